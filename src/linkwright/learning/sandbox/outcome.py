"""The limits, the outcome and the active protections of a run in the sandbox."""

from __future__ import annotations

import enum
from dataclasses import dataclass

MEBIBYTE = 1024 * 1024


@dataclass(frozen=True)
class Limits:
    """The resources that all processes of a run together may use.

    Times are in seconds, sizes in bytes.
    """

    seconds: float = 120.0
    """Wall time, without the time in which a process of the run waited for a processor (see `PatientClock`)."""
    cpu_seconds: float = 60.0
    memory: int = 2048 * MEBIBYTE
    file_bytes: int = 64 * MEBIBYTE
    """The size of one file."""
    disk_bytes: int = 256 * MEBIBYTE
    """The space that the folder occupies beyond that before the run, or the bytes written, whichever is larger."""
    files: int = 20_000
    """The number of files and folders that a run adds."""
    processes: int = 256
    """Processes and their threads."""
    output_bytes: int = MEBIBYTE
    """Standard output and standard error together. Further output ends the run."""


class Exceeded(enum.Enum):
    """The limit that a run has exceeded. The values are the field names of `Limits`."""

    SECONDS = "seconds"
    CPU_SECONDS = "cpu_seconds"
    MEMORY = "memory"
    FILE_BYTES = "file_bytes"
    DISK_BYTES = "disk_bytes"
    FILES = "files"
    PROCESSES = "processes"
    OUTPUT_BYTES = "output_bytes"


class Protection(enum.Enum):
    """A protection against the program of a run. `sentences.py` describes each protection."""

    LIMITS = "limits"
    """It cannot use more time, memory, disk space, processes or output than its limits allow."""
    ENDED = "ended"
    """None of its processes outlives it, even if the grader is killed."""
    PROCESSES = "processes"
    """It cannot signal, trace or read processes outside the sandbox."""
    READ = "read"
    """It cannot read files outside its folder, except programs and libraries."""
    WRITE = "write"
    """It cannot change files outside its folder."""
    NETWORK = "network"
    """It cannot reach other hosts, or servers outside the sandbox on this one."""


@dataclass(frozen=True)
class Outcome:
    """The result of a run."""

    status: int
    """The exit status, or the negated number of the signal that ended the program, as in `subprocess`."""
    stdout: bytes
    stderr: bytes
    """The output up to the limit."""
    exceeded: Exceeded | None
    """The limit that ended the run."""
    protections: frozenset[Protection]
    """The protections that were in force."""
    removed: tuple[str, ...] = ()
    """Paths in the folder, relative to it, that were deleted after the run because reading them could do harm.

    These are symbolic links out of the folder, hard links to files outside it, and files that are not regular.
    """
    seconds: float = 0.0
    cpu_seconds: float = 0.0
