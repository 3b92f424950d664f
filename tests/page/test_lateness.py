"""The lateness of the program, distinguished from a slow connection."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from linkwright.page.audience import LoopLag


class Loop:
    """An event loop that runs its only timer on request."""

    def __init__(self) -> None:
        self.now = 0.0
        self.at = 0.0
        self.timer: Callable[[], None] | None = None

    def time(self) -> float:
        return self.now

    def call_at(self, time_s: float, timer: Callable[[], None]) -> Loop:
        self.at, self.timer = time_s, timer
        return self

    def cancel(self) -> None:
        self.timer = None

    def run(self, lateness_s: float) -> None:
        self.now = self.at + lateness_s
        assert self.timer is not None
        self.timer()


def test_lateness_is_mean_timer_delay_of_last_second():
    loop = Loop()
    lateness = LoopLag(loop)  # type: ignore[arg-type]
    assert lateness.mean == 0.0
    for _ in range(20):
        loop.run(0.08)
    assert lateness.mean == pytest.approx(0.08)
    for _ in range(20):
        loop.run(0.001)
    assert lateness.mean == pytest.approx(0.001)
    lateness.close()
    assert loop.timer is None
