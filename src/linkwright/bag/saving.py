"""Save messages from memory as a recording."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.bag.history import decompress
from linkwright.bag.names import Recorded
from linkwright.bag.writing import BagWriter
from linkwright.graph import QoSProfile
from linkwright.graph.simulated_time import CLOCK_TOPIC
from linkwright.messages import deserialize, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_PROGRESS_STEP = 1000
"""The number of messages between two reports of progress."""


@dataclass(frozen=True, slots=True)
class SavedTopic:
    """The type and quality of service of a topic in memory.

    Attributes:
        type_name: the type, such as ``std_msgs/msg/String``.
        offered: the QoS profiles of the topic's publishers.
    """

    type_name: str
    offered: tuple[QoSProfile, ...]


def save_messages(
    path: Path, topics: Mapping[str, SavedTopic], messages: Sequence[Recorded], on_progress: Callable[[float], object]
) -> None:
    """Write messages to a new recording.

    Args:
        path: the folder to create.
        topics: the topics of all messages.
        messages: the messages ordered by time; their data may be compressed.
        on_progress: called repeatedly with the share of messages that are written, from 0 to 1.

    Raises:
        LinkwrightError: BAG105, BAG107, BAG108; see `BagWriter`.
    """
    with BagWriter(path) as writer:
        for index, (name, stamp_ns, data) in enumerate(messages):
            if name not in writer.topics:
                writer.add_topic(name, topics[name].type_name, topics[name].offered)
            writer.write(name, stamp_ns, decompress(data))
            if index % _PROGRESS_STEP == 0:
                on_progress(index / len(messages))


def find_last_reset_ns(messages: Sequence[Recorded]) -> int | None:
    """Return the reception time of the message with which ``/clock`` last jumped back, or None.

    The time is in nanoseconds since the epoch.
    """
    reset_ns, clock_ns = None, None
    for name, stamp_ns, data in messages:
        if name == CLOCK_TOPIC:
            stamp = _read_clock_ns(data)
            if clock_ns is not None and stamp < clock_ns:
                reset_ns = stamp_ns
            clock_ns = stamp
    return reset_ns


def to_simulated_time(messages: Sequence[Recorded]) -> list[Recorded]:
    """Return messages with the simulated times of ``/clock`` instead of their reception times.

    Messages before the first clock message get the time of that message. Without ``/clock``, all messages keep their
    times.
    """
    clock_ns = next((_read_clock_ns(data) for name, _, data in messages if name == CLOCK_TOPIC), None)
    if clock_ns is None:
        return list(messages)
    converted = []
    for name, _, data in messages:
        if name == CLOCK_TOPIC:
            clock_ns = _read_clock_ns(data)
        converted.append((name, clock_ns, data))
    return converted


def _read_clock_ns(data: bytes) -> int:
    clock = deserialize(data, get_message("rosgraph_msgs/msg/Clock")).clock
    return int(clock.sec) * NANOSECONDS_PER_SECOND + int(clock.nanosec)
