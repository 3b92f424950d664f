"""The processes of a POSIX session, and how they are ended.

A session contains a shell and everything that was started in it, including jobs in the background. A process that
starts its own session, such as a daemon, no longer belongs to it.
"""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import suppress

_HAS_PROC = os.path.exists("/proc/self/stat")  # noqa: PTH110 - on Linux; elsewhere, ps is asked
_PAUSE_S = 0.02
_KILL_TIMEOUT_S = 1.0
"""The maximum number of seconds for which new processes of a session are killed."""


def end_session(leader: int, grace: float) -> None:
    """End all processes of a session, and wait until they have ended.

    They receive SIGHUP, and those that remain after the grace period receive SIGKILL. Zombies do not count.

    Args:
        leader: the process ID of the leader, which is also the ID of the session. The leader must be running, or must
            not have been reaped.
        grace: seconds to wait before the remaining processes are killed.
    """
    for process in find_session_processes(leader):
        _send_signal(process, signal.SIGHUP)
        _send_signal(process, signal.SIGCONT)  # A stopped process handles SIGHUP only after it has been continued.
    now = time.monotonic()
    killing, deadline = now + grace, now + grace + _KILL_TIMEOUT_S
    while (remaining := list(find_session_processes(leader))) and (now := time.monotonic()) < deadline:
        if now >= killing:
            for process in remaining:
                _send_signal(process, signal.SIGKILL)
        time.sleep(_PAUSE_S)


def find_session_processes(leader: int) -> Iterator[int]:
    """Yield the IDs of the processes in a session, except zombies."""
    for process in _list_processes():
        with suppress(OSError):
            if os.getsid(process) == leader and not _is_zombie(process):
                yield process


def _list_processes() -> list[int]:
    if _HAS_PROC:
        return [int(name) for name in os.listdir("/proc") if name.isdigit()]  # noqa: PTH208 - names are enough
    return [int(line) for line in _run_ps("-A", "-o", "pid=").split()]


def _is_zombie(process: int) -> bool:
    if _HAS_PROC:
        with open(f"/proc/{process}/stat", "rb") as file:  # noqa: PTH123 - faster, and hundreds are read
            return file.read().rpartition(b") ")[2].startswith(b"Z")  # the preceding name may contain anything
    return _run_ps("-o", "stat=", "-p", str(process)).strip().startswith("Z")


def _run_ps(*options: str) -> str:
    return subprocess.run(["ps", *options], stdout=subprocess.PIPE, check=False, text=True).stdout  # noqa: S603, S607


def _send_signal(process: int, number: int) -> None:
    with suppress(OSError):  # The process has ended.
        os.kill(process, number)
