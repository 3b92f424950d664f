"""``linkwright learn grade``: check the folders of many students."""

from __future__ import annotations

import argparse
import time
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.cli.exit_status import FINDINGS, FINE, print_message
from linkwright.cli.numbers import positive_float, positive_int
from linkwright.cli.progress import ProgressLine
from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, phrase
from linkwright.diagnostics.render import compute_width
from linkwright.diagnostics.translation import language, localized
from linkwright.process.processors import usable_processors

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from contextlib import AbstractContextManager

    from linkwright.learning.course import Course, Step
    from linkwright.learning.grading.marks import Mark, StudentMarks
    from linkwright.learning.grading.workers import RunJobs
    from linkwright.learning.sandbox import Limits

_MEBIBYTE = 1 << 20


def configure_grade(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn grade``."""
    parser.add_argument("folders", metavar="FOLDER", nargs="+", type=Path, help="the folder of a student")
    parser.add_argument(
        "--course", metavar="COURSE", help="a shipped course by its name, or the folder of a course (default: robot)"
    )
    parser.add_argument(
        "--lesson", metavar="LESSON", action="append", default=[], help="check the steps of this lesson only"
    )
    parser.add_argument(
        "--step",
        metavar="STEP",
        action="append",
        default=[],
        help="check this step only; with --lesson, a step of that lesson",
    )
    parser.add_argument(
        "--workers",
        metavar="N",
        type=positive_int,
        help="the number of parallel processes (default: one for each processor)",
    )
    parser.add_argument(
        "--ray", metavar="ADDRESS", help="run on a Ray cluster: auto, local, HOST:PORT or ray://HOST:PORT"
    )
    parser.add_argument(
        "--csv", metavar="FILE", type=Path, help="write one line for each student, in a format that gradebooks import"
    )
    parser.add_argument("--nbgrader", metavar="FILE", type=Path, help="write the columns of nbgrader's export as CSV")
    parser.add_argument("--json", metavar="FILE", type=Path, help="write all results as JSON, in all languages")
    parser.add_argument("--html", metavar="FILE", type=Path, help="write a page with all results, in all languages")
    _add_limits(parser)


def _add_limits(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--seconds",
        metavar="S",
        type=positive_float,
        default=300.0,
        help="the time that the checks of a step may take (default: 300)",
    )
    parser.add_argument(
        "--cpu-seconds",
        metavar="S",
        type=positive_float,
        default=60.0,
        help="the processor time that the checks of a step may take (default: 60)",
    )
    parser.add_argument(
        "--memory",
        metavar="MIB",
        type=positive_int,
        default=2048,
        help="the memory that the checks of a step may use, in MiB (default: 2048)",
    )
    parser.add_argument(
        "--disk",
        metavar="MIB",
        type=positive_int,
        default=256,
        help="the disk space that the checks of a step may use, in MiB (default: 256)",
    )
    parser.add_argument(
        "--processes",
        metavar="N",
        type=positive_int,
        default=256,
        help="the number of processes and threads that the checks of a step may start (default: 256)",
    )


def run_grade(arguments: argparse.Namespace) -> int:
    """Grade a class, and return 1 if a folder or a step of it could not be graded."""
    from linkwright.learning.course import DEFAULT_COURSE, find_course, load_course
    from linkwright.learning.grading.class_grading import check_extras, grade_class
    from linkwright.learning.grading.journal import Journal
    from linkwright.learning.grading.marks import describe_class_size
    from linkwright.learning.grading.submissions import find_submissions

    course = load_course(find_course(arguments.course or DEFAULT_COURSE))
    steps = _select_steps(course, arguments)
    outputs = [path for path in (arguments.csv, arguments.nbgrader, arguments.json, arguments.html) if path]
    _check_outputs(outputs)
    submissions = find_submissions(arguments.folders, course)
    limits = _create_limits(arguments)
    journal = Journal(_choose_journal_path(outputs))
    line = ProgressLine()
    start_time = time.monotonic()
    if arguments.ray is None:
        check_extras(steps)
    with _choose_workers(arguments) as run_jobs:
        students = grade_class(
            course,
            steps,
            submissions,
            limits=limits,
            run_jobs=run_jobs,
            journal=journal,
            progress=lambda finished_count, count: line.show(
                phrase("{done} of {count} checks", done=finished_count, count=count)
            ),
        )
    line.end()
    _write_outputs(arguments, course, students, limits)
    is_complete = all(student.is_graded for student in students if student.submission.is_readable)
    if is_complete:
        journal.remove()
    _print_table(students)
    _print_protections(students)
    seconds = f"{time.monotonic() - start_time:.0f}"
    print_message(localized(phrase("{size} in {seconds} s", size=describe_class_size(students), seconds=seconds)))
    if not is_complete:
        print_message(localized(phrase("some steps were not graded; run the command again to grade only these")))
    return FINE if all(student.is_graded for student in students) else FINDINGS


def _choose_workers(arguments: argparse.Namespace) -> AbstractContextManager[RunJobs]:
    from linkwright.learning.grading.workers import open_local_workers, open_ray_workers
    from linkwright.learning.sandbox import find_available_protections

    if arguments.ray is not None:
        return open_ray_workers(arguments.ray)
    find_available_protections()  # raises where there is no sandbox
    return open_local_workers(arguments.workers or usable_processors())


def _select_steps(course: Course, arguments: argparse.Namespace) -> list[Step]:
    """Return the selected steps of the selected lessons, in the order of the course.

    Raises:
        LinkwrightError: LEARN106, the course has no such lesson, or the lessons have no such step.
    """
    lessons = course.find_lessons(arguments.lesson)
    given_lessons = lessons if arguments.lesson else ()
    selected_addresses = {course.find_step(name, given_lessons).address for name in arguments.step}
    ids = {lesson.id for lesson in lessons}
    return [
        step
        for step in course.steps
        if step.lesson.id in ids and (not selected_addresses or step.address in selected_addresses)
    ]


def _check_outputs(outputs: Sequence[Path]) -> None:
    """Check the paths of the output files before the first step is graded.

    Raises:
        LinkwrightError: LEARN120, two outputs have the same path; LEARN121, the folder of an output does not
            exist.
    """
    if len({path.absolute() for path in outputs}) < len(outputs):
        raise LinkwrightError(Diagnostic("LEARN120", phrase("two of the output files have the same name")))
    for path in outputs:
        if path.is_dir() or not path.absolute().parent.is_dir():
            message = phrase("cannot write '{path}'", path=display_path(path))
            hint = phrase("choose a file in a writable folder")
            raise LinkwrightError(Diagnostic("LEARN121", message, hint=hint))


def _choose_journal_path(outputs: Sequence[Path]) -> Path | None:
    from linkwright.learning.grading.journal import SUFFIX

    return outputs[0].with_name(outputs[0].name + SUFFIX) if outputs else None


def _create_limits(arguments: argparse.Namespace) -> Limits:
    from linkwright.learning.sandbox import Limits

    return Limits(
        seconds=arguments.seconds,
        cpu_seconds=arguments.cpu_seconds,
        memory=arguments.memory * _MEBIBYTE,
        disk_bytes=arguments.disk * _MEBIBYTE,
        processes=arguments.processes,
    )


def _write_outputs(
    arguments: argparse.Namespace, course: Course, students: Sequence[StudentMarks], limits: Limits
) -> None:
    from linkwright.files.whole_files import write_whole_file
    from linkwright.learning.grading import formats
    from linkwright.learning.grading.journal import report_write_errors
    from linkwright.learning.grading.page import format_grades_page

    writers: list[tuple[Path | None, Callable[[], str]]] = [
        (arguments.csv, lambda: formats.format_gradebook_csv(students, language())),
        (arguments.nbgrader, lambda: formats.format_nbgrader_csv(students)),
        (arguments.json, lambda: formats.format_grades_json(course, students, formats.limits_to_data(limits))),
        (arguments.html, lambda: format_grades_page(course, students, language())),
    ]
    for path, write in writers:
        if path is not None:
            with report_write_errors(path):
                write_whole_file(path, write())


def _print_table(students: Sequence[StudentMarks]) -> None:
    lang = language()
    width = max(compute_width(student.submission.student) for student in students)
    for student in students:
        name = student.submission.student
        signs = "".join(_format_sign(mark) for mark in student.marks.values())
        padding = " " * (width - compute_width(name))
        points = f"{student.total:g}/{student.possible:g}" if student.submission.is_readable else "–"
        print(f"{name}{padding}  {points:>9}  {signs}".rstrip())
        for note in student.submission.notes:
            print(f"    {note.get(lang)}")
        for step, mark in student.marks.items():
            if mark.reason is not None or not mark.is_graded:
                print(f"    {step}: {'; '.join(message.get(lang) for message in mark.messages)}")


def _format_sign(mark: Mark) -> str:
    if not mark.is_graded:
        return "?"
    return "✓" if mark.passed else "✗"


def _print_protections(students: Sequence[StudentMarks]) -> None:
    """Print the protections that were not in force."""
    from linkwright.learning.grading.formats import list_protections_in_force
    from linkwright.learning.sandbox import PROTECTIONS

    enforced = list_protections_in_force(students)
    if not any(mark.protections for student in students for mark in student.marks.values()):
        return
    for protection, meaning in PROTECTIONS.items():
        if protection.value not in enforced:
            print_message(localized(phrase("not enforced on this system: {protection}", protection=meaning)))
