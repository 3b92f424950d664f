"""Sends messages to a topic."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.graph.endpoint import TopicEndpoint
from linkwright.graph.events import EventHandler, PublisherEventCallbacks
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile
from linkwright.graph.qos_compatibility import limit_ns
from linkwright.graph.subscription import Subscription
from linkwright.graph.time import Duration
from linkwright.graph.transport import EndpointKind
from linkwright.messages import serialize

if TYPE_CHECKING:
    from linkwright.graph.dispatch import CallbackGroup
    from linkwright.graph.endpoint_events import PublisherEvents
    from linkwright.graph.node import Node

M = TypeVar("M")


class Publisher(TopicEndpoint[M]):
    """Sends messages to a topic; made by ``Node.create_publisher``. It may publish from any thread.

    In the process a message is handed over as it is: who publishes one does not change it afterwards, nor does who
    receives it. Nodes with `copies_messages` may: what they publish is written at once, and read by each receiver.
    """

    kind = EndpointKind.PUBLISHER

    def __init__(
        self,
        node: Node,
        msg_type: type[M] | str,
        topic_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup | None = None,
        *,
        event_callbacks: PublisherEventCallbacks | None = None,
    ) -> None:
        self._describe(node, msg_type, topic_name, qos_profile)
        self.callback_group = callback_group
        self.event_callbacks = event_callbacks
        self.events: PublisherEvents | None = None
        self.destroyed = False
        self.outside: Callable[[Any], None] | None = None
        """What takes messages out of the process, while somebody there matches; see `set_outside`."""
        self.assert_outside: Callable[[], None] | None = None
        """For the transport: shows outside of the process that the publisher lives."""
        self.lifespan_ns = limit_ns(qos_profile.lifespan)
        self._acknowledged: Callable[[float | None], bool] | None = None
        self._accepted: Any = None
        self._matched: dict[Subscription[Any], Callable[[Any], None]] = {}
        self._receivers: tuple[Callable[[Any], None], ...] = ()
        self._lock = threading.RLock()
        keeps = qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._kept: deque[tuple[int, Any]] | None = deque(maxlen=qos_profile.queue_length) if keeps else None
        self._held: deque[Any] | None = None
        self._sent: Callable[[float | None], bool] = lambda _: True
        self._copies = node.copies_messages
        self._is_plain = not keeps and not self._copies

    def publish(self, msg: M | bytes) -> None:
        """Send a message to every matching subscription, in their order of creation; callbacks run later.

        Args:
            msg: the message, or its CDR bytes with their header.

        Raises:
            TypeError: the message is not of the publisher's type.
            InvalidHandleError: the publisher was destroyed.
        """
        if type(msg) is not self._accepted:
            self._check(msg)
        if self._is_plain:
            for receive in self._receivers:
                receive(msg)
            outside = self.outside
            if outside is not None:
                outside(msg)
        else:
            self._publish_watched(msg)

    @property
    def event_handlers(self) -> list[EventHandler]:
        """What is told of its quality of service: what has a callback, and what the log tells where nothing has."""
        return (self.event_callbacks or PublisherEventCallbacks()).handlers()

    def get_subscription_count(self) -> int:
        """How many subscriptions receive what is published, inside the process and outside."""
        return len(self._matched) + self._outside_count

    def assert_liveliness(self) -> None:
        """Show that the publisher lives, where liveliness is MANUAL_BY_TOPIC.

        Raises:
            InvalidHandleError: the publisher was destroyed.
        """
        self._check_alive()
        if self.events is not None:
            self.events.assert_liveliness()
        if self.assert_outside is not None:
            self.assert_outside()

    def wait_for_all_acked(self, timeout: Duration | None = None) -> bool:
        """Block until everybody outside has what was sent reliably; in the process that is at once.

        Args:
            timeout: how long at most; negative or None for as long as it takes.

        Returns:
            Whether they have.
        """
        seconds = None if timeout is None or timeout.nanoseconds < 0 else timeout.nanoseconds / 1e9
        if self._held and not self._sent(seconds):
            return False
        return self._acknowledged is None or self._acknowledged(seconds)

    def destroy(self) -> None:
        """Leave the topic and the node; what was sent is still delivered."""
        self.node.destroy_publisher(self)

    # --- for the bus and the transport ----------------------------------------------------------------------------

    def connect(self, subscription: Subscription[Any]) -> None:
        """Send to a subscription from now on, and what was kept for late comers, if it wants that, first."""
        receive = subscription.receiver(self)
        with self._lock:
            if self._kept and subscription.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
                for message in self._still_valid():
                    receive(message)
            self._matched[subscription] = receive
            self._receivers = tuple(self._matched.values())
        subscription.connected(self)
        if self.events is not None:
            self.events.matched(1)

    def disconnect(self, subscription: Subscription[Any]) -> None:
        """Send to a subscription no longer."""
        with self._lock:
            if self._matched.pop(subscription, None) is None:
                return
            self._receivers = tuple(self._matched.values())
        subscription.disconnected(self)
        if self.events is not None:
            self.events.matched(-1)

    def retire(self) -> None:
        """Send to nobody any longer."""
        self.destroyed = True
        self._accepted = None
        for subscription in tuple(self._matched):
            self.disconnect(subscription)
        self.outside = None
        if self.events is not None:
            self.events.retire()

    def matched(self) -> tuple[Subscription[Any], ...]:
        """The subscriptions of this process that receive what is published."""
        return tuple(self._matched)

    def watch(self) -> None:
        """Tell `events` of every message from now on."""
        self._is_plain = False

    def hold_for_outside(self, sent: Callable[[float | None], bool]) -> None:
        """For the transport, which will call `set_outside` soon: keep what is published until then.

        A writer takes a moment to be made. Who listens outside may be known already, and gets under ROS what is
        published as soon as there is a publisher.

        Args:
            sent: waits, for so many seconds at most (None for any time), until that was called; whether it was.
        """
        with self._lock:
            if self._kept is None and self.outside is None:
                self._sent = sent
                self._held = deque(maxlen=self.qos_profile.queue_length)
                self.outside = self._held.append

    def set_outside(
        self,
        send: Callable[[Any], None] | None,
        acknowledged: Callable[[float | None], bool] | None = None,
    ) -> None:
        """For the transport: have messages taken out of the process, or no longer.

        What is held, or kept for late comers, is sent first, so that nothing is lost and nothing comes twice.

        Args:
            send: called with each message, or with its CDR bytes where it was published so, in the thread that
                publishes.
            acknowledged: waits, for so many seconds at most (None for any time), until everybody has what was sent,
                and says whether they have.
        """
        with self._lock:
            held, self._held = self._held, None
            if send is not None and (self.outside is None or held is not None):
                for message in self._still_valid() if held is None else held:
                    send(message)
            self.outside = send
            self._acknowledged = acknowledged if send is not None else None

    @property
    def is_manually_alive(self) -> bool:
        """Whether it has to show by itself that it lives."""
        return self.qos_profile.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC

    def _publish_watched(self, message: Any) -> None:
        if self._copies and type(message) is not bytes:
            if not self._receivers and self._kept is None and self.outside is None and self.events is None:
                return
            message = bytes(message) if isinstance(message, bytearray) else serialize(message)
        with self._lock:
            if self._kept is not None:
                self._kept.append((self.node.timebase.steady_ns(), message))
            if self.events is not None:
                self.events.published()
            for receive in self._receivers:
                receive(message)
            if self.outside is not None:
                self.outside(message)

    def _still_valid(self) -> list[Any]:
        """What is kept for late comers, without what has outlived its lifespan."""
        if not self._kept:
            return []
        if self.lifespan_ns is not None:
            oldest_ns = self.node.timebase.steady_ns() - self.lifespan_ns
            while self._kept and self._kept[0][0] < oldest_ns:
                self._kept.popleft()
        return [message for _, message in self._kept]

    def _check_alive(self) -> None:
        if self.destroyed:
            raise InvalidHandleError

    def _check(self, message: Any) -> None:
        self._check_alive()
        if isinstance(message, (bytes, bytearray)):
            return
        if isinstance(message, self.msg_type) or getattr(message, "TYPE_NAME", None) == self.type_name:
            self._accepted = type(message)
            return
        raise TypeError(
            f"Expected {self.msg_type}, got {type(message)}: topic '{self.name}' carries {self.type_name}, "
            f"not {type(message).__name__}"
        )
