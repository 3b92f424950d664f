"""Observes a running graph for several seconds."""

from __future__ import annotations

import asyncio
import math
import os
import struct
import time
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.doctor.record import (
    TWIST,
    TWIST_STAMPED,
    UNKNOWN_NODE,
    FixedFrame,
    Observation,
    ObservedClock,
    ObservedCommanders,
    ObservedDescription,
    ObservedFrame,
    ObservedJoint,
    ObservedStamp,
    ObservedTransform,
    get_node_name,
)
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.endpoints.command_disputes import DisputeDetector, find_node_names, find_publishers
from linkwright.graph.names.rules import join
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.wire.joining import select_middleware
from linkwright.wire.unsupported_settings import (
    DISCOVERY_SERVER_VARIABLES,
    MIDDLEWARE_VARIABLE,
    SECURITY_VARIABLES,
    ZENOH,
)

if TYPE_CHECKING:
    from linkwright.graph.loop.future import Future
    from linkwright.graph.node import Graph, Node

_TF, _JOINT_STATE = "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"
_TRANSFORMS = ("tf", "tf_static")
_MODEL_PREFIX = "/model/"
"""The prefix of gz's topics. ROS nodes receive these topics only through a bridge."""
_STRING, _CLOCK = "std_msgs/msg/String", "rosgraph_msgs/msg/Clock"
_BOND = "bond/msg/Status"
"""The type of bond messages.

Their stamps come from a steady clock, and cannot be compared with other clocks.
"""
_DISCOVERY_VARIABLES = (
    "ROS_DOMAIN_ID",
    "ROS_LOCALHOST_ONLY",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "CYCLONEDDS_URI",
    MIDDLEWARE_VARIABLE,
    *DISCOVERY_SERVER_VARIABLES,
    *SECURITY_VARIABLES,
    "ZENOH_CONFIG_OVERRIDE",
    "ZENOH_SESSION_CONFIG_URI",
)
_RESPONSE_TIMEOUT_S = 1.0
"""The maximum seconds to wait for a node's response.

A node that does not respond is skipped.
"""
_NAMING_TIMEOUT_S = 1.0
"""The maximum seconds to wait for the nodes of endpoints.

The endpoints of some programs never have a node.
"""
_FIXED_FRAME = "fixed_frame"
_POLL_S = 0.01
_TRANSFORMS_TIMEOUT_S = 5.0
"""The maximum additional seconds to wait while published transforms were not received."""

_MIN_QUATERNION_NORM = 1e-3
"""A rotation with a smaller norm was not set."""
_STAMP = {0: struct.Struct(">iI"), 1: struct.Struct("<iI")}
"""The stamp of a header at the start of a message, by byte order.

The byte order is the second byte of the CDR header.
"""
_CDR_HEADER = 4
_TWIST_BYTES = 48
"""The size of the six numbers at the end of a Twist or TwistStamped."""
_MIN_DISPUTE_S = 1.5
"""The seconds for which drivers must contradict each other.

The time is short because observations are short.
"""
_MIN_DISPUTE_COUNT = 2


async def observe(
    graph: Graph,
    node: Node,
    seconds: float,
    *,
    fixed_frames: Sequence[FixedFrame] = (),
    environment: Mapping[str, str] | None = None,
) -> Observation:
    """Observe a graph for a period, and return the observations.

    Args:
        graph: the graph on the running event loop, which has joined other processes.
        node: the observing node of this graph, which the observation omits.
        seconds: the duration of the observation in seconds.
        fixed_frames: the Fixed Frames of viewers that do not declare them as parameters.
        environment: the environment variables; None for the environment of this process.
    """
    watcher = _Watcher(graph, node)
    end = time.monotonic() + seconds
    while True:
        watcher.subscribe()
        remaining_seconds = end - time.monotonic()
        if remaining_seconds <= (-_TRANSFORMS_TIMEOUT_S if watcher.waits_for_transforms() else 0):
            break
        await asyncio.sleep(min(remaining_seconds, 0.25) if remaining_seconds > 0 else _POLL_S)
    sim_time, lifecycle, viewer_frames = await asyncio.gather(
        watcher.sim_time(), watcher.lifecycle(), watcher.fixed_frames()
    )
    await watcher.wait_for_node_names()
    variables = os.environ if environment is None else environment
    return Observation(
        over_zenoh=select_middleware() == ZENOH,
        seconds=seconds,
        nodes=tuple(watcher.nodes()),
        endpoints=tuple(watcher.endpoints()),
        transforms=watcher.transforms(),
        joints=watcher.joints(),
        descriptions=tuple(watcher.descriptions.values()),
        stamps=watcher.compute_stamp_ages(sim_time),
        frames=watcher.find_frames(),
        contradictory_velocities=watcher.contradictory_velocities(),
        clock=watcher.clock,
        sim_time=sim_time,
        lifecycle=lifecycle,
        fixed_frames=(*fixed_frames, *viewer_frames),
        environment={name: variables[name] for name in _DISCOVERY_VARIABLES if name in variables},
    )


