"""Publishers, which pass messages to subscriptions of this process and to the transport."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.graph.endpoints.base import EndpointKind, TopicEndpoint
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.log.logger import run_logged
from linkwright.graph.loop.node_handle import CallbackGroup, NodeHandle
from linkwright.graph.qos.compatibility import limit_ns
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.graph.time.values import Duration
from linkwright.messages import serialize

if TYPE_CHECKING:
    from linkwright.graph.endpoints.endpoint_events import PublisherEvents
    from linkwright.graph.endpoints.event_types import EventHandler, PublisherEventCallbacks

M = TypeVar("M")


class Publisher(TopicEndpoint[M]):
    """A publisher of messages on a topic, usable from any thread (rclpy ``Publisher``).

    ``Node.create_publisher`` creates publishers.

    Inside the process a message is not copied: after publishing, neither the publisher nor the receivers may change the
    message. If a node may change its messages (`NodeHandle.copies_messages`), each message is serialized when it is
    published, and deserialized for each subscription.
    """

    kind = EndpointKind.PUBLISHER
    goes_last = True

    def __init__(
        self,
        node: NodeHandle,
        msg_type: type[M] | str,
        topic_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup | None = None,
        *,
        event_callbacks: PublisherEventCallbacks | None = None,
    ) -> None:
        self._describe(node, msg_type, topic_name, qos_profile)
        self.callback_group = node.default_callback_group if callback_group is None else callback_group
        self.event_callbacks = event_callbacks
        self.events: PublisherEvents | None = None
        self.send_remote: Callable[[Any], None] | None = None
        """Sends messages to other processes, or None if there is no match. See `set_remote_sender`."""
        self.assert_remote_liveliness: Callable[[], None] | None = None
        """Asserts the publisher's liveliness in other processes, set by the transport."""
        self.lifespan_ns = limit_ns(qos_profile.lifespan)
        self._wait_until_acknowledged: Callable[[float | None], bool] | None = None
        self._accepted_type: Any = None
        self._receivers_by_subscription: dict[Subscription[Any], Callable[[Any], None]] = {}
        self._receivers: tuple[Callable[[Any], None], ...] = ()
        self._lock = threading.RLock()
        is_transient_local = qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._late_joiner_messages: deque[tuple[int, Any]] | None = (
            deque(maxlen=qos_profile.queue_length) if is_transient_local else None
        )
        self._held_messages: deque[Any] | None = None
        self._wait_until_sent: Callable[[float | None], bool] = lambda _: True
        self._copies_messages = node.copies_messages
        self._is_plain = not is_transient_local and not self._copies_messages
        if event_callbacks is not None:
            from linkwright.graph.endpoints.endpoint_events import PublisherEvents  # few publishers use events

            self.events = PublisherEvents(self, event_callbacks, self._on_liveliness_change)
            self._is_plain = self._is_plain and not self.events.wants_messages

    def publish(self, msg: M | bytes) -> None:
        """Send a message to all matching subscriptions, in the order of their creation.

        The callbacks of the subscriptions run later.

        Args:
            msg: the message, or its CDR bytes including the header.

        Raises:
            TypeError: the message is not of the publisher's type.
            InvalidHandleError: the publisher was destroyed.
            RclError: a signal has shut down the context.
        """
        if type(msg) is not self._accepted_type:
            self._check(msg)
        if self._is_plain:
            for receive in self._receivers:
                receive(msg)
            send_remote = self.send_remote
            if send_remote is not None:
                send_remote(msg)
        else:
            self._publish_complete(msg)

    @property
    def event_handlers(self) -> list[EventHandler]:
        """The publisher's event handlers, including handlers that only log."""
        from linkwright.graph.endpoints.event_types import PublisherEventCallbacks

        return (self.event_callbacks or PublisherEventCallbacks()).handlers()

    def get_subscription_count(self) -> int:
        """Return the number of matching subscriptions, in this process and others."""
        return len(self._receivers_by_subscription) + self._remote_count

    def assert_liveliness(self) -> None:
        """Assert that the publisher is alive, as the liveliness policy MANUAL_BY_TOPIC requires.

        Raises:
            InvalidHandleError: the publisher was destroyed.
        """
        self.check_alive()
        if self.events is not None:
            self.events.assert_liveliness()
        if self.assert_remote_liveliness is not None:
            self.assert_remote_liveliness()

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Block until all reliable subscriptions have acknowledged the published messages.

        Subscriptions of this process need no acknowledgment, because they receive messages immediately.

        Args:
            timeout: the maximum wait; negative or None for no limit.

        Returns:
            Whether all have acknowledged; False after the timeout.
        """
        seconds = None if timeout is None or timeout.nanoseconds < 0 else timeout.nanoseconds / 1e9
        if self._held_messages and not self._wait_until_sent(seconds):
            return False
        return self._wait_until_acknowledged is None or self._wait_until_acknowledged(seconds)

    # --- for the bus and the transport ----------------------------------------------------------------------------

    def connect(self, subscription: Subscription[Any]) -> None:
        """Connect a subscription of this process.

        A transient local subscription first receives the messages stored for late joiners.
        """
        receive = subscription.make_receiver(self, self.lifespan_ns)
        with self._lock:
            if self._late_joiner_messages and subscription.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
                for message in self._remove_expired_messages():
                    receive(message)
            self._receivers_by_subscription[subscription] = receive
            self._receivers = tuple(self._receivers_by_subscription.values())
        subscription.add_publisher(self)
        if self.events is not None:
            self.events.on_match_change(1)

    def disconnect(self, subscription: Subscription[Any]) -> None:
        """Disconnect a subscription of this process."""
        with self._lock:
            if self._receivers_by_subscription.pop(subscription, None) is None:
                return
            self._receivers = tuple(self._receivers_by_subscription.values())
        subscription.remove_publisher(self)
        if self.events is not None:
            self.events.on_match_change(-1)

    def begin(self) -> None:
        """Set up the publisher's events, then add the publisher to the graph."""
        if self.events is not None:
            self.node.add(self.events)
        super().begin()

    def retire(self) -> None:
        """Remove the publisher from the graph, and disconnect its subscriptions."""
        if self.events is not None:
            self.node.remove(self.events)
        super().retire()
        self._accepted_type = None
        for subscription in tuple(self._receivers_by_subscription):
            self.disconnect(subscription)
        self.send_remote = None

    def local_subscriptions(self) -> tuple[Subscription[Any], ...]:
        """Return the subscriptions of this process that are connected to the publisher."""
        return tuple(self._receivers_by_subscription)

    def hold_for_remote(self, wait_until_sent: Callable[[float | None], bool]) -> None:
        """Hold messages for other processes until `set_remote_sender` is called.

        The transport calls both, in this order. In ROS 2, a discovered subscription receives all messages of a
        publisher, including the first. The transport creates the writer in its own thread, shortly after the publisher
        is created. Messages that are published before are therefore held.

        Args:
            wait_until_sent: waits until `set_remote_sender` was called, for at most the given seconds (None for no
                limit); returns whether it was called.
        """
        with self._lock:
            if self._late_joiner_messages is None and self.send_remote is None:
                self._wait_until_sent = wait_until_sent
                self._held_messages = deque(maxlen=self.qos_profile.queue_length)
                self.send_remote = self._hold

    def _hold(self, message: Any) -> None:
        """Hold a message, or send it if another thread has called `set_remote_sender` meanwhile."""
        with self._lock:
            if self._held_messages is not None:
                self._held_messages.append(message)
                return
            send = self.send_remote
        if send is not None:
            send(message)

    def set_remote_sender(
        self,
        send: Callable[[Any], None] | None,
        wait_until_acknowledged: Callable[[float | None], bool] | None = None,
    ) -> None:
        """Set or clear the function that sends messages to other processes.

        The transport calls this method.

        Messages that are held or stored for late joiners are sent first. No message is lost or sent twice.

        Args:
            send: called in the publishing thread with each message, or its CDR bytes if those were published; None
                to send nothing.
            wait_until_acknowledged: waits until all readers have acknowledged, for at most the given seconds (None for
                no limit); returns whether they have.
        """
        with self._lock:
            if send is not None:
                if self._held_messages is not None:
                    messages: Iterator[Any] = _take_all(self._held_messages)
                else:
                    messages = iter(self._remove_expired_messages() if self.send_remote is None else ())
                for message in messages:
                    operation = f"sending the messages of topic '{self.name}'"
                    run_logged(self.node.logger, operation, partial(send, message))  # `publish` has returned: just log
            self._held_messages = None
            self.send_remote = send
            self._wait_until_acknowledged = wait_until_acknowledged if send is not None else None

    def _publish_complete(self, message: Any) -> None:
        self.node.check_valid()
        if self._copies_messages and type(message) is not bytes:
            if (
                not self._receivers
                and self._late_joiner_messages is None
                and self.send_remote is None
                and self.events is None
            ):
                return
            message = bytes(message) if isinstance(message, bytearray) else serialize(message)
        with self._lock:
            if self._late_joiner_messages is not None:
                self._late_joiner_messages.append((self.node.timebase.steady_ns(), message))
            if self.events is not None:
                self.events.record_publication()
            for receive in self._receivers:
                receive(message)
            if self.send_remote is not None:
                self.send_remote(message)

    def _on_liveliness_change(self, change: int) -> None:
        self.is_alive = change > 0
        for subscription in self.local_subscriptions():
            if subscription.events is not None:
                subscription.events.on_liveliness_change(change, -change)

    def _remove_expired_messages(self) -> list[Any]:
        """Remove the expired messages that are stored for late joiners, and return the others."""
        if not self._late_joiner_messages:
            return []
        if self.lifespan_ns is not None:
            oldest_ns = self.node.timebase.steady_ns() - self.lifespan_ns
            while self._late_joiner_messages and self._late_joiner_messages[0][0] < oldest_ns:
                self._late_joiner_messages.popleft()
        return [message for _, message in self._late_joiner_messages]

    def _check(self, message: Any) -> None:
        self.check_alive()
        if isinstance(message, (bytes, bytearray)):
            return
        if isinstance(message, self.msg_type) or getattr(message, "TYPE_NAME", None) == self.type_name:
            self._accepted_type = type(message)
            return
        raise TypeError(
            f"Expected {self.msg_type}, got {type(message)}: topic '{self.name}' carries {self.type_name}, "
            f"not {type(message).__name__}"
        )


def _take_all(messages: deque[Any]) -> Iterator[Any]:
    """Remove and yield messages until there are none, also those that are added meanwhile."""
    while messages:
        yield messages.popleft()
