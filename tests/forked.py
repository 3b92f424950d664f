"""Programs that tests start often, forked from a process that has imported their modules.

Tests of the start of a process, of its imports, and of the environment variables that Python itself reads use
`start_process` or `subprocess`. The reason is in docs/decisions/0081-programs-of-tests-are-forked.md.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import IO

from linkwright.process import forked

_IMPORTED = (
    "linkwright.cli.command",
    "linkwright.cli.view",
    "linkwright.cli.launch.*",
    "linkwright.cli.sim.*",
    "linkwright.bag.*",
    "linkwright.hosting.*",
    "linkwright.inertia.*",
    "linkwright.messages.*",
    "linkwright.nodes.joint_state_publisher_gui",
    "linkwright.nodes.robot_state_publisher",
    "linkwright.simulation.nodes.simulator",
    "linkwright.packages.*",
    "linkwright.page.*",
    "linkwright.panels.*",
    "linkwright.rviz.*",
    "linkwright.viewer.*",
    "aiohttp.web",
    "encodings.idna",
    "watchfiles",
)


@dataclass
class Program:
    """A running ``python -m linkwright WORDS``; it has no input, and prints to one pipe.

    Attributes:
        process: the forked or new process.
        stdout: the output as text, including standard error.
    """

    process: forked.Program
    stdout: IO[str]

    @property
    def pid(self) -> int:
        return self.process.pid

    def poll(self) -> int | None:
        """Return the exit status, or None while it runs."""
        return self.process.poll()

    def wait(self, timeout: float | None = None) -> int:
        """Wait for the end of the process, and return its exit status.

        Raises:
            subprocess.TimeoutExpired: the process did not end within `timeout` seconds.
        """
        return self.process.wait(timeout)

    def send_signal(self, number: int) -> None:
        """Send a signal unless the process has ended."""
        self.process.send_signal(number)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self.process.terminate()

    def kill(self) -> None:
        """Send SIGKILL."""
        self.process.kill()


def start_process(words: list[str], *, cwd: Path, env: Mapping[str, str]) -> Program:
    """Start a program that imports everything itself."""
    return _start(partial(forked.start_new_process, [sys.executable]), words, cwd, env)


class ForkServer:
    """The process from which programs are forked; it starts with the first program."""

    def __init__(self) -> None:
        self._server = forked.ForkServer(_IMPORTED, variables={"PYTHONUNBUFFERED": "1"})

    def start(self, words: list[str], *, cwd: Path, env: Mapping[str, str]) -> Program:
        """Start a program as `start_process` does, but forked where the system supports that."""
        return _start(self._server.start, words, cwd, env)

    def close(self) -> None:
        """End the process; running programs continue."""
        self._server.close()


def _start(start: Callable[..., forked.Program], words: list[str], cwd: Path, env: Mapping[str, str]) -> Program:
    reader, writer = os.pipe()
    with Path(os.devnull).open("rb") as null_device, os.fdopen(writer, "wb"):
        process = start("linkwright", words, cwd=cwd, env=env, streams=(null_device.fileno(), writer, writer))
    return Program(process, os.fdopen(reader, encoding="utf-8"))
