"""Filters that forward, cache or synchronize messages (the API of ``message_filters``).

The matching and its order follow the Python modules of ``message_filters`` of Humble to Kilted.
"""

from __future__ import annotations

import itertools
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

from linkwright.graph.time.clock import ROSClock
from linkwright.graph.time.values import Duration, Time
from linkwright.standins.rclpy_api.logging import get_logger

_HEADERLESS_WARNING = (
    "can not use message filters messages without timestamp infomation when 'allow_headerless' is disabled. "
    "auto assign ROSTIME to headerless messages once enabling constructor option of 'allow_headerless'."
)


class SimpleFilter:
    """The base class of filters: an output with connected callbacks and other filters.

    Attributes:
        callbacks: registration number -> the callback and its additional arguments.
    """

    def __init__(self) -> None:
        self.callbacks: dict[int, tuple[Callable[..., object], tuple[Any, ...]]] = {}

    def registerCallback(self, cb: Callable[..., object], *args: Any) -> int:
        """Register a callback for each output, and return the key of its entry in `callbacks`.

        Args:
            cb: the callback, called with the output followed by `args`.
            args: additional arguments of the callback.
        """
        number = len(self.callbacks)
        self.callbacks[number] = (cb, args)
        return number

    def signalMessage(self, *msg: Any) -> None:
        """Call the callbacks with a message, or with the messages of a set."""
        for callback, arguments in tuple(self.callbacks.values()):
            callback(*msg, *arguments)


class Subscriber(SimpleFilter):
    """The first filter of a chain: a subscription to a topic.

    It also has the attributes of the subscription.

    Args:
        node: the node that subscribes.
        msg_type: the message class.
        topic: the name of the topic.
        qos_profile: the requested profile, or the depth of the queue.
        arguments: further arguments of ``Node.create_subscription``.
    """

    def __init__(self, node: Any, msg_type: type, topic: str, *, qos_profile: Any = 10, **arguments: Any) -> None:
        super().__init__()
        self.node = node
        self.topic = topic
        self.sub = node.create_subscription(msg_type, topic, self.callback, qos_profile, **arguments)

    def callback(self, msg: Any) -> None:
        """Pass a received message to the callbacks."""
        self.signalMessage(msg)

    def getTopic(self) -> str:
        """Return the name of the topic as given to the constructor."""
        return self.topic

    def __getattr__(self, key: str) -> Any:
        if key == "sub":  # the constructor failed before it set the attribute
            raise AttributeError(key)
        return getattr(self.sub, key)


class Cache(SimpleFilter):
    """A cache of the newest messages of a filter for lookups by time.

    The cache also forwards each message.

    Args:
        f: the filter whose output is cached.
        cache_size: the maximum number of messages.
        allow_headerless: whether to accept messages without a stamp, for which the time of arrival is used.
    """

    def __init__(self, f: SimpleFilter, cache_size: int = 1, allow_headerless: bool = False) -> None:
        super().__init__()
        self.cache_size = cache_size
        self.allow_headerless = allow_headerless
        self.cache_msgs: list[Any] = []
        self.cache_times: list[Time] = []
        self.connectInput(f)

    def connectInput(self, f: SimpleFilter) -> None:
        """Connect the cache to the filter whose messages it caches."""
        self.incoming_connection = f.registerCallback(self.add)

    def add(self, msg: Any) -> None:
        """Add a message, drop the oldest one if the cache is full, and forward the message."""
        stamp = _find_message_time(msg, allow_headerless=self.allow_headerless, logger="message_filters_cache")
        if stamp is None:
            return
        self.cache_msgs.append(msg)
        self.cache_times.append(stamp)
        del self.cache_msgs[: -self.cache_size], self.cache_times[: -self.cache_size]
        self.signalMessage(msg)

    def getInterval(self, from_stamp: Time, to_stamp: Time) -> list[Any]:
        """Return the messages in a time interval that includes both limits."""
        assert from_stamp <= to_stamp, "the interval ends before it begins"
        return [msg for msg, time in self._stamped_messages() if from_stamp <= time <= to_stamp]

    def getElemAfterTime(self, stamp: Time) -> Any:
        """Return the first message at or after a time, or None."""
        return next((msg for msg, time in self._stamped_messages() if time >= stamp), None)

    def getElemBeforeTime(self, stamp: Time) -> Any:
        """Return the last message at or before a time, or None."""
        older = [msg for msg, time in self._stamped_messages() if time <= stamp]
        return older[-1] if older else None

    def getLatestTime(self) -> Time | None:
        """Return the time of the newest message, or None if the cache is empty."""
        return self.cache_times[-1] if self.cache_times else None

    getLastestTime = getLatestTime  # the misspelled name in Humble and Jazzy

    def getOldestTime(self) -> Time | None:
        """Return the time of the oldest message, or None if the cache is empty."""
        return self.cache_times[0] if self.cache_times else None

    def getLast(self) -> Any:
        """Return the newest message, or None if the cache is empty."""
        latest = self.getLatestTime()
        return None if latest is None else self.getElemAfterTime(latest)

    def _stamped_messages(self) -> Iterator[tuple[Any, Time]]:
        return zip(tuple(self.cache_msgs), tuple(self.cache_times), strict=True)


