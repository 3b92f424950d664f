"""parameter_bridge of ros_gz_bridge and image_bridge of ros_gz_image.

Topics of gz are topics of the graph here, with the names and types that they have after a bridge. So a bridge has work
to do only where the two sides have different names or types: it hands messages on from one to the other.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import Graph, MessageInfo, Publisher, QoSProfile, ReliabilityPolicy
from linkwright.input_files import read_text
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, starting

_DIRECTIONS = {"[": "GZ_TO_ROS", "]": "ROS_TO_GZ", "@": "BIDIRECTIONAL"}
_IMAGE = ("sensor_msgs/msg/Image", "gz.msgs.Image")
_CLOCK = "rosgraph_msgs/msg/Clock"
_OF_GZ = {"gz.msgs.Twist": "geometry_msgs/msg/Twist"}
"""The type that a topic of gz has in the graph, for types that bridges turn into more than one of ROS."""
_LISTENING = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


@dataclass(frozen=True)
class BridgedTopic:
    """A topic with a name on each side.

    Attributes:
        ros_topic: its name in ROS, which remappings of the bridge apply to.
        gz_topic: its name in gz.
        ros_type: such as ``sensor_msgs/msg/Imu``.
        gz_type: such as ``gz.msgs.IMU``.
        direction: ``GZ_TO_ROS``, ``ROS_TO_GZ`` or ``BIDIRECTIONAL``.
    """

    ros_topic: str
    gz_topic: str
    ros_type: str
    gz_type: str
    direction: str = "BIDIRECTIONAL"


class _Bridge(SingleNode):
    def _connect(self, graph: Graph, topics: Sequence[BridgedTopic]) -> None:
        # Names of gz are not remapped: that side is a node of its own, hidden.
        self._gz_node = graph.create_node(f"_{self._node.get_name()}_gz", namespace=self._node.get_namespace())
        self._publishers: list[Publisher[Any]] = []
        for topic in topics:
            self._join(topic)

    def close(self) -> None:
        """End it."""
        self._gz_node.destroy_node()
        super().close()

    def _join(self, topic: BridgedTopic) -> None:
        try:
            ros_class = get_message(topic.ros_type)
        except LinkwrightError:
            self._node.get_logger().warning(f"{topic.ros_topic} is not bridged: there is no type {topic.ros_type}")
            return
        gz_class = get_message(_OF_GZ.get(topic.gz_type, topic.ros_type))
        gz_topic = "/" + topic.gz_topic.lstrip("/")
        same_name = self._node.resolve_topic_name(topic.ros_topic) == gz_topic
        if (same_name and ros_class is gz_class) or topic.ros_type == _CLOCK:  # the simulation publishes /clock itself
            return
        if topic.direction in ("GZ_TO_ROS", "BIDIRECTIONAL") and not (same_name and topic.direction == "BIDIRECTIONAL"):
            publisher = self._node.create_publisher(ros_class, topic.ros_topic, 10)
            take = self._handing_on(publisher, _conversion(gz_class, ros_class))
            self._gz_node.create_subscription(gz_class, gz_topic, take, _LISTENING)
        if topic.direction in ("ROS_TO_GZ", "BIDIRECTIONAL"):
            publisher = self._gz_node.create_publisher(gz_class, gz_topic, 10)
            take = self._handing_on(publisher, _conversion(ros_class, gz_class))
            self._node.create_subscription(ros_class, topic.ros_topic, take, _LISTENING)

    def _handing_on(
        self, publisher: Publisher[Any], convert: Callable[[Any], Any]
    ) -> Callable[[Any, MessageInfo], None]:
        self._publishers.append(publisher)

        def take(message: Any, info: MessageInfo) -> None:
            # What was sent by the bridge comes back where messages go both ways.
            if all(info.publisher_gid != each.gid for each in self._publishers):
                publisher.publish(convert(message))

        return take


class ParameterBridge(_Bridge):
    """The running bridge: which topics, its arguments say, or the file that its parameter ``config_file`` names.

    Raises:
        LinkwrightError: NODE820, what it is told cannot be understood; NODE821, the file cannot be read.
    """

    DEFAULT_NAME = "ros_gz_bridge"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, words = create_node(graph, options, self.DEFAULT_NAME)
        with starting(self._node):
            path = str(self._node.declare_parameter("config_file", "").value)
            topics = [topic_of_word(word) for word in words]
            topics += topics_of_file(path) if path else []
            self._connect(graph, topics)


class ImageBridge(_Bridge):
    """The running bridge for the images whose topics are its arguments."""

    DEFAULT_NAME = "ros_gz_image"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, words = create_node(graph, options, self.DEFAULT_NAME)
        self._connect(graph, [BridgedTopic(word, word, *_IMAGE, "GZ_TO_ROS") for word in words])


def topic_of_word(word: str) -> BridgedTopic:
    """The topic that an argument describes: ``TOPIC@ROS_TYPE@GZ_TYPE``, with ``[`` or ``]`` for one direction.

    Raises:
        LinkwrightError: NODE820, it has another form.
    """
    name, at, types = word.partition("@")
    mark = next((each for each in types if each in _DIRECTIONS), "")
    ros_type, _, gz_type = types.partition(mark or "@")
    if not (name and at and mark and ros_type and gz_type):
        hint = phrase("write it as {form}", form="/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan")
        raise LinkwrightError(Diagnostic("NODE820", phrase("'{word}' is no topic to bridge", word=word), hint=hint))
    return BridgedTopic(name, name, _full(ros_type), _modern(gz_type), _DIRECTIONS[mark])


def topics_of_file(path: str) -> list[BridgedTopic]:
    """The topics of a YAML file.

    Raises:
        LinkwrightError: NODE821, it cannot be read; NODE820, it is no list of topics with their types.
    """
    try:
        entries = yaml.safe_load(read_text(path))
    except (OSError, UnicodeDecodeError) as error:
        reason = foreign(getattr(error, "strerror", None) or error)
        message = phrase("cannot read '{path}': {reason}", path=path, reason=reason)
        raise LinkwrightError(Diagnostic("NODE821", message)) from error
    except yaml.YAMLError as error:
        message = phrase("'{path}' is no YAML: {reason}", path=path, reason=foreign(" ".join(str(error).split())))
        raise LinkwrightError(Diagnostic("NODE821", message)) from error
    if not isinstance(entries, list):
        raise _no_topics(path, phrase("it is no list"))
    return [_topic_of(entry, number, path) for number, entry in enumerate(entries, start=1)]


def _topic_of(entry: Any, number: int, path: str) -> BridgedTopic:
    if not isinstance(entry, dict):
        raise _no_topics(path, phrase("entry {number} is no mapping", number=number))
    both = entry.get("topic_name", "")
    ros_topic = entry.get("ros_topic_name") or both or entry.get("gz_topic_name", "")
    gz_topic = entry.get("gz_topic_name") or both or ros_topic
    ros_type, gz_type = entry.get("ros_type_name", ""), entry.get("gz_type_name", "")
    for key, value in (("ros_topic_name", ros_topic), ("ros_type_name", ros_type), ("gz_type_name", gz_type)):
        if not isinstance(value, str) or not value:
            raise _no_topics(path, phrase("entry {number} has no '{key}'", number=number, key=key))
    direction = entry.get("direction", "BIDIRECTIONAL")
    if direction not in _DIRECTIONS.values():
        reason = phrase("entry {number} has no such direction as '{value}'", number=number, value=str(direction))
        raise _no_topics(path, reason)
    return BridgedTopic(ros_topic, gz_topic, _full(ros_type), _modern(gz_type), direction)


def _no_topics(path: str, reason: Any) -> LinkwrightError:
    message = phrase("'{path}' does not say which topics to bridge: {reason}", path=path, reason=reason)
    hint = phrase("each entry needs ros_topic_name, gz_topic_name, ros_type_name, gz_type_name and direction")
    return LinkwrightError(Diagnostic("NODE820", message, hint=hint))


def _full(ros_type: str) -> str:
    return ros_type if ros_type.count("/") == 2 else ros_type.replace("/", "/msg/", 1)


def _modern(gz_type: str) -> str:
    return gz_type.replace("ignition.msgs.", "gz.msgs.")


def _conversion(source: type[Any], target: type[Any]) -> Callable[[Any], Any]:
    """What makes a message of one type from one of the other: a twist may have a header."""
    if source is target:
        return lambda message: message
    if hasattr(source(), "twist"):
        return lambda message: message.twist
    return lambda message: target(twist=message)
