"""Nodes (rclpy ``node``)."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Iterator, Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any, Literal, TypeVar

from linkwright.graph import Node as GraphNode
from linkwright.graph.client import Client
from linkwright.graph.clock import Clock, ROSClock
from linkwright.graph.content_filter import ContentFilterOptions
from linkwright.graph.dispatch import CallbackGroup, Dispatcher
from linkwright.graph.executors import MutuallyExclusiveCallbackGroup
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.handle import Handle
from linkwright.graph.log.logger import Logger
from linkwright.graph.log.services import LoggerServices
from linkwright.graph.names import absolute_namespace, join
from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.parameters.qos_overrides import QoSOverridingOptions, override_qos
from linkwright.graph.publisher import Publisher
from linkwright.graph.qos import ROSOUT_QOS, SERVICES_QOS, QoSProfile
from linkwright.graph.rate import Rate
from linkwright.graph.remapping import Remappings
from linkwright.graph.ros_arguments import RosArguments
from linkwright.graph.service import Service
from linkwright.graph.service_introspection import EVENT_TOPIC_SUFFIX
from linkwright.graph.subscription import Subscription
from linkwright.graph.timer import GuardCondition, Timer
from linkwright.standins.rclpy_api.context import Context, read_ros_arguments
from linkwright.standins.rclpy_api.forwarding import to_graph_node, to_graph_node_by_name
from linkwright.standins.rclpy_api.session import check_initialized, get_default_context
from linkwright.standins.rclpy_api.type_support import check_is_valid_msg_type, check_is_valid_srv_type

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph.events import PublisherEventCallbacks, SubscriptionEventCallbacks
    from linkwright.standins.rclpy_api.executors import Executor

M = TypeVar("M")


def _overrides(
    node_name: str, namespace: str, remappings: Sequence[tuple[str, str]], command_lines: Sequence[RosArguments]
) -> dict[str, Any]:
    """The parameters that command lines give a node, by the name that they give it; the first of them wins."""
    rules = Remappings(remappings)
    full_name = join(absolute_namespace(rules.namespace(namespace, node_name)), rules.node_name(node_name))
    overrides: dict[str, Any] = {}
    for line in reversed(command_lines):
        overrides |= line.parameters_for(full_name)
    return overrides


class Node:
    """A node; users' nodes derive from it. Everything is done by the node of the graph that it wraps.

    Args:
        node_name: its name, which the command line may change.
        context: what it belongs to; the default context when None.
        cli_args: a command line for this node alone.
        namespace: where it lives, which the command line may change.
        use_global_arguments: whether the command line of the context holds for it.
        enable_rosout: whether what it logs is published on ``/rosout``.
        rosout_qos_profile: the quality of service of that.
        start_parameter_services: whether others can read and set its parameters.
        parameter_overrides: values that take the place of defaults, and of what the command lines say.
        allow_undeclared_parameters: whether parameters can be set and read without being declared.
        automatically_declare_parameters_from_overrides: whether all parameters with overrides are declared.
        enable_logger_service: whether others can read and set the levels of its loggers.

    Raises:
        NotInitializedException: the context is not initialised.
        InvalidNodeNameError, InvalidNamespaceError: the name is not valid.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = ROSOUT_QOS,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        # The names of the attributes are mangled: users' nodes have attributes of their own.
        self.__context = get_default_context() if context is None else context
        check_initialized(self.__context, "cannot create node")
        self.__executor: weakref.ref[Any] | None = None
        self.__destroyed = False
        self.__handle = Handle(lambda: self.__destroyed)
        self.__default_callback_group = MutuallyExclusiveCallbackGroup()
        own = read_ros_arguments(cli_args or [])
        command_lines = [own, self.__context.ros_arguments] if use_global_arguments else [own]
        remappings = [rule for line in command_lines for rule in line.remappings_for(node_name)]
        overrides = _overrides(node_name, namespace or "/", remappings, command_lines)
        overrides |= {parameter.name: parameter.value for parameter in parameter_overrides or ()}
        graph = self.__context.graph
        self.__core: GraphNode = graph.create_node(
            node_name,
            namespace=namespace or "/",
            remappings=remappings,
            parameters=overrides,
            enclave=self.__context.ros_arguments.enclave or "/",
            enable_rosout=enable_rosout and self.__context.enable_rosout,
            rosout_qos_profile=QoSProfile.of(rosout_qos_profile),
            start_parameter_services=start_parameter_services,
            allow_undeclared_parameters=allow_undeclared_parameters,
            automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
        )
        self.__core.default_callback_group = self.__default_callback_group
        self.__core.copies_messages = True
        self.__core.get_clock().context = self.__context
        if enable_logger_service:
            LoggerServices(self.__core, graph.levels)
        self.__context.wait_for_network()

    # --- what it is and has ---------------------------------------------------------------------------------------

    @property
    def graph_node(self) -> GraphNode:
        """The node of the graph that does everything."""
        return self.__core

    @property
    def __living(self) -> GraphNode:
        """The node of the graph, for what needs one that lives.

        Raises:
            InvalidHandleError: the node was destroyed.
        """
        if self.__destroyed:
            raise InvalidHandleError
        return self.__core

    @property
    def context(self) -> Context:
        """What the node belongs to."""
        return self.__context

    @property
    def default_callback_group(self) -> CallbackGroup:
        """The group of everything that is given none: one callback runs at a time."""
        return self.__default_callback_group

    @property
    def handle(self) -> Handle:
        """Something to be entered while the node is used."""
        return self.__handle

    @property
    def executor(self) -> Executor | None:
        """What runs the node's callbacks; None when nothing does."""
        return None if self.__executor is None else self.__executor()

    @executor.setter
    def executor(self, new_executor: Executor | None) -> None:
        current = self.executor
        if current is new_executor:
            return
        if current is not None:
            current.remove_node(self)
        self.__executor = None
        if new_executor is not None and new_executor.add_node(self):
            self.__executor = weakref.ref(new_executor)

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """For executors: have the callbacks run by one, which takes the node from the one before."""
        current = self.executor
        self.__executor = None
        if current is not None and dispatcher is not None and current is not dispatcher:
            current.remove_node(self)
        self.__executor = None if dispatcher is None else weakref.ref(dispatcher)
        self.__core.set_dispatcher(dispatcher)

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """The publishers of the node; those of ``/rosout`` and of the events of services are none of its own."""
        return (
            publisher
            for publisher in self.__core.publishers
            if publisher.type_name != "rcl_interfaces/msg/Log" and not publisher.name.endswith(EVENT_TOPIC_SUFFIX)
        )

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """The subscriptions of the node."""
        return iter(self.__core.subscriptions)

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        """The clients of the node."""
        return iter(self.__core.clients)

    @property
    def services(self) -> Iterator[Service[Any, Any]]:
        """The services of the node."""
        return iter(self.__core.services)

    @property
    def timers(self) -> Iterator[Timer]:
        """The timers of the node."""
        return iter(self.__core.timers)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The guard conditions of the node."""
        return iter(self.__core.guards)

    def get_name(self) -> str:
        """The name without namespace."""
        return self.__living.get_name()

    def get_namespace(self) -> str:
        """The namespace, absolute."""
        return self.__living.get_namespace()

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return self.__living.get_fully_qualified_name()

    def get_clock(self) -> ROSClock:
        """The node's clock, which follows ``/clock`` when the parameter ``use_sim_time`` says so."""
        return self.__core.get_clock()

    def get_logger(self) -> Logger:
        """The node's logger."""
        return self.__core.get_logger()

    # --- what it makes --------------------------------------------------------------------------------------------

    def create_publisher(
        self,
        msg_type: type[M],
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
            msg_type: the message class.
            topic: relative, absolute or private (``~/``) name.
            qos_profile: what is offered; a number is a depth.
            callback_group: the group of the event callbacks.
            event_callbacks: told of mismatches, missed deadlines and the like.
            qos_overriding_options: which policies parameters can override.
            publisher_class: the class of what is made.
        """
        check_is_valid_msg_type(msg_type)
        qos = self.__overridden("publisher", topic, qos_profile, qos_overriding_options)
        return self.__living.create_publisher(
            msg_type,
            topic,
            qos,
            callback_group=callback_group or self.__default_callback_group,
            event_callbacks=event_callbacks,
            publisher_class=publisher_class,
        )

    def create_subscription(
        self,
        msg_type: type[M],
        topic: str,
        callback: Callable[..., Any],
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
            msg_type: the message class.
            topic: relative, absolute or private (``~/``) name.
            callback: called with each message, and with a ``MessageInfo`` when it takes two arguments.
            qos_profile: what is asked for; a number is a depth.
            callback_group: which callbacks may run at the same time.
            event_callbacks: told of mismatches, missed deadlines and the like.
            qos_overriding_options: which policies parameters can override.
            raw: whether the callback gets the bytes of messages.
            content_filter_options: which messages are wanted.

        Raises:
            ContentFilterError: the content filter cannot be understood.
        """
        check_is_valid_msg_type(msg_type)
        qos = self.__overridden("subscription", topic, qos_profile, qos_overriding_options)
        return self.__living.create_subscription(
            msg_type,
            topic,
            callback,
            qos,
            callback_group=callback_group or self.__default_callback_group,
            event_callbacks=event_callbacks,
            raw=raw,
            content_filter_options=content_filter_options,
        )

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
            srv_type: the service class.
            srv_name: relative, absolute or private (``~/``) name.
            qos_profile: its quality of service.
            callback_group: which callbacks may run at the same time.
        """
        check_is_valid_srv_type(srv_type)
        group = callback_group or self.__default_callback_group
        return self.__living.create_client(srv_type, srv_name, qos_profile=qos_profile, callback_group=group)

    def create_service(
        self,
        srv_type: Any,
        srv_name: str,
        callback: Callable[[Any, Any], Any],
        *,
        qos_profile: QoSProfile = SERVICES_QOS,
        callback_group: CallbackGroup | None = None,
    ) -> Service[Any, Any]:
        """A service.

        Args:
            srv_type: the service class.
            srv_name: relative, absolute or private (``~/``) name.
            callback: called with a request and an empty response; gives the response.
            qos_profile: its quality of service.
            callback_group: which callbacks may run at the same time.
        """
        check_is_valid_srv_type(srv_type)
        group = callback_group or self.__default_callback_group
        return self.__living.create_service(srv_type, srv_name, callback, qos_profile=qos_profile, callback_group=group)

    def create_timer(
        self,
        timer_period_sec: float,
        callback: Callable[..., Any] | None,
        callback_group: CallbackGroup | None = None,
        clock: Clock | None = None,
        autostart: bool = True,
    ) -> Timer:
        """A timer that calls back at a fixed period, first one period from now.

        Args:
            timer_period_sec: the period, in seconds.
            callback: called without arguments, or with a ``TimerInfo`` when it is annotated so.
            callback_group: which callbacks may run at the same time.
            clock: what the period is counted on; the node's clock when None.
            autostart: False to have it begin with its ``reset``.
        """
        group = callback_group or self.__default_callback_group
        return self.__core.create_timer(
            timer_period_sec, callback, callback_group=group, clock=clock, autostart=autostart
        )

    def create_guard_condition(
        self, callback: Callable[[], Any] | None, callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """Something to be triggered, from any thread, to have a callback called."""
        return self.__core.create_guard_condition(
            callback, callback_group=callback_group or self.__default_callback_group
        )

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Something whose ``sleep`` returns at a fixed frequency, for threads that do not spin.

        Args:
            frequency: times a second.
            clock: what it is counted on; the node's clock when None.

        Raises:
            ValueError: the frequency is not positive.
        """
        return self.__core.create_rate(frequency, clock)

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of a topic, remapped unless `only_expand`."""
        return self.__core.resolve_topic_name(topic, only_expand=only_expand)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The absolute name of a service, remapped unless `only_expand`."""
        return self.__core.resolve_service_name(service, only_expand=only_expand)

    destroy_publisher = to_graph_node(GraphNode.destroy_publisher)
    destroy_subscription = to_graph_node(GraphNode.destroy_subscription)
    destroy_client = to_graph_node(GraphNode.destroy_client)
    destroy_service = to_graph_node(GraphNode.destroy_service)
    destroy_timer = to_graph_node(GraphNode.destroy_timer)
    destroy_guard_condition = to_graph_node(GraphNode.destroy_guard_condition)
    destroy_rate = to_graph_node(GraphNode.destroy_rate)

    def destroy_node(self) -> None:
        """Take the node and all it made out of the graph; a second call does nothing."""
        self.__destroyed = True
        self.__core.destroy_node()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        self.destroy_node()

    # --- parameters -----------------------------------------------------------------------------------------------

    declare_parameter = to_graph_node(GraphNode.declare_parameter)
    declare_parameters = to_graph_node(GraphNode.declare_parameters)
    undeclare_parameter = to_graph_node(GraphNode.undeclare_parameter)
    has_parameter = to_graph_node(GraphNode.has_parameter)
    get_parameter = to_graph_node(GraphNode.get_parameter)
    get_parameters = to_graph_node(GraphNode.get_parameters)
    get_parameter_or = to_graph_node(GraphNode.get_parameter_or)
    get_parameter_type = to_graph_node(GraphNode.get_parameter_type)
    get_parameter_types = to_graph_node(GraphNode.get_parameter_types)
    get_parameters_by_prefix = to_graph_node(GraphNode.get_parameters_by_prefix)
    set_parameters = to_graph_node(GraphNode.set_parameters)
    set_parameters_atomically = to_graph_node(GraphNode.set_parameters_atomically)
    list_parameters = to_graph_node(GraphNode.list_parameters)
    describe_parameter = to_graph_node(GraphNode.describe_parameter)
    describe_parameters = to_graph_node(GraphNode.describe_parameters)
    set_descriptor = to_graph_node(GraphNode.set_descriptor)
    add_pre_set_parameters_callback = to_graph_node(GraphNode.add_pre_set_parameters_callback)
    add_on_set_parameters_callback = to_graph_node(GraphNode.add_on_set_parameters_callback)
    add_post_set_parameters_callback = to_graph_node(GraphNode.add_post_set_parameters_callback)
    remove_pre_set_parameters_callback = to_graph_node(GraphNode.remove_pre_set_parameters_callback)
    remove_on_set_parameters_callback = to_graph_node(GraphNode.remove_on_set_parameters_callback)
    remove_post_set_parameters_callback = to_graph_node(GraphNode.remove_post_set_parameters_callback)

    @property
    def _parameters_callbacks(self) -> Sequence[Callable[[list[Parameter]], Any]]:
        return self.__core.on_set_parameters_callbacks

    _on_set_parameters_callbacks = _parameters_callbacks

    @property
    def _pre_set_parameters_callbacks(self) -> Sequence[Callable[[list[Parameter]], Any]]:
        return self.__core.pre_set_parameters_callbacks

    @property
    def _post_set_parameters_callbacks(self) -> Sequence[Callable[[list[Parameter]], Any]]:
        return self.__core.post_set_parameters_callbacks

    # --- the graph ------------------------------------------------------------------------------------------------

    count_publishers = to_graph_node_by_name(GraphNode.count_publishers)
    count_subscribers = to_graph_node_by_name(GraphNode.count_subscribers)
    count_clients = to_graph_node_by_name(GraphNode.count_clients)
    count_services = to_graph_node_by_name(GraphNode.count_services)
    get_topic_names_and_types = to_graph_node(GraphNode.get_topic_names_and_types)
    get_service_names_and_types = to_graph_node(GraphNode.get_service_names_and_types)
    get_node_names = to_graph_node(GraphNode.get_node_names)
    get_node_names_and_namespaces = to_graph_node(GraphNode.get_node_names_and_namespaces)
    get_node_names_and_namespaces_with_enclaves = to_graph_node(GraphNode.get_node_names_and_namespaces_with_enclaves)
    get_publisher_names_and_types_by_node = to_graph_node(GraphNode.get_publisher_names_and_types_by_node)
    get_subscriber_names_and_types_by_node = to_graph_node(GraphNode.get_subscriber_names_and_types_by_node)
    get_service_names_and_types_by_node = to_graph_node(GraphNode.get_service_names_and_types_by_node)
    get_client_names_and_types_by_node = to_graph_node(GraphNode.get_client_names_and_types_by_node)
    get_publishers_info_by_topic = to_graph_node_by_name(GraphNode.get_publishers_info_by_topic)
    get_subscriptions_info_by_topic = to_graph_node_by_name(GraphNode.get_subscriptions_info_by_topic)
    wait_for_node = to_graph_node(GraphNode.wait_for_node)

    def get_fully_qualified_node_names(self) -> list[str]:
        """The full names of all nodes."""
        return [join(namespace, name) for name, namespace in self.__core.get_node_names_and_namespaces()]

    def __overridden(
        self,
        entity: Literal["publisher", "subscription"],
        topic: str,
        qos_profile: QoSProfile | int,
        options: QoSOverridingOptions | None,
    ) -> QoSProfile:
        qos = QoSProfile.of(qos_profile)
        if options is None:
            return qos
        return override_qos(self, entity, self.resolve_topic_name(topic), qos, options)
