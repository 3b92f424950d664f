"""The processes of a run: their resource usage, and their termination."""

from __future__ import annotations

import contextlib
import os
import signal
import stat
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass

if sys.platform != "win32":
    pass

_TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK") if hasattr(os, "sysconf") else 100


@dataclass(frozen=True)
class ProcessUsage:
    """The resource usage of a process. Times are in seconds, sizes in bytes."""

    pid: int
    parent: int
    threads: int
    cpu_seconds: float
    """With the time of its children that have ended."""
    memory: int


def find_descendants(root: int) -> list[ProcessUsage]:
    """Return all descendants of a process."""
    children: dict[int, list[ProcessUsage]] = {}
    for process in _iterate_processes():
        children.setdefault(process.parent, []).append(process)
    processes: list[ProcessUsage] = []
    waiting = [root]
    while waiting:
        children_of_process = children.pop(waiting.pop(), [])
        processes += children_of_process
        waiting += [process.pid for process in children_of_process]
    return processes


def _iterate_processes() -> Iterator[ProcessUsage]:
    if sys.platform == "linux":
        for name in os.listdir("/proc"):
            if name.isdecimal():
                with contextlib.suppress(OSError, ValueError, IndexError):
                    yield _read_process(int(name))
    else:
        yield from _read_processes_from_ps()


def _read_process(pid: int) -> ProcessUsage:
    """Return the usage of a process from /proc (see proc(5))."""
    with open(f"/proc/{pid}/stat", "rb") as file:
        fields = file.read().rpartition(b")")[2].split()  # the name before it may contain anything
    cpu_ticks = sum(int(field) for field in fields[11:15])
    return ProcessUsage(
        pid, int(fields[1]), int(fields[17]), cpu_ticks / _TICKS_PER_SECOND, int(fields[21]) * _PAGE_BYTES
    )


_PAGE_BYTES = os.sysconf("SC_PAGE_SIZE") if hasattr(os, "sysconf") else 4096


def measure_own_memory(process: ProcessUsage) -> int:
    """Return the proportional memory of a process in bytes, without file pages.

    If the system does not report it, return the whole resident memory.
    """
    total = None
    with contextlib.suppress(OSError), open(f"/proc/{process.pid}/smaps_rollup", "rb") as file:
        for line in file:
            name, _, value = line.partition(b":")
            if name in {b"Pss_Anon", b"Pss_Shmem"}:
                total = (total or 0) + int(value.split()[0]) * 1024
    return process.memory if total is None else total


def read_written_bytes(pid: int) -> int:
    """Return the bytes that a process and its ended children wrote to disks; 0 if unknown."""
    with contextlib.suppress(OSError, ValueError), open(f"/proc/{pid}/io", "rb") as file:
        for line in file:
            name, _, value = line.partition(b":")
            if name == b"write_bytes":
                return int(value)
    return 0


def find_nameless_files(pid: int) -> dict[tuple[int, int], int]:
    """Return the sizes in bytes of a process's open files without a name, by device and inode.

    Such files were deleted, or created by memfd_create(2).
    """
    sizes = {}
    with contextlib.suppress(OSError), os.scandir(f"/proc/{pid}/fd") as descriptors:
        for descriptor in descriptors:
            with contextlib.suppress(OSError):
                status = descriptor.stat()
                if stat.S_ISREG(status.st_mode) and status.st_nlink == 0:
                    sizes[status.st_dev, status.st_ino] = status.st_blocks * 512
    return sizes


def _read_processes_from_ps() -> Iterator[ProcessUsage]:
    """Return the processes from the output of ps(1) in the POSIX format, which lacks threads."""
    command = ["ps", "-A", "-o", "pid=,ppid=,rss=,time="]
    with subprocess.Popen(  # noqa: S603 - fixed arguments
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True
    ) as table:
        lines = table.communicate()[0].splitlines()
    for line in lines:
        with contextlib.suppress(ValueError):
            pid, parent, kibibytes, time = line.split()
            if int(pid) != table.pid:
                yield ProcessUsage(int(pid), int(parent), 1, _parse_ps_time(time), int(kibibytes) * 1024)


def _parse_ps_time(time: str) -> float:
    """Convert a time in the format of ps, [[days-]hours:]minutes:seconds, to seconds."""
    days, _, clock = time.rpartition("-")
    seconds = 0.0
    for part in clock.split(":"):
        seconds = seconds * 60 + float(part)
    return seconds + int(days or 0) * 86400


def end_descendants(user: int | None) -> None:
    """Kill all descendants of this process, and wait until they have ended.

    If the system allows it, this process must have called `adopt_orphans` before.

    Args:
        user: the user of the run if only the run's processes belong to that user; otherwise None.
    """
    while True:
        if user is not None:
            _kill_processes_of(user)
        for pid in _stop_descendants():
            _send_signal(pid, signal.SIGKILL)
        if not _wait_for_one_child():
            return


def _stop_descendants() -> set[int]:
    """Stop all descendants, including children that appear during the search, and return them."""
    stopped: set[int] = set()
    while found := {process.pid for process in find_descendants(os.getpid())} - stopped:
        for pid in found:
            _send_signal(pid, signal.SIGSTOP)
        stopped |= found
    return stopped


def _send_signal(pid: int, number: int) -> None:
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.kill(pid, number)


def _kill_processes_of(user: int) -> None:
    """Kill all processes of a user at once.

    No concurrent fork escapes kill(2) with -1.
    """
    from linkwright.learning.sandbox.identity import become

    if (child := os.fork()) == 0:
        try:
            become(user)
            os.kill(-1, signal.SIGKILL)
        finally:
            os._exit(0)
    os.waitpid(child, 0)


def _wait_for_one_child() -> bool:
    """Wait for a child to end, reap all ended children, and return whether there was any."""
    try:
        os.waitpid(-1, 0)
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass
    except ChildProcessError:
        return False
    return True