class _Watcher:
    """The subscriptions that the examinations need, and a record of their messages."""

    def __init__(self, graph: Graph, node: Node) -> None:
        self._graph = graph
        self._node = node
        self._subscribed: set[tuple[str, str]] = set()
        self._transforms: dict[tuple[str, str], tuple[dict[str, set[str]], bool, bool]] = {}
        self._joints: dict[str, tuple[set[str], set[str]]] = {}
        self._stamps: dict[tuple[str, str], tuple[int, int]] = {}
        self._latched: set[str] = set()
        self._transform_topics: set[str] = set()
        self._frames: dict[tuple[str, str], str] = {}
        self._disputes: dict[str, DisputeDetector] = {}
        self.descriptions: dict[tuple[str, str], ObservedDescription] = {}
        self.clock: ObservedClock | None = None

    def nodes(self) -> list[str]:
        """Return the full names of the nodes in the graph.

        The observing node and the hidden nodes of commands are excluded.
        """
        names = (join(identity.namespace, identity.name) for identity in self._graph.identities())
        return sorted(name for name in names if not _is_tool(name) and name != self._get_own_name)

    def endpoints(self) -> list[EndpointInfo]:
        """Return the endpoints of the graph.

        Endpoints of the observing node and of the hidden nodes of commands are excluded.
        """
        return [
            endpoint
            for endpoint in self._graph.endpoints()
            if not _is_tool(get_node_name(endpoint)) and get_node_name(endpoint) != self._get_own_name
        ]

    async def wait_for_node_names(self) -> None:
        """Wait until the node of every endpoint is known.

        A node is discovered shortly after its endpoints. Before that, the endpoints of another command would be
        mistaken for a part of the graph.
        """
        end = time.monotonic() + _NAMING_TIMEOUT_S
        while time.monotonic() < end:
            if all(endpoint.node is not None for endpoint in self._graph.endpoints()):
                break
            await asyncio.sleep(_POLL_S)

    def waits_for_transforms(self) -> bool:
        """Return whether a topic with a publisher of transforms has not delivered any.

        On a busy computer, the first transforms take seconds to arrive.
        """
        topics_with_transforms = {topic for senders, _, _ in self._transforms.values() for topic in senders}
        return not self._transform_topics <= topics_with_transforms

    @property
    def _get_own_name(self) -> str:
        return self._node.get_fully_qualified_name()

    def subscribe(self) -> None:
        """Subscribe to needed topics that have appeared since the last call.

        Topics of a command such as ``topic pub`` are included only if they carry velocities.
        """
        for endpoint in self._graph.endpoints():
            key = (endpoint.name, endpoint.type_name)
            if _is_tool(get_node_name(endpoint)) and endpoint.type_name not in (TWIST, TWIST_STAMPED):
                continue
            if (
                endpoint.kind is EndpointKind.PUBLISHER
                and get_node_name(endpoint) != self._get_own_name
                and key not in self._subscribed
            ):
                self._subscribed.add(key)
                self._subscribe(endpoint)

    def _subscribe(self, endpoint: EndpointInfo) -> None:
        topic, type_name = endpoint.name, endpoint.type_name
        base_name = topic.rpartition("/")[2]
        if type_name == _TF:
            if base_name not in _TRANSFORMS or topic.startswith(_MODEL_PREFIX):
                return  # poses in a simulated world are not frames; a bridge publishes gz's model poses on /tf
            is_static = base_name == _TRANSFORMS[1]
            self._transform_topics.add(topic)
            self._listen(endpoint, lambda message, info: self._on_transforms(topic, is_static, message, info))
        elif type_name == _JOINT_STATE:
            self._listen(endpoint, lambda message, info: self._on_joints(topic, message, info))
        elif type_name == _STRING and base_name == "robot_description":
            self._listen(endpoint, lambda message, info: self._on_description(topic, message, info))
        elif type_name == _CLOCK and topic == "/clock":
            self._listen(endpoint, lambda message, _info: self._on_clock(message))
        elif type_name == TWIST:
            self._listen(endpoint, lambda data, info: self._on_velocity(topic, data, info), raw=True)
        elif type_name != _BOND and _begins_with_header(type_name):
            is_velocity = type_name == TWIST_STAMPED
            self._listen(
                endpoint, lambda data, info: self._on_stamped(topic, data, info, is_velocity=is_velocity), raw=True
            )

    def _listen(self, endpoint: EndpointInfo, callback: Any, *, raw: bool = False) -> None:
        """Subscribe to a topic with a QoS profile that is compatible with all its publishers.

        From a latched topic, the last messages are also received.
        """
        offers = [publisher.qos for publisher in self._find_publishers(endpoint.name)]
        is_latched = all(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
        is_reliable = all(offer.reliability is ReliabilityPolicy.RELIABLE for offer in offers)
        if is_latched:
            self._latched.add(endpoint.name)
        qos = QoSProfile(
            100,
            ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
            DurabilityPolicy.TRANSIENT_LOCAL if is_latched else DurabilityPolicy.VOLATILE,
        )

        def listen(message: Any, info: MessageInfo) -> None:
            callback(message, info)

        self._node.create_subscription(endpoint.type_name, endpoint.name, listen, qos, raw=raw)

    def _find_sender(self, topic: str, info: MessageInfo) -> str:
        publishers = self._find_publishers(topic)
        for publisher in publishers:
            if publisher.gid == info.publisher_gid:
                return get_node_name(publisher)
        return get_node_name(publishers[0]) if len(publishers) == 1 else UNKNOWN_NODE

    def _find_publishers(self, topic: str) -> list[EndpointInfo]:
        return [
            endpoint
            for endpoint in self._graph.endpoints()
            if endpoint.name == topic and endpoint.kind is EndpointKind.PUBLISHER
        ]

    # --- messages received -------------------------------------------------------------------------------------------

    def _on_transforms(self, topic: str, is_static: bool, message: Any, info: MessageInfo) -> None:
        sender = self._find_sender(topic, info)
        for transform in message.transforms:
            key = (transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/"))
            senders, _, valid = self._transforms.get(key, ({}, is_static, True))
            senders.setdefault(topic, set()).add(sender)
            self._transforms[key] = (senders, is_static, valid and _is_transform(transform.transform))
            if not is_static:
                self._record_stamp(topic, sender, transform.header.stamp.sec, transform.header.stamp.nanosec)

    def _on_joints(self, topic: str, message: Any, info: MessageInfo) -> None:
        sender = self._find_sender(topic, info)
        self._record_stamp(topic, sender, message.header.stamp.sec, message.header.stamp.nanosec)
        for name in message.name if len(message.position) else ():
            senders, topics = self._joints.setdefault(name, (set(), set()))
            senders.add(sender)
            topics.add(topic)

    def _on_description(self, topic: str, message: Any, info: MessageInfo) -> None:
        sender = self._find_sender(topic, info)
        self.descriptions[topic, sender] = ObservedDescription(topic, sender, message.data)

    def _on_clock(self, message: Any) -> None:
        now_ns = message.clock.nanoseconds
        previous = self.clock
        self.clock = (
            ObservedClock(1, now_ns, now_ns)
            if previous is None
            else ObservedClock(previous.message_count + 1, previous.first_ns, now_ns)
        )

    def _on_velocity(self, topic: str, data: bytes, info: MessageInfo) -> None:
        dispute = self._disputes.setdefault(topic, DisputeDetector(_MIN_DISPUTE_S, _MIN_DISPUTE_COUNT))
        dispute.record_command(info.publisher_gid, bytes(data[-_TWIST_BYTES:]), time.monotonic())

    def _on_stamped(self, topic: str, data: bytes, info: MessageInfo, *, is_velocity: bool) -> None:
        if is_velocity:
            self._on_velocity(topic, data, info)
        seconds, nanoseconds = _STAMP[data[1] & 1].unpack_from(data, _CDR_HEADER)
        sender = self._find_sender(topic, info)
        self._record_stamp(topic, sender, seconds, nanoseconds)
        self._frames[topic, sender] = _read_frame(data)

    def _record_stamp(self, topic: str, sender: str, seconds: int, nanoseconds: int) -> None:
        """Record the stamp of a message.

        On a latched topic, such as a map, only a stamp of 0 is recorded, because messages may be of any age.
        """
        if topic in self._latched and (seconds or nanoseconds):
            return
        self._stamps[topic, sender] = (seconds * NANOSECONDS_PER_SECOND + nanoseconds, time.time_ns())

    # --- observations from the messages ------------------------------------------------------------------------------

    def transforms(self) -> tuple[ObservedTransform, ...]:
        """Return the transforms, sorted by parent and child.

        The senders of a transform are the nodes that publish it on one topic, because a bridge may forward transforms
        to another topic.
        """
        return tuple(
            ObservedTransform(parent, child, max(map(tuple, map(sorted, senders.values())), key=len), is_static, valid)
            for (parent, child), (senders, is_static, valid) in sorted(self._transforms.items())
        )

    def joints(self) -> tuple[ObservedJoint, ...]:
        """Return the observed joints, sorted by name."""
        return tuple(
            ObservedJoint(name, tuple(sorted(senders)), tuple(sorted(topics)))
            for name, (senders, topics) in sorted(self._joints.items())
        )

    def contradictory_velocities(self) -> tuple[ObservedCommanders, ...]:
        """Return the nodes that published contradictory velocities, by topic."""
        drivers_by_topic = []
        for topic, dispute in sorted(self._disputes.items()):
            drivers = find_node_names(self._graph, find_publishers(self._graph, dispute.parties))
            if len(drivers) > 1:
                drivers_by_topic.append(ObservedCommanders(topic, tuple(drivers)))
        return tuple(drivers_by_topic)

    def compute_stamp_ages(self, sim_time: Mapping[str, bool]) -> tuple[ObservedStamp, ...]:
        """Return the age of the last stamp of each sender on each topic.

        Ages are measured with the sender's clock.

        This clock is simulated time if the sender uses or publishes it. Any other sender may forward the stamps of
        other nodes, so the age is measured with the clock that is closer to the stamp.
        """
        stamps = []
        clock_nodes = {get_node_name(publisher) for publisher in self._find_publishers("/clock")}
        for (topic, sender), (stamp_ns, now_ns) in sorted(self._stamps.items()):
            if sim_time.get(sender) or sender in clock_nodes:
                if self.clock is None:
                    continue
                now_ns = self.clock.last_ns
            age_ns = now_ns - stamp_ns
            if self.clock is not None:  # bridges and robot_state_publisher forward stamps of simulated time
                age_ns = min(age_ns, self.clock.last_ns - stamp_ns, key=abs)
            stamps.append(ObservedStamp(topic, sender, age_ns, is_zero=stamp_ns == 0))
        return tuple(stamps)

    def find_frames(self) -> tuple[ObservedFrame, ...]:
        """Return the frames of messages by topic and sender, without empty frames."""
        named_frames = sorted(item for item in self._frames.items() if item[1])
        return tuple(ObservedFrame(topic, sender, frame) for (topic, sender), frame in named_frames)

    # --- service calls -----------------------------------------------------------------------------------------------

    async def sim_time(self) -> dict[str, bool]:
        """Return the value of ``use_sim_time`` for each node that responded in time."""
        service_type = "rcl_interfaces/srv/GetParameters"
        responses = await self._call_all(service_type, "get_parameters", names=["use_sim_time"])
        return {node: bool(response.values[0].bool_value) for node, response in responses.items() if response.values}

    async def lifecycle(self) -> dict[str, str]:
        """Return the state of each managed node that responded in time."""
        responses = await self._call_all("lifecycle_msgs/srv/GetState", "get_state")
        return {node: response.current_state.label for node, response in responses.items()}

    async def fixed_frames(self) -> list[FixedFrame]:
        """Return the Fixed Frames that viewers declare as a parameter, as Linkwright's viewer does."""
        subscriptions = [endpoint for endpoint in self.endpoints() if endpoint.kind is EndpointKind.SUBSCRIPTION]
        viewers = {get_node_name(subscription) for subscription in subscriptions if subscription.type_name == _TF}
        package = "rcl_interfaces/srv"
        parameter_lists = await self._call_all(
            f"{package}/ListParameters", "list_parameters", viewers, prefixes=[_FIXED_FRAME]
        )
        # The parameter is not requested from other nodes, because they would log an error.
        nodes_with_frame = {node for node, answer in parameter_lists.items() if _FIXED_FRAME in answer.result.names}
        responses = await self._call_all(
            f"{package}/GetParameters", "get_parameters", nodes_with_frame, names=[_FIXED_FRAME]
        )
        return [
            FixedFrame(response.values[0].string_value, f"'{node}'") for node, response in sorted(responses.items())
        ]

    async def _call_all(
        self, service_type: str, service: str, candidates: set[str] | None = None, **fields: Any
    ) -> dict[str, Any]:
        """Call a service of all nodes that offer it, and return the responses.

        Returns:
            The responses that arrived in time, by the full name of the node.
        """
        from linkwright.messages import get_service

        service_names = {
            endpoint.name
            for endpoint in self.endpoints()
            if endpoint.kind is EndpointKind.SERVICE and endpoint.type_name == service_type
        }
        nodes = [node for node in dict.fromkeys(self.nodes()) if f"{node}/{service}" in service_names]
        if candidates is not None:
            nodes = [node for node in nodes if node in candidates]
        clients = {node: self._node.create_client(service_type, f"{node}/{service}") for node in nodes}
        request = get_service(service_type).Request(**fields)
        futures = {node: client.call_async(request) for node, client in clients.items()}
        tasks = {node: asyncio.ensure_future(_await_result(future)) for node, future in futures.items()}
        if tasks:
            await asyncio.wait(tasks.values(), timeout=_RESPONSE_TIMEOUT_S)
        for node, client in clients.items():
            tasks[node].cancel()
            client.remove_pending_request(futures[node])
            self._node.destroy_client(client)
        return {node: future.result() for node, future in futures.items() if future.done()}


async def _await_result(future: Future[Any]) -> Any:
    return await future


def _read_frame(data: bytes) -> str:
    """Return the frame in the header of a serialized message, without deserializing the rest."""
    start = _CDR_HEADER + _STAMP[0].size
    size = int.from_bytes(data[start : start + 4], "little" if data[1] & 1 else "big")
    return data[start + 4 : start + 4 + size].rstrip(b"\0").decode(errors="replace").lstrip("/")


def _is_tool(full_name: str) -> bool:
    """Return whether a node belongs to a command that only observes the graph."""
    return full_name.rpartition("/")[2].startswith("_ros2cli")


def _begins_with_header(type_name: str) -> bool:
    from linkwright.diagnostics import LinkwrightError
    from linkwright.messages import get_message

    try:
        fields = get_message(type_name).get_fields_and_field_types()
    except LinkwrightError:  # the type's package is not available
        return False
    return next(iter(fields.items()), None) == ("header", "std_msgs/Header")


def _is_transform(transform: Any) -> bool:
    rotation, translation = transform.rotation, transform.translation
    numbers = (rotation.x, rotation.y, rotation.z, rotation.w, translation.x, translation.y, translation.z)
    return (
        all(map(math.isfinite, numbers))
        and math.hypot(rotation.x, rotation.y, rotation.z, rotation.w) > _MIN_QUATERNION_NORM
    )
