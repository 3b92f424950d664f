"""Descriptions of endpoints, and metadata of messages, of this process and of others."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from enum import Enum
from typing import Any

from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import QoSProfile


class EndpointKind(Enum):
    """The kinds of endpoints."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    CLIENT = "client"


@dataclass(frozen=True, slots=True)
class EndpointInfo:
    """One publisher, subscription, service or client, of this process or of another.

    Attributes:
        kind: publisher, subscription, service or client.
        node: the node it belongs to; None until discovery has found out.
        name: the topic's or service's absolute ROS name.
        type_name: such as ``sensor_msgs/msg/JointState``.
        qos: the QoS that it offers or requests.
        gid: its globally unique identifier, 16 bytes.
        type_hash: ``RIHS01_...``; empty where it is not known (Humble does not send it).
        local: whether it belongs to this process.
        host: the machine that it is on; empty where it is not known.
    """

    kind: EndpointKind
    node: NodeIdentity | None
    name: str
    type_name: str
    qos: QoSProfile
    gid: bytes
    type_hash: str = ""
    local: bool = False
    host: str = ""


@dataclass(slots=True)
class MessageInfo(Mapping[str, Any]):
    """The metadata of a message (rmw ``rmw_message_info_t``); values are attributes and, as in rclpy, items.

    Attributes:
        source_timestamp: when it was published, nanoseconds since the epoch.
        received_timestamp: when it was received, nanoseconds since the epoch.
        publisher_gid: the GID of the publisher, 16 bytes.
        from_outside: whether it comes from another process.
        publication_sequence_number: counted by the publisher; None where it does not send it.
        reception_sequence_number: counted by the subscription; None where it does not count.
    """

    source_timestamp: int
    received_timestamp: int
    publisher_gid: bytes = bytes(16)
    from_outside: bool = False
    publication_sequence_number: int | None = None
    reception_sequence_number: int | None = None

    def __getitem__(self, name: str) -> Any:
        if name not in _INFO_NAMES:
            raise KeyError(name)
        return getattr(self, name)

    def __iter__(self) -> Iterator[str]:
        return iter(_INFO_NAMES)

    def __len__(self) -> int:
        return len(_INFO_NAMES)


_INFO_NAMES = tuple(field.name for field in fields(MessageInfo))
