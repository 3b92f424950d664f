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
    """The transforms of one frame to one parent.

    Attributes:
        parent: the parent frame.
        child: the frame.
        senders: full names of the nodes that published it, sorted.
        static: whether it came on a topic of static transforms.
        valid: whether all its numbers are finite and its rotation is one.
    """

    parent: str
    child: str
    senders: tuple[str, ...]
    static: bool = False
    valid: bool = True


@dataclass(frozen=True, slots=True)
class JointSeen:
    """The states of one joint.

    Attributes:
        name: of the joint.
        senders: full names of the nodes that published it, sorted.
        topics: where it came, sorted.
    """

    name: str
    senders: tuple[str, ...]
    topics: tuple[str, ...] = ("/joint_states",)


@dataclass(frozen=True, slots=True)
class DescriptionSeen:
    """A robot description.

    Attributes:
        topic: where it came.
        sender: full name of the node that published it.
        text: the URDF.
    """

    topic: str
    sender: str
    text: str


@dataclass(frozen=True, slots=True)
class StampSeen:
    """The stamps of one node on one topic.

    Attributes:
        topic: the topic.
        sender: the full name of the publishing node.
        behind_ns: how far the last stamp was behind the clock on arrival; negative when ahead.
        zero: whether the stamp was 0, that is, never set.
    """

    topic: str
    sender: str
    behind_ns: int
    zero: bool = False


@dataclass(frozen=True, slots=True)
class FrameSeen:
    """A frame of the messages of one node on one topic.

    Attributes:
        topic: where they came.
        sender: full name of the node that published them.
        frame: its name, as the last message had it.
    """

    topic: str
    sender: str
    frame: str


@dataclass(frozen=True, slots=True)
class DriversSeen:
    """Nodes that sent contradicting velocities at the same time on one topic.

    Attributes:
        topic: where they came, as Twist or TwistStamped.
        drivers: full names of the nodes that published them, sorted; one twice where two nodes have it.
    """

    topic: str
    drivers: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ClockSeen:
    """The messages of ``/clock``.

    Attributes:
        ticks: how many times.
        first_ns: the first time.
        last_ns: the last time.
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
        seconds: the duration.
        nodes: full names, each as often as there are nodes with it.
        endpoints: publishers, subscriptions, services and clients.
        transforms: the transforms published.
        joints: the joint states published.
        descriptions: the robot descriptions published.
        stamps: the stamps of topics whose messages have a header.
        frames: the frames of messages, for topics whose messages have a header.
        disputed: topics with several drivers at once.
        clock: the observations of ``/clock``; None if it has no messages.
        sim_time: ``use_sim_time`` of the nodes that answered, by full name.
        lifecycle: states of the managed nodes, by full name.
        fixed_frames: the Fixed Frames of viewers.
        environment: the environment variables that decide about discovery.
        over_zenoh: whether the graph was observed over Zenoh, where no QoS keeps endpoints apart, and not over DDS.
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
        """The endpoints of a kind."""
        return [endpoint for endpoint in self.endpoints if endpoint.kind is kind]

    def publishers_of(self, topic: str) -> list[EndpointInfo]:
        """The publishers of a topic."""
        return [endpoint for endpoint in self.of_kind(EndpointKind.PUBLISHER) if endpoint.name == topic]


def node_of(endpoint: EndpointInfo) -> str:
    """The full name of the node that an endpoint belongs to."""
    return UNKNOWN_NODE if endpoint.node is None else join(endpoint.node.namespace, endpoint.node.name)


def nodes_of(endpoints: Iterable[EndpointInfo]) -> list[str]:
    """The full names of the nodes that endpoints belong to, each once, sorted."""
    return sorted({node_of(endpoint) for endpoint in endpoints})


def listed(names: Iterable[str], limit: int = 6) -> Phrase:
    """Return names in quotes, separated by commas; of many the first ones, and the number of the others."""
    every = list(names)
    shown = quoted_names(every[:limit])
    return phrase("{names} and {more} more", names=shown, more=len(every) - limit) if len(every) > limit else shown
