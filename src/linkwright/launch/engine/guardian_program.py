"""The program of the guardian: it outlives the launcher by a moment and ends what that has left behind.

It is run by its path with a bare interpreter and imports little, so that it costs a launch next to nothing. Its
standard input is a pipe from the launcher with a line for each event: ``+PID`` a process group was started, ``-PID``
it is gone, ``=PATH`` a folder of temporary files was made, ``.`` the launch is over and in order. When the pipe ends
without that, the launcher was killed.
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
        mark: a setting ``NAME=VALUE`` that is in the environment of every process of the launch.
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
    """The groups of processes with the mark, also those started a moment before the launcher ended."""
    try:
        entries = os.listdir("/proc")  # noqa: PTH208 - without pathlib, which takes longer to import than all else here
    except OSError:  # no Linux
        return set()
    pids = [int(entry) for entry in entries if entry.isdigit() and int(entry) != os.getpid()]
    return {_group_of(pid) for pid in pids if _has_mark(pid, mark)} - {0, os.getpgid(0)}


def _has_mark(pid: int, mark: bytes) -> bool:
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:  # noqa: PTH123 - as above
            return mark in file.read().split(b"\0")
    except OSError:  # it has ended, or is somebody else's
        return False


def _group_of(pid: int) -> int:
    try:
        return os.getpgid(pid)
    except OSError:
        return 0


def end(groups: set[int]) -> None:
    """End process groups, gently first."""
    for number, seconds in _STAGES:
        groups = {group for group in groups if send(group, number)}
        deadline = time.monotonic() + seconds
        while groups and time.monotonic() < deadline:
            time.sleep(_STEP_SECONDS)
            groups = {group for group in groups if send(group, 0)}


def send(group: int, number: int) -> bool:
    """Send a signal to a group; returns whether there is such a group."""
    try:
        os.killpg(group, number)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    main(sys.argv[1])
