"""Two descriptions to compare: two files, or a file and its version in a commit."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from linkwright.descriptions.comparison import Comparison, Side, compare
from linkwright.descriptions.service import Description, examine
from linkwright.diagnostics import Diagnostic, LinkwrightError, Span, display_path
from linkwright.loading.lean_dataclasses import dataclass, replace
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.descriptions.revisions import Revision
    from linkwright.urdf import Robot


@dataclass(frozen=True)
class Model:
    """One of two compared descriptions.

    Attributes:
        path: the file, absolute.
        values: the values of its ``<xacro:arg>``.
        finder: finds its packages.
        revision: the commit that contains the file; None for a file of the working tree.
    """

    path: Path
    values: Mapping[str, str]
    finder: PackageFinder
    revision: Revision | None = None

    def label(self) -> str:
        """Return the file's name for users."""
        return self.named(str(self.path))

    @property
    def title(self) -> str:
        """The name of the file without its folders; ``HEAD:arm.urdf`` for a file of a commit."""
        return self.path.name if self.revision is None else f"{self.revision.name}:{self.path.name}"

    def named(self, file: str) -> str:
        """Return the name of a file for users: ``HEAD:robots/arm.urdf``, or a path relative to the current folder."""
        name = file if self.revision is None else self.revision.label(file)
        return display_path(name) if name == file else name

    def read(self) -> Description:
        """Return the description, which has a robot.

        Raises:
            LinkwrightError: the description cannot be read or expanded, or urdfdom would refuse it.
        """
        try:
            found = examine(self.path, arguments=self.values, packages=self.finder)
        except LinkwrightError as error:
            raise LinkwrightError(*map(self._relabelled, error.diagnostics)) from None
        if found.robot is None:
            raise LinkwrightError(*map(self._relabelled, found.diagnostics))
        return found

    def read_robot(self) -> Robot:
        """Return the robot; raises the same errors as `read`."""
        robot = self.read().robot
        assert robot is not None
        return robot

    def resolve(self, address: str) -> Path:
        """Return the file of a mesh's address.

        Raises:
            LinkwrightError: the package of the mesh is not found.
        """
        return self.finder.resolve(address, self.path.parent)

    def _relabelled(self, diagnostic: Diagnostic) -> Diagnostic:
        """Return a finding in which files of a commit are named as git names them."""
        if self.revision is None:
            return diagnostic
        notes = tuple(note._replace(span=self._span(note.span)) for note in diagnostic.notes)
        return diagnostic.with_changes(span=self._span(diagnostic.span), notes=notes)

    def _span(self, span: Span | None) -> Span | None:
        return None if span is None else span._replace(file=self.named(span.file))


@dataclass(frozen=True)
class Pair:
    """An old description and a new one.

    Attributes:
        old: the old description.
        new: the new description.
    """

    old: Model
    new: Model

    def close(self) -> None:
        """Remove the temporary files of a commit."""
        if self.old.revision is not None:
            self.old.revision.close()

    def label(self, file: str) -> str:
        """Return the name of a file of either description for users."""
        return self.old.named(file)

    def compared(self) -> Comparison:
        """Return the differences between the two descriptions.

        Raises:
            LinkwrightError: see `Model.read`.
        """
        return self.compare(self.old.read_robot(), self.new.read_robot())

    def compare(self, old: Robot, new: Robot) -> Comparison:
        """Return the differences between the robots of the two descriptions."""
        before, after = Side(old, resolve=self.old.resolve), Side(new, resolve=self.new.resolve)
        if self.old.revision is not None:
            ours, theirs = self.old.revision.normalizers(self.new.finder)
            before, after = replace(before, normalize=ours), replace(after, normalize=theirs)
        return compare(before, after)


def text_of_old(description: Description) -> str:
    """Return a text for the old description that differs from any new one.

    Descriptions are identified by their text.
    """
    return f"{description.text}\n<!-- the old one -->\n"


def pair_of(old: Path, new: Path, values: Mapping[str, str]) -> Pair:
    """Return a pair of two files.

    Args:
        old: the old file.
        new: the new file.
        values: the values for the ``<xacro:arg>`` of both.
    """
    first, second = (
        Model(path.absolute(), values, PackageFinder(start=[path.absolute().parent, Path.cwd()])) for path in (old, new)
    )
    return Pair(first, second)


def pair_with_commit(path: Path, commit: str, values: Mapping[str, str]) -> Pair:
    """Return the pair of a file's version in a commit and the file.

    The commit's files exist until the pair is closed.

    Raises:
        LinkwrightError: see `linkwright.descriptions.revisions.Revision`.
    """
    from linkwright.descriptions.revisions import Revision

    revision = Revision(path, commit)
    new = Model(path.absolute(), values, PackageFinder(start=[path.absolute().parent, Path.cwd()]))
    return Pair(Model(revision.path, values, revision.finder, revision), new)
