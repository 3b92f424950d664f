"""A node whose callbacks run between steps of a simulation or control loop, in its thread."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from math import isfinite
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph.endpoints.base import Endpoint, EndpointInfo
from linkwright.graph.endpoints.command_disputes import DisputeMonitor
from linkwright.graph.endpoints.command_guard import CommandGuard, describe_lost_publisher
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.log.logger import Logger
from linkwright.graph.node import Node
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.stepped.calls import Calls, create_logged_calls
from linkwright.graph.stepped.exchange import Exchange
from linkwright.messages import get_service

_WARNING_PERIOD_S = 1.0


class _Outlet:
    """The publishers of a topic, to which the exchange passes messages.

    An error ends only the plugin that owns the publishers.

    Args:
        output: the topic.
        create_message: creates a message from the values that are sent; None if messages themselves are sent.
    """

    __slots__ = ("_create_message", "_output")

    def __init__(self, output: Output, create_message: Callable[..., Any] | None = None) -> None:
        self._output = output
        self._create_message = create_message

    def publish(self, message: Any) -> None:
        """Publish a message.

        With `create_message`, `message` contains the values from which `create_message` creates the message.
        """
        output, create_message = self._output, self._create_message
        try:
            outgoing_message = message if create_message is None else create_message(*message)
            for publisher in output.publishers:
                publisher.publish(outgoing_message)
        except InvalidHandleError:
            raise  # the publisher's model was removed
        except Exception as error:  # noqa: BLE001 - a plugin's message may cause any error
            output.exchange.post(partial(output.calls.fail, error))


class Output:
    """A topic that a plugin publishes, under one or two names.

    Args:
        exchange: the exchange of the simulation.
        publishers: one publisher for each name.
        calls: the calls of the plugin.
    """

    def __init__(self, exchange: Exchange, publishers: list[Publisher[Any]], calls: Calls) -> None:
        self.exchange = exchange
        self.publishers = publishers
        self.calls = calls
        self._outlet = _Outlet(self)
        self._cached_call_number, self._is_wanted = 0, False

    @property
    def is_wanted(self) -> bool:
        """Whether a subscription exists.

        Without one, a plugin need not create a costly message. Subscriptions may change at any time in another thread,
        but within one call of a plugin this value stays the same.
        """
        call_number = self.calls.number
        if not call_number:
            return self._has_subscriptions()
        if call_number != self._cached_call_number:
            self._cached_call_number, self._is_wanted = call_number, self._has_subscriptions()
        return self._is_wanted

    def _has_subscriptions(self) -> bool:
        for publisher in self.publishers:  # noqa: SIM110 - `any` takes twice as long, and calls are frequent
            if publisher.get_subscription_count():
                return True
        return False

    def publish(self, message: Any) -> None:
        """Publish a message.

        The message must not change afterwards.
        """
        self.exchange.send(self._outlet, message)

    def deferred_publisher(self, create_message: Callable[..., Any]) -> Callable[..., None]:
        """Return a function that creates a message from its arguments and publishes it.

        The message is created where it is published, so a simulation with its own thread need not wait for it.

        Args:
            create_message: creates a message from values that do not change afterwards.
        """
        outlet = _Outlet(self, create_message)

        def send(*values: Any) -> None:
            self.exchange.send(outlet, values)

        return send


class SteppedNode:
    """The endpoints and parameters of a node whose callbacks run between two steps.

    Args:
        node: the node.
        exchange: the exchange of the simulation or the control loop.
        owned: whether closing this object destroys the node.
        now_ns: returns the time of the steps, in nanoseconds; by default the time of the node's clock.
        calls: calls the callbacks; by default errors are logged.

    Attributes:
        calls: the object that calls the callbacks.
    """

    def __init__(
        self,
        node: Node,
        exchange: Exchange,
        *,
        owned: bool,
        now_ns: Callable[[], int] | None = None,
        calls: Calls | None = None,
    ) -> None:
        self._node = node
        self.calls = calls or create_logged_calls(node.get_logger(), node.get_fully_qualified_name())
        self._now_ns = now_ns or node.get_clock().now_ns
        self._exchange = exchange
        self._owned = owned
        self._endpoints: list[Endpoint] = []

    @property
    def logger(self) -> Logger:
        """The node's logger."""
        return self._node.get_logger()

    @property
    def graph_node(self) -> Node:
        """The underlying node, for features whose callbacks run on the event loop, such as actions."""
        return self._node

    @property
    def exchange(self) -> Exchange:
        """The exchange between the thread of the steps and the event loop."""
        return self._exchange

    @property
    def name(self) -> str:
        """The full name of the node."""
        return self._node.get_fully_qualified_name()

    def publisher(self, msg_type: Any, topic: str, qos: QoSProfile | int = 10) -> Output:
        """Create a publisher, and return an `Output` for it.

        Args:
            msg_type: the message class, or the name of the type.
            topic: relative, absolute or private name.
            qos: the QoS; a number is a depth.
        """
        return self._create_output(msg_type, [topic], qos)

    def subscribe(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], object],
        qos: QoSProfile | int = 10,
        *,
        command_guard: CommandGuard | None = None,
        stop_motion: Callable[[], object] | None = None,
    ) -> None:
        """Subscribe to a topic, with a callback that runs between two steps.

        Args:
            msg_type: the message class, or the name of the type.
            topic: relative, absolute or private name.
            callback: called with each message.
            qos: the QoS; a number is a depth.
            command_guard: the guard of commands that remain in effect until the next one, created by the
                method `command_guard`.
            stop_motion: called instead of the callback, with a warning, if a message contains NaN or an infinite
                number, which would make the world unstable. None to accept such messages.
        """
        self._subscribe_to(
            msg_type, [topic], self._make_callback(topic, callback, stop_motion, command_guard), qos, command_guard
        )

    def command_guard(self, stop_motion: Callable[[], bool]) -> CommandGuard:
        """Return a guard that revokes the last command when its publisher is lost.

        The guard is for commands that remain in effect until the next one. It also warns if several nodes send
        commands at the same time.

        Args:
            stop_motion: stops the motion of the last command, and returns whether there was any motion. If there was, a
                warning is logged.
        """

        def on_lost(publisher: EndpointInfo) -> None:
            self.post(partial(self._stop_motion, stop_motion, publisher))

        return CommandGuard(on_lost, DisputeMonitor(self.logger, self._node.graph, self._now_ns))

    def service(self, srv_type: str, name: str, callback: Callable[[Any, Any], Any]) -> None:
        """Offer a service.

        Args:
            srv_type: the name of the type.
            name: relative, absolute or private name.
            callback: called with the request and an empty response between two steps; returns the response.
        """
        response = get_service(srv_type).Response

        def on_request(request: Any, reply: Callable[[Any], None]) -> None:
            self.post(lambda: reply(callback(request, response())))

        self._endpoints.append(self._node.create_service(srv_type, name, on_request, replying=True))

    def post(self, command: Callable[[], object]) -> None:
        """Queue a function to be called between two steps.

        Any thread may call this method.
        """
        self._exchange.post(partial(self.calls.call, command))

    def parameter(self, name: str, default: Any) -> Any:
        """Return the value of a parameter of the node.

        The parameter is declared if necessary.

        Args:
            name: the parameter's name.
            default: the default with which it is declared.
        """
        if not self._node.has_parameter(name):
            self._node.declare_parameter(name, default)
        return self._node.get_parameter(name).value

    def close(self) -> None:
        """Destroy the node if it is owned, otherwise the endpoints that were created."""
        if self._owned:
            self._node.destroy_node()
        else:
            for endpoint in self._endpoints:
                endpoint.destroy()

    def _create_output(self, msg_type: Any, names: Iterable[str], qos: QoSProfile | int) -> Output:
        publishers = [
            self._node.create_publisher(msg_type, name, self._resolve_qos(name, "publisher", qos)) for name in names
        ]
        self._endpoints += publishers
        return Output(self._exchange, publishers, self.calls)

    def _make_callback(
        self,
        topic: str,
        callback: Callable[[Any], object],
        stop_motion: Callable[[], object] | None,
        command_guard: CommandGuard | None,
    ) -> Callable[..., object]:
        """Return a subscription callback that passes each message to `callback` between steps."""
        if stop_motion is not None:
            callback = partial(self._pass_if_finite, callback, stop_motion, topic)
        deferred_callback: Callable[..., object] = partial(self._on_received, callback)
        return deferred_callback if command_guard is None else command_guard.tracking_callback(deferred_callback)

    def _subscribe_to(
        self,
        msg_type: Any,
        names: Iterable[str],
        callback: Callable[..., object],
        qos: QoSProfile | int,
        command_guard: CommandGuard | None,
    ) -> None:
        for name in names:
            profile = self._resolve_qos(name, "subscriber", qos)

            def listen(name: str, profile: QoSProfile = profile) -> Endpoint:
                subscription: Subscription[Any] = self._node.create_subscription(msg_type, name, callback, profile)
                self._endpoints.append(subscription)
                if command_guard is not None:
                    command_guard.watch(subscription)
                return subscription

            self._listen(self._node.handle.resolve_topic_name(name), listen)

    def _listen(self, topic: str, listen: Callable[[str], Endpoint]) -> None:
        """Call `listen`, which subscribes to the topic with the given name."""
        listen(topic)

    def _resolve_qos(self, topic: str, side: str, qos: QoSProfile | int) -> QoSProfile:
        """Return the QoS profile of a topic's endpoint.

        Args:
            topic: the topic's name.
            side: ``publisher`` or ``subscriber``.
            qos: a profile, or a depth.
        """
        return QoSProfile.of(qos)

    def _stop_motion(self, stop_motion: Callable[[], bool], publisher: EndpointInfo) -> None:
        if stop_motion():
            self.logger.warning(phrase("{problem}: the motion stops", problem=describe_lost_publisher(publisher)))

    def _pass_if_finite(
        self, callback: Callable[[Any], object], stop_motion: Callable[[], object], topic: str, message: Any
    ) -> None:
        """Call `callback` with a command if all its numbers are finite.

        Otherwise call `stop_motion` and log a warning.
        """
        if _is_finite(message):
            callback(message)
            return
        stop_motion()
        warning = phrase("a command on '{topic}' contains NaN or an infinite number: the motion stops", topic=topic)
        self.logger.warning(warning, throttle_duration_sec=_WARNING_PERIOD_S)

    def _on_received(self, callback: Callable[[Any], object], message: Any) -> None:
        self.post(partial(callback, message))


def _is_finite(message: Any) -> bool:
    """Return whether all floating-point numbers of a message are finite."""
    if isinstance(message, float):
        return isfinite(message)
    if hasattr(message, "get_fields_and_field_types"):
        return all(_is_finite(getattr(message, name)) for name in message.get_fields_and_field_types())
    if isinstance(message, (str, bytes, int)):
        return True
    return all(map(_is_finite, message)) if isinstance(message, Iterable) else True
