"""What publishers, subscriptions, services and clients have in common: a name, a type, a quality of service."""

from __future__ import annotations

import itertools
import os
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from linkwright.graph.handle import Handled
from linkwright.graph.qos_compatibility import resolved
from linkwright.graph.transport import EndpointInfo, EndpointKind

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph.endpoint_events import EndpointEvents
    from linkwright.graph.node import Node
    from linkwright.graph.qos import QoSProfile

M = TypeVar("M")

_GID_START = os.urandom(10)
_gid_numbers = itertools.count(1)


def type_name_of(interface: type | str) -> str:
    """The name of an interface, of a class or as it is: ``sensor_msgs/msg/JointState``.

    Raises:
        TypeError: the class is none of a message, service or action.
    """
    if isinstance(interface, str):
        return interface
    name = getattr(interface, "TYPE_NAME", None)
    if not isinstance(name, str):
        raise TypeError(f"{interface!r} is not the class of a message, a service or an action")
    return name


class Endpoint(Handled):
    """One side of a topic or a service; at the end of a ``with`` block it is destroyed.

    Attributes:
        node: whose it is.
        name: the absolute name of the topic or service.
        type_name: such as ``sensor_msgs/msg/JointState``.
        qos_profile: what is offered or asked for.
    """

    kind: EndpointKind

    def _describe(self, node: Node, interface: type | str, name: str, qos_profile: QoSProfile) -> None:
        self.node = node
        self.name = name
        self.type_name = type_name_of(interface)
        self.qos_profile = qos_profile
        self._interface: Any = None if isinstance(interface, str) else interface
        self._gid = b""

    @property
    def interface(self) -> Any:
        """The class of the type; made when it is first asked for."""
        if self._interface is None:
            from linkwright.messages import get_interface

            self._interface = get_interface(self.type_name)
        return self._interface

    @property
    def gid(self) -> bytes:
        """The endpoint's identity, 16 bytes; a transport may set it before it is asked for."""
        if not self._gid:
            self._gid = _GID_START + next(_gid_numbers).to_bytes(6, "big")
        return self._gid

    @gid.setter
    def gid(self, gid: bytes) -> None:
        self._gid = gid

    @property
    def node_name(self) -> str:
        """The full name of the node it belongs to."""
        return self.node.get_fully_qualified_name()

    @property
    def logger_name(self) -> str:
        """The name of the logger of the node it belongs to."""
        return self.node.get_logger().name

    def info(self) -> EndpointInfo:
        """What tools are told of it."""
        return EndpointInfo(
            self.kind, self.node.identity, self.name, self.type_name, resolved(self.qos_profile), self.gid, local=True
        )

    @abstractmethod
    def destroy(self) -> None:
        """Leave the graph and the node."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy()


class TopicEndpoint(Endpoint, Generic[M]):
    """A publisher or a subscription.

    Attributes:
        events: what is told of quality of service; None when its user wants to hear nothing.
    """

    events: EndpointEvents | None
    _outside_count = 0

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

    def set_outside_count(self, count: int) -> None:
        """For the transport: how many endpoints of the other side match outside of the process."""
        before, self._outside_count = self._outside_count, count
        if self.events is not None and count != before:
            self.events.matched(count - before)


class ServiceEndpoint(Endpoint):
    """A client or a service."""

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
