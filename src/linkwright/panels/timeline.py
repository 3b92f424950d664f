"""The timeline, playback and Time panel, for pages."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.diagnostics import LinkwrightError, join_messages
from linkwright.graph import Duration, JumpThreshold, TimeJump
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage
from linkwright.page.protocol.time import (
    Clock,
    GoLive,
    HistoryExtent,
    Play,
    Playhead,
    ResetTime,
    SeekTime,
    SetPlayback,
    SetTime,
    StepTime,
    Timeline,
    TimelineTopic,
    TimeReset,
    TimeState,
    WatchClock,
)
from linkwright.panels.live_history import LiveHistory
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from linkwright.bag.names import Recorded
    from linkwright.bag.playback import Playback
    from linkwright.bag.reading import BagReader
    from linkwright.graph import JumpHandle
    from linkwright.rviz.visualization.manager import VisualizationManager


_CLOCK_PERIOD_S = 0.1
"""Seconds between two checks of clocks that pages cannot advance by themselves."""


@dataclass(slots=True)
class _ElapsedStart:
    """The start of the elapsed times, in ROS time and in wall time, in ns since the epoch."""

    ros: int
    wall: int


class TimeFeature(PageFeature):
    """The feature that sends the values of the Time panel to pages, and applies its settings.

    A clock that runs at the speed of the wall clock is sent once, and pages advance it themselves. Other clocks are
    sent while they change.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (SetTime, ResetTime, WatchClock)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._elapsed_starts: dict[VisualizationManager, _ElapsedStart] = {}
        self._sent_clocks: dict[Page, Clock | None] = {}
        self._timer: asyncio.TimerHandle | None = None
        self._jump_handle: JumpHandle | None = None
        self._loop = asyncio.get_running_loop()

    def start(self) -> None:
        """Start watching the clock.

        If simulated time jumps back, everything is reset, as in RViz.
        """
        threshold = JumpThreshold(min_forward=None, min_backward=Duration(nanoseconds=-1), on_clock_change=True)
        self._jump_handle = self.context.node.get_clock().create_jump_callback(threshold, post_callback=self._on_jump)

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the state of the Time panel."""
        self._begin(manager)
        return [_make_state(manager)]

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Discard the start of the manager's elapsed times."""
        self._elapsed_starts.pop(manager, None)

    def receive(self, page: Page, message: Any) -> None:
        """Apply settings of the Time panel, or start or stop sending clocks to the page."""
        manager = self.managers.of(page)
        if isinstance(message, SetTime):
            manager.set_time(paused=message.paused, mode=message.mode, source=message.source)
            self._publish_all()
        elif isinstance(message, ResetTime):
            self._reset(manager)
        elif isinstance(message, WatchClock):
            if message.watching:
                self._sent_clocks.setdefault(page, None)
                self._tick()
            else:
                self.remove_page(page)

    def remove_page(self, page: Page) -> None:
        """Stop sending clocks to the page."""
        self._sent_clocks.pop(page, None)

    def close(self) -> None:
        """Stop sending clocks."""
        if self._timer is not None:
            self._timer.cancel()
        if self._jump_handle is not None:
            self._jump_handle.unregister()

    def _begin(self, manager: VisualizationManager) -> _ElapsedStart:
        elapsed_start = self._elapsed_starts.get(manager)
        if elapsed_start is None or elapsed_start.ros == 0:  # simulated time is 0 until the first message of /clock
            now = manager.time.now_ns()
            elapsed_start = self._elapsed_starts[manager] = _ElapsedStart(
                now, time.time_ns() if elapsed_start is None else elapsed_start.wall
            )
        return elapsed_start

    def _reset(self, manager: VisualizationManager) -> None:
        manager.reset_time()
        self._elapsed_starts.pop(manager, None)
        self._begin(manager)
        manager.publish(TimeReset())
        self._publish_all()

    def _on_jump(self, jump: TimeJump) -> None:
        if self.context.held_time.switching:
            return

        def reset() -> None:
            for manager in self.managers.all():
                self._reset(manager)

        # The callback can run in any thread, because messages of /clock change the time.
        self._loop.call_soon_threadsafe(reset)

    def _publish_all(self) -> None:
        for page in self._sent_clocks:
            self._sent_clocks[page] = None
        self._tick()

    def _tick(self) -> None:
        """Send changed clocks to the pages that watch them, and schedule the next check if needed."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        must_repeat = False
        for page, sent_clock in list(self._sent_clocks.items()):
            clock = self._make_clock(self.managers.of(page))
            must_repeat = must_repeat or not clock.running
            if (
                sent_clock is None
                or (not clock.running and clock.ros != sent_clock.ros)
                or clock.running != sent_clock.running
            ):
                page.send(clock)
                self._sent_clocks[page] = clock
        if must_repeat:
            self._timer = self._loop.call_later(_CLOCK_PERIOD_S, self._tick)

    def _make_clock(self, manager: VisualizationManager) -> Clock:
        elapsed_start, time_control = self._begin(manager), manager.time
        is_simulated = self.context.node.get_clock().ros_time_is_active
        return Clock(
            ros=time_control.now_ns() / 1e9,
            ros_start=elapsed_start.ros / 1e9,
            wall=time.time(),
            wall_start=elapsed_start.wall / 1e9,
            running=not (is_simulated or time_control.paused or time_control.mode == "Exact"),
        )


def _make_state(manager: VisualizationManager) -> TimeState:
    time_control = manager.time
    return TimeState(time_control.paused, time_control.mode, time_control.source, list(time_control.sources))


_PLAYHEAD_PERIOD_S = 0.1
"""Seconds between two positions that are sent to pages while a recording plays."""

_COUNT_INTERVALS = 200
"""The number of equal intervals of a recording for which messages are counted."""

_EXTENT_PERIOD_S = 1.0
"""Seconds between two messages to pages about the extent of the live history."""

_CAUGHT_UP_NS = 100_000_000
"""The time to the present in ns at which playback of the last minutes becomes live."""


class TimelineFeature(PageFeature):
    """The feature that controls playback of a recording or of the last minutes.

    The position is sent to pages.

    Without a recording or a live history, the feature has no effect. A recording starts to play when the first page
    opens.

    Attributes:
        on_jump: callbacks that are called when the displayed time jumps.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (Play, SeekTime, StepTime, SetPlayback, GoLive)
    BEFORE_DISPLAYS = True

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._playback: Playback | None = None
        self._timeline: Timeline | None = None
        self._problem: str = ""
        self._is_started = False
        self._timer: asyncio.TimerHandle | None = None
        self._publish_timer: asyncio.TimerHandle | None = None
        self._live: LiveHistory | None = None
        self._was_playing = False
        self._was_live = True
        self.on_jump: list[Callable[[], object]] = []
        self._loop = asyncio.get_running_loop()

    def attach(self, playback: Playback, bag: BagReader) -> None:
        """Show a recording to pages.

        A read error must be reported with `show_error`.
        """
        from linkwright.bag.publishing import find_missing_types

        counts = bag.counts(_COUNT_INTERVALS)
        topics = [
            TimelineTopic(topic_info.name, topic_info.type_name, topic_info.count, counts.get(topic_info.name, []))
            for topic_info in bag.topics
        ]
        if self._live is not None:
            self._live.close()
            self._live = None
        self._timeline = Timeline(
            bag.path.name,
            bag.start_ns / NANOSECONDS_PER_SECOND,
            bag.end_ns / NANOSECONDS_PER_SECOND,
            topics,
            live=False,
        )
        if findings := [*bag.findings, *find_missing_types(bag)]:
            self._problem = join_messages(findings)
        self._playback = playback
        playback.on_reset = self._reset
        playback.changed.append(self._on_change)
        self.context.graph_changes.watch(playback.update_subscribed_topics)
        self.context.pages.publish(self._timeline)
        self._on_change()

    def start_history(self, max_bytes: int) -> LiveHistory:
        """Start storing the messages of the last minutes, and return their history.

        Args:
            max_bytes: the maximum size of the stored messages.
        """
        self._live = LiveHistory(self.context, max_bytes, self.show_error)
        self._live.on_reset = self._reset
        self._live.changed = self._on_change
        return self._live

    def show_error(self, error: LinkwrightError) -> None:
        """Show the error that makes the rest of the recording unreadable."""
        self._problem = join_messages(error.diagnostics)
        for diagnostic in error.diagnostics:
            self.context.report(diagnostic)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the extent of the recording or the history, and the current position."""
        playback = self._playback
        if self._live is not None:
            extent = self._make_extent(self._live)
            self._publish_extent_later()
            return [Timeline("", extent.start, extent.end, [], live=True), extent, self._make_live_playhead(self._live)]
        if playback is None or self._timeline is None:
            return []
        if not self._is_started:
            self._is_started = True
            playback.update_subscribed_topics()
            playback.play()
        return [self._timeline, self._make_playhead(playback)]

    def receive(self, page: Page, message: Play | SeekTime | StepTime | SetPlayback | GoLive) -> None:
        """Handle a request to play, pause, move to a time, or return to the present."""
        from linkwright.bag.playback import FASTEST, SLOWEST

        playback = self._playback if self._live is None else self._live.playback
        if playback is None:
            return
        self._problem = ""
        if self._live is not None:
            if isinstance(message, GoLive) or (message == Play(True) and self._live.live):
                self._live.go_live()
                return
            if not isinstance(message, SetPlayback):
                self._live.freeze()
        match message:
            case Play(playing):
                playback.play() if playing else playback.pause()
            case SeekTime(position) if isfinite(position):
                start = playback.start_ns
                # Compute relative to the start, because a float with seconds since the epoch is precise to about 0.1
                # us only.
                playback.seek(start + round((position - start / NANOSECONDS_PER_SECOND) * NANOSECONDS_PER_SECOND))
            case StepTime(forward, topic):
                playback.step(forward, topic)
            case SetPlayback(speed, loop) if SLOWEST <= speed <= FASTEST:
                playback.set_speed(speed)
                playback.set_loop(loop)

    def messages_before(self, topics: Collection[str], seconds: float, max_bytes: int) -> list[Recorded]:
        """Return the stored messages of topics for a duration before the displayed time.

        Args:
            topics: the topics; the history of the last minutes has only topics that the viewer is subscribed to.
            seconds: the duration, in seconds.
            max_bytes: the maximum total size in bytes; if the messages exceed it, the list is empty.
        """
        if self._live is None and self._playback is None:
            return []
        source = self._playback if self._live is None else self._live
        assert source is not None
        return source.messages_before(topics, round(seconds * NANOSECONDS_PER_SECOND), max_bytes)

    def close(self) -> None:
        """Stop playing."""
        if self._timer is not None:
            self._timer.cancel()
        if self._publish_timer is not None:
            self._publish_timer.cancel()
        if self._live is not None:
            self._live.close()
        elif self._playback is not None:
            self.context.graph_changes.unwatch(self._playback.update_subscribed_topics)
            self._playback.close()

    def _reset(self) -> None:
        """Discard the displayed and queued messages, because the displayed time has jumped."""
        for subscription in self.context.node.subscriptions:
            subscription.discard()
        for manager in self.managers.all():
            manager.reset_time()
            manager.publish(TimeReset())
        self._notify_jump()

    def _notify_jump(self) -> None:
        for jumped in self.on_jump:
            jumped()

    def _on_change(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
        live = self._live
        if live is not None and live.live is not self._was_live:
            self._was_live = live.live
            if live.live:
                self._notify_jump()
        if live is not None and not live.live:
            playing = live.playback.playing
            has_caught_up = live.span_ns[1] - live.playback.position_ns < _CAUGHT_UP_NS
            if self._was_playing and not playing and has_caught_up:
                live.go_live()
            self._was_playing = playing
        playback = self._playback if live is None else live.playback
        if playback is not None:
            self.context.pages.publish(self._make_playhead(playback))
            if playback.playing:
                self._timer = self._loop.call_later(_PLAYHEAD_PERIOD_S, self._on_change)

    def _make_playhead(self, playback: Playback) -> Playhead:
        position = playback.position_ns / NANOSECONDS_PER_SECOND
        live = self._live is not None and self._live.live
        return Playhead(position, playback.playing, playback.speed, playback.loop, playback.seeks, self._problem, live)

    def _make_live_playhead(self, live: LiveHistory) -> Playhead:
        if live.has_playback:
            return self._make_playhead(live.playback)
        return Playhead(live.span_ns[0] / NANOSECONDS_PER_SECOND, False, 1.0, False, 0, self._problem, live=True)

    def _make_extent(self, live: LiveHistory) -> HistoryExtent:
        start_ns, end_ns = live.span_ns
        return HistoryExtent(
            start_ns / NANOSECONDS_PER_SECOND, end_ns / NANOSECONDS_PER_SECOND, live.size, live.max_bytes
        )

    def _publish_extent_later(self) -> None:
        if self._publish_timer is None:
            self._publish_timer = self._loop.call_later(_EXTENT_PERIOD_S, self._publish_extent)

    def _publish_extent(self) -> None:
        """Send the extent of the history to pages.

        While any pages are open, also schedule the next message.
        """
        self._publish_timer = None
        if self._live is not None and len(self.context.pages):
            self.context.pages.publish(self._make_extent(self._live))
            self._publish_extent_later()
