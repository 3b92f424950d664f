"""The guardian, which ends the processes of a launcher that was killed.

A launcher that is killed with SIGKILL cannot end its processes. A small helper program, the guardian, is therefore
started together with the first process. The guardian reads the process groups of the launch from a pipe that the
launcher holds open. If the pipe closes before the launcher has announced a normal end, the guardian ends the groups.
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
    """The launcher's side of the guardian, which does nothing on systems without process groups."""

    def __init__(self) -> None:
        self._identity = os.urandom(16).hex()
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False
        self._folder: Path | None = None

    def start_and_mark(self, environment: dict[str, str]) -> dict[str, str]:
        """Start the guardian if needed, and return the environment with the mark of the launch.

        The guardian finds the processes of the launch by this mark.
        """
        self._start()
        return {**environment, _MARK: self._identity}

    def watch(self, pid: int) -> None:
        """Register the process group whose leader has this process ID."""
        self._send(f"+{pid}\n")

    def register_folder(self, folder: Path) -> None:
        """Register a folder of temporary files to delete if the launcher is killed."""
        self._folder = folder
        self._send(f"={folder}\n")

    def release(self, pid: int) -> None:
        """Unregister a process group that has ended."""
        self._send(f"-{pid}\n")

    def close(self) -> None:
        """Announce that the launch ended normally, and wait for the guardian to exit."""
        self._closed = True
        process = self._process
        if process is None:
            return
        self._send(".\n")
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
        with contextlib.suppress(OSError):  # the launch continues without a guardian if it cannot start
            self._process = subprocess.Popen(  # noqa: S603 - Linkwright's own program
                [sys.executable, "-I", "-S", "-X", "utf8", str(_PROGRAM), f"{_MARK}={self._identity}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                cwd="/",
                start_new_session=True,
                bufsize=0,
            )
        if self._folder is not None:
            self.register_folder(self._folder)

    def _send(self, line: str) -> None:
        if self._process is not None and self._process.stdin is not None:
            with contextlib.suppress(OSError, ValueError):  # the guardian was killed
                self._process.stdin.write(line.encode())
