"""The bus that connects the endpoints of a process, and the interface of transports.

If the QoS of a publisher and a subscription is incompatible, the bus does not connect them, and notifies both nodes of
the reason.

Transports carry the traffic of a graph to other processes; inside the process a message is passed as an object. A
transport mirrors the endpoints of the process on a network. It is called only for topics and services that other
processes use. Transports are in the room `linkwright.wire`.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any, Generic, Protocol, TypeVar

from linkwright.graph.endpoints.base import Endpoint, EndpointInfo, Presence
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.names.rules import NodeIdentity, is_hidden
from linkwright.graph.qos.compatibility import find_incompatible_policies
from linkwright.graph.qos.profile import QoSPolicyKind, QoSProfile


class Transport(Protocol):
    """The interface of transports, which mirror the endpoints of a graph on a network.

    ``open_*`` is called for each endpoint when it is created, ``close_*`` when it is destroyed; neither may block.

    Incoming traffic is passed to ``Subscription.receive(message, info)`` and ``Service.receive(request, reply,
    request_id)``, from any thread. For outgoing traffic the transport calls ``Publisher.set_remote_sender`` and
    ``Client.set_remote_service`` when the first remote endpoint matches, and again when none matches any longer. For a
    transient local publisher it calls ``Publisher.set_remote_sender`` from the start, because late joiners must be
    served.

    The transport reports the number of matches with ``set_remote_count``, and the number of live publishers among them
    with ``Subscription.set_remote_liveliness``.
    """

    def open_node(self, node: NodeIdentity) -> None:
        """Announce a node."""

    def close_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""

    def open_publisher(self, publisher: Publisher[Any]) -> None:
        """Mirror a publisher."""

    def close_publisher(self, publisher: Publisher[Any]) -> None:
        """Stop mirroring a publisher once its reliable messages are acknowledged.

        If no reader is left to acknowledge the messages, mirroring also stops.
        """

    def open_subscription(self, subscription: Subscription[Any]) -> None:
        """Mirror a subscription."""

    def close_subscription(self, subscription: Subscription[Any]) -> None:
        """Stop mirroring a subscription."""

    def open_service(self, service: Service[Any, Any]) -> None:
        """Mirror a service."""

    def close_service(self, service: Service[Any, Any]) -> None:
        """Stop mirroring a service."""

    def open_client(self, client: Client[Any, Any]) -> None:
        """Mirror a client."""

    def close_client(self, client: Client[Any, Any]) -> None:
        """Stop mirroring a client."""

    def open_presence(self, presence: Presence) -> None:
        """Announce an endpoint that neither receives messages nor sends requests."""

    def close_presence(self, presence: Presence) -> None:
        """Withdraw an endpoint that was announced with `open_presence`."""

    def start_discovery(self) -> None:
        """Discover the nodes and endpoints of other processes.

        The graph calls this method before each query for remote nodes or endpoints. A transport need not start
        discovery earlier. The first call may block for a few seconds at most. After that call, discovery continues in
        the background.
        """

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        """Return the nodes of other processes that have been discovered so far.

        A node that has the same name as a node of this process is included.
        """

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """Return the endpoints of other processes that have been discovered so far.

        Actions are represented by the services and topics that they consist of.
        """

    def watch(self, callback: Callable[[], None]) -> None:
        """Register a callback for changes to remote nodes and endpoints.

        The transport may call `callback` from any thread.
        """

    def watch_lost(self, callback: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost publishers of other processes.

        The transport may call `callback` from any thread. A publisher is lost when its process was killed or crashed,
        or when the publisher has been silent for longer than its lease. This method is first called when a
        subscription requests such notifications (`Subscription.watch_lost`).
        """

    def close(self) -> None:
        """Leave the network, and close all threads and sockets of the transport."""


E = TypeVar("E", bound=Endpoint)


