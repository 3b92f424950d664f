"""A server process that imports modules in advance, and forks for each program.

Run as ``python -m linkwright.process.fork_server FD NAME...``, where FD is a socket of `linkwright.process.forked` and
each NAME is a module, ``PACKAGE.*`` for all in a package, or ``MODULE:FUNCTION`` to call a function. The process ends
when the socket is closed. Running programs continue.
"""

from __future__ import annotations

import atexit
import contextlib
import gc
import importlib
import json
import os
import pkgutil
import runpy
import selectors
import signal
import socket
import struct
import sys
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

MAX_REQUEST_BYTES = 1 << 17
"""The maximum size of a request in bytes. A request is one datagram."""

NUMBER_FORMAT = struct.Struct("q")
"""The format of reports: first the process ID, then the exit status. A status alone is that of a program that never
started."""


@dataclass
class Request:
    """A requested program, and the files that it receives."""

    module: str
    words: list[str]
    folder: str
    environment: dict[str, str]
    streams: list[int]
    """The descriptors of standard input, output and error."""
    report: int
    """The descriptor of the pipe for the reports."""


@dataclass
class _Server:
    """The server, which handles requests and the ends of programs in a loop."""

    control: socket.socket
    reports: dict[int, int] = field(default_factory=dict)
    """The report pipe of each running program, by process ID."""

    def __post_init__(self) -> None:
        self._wake_reader, self._wake_writer = socket.socketpair()
        self._wake_reader.setblocking(False)
        self._wake_writer.setblocking(False)
        self._selector = selectors.DefaultSelector()
        self._selector.register(self.control, selectors.EVENT_READ)
        self._selector.register(self._wake_reader, selectors.EVENT_READ)

    def serve(self) -> Request | None:
        """Fork for each request, and return the request in the new process.

        In the server, the result is None when its socket is closed.
        """
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(self._wake_writer.fileno(), warn_on_full_buffer=False)
        while True:
            for key, _ in self._selector.select():
                if key.fileobj is self._wake_reader:
                    self._report_ends()
                    continue
                request = _receive(self.control)
                if request is None or self._fork(request):
                    return request

    def _fork(self, request: Request) -> bool:
        """Fork, and return whether this is the new process."""
        try:
            with warnings.catch_warnings():
                # Since 3.12, Python warns of threads. Those of numpy wait, and its library restarts them after a fork.
                warnings.simplefilter("ignore", DeprecationWarning)
                pid = os.fork()
        except OSError:  # too many processes: the client sees the end of the pipe
            pid = -1
        if pid == 0:
            self._close_server_files()
            return True
        for stream in request.streams:
            os.close(stream)
        if pid > 0:
            self.reports[pid] = request.report
        else:
            os.close(request.report)
        return False

    def _report_ends(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._wake_reader.recv(4096)
        with contextlib.suppress(ChildProcessError):
            while True:
                pid, status = os.waitpid(-1, os.WNOHANG)
                if pid == 0:
                    return
                report = self.reports.pop(pid)
                with contextlib.suppress(BrokenPipeError):  # the client no longer waits for the program
                    os.write(report, NUMBER_FORMAT.pack(os.waitstatus_to_exitcode(status)))
                os.close(report)

    def _close_server_files(self) -> None:
        """Close the files of the server in a new process."""
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        self._selector.close()
        for resource in (self.control, self._wake_reader, self._wake_writer):
            resource.close()
        for report in self.reports.values():
            os.close(report)


def _receive(control: socket.socket) -> Request | None:
    data, descriptors, _, _ = socket.recv_fds(control, MAX_REQUEST_BYTES, 4)
    if not data:
        return None
    requested: dict[str, Any] = json.loads(data)
    *streams, report = descriptors
    return Request(**requested, streams=streams, report=report)


def _run_program(request: Request) -> None:
    """Run ``python -m MODULE WORDS`` in this process, in a session of its own."""
    os.setsid()
    os.write(request.report, NUMBER_FORMAT.pack(os.getpid()))
    os.close(request.report)
    for descriptor, stream in enumerate(request.streams):
        os.dup2(stream, descriptor)
        os.close(stream)
    importlib.invalidate_caches()
    os.chdir(request.folder)
    os.environ.clear()
    os.environ.update(request.environment)
    sys.path[0] = request.folder
    sys.argv[1:] = request.words
    _forget_random_numbers()
    try:
        runpy.run_module(request.module, run_name="__main__", alter_sys=True)
    except SystemExit as end:
        atexit.register(_end_without_cleanup, end.code)
        raise
    atexit.register(_end_without_cleanup, None)


def _end_without_cleanup(code: object) -> None:
    """End the process as Python does, except that the objects of modules are not freed.

    Freeing them would write to all the shared memory, and thereby copy it: ten times the work of a short program. A
    file that the program has not closed may be incomplete.
    """
    atexit.unregister(_end_without_cleanup)
    atexit._run_exitfuncs()  # the handlers that were registered earlier
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError, ValueError):
            stream.flush()
    os._exit(code if isinstance(code, int) else int(code is not None))


def _forget_random_numbers() -> None:
    """Seed numpy's global generator, as an import does.

    Python itself seeds the generator of `random` after a fork.
    """
    numbers = sys.modules.get("numpy.random")
    if numbers is not None:
        numbers.seed()


def _import_all(names: Sequence[str]) -> None:
    """Import modules, and skip those that cannot be imported.

    A program that needs a skipped module reports why it is missing.
    """
    for name in names:
        package = name.removesuffix(".*")
        _import(package)
        for inner in _find_inner_modules(package) if name != package else ():
            _import(inner)


def _call_all(names: Sequence[str]) -> None:
    """Call functions ``MODULE:FUNCTION``, and ignore failures. A program then does itself what a function prepares."""
    for name in names:
        module, _, function = name.partition(":")
        with contextlib.suppress(Exception):
            getattr(importlib.import_module(module), function)()


def _freeze() -> None:
    gc.collect()
    gc.freeze()  # collecting garbage would write to shared memory, and thereby copy it


def _import(name: str) -> None:
    with contextlib.suppress(Exception):
        importlib.import_module(name)


def _find_inner_modules(package: str) -> Iterator[str]:
    """Yield the modules in a package, and import inner packages to yield their modules."""
    for module in pkgutil.iter_modules(getattr(sys.modules.get(package), "__path__", ()), f"{package}."):
        if not module.name.endswith(".__main__"):
            yield module.name
            yield from _find_inner_modules(module.name)


def main() -> None:
    """Import the modules, call the functions, and serve until the socket is closed.

    Each forked process runs the requested program.
    """
    descriptor, *names = sys.argv[1:]
    functions = [name for name in names if ":" in name]
    _import_all([name for name in names if name not in functions])
    _freeze()
    _call_all(functions)
    _freeze()
    control = socket.socket(fileno=int(descriptor))
    control.send(b"ready")
    if request := _Server(control).serve():
        _run_program(request)


if __name__ == "__main__":
    main()
