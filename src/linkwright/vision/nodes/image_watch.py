"""Diagnose missing images: wrong topic, different type, incompatible QoS, or a camera that stopped."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Node, QoSProfile, ReliabilityPolicy
from linkwright.images import ImageSource

_SECONDS = 5.0
_IMAGES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_MOST_TOPICS = 5


class ImageWatch:
    """Warns once when no image has arrived for some seconds, and reports when images resume.

    The timeout doubles each time images resume, so that a slow camera causes only a few warnings.

    Args:
        node: the node that logs.
        source: the source of the images.
        qos: the QoS of the node's subscription.
        is_waiting: returns whether the node currently subscribes to images.
        topic_parameter: the parameter with the topic; empty if the topic can only be remapped.
    """

    def __init__(
        self, node: Node, source: ImageSource, qos: QoSProfile, is_waiting: Callable[[], bool], topic_parameter: str
    ) -> None:
        self._node, self._source, self._qos = node, source, qos
        self._is_waiting, self._topic_parameter = is_waiting, topic_parameter
        self._came = self._has_warned = False
        self._quiet, self._patience = 0, 1  # both in timer periods
        # Use the steady clock: simulated time may be paused, which would hold back the warning.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_SECONDS, self._look, clock=clock)

    def came(self) -> None:
        """Record that an image has arrived."""
        self._came = True

    def _look(self) -> None:
        came, self._came = self._came, False
        if came or not self._is_waiting():
            self._quiet = 0
            if came and self._has_warned:
                self._has_warned = False
                self._patience *= 2
                self._node.get_logger().info(localized(phrase("images are arriving")))
            return
        self._quiet += 1
        if self._has_warned or self._quiet < self._patience:
            return
        self._has_warned = True
        reason, hint = self._reason()
        logger = self._node.get_logger()
        logger.warning(localized(reason))
        if hint is not None:
            logger.warning(localized(hint))

    def _reason(self) -> tuple[Phrase, Phrase | None]:
        """Return the reason why no images arrive, and a hint."""
        topic, wanted = self._source.topic, self._source.message_type
        publishers = self._node.get_publishers_info_by_topic(topic)
        if not publishers:
            return phrase("no images arrive: no node publishes '{topic}'", topic=topic), self._others()
        fitting = [publisher for publisher in publishers if publisher.topic_type == wanted]
        if not fitting:
            types = quoted_names(sorted({publisher.topic_type for publisher in publishers}))
            return phrase(
                "no images arrive: '{topic}' has {types}, not '{wanted}'", topic=topic, types=types, wanted=wanted
            ), self._others()
        offered = {endpoint.qos_profile.reliability for endpoint in fitting}
        if self._qos.reliability is ReliabilityPolicy.RELIABLE and offered == {ReliabilityPolicy.BEST_EFFORT}:
            return phrase(
                "no images arrive: '{topic}' is published best effort, but this node requests reliable", topic=topic
            ), phrase("set '{parameter}' to {value}", parameter="image_reliability", value=2)
        seconds = round(_SECONDS * self._quiet)
        return phrase("no image has arrived on '{topic}' for {seconds} s", topic=topic, seconds=seconds), None

    def _others(self) -> Phrase | None:
        """Return a hint that names other topics with images; None if there are none."""
        passed = {self._source.topic, *(publisher.name for publisher in self._node.publishers)}
        topics = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if name not in passed and set(types) & set(_IMAGES) and self._node.count_publishers(name)
        ]
        if not topics:
            return None
        names = quoted_names(topics[:_MOST_TOPICS])
        if self._topic_parameter:
            return phrase(
                "there are images on {topics}; set the topic with the parameter '{parameter}'",
                topics=names,
                parameter=self._topic_parameter,
            )
        return phrase("there are images on {topics}; remap '{topic}'", topics=names, topic=self._source.topic)
