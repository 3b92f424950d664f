"""Detecting missing sound by stamps of blocks.

AudioDataStamped has no number that counts messages. A source of ours stamps each block with the end of the one before,
and follows the clock slowly, so that a jump ahead means that sound was lost on the way.
"""

from __future__ import annotations

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.speech.sound.samples import RATE

_MOST_BEHIND = 10 * NANOSECONDS_PER_SECOND
"""A suspended source publishes its backlog late; one that is later than this has restarted."""

_MOST_AHEAD = NANOSECONDS_PER_SECOND
_DRIFT = 0.01  # the share of a block by which stamps approach the clock with each block

_STEADY = 5 * 10**6
_STEADY_BLOCKS = 3  # that follow each other without a jump: then the publisher counts samples
_JUMP = 50 * 10**6


class SampleStamps:
    """Computes stamps of the blocks of a stream, in nanoseconds of a clock."""

    def __init__(self) -> None:
        self._next: int | None = None

    def restart(self) -> None:
        """Start a new stream, unrelated to the one before."""
        self._next = None

    def stamp(self, samples: int, now: int, lost: float = 0.0) -> int:
        """The stamp of a block's first sample.

        Args:
            samples: how many it has.
            now: the time when its last sample was recorded, or later.
            lost: seconds that are missing in it or before it: the stamp jumps over them, but over no more than a second
                that has not passed.
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
    """Detects missing sound before a block from stamps, if its publisher counts samples."""

    def __init__(self) -> None:
        self._next: int | None = None
        self._steady = 0
        self._small = 0  # jumps too small to be reported on their own

    def restart(self) -> None:
        """Start a new stream, whose publisher is taken to stamp it in the same way."""
        self._next = None
        self._small = 0

    def missing(self, stamp: int, samples: int) -> float:
        """The seconds of sound missing before a block.

        Args:
            stamp: of its first sample, nanoseconds.
            samples: how many it has, at 16 kHz.
        """
        length = samples * NANOSECONDS_PER_SECOND // RATE
        jump = 0 if self._next is None else stamp - self._next
        self._next = stamp + length
        if jump <= _STEADY:
            # Only a publisher that stamps blocks on arrival is ever early after it was late.
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
