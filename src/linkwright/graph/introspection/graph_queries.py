"""Graph queries for nodes and endpoints, and detection of duplicate node names."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Iterable, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from enum import IntEnum

from linkwright.graph.endpoints.base import Endpoint, EndpointInfo, EndpointKind
from linkwright.graph.endpoints.bus import Bus, Transport
from linkwright.graph.faults import NodeNotFoundError
from linkwright.graph.log.logger import Logger, run_logged
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity, split
from linkwright.graph.qos.profile import UNKNOWN_QOS, HistoryPolicy, QoSProfile

OnSharedNames = Callable[[frozenset[str]], object]
"""Receives the full names of the nodes of this process whose names other processes also use.
It may be called from any thread, but never by two threads at the same time.
"""


class SharedNameMonitor:
    """Watches for node names of this process that other processes also use.

    Args:
        notify: receives the shared names when they change. None logs a warning for each name when it becomes shared.
    """

    def __init__(self, notify: OnSharedNames | None = None) -> None:
        self._notify = notify
        self._shared_names: frozenset[str] = frozenset()
        self._lock = threading.RLock()

    def update(self, local_nodes: Collection[NodeHandle], remote_nodes: Collection[NodeIdentity]) -> None:
        """Compare the node names of this process with the names in other processes.

        Reports the shared names when they have changed.
        """
        if not remote_nodes and not self._shared_names:
            return
        with self._lock:
            remote_names = {node_identity.full_name for node_identity in remote_nodes}
            previous_names = self._shared_names
            self._shared_names = frozenset(node.identity.full_name for node in local_nodes) & remote_names
            if self._shared_names == previous_names:
                return
            if self._notify is not None:
                self._notify(self._shared_names)
                return
            for node in local_nodes:
                name = node.identity.full_name
                if name in self._shared_names and name not in previous_names:
                    node.logger.warning(
                        f"Another process has a node of the exact name '{name}' too: this can have unintended side "
                        "effects. If it belongs to another robot or program, give one of them another ROS_DOMAIN_ID"
                    )


NamesAndTypes = list[tuple[str, list[str]]]
"""The sorted names of topics, services or actions, each with the sorted names of its types."""

UNKNOWN_NODE = NodeIdentity("_NODE_NAME_UNKNOWN_", "_NODE_NAMESPACE_UNKNOWN_")
"""The owner of an endpoint that discovery has not named yet."""

_ACTION_INFIX = "/_action/"
_FEEDBACK_SUFFIX = "_FeedbackMessage"


class TopicEndpointTypeEnum(IntEnum):
    """The kinds of topic endpoints (rclpy ``TopicEndpointTypeEnum``)."""

    INVALID = 0
    PUBLISHER = 1
    SUBSCRIPTION = 2


@dataclass
class TopicEndpointInfo:
    """The description of a publisher or subscription of a topic (rclpy ``TopicEndpointInfo``).

    Attributes:
        node_name: the name of the endpoint's node.
        node_namespace: the namespace of the endpoint's node.
        topic_type: the name of the message type.
        topic_type_hash: ``RIHS01_...``; empty if it is not known.
        endpoint_type: publisher or subscription.
        endpoint_gid: the GID of the endpoint.
        qos_profile: the offered or requested QoS.
        host: the machine that the endpoint runs on, which rclpy does not provide; empty for this process, and if the
            machine is not known.
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
        """Convert an endpoint's description to the form that rclpy returns."""
        node = info.node or UNKNOWN_NODE
        endpoint_type = (
            TopicEndpointTypeEnum.PUBLISHER
            if info.kind is EndpointKind.PUBLISHER
            else TopicEndpointTypeEnum.SUBSCRIPTION
        )
        return cls(
            node.name,
            node.namespace,
            info.type_name,
            info.type_hash,
            endpoint_type,
            list(info.gid),
            info.qos,
            info.host,
        )


def collect_names_and_types(endpoints: Iterable[EndpointInfo], *kinds: EndpointKind) -> NamesAndTypes:
    """Return the sorted names of the endpoints of the given kinds, each with its type names."""
    types: dict[str, set[str]] = {}
    for endpoint in endpoints:
        if endpoint.kind in kinds:
            types.setdefault(endpoint.name, set()).add(endpoint.type_name)
    return [(name, sorted(types[name])) for name in sorted(types)]


def collect_action_names_and_types(endpoints: Iterable[EndpointInfo], *kinds: EndpointKind) -> NamesAndTypes:
    """Return the actions, with types, whose feedback topic has endpoints of the given kinds.

    This is how rcl_action finds actions: an action server publishes feedback, an action client subscribes to it.
    """
    types: dict[str, set[str]] = {}
    for endpoint in endpoints:
        action, _, suffix = endpoint.name.rpartition(_ACTION_INFIX)
        if suffix == "feedback" and endpoint.kind in kinds:
            types.setdefault(action, set()).add(endpoint.type_name.removesuffix(_FEEDBACK_SUFFIX))
    return [(name, sorted(types[name])) for name in sorted(types)]