class TimeSynchronizer(SimpleFilter):
    """A filter that outputs sets of messages with the same stamp, one from each input filter.

    Args:
        fs: the filters.
        queue_size: the maximum number of queued messages of each filter.

    Attributes:
        queues: for each filter, stamp in nanoseconds -> the queued message.
    """

    def __init__(self, fs: Sequence[SimpleFilter], queue_size: int) -> None:
        super().__init__()
        self.queue_size = queue_size
        self.lock = threading.Lock()
        self.connectInput(fs)

    def connectInput(self, fs: Sequence[SimpleFilter]) -> None:
        """Connect the synchronizer to the filters whose messages it matches."""
        self.queues: list[dict[int, Any]] = [{} for _ in fs]
        self.input_connections = [
            input_filter.registerCallback(self.add, queue, index)
            for index, (input_filter, queue) in enumerate(zip(fs, self.queues, strict=True))
        ]

    def add(self, msg: Any, my_queue: dict[int, Any], my_queue_index: int | None = None) -> None:
        """Add a message of one of the filters, and output a set if the message completes one."""
        with self.lock:
            self._store(msg, my_queue, _to_time(msg.header.stamp).nanoseconds)
            common_stamps = set(self.queues[0]).intersection(*self.queues[1:])
            matches = [[queue.pop(stamp) for queue in self.queues] for stamp in sorted(common_stamps)]
        for match in matches:
            self.signalMessage(*match)

    def _store(self, msg: Any, queue: dict[int, Any], stamp: int) -> None:
        queue[stamp] = msg
        while len(queue) > self.queue_size:
            del queue[min(queue)]


class ApproximateTimeSynchronizer(TimeSynchronizer):
    """A filter that outputs sets of messages with similar stamps, one from each input filter.

    Args:
        fs: the filters.
        queue_size: the maximum number of queued messages of each filter.
        slop: the maximum difference of the stamps in a set, in seconds.
        allow_headerless: whether to accept messages without a stamp, for which the time of arrival is used.
        sync_arrival_time: whether to use the time of arrival instead of the stamp for all messages.
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
        """Add a message of one of the filters, and output the set of closest messages, if complete."""
        if self.sync_arrival_time:
            time: Time | None = ROSClock().now()
        else:
            time = _find_message_time(msg, allow_headerless=self.allow_headerless, logger="message_filters_approx")
        if time is None:
            return
        with self.lock:
            self._store(msg, my_queue, time.nanoseconds)
            stamps = self._find_match(time.nanoseconds, my_queue_index)
            match = [queue.pop(stamp) for queue, stamp in zip(self.queues, stamps, strict=True)] if stamps else None
        if match is not None:
            self.signalMessage(*match)

    def _find_match(self, stamp: int, own_index: int | None) -> tuple[int, ...] | None:
        """Return the stamps of the messages that match a new message, in the order of the filters.

        The result is None if a filter has no matching message.
        """
        slop = self.slop.nanoseconds
        candidates_by_filter = []
        for index, queue in enumerate(self.queues):
            close_stamps = (
                [stamp] if index == own_index else [candidate for candidate in queue if abs(candidate - stamp) <= slop]
            )
            candidates_by_filter.append(sorted(close_stamps, key=lambda candidate: abs(candidate - stamp)))
        for stamps in itertools.product(*candidates_by_filter):
            if max(stamps) - min(stamps) < slop and all(
                candidate in queue for candidate, queue in zip(stamps, self.queues, strict=True)
            ):
                return stamps
        return None


def _find_message_time(msg: Any, *, allow_headerless: bool, logger: str) -> Time | None:
    """Return the stamp of a message, or its time of arrival if `allow_headerless` is set.

    If neither is available, a warning is logged and the result is None.
    """
    stamp = getattr(getattr(msg, "header", None), "stamp", None)
    if stamp is not None:
        return _to_time(stamp)
    if allow_headerless:
        return ROSClock().now()
    get_logger(logger).warning(_HEADERLESS_WARNING)
    return None


def _to_time(stamp: Any) -> Time:
    return stamp if isinstance(stamp, Time) else Time.from_msg(stamp)
