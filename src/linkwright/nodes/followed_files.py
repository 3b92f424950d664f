"""Files that a hosted node takes again when they are saved: what the node and its host ask of each other."""

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
        """The file."""

    @property
    def files(self) -> tuple[Path, ...]:
        """All files that it was made of, without its meshes."""

    @property
    def mesh_files(self) -> tuple[Path, ...]:
        """The files of its meshes."""

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """The findings about it."""

    @property
    def read_ns(self) -> int:
        """Before when none of its files was read, in nanoseconds since the epoch."""


class FileFollower(Protocol):
    """The host of a node, which watches files; its methods are called on the event loop."""

    @property
    def launcher_node(self) -> Node:
        """A node of the host, with which services are called."""

    def show(self, about: str, findings: Iterable[Diagnostic]) -> None:
        """Show the current findings about a subject in the viewers."""

    def follow_world(
        self,
        world: ReadWorld,
        read: Callable[[str], ReadWorld],
        load: Callable[[str], Awaitable[Sequence[Diagnostic]]],
    ) -> None:
        """Read the file of a world when it is saved, and load it if it has no new errors.

        Args:
            world: the world as it is now.
            read: reads the file in another thread; raises LinkwrightError.
            load: has the node load the file; returns findings to report in place of those of reading.
        """

    def follow_text(self, text: str, name: str, renew: Callable[[str], None]) -> None:
        """Call back with each new text of a description, if this process expanded it from a file.

        Args:
            text: the description.
            name: what it describes; a file is followed once for each name.
            renew: takes the new text; raises LinkwrightError if it is wrong.
        """
