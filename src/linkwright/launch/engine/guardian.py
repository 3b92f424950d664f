"""The guardian: a helper that ends a launch's processes if its launcher is killed.

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
_MARK_VARIABLE = "LINKWRIGHT_LAUNCH"
_EXIT_TIMEOUT_S = 2.0


class Guardian:
    """The launcher's interface to the guardian.

    It has no effect on systems without process groups.
    """

    def __init__(self) -> None:
        self._mark_value = os.urandom(16).hex()
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = False
        self._folder: Path | None = None

    def start_and_mark(self, environment: dict[str, str]) -> dict[str, str]:
        """Start the guardian if needed, and return an environment with the mark of the launch.

        The guardian recognizes the processes of the launch by this mark.
        """
        self._start()
        return {**environment, _MARK_VARIABLE: self._mark_value}

    def watch(self, pid: int) -> None:
        """Register the process group of a leader, to be ended if the launcher is killed."""
        self._send(f"+{pid}\n")

    def register_folder(self, folder: Path) -> None:
        """Register a folder of temporary files, to be deleted if the launcher is killed."""
        self._folder = folder
        self._send(f"={folder}\n")

    def release(self, pid: int) -> None:
        """Unregister a process group that has ended."""
        self._send(f"-{pid}\n")

    def close(self) -> None:
        """Notify the guardian of the normal end of the launch, and wait for the guardian to exit."""
        self._closed = True
        process = self._process
        if process is None:
            return
        self._send(".\n")
        assert process.stdin is not None
        with contextlib.suppress(OSError):
            process.stdin.close()
        try:
            process.wait(_EXIT_TIMEOUT_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        self._process = None

    def _start(self) -> None:
        if self._process is not None or self._closed or not hasattr(os, "killpg"):
            return
        with contextlib.suppress(OSError):  # the launch continues without a guardian if it cannot start
            self._process = subprocess.Popen(  # noqa: S603 - Linkwright's own program
                [sys.executable, "-I", "-S", "-X", "utf8", str(_PROGRAM), f"{_MARK_VARIABLE}={self._mark_value}"],
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