_PUBLISHER, _SUBSCRIPTION = EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION
_SERVICE, _CLIENT = EndpointKind.SERVICE, EndpointKind.CLIENT


class GraphQueries:
    """The queries that a graph answers, named as in rclpy.

    This is the base class of `Graph`.
    """

    bus: Bus
    _nodes: dict[NodeHandle, None]
    _transport: Transport | None
    _changed: threading.Condition
    _watchers: dict[Callable[[], object], None]
    _closed: bool
    _logger: Logger

    def identities(self) -> list[NodeIdentity]:
        """Return the nodes of this process, and the nodes discovered so far in other processes."""
        remote_nodes: Sequence[NodeIdentity] = ()
        if self._transport is not None:
            self._transport.start_discovery()
            remote_nodes = self._transport.remote_nodes()
        return [*(node.identity for node in tuple(self._nodes)), *remote_nodes]

    def endpoints(self) -> list[EndpointInfo]:
        """Return the endpoints of this process, and those discovered so far in other processes."""
        return self._find_endpoints(lambda _: True)

    def publishers(self) -> list[EndpointInfo]:
        """Return the publishers of all topics, in this process and others."""
        return self._find_endpoints(lambda endpoint: endpoint.kind is _PUBLISHER)

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """Return the endpoints of other processes that have been discovered so far."""
        if self._transport is None:
            return ()
        self._transport.start_discovery()
        return self._transport.remote_endpoints()

    def node_names(self) -> list[str]:
        """Return the sorted full names of the nodes of this process."""
        return sorted(node.identity.full_name for node in tuple(self._nodes))

    def topics(self) -> dict[str, list[str]]:
        """Return the sorted topic names, each with the names of the message types in use on it."""
        return dict(self.get_topic_names_and_types())

    def get_node_names_and_namespaces(self) -> list[tuple[str, str]]:
        """Return the name and namespace of each node."""
        return [(node.name, node.namespace) for node in self.identities()]

    def get_node_names_and_namespaces_with_enclaves(self) -> list[tuple[str, str, str]]:
        """Return the name, namespace and enclave of each node."""
        return [(node.name, node.namespace, node.enclave) for node in self.identities()]

    def get_topic_names_and_types(self, no_demangle: bool = False) -> NamesAndTypes:
        """Return the sorted topic names, each with the names of its types.

        Args:
            no_demangle: whether to return names and types as they are on the wire.
        """
        return _mangle(collect_names_and_types(self.endpoints(), _PUBLISHER, _SUBSCRIPTION), no_demangle)

    def get_service_names_and_types(self) -> NamesAndTypes:
        """Return the sorted service names, each with the names of its types."""
        return collect_names_and_types(self.endpoints(), _SERVICE, _CLIENT)

    def get_action_names_and_types(self) -> NamesAndTypes:
        """Return the sorted action names, each with the names of its types."""
        return collect_action_names_and_types(self.endpoints(), _PUBLISHER, _SUBSCRIPTION)

    def get_action_server_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the actions that a node serves. See `get_publisher_names_and_types_by_node`."""
        return collect_action_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _PUBLISHER)

    def get_action_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the actions of a node's clients. See `get_publisher_names_and_types_by_node`."""
        return collect_action_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _SUBSCRIPTION)

    def get_publisher_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node publishes, with their types.

        Args:
            node_name: the node's name.
            node_namespace: the node's namespace.
            no_demangle: whether to return names and types as they are on the wire.

        Raises:
            NodeNotFoundError: there is no such node.
        """
        return _mangle(
            collect_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _PUBLISHER), no_demangle
        )

    def get_subscriber_names_and_types_by_node(
        self, node_name: str, node_namespace: str, no_demangle: bool = False
    ) -> NamesAndTypes:
        """Return the topics that a node subscribes to.

        See `get_publisher_names_and_types_by_node`.
        """
        return _mangle(
            collect_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _SUBSCRIPTION), no_demangle
        )

    def get_service_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services that a node serves. See `get_publisher_names_and_types_by_node`."""
        return collect_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _SERVICE)

    def get_client_names_and_types_by_node(self, node_name: str, node_namespace: str) -> NamesAndTypes:
        """Return the services of a node's clients. See `get_publisher_names_and_types_by_node`."""
        return collect_names_and_types(self._find_endpoints_of_node(node_name, node_namespace), _CLIENT)

    def get_publishers_info_by_topic(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the publishers of a topic, given by its absolute name."""
        return [
            TopicEndpointInfo.of(_add_type_hash(endpoint))
            for endpoint in self._find_endpoints_by_name(topic, _PUBLISHER)
        ]

    def get_subscriptions_info_by_topic(self, topic: str) -> list[TopicEndpointInfo]:
        """Return the subscriptions to a topic, given by its absolute name."""
        return [
            TopicEndpointInfo.of(_add_type_hash(endpoint))
            for endpoint in self._find_endpoints_by_name(topic, _SUBSCRIPTION)
        ]

    def count_publishers(self, topic: str) -> int:
        """Return the number of publishers of a topic, given by its absolute name."""
        return len(self._find_endpoints_by_name(topic, _PUBLISHER))

    def count_subscribers(self, topic: str) -> int:
        """Return the number of subscriptions to a topic, given by its absolute name."""
        return len(self._find_endpoints_by_name(topic, _SUBSCRIPTION))

    def count_services(self, service: str) -> int:
        """Return the number of servers of a service, given by its absolute name."""
        return len(self._find_endpoints_by_name(service, _SERVICE))

    def count_clients(self, service: str) -> int:
        """Return the number of clients of a service, given by its absolute name."""
        return len(self._find_endpoints_by_name(service, _CLIENT))

    # --- waiting -----------------------------------------------------------------------------------------------------

    def notify_change(self) -> None:
        """Wake the threads in `wait_until`, so that they check their conditions again.

        Any thread may call this.
        """
        with self._changed:
            self._changed.notify_all()
        for watcher in tuple(self._watchers):
            run_logged(self._logger, "a callback for changes to the graph", watcher)

    def watch(self, callback: Callable[[], object]) -> None:
        """Register a callback for changes to nodes and endpoints.

        The callback runs in the thread in which the change happens. Exceptions that the callback raises are logged.
        """
        self._watchers[callback] = None

    def unwatch(self, callback: Callable[[], object]) -> None:
        """Unregister a callback that was registered with `watch`."""
        self._watchers.pop(callback, None)

    def wait_until(self, condition: Callable[[], bool], timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a condition of the graph holds.

        Args:
            condition: the condition, checked whenever nodes or endpoints appear or leave.
            timeout_sec: the maximum wait, in seconds; None or a negative number for no limit.

        Returns:
            Whether the condition holds at the end of the wait. Closing the graph also ends the wait.
        """
        deadline = None if timeout_sec is None or timeout_sec < 0 else time.monotonic() + timeout_sec
        while True:
            if condition():
                return True
            remaining_s = None if deadline is None else deadline - time.monotonic()
            if self._closed or (remaining_s is not None and remaining_s <= 0):
                return False
            with self._changed:
                # Discovery may report a change between the check and the wait, so each wait must be short.
                self._changed.wait(_MAX_WAIT_S if remaining_s is None else min(remaining_s, _MAX_WAIT_S))

    def wait_for_node(self, fully_qualified_node_name: str, timeout: float | None = None) -> bool:
        """Block the calling thread until a node exists, and return whether it exists.

        Args:
            fully_qualified_node_name: the node's full name, with or without the leading slash.
            timeout: the maximum wait, in seconds; None or a negative number for no limit.
        """
        full_name = "/" + fully_qualified_node_name.removeprefix("/")
        return self.wait_until(lambda: any(identity.full_name == full_name for identity in self.identities()), timeout)

    def _find_endpoints_of_node(self, name: str, namespace: str) -> list[EndpointInfo]:
        if not any((identity.name, identity.namespace) == (name, namespace) for identity in self.identities()):
            raise NodeNotFoundError(name, namespace)
        return [
            endpoint
            for endpoint in self.endpoints()
            if endpoint.node is not None and (endpoint.node.name, endpoint.node.namespace) == (name, namespace)
        ]

    def _find_endpoints_by_name(self, name: str, kind: EndpointKind) -> list[EndpointInfo]:
        return self._find_endpoints(lambda endpoint: endpoint.kind is kind and endpoint.name == name)

    def _find_endpoints(self, is_match: Callable[[Endpoint | EndpointInfo], bool]) -> list[EndpointInfo]:
        """Return the endpoints that meet a condition, in this process and others.

        Only the matching endpoints are described, because describing an endpoint takes time.
        """
        local_endpoints = (endpoint.info() for endpoint in self.bus.endpoints() if is_match(endpoint))
        return [*local_endpoints, *(endpoint for endpoint in self.remote_endpoints() if is_match(endpoint))]


_MAX_WAIT_S = 0.1


def _add_type_hash(endpoint: EndpointInfo) -> EndpointInfo:
    """Return the description with the type hash added.

    The hash is computed only when it is needed.
    """
    if endpoint.type_hash or not endpoint.local:
        return endpoint
    from linkwright.messages import get_interface, type_hash

    return replace(endpoint, type_hash=type_hash(get_interface(endpoint.type_name)))


def _mangle(entries: NamesAndTypes, no_demangle: bool) -> NamesAndTypes:
    if not no_demangle:
        return entries
    return [(f"rt{name}", [_to_wire_type_name(type_name) for type_name in types]) for name, types in entries]


def _to_wire_type_name(type_name: str) -> str:
    namespace, name = split(type_name)
    return f"{namespace.replace('/', '::')}::dds_::{name}_"
