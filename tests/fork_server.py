"""A process that has imported what `linkwright view` needs, and forks for each program that a test starts.

Run as ``python -m tests.fork_server FD``, where FD is a socket of `tests.forked`; it ends when that one is closed.
"""

from __future__ import annotations

import contextlib
import gc
import importlib
import json
import os
import pkgutil
import runpy
import selectors
import socket
import struct
import sys
import warnings
from dataclasses import dataclass
from typing import Any

LARGEST_REQUEST = 2**17
"""Bytes of a request at most, which is one datagram: words and environment."""
NUMBER = struct.Struct("q")
"""What the tests are told: first the process id, then the exit status."""

_IMPORTED = (
    "linkwright.cli.command",
    "linkwright.cli.view",
    "linkwright.cli.launch",
    "linkwright.cli.sim",
    "linkwright.bag",
    "linkwright.hosting",
    "linkwright.inertia",
    "linkwright.messages",
    "linkwright.nodes.joint_state_publisher_gui",
    "linkwright.nodes.robot_state_publisher",
    "linkwright.simulation.nodes.simulator",
    "linkwright.packages",
    "linkwright.page",
    "linkwright.panels",
    "linkwright.rviz",
    "linkwright.viewer",
    "aiohttp.web",
    "encodings.idna",
    "watchfiles",
)
"""Modules, and packages with all that is in them."""


@dataclass
class Request:
    """A program that is asked for, and the files that it gets."""

    words: list[str]
    folder: str
    environment: dict[str, str]
    streams: list[int]
    """Standard input, output and error."""
    report: int
    """A pipe that is told of the process id and, later, of its status."""


def _serve(control: socket.socket) -> Request | None:
    """Fork for each request; in the new process this returns the request, in the first one nothing, at the end."""
    running: dict[int, tuple[int, int]] = {}
    with selectors.DefaultSelector() as selector:
        selector.register(control, selectors.EVENT_READ)
        while True:
            for key, _ in selector.select():
                if key.fileobj is control:
                    request = _received(control)
                    if request is None:
                        return None
                    if (pid := _fork()) == 0:
                        for descriptor, (_, report) in running.items():
                            os.close(descriptor)
                            os.close(report)
                        control.close()
                        os.close(request.report)
                        return request
                    for stream in request.streams:
                        os.close(stream)
                    os.write(request.report, NUMBER.pack(pid))
                    process = os.pidfd_open(pid)
                    running[process] = pid, request.report
                    selector.register(process, selectors.EVENT_READ)
                else:
                    selector.unregister(key.fd)
                    os.close(key.fd)
                    pid, report = running.pop(key.fd)
                    _, status = os.waitpid(pid, 0)
                    _tell(report, os.waitstatus_to_exitcode(status))


def _fork() -> int:
    with warnings.catch_warnings():
        # Of threads, since 3.12: the one there is, numpy's, waits, and numpy's library sees to it when a process forks.
        warnings.simplefilter("ignore", DeprecationWarning)
        return os.fork()


def _received(control: socket.socket) -> Request | None:
    data, descriptors, _, _ = socket.recv_fds(control, LARGEST_REQUEST, 4)
    if not data:
        return None
    asked: dict[str, Any] = json.loads(data)
    *streams, report = descriptors
    return Request(asked["words"], asked["folder"], asked["environment"], streams, report)


def _tell(report: int, status: int) -> None:
    with contextlib.suppress(BrokenPipeError):  # Nobody waits for it any more.
        os.write(report, NUMBER.pack(status))
    os.close(report)


def _become(request: Request) -> None:
    """Be what ``python -m linkwright`` is in a process of its own."""
    for number, stream in enumerate(request.streams):
        os.dup2(stream, number)
        os.close(stream)
    importlib.invalidate_caches()
    os.chdir(request.folder)
    os.environ.clear()
    os.environ.update(request.environment)
    sys.path[0] = request.folder
    sys.argv[1:] = request.words
    runpy.run_module("linkwright", run_name="__main__", alter_sys=True)


def main() -> None:
    """Import, serve until the tests end, and be a program in each process that was forked."""
    for name in _IMPORTED:
        package = importlib.import_module(name)
        for walk_package in pkgutil.walk_packages(getattr(package, "__path__", ()), f"{name}."):
            importlib.import_module(walk_package.name)
    gc.collect()
    gc.freeze()  # Looking for garbage would write to memory that is shared, and so copy it.
    control = socket.socket(fileno=int(sys.argv[1]))
    if request := _serve(control):
        _become(request)


if __name__ == "__main__":
    main()
