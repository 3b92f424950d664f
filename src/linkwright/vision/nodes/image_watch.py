"""Warnings about missing images and their causes: topic, type, QoS or a stopped camera."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.diagnostics.translation import localized
from linkwright.graph import Clock, ClockType, Node, QoSProfile, ReliabilityPolicy
from linkwright.images import ImageSource

_CHECK_PERIOD_S = 5.0
_IMAGE_TYPES = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")
_MAX_SUGGESTED_TOPICS = 5


class ImageWatch:
    """Warns once if no image has arrived for some seconds.

    It also reports when images arrive again. The timeout then doubles, so that a slow camera causes only a few
    warnings.

    Args:
        node: the node that logs.
        source: the source of the images.
        qos: the QoS of the node's subscription.
        is_waiting: returns whether the node currently subscribes to images.
        topic_parameter: the parameter that sets the topic; empty if the topic can only be remapped.
    """

    def __init__(
        self, node: Node, source: ImageSource, qos: QoSProfile, is_waiting: Callable[[], bool], topic_parameter: str
    ) -> None:
        self._node, self._source, self._qos = node, source, qos
        self._is_waiting, self._topic_parameter = is_waiting, topic_parameter
        self._has_new_image = self._has_warned = False
        # Numbers of timer periods: without an image, and until the warning.
        self._silent_periods, self._allowed_periods = 0, 1
        # Use the steady clock: simulated time may be paused, which would delay the warning.
        clock = Clock(clock_type=ClockType.STEADY_TIME, timebase=node.get_clock().timebase)
        node.create_timer(_CHECK_PERIOD_S, self._check_images, clock=clock)

    def record_image(self) -> None:
        """Record that an image has arrived."""
        self._has_new_image = True

    def _check_images(self) -> None:
        has_new_image, self._has_new_image = self._has_new_image, False
        if has_new_image or not self._is_waiting():
            self._silent_periods = 0
            if has_new_image and self._has_warned:
                self._has_warned = False
                self._allowed_periods *= 2
                self._node.get_logger().info(localized(phrase("images are arriving")))
            return
        self._silent_periods += 1
        if self._has_warned or self._silent_periods < self._allowed_periods:
            return
        self._has_warned = True
        reason, hint = self._diagnose()
        logger = self._node.get_logger()
        logger.warning(localized(reason))
        if hint is not None:
            logger.warning(localized(hint))

    def _diagnose(self) -> tuple[Phrase, Phrase | None]:
        """Return the reason why no images arrive, and a hint or None."""
        topic, message_type = self._source.topic, self._source.message_type
        publishers = self._node.get_publishers_info_by_topic(topic)
        if not publishers:
            return phrase("no images arrive: no node publishes '{topic}'", topic=topic), self._suggest_topics()
        matching_publishers = [publisher for publisher in publishers if publisher.topic_type == message_type]
        if not matching_publishers:
            types = quoted_names(sorted({publisher.topic_type for publisher in publishers}))
            return phrase(
                "no images arrive: the type of '{topic}' is {types}, not '{expected}'",
                topic=topic,
                types=types,
                expected=message_type,
            ), self._suggest_topics()
        offered_reliabilities = {endpoint.qos_profile.reliability for endpoint in matching_publishers}
        if self._qos.reliability is ReliabilityPolicy.RELIABLE and offered_reliabilities == {
            ReliabilityPolicy.BEST_EFFORT
        }:
            return phrase(
                "no images arrive: the publisher of '{topic}' offers best-effort reliability, but this node "
                "requests reliable",
                topic=topic,
            ), phrase("set '{parameter}' to {value}", parameter="image_reliability", value=2)
        seconds = round(_CHECK_PERIOD_S * self._silent_periods)
        return phrase("no image has arrived on '{topic}' for {seconds} s", topic=topic, seconds=seconds), None

    def _suggest_topics(self) -> Phrase | None:
        """Return a hint with other topics that have images, or None if there are none."""
        excluded_topics = {self._source.topic, *(publisher.name for publisher in self._node.publishers)}
        topics = [
            name
            for name, types in self._node.get_topic_names_and_types()
            if name not in excluded_topics and set(types) & set(_IMAGE_TYPES) and self._node.count_publishers(name)
        ]
        if not topics:
            return None
        names = quoted_names(topics[:_MAX_SUGGESTED_TOPICS])
        if self._topic_parameter:
            return phrase(
                "images are published on {topics}: set the topic with the parameter '{parameter}'",
                topics=names,
                parameter=self._topic_parameter,
            )
        return phrase("images are published on {topics}: remap '{topic}'", topics=names, topic=self._source.topic)
