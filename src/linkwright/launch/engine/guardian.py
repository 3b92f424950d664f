"""Ending the processes of a launcher that was killed.

A launcher that is killed with SIGKILL cannot end its processes. So a small program of its own is started with the first
of them: it holds the other end of a pipe, knows the process groups, and ends them when the pipe ends unannounced.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from pathlib import Path

_PROGRAM = Path(__file__).with_name("guardian_program.py")
_MARK = "LINKWRIGHT_LAUNCH"
_END_SECONDS = 2.0


class Guardian:
    """The launcher's side of the guardian. Where the system has no process groups it does nothing."""

    def __init__(self) -> None:
        self._identity = os.urandom(16).hex()
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False
        self._folder: Path | None = None

    def marked(self, environment: dict[str, str]) -> dict[str, str]:
        """The environment for a process that the guardian is to find; starts the guardian."""
        self._start()
        return {**environment, _MARK: self._identity}

    def watch(self, pid: int) -> None:
        """Take charge of the process group that a process leads."""
        self._tell(f"+{pid}\n")

    def owns(self, folder: Path) -> None:
        """Take charge of a folder of temporary files too."""
        self._folder = folder
        self._tell(f"={folder}\n")

    def release(self, pid: int) -> None:
        """Forget a group that is gone."""
        self._tell(f"-{pid}\n")

    def close(self) -> None:
        """Say that all is in order, and wait until the guardian has gone."""
        self._closed = True
        process = self._process
        if process is None:
            return
        self._tell(".\n")
        assert process.stdin is not None
        with contextlib.suppress(OSError):
            process.stdin.close()
        try:
            process.wait(_END_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        self._process = None

    def _start(self) -> None:
        if self._process is not None or self._closed or not hasattr(os, "killpg"):
            return
        with contextlib.suppress(OSError):  # the launch goes on without, as it would have without us
            self._process = subprocess.Popen(  # noqa: S603 - our own program
                [sys.executable, "-I", "-S", "-X", "utf8", str(_PROGRAM), f"{_MARK}={self._identity}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                start_new_session=True,
                bufsize=0,
            )
        if self._folder is not None:
            self.owns(self._folder)

    def _tell(self, line: str) -> None:
        if self._process is not None and self._process.stdin is not None:
            with contextlib.suppress(OSError, ValueError):  # it has ended: somebody killed it
                self._process.stdin.write(line.encode())
