"""Plays a recording with the original intervals between messages, as ``ros2 bag play`` does."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any

from linkwright.bag.publishing import make_publishers
from linkwright.bag.reading import BagReader
from linkwright.bag.selection import TopicSelection
from linkwright.graph import Node, Publisher, QoSProfile
from linkwright.graph.time.clock import Alarm
from linkwright.messages import Time, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_AT_ONCE = 200
"""Messages that are due are published this many at a time, so that the loop can serve others in between."""

_SHORTEST_ROUND_NS = 1_000_000
"""How long a round of a looped recording takes at least, so that others are served where it has but one message."""


@dataclass(frozen=True)
class PlayOptions:
    """The options of playback.

    Attributes:
        rate: the playback speed; 2.0 is twice the speed of the recording.
        topics: the topics to play; empty for all.
        without: the topics to exclude.
        pattern: a regular expression; if `topics` is empty, only topics whose names contain a match are played.
        without_pattern: a regular expression; topics whose names contain a match are excluded.
        loop: whether to restart at the end, without a limit.
        clock_hz: the rate at which the recording's time is published on ``/clock``, in Hz; 0 to publish no clock.
        clock_topics: topics whose messages are each preceded by a clock message.
        clock_before_all: whether every message is preceded by a clock message.
        delay: the time to wait at the beginning of each round, in seconds.
        start_offset: the position at which to begin, in seconds from the start of the recording.
        duration: the duration to play, in seconds of the recording; None for all.
        until_ns: the time at which to end, in nanoseconds since the epoch; None to play to the end.
        paused: whether playback begins paused.
        qos_overrides: topic -> the QoS profile to publish with.
    """

    rate: float = 1.0
    topics: Sequence[str] = ()
    without: Sequence[str] = ()
    pattern: str = ""
    without_pattern: str = ""
    loop: bool = False
    clock_hz: float = 0.0
    clock_topics: Sequence[str] = ()
    clock_before_all: bool = False
    delay: float = 0.0
    start_offset: float = 0.0
    duration: float | None = None
    until_ns: int | None = None
    paused: bool = False
    qos_overrides: Mapping[str, QoSProfile] = field(default_factory=dict)


class Player:
    """Plays a recording on the dispatcher of a node.

    Args:
        node: the node that publishes; its log reports events.
        bag: the recording, which must stay open during playback.
        options: the options of playback.

    Raises:
        LinkwrightError: BAG103, a topic is not in the recording.
    """

    def __init__(self, node: Node, bag: BagReader, options: PlayOptions) -> None:
        self._node = node
        self._bag = bag
        self._options = options
        self._logger = node.get_logger()
        self._publishers = self._make_publishers()
        self._clock = self._start_clock()
        self._begin_ns = bag.start_ns + round(options.start_offset * NANOSECONDS_PER_SECOND)
        ends = [] if options.until_ns is None else [options.until_ns]
        if options.duration is not None:
            ends.append(self._begin_ns + round(options.duration * NANOSECONDS_PER_SECOND))
        self._end_ns = min(ends, default=None)
        self._stream: Iterator[tuple[str, int, bytes]] = iter(())
        self._next: tuple[str, int, bytes] | None = None
        self._alarm: Alarm | None = None
        self._rate = options.rate
        self._paused = options.paused
        self._position_ns = self._begin_ns
        self._since_ns = 0
        self.finished = False
        """Whether everything was played, or the player was closed."""
        self.message_count = 0
        """How many messages were published."""

    @property
    def publishers(self) -> tuple[Publisher[Any], ...]:
        """The publishers of the played topics."""
        return tuple(self._publishers.values())

    @property
    def rate(self) -> float:
        """The playback rate."""
        return self._rate

    @property
    def paused(self) -> bool:
        """Whether playback is paused."""
        return self._paused

    def start(self) -> None:
        """Start playing."""
        self._begin()

    def pause(self) -> None:
        """Pause playback, unless it is paused already."""
        if not self._paused:
            self.toggle_paused()

    def resume(self) -> None:
        """Resume playback if it is paused."""
        if self._paused:
            self.toggle_paused()

    def toggle_paused(self) -> None:
        """Pause or resume playback."""
        self._anchor()
        self._paused = not self._paused
        self._logger.info("Pausing play." if self._paused else "Resuming play.")
        self._schedule()

    def set_rate(self, rate: float) -> None:
        """Set the playback rate.

        Raises:
            ValueError: the rate is not positive, or not finite.
        """
        if not 0 < rate < inf:
            raise ValueError(f"a rate must be positive, not {rate}")
        self._anchor()
        self._rate = rate
        self._logger.info(f"Set rate to {rate:.2f}")
        self._schedule()

    def play_next(self) -> bool:
        """Publish the next message while paused, and return whether there was one."""
        return self.burst(1) == 1

    def burst(self, count: int) -> int:
        """Publish messages while paused, and return how many were published.

        Args:
            count: the number of messages; 0 for all remaining messages of this round.
        """
        published = 0
        while (
            self._paused and self._next is not None and not self._is_beyond_end() and (published < count or not count)
        ):
            self._position_ns = max(self._position_ns, self._next[1])
            self._publish_next()
            published += 1
        if published:
            self._end_or_schedule()
        return published

    def seek(self, time_ns: int) -> None:
        """Jump to another time in the recording, in nanoseconds since the epoch."""
        self._anchor()
        self._read_from(max(time_ns, self._bag.start_ns))
        self._end_or_schedule()

    def close(self) -> None:
        """Stop playing."""
        self.finished = True
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def now_ns(self) -> int:
        """Return the current time in the recording, in nanoseconds since the epoch."""
        if self._paused:
            return self._position_ns
        return self._position_ns + max(0, round((self._steady_ns() - self._since_ns) * self._rate))

    # --- the round ------------------------------------------------------------------------------------------------

    def _begin(self, not_before_ns: int = 0) -> None:
        self._read_from(self._begin_ns)
        delay_ns = round(self._options.delay * NANOSECONDS_PER_SECOND)
        self._since_ns = max(not_before_ns, self._steady_ns() + delay_ns)
        self._end_or_schedule()

    def _read_from(self, time_ns: int) -> None:
        topics = list(self._publishers)
        self._stream = self._bag.messages(topics, time_ns) if topics else iter(())
        self._next = next(self._stream, None)
        self._position_ns = time_ns

    def _run(self) -> None:
        self._alarm = None
        if self.finished or self._paused:
            return
        now = self.now_ns()
        for _ in range(_AT_ONCE):
            if self._next is None or self._next[1] > now or self._is_beyond_end():
                break
            self._publish_next()
        self._end_or_schedule()

    def _publish_next(self) -> None:
        assert self._next is not None
        topic, stamp_ns, data = self._next
        if self._clock is not None and (self._options.clock_before_all or topic in self._options.clock_topics):
            self._publish_time(stamp_ns)
        self._publishers[topic].publish(data)
        self.message_count += 1
        self._next = next(self._stream, None)

    def _end_or_schedule(self) -> None:
        if self._next is not None and not self._is_beyond_end():
            self._schedule()
        elif self._options.loop and self.message_count:
            self._begin(self._since_ns + _SHORTEST_ROUND_NS)
        else:
            self.close()

    def _is_beyond_end(self) -> bool:
        return self._end_ns is not None and self._next is not None and self._next[1] > self._end_ns

    def _schedule(self) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        if self.finished or self._paused or self._next is None:
            return
        wait_ns = round((self._next[1] - self._position_ns) / self._rate)
        assert self._node.handle.dispatcher is not None
        self._alarm = self._node.handle.dispatcher.call_at(self._since_ns + max(0, wait_ns), self._run)

    def _anchor(self) -> None:
        """Make the current moment the origin of the playback time, before the rate changes."""
        self._position_ns = self.now_ns()
        self._since_ns = self._steady_ns()

    def _steady_ns(self) -> int:
        return self._node.handle.timebase.steady_ns()

    # --- publishers -----------------------------------------------------------------------------------------------

    def _make_publishers(self) -> dict[str, Publisher[Any]]:
        options = self._options
        topics = {topic.name: topic for topic in self._bag.topics}
        self._bag.messages(list(options.topics))  # report unknown topics before playback starts
        selection = TopicSelection(
            everything=not options.pattern,
            names=options.topics,
            pattern=options.pattern,
            without_names=options.without,
            without_pattern=options.without_pattern,
            hidden=True,
            every_service=not options.pattern,
        )
        named = [topics[name] for name in options.topics or topics]
        chosen = [topic for topic in named if selection.takes(topic.name, topic.type_name)]
        return make_publishers(self._node, chosen, options.qos_overrides)

    def _start_clock(self) -> Publisher[Any] | None:
        options = self._options
        if not (options.clock_hz or options.clock_topics or options.clock_before_all):
            return None
        publisher: Publisher[Any] = self._node.create_publisher(get_message("rosgraph_msgs/msg/Clock"), "/clock", 10)
        if options.clock_hz:
            self._node.create_timer(1.0 / options.clock_hz, lambda: self._publish_time(self.now_ns()))
        return publisher

    def _publish_time(self, stamp_ns: int) -> None:
        if self._clock is not None:
            self._clock.publish(self._clock.msg_type(clock=Time.from_nanoseconds(stamp_ns)))
