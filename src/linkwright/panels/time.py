"""The Time panel: pause, synchronization, clocks and Reset."""

from __future__ import annotations

import asyncio
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.graph import Duration, JumpThreshold, TimeJump
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.time import Clock, ResetTime, SetTime, TimeReset, TimeState, WatchClock
from linkwright.panels.page_feature import FeatureHost, PageFeature

if TYPE_CHECKING:
    from linkwright.graph import JumpHandle
    from linkwright.rviz.visualization.manager import VisualizationManager

_PERIOD = 0.1
"""Seconds between two checks of clocks that pages cannot count by themselves."""


@dataclass(slots=True)
class _Since:
    """The start of elapsed times, nanoseconds."""

    ros: int
    wall: int


class TimeFeature(PageFeature):
    """The Time panel of pages.

    Clocks that run as the wall clock does are sent once, and pages count on; others are sent while they change.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (SetTime, ResetTime, WatchClock)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._since: dict[VisualizationManager, _Since] = {}
        self._watching: dict[Page, Clock | None] = {}
        self._timer: asyncio.TimerHandle | None = None
        self._jumps: JumpHandle | None = None
        self._loop = asyncio.get_running_loop()

    def start(self) -> None:
        """Reset time whenever simulated time goes back, as RViz does."""
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        self._jumps = self.context.node.get_clock().create_jump_callback(threshold, post_callback=self._jumped)

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the state of time."""
        self._begin(manager)
        return [_state(manager)]

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Forget the start of its time."""
        self._since.pop(manager, None)

    def receive(self, page: Page, message: Any) -> None:
        """Carry out a request."""
        manager = self.managers.of(page)
        if isinstance(message, SetTime):
            manager.set_time(paused=message.paused, mode=message.mode, source=message.source)
            self._publish_all()
        elif isinstance(message, ResetTime):
            self._reset(manager)
        elif isinstance(message, WatchClock):
            if message.watching:
                self._watching.setdefault(page, None)
                self._tick()
            else:
                self.page_closed(page)

    def page_closed(self, page: Page) -> None:
        """Stop sending the page clocks."""
        self._watching.pop(page, None)

    def close(self) -> None:
        """Stop sending clocks."""
        if self._timer is not None:
            self._timer.cancel()
        if self._jumps is not None:
            self._jumps.unregister()

    # -----------------------------------------------------------------------------------------------------------

    def _begin(self, manager: VisualizationManager) -> _Since:
        known = self._since.get(manager)
        if known is None or known.ros == 0:  # simulated time is zero until it is published, and elapses from then on
            now = manager.time.now_ns()
            known = self._since[manager] = _Since(now, time.time_ns() if known is None else known.wall)
        return known

    def _reset(self, manager: VisualizationManager) -> None:
        manager.reset_time()
        self._since.pop(manager, None)
        self._begin(manager)
        manager.publish(TimeReset())
        self._publish_all()

    def _jumped(self, jump: TimeJump) -> None:
        if self.context.held_time.switching:
            return

        def reset() -> None:
            for manager in self.managers.all():
                self._reset(manager)

        # A message of /clock moves the clock, in any thread.
        self._loop.call_soon_threadsafe(reset)

    def _publish_all(self) -> None:
        for page in self._watching:
            self._watching[page] = None
        self._tick()

    def _tick(self) -> None:
        """Send the clocks to each page that watches them, unless it counts them itself."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        moving = False
        for page, sent in list(self._watching.items()):
            clock = self._clock(self.managers.of(page))
            moving = moving or not clock.running
            if sent is None or (not clock.running and clock.ros != sent.ros) or clock.running != sent.running:
                page.send(clock)
                self._watching[page] = clock
        if moving:
            self._timer = self._loop.call_later(_PERIOD, self._tick)

    def _clock(self, manager: VisualizationManager) -> Clock:
        since, control = self._begin(manager), manager.time
        simulated = self.context.node.get_clock().ros_time_is_active
        return Clock(
            ros=control.now_ns() / 1e9,
            ros_start=since.ros / 1e9,
            wall=time.time(),
            wall_start=since.wall / 1e9,
            running=not (simulated or control.paused or control.mode == "Exact"),
        )


def _state(manager: VisualizationManager) -> TimeState:
    control = manager.time
    return TimeState(control.paused, control.mode, control.source, list(control.sources))
