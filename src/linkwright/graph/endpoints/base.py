"""The base classes and the descriptions of publishers, subscriptions, services and clients.

Message and service classes are checked as in rclpy's ``type_support``, with the same errors.
"""

from __future__ import annotations

import itertools
import os
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from enum import Enum
from typing import Any, Generic, Protocol, TypeVar

from linkwright.graph.loop.node_handle import CallbackGroup, NodeHandle, Part
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.compatibility import resolve_defaults
from linkwright.graph.qos.profile import QoSProfile


class EndpointKind(Enum):
    """The kinds of endpoints."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    CLIENT = "client"


@dataclass(frozen=True, slots=True)
class EndpointInfo:
    """The description of a publisher, subscription, service or client of any process.

    Attributes:
        kind: publisher, subscription, service or client.
        node: the node that owns the endpoint; None until discovery has found the node.
        name: the topic's or service's absolute ROS name.
        type_name: such as ``sensor_msgs/msg/JointState``.
        qos: the offered or requested QoS.
        gid: the endpoint's globally unique identifier, 16 bytes.
        type_hash: ``RIHS01_...``; empty if it is not known (Humble does not send it).
        local: whether the endpoint belongs to this process.
        host: the machine that the endpoint runs on; empty if it is not known.
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
    """The metadata of a message (rmw ``rmw_message_info_t``).

    The values can be read as attributes and, as in rclpy, as items.

    Attributes:
        source_timestamp: when the message was published, in nanoseconds since the epoch.
        received_timestamp: when the message was received, in nanoseconds since the epoch.
        publisher_gid: the GID of the publisher, 16 bytes.
        is_remote: whether another process sent the message.
        publication_sequence_number: the publisher's count of messages; None if the publisher does not send it.
        reception_sequence_number: the subscription's count of messages; None if the subscription does not count.
    """

    source_timestamp: int
    received_timestamp: int
    publisher_gid: bytes = bytes(16)
    is_remote: bool = False
    publication_sequence_number: int | None = None
    reception_sequence_number: int | None = None

    def __getitem__(self, name: str) -> Any:
        if name not in _INFO_FIELD_NAMES:
            raise KeyError(name)
        return getattr(self, name)

    def __iter__(self) -> Iterator[str]:
        return iter(_INFO_FIELD_NAMES)

    def __len__(self) -> int:
        return len(_INFO_FIELD_NAMES)


_INFO_FIELD_NAMES = tuple(field.name for field in fields(MessageInfo))


MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")


def check_for_type_support(interface: Any) -> None:
    """Check that an object is an interface class (rclpy ``check_for_type_support``).

    Raises:
        AttributeError: the object is not an interface class.
    """
    if isinstance(getattr(interface, "TYPE_NAME", None), str):
        return
    module = sys.modules.get(getattr(interface, "__module__", ""))
    module_file = getattr(module, "__file__", None)
    origin = f", from {module_file}," if module_file else ""
    raise AttributeError(
        f"{interface!r}{origin} is not an interface class that this rclpy can use. This might be a ROS 1 message type, "
        "or a type built for a real ROS 2, which does not work with Linkwright's rclpy"
    )


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Check that an object is a message class.

    Raises:
        AttributeError: the object is not an interface class.
        RuntimeError: the object is a service or action class.
    """
    check_for_type_support(msg_type)
    if "/msg/" not in msg_type.TYPE_NAME and hasattr(msg_type, "Request"):
        raise RuntimeError("The message type provided is not valid, this might be a service or action")


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Check that an object is a service class.

    Raises:
        AttributeError: the object is not an interface class.
        RuntimeError: the object is a message or action class.
    """
    check_for_type_support(srv_type)
    if not (hasattr(srv_type, "Request") and hasattr(srv_type, "Response")):
        raise RuntimeError("The service type provided is not valid, this might be a message or action")


M = TypeVar("M")

_GID_PREFIX = os.urandom(10)
_gid_numbers = itertools.count(1)


