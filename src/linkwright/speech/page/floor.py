"""The page that currently talks among several, and the limits of its sound."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.page.audience import Page
from linkwright.page.protocol.voice import TalkMode

_LEAD = 10.0
"""Seconds of sound that may arrive at once, as after a stalled connection."""

_CLOCK_TOLERANCE = 1.05
"""The factor by which the clock of a page's microphone may be faster than ours."""


class Floor:
    """The pages that have a microphone open; the page that has held its button longest talks."""

    def __init__(self) -> None:
        self._modes: dict[Page, TalkMode] = {}

    def __bool__(self) -> bool:
        return bool(self._modes)

    def set(self, page: Page, mode: TalkMode) -> None:
        """Set the microphone mode of a page, which is queued after pages with the same mode."""
        if self._modes.get(page) == mode:
            return
        self._modes.pop(page, None)
        if mode != "off":
            self._modes[page] = mode

    @property
    def holder(self) -> Page | None:
        """The page that holds its button and talks."""
        return self._first("held")

    @property
    def talker(self) -> Page | None:
        """The page whose sound is published."""
        return self.holder or self._first("open")

    def _first(self, mode: TalkMode) -> Page | None:
        return next((page for page, its in self._modes.items() if its == mode), None)


class SoundBudget:
    """The sound that a page may send, and the loss that it may report: as much of each as time passes.

    The two are counted separately because lost sound may be sent as silence.

    Args:
        clock: returns the time in seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._at = clock()
        self._sound = self._lost = _LEAD

    def spend(self, sound: float, lost: float) -> bool:
        """Return whether a number of seconds of sound and of loss is within the limits, and count it."""
        now = self._clock()
        gained = (now - self._at) * _CLOCK_TOLERANCE
        self._at = now
        self._sound = min(_LEAD, self._sound + gained) - sound
        self._lost = min(_LEAD, self._lost + gained) - lost
        return self._sound >= 0.0 and self._lost >= 0.0
