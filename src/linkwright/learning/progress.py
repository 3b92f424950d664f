"""The learner's progress, stored as a readable file in the workspace."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from datetime import datetime
from pathlib import Path
from typing import Any

import yaml

from linkwright.diagnostics import phrase
from linkwright.files.whole_files import write_whole_file
from linkwright.learning.errors import file_error, unreadable_file_error

PROGRESS_FILE = "learn.yaml"

_MAX_ANSWER_LENGTH = 1000

_HEADER = "# Progress in a course of Linkwright, written by `linkwright learn`.\n"


@dataclass(frozen=True)
class StepProgress:
    """The progress in a step.

    Attributes:
        started: the time when the step was first opened.
        passed: the time when all checks were first satisfied; None if they never were.
        hints: the number of hints taken.
        solution: whether the learner used the solution.
        taken_over: whether the course's files replace the learner's work, so that a later step can be started.
        answer: the number that the learner answered, as text; None if there is none.
    """

    started: datetime | None = None
    passed: datetime | None = None
    hints: int = 0
    solution: bool = False
    taken_over: bool = False
    answer: str | None = None

    def to_data(self) -> dict[str, Any]:
        """Return the values that differ from the defaults."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        return {name: value for name, value in values.items() if value not in (None, 0, False)}


@dataclass(frozen=True)
class Progress:
    """The progress in a course.

    Attributes:
        course: the course: its name if it is shipped, else its folder.
        steps: the progress by the address of the step, ``LESSON/STEP``.
    """

    course: str
    steps: Mapping[str, StepProgress]

    def step(self, address: str) -> StepProgress:
        """Return the progress in a step."""
        return self.steps.get(address, StepProgress())

    def with_step(self, address: str, **changes: Any) -> Progress:
        """Return the progress with changes to a step."""
        return replace(self, steps={**self.steps, address: replace(self.step(address), **changes)})


def read_progress(workspace: Path) -> Progress | None:
    """Return the progress in a workspace, or None if there is no progress file.

    Raises:
        LinkwrightError: LEARN102, the file cannot be read; LEARN110, it is not a progress file.
    """
    path = workspace / PROGRESS_FILE
    try:
        data = yaml.safe_load(path.read_text(encoding="utf-8"))
    except (FileNotFoundError, NotADirectoryError):
        return None
    except (OSError, UnicodeDecodeError) as error:
        raise unreadable_file_error(path, error) from None
    except yaml.YAMLError as error:
        line = getattr(getattr(error, "problem_mark", None), "line", 0) + 1
        raise file_error("LEARN110", path, phrase("the file is not valid YAML"), line=line, hint=_RENAME_HINT) from None
    try:
        steps = {str(name): _read_step(values) for name, values in data.get("steps", {}).items()}
        return Progress(str(data["course"]), steps)
    except (AttributeError, KeyError, TypeError, ValueError):
        message = phrase("the file does not contain the progress in a course")
        raise file_error("LEARN110", path, message, hint=_RENAME_HINT) from None


_RENAME_HINT = phrase("fix the file, or rename it to start again")


def _read_step(values: Mapping[str, Any]) -> StepProgress:
    step = StepProgress(**values)
    if step.answer is not None:
        step = replace(step, answer=_read_answer(step.answer))
    if type(step.hints) is not int or type(step.solution) is not bool or type(step.taken_over) is not bool:
        raise ValueError("a number of hints, and whether the solution or the step was taken over, are expected")
    if not all(value is None or isinstance(value, datetime) for value in (step.started, step.passed)):
        raise ValueError("a date and time is expected")
    return step


def _read_answer(value: object) -> str:
    """Return an answer as text. A learner may have edited the file."""
    if not isinstance(value, str | int | float) or len(text := str(value)) > _MAX_ANSWER_LENGTH or "\0" in text:
        raise ValueError("a number is expected")
    return text


def write_progress(workspace: Path, progress: Progress) -> None:
    """Write the progress to the workspace.

    The old file remains if writing fails.

    Raises:
        OSError: the file cannot be written.
    """
    data = {"course": progress.course, "steps": {name: step.to_data() for name, step in progress.steps.items()}}
    text = _HEADER + yaml.safe_dump(data, sort_keys=False, allow_unicode=True)
    write_whole_file(workspace / PROGRESS_FILE, text)
