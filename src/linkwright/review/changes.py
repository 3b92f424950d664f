"""What a review reports: changes, grouped by the file that users open or start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

from linkwright.diagnostics import Diagnostic, Phrase


class Effect(Enum):
    """What a change means for programs that use the package."""

    BREAKING = "breaking"
    """Other programs name what was removed or renamed, or exchange data that no longer fits."""
    CHANGED = "changed"


class SubjectKind(Enum):
    """The kind of a reviewed file."""

    DESCRIPTION = "description"
    WORLD = "world"
    LAUNCH_FILE = "launch file"
    PARAMETERS = "parameter file"
    MAP = "map"
    INTERFACE = "interface"
    MANIFEST = "package manifest"
    MESH = "mesh"


@dataclass(frozen=True)
class Location:
    """A location in a file of either version.

    Attributes:
        file: the path relative to the root of the repository.
        line: the line, starting at 1.
        column: the column, starting at 1.
        is_old: whether the file is that of the old version.
    """

    file: str
    line: int
    column: int
    is_old: bool = False


@dataclass(frozen=True)
class Change:
    """A difference between the two versions of a subject.

    Attributes:
        sentence: the change, in one line.
        effect: what the change means for other programs.
        reason: why the change is breaking; None for other changes.
        location: where the new value is, or the old value of what was removed; None if unknown.
        cases: the names of the argument sets with which the change occurs; empty for all of them.
    """

    sentence: Phrase
    effect: Effect = Effect.CHANGED
    reason: Phrase | None = None
    location: Location | None = None
    cases: tuple[str, ...] = ()


@dataclass(frozen=True)
class Figure:
    """A quantity of the whole subject in both versions.

    Attributes:
        name: the quantity.
        old: its old value as text; empty if there is none.
        new: its new value as text; empty if there is none.
        unit: the unit of both values; empty for counts.
    """

    name: Phrase
    old: str
    new: str
    unit: str = ""


@dataclass(frozen=True)
class Subject:
    """A reviewed file with its changes.

    Attributes:
        kind: the kind of the file.
        path: the new path, relative to the root of the repository, or the old path of a removed file.
        old_path: the old path; None for an added file.
        new_path: the new path; None for a removed file.
        changes: the changes, in the order of the new version.
        figures: the quantities that differ.
        problems: why a part of the comparison is missing.
        cases: the names of all argument sets that were compared.
        pictures: PNG images, by name.
    """

    kind: SubjectKind
    path: str
    old_path: str | None
    new_path: str | None
    changes: Sequence[Change] = ()
    figures: Sequence[Figure] = ()
    problems: Sequence[Phrase] = ()
    cases: Sequence[str] = ()
    pictures: Sequence[Picture] = ()

    @property
    def is_empty(self) -> bool:
        """Whether there is nothing to report."""
        return not (self.changes or self.figures or self.problems)


@dataclass(frozen=True)
class Picture:
    """A view of both versions of a robot from the same side.

    Attributes:
        view: the name of the view, such as ``front``.
        old: the old robot as PNG.
        new: the new robot as PNG.
    """

    view: str
    old: bytes
    new: bytes


@dataclass(frozen=True)
class Review:
    """The differences between two versions of a repository.

    Attributes:
        old_name: the old version in git's notation.
        new_name: the new version in git's notation, or empty for the working tree.
        subjects: the changed files that are compared, with what differs.
        other_files: the changed files of other kinds, by path.
        new_findings: the findings of `linkwright check` that the old version does not have.
        mended_findings: the findings of the old version that the new version does not have.
        notes: what the review could not look at.
    """

    old_name: str
    new_name: str
    subjects: Sequence[Subject] = ()
    other_files: Sequence[str] = ()
    new_findings: Sequence[Diagnostic] = ()
    mended_findings: Sequence[Diagnostic] = ()
    notes: Sequence[Phrase] = field(default_factory=tuple)

    @property
    def breaking_changes(self) -> list[tuple[Subject, Change]]:
        """The breaking changes, each with its subject."""
        return [
            (subject, change)
            for subject in self.subjects
            for change in subject.changes
            if change.effect is Effect.BREAKING
        ]
