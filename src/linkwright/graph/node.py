"""A node: the owner of publishers, subscriptions, timers and parameters. Its methods have rclpy's names."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from linkwright.graph.bus import Bus, Publisher, Subscription
from linkwright.graph.clock import Clock
from linkwright.graph.executor import Executor
from linkwright.graph.log import Logger
from linkwright.graph.names import Remappings, expand_topic_name, join
from linkwright.graph.parameters import (
    OnSetParameters,
    Parameter,
    ParameterDescriptor,
    ParameterStore,
    PostSetParameters,
    SetParametersResult,
)
from linkwright.graph.qos import QoSProfile
from linkwright.graph.timer import GuardCondition, Timer
from linkwright.messages import Message

M = TypeVar("M", bound=Message)

_NANOSECONDS_PER_SECOND = 1_000_000_000


class Node:
    """A node of the graph; made by ``Graph.create_node``.

    Callbacks run on the event loop, one after another. One that raises is logged; the others go on.
    """

    def __init__(
        self,
        name: str,
        namespace: str,
        *,
        bus: Bus,
        executor: Executor,
        clock: Clock,
        logger: Logger,
        parameters: Mapping[str, Any],
        remappings: Remappings,
        forget: Callable[[Node], None],
    ) -> None:
        self._name = name
        self._namespace = namespace
        self._bus = bus
        self._executor = executor
        self._clock = clock
        self._logger = logger
        self._remappings = remappings
        self._forget = forget
        self._publishers: list[Publisher[Any]] = []
        self._subscriptions: list[Subscription[Any]] = []
        self._timers: list[Timer] = []
        self._guards: list[GuardCondition] = []
        self._parameters = ParameterStore(parameters)
        if self.declare_parameter("use_sim_time", False).value:
            logger.warning("use_sim_time is set, but nothing here simulates time: stamps are the system's")

    def get_name(self) -> str:
        """The name without namespace."""
        return self._name

    def get_namespace(self) -> str:
        """The namespace, absolute."""
        return self._namespace

    def get_fully_qualified_name(self) -> str:
        """Namespace and name."""
        return join(self._namespace, self._name)

    def get_logger(self) -> Logger:
        """The node's logger."""
        return self._logger

    def get_clock(self) -> Clock:
        """The graph's clock."""
        return self._clock

    def resolve_topic_name(self, topic: str) -> str:
        """The absolute name of a topic as this node names it, expanded and remapped.

        Raises:
            InvalidNameError: it is not valid.
        """
        full_name = expand_topic_name(topic, self._name, self._namespace)
        return self._remappings.topic(full_name, self._name, self._namespace)

    def create_publisher(self, msg_type: type[M], topic: str, qos: QoSProfile | int) -> Publisher[M]:
        """A publisher of a topic.

        Args:
            msg_type: the message class.
            topic: relative, absolute or private (``~/``) name.
            qos: what is offered; a number is a depth.

        Raises:
            InvalidNameError: the topic's name is not valid.
        """
        publisher = Publisher(
            msg_type,
            self.resolve_topic_name(topic),
            QoSProfile.of(qos),
            self.get_fully_qualified_name(),
            self._logger,
        )
        self._publishers.append(publisher)
        self._bus.add_publisher(publisher)
        return publisher

    def create_subscription(
        self, msg_type: type[M], topic: str, callback: Callable[[M], object], qos: QoSProfile | int
    ) -> Subscription[M]:
        """A subscription to a topic.

        Args:
            msg_type: the message class.
            topic: relative, absolute or private (``~/``) name.
            callback: called with each message, which it must not change.
            qos: what is asked for; a number is a depth.

        Raises:
            InvalidNameError: the topic's name is not valid.
        """
        subscription = Subscription(
            msg_type,
            self.resolve_topic_name(topic),
            QoSProfile.of(qos),
            self.get_fully_qualified_name(),
            self._logger,
            callback,
            self._executor,
        )
        self._subscriptions.append(subscription)
        self._bus.add_subscription(subscription)
        return subscription

    def create_timer(self, timer_period_sec: float, callback: Callable[[], object]) -> Timer:
        """A timer that calls back at a fixed period, first one period from now.

        Raises:
            ValueError: the period, in seconds, is not positive.
        """
        period_ns = round(timer_period_sec * _NANOSECONDS_PER_SECOND)
        timer = Timer(period_ns, callback, self._clock, self._logger)
        self._timers.append(timer)
        return timer

    def create_guard_condition(self, callback: Callable[[], object]) -> GuardCondition:
        """A callback for the node to set off itself: many triggers in a row call it once."""
        guard = GuardCondition(callback, self._executor, self._logger)
        self._guards.append(guard)
        return guard

    def destroy_publisher(self, publisher: Publisher[Any]) -> None:
        """Take a publisher away; what it sent is still delivered."""
        self._publishers.remove(publisher)
        self._bus.remove_publisher(publisher)

    def destroy_subscription(self, subscription: Subscription[Any]) -> None:
        """Take a subscription away; its callback is not called again."""
        self._subscriptions.remove(subscription)
        self._bus.remove_subscription(subscription)

    def destroy_timer(self, timer: Timer) -> None:
        """Stop a timer for good."""
        self._timers.remove(timer)
        timer.cancel()

    def declare_parameter(
        self, name: str, value: Any = None, descriptor: ParameterDescriptor | None = None
    ) -> Parameter:
        """Declare a parameter. Its value is the one given to the node from outside, else the default.

        Args:
            name: its name.
            value: the default, whose type every later value must have too; None for none of either.
            descriptor: what else is to be said of it.

        Raises:
            InvalidParameterTypeError: the value from outside has another type than the default.
            InvalidParameterValueError: a callback refuses the value.
            ParameterAlreadyDeclaredError: it is declared already.
        """
        return self._parameters.declare(name, value, descriptor)

    def declare_parameters_from_overrides(self) -> None:
        """Declare every parameter that was given to the node from outside and is not declared yet."""
        for name, value in self._parameters.overrides.items():
            if not self.has_parameter(name):
                self._parameters.declare(name, value, None)

    def has_parameter(self, name: str) -> bool:
        """Whether a parameter is declared."""
        return name in self._parameters.names()

    def get_parameter(self, name: str) -> Parameter:
        """A declared parameter.

        Raises:
            ParameterNotDeclaredError: it is not declared.
        """
        return self._parameters.get(name)

    def get_parameters(self, names: Sequence[str]) -> list[Parameter]:
        """Several declared parameters; see `get_parameter`."""
        return [self._parameters.get(name) for name in names]

    def get_parameters_by_prefix(self, prefix: str) -> dict[str, Parameter]:
        """The parameters ``prefix.rest``, by ``rest``."""
        return self._parameters.with_prefix(prefix)

    def list_parameters(self) -> list[str]:
        """Names of the declared parameters, in order of declaration."""
        return self._parameters.names()

    def set_parameters(self, parameters: Sequence[Parameter]) -> list[SetParametersResult]:
        """Set parameters one by one; each is set or not, for a reason."""
        return [self._parameters.set_together([parameter]) for parameter in parameters]

    def set_parameters_atomically(self, parameters: Sequence[Parameter]) -> SetParametersResult:
        """Set all of the parameters or none."""
        return self._parameters.set_together(parameters)

    def add_on_set_parameters_callback(self, callback: OnSetParameters) -> None:
        """Have a callback asked before parameters are declared or set; it may refuse with a reason."""
        self._parameters.on_set.append(callback)

    def add_post_set_parameters_callback(self, callback: PostSetParameters) -> None:
        """Have a callback told after parameters were set."""
        self._parameters.post_set.append(callback)

    def destroy_node(self) -> None:
        """Take the node and all it made out of the graph. A second call does nothing."""
        for timer in self._timers:
            timer.cancel()
        for guard in self._guards:
            guard.destroy()
        for publisher in self._publishers:
            self._bus.remove_publisher(publisher)
        for subscription in self._subscriptions:
            self._bus.remove_subscription(subscription)
        for made in (self._timers, self._guards, self._publishers, self._subscriptions):
            made.clear()
        self._forget(self)