class Endpoint(Part):
    """A publisher, subscription, service or client of this process.

    Attributes:
        name: the absolute name of the topic or service.
        type_name: such as ``sensor_msgs/msg/JointState``.
        qos_profile: the offered or requested QoS.
        type_hash: the type's hash (``RIHS01_...``) as other nodes announce it; empty if no node announces one. It takes
            precedence over the hash of the local definition.
        is_listed: whether other processes see the endpoint in the graph. A transport that cannot hide endpoints ignores
            this.
        raw: whether payloads are bytes (CDR with its header), in which case the type need not be known here.
    """

    kind: EndpointKind
    type_hash = ""
    is_listed = True
    raw = False
    _check_interface: Callable[[Any], None]
    """A function that raises an error for an interface class that the endpoint cannot carry."""

    def _describe(self, node: NodeHandle, interface: Any, name: str, qos_profile: QoSProfile) -> None:
        self.node = node
        self.name = name
        if not isinstance(interface, str):
            self._check_interface(interface)
        self.type_name: str = interface if isinstance(interface, str) else interface.TYPE_NAME
        self.qos_profile = qos_profile
        self._interface: Any = None if isinstance(interface, str) else interface
        self._gid = b""

    @property
    def interface(self) -> Any:
        """The message or service class, created on first access."""
        if self._interface is None:
            from linkwright.messages import get_interface

            self._interface = get_interface(self.type_name)
        return self._interface

    @property
    def gid(self) -> bytes:
        """The endpoint's GID (globally unique identifier), 16 bytes.

        A transport sets this to the GID of its own reader or writer.
        """
        if not self._gid:
            self._gid = _GID_PREFIX + next(_gid_numbers).to_bytes(6, "big")
        return self._gid

    @gid.setter
    def gid(self, gid: bytes) -> None:
        self._gid = gid

    @property
    def node_name(self) -> str:
        """The full name of the node that owns the endpoint."""
        return self.node.identity.full_name

    @property
    def logger_name(self) -> str:
        """The logger name of the node that owns the endpoint."""
        return self.node.logger.name

    def info(self) -> EndpointInfo:
        """Return the endpoint's description for graph queries."""
        return EndpointInfo(
            self.kind,
            self.node.identity,
            self.name,
            self.type_name,
            resolve_defaults(self.qos_profile),
            self.gid,
            local=True,
        )

    def begin(self) -> None:
        """Add the endpoint to the graph, and connect it to matching endpoints."""
        super().begin()
        self.node.graph.add(self)

    def retire(self) -> None:
        """Remove the endpoint from the graph."""
        self.node.graph.remove(self)
        super().retire()


class MatchListener(Protocol):
    """A listener that is notified when endpoints match, and when they no longer match."""

    def on_match_change(self, change: int) -> None:
        """Handle a change in the number of matching endpoints.

        Args:
            change: how many endpoints were added; negative if endpoints left.
        """


class TopicEndpoint(Endpoint, Generic[M]):
    """A publisher or a subscription.

    Attributes:
        callback_group: the group that decides which other callbacks may run at the same time.
        events: the endpoint's QoS events; None if there is no callback for them.
        is_alive: for a publisher, whether its liveliness has not been lost.
    """

    callback_group: CallbackGroup
    is_alive = True
    events: MatchListener | None
    _check_interface = staticmethod(check_is_valid_msg_type)
    _remote_count = 0

    @property
    def topic_name(self) -> str:
        """The topic's absolute name."""
        return self.name

    @property
    def topic(self) -> str:
        """The topic's absolute name."""
        return self.name

    @property
    def msg_type(self) -> type[M]:
        """The message class."""
        return self.interface  # type: ignore[no-any-return]  # made from the name of a type

    def set_remote_count(self, count: int) -> None:
        """Set the number of matching endpoints in other processes, and report a change.

        The transport calls this method. A change causes a QoS event. The first match and the end of the last one wake
        those that wait for a change of the graph, because discovery may report an endpoint before it matches.
        """
        previous_count, self._remote_count = self._remote_count, count
        if self.events is not None and count != previous_count:
            self.events.on_match_change(count - previous_count)
        if bool(count) != bool(previous_count):
            self.node.graph.notify_change()


class ServiceEndpoint(Endpoint):
    """A client or a service."""

    _check_interface = staticmethod(check_is_valid_srv_type)

    @property
    def srv_name(self) -> str:
        """The service's absolute name."""
        return self.name

    @property
    def service_name(self) -> str:
        """The service's absolute name."""
        return self.name

    @property
    def srv_type(self) -> Any:
        """The class of the service."""
        return self.interface

    def check_message(self, message: Any, message_kind: str) -> None:
        """Check that a request or a response can be sent.

        Args:
            message: the request or response.
            message_kind: ``Request`` or ``Response``.

        Raises:
            TypeError: the message is not of the service's type, or the endpoint is raw and the message is not bytes.
        """
        expected_type = bytes if self.raw else getattr(self.srv_type, message_kind)
        if not isinstance(message, expected_type):
            raise TypeError(
                f"Expected {expected_type}, got {type(message)}: the {message_kind.lower()} of '{self.name}'"
            )


class Presence(Endpoint):
    """A subscription or client that only announces itself to other processes.

    A presence receives no messages and sends no requests. A bridge uses it to represent a subscription or client of
    another network, to which the bridge forwards messages and responses.

    Args:
        node: the node that owns the presence.
        info: the description of a subscription or a client.

    Raises:
        ValueError: `info` describes an endpoint of another kind.
    """

    raw = True

    def __init__(self, node: NodeHandle, info: EndpointInfo) -> None:
        if info.kind not in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT):
            raise ValueError(f"a presence represents a subscription or a client, not a {info.kind.value}")
        self.kind = info.kind
        self._describe(node, info.type_name, info.name, info.qos)
        self.type_hash = info.type_hash
