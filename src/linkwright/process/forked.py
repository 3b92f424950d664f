"""Python programs that are forked from a server process to save the time of imports.

The server process has already imported the modules that the programs need.
"""

from __future__ import annotations

import contextlib
import json
import os
import selectors
import signal
import socket
import subprocess
import sys
import threading
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Union

if TYPE_CHECKING:
    from typing_extensions import Self

_MODULE = "linkwright.process.fork_server"

IS_POSSIBLE = sys.platform == "linux"
"""Whether programs can be forked. Windows cannot fork, and numpy does not survive a fork on macOS."""

Streams = tuple[int, int, int]
"""The descriptors of a program's standard input, output and error."""


class ForkedProcess:
    """A program that a `ForkServer` has forked.

    It has the part of the interface of `subprocess.Popen` that does not depend on pipes.

    The program leads a session of its own.

    Attributes:
        args: the command line of the program.
        pid: the process ID of the program.
        returncode: its exit status, or minus the number of the signal that ended it; None while it runs.
    """

    returncode: int | None = None

    def __init__(self, args: Sequence[str], report: int) -> None:
        self.args = list(args)
        self._report = report
        self.pid = self._read_number()
        if self.pid < 0:  # the program was killed before it started
            self._end_server(self.pid)

    def __del__(self) -> None:
        if self.returncode is None:
            os.close(self._report)

    def poll(self) -> int | None:
        """Return the exit status, or None while the program runs."""
        if self.returncode is None and _is_readable(self._report, 0.0):
            self._end_server(self._read_number())
        return self.returncode

    def wait(self, timeout: float | None = None) -> int:
        """Wait until the program ends, and return its exit status.

        Raises:
            subprocess.TimeoutExpired: the program did not end within `timeout` seconds.
        """
        if self.returncode is None and not _is_readable(self._report, timeout):
            raise subprocess.TimeoutExpired(self.args, timeout or 0.0)
        status = self.poll()
        assert status is not None, "there was a report"
        return status

    def send_signal(self, number: int) -> None:
        """Send a signal unless the program has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL."""
        self.send_signal(signal.SIGKILL)

    def _read_number(self) -> int:
        from linkwright.process.fork_server import NUMBER_FORMAT

        data = os.read(self._report, NUMBER_FORMAT.size)
        number: int = NUMBER_FORMAT.unpack(data)[0] if data else -signal.SIGKILL  # the server was killed
        return number

    def _end_server(self, status: int) -> None:
        self.returncode = status
        os.close(self._report)


def _is_readable(descriptor: int, timeout: float | None) -> bool:
    with selectors.DefaultSelector() as selector:
        selector.register(descriptor, selectors.EVENT_READ)
        return bool(selector.select(timeout))


Program = Union[ForkedProcess, "subprocess.Popen[bytes]"]
"""A program that was forked or started afresh."""


def start_new_process(
    python: Sequence[str], module: str, words: Sequence[str], *, cwd: Path, env: Mapping[str, str], streams: Streams
) -> subprocess.Popen[bytes]:
    """Start ``python -m MODULE WORDS`` in a new process and a new session."""
    stdin, stdout, stderr = streams
    return subprocess.Popen(  # noqa: S603 - Linkwright's own command
        [*python, "-m", module, *words],
        cwd=cwd,
        env=env,
        stdin=stdin,
        stdout=stdout,
        stderr=stderr,
        start_new_session=True,
    )


class ForkServer:
    """A process from which programs are forked; it starts with the first program.

    Each program has its own environment, folder, standard streams, session, signals and exit status. It shares the
    modules, the search path and the hash seed of the server.

    Args:
        modules: the names of the modules to import; ``PACKAGE.*`` for a package and all its modules. With
            ``MODULE:FUNCTION``, a function is called, which must end the threads that it starts.
        python: the command that runs Python.
        variables: environment variables of the server itself.
    """

    def __init__(
        self,
        modules: Sequence[str],
        python: Sequence[str] = (sys.executable,),
        variables: Mapping[str, str] | None = None,
    ) -> None:
        self._modules = modules
        self._python = python
        self._variables = variables or {}
        self._lock = threading.Lock()
        self._control: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def prepare(self) -> None:
        """Start the server unless it is running, so that its imports finish early."""
        with self._lock:
            if IS_POSSIBLE:
                self._ensure_running()

    @property
    def is_ready(self) -> bool:
        """Whether the server has imported the modules, so that programs start immediately."""
        with self._lock:
            return self._control is not None and _is_readable(self._control.fileno(), 0.0)

    def start(
        self, module: str, words: Sequence[str], *, cwd: Path, env: Mapping[str, str], streams: Streams
    ) -> Program:
        """Start ``python -m MODULE WORDS``, from any thread.

        The program is forked if the system supports that. Otherwise, or if the server fails, the program is started in
        a new process.
        """
        if IS_POSSIBLE:
            with contextlib.suppress(OSError):
                return self._fork(module, words, cwd, env, streams)
        return start_new_process(self._python, module, words, cwd=cwd, env=env, streams=streams)

    def _fork(
        self, module: str, words: Sequence[str], cwd: Path, env: Mapping[str, str], streams: Streams
    ) -> ForkedProcess:
        request = {"module": module, "words": list(words), "folder": str(cwd), "environment": dict(env)}
        report, writer = os.pipe()
        try:
            self._send(json.dumps(request).encode(), [*streams, writer])
        except OSError:
            os.close(report)
            raise
        finally:
            os.close(writer)
        process = ForkedProcess(words, report)
        if process.pid < 0:
            raise ChildProcessError("the fork server could not fork")
        return process

    def _send(self, data: bytes, descriptors: Sequence[int]) -> None:
        """Send a request to the server."""
        with self._lock:
            socket.send_fds(self._ensure_running(), [data], list(descriptors))

    def _ensure_running(self) -> socket.socket:
        """Return the socket of the server, and start the server if it is not running."""
        if self._process is not None and self._process.poll() is not None:
            self._end_server()
        return self._control or self._start_server()

    def _start_server(self) -> socket.socket:
        control, server_end = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with server_end:
            self._process = subprocess.Popen(  # noqa: S603 - Linkwright's own command
                [*self._python, "-m", _MODULE, str(server_end.fileno()), *self._modules],
                cwd="/",  # a folder whose files hide no modules
                env={**os.environ, **self._variables},
                pass_fds=[server_end.fileno()],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,
            )
        self._control = control
        return control

    def close(self) -> None:
        """Stop the server.

        Running programs continue, but their exit statuses are no longer reported.
        """
        with self._lock:
            self._end_server()

    def _end_server(self) -> None:
        if self._control is not None and self._process is not None:
            self._control.close()
            self._process.terminate()  # The server may still be importing.
            self._process.wait()
            self._control = self._process = None
