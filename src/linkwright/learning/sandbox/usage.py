"""Watching what a run uses, and naming the limit that it exceeds."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
import time
from collections.abc import Iterator
from dataclasses import dataclass

from linkwright.learning.sandbox.outcome import Exceeded, Limits
from linkwright.learning.sandbox.processes import ProcessUsage, descendants, own_memory, written_bytes

_INTERVAL_SECONDS = 0.04
_SHARE_OF_TIME = 0.1
"""The part of the time that may pass with walks over the folder."""


@dataclass(frozen=True)
class FolderUsage:
    """What a folder contains."""

    bytes: int
    files: int
    largest: int
    """The length of the largest file."""


def measure_folder(folder: str) -> FolderUsage:
    """Return what a folder contains, without following links. A path that is too long counts as endless many files."""
    total = files = largest = 0
    counted: set[tuple[int, int]] = set()
    for status in _walk(folder):
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


def _walk(folder: str) -> Iterator[os.stat_result | None]:
    waiting = [folder]
    while waiting:
        try:
            entries = os.scandir(waiting.pop())
        except FileNotFoundError:
            continue
        except OSError as error:
            if error.errno == errno.ENAMETOOLONG:
                yield None
            continue
        with entries:
            for entry in entries:
                with contextlib.suppress(OSError):
                    yield entry.stat(follow_symlinks=False)
                    if entry.is_dir(follow_symlinks=False):
                        waiting.append(entry.path)


class Watchdog:
    """What a run has used since its start, compared with its limits.

    Attributes:
        cpu_seconds: the processor time of all processes so far.
    """

    def __init__(self, limits: Limits, folder: str) -> None:
        self._limits = limits
        self._folder = folder
        self._before = measure_folder(folder)
        self._start = time.monotonic()
        self._next_walk = self._next_check = self._start
        self._written_by: dict[int, int] = {}
        self.cpu_seconds = 0.0

    @property
    def seconds(self) -> float:
        """The wall time since the start."""
        return time.monotonic() - self._start

    def check_in_time(self) -> Exceeded | None:
        """Return the limit that the run exceeds now, if it is time to look again."""
        now = time.monotonic()
        if now < self._next_check:
            return None
        exceeded = self._find_exceeded()
        self._next_check = time.monotonic() + max(_INTERVAL_SECONDS, 4 * (time.monotonic() - now))
        return exceeded

    def _find_exceeded(self) -> Exceeded | None:
        if self.seconds > self._limits.seconds:
            return Exceeded.SECONDS
        return self._check_processes() or self._check_folder()

    def find_exceeded_at_end(self) -> Exceeded | None:
        """Return the limit that the run exceeded in its last moments."""
        self._next_walk = 0.0
        return self._check_folder()

    def _check_processes(self) -> Exceeded | None:
        found = descendants(os.getpid())
        ended = os.times()
        now = ended.children_user + ended.children_system + sum(process.cpu_seconds for process in found)
        self.cpu_seconds = max(self.cpu_seconds, now)
        if self.cpu_seconds > self._limits.cpu_seconds:
            return Exceeded.CPU_SECONDS
        if sum(process.threads for process in found) > self._limits.processes:
            return Exceeded.PROCESSES
        if self._uses_too_much_memory(found):
            return Exceeded.MEMORY
        self._written_by.update({process.pid: written_bytes(process.pid) for process in found})
        if sum(self._written_by.values()) > self._limits.disk_bytes:
            return Exceeded.DISK_BYTES
        return None

    def _uses_too_much_memory(self, found: list[ProcessUsage]) -> bool:
        """Compare the memory with the limit, at first by a sum that counts shared pages more than once."""
        limit = self._limits.memory
        return sum(process.memory for process in found) > limit and sum(map(own_memory, found)) > limit

    def _check_folder(self) -> Exceeded | None:
        start = time.monotonic()
        if start < self._next_walk:
            return None
        usage = measure_folder(self._folder)
        now = time.monotonic()
        self._next_walk = now + (now - start) / _SHARE_OF_TIME
        if usage.largest >= self._limits.file_bytes > self._before.largest:
            return Exceeded.FILE_BYTES
        if usage.bytes - self._before.bytes > self._limits.disk_bytes:
            return Exceeded.DISK_BYTES
        if usage.files - self._before.files > self._limits.files:
            return Exceeded.FILES
        return None
