"""The program of the guardian, which ends the remaining processes of a killed launcher.

The launcher runs this file by its path in a bare interpreter. The file imports little, so that it adds almost no time
to a launch. Its standard input is a pipe from the launcher, with one line per event: ``+PID`` when a process group was
started, ``-PID`` when the group ended, ``=PATH`` when a folder of temporary files was created, and ``.`` when the
launch ended normally. If the pipe closes without the last line, the launcher was killed.
"""

from __future__ import annotations

import os
import signal
import sys
import time

_STEP_SECONDS = 0.02
_STAGES = ((signal.SIGINT, 1.0), (signal.SIGTERM, 0.5), (signal.SIGKILL, 0.0))


def main(mark: str) -> None:
    """Wait for the launcher to end, and end the remaining processes if the launcher was killed.

    Args:
        mark: an environment variable ``NAME=VALUE`` that every process of the launch has.
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
    end_groups(groups | marked_groups(mark.encode()))
    if folder:
        import shutil

        shutil.rmtree(folder, ignore_errors=True)


def marked_groups(mark: bytes) -> set[int]:
    """Return the IDs of the process groups whose environment contains the mark.

    The result includes groups that were started just before the launcher was killed and were not yet registered. It is
    empty on systems without ``/proc``.
    """
    try:
        entries = os.listdir("/proc")  # noqa: PTH208 - importing pathlib would take longer than all the rest
    except OSError:  # only Linux has /proc
        return set()
    pids = [int(entry) for entry in entries if entry.isdigit() and int(entry) != os.getpid()]
    return {_group_of(pid) for pid in pids if _has_mark(pid, mark)} - {0, os.getpgid(0)}


def _has_mark(pid: int, mark: bytes) -> bool:
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:  # noqa: PTH123 - as above
            return mark in file.read().split(b"\0")
    except OSError:  # the process has ended, or belongs to another user
        return False


def _group_of(pid: int) -> int:
    try:
        return os.getpgid(pid)
    except OSError:
        return 0


def end_groups(groups: set[int]) -> None:
    """End process groups with SIGINT, then SIGTERM, then SIGKILL for the groups that remain."""
    for number, seconds in _STAGES:
        groups = {group for group in groups if send_signal(group, number)}
        deadline = time.monotonic() + seconds
        while groups and time.monotonic() < deadline:
            time.sleep(_STEP_SECONDS)
            groups = {group for group in groups if send_signal(group, 0)}


def send_signal(group: int, number: int) -> bool:
    """Send a signal to a group, and return whether the group exists."""
    try:
        os.killpg(group, number)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    main(sys.argv[1])
