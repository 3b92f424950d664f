"""The interfaces between a node and its host for reloading files when they are saved."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from linkwright.diagnostics import Diagnostic
    from linkwright.graph import Node


class ReadWorld(Protocol):
    """A world that was read from a file."""

    @property
    def path(self) -> Path:
        """The path of the world's file."""

    @property
    def files(self) -> tuple[Path, ...]:
        """All files from which the world was read, except its meshes."""

    @property
    def mesh_files(self) -> tuple[Path, ...]:
        """The files of the world's meshes."""

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings about the world."""

    @property
    def read_ns(self) -> int:
        """A time before the first file of the world was read, in nanoseconds since the epoch."""


class FileWatcher(Protocol):
    """A host that watches the files of its node.

    All methods are called on the event loop.
    """

    @property
    def launcher_node(self) -> Node:
        """The host's own node, through which it calls services."""

    def show(self, subject: str, findings: Iterable[Diagnostic]) -> None:
        """Replace the findings about a subject in the viewers."""

    def watch_world(
        self,
        world: ReadWorld,
        read: Callable[[str], ReadWorld],
        load: Callable[[str], Awaitable[Sequence[Diagnostic]]],
    ) -> None:
        """Watch the files of a world, and reload the world when one of them is saved.

        A world with new errors is not loaded.

        Args:
            world: the current world.
            read: reads the world's file, in another thread; raises LinkwrightError.
            load: makes the node load the file, and returns findings that replace the findings of reading.
        """

    def watch_text(self, text: str, name: str, on_text: Callable[[str], None]) -> None:
        """Watch the file from which this process expanded a description.

        Each new version of the description is passed on. If this process did not expand the description, do nothing.

        Args:
            text: the description.
            name: the name of the described object; one file is watched for each name.
            on_text: receives the new description; raises LinkwrightError if the description is invalid.
        """
