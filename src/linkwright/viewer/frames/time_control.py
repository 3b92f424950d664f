"""The state of the Time panel: paused, synchronized to a display's messages, or free."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph import Clock
from linkwright.viewer.protocol.time import SyncMode

_APPROACH = 0.3
"""Part by which the delay of Approximate comes nearer to that of the last message, at each look (rviz_common)."""


class TimeControl:
    """RViz's Time panel: Pause, and Synchronization with its Source.

    While paused displays take no messages and frames stay where they are. Exact shows the frames where they were at
    the time of the source's last message; Approximate lets time go on behind the present by the source's delay.

    Args:
        clock: the viewer's.
        changed: called when one of the attributes is another.
        signalled: called when the source took a message, so that frames must be looked at.

    Attributes:
        paused: whether time stands still.
        mode: Off, Exact or Approximate.
        source: the name of the display that leads.
        sources: names of the displays that can, in the order in which their first messages came.
    """

    def __init__(
        self, clock: Clock, changed: Callable[[], None] = lambda: None, signalled: Callable[[], None] = lambda: None
    ) -> None:
        self.paused = False
        self.mode: SyncMode = "Off"
        self.source = ""
        self.sources: list[str] = []
        self._clock = clock
        self._changed = changed
        self._signalled = signalled
        self._exact_ns = 0
        self._delay_ns = self._current_delay_ns = 0
        self._paused_ns = 0

    def set(self, *, paused: bool, mode: SyncMode, source: str) -> None:
        """Pause or go on; follow a source or none."""
        if paused and not self.paused:
            self._paused_ns = self.now_ns()
        if (mode, source) != (self.mode, self.source):
            self._exact_ns = self._delay_ns = self._current_delay_ns = 0
        self.paused, self.mode, self.source = paused, mode, source
        self._changed()

    def took(self, display: str, stamp_ns: int) -> None:
        """A display takes a message of some time, nanoseconds."""
        if display not in self.sources:
            self.sources.append(display)
            self._changed()
        if display != self.source or self.mode == "Off" or self.paused:
            return
        self._exact_ns = stamp_ns
        self._delay_ns = max(0, self._clock.now_ns() - stamp_ns) if stamp_ns else 0
        self._signalled()

    def lookup_ns(self) -> int | None:
        """The time at which frames are to be shown, nanoseconds; None for the latest there is."""
        if self.paused and self.mode != "Off":
            return self._paused_ns
        if self.mode == "Exact":
            return self._exact_ns or None
        if self.mode == "Approximate" and self.source in self.sources:
            self._current_delay_ns += int(_APPROACH * (self._delay_ns - self._current_delay_ns))
            return self._clock.now_ns() - self._current_delay_ns
        return None

    def now_ns(self) -> int:
        """What the clock of the Time panel shows as ROS time, nanoseconds."""
        if self.paused:
            return self._paused_ns
        if self.mode == "Exact" and self._exact_ns:
            return self._exact_ns
        return self._clock.now_ns() - (self._current_delay_ns if self.mode == "Approximate" else 0)

    def reset(self) -> None:
        """Forget what messages said of time."""
        self.sources.clear()
        self._exact_ns = self._delay_ns = self._current_delay_ns = 0
        self._paused_ns = self._clock.now_ns()
        self._changed()
