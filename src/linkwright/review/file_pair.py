"""Define a file in both versions, with the results of its comparison."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple, TypeVar

from linkwright.diagnostics import LinkwrightError, Phrase, Span, foreign, joined_first, phrase, quoted, quoted_names
from linkwright.review.changes import Change, Effect, ExpandedElement, Figure, Location, Problem, RobotScene, ViewImages
from linkwright.review.versions import Version, Versions

_Content = TypeVar("_Content")
_MAX_NAMES = 5
"""The number of names that a problem lists."""


class UnreadableFileError(Exception):
    """Raised for a file that a comparison cannot read.

    Attributes:
        reason: the reason why the file cannot be read.
    """

    def __init__(self, reason: Phrase) -> None:
        super().__init__(reason)
        self.reason = reason


class LimitError(UnreadableFileError):
    """Raised for a file that is not read because of its size, location or kind.

    The file may be valid.
    """


class Fault(NamedTuple):
    """The reason why a version cannot be read.

    Attributes:
        reason: the reason without its location.
        path: the file with the fault relative to the root, or its path outside; empty for the compared file.
        line: the line of the fault; 0 if unknown.
        column: the column of the fault.
        is_certain: whether the fault is in the file, and not in the computer or a limit.
    """

    reason: Phrase
    path: str = ""
    line: int = 0
    column: int = 1
    is_certain: bool = True

    @property
    def text(self) -> Phrase:
        """The reason with its location."""
        location = f"{self.path}:{self.line}: " if self.path else ""
        return phrase("{location}{reason}", location=location, reason=self.reason)


@dataclass(frozen=True)
class Drawings:
    """The kinds of drawings of robots in a review.

    Attributes:
        images: whether to render images from four sides.
        scenes: whether to build 3D scenes.
    """

    images: bool = False
    scenes: bool = False


@dataclass
class FilePair:
    """A file that both versions have. Its comparison adds the results.

    Attributes:
        versions: both versions.
        old_path: the path in the old version, relative to the root of the repository.
        new_path: the path in the new version, relative to the root of the repository.
        drawings: the kinds of drawings of robots that look different.
        changes: the changes found so far.
        figures: the quantities that differ.
        problems: the reasons why parts of the comparison are missing.
        cases: the names of the compared argument sets.
        images: images of both versions.
        scene: both versions in 3D.
        expanded: the elements of changed files that the expansions of the compared robots use.
        missing: the names of packages and files that were left out because a version does not find them.
        is_lost: whether the new version cannot be read, and the old version can.
        is_gained: whether the old version cannot be read, and the new version can.
    """

    versions: Versions
    old_path: str
    new_path: str
    drawings: Drawings = field(default_factory=Drawings)
    changes: list[Change] = field(default_factory=list)
    figures: list[Figure] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)
    cases: list[str] = field(default_factory=list)
    images: list[ViewImages] = field(default_factory=list)
    scene: RobotScene | None = None
    expanded: set[ExpandedElement] = field(default_factory=set)
    missing: dict[str, None] = field(default_factory=dict)
    added_topics: set[str] = field(default_factory=set)
    is_lost: bool = False
    is_gained: bool = False

    @property
    def old_file(self) -> Path:
        """The file of the old version."""
        return self.versions.old.file(self.old_path)

    @property
    def new_file(self) -> Path:
        """The file of the new version."""
        return self.versions.new.file(self.new_path)

    def read(self, read: Callable[[Path], _Content]) -> tuple[_Content, _Content] | None:
        """Return the contents of both versions.

        If one of them cannot be read, the fault is reported, and the result is None.

        Args:
            read: a function that reads a file, and raises `LinkwrightError`, `UnreadableFileError`, `OSError` or
                `ValueError` if it cannot.
        """
        old, new = _try_read(read, self.old_file), _try_read(read, self.new_file)
        if not isinstance(old, Fault) and not isinstance(new, Fault):
            return old, new
        self.add_faults(old if isinstance(old, Fault) else None, new if isinstance(new, Fault) else None)
        return None

    def add_faults(
        self, old: Fault | None, new: Fault | None, cases: tuple[str, ...] = (), callers: Sequence[str] = ()
    ) -> None:
        """Report the faults that make one or both versions unreadable.

        A file that is readable in only one version is a change; it is breaking if the new version is unreadable.

        Args:
            old: the fault of the old version; None if it can be read.
            new: the fault of the new version; None if it can be read.
            cases: the names of the argument sets with which the description cannot be read; empty for all.
            callers: the files that cannot use the description, if others can; else empty.
        """
        if old is not None and new is not None:
            is_same_file = (old.path, new.path) == (self.old_path, self.new_path) or old.path == new.path
            if is_same_file and old.reason == new.reason:
                text = phrase("neither version can be read: {reason}", reason=new.text)
                if callers:
                    text = phrase(
                        "called by {names}, neither version can be read: {reason}",
                        names=joined_first(dict.fromkeys(map(quoted, callers)), _MAX_NAMES),
                        reason=new.text,
                    )
                self._add(Problem(text, is_of_both=True))
            else:
                self.add_unreadable(self.versions.old, old, is_of_both=True)
                self.add_unreadable(self.versions.new, new, is_of_both=True)
        elif new is not None and not new.is_certain:
            self.add_unreadable(self.versions.new, new)
        elif new is not None:
            text = phrase("can no longer be read: {reason}", reason=new.text)
            reason = phrase("launch files and programs that use the file fail")
            if callers:
                reason = phrase("these files fail: {names}", names=quoted_names(callers))
            location = Location(new.path or self.new_path, new.line, new.column) if new.line else None
            self.changes.append(Change(text, Effect.BREAKING, reason, location, cases))
            self.is_lost = True
        elif old is not None and not old.is_certain:
            self.add_unreadable(self.versions.old, old)
        elif old is not None:
            self.is_gained = True
            text = phrase("can be read now; in the old version: {reason}", reason=old.text)
            location = Location(old.path or self.old_path, old.line, old.column, is_old=True) if old.line else None
            self.changes.append(Change(text, location=location, cases=cases))

    def add_unreadable(self, version: Version, fault: Fault, *, is_of_both: bool = False) -> None:
        """Report the problem that a version cannot be read, once for each reason."""
        text = phrase("the new version cannot be read: {reason}", reason=fault.text)
        if version.is_old:
            text = phrase("the old version cannot be read: {reason}", reason=fault.text)
        self._add(Problem(text, is_of_old=version.is_old, is_of_both=is_of_both))

    def add_unevaluated(self, names: list[str]) -> None:
        """Report the problem that values of links and joints need definitions in missing files."""
        text = phrase(
            "values that need definitions of missing files are not compared: {names}",
            names=joined_first(map(quoted, names), _MAX_NAMES),
        )
        self.add_problem(text)

    def add_problem(self, text: Phrase) -> None:
        """Report a reason why a part of the comparison is missing, once."""
        self._add(Problem(text))

    def _add(self, problem: Problem) -> None:
        if problem not in self.problems:
            self.problems.append(problem)

    def add(self, sentence: Phrase, location: Location | None, reason: Phrase | None = None) -> None:
        """Report a change. A change with a reason is breaking."""
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        self.changes.append(Change(sentence, effect, reason, location))

    def location(self, span: Span | None, *, is_old: bool = False) -> Location | None:
        """Return a location relative to the root, or None for a file outside the repository."""
        version = self.versions.old if is_old else self.versions.new
        path = None if span is None else version.relative(span.file)
        return None if span is None or path is None else Location(path, span.line, span.column, is_old)


def _try_read(read: Callable[[Path], _Content], file: Path) -> _Content | Fault:
    try:
        return read(file)
    except LinkwrightError as error:
        return Fault(error.diagnostics[0].message)
    except LimitError as error:
        return Fault(error.reason, is_certain=False)
    except UnreadableFileError as error:
        return Fault(error.reason)
    except OSError as error:
        return Fault(foreign(error.strerror or str(error)), is_certain=False)
    except ValueError as error:
        return Fault(foreign(str(error)))
