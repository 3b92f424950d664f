"""Tests of lessons: the checks must accept correct solutions, and reject wrong ones."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Phrase, phrase
from linkwright.files.scratch_folders import ScratchFolder
from linkwright.learning.checks.check_process import check_in_process
from linkwright.learning.checks.declarations import load_checks, load_module
from linkwright.learning.course import CASES_FILE, CHECKS_FILE, Course, Lesson, Step
from linkwright.learning.errors import file_error
from linkwright.process.forked import ForkServer

_IMAGE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)")


@dataclass(frozen=True)
class Edit:
    """A replacement in a file of the workspace.

    Attributes:
        file: the path in the workspace.
        old: the text to replace, which must occur exactly once.
        new: the text that replaces it.
    """

    file: str
    old: str
    new: str


@dataclass(frozen=True)
class Case:
    """A solution of a step, right or wrong.

    Attributes:
        step: the name of the step.
        title: the distinguishing feature of the solution.
        changes: the changes to the step's solution, in order: edits, or new contents by path in the workspace with
            None for a file to delete.
        says: for a wrong solution, a part of the first failed check's English message; None for a right solution.
        answer: the learner's answer; None for the correct answer.
    """

    step: str
    title: str
    changes: Sequence[Edit | Mapping[str, str | None]]
    says: str | None
    answer: str | None = None


def right(step: str, title: str, *changes: Edit | Mapping[str, str | None], answer: str | None = None) -> Case:
    """Return a test case with a correct solution. See `Case`."""
    return Case(step, title, changes, None, answer)


def wrong(
    step: str, title: str, *changes: Edit | Mapping[str, str | None], says: str, answer: str | None = None
) -> Case:
    """Return a test case with a wrong solution. See `Case`.

    A check's message must contain `says`.
    """
    return Case(step, title, changes, says, answer)


@dataclass(frozen=True)
class TestResult:
    """The result of one test of a lesson.

    Attributes:
        lesson: the name of the lesson.
        title: the name of the test.
        problem: the reason why the test failed; None if it passed.
    """

    __test__ = False  # pytest would collect it

    lesson: str
    title: str
    problem: Phrase | None


def test_lesson(course: Course, lesson: Lesson, server: ForkServer) -> Iterator[TestResult]:
    """Test the images, the checks, the solutions and the cases of a lesson.

    The checks of each step must fail before its solution and pass after it. The initial workspace has the solutions
    of all steps before the lesson.

    Args:
        course: the course of the lesson.
        lesson: the lesson to test.
        server: starts the processes of the checks; see `create_check_server`.

    Yields:
        The result of each test as soon as the test has ended.

    Raises:
        LinkwrightError: a file of the lesson cannot be read or run.
    """
    yield from _test_images(lesson)
    checks = load_checks(lesson.folder / CHECKS_FILE)
    unknown = sorted(set(checks) - {step.id for step in lesson.steps})
    if unknown:
        yield TestResult(lesson.id, CHECKS_FILE, phrase("there is no step '{step}'", step=unknown[0]))
    cases = load_cases(lesson)
    with ScratchFolder("lesson") as scratch:
        workspace = Path(scratch) / "before"
        workspace.mkdir()
        for name, source in course.files_before(lesson.steps[0]).items():
            (workspace / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, workspace / name)
        _copy_over(lesson.start, workspace)
        for step in lesson.steps:
            if step.id not in checks:
                yield TestResult(lesson.id, step.id, phrase("the step has no checks"))
            own_cases = [case for case in cases if case.step == step.id]
            yield from _test_step(step, workspace, own_cases, Path(scratch) / "case", server)


test_lesson.__test__ = False  # type: ignore[attr-defined]  # pytest would collect it


def _test_step(
    step: Step, workspace: Path, cases: Sequence[Case], scratch: Path, server: ForkServer
) -> Iterator[TestResult]:
    """Yield the results of a step's tests, and leave the step's solution in the workspace."""
    answer = step.right_answer
    if check_in_process(step, workspace, stop_at_failure=True, server=server).passed:
        yield TestResult(step.lesson.id, step.id, phrase("the checks accept the step without its solution"))
    _copy_over(step.solution, workspace)
    yield TestResult(step.lesson.id, step.id, _find_unexpected_result(step, workspace, answer, None, server))
    for case in cases:
        shutil.rmtree(scratch, ignore_errors=True)
        shutil.copytree(workspace, scratch)
        _apply_changes(case, scratch, step.lesson)
        tested_answer = answer if case.answer is None else case.answer
        yield TestResult(
            step.lesson.id,
            f"{step.id}: {case.title}",
            _find_unexpected_result(step, scratch, tested_answer, case.says, server),
        )


def _find_unexpected_result(
    step: Step, workspace: Path, answer: str | None, says: str | None, server: ForkServer
) -> Phrase | None:
    """Return the difference between the expected and the actual result of the checks, or None."""
    result = check_in_process(step, workspace, answer=answer, stop_at_failure=True, server=server)
    messages = [str(check.message) for check in result.checks if check.message is not None]
    if says is None:
        return (
            None
            if result.passed
            else phrase("the checks reject a correct solution: {message}", message=(messages or [""])[0])
        )
    if result.passed:
        return phrase("the checks accept a wrong solution")
    if not messages or says not in messages[0]:
        return phrase("the message '{message}' does not contain '{part}'", message=(messages or [""])[0], part=says)
    return None


def load_cases(lesson: Lesson) -> list[Case]:
    """Return the cases of a lesson, in the order of its file.

    Raises:
        LinkwrightError: LEARN102, LEARN107: the file cannot be read or run, or has other values.
    """
    path = lesson.folder / CASES_FILE
    if not path.is_file():
        return []
    cases = list(getattr(load_module(path), "CASES", ()))
    names = {step.id for step in lesson.steps}
    for case in cases:
        if not isinstance(case, Case) or case.step not in names:
            message = phrase("CASES must be a list of right(...) and wrong(...) for steps of the lesson")
            raise file_error("LEARN107", path, message)
    return cases


def _apply_changes(case: Case, workspace: Path, lesson: Lesson) -> None:
    for change in case.changes:
        if isinstance(change, Edit):
            path = workspace / change.file
            text = path.read_text(encoding="utf-8") if path.is_file() else ""
            if text.count(change.old) != 1:
                message = phrase(
                    "case '{title}': '{text}' occurs {count} times in '{file}', and must occur once",
                    title=case.title,
                    text=change.old,
                    count=text.count(change.old),
                    file=change.file,
                )
                raise file_error("LEARN107", lesson.folder / CASES_FILE, message)
            path.write_text(text.replace(change.old, change.new), encoding="utf-8")
            continue
        for name, content in change.items():
            path = workspace / name
            if content is None:
                path.unlink()
                continue
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")


def _copy_over(source: Path, target: Path) -> None:
    if source.is_dir():
        shutil.copytree(source, target, dirs_exist_ok=True)


def _test_images(lesson: Lesson) -> Iterator[TestResult]:
    for text in lesson.texts.values():
        for name in _IMAGE.findall(text.path.read_text(encoding="utf-8")):
            if "://" not in name and not (lesson.folder / name).is_file():
                yield TestResult(lesson.id, text.path.name, phrase("the image '{name}' is missing", name=name))
