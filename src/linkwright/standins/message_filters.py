"""Filters that hand messages on, keep them, or match those of several topics (the API of ``message_filters``).

What is matched with what, and in which order, follows the Python modules of ``message_filters`` of Humble to Kilted.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from linkwright.graph.time.clock import ROSClock
from linkwright.graph.time.values import Duration, Time
from linkwright.standins.rclpy_api.logging import get_logger

_HEADERLESS = (
    "can not use message filters messages without timestamp infomation when 'allow_headerless' is disabled. "
    "auto assign ROSTIME to headerless messages once enabling constructor option of 'allow_headerless'."
)


class SimpleFilter:
    """The base of filters: an output that callbacks and other filters connect to.

    Attributes:
        callbacks: each callback with the arguments that it gets after those of the filter, by its number.
    """

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: Any) -> int:
        """Register a callback that gets each output, followed by `args`. Returns its number in `callbacks`."""
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Put something out."""
        for callback, arguments in tuple(self.callbacks.values()):
            callback(*msg, *arguments)


class Subscriber(SimpleFilter):
    """A subscription as the first filter of a chain, with the attributes of the subscription.

    Args:
        node: the node that subscribes.
        msg_type: the message class.
        topic: its name.
        qos_profile: what is asked for; a number is a depth.
        arguments: what else ``Node.create_subscription`` takes.
    """

    def __init__(self, node: Any, msg_type: type, topic: str, *, qos_profile: Any = 10, **arguments: Any) -> None:
        super().__init__()
        self.node = node
        self.topic = topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **arguments)

    def callback(self, msg: Any) -> None:
        """Put a message out."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """The name of the topic as it was given."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # where the constructor failed
            raise AttributeError(key)
        return getattr(self.sub, key)


class Cache(SimpleFilter):
    """Keeps the newest messages of a filter for look-ups by time, and passes each one on.

    Args:
        f: the filter whose messages are kept.
        cache_size: how many are.
        allow_headerless: whether messages without a stamp are taken, as of the moment that they arrive.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self.allow_headerless = allow_headerless
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Keep the messages of a filter."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Keep a message; the oldest goes when there are too many."""
        stamp = _time_of(msg, allow_headerless=self.allow_headerless, logger="message_filters_cache")
        if stamp is None:
            return
        self.cache_msgs.append(msg)
        self.cache_times.append(stamp)
        del self.cache_msgs[: -self.cache_size], self.cache_times[: -self.cache_size]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """The messages from a time to a time, both included."""
        assert from_stamp <= to_stamp, "the interval ends before it begins"
        return [msg for msg, time in self._kept() if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """The first message that is not older than a time; None where there is none."""
        return next((msg for msg, time in self._kept() if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """The last message that is not newer than a time; None where there is none."""
        older = [msg for msg, time in self._kept() if time <= stamp]
        return older[-1] if older else None

    def getLatestTime(self) -> Time | None:
        """The time of the last message; None without any."""
        return self.cache_times[-1] if self.cache_times else None

    getLastestTime = getLatestTime  # the name that Humble and Jazzy have for it

    def getOldestTime(self) -> Time | None:
        """The time of the first message; None without any."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """The message of the latest time; None without any."""
        latest = self.getLatestTime()
        return None if latest is None else self.getElemAfterTime(latest)

    def _kept(self) -> Iterator[tuple[Any, Time]]:
        return zip(tuple(self.cache_msgs), tuple(self.cache_times), strict=True)


class TimeSynchronizer(SimpleFilter):
    """Outputs sets of messages, one from each filter, that have the same stamp.

    Args:
        fs: the filters.
        queue_size: how many messages of each wait for the others at most.

    Attributes:
        queues: the messages of each filter that wait, by their stamps in nanoseconds.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Match the messages of these filters."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        self.input_connections = [
            each.registerCallback(self.add, queue, index)
            for index, (each, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Take a message of one of the filters; put out what is complete with it."""
        with self.lock:
            self._keep(msg, my_queue, _time(msg.header.stamp).nanoseconds)
            common = set(self.queues[0]).intersection(*self.queues[1:])
            matches = [[queue.pop(stamp) for queue in self.queues] for stamp in sorted(common)]
        for match in matches:
            self.signalMessage(*match)

    def _keep(self, msg: Any, queue: dict[int, Any], stamp: int) -> None:
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """Outputs sets of messages, one from each filter, whose stamps are close together.

    Args:
        fs: the filters.
        queue_size: how many messages of each wait for the others at most.
        slop: how far the stamps of a set may be apart, in seconds.
        allow_headerless: whether messages without a stamp are taken, as of the moment that they arrive.
        sync_arrival_time: whether all messages are taken as of that moment.
    """

    def __init__(
        self,
        fs: Sequence[SimpleFilter],
        queue_size: int,
        slop: float,
        allow_headerless: bool = False,
        sync_arrival_time: bool = False,
    ) -> None:
        super().__init__(fs, queue_size)
        self.slop = Duration(seconds=slop)
        self.allow_headerless = allow_headerless
        self.sync_arrival_time = sync_arrival_time

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Take a message of one of the filters; put out the set that it completes, of those nearest to it."""
        if self.sync_arrival_time:
            time: Time | None = ROSClock().now()
        else:
            time = _time_of(msg, allow_headerless=self.allow_headerless, logger="message_filters_approx")
        if time is None:
            return
        with self.lock:
            self._keep(msg, my_queue, time.nanoseconds)
            stamps = self._match(time.nanoseconds, my_queue_index)
            match = [queue.pop(stamp) for queue, stamp in zip(self.queues, stamps, strict=True)] if stamps else None
        if match is not None:
            self.signalMessage(*match)

    def _match(self, stamp: int, own: int | None) -> tuple[int, ...] | None:
        """The stamps of the messages that go together with one just kept, in the order of the filters."""
        slop = self.slop.nanoseconds
        choices = []
        for index, queue in enumerate(self.queues):
            near = [stamp] if index == own else [each for each in queue if abs(each - stamp) <= slop]
            choices.append(sorted(near, key=lambda each: abs(each - stamp)))
        for stamps in itertools.product(*choices):
            if max(stamps) - min(stamps) < slop and all(
                each in queue for each, queue in zip(stamps, self.queues, strict=True)
            ):
                return stamps
        return None


def _time_of(msg: Any, *, allow_headerless: bool, logger: str) -> Time | None:
    """The stamp of a message, or its time of arrival where that is allowed; without either None, and a warning."""
    stamp = getattr(getattr(msg, "header", None), "stamp", None)
    if stamp is not None:
        return _time(stamp)
    if allow_headerless:
        return ROSClock().now()
    get_logger(logger).warning(_HEADERLESS)
    return None


def _time(stamp: Any) -> Time:
    return stamp if isinstance(stamp, Time) else Time.from_msg(stamp)
