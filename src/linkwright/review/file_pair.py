"""A file in both versions, with the results of its comparison."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from linkwright.diagnostics import LinkwrightError, Phrase, Span, foreign, phrase
from linkwright.review.changes import Change, Effect, ExpandedPlace, Figure, Location, Problem, RobotScene, ViewImages
from linkwright.review.versions import Version, Versions

_Content = TypeVar("_Content")


class UnreadableFileError(Exception):
    """Raised for a file that a comparison cannot read.

    Attributes:
        reason: why.
    """

    def __init__(self, reason: Phrase) -> None:
        super().__init__(reason)
        self.reason = reason


@dataclass(frozen=True)
class Drawings:
    """The drawings of robots that a review makes.

    Attributes:
        images: whether to make images from four sides.
        scenes: whether to make scenes in 3D.
    """

    images: bool = False
    scenes: bool = False


@dataclass
class FilePair:
    """A file that both versions have, to which its comparison adds its results.

    Attributes:
        versions: both versions.
        old_path: the path in the old version, relative to the root of the repository.
        new_path: the path in the new version, relative to the root of the repository.
        drawings: what to draw of robots that look different.
        changes: the changes found so far.
        figures: the quantities that differ.
        problems: why a part of the comparison is missing.
        cases: the names of the compared argument sets.
        images: images of both versions.
        scene: both versions in 3D.
        expanded: the elements of changed files that the compared robots show.
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
    expanded: set[ExpandedPlace] = field(default_factory=set)

    @property
    def old_file(self) -> Path:
        """The file of the old version."""
        return self.versions.old.file(self.old_path)

    @property
    def new_file(self) -> Path:
        """The file of the new version."""
        return self.versions.new.file(self.new_path)

    def read(self, read: Callable[[Path], _Content]) -> tuple[_Content, _Content] | None:
        """Return the contents of both versions, or None, with a problem added, if one of them cannot be read.

        Args:
            read: a function that reads a file, and raises `LinkwrightError`, `UnreadableFileError`, `OSError` or
                `ValueError` if it cannot.
        """
        old = self._read(read, self.old_file, self.versions.old)
        new = self._read(read, self.new_file, self.versions.new)
        return None if old is None or new is None else (old, new)

    def _read(self, read: Callable[[Path], _Content], file: Path, version: Version) -> _Content | None:
        reason: Phrase
        try:
            return read(file)
        except LinkwrightError as error:
            reason = error.diagnostics[0].message
        except UnreadableFileError as error:
            reason = error.reason
        except OSError as error:
            reason = foreign(error.strerror or str(error))
        except ValueError as error:
            reason = foreign(str(error))
        self.add_unreadable(version, reason)
        return None

    def add_unreadable(self, version: Version, reason: Phrase) -> None:
        """Add the problem that a version cannot be read, once for each reason."""
        text = phrase("the new version cannot be read: {reason}", reason=reason)
        if version.is_old:
            text = phrase("the old version cannot be read: {reason}", reason=reason)
        self.add_problem(text, is_of_old=version.is_old)

    def add_problem(self, text: Phrase, *, is_of_old: bool = False) -> None:
        """Add a reason why a part of the comparison is missing, once."""
        problem = Problem(text, is_of_old)
        if problem not in self.problems:
            self.problems.append(problem)

    def add(self, sentence: Phrase, location: Location | None, reason: Phrase | None = None) -> None:
        """Add a change, which is breaking if there is a reason why."""
        effect = Effect.CHANGED if reason is None else Effect.BREAKING
        self.changes.append(Change(sentence, effect, reason, location))

    def location(self, span: Span | None, *, is_old: bool = False) -> Location | None:
        """Return a location in a version relative to the root, or None for a file outside the repository."""
        version = self.versions.old if is_old else self.versions.new
        path = None if span is None else version.relative(span.file)
        return None if span is None or path is None else Location(path, span.line, span.column, is_old)
