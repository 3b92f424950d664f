"""The answers of graph queries, in the types of rclpy."""

from __future__ import annotations

from collections.abc import Iterable
from copy import copy
from dataclasses import dataclass, field
from enum import IntEnum

from linkwright.graph.endpoints.info import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import UNKNOWN_QOS, HistoryPolicy, QoSProfile

NamesAndTypes = list[tuple[str, list[str]]]
"""Names, sorted, each with the names of the types in use for it, sorted."""

UNKNOWN_NODE = NodeIdentity("_NODE_NAME_UNKNOWN_", "_NODE_NAMESPACE_UNKNOWN_")
"""The owner of an endpoint that discovery has not named yet."""

_ACTION = "/_action/"
_FEEDBACK = "_FeedbackMessage"


class TopicEndpointTypeEnum(IntEnum):
    """The kinds of endpoints of a topic (rclpy)."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


@dataclass
class TopicEndpointInfo:
    """A publisher or subscription of a topic (rclpy ``TopicEndpointInfo``).

    Attributes:
        node_name: the name of its node.
        node_namespace: that node's namespace.
        topic_type: the name of the message type.
        topic_type_hash: ``RIHS01_...``; empty where it is not known.
        endpoint_type: its kind.
        endpoint_gid: its identity.
        qos_profile: the QoS that it offers or requests.
        host: the machine that it is on, which rclpy does not give; empty for this process, and where it is not known.
    """

    node_name: str = ""
    node_namespace: str = ""
    topic_type: str = ""
    topic_type_hash: str = ""
    endpoint_type: TopicEndpointTypeEnum = TopicEndpointTypeEnum.INVALID
    endpoint_gid: list[int] = field(default_factory=list)
    qos_profile: QoSProfile = field(default_factory=lambda: copy(UNKNOWN_QOS))
    host: str = field(default="", compare=False)

    def __str__(self) -> str:
        qos = self.qos_profile
        depth = f" ({qos.depth})" if qos.history is HistoryPolicy.KEEP_LAST else ""
        return "\n".join(
            (
                f"Node name: {self.node_name}",
                f"Node namespace: {self.node_namespace}",
                f"Topic type: {self.topic_type}",
                *([f"Topic type hash: {self.topic_type_hash}"] if self.topic_type_hash else []),
                f"Endpoint type: {self.endpoint_type.name}",
                f"GID: {'.'.join(f'{byte:02x}' for byte in self.endpoint_gid)}",
                "QoS profile:",
                f"  Reliability: {qos.reliability.name}",
                f"  History (Depth): {qos.history.name}{depth}",
                f"  Durability: {qos.durability.name}",
                f"  Lifespan: {qos.lifespan}",
                f"  Deadline: {qos.deadline}",
                f"  Liveliness: {qos.liveliness.name}",
                f"  Liveliness lease duration: {qos.liveliness_lease_duration}",
            )
        )

    @classmethod
    def of(cls, info: EndpointInfo) -> TopicEndpointInfo:
        """The form for tools."""
        node = info.node or UNKNOWN_NODE
        kind = (
            TopicEndpointTypeEnum.PUBLISHER
            if info.kind is EndpointKind.PUBLISHER
            else TopicEndpointTypeEnum.SUBSCRIPTION
        )
        return cls(node.name, node.namespace, info.type_name, info.type_hash, kind, list(info.gid), info.qos, info.host)


def names_and_types(endpoints: Iterable[EndpointInfo], *kinds: EndpointKind) -> NamesAndTypes:
    """The names and types of endpoints of some kinds."""
    types: dict[str, set[str]] = {}
    for endpoint in endpoints:
        if endpoint.kind in kinds:
            types.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return [(name, sorted(types[name])) for name in sorted(types)]


def action_names_and_types(endpoints: Iterable[EndpointInfo], *kinds: EndpointKind) -> NamesAndTypes:
    """The names and types of the actions whose feedback topic is among endpoints of some kinds, as rcl_action gives.

    A server publishes feedback, a client subscribes to it.
    """
    types: dict[str, set[str]] = {}
    for endpoint in endpoints:
        action, _, part = endpoint.name.rpartition(_ACTION)
        if part == "feedback" and endpoint.kind in kinds:
            types.setdefault(action, set()).add(endpoint.type_name.removesuffix(_FEEDBACK))
    return [(name, sorted(types[name])) for name in sorted(types)]
