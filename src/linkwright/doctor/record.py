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
        senders: the sorted full names of the nodes that published the transform.
        static: whether the transform was published on a topic of static transforms.
        valid: whether all numbers are finite and the quaternion is not zero.
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
        senders: the sorted full names of the nodes that published the states.
        topics: the sorted names of the topics on which the states were published.
    """

    name: str
    senders: tuple[str, ...]
    topics: tuple[str, ...] = ("/joint_states",)


@dataclass(frozen=True, slots=True)
class DescriptionSeen:
    """An observed robot description.

    Attributes:
        topic: the topic on which the description was published.
        sender: the full name of the node that published the description.
        text: the URDF.
    """

    topic: str
    sender: str
    text: str


@dataclass(frozen=True, slots=True)
class StampSeen:
    """The observed stamps of a node on a topic.

    Attributes:
        topic: the name of the topic.
        sender: the full name of the publishing node.
        behind_ns: the difference between the clock on arrival and the last stamp, in nanoseconds; negative if the stamp
            was in the future.
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
        sender: the full name of the node that published the messages.
        frame: the frame in the last message.
    """

    topic: str
    sender: str
    frame: str


@dataclass(frozen=True, slots=True)
class DriversSeen:
    """Nodes that sent contradictory velocities on one topic at the same time.

    Attributes:
        topic: the topic on which the velocities were published, as Twist or TwistStamped.
        drivers: the sorted full names of the publishing nodes; a name occurs twice if two nodes have it.
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
        nodes: the full names of the nodes; a name that several nodes share is repeated.
        endpoints: the publishers, subscriptions, services and clients.
        transforms: the published transforms.
        joints: the published joint states.
        descriptions: the published robot descriptions.
        stamps: the stamps of messages with a header.
        frames: the frames of messages with a header.
        disputed: the topics on which several nodes sent contradictory velocities.
        clock: the observation of ``/clock``; None if no message was received.
        sim_time: the value of ``use_sim_time`` of each node that responded, by full name.
        lifecycle: the states of the managed nodes, by full name.
        fixed_frames: the Fixed Frames of viewers.
        environment: the environment variables that affect discovery.
        over_zenoh: whether the graph was observed over Zenoh, where QoS does not separate endpoints, instead of DDS.
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
        """Return the observed publishers of a topic."""
        return [endpoint for endpoint in self.of_kind(EndpointKind.PUBLISHER) if endpoint.name == topic]


def node_of(endpoint: EndpointInfo) -> str:
    """Return the full name of the node to which an endpoint belongs."""
    return UNKNOWN_NODE if endpoint.node is None else join(endpoint.node.namespace, endpoint.node.name)


def nodes_of(endpoints: Iterable[EndpointInfo]) -> list[str]:
    """Return the sorted full names of the nodes to which endpoints belong, without duplicates."""
    return sorted({node_of(endpoint) for endpoint in endpoints})


def listed(names: Iterable[str], limit: int = 6) -> Phrase:
    """Return names in quotation marks, separated by commas.

    If there are more than `limit` names, the result contains the first ones and the number of the others.
    """
    every = list(names)
    shown = quoted_names(every[:limit])
    return phrase("{names} and {more} more", names=shown, more=len(every) - limit) if len(every) > limit else shown
