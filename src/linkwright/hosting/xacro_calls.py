"""Descriptions and worlds from files, with the file and the arguments of each text."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.descriptions import Description, DescriptionLibrary
    from linkwright.nodes.watched_files import ReadWorld
    from linkwright.urdf import Collision, Robot, Visual


@dataclass(frozen=True)
class XacroCall:
    """A call of xacro: a description file and its arguments.

    Attributes:
        path: the absolute path of the description file.
        arguments: pairs of the name and value of an argument.
    """

    path: Path
    arguments: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class WorldCall(XacroCall):
    """The file of a simulated world, which is read like a description.

    Attributes:
        read: reads the world from a path; raises LinkwrightError if the file is not valid.
    """

    read: Callable[[str], ReadWorld] = field(kw_only=True, compare=False, repr=False)


class DescriptionError(LinkwrightError):
    """Raised when a description file cannot be expanded.

    Attributes:
        call: the xacro call that failed.
    """

    def __init__(self, call: XacroCall, diagnostics: Iterable[Diagnostic]) -> None:
        super().__init__(*diagnostics)
        self.call = call

    @property
    def is_missing(self) -> bool:
        """Whether the description file itself cannot be read.

        Editing the file cannot fix this.
        """
        return not self.call.path.is_file() or not os.access(self.call.path, os.R_OK)


class Descriptions:
    """A store that expands description files and keeps the results with their source locations.

    Args:
        finder: the finder of ROS packages.
        reads_unsaved: whether descriptions are read with the unsaved texts of editors.
    """

    def __init__(self, finder: PackageFinder, *, reads_unsaved: bool = False) -> None:
        self.finder = finder
        self.reads_unsaved = reads_unsaved
        self._warnings: dict[XacroCall, tuple[Diagnostic, ...]] = {}
        self._read_ns: dict[XacroCall, int] = {}
        self._calls: dict[str, XacroCall] = {}
        self._files: dict[XacroCall, tuple[Path, ...]] = {}
        self._robots: dict[XacroCall, Robot] = {}
        self._worlds: dict[XacroCall, ReadWorld] = {}
        self._meshes: dict[XacroCall, tuple[Path, ...]] = {}
        self._known_findings: set[tuple[str, str]] = set()
        self._library: DescriptionLibrary | None = None

    @property
    def unsaved_texts(self) -> Mapping[str | os.PathLike[str], str]:
        """The unsaved texts with which descriptions are read, by the real paths of their files."""
        return self.library.unsaved_texts if self.reads_unsaved else {}

    @property
    def library(self) -> DescriptionLibrary:
        """The library from which the nodes and the viewer read descriptions."""
        if self._library is None:
            from linkwright.descriptions import DescriptionLibrary

            self._library = DescriptionLibrary()
        return self._library

    def expand(self, call: XacroCall) -> str:
        """Expand a description, store it in the library, and return its text.

        Raises:
            DescriptionError: the file, or an included file, has errors.
        """
        return self.store(call, self.read(call))

    def register_world(self, world: ReadWorld, read: Callable[[str], ReadWorld]) -> WorldCall:
        """Store a world that has already been read, and return its call.

        The findings about this world are not reported again.

        Args:
            world: the world as it was read.
            read: reads the world again from its path.
        """
        call = WorldCall(world.path.absolute(), read=read)
        self._read_ns[call] = world.read_ns
        self._known_findings |= {_create_finding_key(diagnostic) for diagnostic in world.diagnostics}
        self._set_world(call, world)
        return call

    def _set_world(self, call: WorldCall, world: ReadWorld) -> None:
        self._files[call], self._worlds[call] = world.files, world
        self._meshes.pop(call, None)

    def read(self, call: XacroCall) -> Any:
        """Read a description or world from its file and return it, without storing it.

        Returns:
            The `Description` of a robot, or the `ReadWorld` of a world.

        Raises:
            DescriptionError: the file, or an included file, has errors; with the findings about the parts that could
                be read. For a world, only errors that it did not have at the start are raised.
        """
        if isinstance(call, WorldCall):
            return self._read_world(call)
        from linkwright.descriptions import examine
        from linkwright.xmltree import Overlay

        self.record_read_time(call)
        try:
            xacro = None if call.path.suffix == ".sdf" else True  # SDF models are accepted too.
            description = examine(
                call.path,
                arguments=dict(call.arguments),
                packages=self.finder,
                overlay=Overlay(texts) if (texts := self.unsaved_texts) else None,
                xacro=xacro,
                partly=True,
            )
        except LinkwrightError as error:
            raise DescriptionError(call, error.diagnostics) from error
        if description.problems:
            raise DescriptionError(call, description.diagnostics)
        return description

    def record_read_time(self, call: XacroCall) -> None:
        """Record the current time as the start of reading a description's files."""
        self._read_ns[call] = time.time_ns()

    def store(self, call: XacroCall, description: Description, text: str | None = None) -> str:
        """Store a description, and return the text that identifies it.

        By default, this is the description's own text.
        """
        text = self.library.store(description, text, self.finder)
        self._files[call] = description.files
        self._calls[text] = call
        self._warnings[call] = description.remarks
        if description.robot is not None:
            self._robots[call] = description.robot
            self._meshes.pop(call, None)
        return text

    def store_result(self, call: XacroCall, description: Any) -> tuple[str | None, tuple[Diagnostic, ...]]:
        """Store the result of `read`, and return its text and findings.

        For a world, the text is the path of its file. The text is None if the description has no robot.
        """
        if isinstance(call, WorldCall):
            self._set_world(call, description)
            return str(call.path), self._find_new_findings(description.diagnostics)
        text = self.store(call, description)
        return (None if description.robot is None else text), description.diagnostics

    def find_call(self, text: str) -> XacroCall | None:
        """Return the call from which a text was expanded, or None if it was not expanded here."""
        return self._calls.get(text)

    def get_warnings(self, call: XacroCall) -> tuple[Diagnostic, ...]:
        """Return the warnings of the last successful expansion of a call.

        The result is empty before the first successful expansion.
        """
        return self._warnings.get(call, ())

    def read_ns(self, call: XacroCall) -> int:
        """Return the time at which a call's files were last read, in nanoseconds since the epoch.

        The time is 0 if the files have not been read.
        """
        return self._read_ns.get(call, 0)

    def get_files(self, call: XacroCall) -> tuple[Path, ...]:
        """Return the files that the last successful expansion of a call read, and its mesh files.

        Before the first successful expansion, the result is only the description file.
        """
        if call in self._robots and call not in self._meshes:
            self._meshes[call] = _find_mesh_files(self._robots[call], self.finder, call.path.parent)
        if call in self._worlds and call not in self._meshes:
            self._meshes[call] = self._worlds[call].mesh_files
        return (*self._files.get(call, (call.path,)), *self._meshes.get(call, ()))

    def _read_world(self, call: WorldCall) -> ReadWorld:
        self.record_read_time(call)
        world = call.read(str(call.path))
        errors = [
            diagnostic
            for diagnostic in self._find_new_findings(world.diagnostics)
            if diagnostic.severity is Severity.ERROR
        ]
        if errors:
            raise DescriptionError(call, errors)
        return world

    def _find_new_findings(self, findings: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        return tuple(finding for finding in findings if _create_finding_key(finding) not in self._known_findings)


def _find_mesh_files(robot: Robot, finder: PackageFinder, folder: Path) -> tuple[Path, ...]:
    """Return the mesh files of a robot that exist, without duplicates."""
    from linkwright.urdf import Mesh

    mesh_files: dict[Path, None] = {}
    for link in robot.links.values():
        geometries: list[Visual | Collision] = [*link.visuals, *link.collisions]
        for geometry in geometries:
            if isinstance(geometry.geometry, Mesh):
                source = None if geometry.element is None else geometry.element.source
                base_folder = folder if source is None else Path(source.name).absolute().parent
                with suppress(LinkwrightError, ValueError):
                    mesh_files[finder.resolve(geometry.geometry.filename, base_folder)] = None
    return tuple(path for path in mesh_files if path.is_file())


def _create_finding_key(finding: Diagnostic) -> tuple[str, str]:
    return finding.code, str(finding.message)


_current_descriptions: ContextVar[Descriptions | None] = ContextVar("linkwright_descriptions", default=None)


def current_descriptions() -> Descriptions | None:
    """Return the descriptions of the current launch, or None outside of a launch.

    This function is for code that has no access to the launch.
    """
    return _current_descriptions.get()


@contextmanager
def use_descriptions(descriptions: Descriptions) -> Iterator[None]:
    """Make `current_descriptions` return the given descriptions in a ``with`` block."""
    token = _current_descriptions.set(descriptions)
    try:
        yield
    finally:
        _current_descriptions.reset(token)
