"""Monitor the resources that a run uses, and detect an exceeded limit."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import sys
import time
from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.learning.sandbox.outcome import Exceeded, Limits
from linkwright.learning.sandbox.processes import (
    ProcessUsage,
    find_descendants,
    find_nameless_files,
    measure_own_memory,
    read_written_bytes,
)
from linkwright.process.patience import PatientClock

_INTERVAL_S = 0.04
_TIME_FRACTION = 0.1
"""The fraction of the time that may pass with walks over the folder."""


@dataclass(frozen=True)
class FolderUsage:
    """The total size, the number of files and the largest file of a folder. Sizes are in bytes."""

    bytes: int
    files: int
    largest: int
    """The length of the largest file."""


def measure_folder(folder: str) -> FolderUsage:
    """Measure the contents of a folder without following links.

    A path that is too long counts as an infinite number of files.
    """
    total = files = largest = 0
    counted: set[tuple[int, int]] = set()
    for status in _walk_folder(folder):
        if status is None:
            return FolderUsage(total, 1 << 60, largest)
        files += 1
        if (status.st_dev, status.st_ino) not in counted:
            if status.st_nlink > 1:
                counted.add((status.st_dev, status.st_ino))
            total += status.st_blocks * 512
            if stat.S_ISREG(status.st_mode):
                largest = max(largest, status.st_size)
    return FolderUsage(total, files, largest)


def _walk_folder(folder: str) -> Iterator[os.stat_result | None]:
    """Yield the status of each path below a folder, or None for a path that is too long."""
    waiting = [folder]
    while waiting:
        for path, status in _list_folder(waiting.pop()):
            if status is not None and stat.S_ISDIR(status.st_mode):
                waiting.append(path)
            yield status


def _list_folder(folder: str) -> Iterator[tuple[str, os.stat_result | None]]:
    """Yield the paths in a folder with their status, except deleted and unreadable paths."""
    try:
        with os.scandir(folder) as entries:
            for entry in entries:
                yield entry.path, entry.stat(follow_symlinks=False)
    except OSError as error:
        if error.errno == errno.ENAMETOOLONG:
            yield folder, None


class Watchdog:
    """Compares the resource usage of a run with its limits.

    Attributes:
        user: the user of the run, if it differs from this process's user.
        cpu_seconds: the processor time of all processes so far, in seconds.
    """

    def __init__(self, limits: Limits, folder: str) -> None:
        self._limits = limits
        self._folder = folder
        self._before = measure_folder(folder)
        self._start = time.monotonic()
        self._clock = PatientClock()
        self._next_walk = self._next_check = self._start
        self._nameless_on_disk = 0
        self._device = os.stat(folder).st_dev
        self._may_trace = _may_trace_all()
        self.user: int | None = None
        self.cpu_seconds = 0.0

    @property
    def seconds(self) -> float:
        """The wall time since the start, in seconds."""
        return time.monotonic() - self._start

    def check_in_time(self) -> Exceeded | None:
        """Return the exceeded limit or None, checking only if the check interval has passed."""
        now = time.monotonic()
        if now < self._next_check:
            return None
        exceeded = self._find_exceeded()
        self._next_check = time.monotonic() + max(_INTERVAL_S, 4 * (time.monotonic() - now))
        return exceeded

    def _find_exceeded(self) -> Exceeded | None:
        if self._clock.read() > self._limits.seconds:
            return Exceeded.SECONDS
        return self._check_processes() or self._check_folder()

    def find_exceeded_at_end(self) -> Exceeded | None:
        """Return the limit that the run exceeded shortly before its end, or None."""
        self._next_walk = 0.0
        return self._check_folder()

    def _check_processes(self) -> Exceeded | None:
        processes = find_descendants(os.getpid())
        ended = os.times()
        now = ended.children_user + ended.children_system + sum(process.cpu_seconds for process in processes)
        self.cpu_seconds = max(self.cpu_seconds, now)
        if self.cpu_seconds > self._limits.cpu_seconds:
            return Exceeded.CPU_SECONDS
        if sum(process.threads for process in processes) > self._limits.processes:
            return Exceeded.PROCESSES
        with self._access_processes():
            return self._check_memory(processes) or self._check_written(processes)

    def _check_memory(self, processes: list[ProcessUsage]) -> Exceeded | None:
        """Compare the memory with the limit.

        A fast sum that counts shared pages repeatedly is checked first.
        """
        sizes: dict[tuple[int, int], int] = {}
        for process in processes:
            sizes.update(find_nameless_files(process.pid))
        self._nameless_on_disk = sum(size for (device, _), size in sizes.items() if device == self._device)
        room = self._limits.memory - sum(sizes.values()) + self._nameless_on_disk
        is_exceeded = (
            sum(process.memory for process in processes) > room and sum(map(measure_own_memory, processes)) > room
        )
        return Exceeded.MEMORY if is_exceeded else None

    def _check_written(self, processes: list[ProcessUsage]) -> Exceeded | None:
        """Compare the written bytes with the limit. A parent's bytes include its ended children's."""
        written = sum(read_written_bytes(pid) for pid in (os.getpid(), *(process.pid for process in processes)))
        is_exceeded = max(written, self._nameless_on_disk) > self._limits.disk_bytes
        return Exceeded.DISK_BYTES if is_exceeded else None

    @contextlib.contextmanager
    def _access_processes(self) -> Iterator[None]:
        """Access /proc as the user of the run.

        This is only needed if this process is root without the right to trace processes.
        """
        if self.user is None or self._may_trace:
            yield
            return
        from linkwright.learning.sandbox.linux import set_file_user

        set_file_user(self.user, self.user)
        try:
            yield
        finally:
            set_file_user(os.geteuid(), os.getegid())

    def _check_folder(self) -> Exceeded | None:
        start = time.monotonic()
        if start < self._next_walk:
            return None
        usage = measure_folder(self._folder)
        now = time.monotonic()
        self._next_walk = now + (now - start) / _TIME_FRACTION
        if usage.largest >= self._limits.file_bytes > self._before.largest:
            return Exceeded.FILE_BYTES
        if usage.bytes - self._before.bytes > self._limits.disk_bytes:
            return Exceeded.DISK_BYTES
        if usage.files - self._before.files > self._limits.files:
            return Exceeded.FILES
        return None


def _may_trace_all() -> bool:
    if sys.platform != "linux":
        return False
    from linkwright.learning.sandbox.linux import CAP_SYS_PTRACE, has_capability

    return has_capability(CAP_SYS_PTRACE)
