"""Play a recording with the original intervals between messages, as ``ros2 bag play`` does."""

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

_MAX_BATCH = 200
"""The maximum number of messages that are published at once, so that the event loop can run other tasks in between."""

_MIN_ROUND_NS = 1_000_000
"""The minimum duration of a round in a loop, so that other tasks run even if the recording has only one message."""


@dataclass(frozen=True)
class PlayOptions:
    """The options of playback.

    Attributes:
        rate: the playback speed; 2.0 is twice the speed of the recording.
        topics: the topics to play; empty for all.
        excluded_topics: the topics that are not played.
        pattern: a regular expression; if `topics` is empty, only topics with a match in their names are played.
        without_pattern: a regular expression; topics with a match in their names are not played.
        loop: whether to repeat the recording until stopped.
        clock_hz: the rate at which the recording's time is published on ``/clock``, in Hz; 0 to publish no clock.
        clock_topics: topics whose messages are each preceded by a clock message.
        clock_before_all: whether every message is preceded by a clock message.
        delay: the time to wait at the beginning of each round, in seconds.
        start_offset: where to begin, in seconds from the start of the recording.
        duration: the duration to play, in seconds of the recording; None to play to the end.
        until_ns: the time at which to stop, in nanoseconds since the epoch; None to play to the end.
        paused: whether playback begins paused.
        qos_overrides: the QoS profiles with which topics are published, by topic.
    """

    rate: float = 1.0
    topics: Sequence[str] = ()
    excluded_topics: Sequence[str] = ()
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
    """A player that publishes the messages of a recording, on the dispatcher of a node.

    Args:
        node: the node that publishes the messages and logs events.
        bag: the recording; it must stay open during playback.
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
        self._next_message: tuple[str, int, bytes] | None = None
        self._alarm: Alarm | None = None
        self._rate = options.rate
        self._is_paused = options.paused
        self._position_ns = self._begin_ns
        self._reference_ns = 0
        self.finished = False
        """Whether everything was played, or the player was closed."""
        self.message_count = 0
        """The number of published messages."""

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
        return self._is_paused

    def start(self) -> None:
        """Start playing."""
        self._begin()

    def pause(self) -> None:
        """Pause playback if it is not paused."""
        if not self._is_paused:
            self.toggle_paused()

    def resume(self) -> None:
        """Resume playback if it is paused."""
        if self._is_paused:
            self.toggle_paused()

    def toggle_paused(self) -> None:
        """Pause or resume playback."""
        self._set_reference()
        self._is_paused = not self._is_paused
        self._logger.info("Pausing play." if self._is_paused else "Resuming play.")
        self._schedule()

    def set_rate(self, rate: float) -> None:
        """Set the playback rate.

        Raises:
            ValueError: the rate is not positive, or not finite.
        """
        if not 0 < rate < inf:
            raise ValueError(f"the rate must be positive and finite, not {rate}")
        self._set_reference()
        self._rate = rate
        self._logger.info(f"Set rate to {rate:.2f}")
        self._schedule()

    def play_next(self) -> bool:
        """Publish the next message while paused.

        Return False if there is none.
        """
        return self.burst(1) == 1

    def burst(self, count: int) -> int:
        """Publish messages while paused, and return the number of published messages.

        Args:
            count: the maximum number of messages; 0 for all remaining messages of this round.
        """
        published = 0
        while (
            self._is_paused
            and self._next_message is not None
            and not self._is_next_beyond_end()
            and (published < count or not count)
        ):
            self._position_ns = max(self._position_ns, self._next_message[1])
            self._publish_next()
            published += 1
        if published:
            self._end_or_schedule()
        return published

    def seek(self, time_ns: int) -> None:
        """Jump to another time in the recording, in nanoseconds since the epoch."""
        self._set_reference()
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
        if self._is_paused:
            return self._position_ns
        return self._position_ns + max(0, round((self._steady_ns() - self._reference_ns) * self._rate))

    # --- the round ------------------------------------------------------------------------------------------------

    def _begin(self, not_before_ns: int = 0) -> None:
        self._read_from(self._begin_ns)
        delay_ns = round(self._options.delay * NANOSECONDS_PER_SECOND)
        self._reference_ns = max(not_before_ns, self._steady_ns() + delay_ns)
        self._end_or_schedule()

    def _read_from(self, time_ns: int) -> None:
        topics = list(self._publishers)
        self._stream = self._bag.messages(topics, time_ns) if topics else iter(())
        self._next_message = next(self._stream, None)
        self._position_ns = time_ns

    def _run(self) -> None:
        self._alarm = None
        if self.finished or self._is_paused:
            return
        now = self.now_ns()
        for _ in range(_MAX_BATCH):
            if self._next_message is None or self._next_message[1] > now or self._is_next_beyond_end():
                break
            self._publish_next()
        self._end_or_schedule()

    def _publish_next(self) -> None:
        assert self._next_message is not None
        topic, stamp_ns, data = self._next_message
        if self._clock is not None and (self._options.clock_before_all or topic in self._options.clock_topics):
            self._publish_time(stamp_ns)
        self._publishers[topic].publish(data)
        self.message_count += 1
        self._next_message = next(self._stream, None)

    def _end_or_schedule(self) -> None:
        if self._next_message is not None and not self._is_next_beyond_end():
            self._schedule()
        elif self._options.loop and self.message_count:
            self._begin(self._reference_ns + _MIN_ROUND_NS)
        else:
            self.close()

    def _is_next_beyond_end(self) -> bool:
        return self._end_ns is not None and self._next_message is not None and self._next_message[1] > self._end_ns

    def _schedule(self) -> None:
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None
        if self.finished or self._is_paused or self._next_message is None:
            return
        wait_ns = round((self._next_message[1] - self._position_ns) / self._rate)
        assert self._node.handle.dispatcher is not None
        self._alarm = self._node.handle.dispatcher.call_at(self._reference_ns + max(0, wait_ns), self._run)

    def _set_reference(self) -> None:
        """Store the current playback time as the reference before the rate or the state changes."""
        self._position_ns = self.now_ns()
        self._reference_ns = self._steady_ns()

    def _steady_ns(self) -> int:
        return self._node.handle.timebase.steady_ns()

    # --- publishers -----------------------------------------------------------------------------------------------

    def _make_publishers(self) -> dict[str, Publisher[Any]]:
        options = self._options
        topics = {topic.name: topic for topic in self._bag.topics}
        self._bag.messages(list(options.topics))  # report unknown topics before playback starts
        selection = TopicSelection(
            all_topics=not options.pattern,
            names=options.topics,
            pattern=options.pattern,
            without_names=options.excluded_topics,
            without_pattern=options.without_pattern,
            include_hidden=True,
            all_services=not options.pattern,
        )
        named_topics = [topics[name] for name in options.topics or topics]
        selected_topics = [topic for topic in named_topics if selection.selects(topic.name, topic.type_name)]
        return make_publishers(self._node, selected_topics, options.qos_overrides)

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
