"""A node whose callbacks run on the thread of a simulation or of a control loop, between two of its steps."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from math import isfinite
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.graph.endpoints.base import Endpoint, EndpointInfo
from linkwright.graph.endpoints.commander import Commander, describe_lost_publisher
from linkwright.graph.endpoints.drivers import DriverWatch
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.log.logger import Logger
from linkwright.graph.node import Node
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.stepped.calls import Calls, logged_calls
from linkwright.graph.stepped.exchange import Exchange
from linkwright.messages import get_service

_WARN_SECONDS = 1.0


class _Outlet:
    """The publishers of a topic, to which the exchange hands messages; an error ends only their plugin.

    Args:
        output: the topic.
        make: makes a message of the values that are sent; None where messages themselves are.
    """

    __slots__ = ("_make", "_output")

    def __init__(self, output: Output, make: Callable[..., Any] | None = None) -> None:
        self._output = output
        self._make = make

    def publish(self, message: Any) -> None:
        """Publish a message, or the one that is made of values."""
        output, make = self._output, self._make
        try:
            made = message if make is None else make(*message)
            for publisher in output.publishers:
                publisher.publish(made)
        except InvalidHandleError:
            raise  # its model is gone
        except Exception as error:  # noqa: BLE001 - of a message that a plugin made
            output.exchange.post(partial(output.calls.fail, error))


class Output:
    """A topic that a plugin publishes, under one name or two.

    Args:
        exchange: that of the simulation.
        publishers: one for each name.
        calls: those of the plugin.
    """

    def __init__(self, exchange: Exchange, publishers: list[Publisher[Any]], calls: Calls) -> None:
        self.exchange = exchange
        self.publishers = publishers
        self.calls = calls
        self._outlet = _Outlet(self)
        self._asked, self._is_wanted = 0, False

    @property
    def is_wanted(self) -> bool:
        """Whether a subscriber exists; otherwise a costly message need not be made.

        Subscriptions change at any time, on another thread; within one call of a plugin the answer stays the same.
        """
        number = self.calls.number
        if not number:
            return self._has_readers()
        if number != self._asked:
            self._asked, self._is_wanted = number, self._has_readers()
        return self._is_wanted

    def _has_readers(self) -> bool:
        for publisher in self.publishers:  # noqa: SIM110 - `any` takes twice as long, and this is asked all the time
            if publisher.get_subscription_count():
                return True
        return False

    def publish(self, message: Any) -> None:
        """Publish a message, which must not change afterwards."""
        self.exchange.send(self._outlet, message)

    def making(self, make: Callable[..., Any]) -> Callable[..., None]:
        """Return a function that publishes the message which `make` makes of its arguments.

        The message is made where it is published: a simulation with a thread of its own computes on meanwhile.

        Args:
            make: makes a message of values that do not change afterwards.
        """
        outlet = _Outlet(self, make)

        def send(*values: Any) -> None:
            self.exchange.send(outlet, values)

        return send


class SteppedNode:
    """Publishers, subscriptions, services and parameters whose callbacks run between two steps.

    Args:
        node: the node.
        exchange: that of the simulation or of the control loop.
        owned: whether the node ends with this object.
        now_ns: returns the time of the steps, in nanoseconds; by default that of the node's clock.
        calls: calls the callbacks; by default an error of one is logged.

    Attributes:
        calls: calls the callbacks.
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
        self.calls = calls or logged_calls(node.get_logger(), node.get_fully_qualified_name())
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
        """The node itself, for features such as actions: its callbacks run on the event loop."""
        return self._node

    @property
    def exchange(self) -> Exchange:
        """The queues between the thread of the steps and the event loop."""
        return self._exchange

    @property
    def name(self) -> str:
        """The full name of the node."""
        return self._node.get_fully_qualified_name()

    def publisher(self, msg_type: Any, topic: str, qos: QoSProfile | int = 10) -> Output:
        """A topic to publish.

        Args:
            msg_type: the class of its messages, or the name of the type.
            topic: relative, absolute or private name.
            qos: the quality of service; a number is a depth.
        """
        return self._publish_as(msg_type, [topic], qos)

    def subscribe(
        self,
        msg_type: Any,
        topic: str,
        callback: Callable[[Any], object],
        qos: QoSProfile | int = 10,
        *,
        commander: Commander | None = None,
        rest: Callable[[], object] | None = None,
    ) -> None:
        """Subscribe to a topic.

        The arguments are those of `publisher`; for commands that hold until the next one, ``commander`` is one that
        the method of this name gave. ``rest`` is called in place of the callback where a message has NaN or an infinite
        number, which is logged: the world would be unstable with it.
        """
        self._subscribe_to(msg_type, [topic], self._received_by(topic, callback, rest, commander), qos, commander)

    def commander(self, rest: Callable[[], bool]) -> Commander:
        """A watcher of topics whose commands hold until the next one: a lost publisher's command is withdrawn.

        It also warns where several nodes command at the same time.

        Args:
            rest: stops the motion of the last command; returns whether there was one, which is logged.
        """

        def lost(publisher: EndpointInfo) -> None:
            self.post(partial(self._rest, rest, publisher))

        return Commander(lost, DriverWatch(self.logger, self._node.graph, self._now_ns))

    def service(self, srv_type: str, name: str, callback: Callable[[Any, Any], Any]) -> None:
        """Offer a service, whose callback gets the request and an empty response, and returns the response."""
        response = get_service(srv_type).Response

        def asked(request: Any, reply: Callable[[Any], None]) -> None:
            self.post(lambda: reply(callback(request, response())))

        self._endpoints.append(self._node.create_service(srv_type, name, asked, replying=True))

    def post(self, command: Callable[[], object]) -> None:
        """Queue a function to be called between two steps; from any thread."""
        self._exchange.post(partial(self.calls.make, command))

    def parameter(self, name: str, default: Any) -> Any:
        """The value of a parameter of the node, which is declared with a default."""
        if not self._node.has_parameter(name):
            self._node.declare_parameter(name, default)
        return self._node.get_parameter(name).value

    def close(self) -> None:
        """Remove everything that was made from the graph."""
        if self._owned:
            self._node.destroy_node()
        else:
            for endpoint in self._endpoints:
                endpoint.destroy()

    def _publish_as(self, msg_type: Any, names: Iterable[str], qos: QoSProfile | int) -> Output:
        publishers = [
            self._node.create_publisher(msg_type, name, self._profile(name, "publisher", qos)) for name in names
        ]
        self._endpoints += publishers
        return Output(self._exchange, publishers, self.calls)

    def _received_by(
        self,
        topic: str,
        callback: Callable[[Any], object],
        rest: Callable[[], object] | None,
        commander: Commander | None,
    ) -> Callable[..., object]:
        """Return the callback of a subscription, which hands messages to that of the steps."""
        if rest is not None:
            callback = partial(self._sound, callback, rest, topic)
        received: Callable[..., object] = partial(self._received, callback)
        return received if commander is None else commander.accepting(received)

    def _subscribe_to(
        self,
        msg_type: Any,
        names: Iterable[str],
        received: Callable[..., object],
        qos: QoSProfile | int,
        commander: Commander | None,
    ) -> None:
        for name in names:
            profile = self._profile(name, "subscriber", qos)

            def listen(name: str, profile: QoSProfile = profile) -> Endpoint:
                subscription: Subscription[Any] = self._node.create_subscription(msg_type, name, received, profile)
                self._endpoints.append(subscription)
                if commander is not None:
                    commander.watch(subscription)
                return subscription

            self._listen(self._node.handle.resolve_topic_name(name), listen)

    def _listen(self, topic: str, listen: Callable[[str], Endpoint]) -> None:
        """Subscribe to a topic of a full name."""
        listen(topic)

    def _profile(self, topic: str, side: str, qos: QoSProfile | int) -> QoSProfile:
        """Return the quality of service of a topic, for a ``publisher`` or a ``subscriber``."""
        return QoSProfile.of(qos)

    def _rest(self, rest: Callable[[], bool], publisher: EndpointInfo) -> None:
        if rest():
            self.logger.warning(phrase("{who}: the motion stops", who=describe_lost_publisher(publisher)))

    def _sound(self, callback: Callable[[Any], object], rest: Callable[[], object], topic: str, message: Any) -> None:
        """Pass a command on if its numbers are finite; stop otherwise."""
        if _is_finite(message):
            callback(message)
            return
        rest()
        warning = phrase("'{topic}': a command with NaN or an infinite number stops the motion", topic=topic)
        self.logger.warning(warning, throttle_duration_sec=_WARN_SECONDS)

    def _received(self, callback: Callable[[Any], object], message: Any) -> None:
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
