"""Pairs of descriptions to compare: two files, or a file and its version in a git commit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

from linkwright.descriptions.comparison import Comparison, Side, compare
from linkwright.descriptions.service import Description, examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, display_path
from linkwright.loading.lean_dataclasses import dataclass
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.descriptions.revisions import CommitFiles
    from linkwright.urdf import Robot
    from linkwright.xmltree import Overlay


@dataclass(frozen=True)
class Model:
    """One of two compared descriptions.

    Attributes:
        path: the absolute path of the file.
        values: the values of the file's ``<xacro:arg>``.
        finder: the finder of the file's packages.
        commit: the files of the commit that contains the file, or None for a file of the working tree.
        overlay: texts that replace the contents of files.
    """

    path: Path
    values: Mapping[str, str]
    finder: PackageFinder
    commit: CommitFiles | None = None
    overlay: Overlay | None = None

    def label(self) -> str:
        """Return the name of the file for users; see `display_name`."""
        return self.display_name(str(self.path))

    @property
    def title(self) -> str:
        """The name of the file without folders, such as ``HEAD:arm.urdf`` for a file of a commit."""
        return self.path.name if self.commit is None else f"{self.commit.name}:{self.path.name}"

    def display_name(self, file: str) -> str:
        """Return the name of a file for users.

        Examples are ``HEAD:robots/arm.urdf``, and a path relative to the current folder.
        """
        name = file if self.commit is None else self.commit.label(file)
        return display_path(name) if name == file else name

    def read(self) -> Description:
        """Return the description with its robot.

        Raises:
            LinkwrightError: if the description cannot be read or expanded, or if urdfdom would refuse it.
        """
        try:
            description = examine(self.path, arguments=self.values, packages=self.finder, overlay=self.overlay)
        except LinkwrightError as error:
            raise LinkwrightError(*map(self._relabel, error.diagnostics)) from None
        if description.robot is None:
            raise LinkwrightError(*map(self._relabel, description.diagnostics))
        return description

    def read_robot(self) -> Robot:
        """Return the robot.

        Raises:
            LinkwrightError: see `read`.
        """
        robot = self.read().robot
        assert robot is not None
        return robot

    def resolve(self, uri: str) -> Path:
        """Return the file of a mesh's URI.

        Raises:
            LinkwrightError: if the package of the mesh is not found.
        """
        return self.finder.resolve(uri, self.path.parent)

    def normalizer(self, other: Model) -> Callable[[str], str]:
        """Return a function that makes texts comparable with another description's texts.

        Paths in the folder of a commit are then equal to those in the working tree.
        """
        if self.commit is not None:
            return self.commit.normalize
        return other.commit.normalizer_for(self.finder) if other.commit is not None else str

    def _relabel(self, diagnostic: Diagnostic) -> Diagnostic:
        """Return a finding with git's names for the files of a commit."""
        if self.commit is None:
            return diagnostic
        notes = tuple(note._replace(span=self._span(note.span)) for note in diagnostic.notes)
        return diagnostic.with_changes(span=self._span(diagnostic.span), notes=notes)

    def _span(self, span: Span | None) -> Span | None:
        return None if span is None else span._replace(file=self.display_name(span.file))


@dataclass(frozen=True)
class Pair:
    """An old and a new description.

    Attributes:
        old: the old description.
        new: the new description.
    """

    old: Model
    new: Model

    def close(self) -> None:
        """Remove the temporary folders of commits, if there are any."""
        for model in (self.old, self.new):
            if model.commit is not None:
                model.commit.close()

    def label(self, file: str) -> str:
        """Return the name of a file of either description for users."""
        return self.old.display_name(file)

    def read_and_compare(self) -> Comparison:
        """Read both descriptions and return the differences between them.

        Raises:
            LinkwrightError: see `Model.read`.
        """
        return self.compare(self.old.read_robot(), self.new.read_robot())

    def compare(self, old: Robot, new: Robot) -> Comparison:
        """Return the differences between two robots that were read from the two descriptions."""
        sides = (
            Side(robot, normalize=model.normalizer(other), resolve=model.resolve)
            for robot, model, other in ((old, self.old, self.new), (new, self.new, self.old))
        )
        return compare(*sides)


def make_old_description_key(description: Description) -> str:
    """Return a text that identifies the old description, even if the new description is equal.

    Descriptions are identified by their text.
    """
    return f"{description.text}\n<!-- the old one -->\n"


def make_file_pair(old: Path, new: Path, values: Mapping[str, str]) -> Pair:
    """Return the pair of two files.

    Args:
        old: the old file.
        new: the new file.
        values: the values for the ``<xacro:arg>`` of both files.
    """
    old_model, new_model = (
        Model(path.absolute(), values, PackageFinder(start=[path.absolute().parent, Path.cwd()])) for path in (old, new)
    )
    return Pair(old_model, new_model)


def make_pair_with_commit(path: Path, commit: str, values: Mapping[str, str]) -> Pair:
    """Return the pair of a file's version in a commit and the file in the working tree.

    The files of the commit exist until the pair is closed.

    Raises:
        LinkwrightError: see `linkwright.descriptions.revisions.file_in_commit`.
    """
    from linkwright.descriptions.revisions import file_in_commit

    files, old_path = file_in_commit(path, commit)
    new = Model(path.absolute(), values, PackageFinder(start=[path.absolute().parent, Path.cwd()]))
    return Pair(Model(old_path, values, files.finder(old_path.parent), files), new)
