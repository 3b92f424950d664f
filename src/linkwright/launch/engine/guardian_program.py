"""The program of the guardian, which briefly outlives the launcher and ends the remaining processes.

It is run by path in a bare interpreter and imports little, so that it costs a launch next to nothing. Its standard
input is a pipe from the launcher with a line for each event: ``+PID`` a process group was started, ``-PID`` the group
ended, ``=PATH`` a folder of temporary files was created, ``.`` the launch ended regularly. If the pipe closes without
the last one, the launcher was killed.
"""

from __future__ import annotations

import os
import signal
import sys
import time

_STEP_SECONDS = 0.02
_STAGES = ((signal.SIGINT, 1.0), (signal.SIGTERM, 0.5), (signal.SIGKILL, 0.0))


def main(mark: str) -> None:
    """Wait for the end of the launch.

    Args:
        mark: a variable ``NAME=VALUE`` in the environment of every process of the launch.
    """
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)
    groups: set[int] = set()
    folder = ""
    for line in sys.stdin:
        if line.startswith("+"):
            groups.add(int(line[1:]))
        elif line.startswith("-"):
            groups.discard(int(line[1:]))
        elif line.startswith("="):
            folder = line[1:].rstrip("\n")
        else:
            return
    end(groups | marked_groups(mark.encode()))
    if folder:
        import shutil

        shutil.rmtree(folder, ignore_errors=True)


def marked_groups(mark: bytes) -> set[int]:
    """Return the process groups with the mark, including those started just before the launcher ended."""
    try:
        entries = os.listdir("/proc")  # noqa: PTH208 - importing pathlib would take longer than all the rest
    except OSError:  # not Linux
        return set()
    pids = [int(entry) for entry in entries if entry.isdigit() and int(entry) != os.getpid()]
    return {_group_of(pid) for pid in pids if _has_mark(pid, mark)} - {0, os.getpgid(0)}


def _has_mark(pid: int, mark: bytes) -> bool:
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:  # noqa: PTH123 - as above
            return mark in file.read().split(b"\0")
    except OSError:  # it has ended, or belongs to another user
        return False


def _group_of(pid: int) -> int:
    try:
        return os.getpgid(pid)
    except OSError:
        return 0


def end(groups: set[int]) -> None:
    """End process groups, first with a gentle signal."""
    for number, seconds in _STAGES:
        groups = {group for group in groups if send(group, number)}
        deadline = time.monotonic() + seconds
        while groups and time.monotonic() < deadline:
            time.sleep(_STEP_SECONDS)
            groups = {group for group in groups if send(group, 0)}


def send(group: int, number: int) -> bool:
    """Send a signal to a group, and return whether the group exists."""
    try:
        os.killpg(group, number)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    main(sys.argv[1])
