"""The common interface of pseudoterminals on all systems."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol


@dataclass(frozen=True, slots=True)
class TerminalSize:
    """The size of a terminal in characters."""

    columns: int
    rows: int


@dataclass(frozen=True, slots=True)
class TerminalProgram:
    """A program to run in a terminal.

    Attributes:
        command: the absolute path of the program, and its arguments.
        folder: the working directory.
        environment: the environment variables.
    """

    command: Sequence[str]
    folder: Path
    environment: Mapping[str, str]


class Pty(Protocol):
    """A program in a pseudoterminal.

    All methods except `wait_until_ended` are called on the event loop.

    Output is read only on request, so that a program cannot write more than its reader can handle.
    """

    @property
    def unwritten_size(self) -> int:
        """The size in bytes of the input that the program has not read yet."""

    def request_output(self) -> None:
        """Request the next block of output. It is passed to `receive` when it is available."""

    def write(self, data: bytes) -> None:
        """Write input for the program, which may read the input later."""

    def resize(self, size: TerminalSize) -> None:
        """Set the size of the terminal, and notify the program."""

    def hang_up(self) -> None:
        """Close the terminal.

        The program and its children receive SIGHUP, or its equivalent on the system.
        """

    def wait_until_ended(self, grace: float) -> None:
        """Wait after `hang_up` until all processes have ended, and kill them after `grace` seconds."""


OutputCallback = Callable[[bytes], object]
"""A callback on the event loop for a block of output."""

ExitCallback = Callable[[int], object]
"""Handles the end of the program, after all its output, on the event loop.

Its argument is the exit status, or the negative number of the signal that ended the program.
"""
