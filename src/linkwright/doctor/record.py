"""Observations of a running graph, as plain data for the examinations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from linkwright.diagnostics import Phrase, phrase, quoted_names
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import join

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
UNKNOWN_NODE = "an unknown node"
"""The name of a sender that discovery does not report."""


@dataclass(frozen=True, slots=True)
class TransformSeen:
    """The observed transforms from a frame to one of its parents.

    Attributes:
        parent: the parent frame.
        child: the child frame.
        senders: full names of the nodes that published the transform, sorted.
        static: whether it was published on a topic of static transforms.
        valid: whether all its numbers are finite and its rotation is not zero.
    """

    parent: str
    child: str
    senders: tuple[str, ...]
    static: bool = False
    valid: bool = True


@dataclass(frozen=True, slots=True)
class JointSeen:
    """The observed states of a joint.

    Attributes:
        name: the name of the joint.
        senders: full names of the nodes that published the states, sorted.
        topics: the topics on which they were published, sorted.
    """

    name: str
    senders: tuple[str, ...]
    topics: tuple[str, ...] = ("/joint_states",)


@dataclass(frozen=True, slots=True)
class DescriptionSeen:
    """An observed robot description.

    Attributes:
        topic: the topic on which it was published.
        sender: full name of the node that published it.
        text: the URDF.
    """

    topic: str
    sender: str
    text: str


@dataclass(frozen=True, slots=True)
class StampSeen:
    """The observed stamps of a node on a topic.

    Attributes:
        topic: the topic.
        sender: the full name of the publishing node.
        behind_ns: how far the last stamp was behind the clock on arrival, in nanoseconds; negative if it was ahead.
        zero: whether the stamp was 0, which means that it was never set.
    """

    topic: str
    sender: str
    behind_ns: int
    zero: bool = False


@dataclass(frozen=True, slots=True)
class FrameSeen:
    """The observed frame of a node's messages on a topic.

    Attributes:
        topic: the topic on which the messages were published.
        sender: full name of the node that published them.
        frame: the name of the frame in the last message.
    """

    topic: str
    sender: str
    frame: str


@dataclass(frozen=True, slots=True)
class DriversSeen:
    """Nodes that sent contradicting velocities at the same time on one topic.

    Attributes:
        topic: the topic on which the velocities were published, as Twist or TwistStamped.
        drivers: full names of the nodes that published them, sorted; a name occurs twice if two nodes have it.
    """

    topic: str
    drivers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ClockSeen:
    """The observed messages of ``/clock``.

    Attributes:
        ticks: the number of messages.
        first_ns: the time in the first message, in nanoseconds.
        last_ns: the time in the last message, in nanoseconds.
    """

    ticks: int
    first_ns: int
    last_ns: int


@dataclass(frozen=True, slots=True)
class FixedFrame:
    """The fixed frame of a viewer.

    Attributes:
        name: the name of the frame.
        source: the file or node that sets it.
    """

    name: str
    source: str


@dataclass(frozen=True, slots=True)
class Observation:
    """All observations of a graph.

    Attributes:
        seconds: the duration of the observation.
        nodes: full names of the nodes; a name is repeated if several nodes have it.
        endpoints: publishers, subscriptions, services and clients.
        transforms: the transforms published.
        joints: the joint states published.
        descriptions: the robot descriptions published.
        stamps: the stamps of topics whose messages have a header.
        frames: the frames of messages, for topics whose messages have a header.
        disputed: topics with several drivers at the same time.
        clock: the observations of ``/clock``; None if it has no messages.
        sim_time: ``use_sim_time`` of the nodes that responded, by full name.
        lifecycle: states of the managed nodes, by full name.
        fixed_frames: the Fixed Frames of viewers.
        environment: the environment variables that affect discovery.
        over_zenoh: whether the graph was observed over Zenoh, where QoS does not keep endpoints apart, and not over
            DDS.
    """

    seconds: float = 0.0
    nodes: tuple[str, ...] = ()
    endpoints: tuple[EndpointInfo, ...] = ()
    transforms: tuple[TransformSeen, ...] = ()
    joints: tuple[JointSeen, ...] = ()
    descriptions: tuple[DescriptionSeen, ...] = ()
    stamps: tuple[StampSeen, ...] = ()
    frames: tuple[FrameSeen, ...] = ()
    disputed: tuple[DriversSeen, ...] = ()
    clock: ClockSeen | None = None
    sim_time: Mapping[str, bool] = field(default_factory=dict)
    lifecycle: Mapping[str, str] = field(default_factory=dict)
    fixed_frames: tuple[FixedFrame, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict)
    over_zenoh: bool = False

    def of_kind(self, kind: EndpointKind) -> list[EndpointInfo]:
        """Return the endpoints of a kind."""
        return [endpoint for endpoint in self.endpoints if endpoint.kind is kind]

    def publishers_of(self, topic: str) -> list[EndpointInfo]:
        """Return the publishers of a topic."""
        return [endpoint for endpoint in self.of_kind(EndpointKind.PUBLISHER) if endpoint.name == topic]


def node_of(endpoint: EndpointInfo) -> str:
    """Return the full name of the node to which an endpoint belongs."""
    return UNKNOWN_NODE if endpoint.node is None else join(endpoint.node.namespace, endpoint.node.name)


def nodes_of(endpoints: Iterable[EndpointInfo]) -> list[str]:
    """Return the sorted full names of the nodes to which endpoints belong.

    Each name occurs only once.
    """
    return sorted({node_of(endpoint) for endpoint in endpoints})


def listed(names: Iterable[str], limit: int = 6) -> Phrase:
    """Return names in quotes, separated by commas.

    If there are more than `limit`, the result has the first ones, and the number of the rest.
    """
    every = list(names)
    shown = quoted_names(every[:limit])
    return phrase("{names} and {more} more", names=shown, more=len(every) - limit) if len(every) > limit else shown
