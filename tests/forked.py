"""Programs that tests start often, forked off a process that has imported what they need.

Tests of how a process starts, of what it imports and of what Python itself reads of its environment take
`start_process` or `subprocess`. Why: docs/decisions/0081-programs-of-tests-are-forked.md
"""

from __future__ import annotations

import json
import os
import select
import signal
import socket
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import IO

from tests.fork_server import NUMBER

ROOT = Path(__file__).resolve().parent.parent
IS_POSSIBLE = hasattr(os, "pidfd_open")
"""Whether the system can do it: Linux."""


class Forked:
    """A running ``python -m linkwright WORDS``, with the part of `subprocess.Popen` that tests use.

    Attributes:
        stdout: what it prints, standard error included, as text.
        returncode: its exit status once that is known, or minus the number of the signal that ended it.
    """

    stdout: IO[str]
    returncode: int | None = None

    def __init__(self, server: ForkServer, words: list[str], cwd: Path, env: Mapping[str, str]) -> None:
        self._server = server
        printed, prints = os.pipe()
        self._report, report = os.pipe()
        nothing = os.open(os.devnull, os.O_RDONLY)
        server.ask(words, cwd, env, [nothing, prints, prints, report])
        for descriptor in (nothing, prints, report):
            os.close(descriptor)
        self.stdout = os.fdopen(printed, encoding="utf-8")
        self.args = ["linkwright", *words]
        try:
            self.pid = self._read_number()
        except BaseException:
            self.stdout.close()
            os.close(self._report)
            raise

    def poll(self) -> int | None:
        """The exit status, or None while it runs."""
        if self.returncode is None and select.select([self._report], [], [], 0)[0]:
            self.returncode = self._read_number()
            os.close(self._report)
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end, and give the exit status.

        Raises:
            subprocess.TimeoutExpired: when it did not end within that many seconds.
        """
        if self.returncode is None and not select.select([self._report], [], [], timeout)[0]:
            raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
        status = self.poll()
        assert status is not None
        return status

    def send_signal(self, number: int) -> None:
        """Send a signal unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL."""
        self.send_signal(signal.SIGKILL)

    def _read_number(self) -> int:
        result = os.read(self._report, NUMBER.size)
        assert result, f"the fork server has ended: {self._server.close()}"
        number: int = NUMBER.unpack(result)[0]
        return number


Program = Forked | subprocess.Popen[str]


def start_process(words: list[str], *, cwd: Path, env: Mapping[str, str]) -> Program:
    """A ``python -m linkwright WORDS`` that reads nothing and prints into one pipe."""
    return subprocess.Popen(
        [sys.executable, "-m", "linkwright", *words],
        cwd=cwd,
        env=env,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        encoding="utf-8",
    )


class ForkServer:
    """The process that programs are forked off; it starts with the first of them."""

    def __init__(self) -> None:
        self._process: subprocess.Popen[bytes] | None = None

    def start(self, words: list[str], *, cwd: Path, env: Mapping[str, str]) -> Program:
        """The same as `start_process`, forked off where the system can do that."""
        return Forked(self, words, cwd, env) if IS_POSSIBLE else start_process(words, cwd=cwd, env=env)

    def ask(self, words: list[str], cwd: Path, env: Mapping[str, str], descriptors: list[int]) -> None:
        """Send what `tests.fork_server.Request` has."""
        if self._process is None:
            self._control, far = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
            with far:
                self._process = subprocess.Popen(
                    [sys.executable, "-m", "tests.fork_server", str(far.fileno())],
                    cwd=ROOT,
                    env={**os.environ, "PYTHONUNBUFFERED": "1"},
                    pass_fds=[far.fileno()],
                    # Of the kind that its programs get, as Python looks at them only once.
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.STDOUT,
                )
        request = {"words": words, "folder": str(cwd), "environment": dict(env)}
        socket.send_fds(self._control, [json.dumps(request).encode()], descriptors)

    def close(self) -> str:
        """End the process and tell what it printed; programs that run go on."""
        if self._process is None:
            return ""
        self._control.close()
        printed, _ = self._process.communicate()
        self._process = None
        return printed.decode(errors="replace")
