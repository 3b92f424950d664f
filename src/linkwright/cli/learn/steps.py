"""``linkwright learn list``, ``show``, ``check`` and others: a course in the terminal."""

from __future__ import annotations

import argparse
import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from linkwright.diagnostics import display_path, phrase
from linkwright.diagnostics.translation import language, localized

if TYPE_CHECKING:
    from linkwright.learning.classroom import Classroom
    from linkwright.learning.course import Step

_PASSED, _MISSING, _TAKEN_OVER = "✓", "✗", "→"


def _add_workspace(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "-C",
        "--workspace",
        metavar="FOLDER",
        type=Path,
        help="the workspace (default: the folder with a learn.yaml at or above the current one)",
    )
    parser.add_argument("--course", metavar="COURSE", help="a shipped course by its name, or the folder of a course")


def _add_step(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "step",
        metavar="STEP",
        nargs="?",
        help="the step (default: the last one that you began, or the next one if it is passed)",
    )


def _open_classroom(arguments: argparse.Namespace) -> Classroom:
    from linkwright.learning.classroom import find_enclosing_workspace, open_classroom

    workspace = arguments.workspace or find_enclosing_workspace(Path.cwd())
    return open_classroom(workspace.absolute(), arguments.course)


def _find_step(classroom: Classroom, arguments: argparse.Namespace) -> Step:
    return classroom.current_step if arguments.step is None else classroom.course.find_step(arguments.step)


def configure_list(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn list``."""
    _add_workspace(parser)


def run_list(arguments: argparse.Namespace) -> int:
    """Print the lessons and steps of the course."""
    classroom = _open_classroom(arguments)
    lang = language()
    print(classroom.course.title.get(lang))
    for lesson in classroom.course.lessons:
        print(f"\n{lesson.id}: {lesson.title.get(lang)}")
        for step in lesson.steps:
            record = classroom.progress.step(step.address)
            mark = _PASSED if record.passed is not None else _TAKEN_OVER if record.taken_over else " "
            print(f"  {mark} {step.id}: {step.title.get(lang)}")
    if any(record.taken_over for record in classroom.progress.steps.values()):
        print(f"\n{_TAKEN_OVER} {localized(phrase('solution copied from the course'))}")
    return 0


def configure_show(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn show``."""
    _add_step(parser)
    _add_workspace(parser)


def run_show(arguments: argparse.Namespace) -> int:
    """Print the text of a step."""
    classroom = _open_classroom(arguments)
    step = _find_step(classroom, arguments)
    created_files = classroom.open_step(step)
    text = step.text(language())
    if step.id == step.lesson.steps[0].id:
        lesson = step.lesson.texts.get(language()) or next(iter(step.lesson.texts.values()))
        print(f"# {lesson.title}\n\n{lesson.introduction}\n")
    print(f"## {text.title}\n\n{text.body}")
    for path in created_files:
        print(localized(phrase("created {path}", path=display_path(path))), file=sys.stderr)
    return 0


def configure_check(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn check``."""
    _add_step(parser)
    _add_workspace(parser)
    parser.add_argument("--json", action="store_true", help="print the result as JSON, in all languages")


def run_check(arguments: argparse.Namespace) -> int:
    """Check a step, and return 1 if it is not passed."""
    classroom = _open_classroom(arguments)
    step = _find_step(classroom, arguments)
    result = classroom.check(step)
    if arguments.json:
        print(json.dumps(result.to_data(), ensure_ascii=False))
        return 0 if result.passed else 1
    lang = language()
    print(f"{step.address}: {step.title.get(lang)}")
    for check in result.checks:
        print(f"  {_PASSED if check.passed else _MISSING} {check.title.get(lang)}")
        if check.message is not None:
            print(f"      {check.message.get(lang)}")
    if result.passed:
        next_step = classroom.current_step
        if next_step.address != step.address:
            print(localized(phrase("passed; the next step is {step}", step=next_step.address)))
        return 0
    if count := len(classroom.find_steps_to_catch_up(step)):
        command = f"linkwright learn catch-up {step.address}"
        message = phrase(
            "unfinished steps before this one: {count}; `{command}` copies their solutions from the course",
            count=count,
            command=command,
        )
        print(localized(message))
    return 1


def configure_answer(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn answer``."""
    parser.add_argument("step", metavar="STEP", help="the step")
    parser.add_argument("number", metavar="NUMBER", help="the number that you measured")
    _add_workspace(parser)
    parser.set_defaults(json=False)


def run_answer(arguments: argparse.Namespace) -> int:
    """Store the answer to a step, and check the step."""
    classroom = _open_classroom(arguments)
    classroom.record_answer(classroom.course.find_step(arguments.step), arguments.number)
    return run_check(arguments)


def configure_hint(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn hint``."""
    _add_step(parser)
    _add_workspace(parser)


def run_hint(arguments: argparse.Namespace) -> int:
    """Print the hints taken so far and the next one."""
    classroom = _open_classroom(arguments)
    step = _find_step(classroom, arguments)
    hints = step.text(language()).hints
    if not hints:
        print(localized(phrase("the step '{step}' has no hints", step=step.address)), file=sys.stderr)
        return 0
    print("\n\n".join(hints[: classroom.take_hint(step)]))
    return 0


def configure_solution(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn solution``."""
    _add_step(parser)
    _add_workspace(parser)


def run_solution(arguments: argparse.Namespace) -> int:
    """Copy the solution of a step into the workspace, and print the requested number, if any."""
    classroom = _open_classroom(arguments)
    step = _find_step(classroom, arguments)
    for path in classroom.take_solution(step):
        print(display_path(path))
    if step.right_answer is not None:
        print(localized(phrase("the answer is {answer}", answer=_with_unit(step.right_answer, step.unit))))
    return 0


def configure_catch_up(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments of ``learn catch-up``."""
    _add_step(parser)
    _add_workspace(parser)
    parser.add_argument("--yes", action="store_true", help="write the files; without it, they are only listed")


def run_catch_up(arguments: argparse.Namespace) -> int:
    """List or write the files that the course has before a step.

    Returns:
        1 if files were only listed, otherwise 0.
    """
    from linkwright.learning.classroom import REPLACED_FOLDER

    classroom = _open_classroom(arguments)
    step = _find_step(classroom, arguments)
    plan = classroom.plan_catch_up(step)
    for path in sorted(plan.new):
        print(localized(phrase("new: {path}", path=display_path(path))))
    for path in sorted(plan.replaced):
        print(localized(phrase("replaced: {path}", path=display_path(path))))
    if arguments.yes:
        classroom.catch_up(step)
        message = phrase("the workspace has the course's files of all steps before {step}", step=step.address)
    elif plan.files:
        message = phrase(
            "nothing was written; add --yes to write these files; replaced ones are moved to the folder '{folder}'",
            folder=REPLACED_FOLDER,
        )
    else:
        message = phrase(
            "there is nothing to write; add --yes to mark the steps before {step} as copied from the course",
            step=step.address,
        )
    print(localized(message), file=sys.stderr)
    return 0 if arguments.yes else 1


def _with_unit(number: str, unit: str | None) -> str:
    return number if unit in {None, "1"} else f"{number} {unit}"
