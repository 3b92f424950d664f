"""Nodes, and the graph that creates them, with rclpy's method names."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial, wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar, cast

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import EVENT_TOPIC_SUFFIX, Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.introspection.node_queries import TYPE_DESCRIPTION_PARAMETER as TYPE_DESCRIPTIONS
from linkwright.graph.introspection.node_queries import NodeQueries, TypeDescriptions, has_type_descriptions_by_default
from linkwright.graph.local_graph import LocalGraph
from linkwright.graph.log.console import LOG_TYPE, ROSOUT_TOPIC, Rosout
from linkwright.graph.log.logger import Logger
from linkwright.graph.loop.dispatcher import GuardCondition
from linkwright.graph.loop.future import STRICT_GROUPS_PARAMETER
from linkwright.graph.loop.node_handle import FREE_GROUP, CallbackGroup, NodeHandle
from linkwright.graph.loop.timer import Rate, Timer
from linkwright.graph.names.rules import NodeIdentity, Remappings, absolute_namespace, check_node_name
from linkwright.graph.parameters.node_parameters import (
    EVENTS_TOPIC,
    EVENTS_TYPE,
    NodeParameters,
    ParameterEvents,
    ParameterServices,
)
from linkwright.graph.parameters.parameter import Parameter, ParameterDescriptor
from linkwright.graph.parameters.qos_overrides import QoSOverridingOptions, override_qos
from linkwright.graph.parameters.store import ParameterStore
from linkwright.graph.qos.compatibility import resolve_best_available
from linkwright.graph.qos.profile import PARAMETER_EVENTS_QOS, ROSOUT_QOS, SERVICES_QOS, QoSProfile
from linkwright.graph.simulated_time import SimulatedTime
from linkwright.graph.time.clock import Clock, ROSClock
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph.endpoints.content_filter import ContentFilterOptions
    from linkwright.graph.endpoints.event_types import PublisherEventCallbacks, SubscriptionEventCallbacks
    from linkwright.graph.executors import Executor
    from linkwright.graph.introspection.graph_queries import TopicEndpointInfo


M = TypeVar("M")


class Node(NodeParameters, NodeQueries):
    """A node of a graph.

    The node's dispatcher runs its callbacks. In a graph on an event loop, the loop runs one callback after another. If
    a callback raises an exception, the exception is logged and the loop continues. All parts of a node may be created
    and used from any thread.

    rclpy's nodes derive from this class, and users' nodes derive from rclpy's. The attributes here therefore have
    rclpy's names or mangled names, and the `handle` provides everything else. The methods do not use the attribute
    `graph`, because a user's node may define an attribute with that name.

    Args:
        graph: the graph that the node belongs to.
        node_name: the node name in the source code, before remapping.
        namespace: the namespace; a missing leading slash is added.
        parameters: values that override declared defaults; nested mappings represent dotted names.
        remappings: rules ``(from, to)`` for topics, services, ``__node`` and ``__ns``; see `Remappings`.
        enclave: the security enclave.
        start_parameter_services: whether other nodes can access this node's parameters.
        enable_rosout: whether the node's log is also published on ``/rosout``.
        rosout_qos_profile: the QoS of ``/rosout``; a number is a depth.
        allow_undeclared_parameters: whether parameters can be set without being declared.
        automatically_declare_parameters_from_overrides: whether `parameters` are declared immediately.
        copies_messages: whether messages are copied, so that the node may change a message after publishing it.
        stays_inside: whether the node and its endpoints are hidden from other processes.

    Raises:
        InvalidNodeNameError: the name is not valid.
        InvalidNamespaceError: the namespace is not valid.
        InvalidHandleError: the graph is closed.
        LinkwrightError: a parameter cannot have the given value.
    """

    def __init__(
        self,
        graph: LocalGraph,
        node_name: str,
        *,
        namespace: str = "/",
        parameters: Mapping[str, Any] | Sequence[Parameter] | None = None,
        remappings: Sequence[tuple[str, str]] = (),
        enclave: str = "/",
        start_parameter_services: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = ROSOUT_QOS,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        copies_messages: bool = False,
        stays_inside: bool = False,
    ) -> None:
        rules = Remappings(remappings)
        name = rules.node_name(node_name)
        check_node_name(name)
        identity = NodeIdentity(name, absolute_namespace(rules.namespace(namespace, node_name)), enclave)
        self.__local_graph = graph
        self.__handle = handle = graph.open_node(
            identity, rules, copies_messages=copies_messages, stays_inside=stays_inside
        )
        self.__clock = ROSClock(timebase=graph.timebase)
        NodeQueries.__init__(self, graph, handle)
        try:
            if enable_rosout:
                publisher: Publisher[Any] = Node.create_publisher(self, LOG_TYPE, ROSOUT_TOPIC, rosout_qos_profile)
                handle.add_cleanup(Rosout(publisher, handle.logger).close)
            events = ParameterEvents(
                Node.create_publisher(self, EVENTS_TYPE, EVENTS_TOPIC, PARAMETER_EVENTS_QOS),
                self.__clock,
                identity.full_name,
            )
            store = ParameterStore(
                _values_by_name(parameters or {}),
                allow_undeclared=allow_undeclared_parameters,
                on_change=events.publish,
            )
            NodeParameters.__init__(self, store)
            if automatically_declare_parameters_from_overrides:
                NodeParameters.declare_parameters_from_overrides(self)
            if start_parameter_services:
                ParameterServices(self, name, partial(Node.create_service, self))
            if STRICT_GROUPS_PARAMETER in store.overrides:
                description = "Let responses wait for the callback group of their client, as rclpy does."
                handle.strict_callback_groups = self.__node_flag(STRICT_GROUPS_PARAMETER, False, description)
            if self.__describes_types(store):
                TypeDescriptions(handle, partial(Node.create_service, self))
            SimulatedTime(handle, self, self.__clock)
        except BaseException:
            handle.destroy()
            raise

    def __describes_types(self, store: ParameterStore) -> bool:
        """Return whether the node offers the type description service.

        A parameter of the node decides. If the parameter is not set, the distribution's default applies.
        """
        if TYPE_DESCRIPTIONS not in store.overrides and not has_type_descriptions_by_default():
            return False
        return self.__node_flag(TYPE_DESCRIPTIONS, True, "Start the ~/get_type_description service for this node.")

    def __node_flag(self, name: str, default: bool, description: str) -> bool:
        """Return the value of a read-only boolean parameter that configures the node itself.

        If the parameter is not declared, it is declared with the value `default`.
        """
        if not NodeParameters.has_parameter(self, name):
            NodeParameters.declare_parameter(
                self, name, default, ParameterDescriptor(description=description, read_only=True)
            )
        return bool(NodeParameters.get_parameter(self, name).value)

    @cached_property
    def graph(self) -> LocalGraph:
        """The graph that the node belongs to.

        This is a cached property, so that a user's node can define an attribute with the same name.
        """
        return self.__local_graph

    @property
    def handle(self) -> NodeHandle:
        """The node's handle in the graph, which is entered while the node is in use."""
        return self.__handle

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The mutually exclusive group of entities that are created without a group."""
        return self.__handle.default_callback_group

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks, or None if there is none.

        The value is also None if the graph's event loop runs the callbacks.
        """
        dispatcher = self.__handle.dispatcher
        return cast("Executor", dispatcher) if hasattr(dispatcher, "add_node") else None

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.executor
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        if new_executor is not None:
            new_executor.add_node(self)

    def get_name(self) -> str:
        """Return the node's name without namespace."""
        self.__handle.check_alive()
        return self.__handle.identity.name

    def get_namespace(self) -> str:
        """Return the node's absolute namespace."""
        self.__handle.check_alive()
        return self.__handle.identity.namespace

    def get_fully_qualified_name(self) -> str:
        """Return the node's namespace and name."""
        self.__handle.check_alive()
        return self.__handle.identity.full_name

    def get_logger(self) -> Logger:
        """Return the node's logger."""
        return self.__handle.logger

    def get_clock(self) -> ROSClock:
        """Return the node's clock, which follows ``/clock`` while ``use_sim_time`` is true."""
        return self.__clock

    # --- creation ----------------------------------------------------------------------------------------------------

    def create_publisher(
        self,
        msg_type: type[M] | str,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
    ) -> Publisher[M]:
        """Create a publisher for a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then created on first use.
            topic: relative, absolute or private (``~/``) name.
            qos_profile: the offered QoS; a number is a depth.
            callback_group: the group of the event callbacks.
            event_callbacks: callbacks for QoS events.
            qos_overriding_options: the policies that parameters may override.
            publisher_class: the class of the publisher.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            AttributeError: the type is not an interface class.
            RuntimeError: the type is a service class.
            InvalidHandleError: the node was destroyed.
        """
        name = self.__handle.resolve_topic_name(topic)
        qos = override_qos(self, "publisher", name, QoSProfile.of(qos_profile), qos_overriding_options)
        peer_profiles = _endpoint_profiles(self.get_subscriptions_info_by_topic, name)
        qos = resolve_best_available(qos, peer_profiles, is_publisher=True)
        publisher: Publisher[M] = publisher_class(
            self.__handle, msg_type, name, qos, callback_group, event_callbacks=event_callbacks
        )
        return self.__handle.add(publisher)

    def create_subscription(
        self,
        msg_type: type[M] | str,
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
    ) -> Subscription[M]:
        """Create a subscription to a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then created on first use.
            topic: relative, absolute or private (``~/``) name.
            callback: a function or coroutine function that is called with each message, and with a `MessageInfo` if it
                takes two arguments. It must not change the message.
            qos_profile: the requested QoS; a number is a depth.
            callback_group: decides which entities may run at the same time.
            event_callbacks: callbacks for QoS events.
            qos_overriding_options: the policies that parameters may override.
            raw: whether the callback receives CDR bytes with their header instead of messages.
            content_filter_options: a condition for the messages.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            ContentFilterError: the content filter cannot be parsed, or does not fit the message type.
            AttributeError: the type is not an interface class.
            RuntimeError: the type is a service class.
        """
        name = self.__handle.resolve_topic_name(topic)
        qos = override_qos(self, "subscription", name, QoSProfile.of(qos_profile), qos_overriding_options)
        peer_profiles = _endpoint_profiles(self.get_publishers_info_by_topic, name)
        qos = resolve_best_available(qos, peer_profiles, is_publisher=False)
        subscription: Subscription[M] = Subscription(
            self.__handle, msg_type, name, qos, callback, callback_group, raw=raw, event_callbacks=event_callbacks
        )
        if content_filter_options is not None:
            subscription.set_content_filter(*content_filter_options)
        return self.__handle.add(subscription)

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any | Awaitable[Any]],
        *,
        qos_profile: QoSProfile = SERVICES_QOS,
        callback_group: CallbackGroup | None = None,
        replying: bool = False,
    ) -> Service[Any, Any]:
        """Create a server for a service.

        Args:
            srv_type: the service class, or the name of the type.
            srv_name: relative, absolute or private (``~/``) name.
            callback: a function or coroutine function that is called with a request and an empty response, fills in the
                response and returns it.
            qos_profile: the QoS; its depth limits how many requests are queued.
            callback_group: decides which entities may run at the same time.
            replying: whether the callback receives, instead of the empty response, a function that sends a response at
                any time.

        Raises:
            InvalidServiceNameError: the name is not valid.
            AttributeError: the type is not an interface class.
            RuntimeError: the type is a message class.
        """
        name = self.__handle.resolve_service_name(srv_name)
        service: Service[Any, Any] = Service(
            self.__handle, srv_type, name, QoSProfile.of(qos_profile), callback, callback_group, replying=replying
        )
        return self.__handle.add(service)

    def create_client(
        self,
        srv_type: Any,
        srv_name: str,
        *,
        qos_profile: QoSProfile = SERVICES_QOS,
        callback_group: CallbackGroup | None = None,
    ) -> Client[Any, Any]:
        """Create a client for a service.

        Args:
            srv_type: the service class, or the name of the type.
            srv_name: relative, absolute or private (``~/``) name.
            qos_profile: the QoS; its depth limits how many requests are queued while no server is available.
            callback_group: decides which entities may run at the same time.

        Raises:
            InvalidServiceNameError: the name is not valid.
            AttributeError: the type is not an interface class.
            RuntimeError: the type is a message class.
        """
        name = self.__handle.resolve_service_name(srv_name)
        qos = QoSProfile.of(qos_profile)
        client: Client[Any, Any] = Client(self.__handle, srv_type, name, qos, callback_group)
        return self.__handle.add(client)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., object] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """Create a timer that calls back at a fixed period, for the first time after one period.

        Args:
            timer_period_sec: the period in seconds.
            callback: called with a `TimerInfo` if it requires one argument, otherwise without arguments.
            callback_group: decides which entities may run at the same time.
            clock: the clock that measures the period; by default the node's clock, which may follow simulated time.
            autostart: whether the timer runs from the start.

        Raises:
            ValueError: the period is negative.
        """
        period_ns = round(float(timer_period_sec) * NANOSECONDS_PER_SECOND)
        clock = clock or self.__clock
        return self.__handle.add(Timer(self.__handle, callback, period_ns, clock, callback_group, autostart=autostart))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate, with which a loop sleeps until its next iteration.

        Args:
            frequency: iterations per second.
            clock: the clock that measures time; the node's clock by default.

        Raises:
            ValueError: the frequency is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        return Rate(Node.create_timer(self, 1.0 / frequency, None, FREE_GROUP, clock))

    def create_guard_condition(
        self, callback: Callable[[], object] | None, callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Create a guard condition, which calls its callback soon after a trigger.

        Several triggers before the call result in a single call.
        """
        return self.__handle.add(GuardCondition(self.__handle, callback, callback_group))

    # --- parts of the node -------------------------------------------------------------------------------------------

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """The node's publishers without ``/rosout`` and service events, as in rclpy."""
        return (
            publisher
            for publisher in self.__handle.parts(Publisher)
            if publisher.type_name != LOG_TYPE and not publisher.name.endswith(EVENT_TOPIC_SUFFIX)
        )

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """The node's subscriptions."""
        return iter(self.__handle.parts(Subscription))

    @property
    def services(self) -> Iterator[Service[Any, Any]]:
        """The node's services."""
        return iter(self.__handle.parts(Service))

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        """The node's clients."""
        return iter(self.__handle.parts(Client))

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's timers."""
        return iter(self.__handle.parts(Timer))

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The node's guard conditions."""
        return iter(self.__handle.parts(GuardCondition))

    # --- destruction -------------------------------------------------------------------------------------------------

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Destroy a publisher.

        Messages that it has published are still delivered. Returns whether the publisher belonged to this node.
        """
        return self.__handle.remove(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Destroy a subscription, and stop calling its callback.

        Returns whether the subscription belonged to this node.
        """
        return self.__handle.remove(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Destroy a service, and return whether it belonged to this node."""
        return self.__handle.remove(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Destroy a client, without completing its pending futures.

        Returns whether the client belonged to this node.
        """
        return self.__handle.remove(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Destroy a timer, and return whether it belonged to this node."""
        return self.__handle.remove(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Destroy a guard condition, and return whether it belonged to this node."""
        return self.__handle.remove(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """Destroy a rate, and wake the threads that sleep on it.

        Returns whether the rate belonged to this node.
        """
        return rate.destroy()

    def destroy_node(self) -> None:
        """Remove the node and all its parts from the graph.

        A second call does nothing.
        """
        self.__handle.destroy()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _values_by_name(parameters: Mapping[str, Any] | Sequence[Parameter]) -> Mapping[str, Any]:
    if isinstance(parameters, Mapping):
        return parameters
    return {parameter.name: parameter.value for parameter in parameters}


def _endpoint_profiles(query: Callable[[str, bool], list[TopicEndpointInfo]], topic: str) -> Iterator[QoSProfile]:
    """Iterate over the QoS profiles of a topic's endpoints, in this process and others.

    The graph is queried only when the first profile is needed.
    """
    yield from (endpoint.qos_profile for endpoint in query(topic, True))


P = ParamSpec("P")


def _node_factory(node_class: Callable[Concatenate[LocalGraph, P], Node]) -> Callable[Concatenate[Graph, P], Node]:
    """Return a method of `Graph` that creates a node of the given class.

    The method takes the arguments of that class after the graph.
    """

    @wraps(node_class, assigned=("__doc__",), updated=())
    def create_node(graph: Graph, /, *args: P.args, **kwargs: P.kwargs) -> Node:
        return node_class(graph, *args, **kwargs)

    return create_node


class Graph(LocalGraph):
    """The computation graph of a process, as in ROS 2.

    If a graph is created inside a running event loop, the loop runs the callbacks of its nodes. If it is created
    elsewhere, or with `threads`, its nodes have no dispatcher at first; an executor of `linkwright.graph.executors`
    can be their dispatcher. The arguments are those of `LocalGraph`.
    """

    create_node = _node_factory(Node)