class _EndpointsByName(Generic[E]):
    """The endpoints of one kind by name.

    Endpoints that share a name are in order of creation.
    """

    def __init__(self) -> None:
        self._by_name: dict[str, dict[E, None]] = {}

    def add(self, endpoint: E) -> None:
        self._by_name.setdefault(endpoint.name, {})[endpoint] = None

    def remove(self, endpoint: E) -> bool:
        endpoints = self._by_name.get(endpoint.name, {})
        if endpoint not in endpoints:
            return False
        del endpoints[endpoint]
        if not endpoints:
            del self._by_name[endpoint.name]
        return True

    def find(self, name: str) -> tuple[E, ...]:
        return tuple(self._by_name.get(name, ()))

    def __iter__(self) -> Iterator[E]:
        return (endpoint for endpoints in tuple(self._by_name.values()) for endpoint in tuple(endpoints))


class Bus:
    """A registry of the endpoints of the process that connects matching endpoints.

    All methods may be called from any thread.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self._publishers: _EndpointsByName[Publisher[Any]] = _EndpointsByName()
        self._subscriptions: _EndpointsByName[Subscription[Any]] = _EndpointsByName()
        self._services: _EndpointsByName[Service[Any, Any]] = _EndpointsByName()
        self._clients: _EndpointsByName[Client[Any, Any]] = _EndpointsByName()

    def add(self, endpoint: Endpoint) -> None:
        """Connect a new endpoint to the matching endpoints with the same name."""
        with self._lock:
            if isinstance(endpoint, Publisher):
                self._publishers.add(endpoint)
                for subscription in self._subscriptions.find(endpoint.name):
                    self._connect(endpoint, subscription)
            elif isinstance(endpoint, Subscription):
                self._subscriptions.add(endpoint)
                for publisher in self._publishers.find(endpoint.name):
                    self._connect(publisher, endpoint)
            elif isinstance(endpoint, Service):
                self._services.add(endpoint)
                self._update_servers(endpoint.name)
            elif isinstance(endpoint, Client):
                self._clients.add(endpoint)
                self._update_servers(endpoint.name)

    def _connect(self, publisher: Publisher[Any], subscription: Subscription[Any]) -> None:
        """Connect a publisher and a subscription, or warn of different types or incompatible QoS."""
        if publisher.type_name == subscription.type_name or not self._is_mixed_on_purpose(publisher, subscription):
            connect_if_compatible(publisher, subscription)

    def _is_mixed_on_purpose(self, publisher: Publisher[Any], subscription: Subscription[Any]) -> bool:
        """Return whether a topic has two types because a node reads both, or because a bridge converts them.

        The gz side of a bridge is a hidden node. The bridge publishes the messages with the other type.
        """
        return (
            any(
                other_subscription.node is subscription.node and other_subscription.type_name == publisher.type_name
                for other_subscription in self._subscriptions.find(subscription.name)
            )
            or any(
                other_publisher.type_name == subscription.type_name
                for other_publisher in self._publishers.find(publisher.name)
            )
            or is_hidden(publisher.node_name)
            or is_hidden(subscription.node_name)
        )

    def remove(self, endpoint: Endpoint) -> None:
        """Remove an endpoint.

        Messages that a removed publisher has sent are still delivered; the queue of a removed subscription is dropped.
        """
        with self._lock:
            if isinstance(endpoint, Publisher):
                self._publishers.remove(endpoint)
            elif isinstance(endpoint, Subscription):
                self._subscriptions.remove(endpoint)
                for publisher in self._publishers.find(endpoint.name):
                    publisher.disconnect(endpoint)
            elif isinstance(endpoint, Service):
                self._services.remove(endpoint)
                self._update_servers(endpoint.name)
            elif isinstance(endpoint, Client):
                self._clients.remove(endpoint)

    def publishers(self, topic: str | None = None) -> tuple[Publisher[Any], ...]:
        """Return the publishers of a topic, or of all topics if `topic` is None."""
        with self._lock:
            return tuple(self._publishers) if topic is None else self._publishers.find(topic)

    def subscriptions(self, topic: str | None = None) -> tuple[Subscription[Any], ...]:
        """Return the subscriptions to a topic, or to all topics if `topic` is None."""
        with self._lock:
            return tuple(self._subscriptions) if topic is None else self._subscriptions.find(topic)

    def endpoints(self) -> tuple[Endpoint, ...]:
        """Return all endpoints."""
        with self._lock:
            return (*self._publishers, *self._subscriptions, *self._services, *self._clients)

    def _update_servers(self, name: str) -> None:
        servers = self._services.find(name)
        for client in self._clients.find(name):
            client.set_server(next((server for server in servers if server.type_name == client.type_name), None))


def connect_if_compatible(publisher: Publisher[Any], subscription: Subscription[Any]) -> None:
    """Connect a publisher and a subscription, or warn of different types or incompatible QoS."""
    if publisher.type_name != subscription.type_name:
        subscription.node.logger.warning(
            f"Topic '{publisher.name}' has different types: '{publisher.node_name}' publishes "
            f"{publisher.type_name}, '{subscription.node_name}' subscribes to "
            f"{subscription.type_name}. No messages will be received."
        )
        return
    offered, requested = publisher.qos_profile, subscription.qos_profile
    policies = find_incompatible_policies(offered, requested)
    if not policies:
        publisher.connect(subscription)
        return
    mismatch = describe_mismatch(publisher.node_name, offered, subscription.node_name, requested, policies)
    report_to_subscription(subscription, policies[-1].name, mismatch)
    report_to_publisher(publisher, policies[-1].name, mismatch)


def report_to_subscription(subscription: Subscription[Any], policy: str, mismatch: str) -> None:
    """Report incompatible QoS to a subscription that requests more than a publisher offers.

    The subscription's event callback receives the report; without such a callback, the report is logged.

    Args:
        subscription: the subscription.
        policy: the name of the incompatible policy.
        mismatch: the values that the two nodes offer and request; see `describe_mismatch`.
    """
    if subscription.events is not None and subscription.events.report_incompatible(policy):
        return
    subscription.node.logger.warning(
        f"New publisher discovered on topic '{subscription.name}', offering incompatible QoS. "
        f"No messages will be received from it. Last incompatible policy: {policy}_QOS_POLICY ({mismatch})"
    )


def report_to_publisher(publisher: Publisher[Any], policy: str, mismatch: str) -> None:
    """Report incompatible QoS to a publisher that offers less than a subscription requests.

    See `report_to_subscription`.
    """
    if publisher.events is not None and publisher.events.report_incompatible(policy):
        return
    publisher.node.logger.warning(
        f"New subscription discovered on topic '{publisher.name}', requesting incompatible QoS. "
        f"No messages will be sent to it. Last incompatible policy: {policy}_QOS_POLICY ({mismatch})"
    )


def describe_mismatch(
    publisher: str, offered: QoSProfile, subscription: str, requested: QoSProfile, policies: list[QoSPolicyKind]
) -> str:
    """Return a text with the offered and requested values of the incompatible policies."""
    return (
        f"'{publisher}' offers {_format_policies(offered, policies)}, '{subscription}' requests "
        f"{_format_policies(requested, policies)}"
    )


def _format_policies(qos: QoSProfile, policies: list[QoSPolicyKind]) -> str:
    return ", ".join(_format_policy(qos, policy) for policy in policies)


def _format_policy(qos: QoSProfile, policy: QoSPolicyKind) -> str:
    if policy is QoSPolicyKind.RELIABILITY:
        return _format_value_name(qos.reliability.name)
    if policy is QoSPolicyKind.DURABILITY:
        return _format_value_name(qos.durability.name)
    if policy is QoSPolicyKind.DEADLINE:
        return f"a deadline of {qos.deadline}"
    return f"{_format_value_name(qos.liveliness.name)} liveliness with a lease of {qos.liveliness_lease_duration}"


def _format_value_name(name: str) -> str:
    return name.lower().replace("_", " ")
