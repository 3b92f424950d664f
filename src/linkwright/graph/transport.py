"""What carries the graph's traffic out of the process and in: the contract between the bus and the wire.

In the process a message is handed over as an object. A transport mirrors the endpoints of the process on a network; it
is called only for what somebody outside listens to.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from enum import Enum
from typing import TYPE_CHECKING, Any, Protocol

if TYPE_CHECKING:
    from linkwright.graph.client import Client
    from linkwright.graph.publisher import Publisher
    from linkwright.graph.qos import QoSProfile
    from linkwright.graph.service import Service
    from linkwright.graph.subscription import Subscription


class EndpointKind(Enum):
    """What an endpoint of the graph is."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVICE = "service"
    CLIENT = "client"


@dataclass(frozen=True, slots=True)
class NodeIdentity:
    """A node's name in the graph.

    Attributes:
        name: without namespace.
        namespace: absolute.
        enclave: the security enclave, ``/`` where there is none.
    """

    name: str
    namespace: str
    enclave: str = "/"


@dataclass(frozen=True, slots=True)
class EndpointInfo:
    """One publisher, subscription, service or client, of this process or of another.

    Attributes:
        kind: which of the four.
        node: whose it is; None while discovery has not told yet.
        name: the topic's or service's absolute ROS name.
        type_name: such as ``sensor_msgs/msg/JointState``.
        qos: what is offered or asked for.
        gid: the endpoint's identity, 16 bytes.
        type_hash: ``RIHS01_...``; empty where it is not known (Humble does not send it).
        local: whether it belongs to this process.
    """

    kind: EndpointKind
    node: NodeIdentity | None
    name: str
    type_name: str
    qos: QoSProfile
    gid: bytes
    type_hash: str = ""
    local: bool = False


@dataclass(slots=True)
class MessageInfo(Mapping[str, Any]):
    """What is known of a message beside its content; its values are found as attributes and, as in rclpy, by name.

    Attributes:
        source_timestamp: when it was published, nanoseconds since the epoch.
        received_timestamp: when it was received, nanoseconds since the epoch.
        publisher_gid: who sent it, 16 bytes.
        from_outside: whether it came from another process.
        publication_sequence_number: its number among the publisher's, where the sender tells.
        reception_sequence_number: its number among those received, where it is counted.
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


class OutsideService(Protocol):
    """A server outside of the process, as a client of it sees it."""

    def send(self, request: Any, answer: Callable[[Any], None], number: int) -> Callable[[], None]:
        """Ask it.

        Args:
            request: the request.
            answer: called with the response, from any thread, at most once.
            number: of the request, another one for each of a client's.

        Returns:
            What forgets the request.
        """


class Transport(Protocol):
    """Mirrors the endpoints of one graph outside of the process.

    ``open_*`` is called for each endpoint when it is made, ``close_*`` when it is destroyed; neither may block. What
    comes in is given to ``Subscription.receive(message, info)`` and ``Service.receive(request, reply, request_id)``,
    from any thread. What goes out is asked for with ``Publisher.set_outside`` and ``Client.set_outside`` while somebody
    outside matches, and no longer when nobody does; a transient local publisher's is set from the start, so that who
    comes late is served. How many match is told with ``set_outside_count``.
    """

    def open_node(self, node: NodeIdentity) -> None:
        """Make a node known."""

    def close_node(self, node: NodeIdentity) -> None:
        """Take a node back."""

    def open_publisher(self, publisher: Publisher[Any]) -> None:
        """Mirror a publisher."""

    def close_publisher(self, publisher: Publisher[Any]) -> None:
        """Take a publisher back once what it sent reliably has been acknowledged, or nobody is there to do so."""

    def open_subscription(self, subscription: Subscription[Any]) -> None:
        """Mirror a subscription."""

    def close_subscription(self, subscription: Subscription[Any]) -> None:
        """Take a subscription back."""

    def open_service(self, service: Service[Any, Any]) -> None:
        """Mirror a service."""

    def close_service(self, service: Service[Any, Any]) -> None:
        """Take a service back."""

    def open_client(self, client: Client[Any, Any]) -> None:
        """Mirror a client."""

    def close_client(self, client: Client[Any, Any]) -> None:
        """Take a client back."""

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        """The nodes of other processes, as far as discovery has come."""

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """The endpoints of other processes, as far as discovery has come.

        Actions are the services and topics they are made of.
        """

    def watch(self, changed: Callable[[], None]) -> None:
        """Have something called, from any thread, whenever nodes or endpoints outside come or go."""

    def close(self) -> None:
        """Leave the network; nothing of the transport (no thread, no socket) outlives this."""
