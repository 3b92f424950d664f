"""Create the publishers for a recording's topics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from linkwright.bag.names import STATIC_TRANSFORMS, TRANSFORMS
from linkwright.bag.qos import choose_playing_profile
from linkwright.bag.reading import BagReader, BagTopic
from linkwright.diagnostics import Diagnostic, LinkwrightError, Severity, phrase
from linkwright.graph import TF_QOS, DurabilityPolicy, Node, Publisher, QoSProfile
from linkwright.graph.simulated_time import CLOCK_TOPIC
from linkwright.messages import TFMessage, Time, get_message

_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
_LATCHED_TOPICS = frozenset({STATIC_TRANSFORMS, "/robot_description"})
"""The topics that subscribers expect to be latched, whatever profile was recorded."""
_LATCHED_QOS = QoSProfile(100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


def make_publishers(
    node: Node, topics: Iterable[BagTopic], overrides: Mapping[str, QoSProfile] | None = None
) -> dict[str, Publisher[Any]]:
    """Create a publisher for each topic with its recorded quality of service.

    A topic with an unavailable type is logged and skipped.

    Args:
        node: the node that publishes.
        topics: the topics of a recording.
        overrides: the QoS profiles that replace recorded ones, by topic.

    Returns:
        The publishers by the name of their topic.
    """
    publishers: dict[str, Publisher[Any]] = {}
    for topic in topics:
        try:
            message_class = get_message(topic.type_name)
        except LinkwrightError as error:
            node.get_logger().warning(f"Topic '{topic.name}' is not played: {error}")
            continue
        qos = (overrides or {}).get(topic.name) or choose_playing_profile(topic.offered_qos)
        publishers[topic.name] = node.create_publisher(message_class, topic.name, qos)
    return publishers


def find_missing_types(bag: BagReader) -> list[Diagnostic]:
    """Return the diagnostic BAG114 if topics cannot be played because their types are missing.

    Otherwise return an empty list.
    """
    names = [f"{topic.name} ({topic.type_name})" for topic in bag.topics if not _has_type(topic.type_name)]
    if not names:
        return []
    message = phrase(
        "topics of '{path}' are left out because the definitions of their types are missing or invalid: {topics}",
        path=bag.path.name,
        topics=", ".join(sorted(names)),
    )
    return [Diagnostic("BAG114", message, severity=Severity.WARNING)]


def _has_type(type_name: str) -> bool:
    try:
        get_message(type_name)
    except LinkwrightError:
        return False
    return True


class PublishedRecording:
    """A recording that is published, with its time on ``/clock``, in a graph of its own.

    Args:
        node: the node that publishes.
        bag: the recording. Its own ``/clock`` is not published, because the published time is the reception time
            of messages.
        namespace: the namespace of a robot; its transforms are also published as ``/tf`` and ``/tf_static``. Empty for
            none.
    """

    def __init__(self, node: Node, bag: BagReader, namespace: str = "") -> None:
        topics = [topic for topic in bag.topics if topic.name != CLOCK_TOPIC]
        self._publishers = make_publishers(node, topics, dict.fromkeys(_LATCHED_TOPICS, _LATCHED_QOS))
        remapped = {namespace + name: name for name in (TRANSFORMS, STATIC_TRANSFORMS)} if namespace else {}
        self._remapped_publishers = {
            topic: node.create_publisher(TFMessage, name, _LATCHED_QOS if name in _LATCHED_TOPICS else TF_QOS)
            for topic, name in remapped.items()
            if topic in self._publishers
        }
        self._clock_publisher: Publisher[Any] = node.create_publisher(_CLOCK_TYPE, CLOCK_TOPIC, 10)

    @property
    def topics(self) -> frozenset[str]:
        """The topics that can be played."""
        return frozenset(self._publishers)

    def subscribed_topics(self) -> frozenset[str]:
        """Return the topics that have subscribers."""
        publishers = [*self._publishers.items(), *self._remapped_publishers.items()]
        return frozenset(name for name, publisher in publishers if publisher.get_subscription_count())

    def publish_time(self, stamp_ns: int) -> None:
        """Publish a time on ``/clock``."""
        self._clock_publisher.publish(self._clock_publisher.msg_type(clock=Time.from_nanoseconds(stamp_ns)))

    def publish(self, topic: str, stamp_ns: int, data: bytes) -> None:
        """Publish a message."""
        self._publishers[topic].publish(data)
        if topic in self._remapped_publishers:
            self._remapped_publishers[topic].publish(data)
