"""Detect missing sound from the stamps of sound blocks.

AudioDataStamped does not number its messages. Linkwright's sources stamp each block with the end of the previous one
and follow the clock only slowly. A jump forward therefore means that sound was lost in transit.
"""

from __future__ import annotations

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.speech.sound.samples import RATE

_MAX_BEHIND_NS = 10 * NANOSECONDS_PER_SECOND
"""The maximum delay in ns of a source that publishes a backlog. A source with a larger delay has restarted."""

_MAX_AHEAD_NS = NANOSECONDS_PER_SECOND
_MAX_DRIFT = 0.01  # the share of a block's length by which its stamp can approach the clock

_JITTER_NS = 5 * 10**6
_STEADY_BLOCKS = 3  # blocks without a jump, after which the publisher is assumed to count samples
_MIN_GAP_NS = 50 * 10**6


class SampleStamps:
    """The stamps of the blocks of a stream, in nanoseconds of a clock."""

    def __init__(self) -> None:
        self._next_ns: int | None = None

    def restart(self) -> None:
        """Start a new stream, whose stamps are independent of the previous stream."""
        self._next_ns = None

    def compute_stamp(self, samples: int, now: int, lost: float = 0.0) -> int:
        """Return the stamp of a block's first sample.

        Args:
            samples: the number of samples in the block.
            now: the time in ns at which the last sample was recorded, or later.
            lost: the seconds of sound that are missing in the block or before it. The stamp jumps over them, but at
                most one second into the future.
        """
        length = samples * NANOSECONDS_PER_SECOND // RATE
        start = max(0, now - length)
        if self._next_ns is not None and -_MAX_AHEAD_NS < (delay_ns := start - self._next_ns) < _MAX_BEHIND_NS:
            max_correction = round(_MAX_DRIFT * length)
            jump = min(round(lost * NANOSECONDS_PER_SECOND), max(delay_ns, 0) + _MAX_AHEAD_NS)
            start = self._next_ns + min(max(delay_ns, -max_correction), max_correction) + jump
        self._next_ns = start + length
        return start


class SoundGaps:
    """Detects missing sound, for publishers that derive their stamps from a sample count."""

    def __init__(self) -> None:
        self._next_stamp: int | None = None
        self._steady_blocks = 0
        self._small_jumps = 0  # the sum of jumps that are too small to report individually

    def restart(self) -> None:
        """Start a new stream of a publisher that is assumed to stamp in the same way as before."""
        self._next_stamp = None
        self._small_jumps = 0

    def measure_gap(self, stamp: int, samples: int) -> float:
        """Return the seconds of sound that are missing before a block.

        Args:
            stamp: the stamp of its first sample, in nanoseconds.
            samples: the number of samples, at 16 kHz.
        """
        length = samples * NANOSECONDS_PER_SECOND // RATE
        jump = 0 if self._next_stamp is None else stamp - self._next_stamp
        self._next_stamp = stamp + length
        if jump <= _JITTER_NS:
            # Stamps that are early after late ones only occur if a publisher stamps blocks with their arrival times.
            self._steady_blocks, self._small_jumps = (
                (self._steady_blocks + 1, self._small_jumps) if jump >= -_JITTER_NS else (0, 0)
            )
            return 0.0
        if self._steady_blocks < _STEADY_BLOCKS:
            self._steady_blocks = 0
            return 0.0
        self._small_jumps += jump
        if self._small_jumps <= _MIN_GAP_NS:
            return 0.0
        missing, self._small_jumps = self._small_jumps, 0
        return missing / NANOSECONDS_PER_SECOND
