"""parameter_bridge and static_bridge of ros_gz_bridge, and image_bridge of ros_gz_image.

In Linkwright, gz topics are topics of the graph, with the names and types that a bridge would give them. A bridge
therefore forwards messages only if the two sides have different names or types. It only announces the other topics,
because programs look for them before the simulation has started or the robot is spawned.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import yaml

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, install_hint, phrase
from linkwright.files.input_files import read_text
from linkwright.graph import Graph, MessageInfo, Node, Publisher, QoSProfile, ReliabilityPolicy, Subscription
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard
from linkwright.graph.endpoints.event_types import PublisherEventCallbacks, QoSMatchedInfo
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.qos_overrides import QoSOverridingOptions
from linkwright.graph.qos.profile import QoSPolicyKind
from linkwright.messages import get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.standstill import VELOCITIES, send_stop
from linkwright.perception.nodes.compressed import compress_image
from linkwright.simulation.gz_services import WORLD_SERVICES
from linkwright.simulation.nodes.conversions import DEFAULT_ROS_TYPES, find_conversion
from linkwright.simulation.plugins.bridged_topics import hidden_gz_topic
from linkwright.simulation.plugins.node import to_ros_name

_DIRECTIONS = {"[": "GZ_TO_ROS", "]": "ROS_TO_GZ", "@": "BIDIRECTIONAL"}
_IMAGE_TYPES = ("sensor_msgs/msg/Image", "gz.msgs.Image")
_CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
_COMPRESSED_IMAGE_TYPE = "sensor_msgs/msg/CompressedImage"
_Endpoint = tuple[Node, str, str]
"""A node, a topic and its type."""
_OVERRIDABLE_QOS = QoSOverridingOptions(
    (QoSPolicyKind.DEPTH, QoSPolicyKind.DURABILITY, QoSPolicyKind.HISTORY, QoSPolicyKind.RELIABILITY)
)
_QUEUE_DEPTH = 10


@dataclass(frozen=True)
class BridgedTopic:
    """A bridged topic with its name on each side.

    Attributes:
        ros_topic: the name in ROS, to which remappings of the bridge apply.
        gz_topic: the name in gz.
        ros_type: the type in ROS, such as ``sensor_msgs/msg/Imu``.
        gz_type: the type in gz, such as ``gz.msgs.IMU``.
        direction: ``GZ_TO_ROS``, ``ROS_TO_GZ`` or ``BIDIRECTIONAL``.
        publisher_queue, subscriber_queue: the queue depths of the publisher and the subscription, in messages.
        lazy: whether to subscribe only while the other side has a subscriber; None for the node's setting.
    """

    ros_topic: str
    gz_topic: str
    ros_type: str
    gz_type: str
    direction: str = "BIDIRECTIONAL"
    publisher_queue: int = _QUEUE_DEPTH
    subscriber_queue: int = _QUEUE_DEPTH
    lazy: bool | None = None


class _BridgeDirection:
    """One direction of a bridge, from a topic of one node to a topic of another.

    Args:
        create_subscription: creates and returns the subscription to the input topic.
        lazy: whether to subscribe only while the output topic has a subscriber.
    """

    def __init__(self, create_subscription: Callable[[], Subscription[Any]], *, lazy: bool) -> None:
        self._create_subscription = create_subscription
        self._subscription = None if lazy else create_subscription()

    def on_matched(self, info: QoSMatchedInfo) -> None:
        """Subscribe when the output has a subscriber, and unsubscribe when it has none."""
        if info.current_count and self._subscription is None:
            self._subscription = self._create_subscription()
        elif not info.current_count and self._subscription is not None:
            self._subscription.destroy()
            self._subscription = None


class _Bridge(SingleNode):
    _is_lazy = False
    _expands_gz_names = False

    def _connect(self, graph: Graph, topics: Sequence[BridgedTopic]) -> None:
        # Remappings do not apply to gz names, so the gz side has its own, hidden node.
        self._gz_node = graph.create_node(f"_{self._node.get_name()}_gz", namespace=self._node.get_namespace())
        self._publishers: list[Publisher[Any]] = []
        try:
            for topic in topics:
                self._bridge_topic(topic)
        except LinkwrightError:  # The caller destroys the other node.
            self._gz_node.destroy_node()
            raise

    def close(self) -> None:
        """Destroy both nodes of the bridge."""
        self._gz_node.destroy_node()
        super().close()

    def _bridge_topic(self, topic: BridgedTopic) -> None:
        try:
            get_message(topic.ros_type)
        except LinkwrightError:
            self._node.get_logger().warning(f"{topic.ros_topic} is not bridged: there is no type {topic.ros_type}")
            return
        gz_type = DEFAULT_ROS_TYPES.get(topic.gz_type, topic.ros_type)
        gz_topic = to_ros_name("/" + self._resolve_gz_name(topic.gz_topic).lstrip("/"))
        has_same_name = self._node.resolve_topic_name(topic.ros_topic) == gz_topic
        if topic.ros_type == _CLOCK_TYPE:  # The simulation publishes /clock itself.
            return
        to_ros, to_gz = (topic.direction in (direction, "BIDIRECTIONAL") for direction in ("GZ_TO_ROS", "ROS_TO_GZ"))
        if has_same_name and topic.ros_type == gz_type:
            self._create_endpoints(topic, to_ros=to_ros, to_gz=to_gz)
            return
        ros, gz = (self._node, topic.ros_topic, topic.ros_type), (self._gz_node, gz_topic, gz_type)
        # Velocities of the type of gz on a shared name would be commands for the wrong side of the bridge.
        if to_ros and not (has_same_name and to_gz and gz_type in VELOCITIES):
            self._forward_messages(topic, gz, ros)
        if to_gz:  # The ROS topic owns a shared name, so commands for gz use its hidden name.
            name = hidden_gz_topic(gz_topic) if has_same_name else gz_topic
            self._forward_messages(topic, ros, (self._gz_node, name, gz_type))

    def _create_endpoints(self, topic: BridgedTopic, *, to_ros: bool, to_gz: bool) -> None:
        """Create the endpoints of a topic before the simulation does, without forwarding messages."""
        if to_ros:
            self._node.create_publisher(topic.ros_type, topic.ros_topic, topic.publisher_queue)
        if to_gz:
            profile = QoSProfile(topic.subscriber_queue, reliability=ReliabilityPolicy.BEST_EFFORT)
            self._node.create_subscription(topic.ros_type, topic.ros_topic, lambda _: None, profile, raw=True)

    def _resolve_gz_name(self, name: str) -> str:
        """Return a gz topic name, below the node's namespace if ``expand_gz_topic_names`` is set.

        An absolute name is returned unchanged.
        """
        return join(self._node.get_namespace(), name) if self._expands_gz_names and not name.startswith("/") else name

    def _forward_messages(self, topic: BridgedTopic, source: _Endpoint, target: _Endpoint) -> None:
        """Forward the messages of a topic in one direction."""
        (source_node, source_topic, source_type), (target_node, target_topic, target_type) = source, target
        convert = find_conversion(source_type, target_type)
        if convert is None:
            text = f"{topic.ros_topic} is not bridged: {source_type} cannot be converted to {target_type}"
            self._node.get_logger().warning(text)
            return
        lazy = self._is_lazy if topic.lazy is None else topic.lazy
        publishers: list[Publisher[Any]] = []
        command_guard = dispute_monitor = None
        if target_type in VELOCITIES:
            command_guard = CommandGuard(lambda lost: send_stop(self._node, publishers[0], lost))
            dispute_monitor = DisputeMonitor.of(self._node)

        def forward(message: Any, info: MessageInfo) -> None:
            # A bidirectional bridge also receives the messages that it publishes itself.
            if all(info.publisher_gid != publisher.gid for publisher in self._publishers):
                if command_guard is not None and dispute_monitor is not None:
                    command_guard.note_publisher(info)
                    dispute_monitor.record_command(message, info)
                publishers[0].publish(convert(message))

        def subscribe() -> Subscription[Any]:
            profile = QoSProfile(topic.subscriber_queue, reliability=ReliabilityPolicy.BEST_EFFORT)
            subscription: Subscription[Any] = source_node.create_subscription(
                source_type, source_topic, forward, profile
            )
            if command_guard is not None:
                command_guard.watch(subscription)
            return subscription

        direction = _BridgeDirection(subscribe, lazy=lazy)
        events = PublisherEventCallbacks(matched=direction.on_matched) if lazy else None
        publisher: Publisher[Any] = target_node.create_publisher(
            target_type,
            target_topic,
            topic.publisher_queue,
            event_callbacks=events,
            qos_overriding_options=_OVERRIDABLE_QOS if target_node is self._node else None,
        )
        publishers.append(publisher)
        self._publishers.append(publisher)


class ParameterBridge(_Bridge):
    """The node of ``parameter_bridge``.

    The node bridges the topics in its arguments and in the file that its parameter ``config_file`` names.

    Raises:
        LinkwrightError: NODE820, an argument or the file is invalid; NODE821, the file cannot be read.
    """

    DEFAULT_NAME = "ros_gz_bridge"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            path = str(self._node.declare_parameter("config_file", "").value)
            self._is_lazy = bool(self._node.declare_parameter("lazy", False).value)
            self._expands_gz_names = bool(self._node.declare_parameter("expand_gz_topic_names", False).value)
            services = [argument for argument in arguments if _is_service(argument)]
            topics = [parse_bridge_argument(argument) for argument in arguments if argument not in services]
            topics += read_bridge_file(path) if path else []
            self._connect(graph, topics)
            for service in services:
                self._bridge_service(service)

    def _bridge_service(self, argument: str) -> None:
        """Offer a service of gz under its name in ROS, if this is another name.

        The form of the argument is ``SERVICE@ROS_TYPE``, optionally with the types of gz for request and response.
        """
        name, _, types = argument.partition("@")
        service_type = types.partition("@")[0]
        if service_type not in {service.ros_type for service in WORLD_SERVICES}:
            self._node.get_logger().warning(f"{name} is not bridged: services of type {service_type} are not supported")
            return
        gz_name = to_ros_name("/" + name.lstrip("/"))
        ros_name = self._node.resolve_service_name(name)
        if ros_name == gz_name:
            return  # The simulator offers it itself.
        client = self._gz_node.create_client(service_type, gz_name)

        def forward(request: Any, reply: Callable[[Any], None]) -> None:
            client.call_async(request).add_done_callback(lambda future: reply(future.result()))

        self._node.create_service(service_type, ros_name, forward, replying=True)


def _is_service(argument: str) -> bool:
    """Return whether an argument describes a service instead of a topic."""
    return "/srv/" in argument.partition("@")[2].partition("@")[0]


class StaticBridge(_Bridge):
    """The node of ``static_bridge``, which bridges the string topic ``chatter``."""

    DEFAULT_NAME = "ros_gz_bridge"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._connect(graph, [BridgedTopic("chatter", "chatter", "std_msgs/msg/String", "gz.msgs.StringMsg")])


class ImageBridge(_Bridge):
    """The node of ``image_bridge``, which bridges the image topics in its arguments.

    The images are also published as JPEG while a compressed topic has subscribers.
    """

    DEFAULT_NAME = "ros_gz_image"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._connect(graph, [BridgedTopic(topic, topic, *_IMAGE_TYPES, "GZ_TO_ROS") for topic in arguments])
        for topic in arguments:
            self._compress(topic)

    def _compress(self, topic: str) -> None:
        """Publish the images of a topic as JPEG while the compressed topic has subscribers."""
        name = f"{self._node.resolve_topic_name(topic)}/compressed"

        def forward(image: Any) -> None:
            try:
                message = compress_image(image)
            except ModuleNotFoundError as error:
                text = phrase(
                    "images are not compressed, because {name} is missing; {hint}",
                    name=error.name,
                    hint=install_hint("image"),
                )
                self._node.get_logger().warning(text, once=True)
                return
            if message is not None:
                publisher.publish(message)

        def subscribe() -> Subscription[Any]:
            profile = QoSProfile(1, reliability=ReliabilityPolicy.BEST_EFFORT)
            return self._gz_node.create_subscription(_IMAGE_TYPES[0], "/" + topic.lstrip("/"), forward, profile)

        events = PublisherEventCallbacks(matched=_BridgeDirection(subscribe, lazy=True).on_matched)
        publisher: Publisher[Any] = self._node.create_publisher(
            _COMPRESSED_IMAGE_TYPE, name, _QUEUE_DEPTH, event_callbacks=events
        )


def parse_bridge_argument(argument: str) -> BridgedTopic:
    """Parse an argument ``TOPIC@ROS_TYPE@GZ_TYPE`` or ``TOPIC@ROS_TYPE@GZ_TYPE@GZ_TOPIC``.

    ``[`` in place of the second ``@`` bridges only from gz to ROS, and ``]`` only from ROS to gz. The topic has the
    same name on both sides if the argument does not name the one of gz.

    Raises:
        LinkwrightError: NODE820, the argument has another form.
    """
    name, at, types = argument.partition("@")
    direction_mark = next((character for character in types if character in _DIRECTIONS), "")
    ros_type, _, gz_type = types.partition(direction_mark or "@")
    if not (name and at and direction_mark and ros_type and gz_type):
        hint = phrase("write it as {form}", form="/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan")
        raise LinkwrightError(
            Diagnostic(
                "NODE820",
                phrase(
                    "'{argument}' does not describe a topic to bridge; it needs a name and two types", argument=argument
                ),
                hint=hint,
            )
        )
    gz_type, _, gz_topic = gz_type.partition("@")
    direction = _DIRECTIONS[direction_mark]
    return BridgedTopic(name, gz_topic or name, _complete_ros_type(ros_type), _update_gz_type(gz_type), direction)


def read_bridge_file(path: str) -> list[BridgedTopic]:
    """Read the bridged topics from a YAML file.

    Raises:
        LinkwrightError: NODE821, the file cannot be read; NODE820, it is not a list of topics with their types.
    """
    try:
        entries = yaml.safe_load(read_text(path))
    except (OSError, UnicodeDecodeError) as error:
        reason = foreign(getattr(error, "strerror", None) or error)
        message = phrase("cannot read '{path}': {reason}", path=path, reason=reason)
        raise LinkwrightError(Diagnostic("NODE821", message)) from error
    except yaml.YAMLError as error:
        message = phrase("'{path}' is not YAML: {reason}", path=path, reason=foreign(" ".join(str(error).split())))
        raise LinkwrightError(Diagnostic("NODE821", message)) from error
    if not isinstance(entries, list):
        raise _bridge_file_error(path, phrase("it is not a list"))
    return [_parse_entry(entry, position, path) for position, entry in enumerate(entries, start=1)]


def _parse_entry(entry: Any, position: int, path: str) -> BridgedTopic:
    if not isinstance(entry, dict):
        raise _bridge_file_error(path, phrase("entry {number} is not a mapping", number=position))
    shared_topic = entry.get("topic_name", "")
    ros_topic = entry.get("ros_topic_name") or shared_topic or entry.get("gz_topic_name", "")
    gz_topic = entry.get("gz_topic_name") or shared_topic or ros_topic
    ros_type, gz_type = entry.get("ros_type_name", ""), entry.get("gz_type_name", "")
    for key, value in (("ros_topic_name", ros_topic), ("ros_type_name", ros_type), ("gz_type_name", gz_type)):
        if not isinstance(value, str) or not value:
            raise _bridge_file_error(path, phrase("entry {number} has no '{key}'", number=position, key=key))
    direction = entry.get("direction", "BIDIRECTIONAL")
    if direction not in _DIRECTIONS.values():
        reason = phrase("entry {number} has the unknown direction '{value}'", number=position, value=str(direction))
        raise _bridge_file_error(path, reason)
    queues = [entry.get(f"{endpoint}_queue", _QUEUE_DEPTH) for endpoint in ("publisher", "subscriber")]
    for side, value in zip(("publisher", "subscriber"), queues, strict=True):
        if not isinstance(value, int) or isinstance(value, bool) or value < 0:
            raise _bridge_file_error(
                path,
                phrase("entry {number}: '{key}' is not an integer of 0 or more", number=position, key=f"{side}_queue"),
            )
    lazy = entry.get("lazy")
    if lazy is not None and not isinstance(lazy, bool):
        raise _bridge_file_error(
            path, phrase("entry {number}: '{key}' is neither true nor false", number=position, key="lazy")
        )
    return BridgedTopic(
        ros_topic,
        gz_topic,
        _complete_ros_type(ros_type),
        _update_gz_type(gz_type),
        direction,
        queues[0],
        queues[1],
        lazy,
    )


def _bridge_file_error(path: str, reason: Any) -> LinkwrightError:
    message = phrase("'{path}' does not list topics to bridge: {reason}", path=path, reason=reason)
    hint = phrase("each entry needs ros_topic_name, gz_topic_name, ros_type_name, gz_type_name and direction")
    return LinkwrightError(Diagnostic("NODE820", message, hint=hint))


def _complete_ros_type(ros_type: str) -> str:
    return ros_type if ros_type.count("/") == 2 else ros_type.replace("/", "/msg/", 1)


def _update_gz_type(gz_type: str) -> str:
    return gz_type.replace("ignition.msgs.", "gz.msgs.")
