"""A node: the owner of publishers, subscriptions, services, timers and parameters. Its methods have rclpy's names."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.graph.client import Client
from linkwright.graph.clock import Clock, ROSClock
from linkwright.graph.dispatch import FREE_GROUP, CallbackGroup, Dispatcher, ExclusiveGroup
from linkwright.graph.endpoint import Endpoint
from linkwright.graph.endpoint_events import PublisherEvents, SubscriptionEvents
from linkwright.graph.entity import Entity
from linkwright.graph.events import PublisherEventCallbacks, SubscriptionEventCallbacks
from linkwright.graph.log.logger import Logger
from linkwright.graph.names import expand_service_name, expand_topic_name, join
from linkwright.graph.node_queries import NodeQueries
from linkwright.graph.parameters.node_parameters import NodeParameters
from linkwright.graph.publisher import Publisher
from linkwright.graph.qos import SERVICES_QOS, QoSProfile
from linkwright.graph.qos_compatibility import best_available
from linkwright.graph.rate import Rate
from linkwright.graph.remapping import Remappings
from linkwright.graph.service import Service
from linkwright.graph.sim_time import SimulatedTime
from linkwright.graph.subscription import Subscription
from linkwright.graph.time import NANOSECONDS_PER_SECOND
from linkwright.graph.timebase import Timebase
from linkwright.graph.timer import GuardCondition, Timer
from linkwright.graph.transport import NodeIdentity

if TYPE_CHECKING:
    from linkwright.graph.content_filter import ContentFilterOptions
    from linkwright.graph.graph import Graph
    from linkwright.graph.parameters.parameter import Parameter

M = TypeVar("M")
E = TypeVar("E", bound=Entity)


class Node(NodeParameters, NodeQueries):
    """A node of the graph; made by ``Graph.create_node``, whose arguments these are.

    Its callbacks are run by its dispatcher: in a graph on an event loop that is the loop, where one callback runs
    after another. One that raises is logged there; the others go on. Everything of a node may be made and used from
    any thread.
    """

    def __init__(
        self,
        graph: Graph,
        identity: NodeIdentity,
        *,
        logger: Logger,
        remappings: Remappings,
        dispatcher: Dispatcher | None,
    ) -> None:
        self.graph = graph
        self.identity = identity
        self._full_name = join(identity.namespace, identity.name)
        self.default_callback_group: CallbackGroup = ExclusiveGroup()
        """The group of entities that are in no other."""
        self._logger = logger
        self._remappings = remappings
        self._dispatcher = dispatcher
        self._clock = ROSClock(timebase=graph.timebase)
        self._entities: dict[Entity, None] = {}
        self._publishers: dict[Publisher[Any], None] = {}
        self._cleanups: dict[Callable[[], object], None] = {}
        self._destroyed = False
        self.copies_messages = False
        """Whether what is sent is copied, for its sender to change it then; holds for what is made afterwards."""
        self._simulated_time: SimulatedTime | None = None

    def begin(self, parameters: Mapping[str, Any] | Sequence[Parameter], **parameter_options: Any) -> None:
        """Make what every node has: parameters and their services, logging, and the following of simulated time.

        Args:
            parameters: values that take the place of declared defaults.
            parameter_options: see `NodeParameters._start_parameters`.

        Raises:
            LinkwrightError: a value that is given cannot be had.
        """
        self._start_parameters(parameters, **parameter_options)
        self._simulated_time = SimulatedTime(self, self._clock)

    def get_name(self) -> str:
        """The name without namespace."""
        return self.identity.name

    def get_namespace(self) -> str:
        """The namespace, absolute."""
        return self.identity.namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return self._full_name

    def get_logger(self) -> Logger:
        """The node's logger."""
        return self._logger

    def get_clock(self) -> ROSClock:
        """The node's clock: ROS time."""
        return self._clock

    @property
    def timebase(self) -> Timebase:
        """What the graph's time is made of."""
        return self.graph.timebase

    @property
    def is_destroyed(self) -> bool:
        """Whether the node has left the graph."""
        return self._destroyed

    # --- what runs the callbacks ---------------------------------------------------------------------------------

    @property
    def dispatcher(self) -> Dispatcher | None:
        """What runs the node's callbacks; None while nothing does."""
        return self._dispatcher

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Have the node's callbacks run by a dispatcher from now on, or by none.

        What falls due while there is none waits as the quality of service says, and is announced to the next one.
        """
        self._dispatcher = dispatcher
        for entity in tuple(self._entities):
            entity.set_dispatcher(dispatcher)

    def entities(self) -> tuple[Entity, ...]:
        """Everything of the node that calls back."""
        return tuple(self._entities)

    def add_entity(self, entity: E) -> E:
        """Take something that calls back into the node, and give it back: its calls are run with the node's."""
        return self._added(entity)

    def remove_entity(self, entity: Entity) -> None:
        """Take something out of the node that was added with `add_entity`."""
        self._retire(entity)

    def add_cleanup(self, callback: Callable[[], object]) -> None:
        """Have something called when the node is destroyed, before its parts are."""
        self._cleanups[callback] = None

    def remove_cleanup(self, callback: Callable[[], object]) -> None:
        """Do not have it called."""
        self._cleanups.pop(callback, None)

    # --- names -------------------------------------------------------------------------------------------------------

    def resolve_topic_name(self, topic: str, *, only_expand: bool = False) -> str:
        """The absolute name of a topic as this node names it, expanded and remapped.

        Raises:
            InvalidTopicNameError: it is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_topic_name(topic, name, namespace)
        return full_name if only_expand else self._remappings.topic(full_name, name, namespace)

    def resolve_service_name(self, service: str, *, only_expand: bool = False) -> str:
        """The absolute name of a service or action as this node names it, expanded and remapped.

        Raises:
            InvalidServiceNameError: it is not valid.
        """
        name, namespace = self.identity.name, self.identity.namespace
        full_name = expand_service_name(service, name, namespace)
        return full_name if only_expand else self._remappings.service(full_name, name, namespace)

    # --- making ------------------------------------------------------------------------------------------------------

    def create_publisher(
        self,
        msg_type: type[M] | str,
        topic: str,
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: PublisherEventCallbacks | None = None,
        publisher_class: type[Publisher[Any]] = Publisher,
    ) -> Publisher[M]:
        """A publisher of a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then made when it is needed.
            topic: relative, absolute or private (``~/``) name.
            qos_profile: what is offered; a number is a depth.
            callback_group: for the event callbacks.
            event_callbacks: what is called for events of the quality of service.
            publisher_class: the class of what is made.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            TypeError: the type is none of a message.
        """
        name = self.resolve_topic_name(topic)
        others = (each.qos_profile for each in self.graph.bus.subscriptions(name))
        qos = best_available(QoSProfile.of(qos_profile), others, publisher=True)
        publisher: Publisher[M] = publisher_class(
            self, msg_type, name, qos, callback_group, event_callbacks=event_callbacks
        )
        if event_callbacks is not None:
            publisher.events = self._added(PublisherEvents(publisher, event_callbacks))
        self._publishers[publisher] = None
        self.graph.add(publisher)
        return publisher

    def create_subscription(
        self,
        msg_type: type[M] | str,
        topic: str,
        callback: Callable[..., object],
        qos_profile: QoSProfile | int,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        raw: bool = False,
        content_filter_options: ContentFilterOptions | None = None,
    ) -> Subscription[M]:
        """A subscription to a topic.

        Args:
            msg_type: the message class, or the name of the type, whose class is then made when it is needed.
            topic: relative, absolute or private (``~/``) name.
            callback: called with each message, which it must not change, and, when it takes two arguments, with a
                `MessageInfo`. It may be a coroutine function.
            qos_profile: what is asked for; a number is a depth.
            callback_group: which entities may run beside it.
            event_callbacks: what is called for events of the quality of service.
            raw: whether the callback gets CDR bytes with their header instead of messages.
            content_filter_options: which messages are wanted.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
            ContentFilterError: the content filter cannot be understood.
            TypeError: the type is none of a message.
        """
        name = self.resolve_topic_name(topic)
        others = (each.qos_profile for each in self.graph.bus.publishers(name))
        qos = best_available(QoSProfile.of(qos_profile), others, publisher=False)
        subscription: Subscription[M] = Subscription(
            self, msg_type, name, qos, callback, callback_group, raw=raw, event_callbacks=event_callbacks
        )
        if event_callbacks is not None:
            subscription.events = SubscriptionEvents(subscription, event_callbacks)
        if content_filter_options is not None:
            subscription.set_content_filter(*content_filter_options)
        self.add_subscription(subscription)
        return subscription

    def add_subscription(self, subscription: Subscription[Any]) -> None:
        """Take a subscription into the node and the graph that was made otherwise than by `create_subscription`."""
        self._added(subscription)
        self.graph.add(subscription)

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
            TypeError: the type is none of a service.
        """
        name = self.resolve_service_name(srv_name)
        service: Service[Any, Any] = Service(
            self, srv_type, name, QoSProfile.of(qos_profile), callback, callback_group, replying=replying
        )
        self._added(service)
        self.graph.add(service)
        return service

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
            TypeError: the type is none of a service.
        """
        name = self.resolve_service_name(srv_name)
        client: Client[Any, Any] = Client(self, srv_type, name, QoSProfile.of(qos_profile), callback_group)
        self._added(client)
        self.graph.add(client)
        return client

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
            clock: what the period is counted on; the node's clock when left out, which follows simulated time.
            autostart: whether it runs from the start.

        Raises:
            ValueError: the period is negative.
        """
        period_ns = round(float(timer_period_sec) * NANOSECONDS_PER_SECOND)
        timer = Timer(self, callback, period_ns, clock or self._clock, callback_group, autostart=autostart)
        return self._added(timer)

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """A rate to sleep by.

        Args:
            frequency: turns a second.
            clock: what time is counted on; the node's clock when left out.

        Raises:
            ValueError: the frequency is not positive.
        """
        if frequency <= 0:
            raise ValueError("frequency must be > 0")
        return Rate(self.create_timer(1.0 / frequency, None, FREE_GROUP, clock))

    def create_guard_condition(
        self, callback: Callable[[], object] | None, callback_group: CallbackGroup | None = None
    ) -> GuardCondition:
        """A callback for the node to set off itself: many triggers in a row call it once."""
        return self._added(GuardCondition(self, callback, callback_group))

    # --- what was made -----------------------------------------------------------------------------------------------

    @property
    def publishers(self) -> Iterator[Publisher[Any]]:
        """The node's publishers."""
        yield from tuple(self._publishers)

    @property
    def subscriptions(self) -> Iterator[Subscription[Any]]:
        """The node's subscriptions."""
        yield from self._of(Subscription)

    @property
    def services(self) -> Iterator[Service[Any, Any]]:
        """The node's services."""
        yield from self._of(Service)

    @property
    def clients(self) -> Iterator[Client[Any, Any]]:
        """The node's clients."""
        yield from self._of(Client)

    @property
    def timers(self) -> Iterator[Timer]:
        """The node's timers."""
        yield from self._of(Timer)

    @property
    def guards(self) -> Iterator[GuardCondition]:
        """The node's guard conditions."""
        yield from self._of(GuardCondition)

    def endpoints(self) -> tuple[Endpoint, ...]:
        """The node's publishers, subscriptions, services and clients."""
        entities = [entity for entity in tuple(self._entities) if isinstance(entity, Endpoint)]
        return (*self._publishers, *entities)

    # --- destroying --------------------------------------------------------------------------------------------------

    def destroy_publisher(self, publisher: Publisher[Any]) -> bool:
        """Take a publisher away; what it sent is still delivered. Whether it was this node's."""
        if self._publishers.pop(publisher, publisher) is publisher:
            return False
        if publisher.events is not None:
            self._entities.pop(publisher.events, None)
        self.graph.remove(publisher)
        publisher.retire()
        return True

    def destroy_subscription(self, subscription: Subscription[Any]) -> bool:
        """Take a subscription away; its callback is not called again. Whether it was this node's."""
        return self._destroy_endpoint(subscription)

    def destroy_service(self, service: Service[Any, Any]) -> bool:
        """Take a service away. Whether it was this node's."""
        return self._destroy_endpoint(service)

    def destroy_client(self, client: Client[Any, Any]) -> bool:
        """Take a client away; its pending futures stay as they are. Whether it was this node's."""
        return self._destroy_endpoint(client)

    def destroy_timer(self, timer: Timer) -> bool:
        """Stop a timer for good. Whether it was this node's."""
        return self._retire(timer)

    def destroy_guard_condition(self, guard: GuardCondition) -> bool:
        """Never call back again. Whether it was this node's."""
        return self._retire(guard)

    def destroy_rate(self, rate: Rate) -> bool:
        """End a rate; who sleeps by it is woken. Whether it was this node's."""
        rate.wake()
        self.remove_cleanup(rate.wake)
        return self._retire(rate.timer)

    def destroy_node(self) -> bool:
        """Take the node and all it made out of the graph. A second call does nothing. Whether this was the first."""
        if self._destroyed:
            return False
        self._destroyed = True
        for cleanup in tuple(self._cleanups):
            cleanup()
        self._close_parameters()
        for entity in tuple(self._entities):
            if isinstance(entity, Endpoint):
                self._destroy_endpoint(entity)
            else:
                self._retire(entity)
        for publisher in tuple(self._publishers):
            self.destroy_publisher(publisher)
        self.graph.forget(self)
        return True

    def _added(self, entity: E) -> E:
        self._entities[entity] = None
        entity.set_dispatcher(self._dispatcher)
        return entity

    def _retire(self, entity: Entity) -> bool:
        if entity not in self._entities:
            return False
        del self._entities[entity]
        entity.retire()
        return True

    def _destroy_endpoint(self, endpoint: Any) -> bool:
        if endpoint not in self._entities:
            return False
        del self._entities[endpoint]
        self.graph.remove(endpoint)
        endpoint.retire()
        return True

    def _of(self, kind: type[E]) -> Iterator[E]:
        return (entity for entity in tuple(self._entities) if isinstance(entity, kind))
