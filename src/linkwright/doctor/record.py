"""The observation of a running graph, as plain data for the examinations."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from linkwright.diagnostics import Phrase, joined_first, quoted
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import join

TWIST, TWIST_STAMPED = "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"
UNKNOWN_NODE = "an unknown node"
"""The name of a publishing node that discovery does not report."""


@dataclass(frozen=True, slots=True)
class ObservedTransform:
    """The transforms that were observed from a frame to one of its parents.

    Attributes:
        parent: the parent frame.
        child: the child frame.
        senders: the sorted full names of the nodes that published the transform.
        is_static: whether the transform was published as a static transform.
        is_valid: whether all numbers are finite, and the quaternion is not zero.
    """

    parent: str
    child: str
    senders: tuple[str, ...]
    is_static: bool = False
    is_valid: bool = True


@dataclass(frozen=True, slots=True)
class ObservedJoint:
    """The states of a joint that were observed.

    Attributes:
        name: the name of the joint.
        senders: the sorted full names of the nodes that published the states.
        topics: the sorted names of the topics on which the states were published.
    """

    name: str
    senders: tuple[str, ...]
    topics: tuple[str, ...] = ("/joint_states",)


@dataclass(frozen=True, slots=True)
class ObservedDescription:
    """A robot description that was observed.

    Attributes:
        topic: the topic on which the description was published.
        sender: the full name of the node that published the description.
        text: the text of the description.
    """

    topic: str
    sender: str
    text: str


@dataclass(frozen=True, slots=True)
class ObservedStamp:
    """The observed stamps of a node's messages on a topic.

    Attributes:
        topic: the name of the topic.
        sender: the full name of the publishing node.
        age_ns: the clock at arrival minus the last stamp, in nanoseconds; negative if the stamp was in the future.
        is_zero: whether the stamp was 0, so that it was probably never set.
    """

    topic: str
    sender: str
    age_ns: int
    is_zero: bool = False


@dataclass(frozen=True, slots=True)
class ObservedFrame:
    """The frame that was observed in a node's messages on a topic.

    Attributes:
        topic: the topic on which the messages were published.
        sender: the full name of the node that published the messages.
        frame: the frame in the last message.
    """

    topic: str
    sender: str
    frame: str


@dataclass(frozen=True, slots=True)
class ObservedCommanders:
    """The nodes that published contradictory velocities on a topic at the same time.

    Attributes:
        topic: the topic of the velocities, with the type Twist or TwistStamped.
        commanders: the sorted full names of the nodes; a name occurs twice if two nodes share it.
    """

    topic: str
    commanders: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ObservedClock:
    """The messages of ``/clock`` that were observed.

    Attributes:
        message_count: the number of messages.
        first_ns: the time in the first message, in nanoseconds.
        last_ns: the time in the last message, in nanoseconds.
    """

    message_count: int
    first_ns: int
    last_ns: int


@dataclass(frozen=True, slots=True)
class FixedFrame:
    """The Fixed Frame of a viewer.

    Attributes:
        name: the name of the frame.
        source: the configuration file or node that sets the frame.
    """

    name: str
    source: str


@dataclass(frozen=True, slots=True)
class Observation:
    """The observations of a graph.

    Attributes:
        seconds: the duration of the observation in seconds.
        nodes: the full names of the nodes; a name that several nodes share occurs several times.
        endpoints: the publishers, subscriptions, services and clients.
        transforms: the published transforms.
        joints: the published joint states.
        descriptions: the published robot descriptions.
        stamps: the stamps of messages with a header.
        frames: the frames of messages with a header.
        contradictory_velocities: the topics on which several nodes published contradictory velocities.
        clock: the messages of ``/clock``; None if there were none.
        sim_time: the values of ``use_sim_time`` by the full names of the nodes that responded.
        lifecycle: the states of the managed nodes, by full name.
        fixed_frames: the Fixed Frames of viewers and configuration files.
        environment: the environment variables that affect discovery.
        over_zenoh: whether the graph was observed over Zenoh instead of DDS. Over Zenoh, endpoints match regardless of
            their QoS.
    """

    seconds: float = 0.0
    nodes: tuple[str, ...] = ()
    endpoints: tuple[EndpointInfo, ...] = ()
    transforms: tuple[ObservedTransform, ...] = ()
    joints: tuple[ObservedJoint, ...] = ()
    descriptions: tuple[ObservedDescription, ...] = ()
    stamps: tuple[ObservedStamp, ...] = ()
    frames: tuple[ObservedFrame, ...] = ()
    contradictory_velocities: tuple[ObservedCommanders, ...] = ()
    clock: ObservedClock | None = None
    sim_time: Mapping[str, bool] = field(default_factory=dict)
    lifecycle: Mapping[str, str] = field(default_factory=dict)
    fixed_frames: tuple[FixedFrame, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict)
    over_zenoh: bool = False

    def endpoints_of_kind(self, kind: EndpointKind) -> list[EndpointInfo]:
        """Return the endpoints of the given kind."""
        return [endpoint for endpoint in self.endpoints if endpoint.kind is kind]

    def find_publishers(self, topic: str) -> list[EndpointInfo]:
        """Return the publishers of a topic that were observed."""
        return [endpoint for endpoint in self.endpoints_of_kind(EndpointKind.PUBLISHER) if endpoint.name == topic]


def get_node_name(endpoint: EndpointInfo) -> str:
    """Return the full name of an endpoint's node."""
    return UNKNOWN_NODE if endpoint.node is None else join(endpoint.node.namespace, endpoint.node.name)


def list_node_names(endpoints: Iterable[EndpointInfo]) -> list[str]:
    """Return the sorted full names of the nodes of endpoints, without duplicates."""
    return sorted({get_node_name(endpoint) for endpoint in endpoints})


def format_names(names: Iterable[str], limit: int = 6) -> Phrase:
    """Return the names in quotation marks, separated by commas.

    If there are more than `limit` names, only the first ones are listed, with the number of the remaining ones.
    """
    return joined_first(map(quoted, names), limit)
