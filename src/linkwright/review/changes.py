"""Define the changes that a review reports, grouped by the files that users open or start."""

from __future__ import annotations

import re
from collections.abc import Collection, Hashable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import NamedTuple

from linkwright.diagnostics import Diagnostic, Phrase, phrase
from linkwright.review.paths import PathComparison

_QUOTED = re.compile("'[^']*'")
MAX_NAMES = 40
"""The maximum number of names that a sentence lists."""
REMOVED_VALUE = "value"
"""The argument of a sentence that is the value of a removed property."""


class Effect(Enum):
    """The effect of a change on programs that use the package."""

    BREAKING = "breaking"
    """Other programs use a removed name, or exchange data that no longer fits."""
    CHANGED = "changed"


class SubjectKind(Enum):
    """The kind of a reviewed file.

    Reports have this order: robots first, then programs, then the files that build and install them.
    """

    SCENARIO = "scenario"
    DESCRIPTION = "description"
    WORLD = "world"
    TEMPLATE = "template of a model or world"
    MUJOCO = "robot or world of MuJoCo"
    PART = "part of descriptions"
    SEMANTICS = "semantic description"
    MESH = "mesh"
    INTERFACE = "interface"
    LAUNCH_FILE = "launch file"
    BEHAVIOR_TREE = "behavior tree"
    PARAMETERS = "parameter file"
    MAP = "map"
    SOURCE = "node source"
    PLUGINS = "plugin description"
    RVIZ = "RViz configuration"
    MODEL_CONFIGURATION = "model.config"
    GUI = "configuration of Gazebo's window"
    BUILD = "build file"
    MANIFEST = "package manifest"
    DEPENDENCIES = "list of dependencies"


class PathChange(Enum):
    """How the path of a file changed."""

    RENAMED = "renamed"
    MOVED = "moved, installed at the same place"


@dataclass(frozen=True)
class Location:
    """A location in a file of either version.

    Attributes:
        file: the path relative to the root of the repository.
        line: the line, starting at 1.
        column: the column, starting at 1.
        is_old: whether it is the file of the old version.
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
        effect: the effect of the change on other programs.
        reason: why the change is breaking; None for other changes.
        location: the location of the new value, or of the old value if there is no new one; None if unknown.
        cases: the names of the argument sets with which the change occurs; empty for all of them.
        other_names: the names of other links, joints or extensions that change in the same way.
        other_locations: the locations of their values, if they differ from the first location.
        path_change: how the path of the file changed; None for other changes.
        is_code: whether the change only names functions and classes with other code.
        uninstalled: the files and folders that a build file no longer installs, if the sentence names them; else empty.
        lost_topics: the topics that a source no longer publishes or receives, if the sentence names them; else empty.
    """

    sentence: Phrase
    effect: Effect = Effect.CHANGED
    reason: Phrase | None = None
    location: Location | None = None
    cases: tuple[str, ...] = ()
    other_names: tuple[str, ...] = ()
    other_locations: tuple[Location, ...] = ()
    path_change: PathChange | None = None
    is_code: bool = False
    uninstalled: tuple[str, ...] = ()
    lost_topics: tuple[str, ...] = ()

    @property
    def name(self) -> str:
        """The name of the changed link, joint or extension; empty for other changes."""
        return str(self.core.arguments.get("name", ""))

    @property
    def identity(self) -> Hashable:
        """A key that is equal for the same change to links and joints of one macro.

        The label of a visual often contains the name of its link.
        """
        if self.location is None:
            return str(self.sentence)
        return self.location, self.other_locations, self.content

    @property
    def content(self) -> tuple[Effect, str, tuple[str, str, str, str]]:
        """A key that is equal for the same change to other links and joints at any location."""
        return self.effect, _QUOTED.sub("", self.property_name), self.values

    @property
    def property_name(self) -> str:
        """The name of the changed property; empty for other changes."""
        return str(self.core.arguments.get("property", ""))

    @property
    def values(self) -> tuple[str, str, str, str]:
        """The form of the sentence, the kind of the changed object, and both values."""
        arguments = self.core.arguments
        subject, old, new = (str(arguments.get(name)) for name in ("subject", "old", "new"))
        return self.core.template, subject, old, str(arguments.get(REMOVED_VALUE, new))

    @property
    def core(self) -> Phrase:
        """The sentence without additions at its end."""
        core = self.sentence.arguments.get("change", self.sentence)
        return core if isinstance(core, Phrase) else self.sentence


