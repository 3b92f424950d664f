"""Sentences about the sandbox for users: the reasons why runs end, and the protections."""

from __future__ import annotations

from linkwright.diagnostics import Phrase, phrase
from linkwright.learning.sandbox.outcome import Exceeded, Limits, Protection

_MEBIBYTE = 1024 * 1024

PROTECTIONS: dict[Protection, Phrase] = {
    Protection.LIMITS: phrase(
        "a run ends when it uses more time, memory, disk space, processes or output than allowed"
    ),
    Protection.ENDED: phrase("no process of a run outlives it or escapes its limits"),
    Protection.PROCESSES: phrase("a run cannot end, trace or read other processes"),
    Protection.READ: phrase("a run cannot read files outside its folder, except programs and libraries"),
    Protection.WRITE: phrase("a run cannot change files outside its folder"),
    Protection.NETWORK: phrase("a run cannot reach the network"),
}
"""The meaning of each protection. A grader lists missing protections with the same sentences."""


def describe_exceeded(exceeded: Exceeded, limits: Limits) -> Phrase:
    """Return a sentence with the limit that a run has exceeded."""
    match exceeded:
        case Exceeded.SECONDS:
            return phrase("the program did not end within {seconds:g} s", seconds=limits.seconds)
        case Exceeded.CPU_SECONDS:
            return phrase("the program used more than {seconds:g} s of processor time", seconds=limits.cpu_seconds)
        case Exceeded.MEMORY:
            return phrase("the program used more than {size} MiB of memory", size=limits.memory // _MEBIBYTE)
        case Exceeded.FILE_BYTES:
            return phrase("the program wrote a file larger than {size} MiB", size=limits.file_bytes // _MEBIBYTE)
        case Exceeded.DISK_BYTES:
            return phrase("the program wrote more than {size} MiB to the disk", size=limits.disk_bytes // _MEBIBYTE)
        case Exceeded.FILES:
            return phrase("the program created more than {count} files", count=limits.files)
        case Exceeded.PROCESSES:
            return phrase("the program started more than {count} processes and threads", count=limits.processes)
        case Exceeded.OUTPUT_BYTES:
            return phrase("the program printed more than {size} KiB", size=limits.output_bytes // 1024)
