"""The program of the guardian: ends the remaining processes of a killed launcher.

The launcher runs this file in a bare interpreter. The file imports little, so that it adds almost no time to a launch.
Its standard input is a pipe from the launcher, with one line per event: ``+PID`` when a process group was started,
``-PID`` when the group ended, ``=PATH`` when a folder of temporary files was created, and ``.`` when the launch ended
normally. If the pipe closes without this last line, the launcher was killed.
"""

from __future__ import annotations

import os
import signal
import sys
import time

_POLL_INTERVAL_S = 0.02
_SIGNAL_STAGES = ((signal.SIGINT, 1.0), (signal.SIGTERM, 0.5), (signal.SIGKILL, 0.0))


def main(mark: str) -> None:
    """Wait for the launcher to end, and end the remaining processes if the launcher was killed.

    Args:
        mark: an environment variable ``NAME=VALUE`` that all processes of the launch have.
    """
    for signal_number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(signal_number, signal.SIG_IGN)
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
    end_groups(groups | find_marked_groups(mark.encode()))
    if folder:
        import shutil

        shutil.rmtree(folder, ignore_errors=True)


def find_marked_groups(mark: bytes) -> set[int]:
    """Return the IDs of the process groups with a process whose environment contains the mark.

    The result includes groups that the launcher started just before it was killed, without registering them. It is
    empty on systems without ``/proc``.
    """
    try:
        entries = os.listdir("/proc")  # noqa: PTH208 - pathlib is slow to import
    except OSError:  # only Linux has /proc
        return set()
    pids = [int(entry) for entry in entries if entry.isdigit() and int(entry) != os.getpid()]
    return {_read_group_id(pid) for pid in pids if _has_mark(pid, mark)} - {0, os.getpgid(0)}


def _has_mark(pid: int, mark: bytes) -> bool:
    try:
        with open(f"/proc/{pid}/environ", "rb") as file:  # noqa: PTH123 - as above
            return mark in file.read().split(b"\0")
    except OSError:  # the process has ended, or belongs to another user
        return False


def _read_group_id(pid: int) -> int:
    try:
        return os.getpgid(pid)
    except OSError:
        return 0


def end_groups(groups: set[int]) -> None:
    """Send SIGINT, then SIGTERM, then SIGKILL to process groups until they have ended."""
    for signal_number, seconds in _SIGNAL_STAGES:
        groups = {group for group in groups if send_signal(group, signal_number)}
        deadline = time.monotonic() + seconds
        while groups and time.monotonic() < deadline:
            time.sleep(_POLL_INTERVAL_S)
            groups = {group for group in groups if send_signal(group, 0)}


def send_signal(group: int, signal_number: int) -> bool:
    """Send a signal to a process group, and return whether the group exists."""
    try:
        os.killpg(group, signal_number)
    except OSError:
        return False
    return True


if __name__ == "__main__":
    main(sys.argv[1])
