"""Subscriptions, which queue their messages until a dispatcher runs the callback."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from functools import partial
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo, TopicEndpoint
from linkwright.graph.loop.dispatcher import Entity, accepts
from linkwright.graph.loop.node_handle import CallbackGroup, Dispatcher, NodeHandle
from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import deserialize, serialize

if TYPE_CHECKING:
    from linkwright.graph.endpoints.content_filter import ContentFilter, ContentFilterOptions
    from linkwright.graph.endpoints.endpoint_events import SubscriptionEvents
    from linkwright.graph.endpoints.event_types import EventHandler, SubscriptionEventCallbacks

M = TypeVar("M")


@dataclass(slots=True)
class QueuedMessage:
    """A queued message with its metadata.

    Attributes:
        message: the message, or its CDR bytes.
        info: the publisher and times of the message.
        expires_ns: the steady time at which the message's lifespan ends, in nanoseconds; None for no lifespan.
    """

    message: Any
    info: MessageInfo | None = None
    expires_ns: int | None = None


class CallbackType(Enum):
    """The arguments that a callback accepts (rclpy ``Subscription.CallbackType``)."""

    MessageOnly = 0
    WithMessageInfo = 1


class Subscription(TopicEndpoint[M], Entity):
    """A subscription to the messages of a topic (rclpy ``Subscription``).

    ``Node.create_subscription`` creates subscriptions.

    Messages are queued. The length of the queue follows from the QoS history and depth. When the queue is full, the
    oldest message is dropped.
    """

    kind = EndpointKind.SUBSCRIPTION
    CallbackType = CallbackType

    def __init__(
        self,
        node: NodeHandle,
        msg_type: type[M] | str,
        topic_name: str,
        qos_profile: QoSProfile,
        callback: Callable[..., object],
        callback_group: CallbackGroup | None = None,
        *,
        raw: bool = False,
        event_callbacks: SubscriptionEventCallbacks | None = None,
    ) -> None:
        Entity.__init__(self, node, callback_group)
        self._describe(node, msg_type, topic_name, qos_profile)
        self.raw = raw
        self.malformed_count = 0
        """The number of messages that could not be deserialized."""
        self._waiting: deque[Any] = deque(maxlen=qos_profile.queue_length)
        self._plain_type: type | None = None
        self._wants_info = False
        self.callback = callback
        self.event_callbacks = event_callbacks
        self.events: SubscriptionEvents | None = None
        if event_callbacks is not None:
            from linkwright.graph.endpoints.endpoint_events import SubscriptionEvents  # few subscriptions use events

            self.events = SubscriptionEvents(self, event_callbacks)
        self._publishers: dict[TopicEndpoint[Any], None] = {}
        self._filter: ContentFilter | None = None
        self._on_lost: Callable[[EndpointInfo], object] | None = None
        self._lost_publishers: deque[EndpointInfo] = deque()
        self._is_batched = False

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return f"callback of topic '{self.name}'"

    @property
    def callback(self) -> Callable[..., object]:
        """The callback.

        It is called with the message, and with a `MessageInfo` if it accepts two arguments.

        Raises:
            RuntimeError: the callback accepts neither one nor two arguments.
        """
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., object]) -> None:
        if accepts(callback, 1, unknown=True):
            self._wants_info = False
        elif accepts(callback, 2, unknown=False):
            self._wants_info = True
        else:
            raise RuntimeError(
                "Subscription.__init__(): callback should be either be callable with one argument (to get only the "
                "message) or two (to get message and message info)"
            )
        self._callback = callback
        self._plain_type = None

    @property
    def _callback_type(self) -> Enum:
        return CallbackType.WithMessageInfo if self._wants_info else CallbackType.MessageOnly

    @property
    def event_handlers(self) -> list[EventHandler]:
        """The subscription's event handlers, including handlers that only log."""
        from linkwright.graph.endpoints.event_types import SubscriptionEventCallbacks

        return (self.event_callbacks or SubscriptionEventCallbacks()).handlers()

    def get_publisher_count(self) -> int:
        """Return the number of matching publishers, in this process and others."""
        return len(self._publishers) + self._remote_count

    @property
    def is_cft_enabled(self) -> bool:
        """Whether a content filter is set."""
        return self._filter is not None

    def get_content_filter(self) -> ContentFilterOptions:
        """Return the current content filter.

        Without a filter, the result has an empty expression.
        """
        from linkwright.graph.endpoints.content_filter import ContentFilterOptions

        return ContentFilterOptions("") if self._filter is None else self._filter.options

    def set_content_filter(self, filter_expression: str, expression_parameters: Sequence[str] = ()) -> None:
        """Receive only messages that meet a condition, from now on (rclpy ``set_content_filter``).

        Args:
            filter_expression: the condition, see `ContentFilter`; an empty one removes the filter.
            expression_parameters: the values of ``%0``, ``%1``, ... in the condition.

        Raises:
            ContentFilterError: the condition cannot be parsed, or names a field or parameter that does not exist.
        """
        from linkwright.graph.endpoints.content_filter import ContentFilter, ContentFilterOptions

        options = ContentFilterOptions(filter_expression, list(expression_parameters))
        self._filter = ContentFilter(options, self.msg_type) if filter_expression.strip() else None

    def watch_lost(self, callback: Callable[[EndpointInfo], object]) -> None:
        """Register a callback for lost publishers of other processes.

        The callback runs in the same way as the subscription's callback. A publisher is lost when its process was
        killed, crashed or is out of reach. Messages of the lost publisher are delivered first.
        """
        self._on_lost = callback
        self.node.graph.watch_lost()

    def queue_lost_publisher(self, publisher: EndpointInfo) -> None:
        """Queue the notification that a publisher of another process is lost.

        The graph calls this, from any thread.
        """
        if self._on_lost is not None:
            self._lost_publishers.append(publisher)
            self.announce()

    def deliver_in_batches(self) -> None:
        """Pass all queued messages to the callback in a single dispatched call, from now on.

        The callback is still called once per message. Batches are meant for short callbacks that receive many messages,
        such as transforms: with one message per dispatched call, a busy loop would lag behind by the length of the
        queue.
        """
        self._is_batched = True

    def set_remote_liveliness(self, alive: int, not_alive: int) -> None:
        """Set the numbers of matching publishers in other processes that are alive and not alive.

        The transport calls this.
        """
        if self.events is not None:
            self.events.set_remote_liveliness(alive, not_alive)

    def count_lost_remote(self, count: int) -> None:
        """Count lost messages from other processes.

        The transport calls this method.
        """
        if self.events is not None:
            self.events.count_lost(count)

    def receive(self, message: M | bytes | QueuedMessage, info: MessageInfo | None = None) -> None:
        """Queue a message for the callback, from any thread.

        Args:
            message: the message, or its CDR bytes, which are deserialized just before the callback is called.
            info: the message's metadata; required for messages of other processes.
        """
        message_filter = self.node.message_filter
        if message_filter is None or message_filter(self, message):
            self.enqueue(message, info)

    def enqueue(self, message: M | bytes | QueuedMessage, info: MessageInfo | None = None) -> None:
        """Queue a message for the callback, bypassing the node's `message_filter`. See `receive`."""
        if self._filter is not None and not self._passes_filter(message, self._filter):
            return
        if self.events is not None:
            self.events.record_message()
        self._waiting.append(message if info is None else QueuedMessage(message, info))
        if not self._announced:
            dispatcher = self.dispatcher
            if dispatcher is not None:
                self._announced = True
                dispatcher.ready(self)

    def make_receiver(self, publisher: TopicEndpoint[Any], lifespan_ns: int | None) -> Callable[[Any], None]:
        """Return the function that a publisher of this process calls with each message.

        Args:
            publisher: the publisher.
            lifespan_ns: the lifespan of the publisher's messages, in nanoseconds; None for no limit.
        """
        if not self._wants_info and lifespan_ns is None and self.events is None:
            return self.receive

        def receive(message: Any) -> None:
            info = None
            if self._wants_info:
                now_ns = self.node.timebase.now_ns()
                info = MessageInfo(now_ns, now_ns, publisher.gid)
            expires_ns = None if lifespan_ns is None else self.node.timebase.steady_ns() + lifespan_ns
            if self.events is not None and len(self._waiting) == self._waiting.maxlen:
                self.events.count_lost(1)
            self.receive(QueuedMessage(message, info, expires_ns))

        return receive

    def add_publisher(self, publisher: TopicEndpoint[Any]) -> None:
        """Record that a publisher of this process was connected.

        The publisher calls this method.
        """
        self._publishers[publisher] = None
        if self.events is not None:
            self.events.on_match_change(1)
            self.events.on_liveliness_change(int(publisher.is_alive), int(not publisher.is_alive))

    def remove_publisher(self, publisher: TopicEndpoint[Any]) -> None:
        """Record that a publisher of this process was disconnected.

        The publisher calls this method.
        """
        if self._publishers.pop(publisher, self) is None and self.events is not None:
            self.events.on_match_change(-1)
            self.events.on_liveliness_change(-int(publisher.is_alive), -int(not publisher.is_alive))

    def has_work(self) -> bool:
        """Return whether messages or notifications of lost publishers are queued."""
        return bool(self._waiting or self._lost_publishers)

    def take(self) -> Callable[[], object] | None:
        """Remove the oldest message from the queue and return the call of its callback.

        When no messages are left, the notification of a lost publisher is next. Returns None if there is nothing to
        call.
        """
        self._announced = False
        queue = self._waiting
        try:
            message = queue.popleft()
        except IndexError:
            return self._take_lost_publisher()
        further_messages = [queue.popleft() for _ in range(len(queue))] if self._is_batched else ()
        if queue or self._lost_publishers:
            self.announce()
        return (
            partial(self._call_for_each, [message, *further_messages]) if further_messages else self._call_for(message)
        )

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the callbacks."""
        super().set_dispatcher(dispatcher)
        if self.events is not None:
            self.events.set_dispatcher(dispatcher)

    def discard(self) -> None:
        """Drop the queued messages."""
        self._waiting.clear()
        self._lost_publishers.clear()

    def retire(self) -> None:
        """Stop calling callbacks, and drop the queued messages."""
        super().retire()
        self.discard()
        if self.events is not None:
            self.events.retire()

    def _take_lost_publisher(self) -> Callable[[], object] | None:
        publisher = self._take_from(self._lost_publishers)
        return None if publisher is None or self._on_lost is None else partial(self._on_lost, publisher)

    def _call_for_each(self, items: list[Any]) -> None:
        for item in items:
            call = self._call_for(item)
            if call is not None:
                call()

    def _call_for(self, item: Any) -> Callable[[], object] | None:
        if type(item) is self._plain_type:
            return partial(self._callback, item)
        return self._prepare_call(item)

    def _prepare_call(self, item: Any) -> Callable[[], object] | None:
        """Return the call of the callback for CDR bytes or for a message with metadata.

        Returns None if there is nothing to call, for example because the message has expired.
        """
        if type(item) is bytes and not self._wants_info and not self.raw:
            message = self._decode(item)
            return None if message is None else partial(self._callback, message)
        queued_message = item if type(item) is QueuedMessage else QueuedMessage(item)
        if queued_message.expires_ns is not None and self.node.timebase.steady_ns() > queued_message.expires_ns:
            return None
        message = queued_message.message
        if self.raw:
            message = self._serialize(message)
        elif isinstance(message, (bytes, bytearray, memoryview)):
            message = self._decode(message)
            if message is None:
                return None
        elif item is message and not self._wants_info:
            self._plain_type = type(message)
        if self._wants_info:
            return partial(self._callback, message, queued_message.info or MessageInfo(time.time_ns(), time.time_ns()))
        return partial(self._callback, message)

    def _serialize(self, message: Any) -> bytes:
        if isinstance(message, bytes):
            return message
        return serialize(message)

    def _passes_filter(self, message: Any, content_filter: ContentFilter) -> bool:
        """Return whether the content filter accepts a message.

        A message that cannot be decoded is accepted here; the error is reported later.
        """
        payload = message.message if type(message) is QueuedMessage else message
        if isinstance(payload, (bytes, bytearray, memoryview)):
            try:
                payload = deserialize(payload, self.msg_type)
            except LinkwrightError:
                return True
        return content_filter.accepts(payload)

    def _decode(self, data: bytes | bytearray | memoryview) -> Any:
        """Decode a message.

        If that fails, log the error once and return None.
        """
        try:
            return deserialize(data, self.msg_type)
        except LinkwrightError as error:
            self._log_decoding_error(error)
            return None

    def _log_decoding_error(self, error: LinkwrightError) -> None:
        self.malformed_count += 1
        if self.malformed_count == 1:
            self.node.logger.warning(f"Dropped a malformed message of topic '{self.name}': {error}")
