"""Descriptions and worlds from files, with the file and arguments of each expanded text."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity
from linkwright.packages import PackageFinder

if TYPE_CHECKING:
    from linkwright.descriptions import Description, DescriptionLibrary
    from linkwright.nodes.followed_files import ReadWorld
    from linkwright.urdf import Collision, Robot, Visual


@dataclass(frozen=True)
class XacroCall:
    """A use of xacro: a model file and arguments.

    Attributes:
        path: the model file, absolute.
        arguments: name and value of the given arguments.
    """

    path: Path
    arguments: tuple[tuple[str, str], ...] = ()


@dataclass(frozen=True)
class WorldCall(XacroCall):
    """The file of a simulated world.

    Attributes:
        read: reads the file; raises LinkwrightError.
    """

    read: Callable[[str], ReadWorld] = field(kw_only=True, compare=False, repr=False)


class DescriptionError(LinkwrightError):
    """Raised when a model file cannot be expanded.

    Attributes:
        call: the use of xacro.
    """

    def __init__(self, call: XacroCall, diagnostics: Iterable[Diagnostic]) -> None:
        super().__init__(*diagnostics)
        self.call = call

    @property
    def missing(self) -> bool:
        """Whether the model file itself cannot be read, an error that no edit of the file can fix."""
        return not self.call.path.is_file() or not os.access(self.call.path, os.R_OK)


class Descriptions:
    """Expands model files, and stores the results with their source positions.

    Args:
        finder: finds packages.
    """

    def __init__(self, finder: PackageFinder) -> None:
        self.finder = finder
        self._warnings: dict[XacroCall, tuple[Diagnostic, ...]] = {}
        self._read_ns: dict[XacroCall, int] = {}
        self._calls: dict[str, XacroCall] = {}
        self._files: dict[XacroCall, tuple[Path, ...]] = {}
        self._robots: dict[XacroCall, Robot] = {}
        self._worlds: dict[XacroCall, ReadWorld] = {}
        self._meshes: dict[XacroCall, tuple[Path, ...]] = {}
        self._known: set[tuple[str, str]] = set()
        self._library: DescriptionLibrary | None = None

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
            DescriptionError: the errors of the file, or of an included file.
        """
        return self.store(call, self.read(call))

    def begin_with(self, world: ReadWorld, read: Callable[[str], ReadWorld]) -> WorldCall:
        """Store a world that was already read, and return its call.

        The findings of this world are not reported again.

        Args:
            world: the world.
            read: reads the world again.
        """
        call = WorldCall(world.path.absolute(), read=read)
        self._read_ns[call] = world.read_ns
        self._known |= {_essence(diagnostic) for diagnostic in world.diagnostics}
        self._set_world(call, world)
        return call

    def _set_world(self, call: WorldCall, world: ReadWorld) -> None:
        self._files[call], self._worlds[call] = world.files, world
        self._meshes.pop(call, None)

    def read(self, call: XacroCall) -> Any:
        """Expand and read a file without storing anything; may run in another thread.

        Returns:
            The `Description` of a robot, or the `ReadWorld` of a world.

        Raises:
            DescriptionError: the errors of the file, or of an included file, with the findings of the parts that could
                be read; for a world, only errors that the world did not have at the start.
        """
        if isinstance(call, WorldCall):
            return self._read_world(call)
        from linkwright.descriptions import examine

        self.begin(call)
        try:
            xacro = None if call.path.suffix == ".sdf" else True  # SDF models are accepted too.
            found = examine(call.path, arguments=dict(call.arguments), packages=self.finder, xacro=xacro, partly=True)
        except LinkwrightError as error:
            raise DescriptionError(call, error.diagnostics) from error
        if found.problems:
            raise DescriptionError(call, found.diagnostics)
        return found

    def begin(self, call: XacroCall) -> None:
        """Record the time before the files of a model are read."""
        self._read_ns[call] = time.time_ns()

    def store(self, call: XacroCall, description: Description, text: str | None = None) -> str:
        """Store a description, and return the text that identifies it: `text`, or by default its own text."""
        text = self.library.store(description, text, self.finder)
        self._files[call] = description.files
        self._calls[text] = call
        self._warnings[call] = description.remarks
        if description.robot is not None:
            self._robots[call] = description.robot
            self._meshes.pop(call, None)
        return text

    def take(self, call: XacroCall, description: Any) -> tuple[str | None, tuple[Diagnostic, ...]]:
        """Store the result of `read`, and return its text and the findings about it.

        The text of a world is the path of its file. The text is None if the description has no robot.
        """
        if isinstance(call, WorldCall):
            self._set_world(call, description)
            return str(call.path), self._new(description.diagnostics)
        text = self.store(call, description)
        return (None if description.robot is None else text), description.diagnostics

    def call_of(self, text: str) -> XacroCall | None:
        """Return the call that resulted in a text, or None if the text was not expanded here."""
        return self._calls.get(text)

    def warnings_of(self, call: XacroCall) -> tuple[Diagnostic, ...]:
        """Return the warnings of a call's last successful expansion; empty before it."""
        return self._warnings.get(call, ())

    def read_ns(self, call: XacroCall) -> int:
        """Return the time in nanoseconds since the epoch at which the files of a call were last read.

        The time is 0 if they were never read.
        """
        return self._read_ns.get(call, 0)

    def files_of(self, call: XacroCall) -> tuple[Path, ...]:
        """Return the files that the last successful expansion read, and the robot's or world's mesh files.

        Before the first successful expansion, return only the model file.
        """
        if call in self._robots and call not in self._meshes:
            self._meshes[call] = _mesh_files(self._robots[call], self.finder, call.path.parent)
        if call in self._worlds and call not in self._meshes:
            self._meshes[call] = self._worlds[call].mesh_files
        return (*self._files.get(call, (call.path,)), *self._meshes.get(call, ()))

    def _read_world(self, call: WorldCall) -> ReadWorld:
        self.begin(call)
        loaded = call.read(str(call.path))
        wrong = [diagnostic for diagnostic in self._new(loaded.diagnostics) if diagnostic.severity is Severity.ERROR]
        if wrong:
            raise DescriptionError(call, wrong)
        return loaded

    def _new(self, findings: tuple[Diagnostic, ...]) -> tuple[Diagnostic, ...]:
        return tuple(finding for finding in findings if _essence(finding) not in self._known)


def _mesh_files(robot: Robot, finder: PackageFinder, folder: Path) -> tuple[Path, ...]:
    """Return the existing mesh files of a robot, without duplicates."""
    from linkwright.urdf import Mesh

    found: dict[Path, None] = {}
    for link in robot.links.values():
        parts: list[Visual | Collision] = [*link.visuals, *link.collisions]
        for part in parts:
            if isinstance(part.geometry, Mesh):
                source = None if part.element is None else part.element.source
                base = folder if source is None else Path(source.name).absolute().parent
                with suppress(LinkwrightError, ValueError):
                    found[finder.resolve(part.geometry.filename, base)] = None
    return tuple(path for path in found if path.is_file())


def _essence(finding: Diagnostic) -> tuple[str, str]:
    return finding.code, str(finding.message)


_current: ContextVar[Descriptions | None] = ContextVar("linkwright_descriptions", default=None)


def current_descriptions() -> Descriptions | None:
    """Return the descriptions of the current launch, or None if there is none.

    Code without access to the launch uses this function.
    """
    return _current.get()


@contextmanager
def use_descriptions(descriptions: Descriptions) -> Iterator[None]:
    """Make `current_descriptions` return these descriptions inside a ``with`` block."""
    token = _current.set(descriptions)
    try:
        yield
    finally:
        _current.reset(token)
