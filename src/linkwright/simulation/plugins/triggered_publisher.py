"""Messages that other messages trigger: ``gz-sim-triggered-publisher-system``.

Each message on the input topic is compared with the ``<match>`` elements. If all of them match, the plugin publishes
the messages of the ``<output>`` elements, after the delay.

Source: gz-sim (parameters, matching); ros_gz_bridge (the ROS type of each type of gz). Messages are in the text format
of protobuf. Calls of services are left out, because services of gz have no counterpart of the same type in ROS.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from math import isclose
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.messages.errors import FieldValueError
from linkwright.messages.message import Message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.protobuf_text import (
    Fields,
    TextFormatError,
    is_sequence,
    message_from_fields,
    parse_fields,
)
from linkwright.xmltree import Element

_ROS_TYPES = {
    "Actuators": "actuator_msgs/msg/Actuators",
    "Altimeter": "ros_gz_interfaces/msg/Altimeter",
    "BatteryState": "sensor_msgs/msg/BatteryState",
    "Boolean": "std_msgs/msg/Bool",
    "Color": "std_msgs/msg/ColorRGBA",
    "Contacts": "ros_gz_interfaces/msg/Contacts",
    "Double": "std_msgs/msg/Float64",
    "Empty": "std_msgs/msg/Empty",
    "Entity": "ros_gz_interfaces/msg/Entity",
    "EntityWrench": "ros_gz_interfaces/msg/EntityWrench",
    "Float": "std_msgs/msg/Float32",
    "IMU": "sensor_msgs/msg/Imu",
    "Image": "sensor_msgs/msg/Image",
    "Int32": "std_msgs/msg/Int32",
    "JointTrajectory": "trajectory_msgs/msg/JointTrajectory",
    "LaserScan": "sensor_msgs/msg/LaserScan",
    "LogicalCameraImage": "ros_gz_interfaces/msg/LogicalCameraImage",
    "NavSat": "sensor_msgs/msg/NavSatFix",
    "Odometry": "nav_msgs/msg/Odometry",
    "Pose": "geometry_msgs/msg/Pose",
    "Quaternion": "geometry_msgs/msg/Quaternion",
    "StringMsg": "std_msgs/msg/String",
    "Time": "builtin_interfaces/msg/Time",
    "Twist": "geometry_msgs/msg/Twist",
    "UInt32": "std_msgs/msg/UInt32",
    "Vector3d": "geometry_msgs/msg/Vector3",
    "Wrench": "geometry_msgs/msg/Wrench",
}
"""The ROS type of each type of gz, for the topics that the simulation publishes or takes."""
_DEFAULT_TOLERANCE = 1e-8
_FLOAT32_TOLERANCE = 1e-7
"""The relative tolerance for numbers, which a field of 32 bits rounds."""

Matcher = Callable[[Any], bool]


@dataclass(frozen=True, kw_only=True)
class TriggeredPublisherParameters:
    """Parameters of ``gz-sim-triggered-publisher-system``."""

    delay_ms: int = 0


class GzTriggeredPublisher(SimulatedPlugin[TriggeredPublisherParameters]):
    """The substitute for ``gz-sim-triggered-publisher-system``."""

    PARAMETERS = TriggeredPublisherParameters
    IGNORED = ("input", "output", "service")  # read by start

    def start(self) -> None:
        """Read the matches and the outputs, and subscribe to the input.

        Raises:
            LinkwrightError: SIM160, there is no input, or a type, a match or an output is not valid.
        """
        element = self.context.element
        source = None if element is None else element.first("input")
        if element is None or source is None:
            raise self.parameter_error(phrase("plugin '{plugin}': <input> is missing", plugin=self.context.name))
        self._due_times: deque[int] = deque()
        self._matchers = [self._read_match(source, match) for match in source.elements("match")]
        self._outputs = [
            (
                self.node.publisher(self._find_ros_type(output), self._read_topic(output)),
                self._read_message(output, output.text()),
            )
            for output in element.elements("output")
        ]
        if element.first("service") is not None:
            self.node.logger.warning(
                phrase("plugin '{plugin}': calls of a <service> are not simulated", plugin=self.context.name)
            )
        self.node.subscribe(self._find_ros_type(source), self._read_topic(source), self._on_message)
        if self.parameters.delay_ms > 0:
            self.every(0.0, self._publish_delayed)

    def reset(self) -> None:
        """Drop delayed messages."""
        self._due_times.clear()

    def _find_ros_type(self, element: Element) -> str:
        name = element.attributes.get("type", "")
        ros_type = _ROS_TYPES.get(name.rpartition(".")[2])
        if ros_type is None:
            raise self.parameter_error(
                phrase("plugin '{plugin}': the type '{type}' has no ROS type", plugin=self.context.name, type=name)
            )
        return ros_type

    def _read_topic(self, element: Element) -> str:
        topic = element.attributes.get("topic", "")
        if not topic:
            raise self.parameter_error(
                phrase("plugin '{plugin}': <{tag}> needs a topic", plugin=self.context.name, tag=element.tag)
            )
        return f"/{topic.lstrip('/')}"

    def _read_message(self, typed_element: Element, text: str, path: tuple[str, ...] = ()) -> Message:
        """Return the message in a text.

        Args:
            typed_element: the element with the type of the message.
            text: the fields, or the value of a nested field.
            path: the names of the nested field whose value the text contains.
        """
        try:
            fields: Fields = parse_fields(f"{path[-1]}: {text}" if path else text)
            for name in reversed(path[:-1]):
                fields = {name: [fields]}
            return message_from_fields(self._find_ros_type(typed_element), fields)
        except (TextFormatError, FieldValueError) as error:
            if isinstance(error, LinkwrightError):
                raise self.parameter_error(error.diagnostics[0].message) from error
            message = phrase(
                "plugin '{plugin}': '{text}' is not a message in the text format of protobuf",
                plugin=self.context.name,
                text=" ".join(text.split()),
            )
            raise self.parameter_error(message) from error

    def _read_match(self, source: Element, match: Element) -> Matcher:
        """Return a function that returns whether a message matches."""
        tolerance = float(match.attributes.get("tol", _DEFAULT_TOLERANCE))
        is_expected = match.attributes.get("logic_type", "positive") != "negative"
        path = tuple(filter(None, match.attributes.get("field", "").split(".")))
        text = match.text().strip()
        if not text:
            return lambda _: True
        expected = self._read_message(source, text, path)
        return partial(_matches, path, expected, tolerance, is_expected)

    def _on_message(self, message: Any) -> None:
        if all(matches(message) for matches in self._matchers):
            if self.parameters.delay_ms > 0:
                delay = self.parameters.delay_ms * NANOSECONDS_PER_SECOND // 1000
                self._due_times.append(self.simulation.time + delay)
            else:
                self._publish()

    def _publish_delayed(self) -> None:
        while self._due_times and self._due_times[0] <= self.simulation.time:
            self._due_times.popleft()
            self._publish()

    def _publish(self) -> None:
        for output, message in self._outputs:
            output.publish(message)


def _matches(path: tuple[str, ...], expected: Any, tolerance: float, is_expected: bool, message: Any) -> bool:
    """Return whether a message, or the field at a path, matches the expected one.

    It must be equal, or differ if `is_expected` is false.
    """
    for name in path:
        expected, message = getattr(expected, name), getattr(message, name)
    if path and is_sequence(expected):
        is_equal = all(any(_is_equal(item, other, tolerance) for other in message) for item in expected)
    else:
        is_equal = _is_equal(expected, message, tolerance)
    return is_equal is is_expected


def _is_equal(one: Any, other: Any, tolerance: float) -> bool:
    if isinstance(one, Message):
        names = one.get_fields_and_field_types()
        return all(_is_equal(getattr(one, name), getattr(other, name), tolerance) for name in names)
    if is_sequence(one):
        return len(one) == len(other) and all(
            _is_equal(item, other_item, tolerance) for item, other_item in zip(one, other, strict=True)
        )
    if isinstance(one, float):
        return isclose(one, other, rel_tol=_FLOAT32_TOLERANCE, abs_tol=tolerance)
    return bool(one == other)
