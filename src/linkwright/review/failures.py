"""Keep a review going when a comparison fails: the file that causes it gets a problem, the others their changes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from traceback import extract_tb
from typing import TypeVar

from linkwright.diagnostics import LinkwrightError, Phrase, foreign, phrase
from linkwright.files.git_repository import ChangedFile
from linkwright.review.changes import Problem, make_nesting_problem
from linkwright.review.file_pair import UnreadableFileError
from linkwright.review.versions import Versions

_Result = TypeVar("_Result")
_Step = Callable[[Versions, Sequence[ChangedFile]], Iterable[_Result]]
_ROOT = Path(__file__).parents[1]
_MAX_SEARCHED_FILES = 60
"""The maximum number of changed files that are tried one by one to find the cause of a failure."""


def make_problem(error: Exception) -> Problem:
    """Return the problem that an exception ended the comparison of a file."""
    if isinstance(error, (RecursionError, MemoryError)):
        return make_nesting_problem()
    if isinstance(error, LinkwrightError):
        return Problem(phrase("the versions cannot be compared: {reason}", reason=error.diagnostics[0].message))
    if isinstance(error, UnreadableFileError):
        return Problem(phrase("the versions cannot be compared: {reason}", reason=error.reason))
    if isinstance(error, OSError):
        reason = foreign(error.strerror or str(error))
        return Problem(phrase("the versions cannot be compared: {reason}", reason=reason))
    return Problem(_format_bug(error), is_bug=True)


def _format_bug(error: Exception) -> Phrase:
    """Return the line about a bug, with the location of the exception in Linkwright."""
    frames = [frame for frame in extract_tb(error.__traceback__) if Path(frame.filename).is_relative_to(_ROOT)]
    location = f"{Path(frames[-1].filename).relative_to(_ROOT).as_posix()}:{frames[-1].lineno}" if frames else "-"
    return phrase(
        "not compared because of a bug in Linkwright; please report this line, with the file if you can share it: "
        "{error} in {place}",
        error=foreign(" ".join(f"{type(error).__name__}: {error}".split())),
        place=location,
    )


@dataclass
class Failures:
    """The failures of the steps of a review.

    Attributes:
        problems: the first failure of each file, by path.
        notes: a line for each step whose failure no single file causes.
    """

    problems: dict[str, Problem] = field(default_factory=dict)
    notes: list[Phrase] = field(default_factory=list)

    def run_step(self, step: _Step[_Result], versions: Versions, files: Sequence[ChangedFile]) -> list[_Result]:
        """Return the results of a step.

        A step that fails is repeated without the files that make it fail.
        """
        try:
            return list(step(versions, files))
        except Exception as error:  # noqa: BLE001 - the other files are still compared
            failure = error
        failing = {
            file.path: problem
            for file in files[:_MAX_SEARCHED_FILES]
            if (problem := _find_problem(step, versions, file))
        }
        remaining_files = [file for file in files if file.path not in failing]
        if failing:
            try:
                results = list(step(versions, remaining_files))
            except Exception as error:  # noqa: BLE001
                failure = error
            else:
                self.problems = {**failing, **self.problems}
                return results
        self._add_note(failure)
        return []

    def attempt(self, function: Callable[[], _Result], fallback: _Result) -> _Result:
        """Return the result of a function, or the fallback and a note if it fails."""
        try:
            return function()
        except Exception as error:  # noqa: BLE001
            self._add_note(error)
            return fallback

    def add(self, path: str, error: Exception) -> None:
        """Add the failure of a file."""
        self.problems.setdefault(path, make_problem(error))

    def add_missing_findings(self, path: str, error: Exception) -> None:
        """Add the failure of the check of a file or package, whose findings are missing then."""
        problem = make_problem(error)
        text = phrase("new and fixed findings are missing: {reason}", reason=problem.text)
        self.problems.setdefault(path, replace(problem, text=text))

    def _add_note(self, error: Exception) -> None:
        text = phrase("a part of the review is missing: {reason}", reason=make_problem(error).text)
        if text not in self.notes:
            self.notes.append(text)


def _find_problem(step: _Step[_Result], versions: Versions, file: ChangedFile) -> Problem | None:
    """Return the problem with which a step fails for a single file, or None."""
    try:
        for _ in step(versions, [file]):
            pass
    except Exception as error:  # noqa: BLE001
        return make_problem(error)
    return None