@dataclass(frozen=True)
class Figure:
    """A quantity of the whole subject in both versions.

    Attributes:
        name: the name of the quantity.
        old: its old value as text; empty if there is none.
        new: its new value as text; empty if there is none.
        unit: the unit of both values; empty for counts.
        arguments: the values of arguments with which it was measured, if the subject has other sets; else empty.
    """

    name: Phrase
    old: str
    new: str
    unit: str = ""
    arguments: str = ""


@dataclass(frozen=True)
class Problem:
    """The reason why a part of a comparison is missing.

    Attributes:
        text: the reason in one line.
        is_of_old: whether only the old version has the problem, so that the new version solves it.
        is_of_both: whether neither version can be read.
        is_bug: whether a bug in Linkwright is the reason, not the file.
    """

    text: Phrase
    is_of_old: bool = False
    is_of_both: bool = False
    is_bug: bool = False


def make_nesting_problem() -> Problem:
    """Return the problem that a comparison ended with a `RecursionError` or `MemoryError`."""
    return Problem(phrase("the versions cannot be compared: they are nested too deeply, or too large"))


FILE = -1
"""The offset of the whole file, if an expansion read it."""


class ExpandedElement(NamedTuple):
    """An element of a changed file that the expansion of a compared robot used.

    Attributes:
        path: the path of the file relative to the root.
        offset: the character offset of the element in the file, or `FILE`.
        is_old: whether it is the file of the old version.
    """

    path: str
    offset: int
    is_old: bool


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
        problems: the reasons why parts of the comparison are missing.
        cases: the names of all argument sets that were compared.
        images: views of both versions.
        paths: the paths of robots that differ.
        scene: both versions of a robot in 3D; None if it was not requested.
        expanded: the elements of changed files that the compared robots show.
        missing: the names of omitted packages and files, which neither version has.
        is_lost: whether the new version cannot be read, and the old version can.
        added_topics: the topics of plugins and sensors that a description or world adds.
    """

    kind: SubjectKind
    path: str
    old_path: str | None
    new_path: str | None
    changes: Sequence[Change] = ()
    figures: Sequence[Figure] = ()
    problems: Sequence[Problem] = ()
    cases: Sequence[str] = ()
    images: Sequence[ViewImages] = ()
    paths: Sequence[PathComparison] = ()
    scene: RobotScene | None = None
    expanded: Collection[ExpandedElement] = ()
    missing: Sequence[str] = ()
    is_lost: bool = False
    added_topics: Collection[str] = ()

    @property
    def is_empty(self) -> bool:
        """Whether the subject has nothing to report."""
        return not (self.changes or self.figures or self.problems)


@dataclass(frozen=True)
class ViewImages:
    """Images of both versions of a robot from the same side.

    Attributes:
        name: the name of the view, such as ``front``.
        old: the old robot as PNG; empty if there is none.
        new: the new robot as PNG; empty if there is none.
        notes: what is special about the images, such as meshes that are not drawn.
    """

    name: str
    old: bytes
    new: bytes
    notes: tuple[Phrase, ...] = ()


@dataclass(frozen=True)
class RobotScene:
    """Both versions of a robot in 3D, over each other.

    Attributes:
        data: the recorded messages and files for the page of `linkwright export`, as JSON, compressed by gzip; empty
            if there is no scene.
        reason: why there is no scene.
    """

    data: bytes = b""
    reason: Phrase | None = None


@dataclass(frozen=True)
class Review:
    """The differences between two versions of a repository.

    Attributes:
        old_name: the old version in git's notation.
        new_name: the new version in git's notation, or empty for the working tree.
        subjects: the compared files, with their differences.
        other_files: the changed files of other kinds, by path.
        file_states: the states, such as removed, of other files whose path is not in both versions, by path.
        new_findings: the findings of `linkwright check` that the old version does not have.
        fixed_findings: the findings of the old version that the new version does not have.
        notes: the parts that the review does not cover.
    """

    old_name: str
    new_name: str
    subjects: Sequence[Subject] = ()
    other_files: Sequence[str] = ()
    file_states: Mapping[str, Phrase] = field(default_factory=dict)
    new_findings: Sequence[Diagnostic] = ()
    fixed_findings: Sequence[Diagnostic] = ()
    notes: Sequence[Phrase] = field(default_factory=tuple)

    @property
    def breaking_changes(self) -> list[tuple[Subject, Change]]:
        """The breaking changes with their subjects."""
        return [
            (subject, change)
            for subject in self.subjects
            for change in subject.changes
            if change.effect is Effect.BREAKING
        ]
