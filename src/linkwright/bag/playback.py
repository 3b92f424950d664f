"""Play a recording interactively: play, pause, seek, step, speed, loop.

Recordings in files and the history of the last minutes are played in the same way. Messages are published
serialized, with the time at which they were received, so that subscribers handle them like live messages.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Iterator
from typing import Protocol

from linkwright.bag.names import Recorded
from linkwright.diagnostics import LinkwrightError
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.time.clock import Alarm

_TICK_NS = 16_000_000
"""The real time between two checks for messages to publish."""

_MAX_TICK_MESSAGES, _MAX_TICK_BYTES = 1000, 16 << 20
"""The maximum number of messages and bytes in one tick. If there are more, playback is slower but skips nothing."""

SLOWEST, FASTEST = 0.1, 10.0
"""The minimum and maximum speed."""


class Recording(Protocol):
    """The interface of recordings that can be played.

    Times are in nanoseconds since the epoch.
    """

    @property
    def start_ns(self) -> int:
        """The time of the first message."""

    @property
    def end_ns(self) -> int:
        """The time of the last message."""

    def messages(self, topics: Collection[str], start_ns: int, /) -> Iterator[Recorded]:
        """Yield the messages of topics that were received at or after a time, ordered by time."""

    def state_at(self, topics: Collection[str], at_ns: int, /) -> list[Recorded]:
        """Return the state at a time: the last message of each topic, and the transforms."""

    def time_before(self, topics: Collection[str], at_ns: int, /) -> int | None:
        """Return the reception time, in nanoseconds, of the last message before a time, or None."""


class Output(Protocol):
    """The interface for destinations of played messages."""

    def subscribed_topics(self) -> frozenset[str]:
        """Return the topics of the recording that have subscribers."""

    def publish_time(self, stamp_ns: int, /) -> None:
        """Set the time of playback, in nanoseconds since the epoch."""

    def publish(self, topic: str, stamp_ns: int, data: bytes, /) -> None:
        """Publish a message that was received at a time, in nanoseconds since the epoch."""


class Playback:
    """The interactive playback of a recording.

    Args:
        node: the node whose dispatcher runs the playback.
        recording: the recording to play.
        output: the destination of the messages.
        on_error: called with the error if the recording can no longer be read; playback is then paused.

    Attributes:
        position_ns: the playback position, in nanoseconds since the epoch; all messages up to it have been published.
        playing: whether playback is running.
        speed: the number of recorded seconds per real second.
        loop: whether playback restarts at the end.
        seeks: the number of finished seeks, including those whose position could not be read.
        changed: functions that are called when one of these attributes changes, except by the passing of time.
        on_reset: called when playback jumps to another time, so that subscribers can drop their state.
    """

    def __init__(
        self, node: NodeHandle, recording: Recording, output: Output, on_error: Callable[[LinkwrightError], object]
    ) -> None:
        self._node = node
        self._recording = recording
        self._output = output
        self._on_error = on_error
        self._subscribed_topics: frozenset[str] = frozenset()
        self._stream: Iterator[Recorded] = iter(())
        self._next_message: Recorded | None = None
        self._alarm: Alarm | None = None
        self._last_tick_ns = 0
        self._target_ns: int | None = None
        self.position_ns = recording.start_ns
        self.playing = False
        self.speed = 1.0
        self.loop = False
        self.seeks = 0
        self.changed: list[Callable[[], object]] = []
        self.on_reset: Callable[[], object] = lambda: None

    @property
    def start_ns(self) -> int:
        """The time of the first message, in nanoseconds since the epoch."""
        return self._recording.start_ns

    @property
    def end_ns(self) -> int:
        """The time of the last message, in nanoseconds since the epoch."""
        return self._recording.end_ns

    def play(self) -> None:
        """Start playing.

        If the position is at the end, start from the beginning.
        """
        if self.playing:
            return
        if self._target() >= self.end_ns:
            self.seek(self.start_ns)
        self.playing = True
        self._last_tick_ns = self._steady_ns()
        self._set_alarm()
        self._notify()

    def pause(self) -> None:
        """Pause the playback."""
        if self.playing:
            self._stop()
            self._notify()

    def set_speed(self, speed: float) -> None:
        """Set the speed, clamped to the range from `SLOWEST` to `FASTEST`."""
        self.speed = min(FASTEST, max(SLOWEST, speed))
        self._notify()

    def set_loop(self, loop: bool) -> None:
        """Set whether to restart at the end."""
        self.loop = loop
        self._notify()

    def seek(self, stamp_ns: int) -> None:
        """Jump to another time in the next iteration of the event loop.

        Of several pending seeks, only the last one takes effect. The new time is published first. The messages of the
        new state follow one iteration of the event loop later, because subscribers drop their state when the clock goes
        back.
        """
        is_pending = self._target_ns is not None
        self._target_ns = min(self.end_ns, max(self.start_ns, stamp_ns))
        if not is_pending:
            asyncio.get_running_loop().call_soon(self._begin_seek)

    def step(self, forward: bool, topic: str = "") -> None:
        """Pause, and step to the next or the previous message.

        Args:
            forward: True for the next message, False for the previous one.
            topic: the topic of that message; empty for any subscribed topic.
        """
        self.pause()
        try:
            if not forward:
                previous_ns = self._recording.time_before({topic} if topic else self._subscribed_topics, self._target())
                if previous_ns is not None:
                    self.seek(previous_ns)
            elif topic:
                self._step_to_next_of(topic)
            elif self._target_ns is None:
                self._next_message = next(self._stream, None) if self._next_message is None else self._next_message
                if self._next_message is not None:
                    self._publish_until(self._next_message[1])
                    self._notify()
        except LinkwrightError as error:
            self._fail(error)

    def _step_to_next_of(self, topic: str) -> None:
        """Play up to the next message of a topic.

        If there are too many messages before it for one iteration of the event loop, jump to it instead.
        """
        next_message = next(self._recording.messages({topic}, self._target() + 1), None)
        if self._target_ns is None:
            self._open_stream()  # reading ahead closed the stream, because a file supports only one
            if next_message is not None:
                self._publish_until(next_message[1])
        if next_message is not None and self._target() < next_message[1]:
            self.seek(next_message[1])
        self._notify()

    def continue_from(self, stamp_ns: int) -> None:
        """Continue from a time at which the subscribers already have the state."""
        self.position_ns, self._target_ns = stamp_ns, None
        self._subscribed_topics = self._output.subscribed_topics()
        self._open_stream()

    def messages_before(self, topics: Collection[str], length_ns: int, max_bytes: int) -> list[Recorded]:
        """Return the messages of topics shortly before the current position.

        Args:
            topics: the names of the topics.
            length_ns: the duration to read before the position.
            max_bytes: the maximum total size of the messages; if it is exceeded, the result is empty.
        """
        messages: list[Recorded] = []
        size = 0
        try:
            for message in self._recording.messages(topics, self.position_ns - length_ns):
                size += len(message[2])
                if message[1] > self.position_ns:
                    break
                if size > max_bytes:
                    messages = []
                    break
                messages.append(message)
            self._open_stream()  # reading back closed the stream, because a file supports only one
        except LinkwrightError as error:
            self._fail(error)
        return messages

    def update_subscribed_topics(self) -> None:
        """Update the set of subscribed topics.

        Publish the last message of each topic that was added.
        """
        topics = self._output.subscribed_topics()
        if topics == self._subscribed_topics or self._target_ns is not None:
            return
        new_topics, self._subscribed_topics = topics - self._subscribed_topics, topics
        try:
            for message in self._recording.state_at(new_topics, self.position_ns) if new_topics else ():
                self._output.publish(*message)
            self._open_stream()
        except LinkwrightError as error:
            self._fail(error)

    def close(self) -> None:
        """Stop playing, and remove the listeners.

        The recording stays open.
        """
        self._stop()
        self.changed.clear()
        self._stream, self._next_message = iter(()), None

    def _target(self) -> int:
        return self.position_ns if self._target_ns is None else self._target_ns

    def _begin_seek(self) -> None:
        self._output.publish_time(self._target())
        asyncio.get_running_loop().call_soon(self._finish_seek)

    def _finish_seek(self) -> None:
        self.position_ns, self._target_ns = self._target(), None
        self.seeks += 1
        self._subscribed_topics = self._output.subscribed_topics()
        try:
            state = self._recording.state_at(self._subscribed_topics, self.position_ns)
            self._open_stream()
        except LinkwrightError as error:
            self._fail(error)
            return
        self._output.publish_time(self.position_ns)
        self.on_reset()
        for message in state:
            self._output.publish(*message)
        self._last_tick_ns = self._steady_ns()
        self._notify()

    def _open_stream(self) -> None:
        """Open the stream of the messages after the current position."""
        self._stream = (
            self._recording.messages(self._subscribed_topics, self.position_ns + 1)
            if self._subscribed_topics
            else iter(())
        )
        self._next_message = next(self._stream, None)

    def _tick(self) -> None:
        self._alarm = None
        if not self.playing:
            return
        now = self._steady_ns()
        elapsed, self._last_tick_ns = now - self._last_tick_ns, now
        if self._target_ns is None:
            end = self.end_ns  # the end moves while the recording is still being written
            try:
                self._publish_until(min(end, self.position_ns + round(elapsed * self.speed)))
            except LinkwrightError as error:
                self._fail(error)
                return
            if self.position_ns >= end and self.loop:
                self.seek(self.start_ns)
            elif self.position_ns >= end:
                self.pause()
                return
        self._set_alarm()

    def _publish_until(self, stamp_ns: int) -> None:
        """Publish the messages up to a time, but no more than one tick allows."""
        self._output.publish_time(stamp_ns)
        if self._next_message is None:
            self._next_message = next(self._stream, None)  # a recording in progress may have new messages
        size = 0
        for _ in range(_MAX_TICK_MESSAGES):
            if self._next_message is None or self._next_message[1] > stamp_ns:
                break
            if size > _MAX_TICK_BYTES:
                stamp_ns = self._next_message[1] - 1
                break
            self._output.publish(*self._next_message)
            size += len(self._next_message[2])
            self._next_message = next(self._stream, None)
        else:
            if self._next_message is not None and self._next_message[1] <= stamp_ns:
                stamp_ns = self._next_message[1] - 1
        self.position_ns = max(self.position_ns, stamp_ns)

    def _set_alarm(self) -> None:
        assert self._node.dispatcher is not None
        self._alarm = self._node.dispatcher.call_at(self._steady_ns() + _TICK_NS, self._tick)

    def _stop(self) -> None:
        self.playing = False
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def _fail(self, error: LinkwrightError) -> None:
        self._stop()
        self._on_error(error)
        self._notify()

    def _notify(self) -> None:
        for listener in self.changed:
            listener()

    def _steady_ns(self) -> int:
        return self._node.timebase.steady_ns()
