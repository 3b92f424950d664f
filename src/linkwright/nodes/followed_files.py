"""Interfaces of a node and its host for files that the node reloads when they are saved."""

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
        """A time, in nanoseconds since the epoch, before which none of the world's files was read."""


class FileFollower(Protocol):
    """The host of a node, which watches files; its methods are called on the event loop."""

    @property
    def launcher_node(self) -> Node:
        """A node of the host with which services are called."""

    def show(self, about: str, findings: Iterable[Diagnostic]) -> None:
        """Show the current findings about a subject in the viewers."""

    def follow_world(
        self,
        world: ReadWorld,
        read: Callable[[str], ReadWorld],
        load: Callable[[str], Awaitable[Sequence[Diagnostic]]],
    ) -> None:
        """Watch the file of a world: read it when it is saved, and load it if it has no new errors.

        Args:
            world: the current world.
            read: reads the file in another thread; raises LinkwrightError.
            load: has the node load the file; returns findings that replace those of reading.
        """

    def follow_text(self, text: str, name: str, renew: Callable[[str], None]) -> None:
        """Call back with each new text of a description, if this process expanded it from a file.

        Args:
            text: the description.
            name: the name of the described object; one file is watched for each name.
            renew: receives the new text; raises LinkwrightError if it is invalid.
        """
