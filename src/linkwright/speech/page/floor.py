"""The choice of the talking page, and the limit of the sound that a page may send."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.page.audience import Page
from linkwright.page.protocol.voice import TalkMode

_RESERVE_S = 10.0
"""The seconds of sound that may arrive at once, as after a stalled connection."""

_CLOCK_TOLERANCE = 1.05
"""The factor by which a page's microphone may be faster than the server's clock."""


class Floor:
    """The pages with an open microphone.

    Of the pages with a held button, the page that has held it longest talks.
    """

    def __init__(self) -> None:
        self._modes: dict[Page, TalkMode] = {}

    def __bool__(self) -> bool:
        return bool(self._modes)

    def set(self, page: Page, mode: TalkMode) -> None:
        """Set the microphone mode of a page, which takes its turn after pages with the same mode."""
        if self._modes.get(page) == mode:
            return
        self._modes.pop(page, None)
        if mode != "off":
            self._modes[page] = mode

    @property
    def holder(self) -> Page | None:
        """The page that holds its button and talks, or None if no button is held."""
        return self._first_page("held")

    @property
    def talker(self) -> Page | None:
        """The page whose sound is published, or None if no microphone is open."""
        return self.holder or self._first_page("open")

    def _first_page(self, mode: TalkMode) -> Page | None:
        return next((page for page, page_mode in self._modes.items() if page_mode == mode), None)


class SoundBudget:
    """A limit for the sound that a page sends, and for its reported loss.

    Each may last as long as the time that has passed, with a reserve of 10 s. The two are counted separately, because a
    page may send silence for lost sound.

    Args:
        clock: returns the time in seconds.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock = clock
        self._last_time = clock()
        self._sound_budget = self._loss_budget = _RESERVE_S

    def spend(self, sound: float, lost: float) -> bool:
        """Count seconds of sound and of loss, and return whether they are within the limits."""
        now = self._clock()
        credit = (now - self._last_time) * _CLOCK_TOLERANCE
        self._last_time = now
        self._sound_budget = min(_RESERVE_S, self._sound_budget + credit) - sound
        self._loss_budget = min(_RESERVE_S, self._loss_budget + credit) - lost
        return self._sound_budget >= 0.0 and self._loss_budget >= 0.0
