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
    ClockSeen,
    DescriptionSeen,
    DriversSeen,
    FixedFrame,
    FrameSeen,
    JointSeen,
    Observation,
    StampSeen,
    TransformSeen,
    node_of,
)
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.endpoints.drivers import Dispute, drivers_of, publishers_of
from linkwright.graph.names.rules import join
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.wire.joining import middleware
from linkwright.wire.unfollowed import DISCOVERY_SERVERS, MIDDLEWARE, SECURITY, ZENOH

if TYPE_CHECKING:
    from linkwright.graph.loop.future import Future
    from linkwright.graph.node import Graph, Node

_TF, _JOINT_STATE = "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/JointState"
_TRANSFORMS = ("tf", "tf_static")
_MODELS = "/model/"
"""The prefix of topics of gz, which are not ROS's before a bridge carries them."""
_STRING, _CLOCK = "std_msgs/msg/String", "rosgraph_msgs/msg/Clock"
_BOND = "bond/msg/Status"
"""Bonds stamp by a steady clock, which no other clock is compared with."""
_ENVIRONMENT = (
    "ROS_DOMAIN_ID",
    "ROS_LOCALHOST_ONLY",
    "ROS_AUTOMATIC_DISCOVERY_RANGE",
    "ROS_STATIC_PEERS",
    "CYCLONEDDS_URI",
    MIDDLEWARE,
    *DISCOVERY_SERVERS,
    *SECURITY,
    "ZENOH_CONFIG_OVERRIDE",
    "ZENOH_SESSION_CONFIG_URI",
)
_ANSWER_WITHIN = 1.0
"""Seconds for a node to answer what is asked of it; one that hangs is passed over."""
_NAMED_WITHIN = 1.0
"""Seconds for a process to announce the nodes of its endpoints; those of other programs never have one."""
_FIXED_FRAME = "fixed_frame"
_LOOK_AGAIN = 0.01
_TRANSFORMS_WITHIN = 5.0
"""How much longer than asked for it looks, in seconds, where transforms are published and none came."""
_LENGTH_TOLERANCE = 1e-3
_STAMP = {0: struct.Struct(">iI"), 1: struct.Struct("<iI")}
"""The stamp of a header that comes first, by the second byte of the CDR header, which tells the order of bytes."""
_CDR_HEADER = 4
_TWIST_BYTES = 48
"""Six numbers, at the end of a Twist and of a TwistStamped."""
_DISPUTED_S = 1.5
"""For how long drivers must contradict each other: less than a drive asks for, as one looks for a few seconds."""
_DISPUTED_TIMES = 2


async def observe(
    graph: Graph,
    node: Node,
    seconds: float,
    *,
    fixed_frames: Sequence[FixedFrame] = (),
    environment: Mapping[str, str] | None = None,
) -> Observation:
    """Observe a graph, and return the observations.

    Args:
        graph: the graph, joined with other processes, on the running event loop.
        node: the observing node of this graph, which is excluded from the observations.
        seconds: the duration of the observation.
        fixed_frames: the Fixed Frames of viewers that do not declare them as parameters.
        environment: the environment variables; None for the environment of this process.
    """
    watcher = _Watcher(graph, node)
    end = time.monotonic() + seconds
    while True:
        watcher.subscribe()
        left = end - time.monotonic()
        if left <= (-_TRANSFORMS_WITHIN if watcher.waits_for_transforms() else 0):
            break
        await asyncio.sleep(min(left, 0.25) if left > 0 else _LOOK_AGAIN)
    sim_time, lifecycle, shown_in = await asyncio.gather(
        watcher.sim_time(), watcher.lifecycle(), watcher.fixed_frames()
    )
    await watcher.until_named()
    variables = os.environ if environment is None else environment
    return Observation(
        over_zenoh=middleware() == ZENOH,
        seconds=seconds,
        nodes=tuple(watcher.nodes()),
        endpoints=tuple(watcher.endpoints()),
        transforms=watcher.transforms(),
        joints=watcher.joints(),
        descriptions=tuple(watcher.descriptions.values()),
        stamps=watcher.stamps_seen(sim_time),
        frames=watcher.frames_seen(),
        disputed=watcher.disputed(),
        clock=watcher.clock,
        sim_time=sim_time,
        lifecycle=lifecycle,
        fixed_frames=(*fixed_frames, *shown_in),
        environment={name: variables[name] for name in _ENVIRONMENT if name in variables},
    )


