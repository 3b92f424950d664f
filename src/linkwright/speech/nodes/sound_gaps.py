"""Detect missing sound from the stamps of blocks.

AudioDataStamped does not number its messages. Linkwright's sources stamp each block with the end of the previous one,
and follow the clock slowly. A jump ahead therefore means that sound was lost in transit.
"""

from __future__ import annotations

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.speech.sound.samples import RATE

_MOST_BEHIND = 10 * NANOSECONDS_PER_SECOND
"""A suspended source publishes its backlog late; one that is later than this has restarted."""

_MOST_AHEAD = NANOSECONDS_PER_SECOND
_DRIFT = 0.01  # the fraction of a block by which stamps approach the clock with each block

_STEADY = 5 * 10**6
_STEADY_BLOCKS = 3  # blocks without a jump, after which the publisher is taken to count samples
_JUMP = 50 * 10**6


class SampleStamps:
    """Computes stamps of the blocks of a stream, in nanoseconds of a clock."""

    def __init__(self) -> None:
        self._next: int | None = None

    def restart(self) -> None:
        """Start a new stream, unrelated to the previous one."""
        self._next = None

    def stamp(self, samples: int, now: int, lost: float = 0.0) -> int:
        """Return the stamp of a block's first sample.

        Args:
            samples: the number of samples in the block.
            now: the time when its last sample was recorded, or later.
            lost: seconds of sound missing in the block or before it: the stamp jumps over them, but at most one second
                into the future.
        """
        length = samples * NANOSECONDS_PER_SECOND // RATE
        began = max(0, now - length)
        if self._next is not None and -_MOST_AHEAD < (behind := began - self._next) < _MOST_BEHIND:
            most = round(_DRIFT * length)
            jump = min(round(lost * NANOSECONDS_PER_SECOND), max(behind, 0) + _MOST_AHEAD)
            began = self._next + min(max(behind, -most), most) + jump
        self._next = began + length
        return began


class SoundGaps:
    """Detects missing sound before a block from stamps, if the publisher counts samples."""

    def __init__(self) -> None:
        self._next: int | None = None
        self._steady = 0
        self._small = 0  # sum of jumps that are too small to report individually

    def restart(self) -> None:
        """Start a new stream whose publisher is assumed to stamp it in the same way."""
        self._next = None
        self._small = 0

    def missing(self, stamp: int, samples: int) -> float:
        """Return the seconds of sound that are missing before a block.

        Args:
            stamp: the stamp of its first sample, in nanoseconds.
            samples: the number of samples, at 16 kHz.
        """
        length = samples * NANOSECONDS_PER_SECOND // RATE
        jump = 0 if self._next is None else stamp - self._next
        self._next = stamp + length
        if jump <= _STEADY:
            # Only the stamps of a publisher that uses the arrival times of blocks can be early after they were late.
            self._steady, self._small = (self._steady + 1, self._small) if jump >= -_STEADY else (0, 0)
            return 0.0
        if self._steady < _STEADY_BLOCKS:
            self._steady = 0
            return 0.0
        self._small += jump
        if self._small <= _JUMP:
            return 0.0
        missing, self._small = self._small, 0
        return missing / NANOSECONDS_PER_SECOND
