"""Nodes, and the graph that makes them. Their methods have rclpy's names."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from functools import cached_property, partial, wraps
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar, cast

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import EVENT_TOPIC_SUFFIX, Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.introspection.node_queries import PARAMETER as TYPE_DESCRIPTIONS
from linkwright.graph.introspection.node_queries import NodeQueries, TypeDescriptions, is_usual
from linkwright.graph.local_graph import LocalGraph
from linkwright.graph.log.console import LOG_TYPE, ROSOUT_TOPIC, Rosout
from linkwright.graph.log.logger import Logger
from linkwright.graph.loop.dispatcher import GuardCondition
from linkwright.graph.loop.future import STRICT
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
from linkwright.graph.qos.compatibility import best_available
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

    Its callbacks are run by its dispatcher: in a graph on an event loop that is the loop, where one callback runs
    after another. An exception of a callback is logged there; the others continue. Everything of a node may be made and
    used from any thread.

    rclpy's nodes derive from this class, and users' nodes from those. So names here are those of rclpy, or mangled
    ones; for everything else there is the `handle`. Nothing here reads `graph`, which a user's node may define itself.

    Args:
        graph: where it lives.
        node_name: the name its code gives it.
        namespace: where in the graph it lives; a missing leading slash is added.
        parameters: values that take the place of declared defaults; nested mappings represent dotted names.
        remappings: rules ``(from, to)`` for topics, services, ``__node`` and ``__ns``; see `Remappings`.
        enclave: its security enclave.
        start_parameter_services: whether others can ask for its parameters.
        enable_rosout: whether its log goes to ``/rosout`` too.
        rosout_qos_profile: the quality of service of that; a number is a depth.
        allow_undeclared_parameters: whether parameters can be set that were not declared.
        automatically_declare_parameters_from_overrides: whether `parameters` are declared at once.
        copies_messages: whether its messages are copied, so that their sender may change them afterwards.
        stays_inside: whether it is hidden, with all its endpoints, from other processes.

    Raises:
        InvalidNodeNameError: the name is not valid.
        InvalidNamespaceError: the namespace is not valid.
        InvalidHandleError: the graph is closed.
        LinkwrightError: a parameter's value cannot be had.
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
                _by_name(parameters or {}), allow_undeclared=allow_undeclared_parameters, on_change=events.publish
            )
            NodeParameters.__init__(self, store)
            if automatically_declare_parameters_from_overrides:
                NodeParameters.declare_parameters_from_overrides(self)
            if start_parameter_services:
                ParameterServices(self, name, partial(Node.create_service, self))
            if STRICT in store.overrides:
                description = "Let responses wait for the callback group of their client, as rclpy does."
                handle.strict_callback_groups = self.__own(STRICT, False, description)
            if self.__describes_types(store):
                TypeDescriptions(handle, partial(Node.create_service, self))
            SimulatedTime(handle, self, self.__clock)
        except BaseException:
            handle.destroy()
            raise

    def __describes_types(self, store: ParameterStore) -> bool:
        """Whether others can ask for its types: as the distribution does, unless its parameter sets it."""
        if TYPE_DESCRIPTIONS not in store.overrides and not is_usual():
            return False
        return self.__own(TYPE_DESCRIPTIONS, True, "Start the ~/get_type_description service for this node.")

    def __own(self, name: str, usual: bool, description: str) -> bool:
        """The value of a parameter that the node itself obeys, declared unless it is."""
        if not NodeParameters.has_parameter(self, name):
            NodeParameters.declare_parameter(
                self, name, usual, ParameterDescriptor(description=description, read_only=True)
            )
        return bool(NodeParameters.get_parameter(self, name).value)

    @cached_property
    def graph(self) -> LocalGraph:
        """Where it lives. Unlike a property this lets a user's node have an attribute or a method of the name."""
        return self.__local_graph

    @property
    def handle(self) -> NodeHandle:
        """The node's handle in the graph; entered while the node is used."""
        return self.__handle

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of everything that is given none: one callback runs at a time."""
        return self.__handle.default_callback_group

    @property
    def executor(self) -> Executor | None:
        """The executor that runs the node's callbacks; None when nothing does, or the event loop of its graph."""
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
        """The name without namespace."""
        self.__handle.check_alive()
        return self.__handle.identity.name

    def get_namespace(self) -> str:
        """The namespace, absolute."""
        self.__handle.check_alive()
        return self.__handle.identity.namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        self.__handle.check_alive()
        return self.__handle.identity.full_name

    def get_logger(self) -> Logger:
        """The node's logger."""
        return self.__handle.logger

    def get_clock(self) -> ROSClock:
        """The node's clock: ROS time, which follows ``/clock`` while the parameter ``use_sim_time`` is true."""
        return self.__clock

    # --- making ------------------------------------------------------------------------------------------------------

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
        """A publisher of a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then made when it is needed.
            topic: relative, absolute or private (``~/``) name.
            qos_profile: the QoS that it offers; a number is a depth.
            callback_group: for the event callbacks.
            event_callbacks: callbacks for events of the quality of service.
            qos_overriding_options: which of its policies parameters may override.
            publisher_class: the class of the publisher.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            AttributeError: the type is not a class of an interface.
            RuntimeError: it is the class of a service.
            InvalidHandleError: the node was destroyed.
        """
        name = self.__handle.resolve_topic_name(topic)
        qos = override_qos(self, "publisher", name, QoSProfile.of(qos_profile), qos_overriding_options)
        others = _profiles(self.get_subscriptions_info_by_topic, name)
        qos = best_available(qos, others, publisher=True)
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
        """A subscription to a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then made when it is needed.
            topic: relative, absolute or private (``~/``) name.
            callback: called with each message, which it must not change, and, when it takes two arguments, with a
                `MessageInfo`. It may be a coroutine function.
            qos_profile: the QoS that it requests; a number is a depth.
            callback_group: which entities may run beside it.
            event_callbacks: callbacks for events of the quality of service.
            qos_overriding_options: which of its policies parameters may override.
            raw: whether the callback gets CDR bytes with their header instead of messages.
            content_filter_options: a condition for the messages.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            ContentFilterError: the content filter cannot be understood.
            AttributeError: the type is not a class of an interface.
            RuntimeError: it is the class of a service.
        """
        name = self.__handle.resolve_topic_name(topic)
        qos = override_qos(self, "subscription", name, QoSProfile.of(qos_profile), qos_overriding_options)
        others = _profiles(self.get_publishers_info_by_topic, name)
        qos = best_available(qos, others, publisher=False)
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
        """A server of a service.

        Args:
            srv_type: the class of the service, or its name.
            srv_name: relative, absolute or private (``~/``) name.
            callback: called with a request and an empty response, which it fills in and gives back. It may be a
                coroutine function.
            qos_profile: how many requests wait, and so on.
            callback_group: which entities may run beside it.
            replying: whether the callback gets, instead of the response, a callable that sends one at any time.

        Raises:
            InvalidServiceNameError: the name is not valid.
            AttributeError: the type is not a class of an interface.
            RuntimeError: it is the class of a message.
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
        """A client of a service.

        Args:
            srv_type: the class of the service, or its name.
            srv_name: relative, absolute or private (``~/``) name.
            qos_profile: how many requests wait for a server, and so on.
            callback_group: which entities may run beside it.

        Raises:
            InvalidServiceNameError: the name is not valid.
            AttributeError: the type is not a class of an interface.
            RuntimeError: it is the class of a message.
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
        """A timer that calls back at a fixed period, first one period from now.

        Args:
            timer_period_sec: the period in seconds.
            callback: called without arguments, or with a `TimerInfo` when it takes one.
            callback_group: which entities may run beside it.
            clock: the clock that counts the period; the node's when left out, which follows simulated time.
            autostart: whether it runs from the start.

        Raises:
            ValueError: the period is negative.
        """
        period_ns = round(float(timer_period_sec) * NANOSECONDS_PER_SECOND)
        clock = clock or self.__clock
        return self.__handle.add(Timer(self.__handle, callback, period_ns, clock, callback_group, autostart=autostart))

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """A rate to sleep by.

        Args:
            frequency: turns a second.
            clock: the clock that counts time; the node's when left out.

        Raises:
            ValueError: the frequency is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        return Rate(Node.create_timer(self, 1.0 / frequency, None, FREE_GROUP, clock))

    def create_guard_condition(
        self, callback: Callable[[], object] | None, callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """A callback for the node to set off itself: many triggers in a row call it once."""
        return self.__handle.add(GuardCondition(self.__handle, callback, callback_group))

    # --- publishers, subscriptions and the rest -----------------------------------------------------------------------

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """The node's publishers, without those of ``/rosout`` and of the events of services, as in rclpy."""
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

    # --- destroying --------------------------------------------------------------------------------------------------

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Remove a publisher; its messages are still delivered. Whether it was this node's."""
        return self.__handle.remove(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Remove a subscription; its callback is not called again. Whether it was this node's."""
        return self.__handle.remove(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Take a service away. Whether it was this node's."""
        return self.__handle.remove(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Remove a client; its pending futures stay as they are. Whether it was this node's."""
        return self.__handle.remove(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Stop a timer for good. Whether it was this node's."""
        return self.__handle.remove(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Never call back again. Whether it was this node's."""
        return self.__handle.remove(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """End a rate; threads that sleep by it wake. Whether it was this node's."""
        return rate.destroy()

    def destroy_node(self) -> None:
        """Take the node and all it made out of the graph. A second call does nothing."""
        self.__handle.destroy()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.destroy_node()


def _by_name(parameters: Mapping[str, Any] | Sequence[Parameter]) -> Mapping[str, Any]:
    if isinstance(parameters, Mapping):
        return parameters
    return {parameter.name: parameter.value for parameter in parameters}


def _profiles(ask: Callable[[str, bool], list[TopicEndpointInfo]], topic: str) -> Iterator[QoSProfile]:
    """The profiles of the endpoints of a topic, in this process and outside; the graph is asked when one is needed."""
    yield from (endpoint.qos_profile for endpoint in ask(topic, True))


P = ParamSpec("P")


def _made_by(node_class: Callable[Concatenate[LocalGraph, P], Node]) -> Callable[Concatenate[Graph, P], Node]:
    """The method that makes a node of a class in a graph, with that class's further arguments."""

    @wraps(node_class, assigned=("__doc__",), updated=())
    def create_node(graph: Graph, /, *args: P.args, **kwargs: P.kwargs) -> Node:
        return node_class(graph, *args, **kwargs)

    return create_node


class Graph(LocalGraph):
    """A ROS-like computation graph.

    Made inside a running event loop, it has that loop run the callbacks of its nodes. Made elsewhere, or with
    `threads`, its nodes have no dispatcher of their own; the executors of `linkwright.graph.executors` are ones. Its
    arguments are those of `LocalGraph`.
    """

    create_node = _made_by(Node)