class _Watcher:
    """Subscribes to the topics that the examinations need, and records observations."""

    def __init__(self, graph: Graph, node: Node) -> None:
        self._graph = graph
        self._node = node
        self._subscribed: set[tuple[str, str]] = set()
        self._transforms: dict[tuple[str, str], tuple[dict[str, set[str]], bool, bool]] = {}
        self._joints: dict[str, tuple[set[str], set[str]]] = {}
        self._stamps: dict[tuple[str, str], tuple[int, int]] = {}
        self._latched: set[str] = set()
        self._awaited: set[str] = set()
        self._frames: dict[tuple[str, str], str] = {}
        self._disputes: dict[str, Dispute] = {}
        self.descriptions: dict[tuple[str, str], DescriptionSeen] = {}
        self.clock: ClockSeen | None = None

    def nodes(self) -> list[str]:
        """Return the full names of the nodes.

        The observing node and the hidden nodes of other tools are excluded.
        """
        names = (join(identity.namespace, identity.name) for identity in self._graph.identities())
        return sorted(name for name in names if not _is_tool(name) and name != self._own)

    def endpoints(self) -> list[EndpointInfo]:
        """Return the endpoints of the graph.

        Endpoints of the observing node and of the hidden nodes of other tools are excluded.
        """
        return [
            endpoint
            for endpoint in self._graph.endpoints()
            if not _is_tool(node_of(endpoint)) and node_of(endpoint) != self._own
        ]

    async def until_named(self) -> None:
        """Wait until the node of every endpoint is known.

        A node is discovered shortly after its endpoints. Until then, the endpoints of another command would be treated
        as a part of the graph.
        """
        end = time.monotonic() + _NAMED_WITHIN
        while time.monotonic() < end:
            if all(endpoint.node is not None for endpoint in self._graph.endpoints()):
                break
            await asyncio.sleep(_LOOK_AGAIN)

    def waits_for_transforms(self) -> bool:
        """Return whether a topic with publishers of transforms has not delivered any transform yet.

        On a busy machine, the first transforms take seconds to arrive.
        """
        heard = {topic for senders, _, _ in self._transforms.values() for topic in senders}
        return not self._awaited <= heard

    @property
    def _own(self) -> str:
        return self._node.get_fully_qualified_name()

    def subscribe(self) -> None:
        """Subscribe to new topics that the examinations need.

        A topic of a tool such as ``topic pub`` is included only if it carries velocities.
        """
        for endpoint in self._graph.endpoints():
            key = (endpoint.name, endpoint.type_name)
            if _is_tool(node_of(endpoint)) and endpoint.type_name not in (TWIST, TWIST_STAMPED):
                continue
            if (
                endpoint.kind is EndpointKind.PUBLISHER
                and node_of(endpoint) != self._own
                and key not in self._subscribed
            ):
                self._subscribed.add(key)
                self._subscribe(endpoint)

    def _subscribe(self, endpoint: EndpointInfo) -> None:
        topic, kind = endpoint.name, endpoint.type_name
        last = topic.rpartition("/")[2]
        if kind == _TF:
            if last not in _TRANSFORMS or topic.startswith(_MODELS):
                return  # poses in a simulated world are not frames; a bridge publishes gz's model poses on /tf
            is_static = last == _TRANSFORMS[1]
            self._awaited.add(topic)
            self._listen(endpoint, lambda message, info: self._on_transforms(topic, is_static, message, info))
        elif kind == _JOINT_STATE:
            self._listen(endpoint, lambda message, info: self._on_joints(topic, message, info))
        elif kind == _STRING and last == "robot_description":
            self._listen(endpoint, lambda message, info: self._on_description(topic, message, info))
        elif kind == _CLOCK and topic == "/clock":
            self._listen(endpoint, lambda message, _info: self._on_clock(message))
        elif kind == TWIST:
            self._listen(endpoint, lambda data, info: self._on_velocity(topic, data, info), raw=True)
        elif kind != _BOND and _begins_with_header(kind):
            driving = kind == TWIST_STAMPED
            self._listen(endpoint, lambda data, info: self._on_stamped(topic, data, info, driving=driving), raw=True)

    def _listen(self, endpoint: EndpointInfo, callback: Any, *, raw: bool = False) -> None:
        """Subscribe to a topic with a QoS profile that is compatible with every publisher.

        The last messages of a latched topic are received, too.
        """
        offers = [publisher.qos for publisher in self._publishers(endpoint.name)]
        latched = all(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
        reliable = all(offer.reliability is ReliabilityPolicy.RELIABLE for offer in offers)
        if latched:
            self._latched.add(endpoint.name)
        qos = QoSProfile(
            100,
            ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
            DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE,
        )

        def listen(message: Any, info: MessageInfo) -> None:
            callback(message, info)

        self._node.create_subscription(endpoint.type_name, endpoint.name, listen, qos, raw=raw)

    def _sender(self, topic: str, info: MessageInfo) -> str:
        publishers = self._publishers(topic)
        for publisher in publishers:
            if publisher.gid == info.publisher_gid:
                return node_of(publisher)
        return node_of(publishers[0]) if len(publishers) == 1 else UNKNOWN_NODE

    def _publishers(self, topic: str) -> list[EndpointInfo]:
        return [
            endpoint
            for endpoint in self._graph.endpoints()
            if endpoint.name == topic and endpoint.kind is EndpointKind.PUBLISHER
        ]

    # --- messages received -------------------------------------------------------------------------------------------

    def _on_transforms(self, topic: str, is_static: bool, message: Any, info: MessageInfo) -> None:
        sender = self._sender(topic, info)
        for transform in message.transforms:
            key = (transform.header.frame_id.lstrip("/"), transform.child_frame_id.lstrip("/"))
            senders, _, valid = self._transforms.get(key, ({}, is_static, True))
            senders.setdefault(topic, set()).add(sender)
            self._transforms[key] = (senders, is_static, valid and _is_transform(transform.transform))
            if not is_static:
                self._note_stamp(topic, sender, transform.header.stamp.sec, transform.header.stamp.nanosec)

    def _on_joints(self, topic: str, message: Any, info: MessageInfo) -> None:
        sender = self._sender(topic, info)
        self._note_stamp(topic, sender, message.header.stamp.sec, message.header.stamp.nanosec)
        for name in message.name if len(message.position) else ():
            senders, topics = self._joints.setdefault(name, (set(), set()))
            senders.add(sender)
            topics.add(topic)

    def _on_description(self, topic: str, message: Any, info: MessageInfo) -> None:
        sender = self._sender(topic, info)
        self.descriptions[topic, sender] = DescriptionSeen(topic, sender, message.data)

    def _on_clock(self, message: Any) -> None:
        now_ns = message.clock.nanoseconds
        before = self.clock
        self.clock = (
            ClockSeen(1, now_ns, now_ns) if before is None else ClockSeen(before.ticks + 1, before.first_ns, now_ns)
        )

    def _on_velocity(self, topic: str, data: bytes, info: MessageInfo) -> None:
        dispute = self._disputes.setdefault(topic, Dispute(_DISPUTED_S, _DISPUTED_TIMES))
        dispute.note_command(info.publisher_gid, bytes(data[-_TWIST_BYTES:]), time.monotonic())

    def _on_stamped(self, topic: str, data: bytes, info: MessageInfo, *, driving: bool) -> None:
        if driving:
            self._on_velocity(topic, data, info)
        seconds, nanoseconds = _STAMP[data[1] & 1].unpack_from(data, _CDR_HEADER)
        sender = self._sender(topic, info)
        self._note_stamp(topic, sender, seconds, nanoseconds)
        self._frames[topic, sender] = _frame_of(data)

    def _note_stamp(self, topic: str, sender: str, seconds: int, nanoseconds: int) -> None:
        """Record the stamp of a message.

        On a latched topic such as a map, only a stamp of 0 is recorded, because other stamps can be of any age.
        """
        if topic in self._latched and (seconds or nanoseconds):
            return
        self._stamps[topic, sender] = (seconds * NANOSECONDS_PER_SECOND + nanoseconds, time.time_ns())

    # --- observations from the messages ------------------------------------------------------------------------------

    def transforms(self) -> tuple[TransformSeen, ...]:
        """Return the transforms, sorted by parent and child.

        The senders of a transform are those on one topic, because a bridge may forward the transforms of another topic.
        """
        return tuple(
            TransformSeen(parent, child, max(map(tuple, map(sorted, senders.values())), key=len), is_static, valid)
            for (parent, child), (senders, is_static, valid) in sorted(self._transforms.items())
        )

    def joints(self) -> tuple[JointSeen, ...]:
        """Return the joint states, sorted by the name of the joint."""
        return tuple(
            JointSeen(name, tuple(sorted(senders)), tuple(sorted(topics)))
            for name, (senders, topics) in sorted(self._joints.items())
        )

    def disputed(self) -> tuple[DriversSeen, ...]:
        """Return the nodes that sent contradictory velocities, by topic."""
        found = []
        for topic, dispute in sorted(self._disputes.items()):
            drivers = drivers_of(self._graph, publishers_of(self._graph, dispute.parties))
            if len(drivers) > 1:
                found.append(DriversSeen(topic, tuple(drivers)))
        return tuple(found)

    def stamps_seen(self, sim_time: Mapping[str, bool]) -> tuple[StampSeen, ...]:
        """Return the stamps relative to the clock of their senders.

        The clock is simulated time if the sender uses or publishes simulated time. Any other sender may forward the
        stamps of other nodes, so the clock that is closer to the stamp is used.
        """
        found = []
        makers = {node_of(publisher) for publisher in self._publishers("/clock")}
        for (topic, sender), (stamp_ns, now_ns) in sorted(self._stamps.items()):
            if sim_time.get(sender) or sender in makers:
                if self.clock is None:
                    continue
                now_ns = self.clock.last_ns
            behind_ns = now_ns - stamp_ns
            if self.clock is not None:  # bridges and robot_state_publisher forward stamps of simulated time
                behind_ns = min(behind_ns, self.clock.last_ns - stamp_ns, key=abs)
            found.append(StampSeen(topic, sender, behind_ns, zero=stamp_ns == 0))
        return tuple(found)

    def frames_seen(self) -> tuple[FrameSeen, ...]:
        """Return the frames of messages, by topic and sender; empty frames are omitted."""
        named = sorted(item for item in self._frames.items() if item[1])
        return tuple(FrameSeen(topic, sender, frame) for (topic, sender), frame in named)

    # --- service calls -----------------------------------------------------------------------------------------------

    async def sim_time(self) -> dict[str, bool]:
        """Return the value of ``use_sim_time`` of each node that responds, by full name."""
        kind = "rcl_interfaces/srv/GetParameters"
        answers = await self._ask_all(kind, "get_parameters", names=["use_sim_time"])
        return {node: bool(answer.values[0].bool_value) for node, answer in answers.items() if answer.values}

    async def lifecycle(self) -> dict[str, str]:
        """Return the state of each managed node that responds, by full name."""
        answers = await self._ask_all("lifecycle_msgs/srv/GetState", "get_state")
        return {node: answer.current_state.label for node, answer in answers.items()}

    async def fixed_frames(self) -> list[FixedFrame]:
        """Return the Fixed Frame of each viewer that declares it as a parameter, as ours does."""
        subscriptions = [endpoint for endpoint in self.endpoints() if endpoint.kind is EndpointKind.SUBSCRIPTION]
        viewers = {node_of(subscription) for subscription in subscriptions if subscription.type_name == _TF}
        package = "rcl_interfaces/srv"
        listed = await self._ask_all(f"{package}/ListParameters", "list_parameters", viewers, prefixes=[_FIXED_FRAME])
        # Do not request the parameter from other nodes, which would log an error.
        with_frame = {node for node, answer in listed.items() if _FIXED_FRAME in answer.result.names}
        answers = await self._ask_all(f"{package}/GetParameters", "get_parameters", with_frame, names=[_FIXED_FRAME])
        return [FixedFrame(answer.values[0].string_value, f"'{node}'") for node, answer in sorted(answers.items())]

    async def _ask_all(self, kind: str, service: str, among: set[str] | None = None, **fields: Any) -> dict[str, Any]:
        """Call a service of all nodes that offer it.

        Returns:
            The responses that arrived in time, by full name of the node.
        """
        from linkwright.messages import get_service

        served = {
            endpoint.name
            for endpoint in self.endpoints()
            if endpoint.kind is EndpointKind.SERVICE and endpoint.type_name == kind
        }
        nodes = [node for node in dict.fromkeys(self.nodes()) if f"{node}/{service}" in served]
        if among is not None:
            nodes = [node for node in nodes if node in among]
        clients = {node: self._node.create_client(kind, f"{node}/{service}") for node in nodes}
        request = get_service(kind).Request(**fields)
        futures = {node: client.call_async(request) for node, client in clients.items()}
        tasks = {node: asyncio.ensure_future(_result(future)) for node, future in futures.items()}
        if tasks:
            await asyncio.wait(tasks.values(), timeout=_ANSWER_WITHIN)
        for node, client in clients.items():
            tasks[node].cancel()
            client.remove_pending_request(futures[node])
            self._node.destroy_client(client)
        return {node: future.result() for node, future in futures.items() if future.done()}


async def _result(future: Future[Any]) -> Any:
    return await future


def _frame_of(data: bytes) -> str:
    """Return the frame in the header of a serialized message, without reading the rest."""
    start = _CDR_HEADER + _STAMP[0].size
    size = int.from_bytes(data[start : start + 4], "little" if data[1] & 1 else "big")
    return data[start + 4 : start + 4 + size].rstrip(b"\0").decode(errors="replace").lstrip("/")


def _is_tool(full_name: str) -> bool:
    """Return whether a node belongs to a command that only inspects the graph."""
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
    turn, shift = transform.rotation, transform.translation
    numbers = (turn.x, turn.y, turn.z, turn.w, shift.x, shift.y, shift.z)
    return all(map(math.isfinite, numbers)) and math.hypot(turn.x, turn.y, turn.z, turn.w) > _LENGTH_TOLERANCE
