"""Services and clients.

Requests are queued until a dispatcher runs the callback, which returns the response.
"""

from __future__ import annotations

import itertools
import threading
from collections import deque
from collections.abc import Awaitable, Callable
from enum import IntEnum
from functools import partial
from inspect import isawaitable
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.base import EndpointKind, ServiceEndpoint
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.loop.dispatcher import Entity
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.node_handle import CallbackGroup, NodeHandle
from linkwright.graph.qos.compatibility import resolve_best_available
from linkwright.graph.qos.profile import QoSProfile
from linkwright.graph.time.clock import Clock
from linkwright.messages import deserialize, get_message, serialize

EVENT_TOPIC_SUFFIX = "/_service_event"
"""The suffix that is appended to a service's name to get the name of its event topic."""


class ServiceIntrospectionState(IntEnum):
    """The levels of service introspection, with rclpy's numbers and names."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2


class EventType(IntEnum):
    """The kinds of service events (``service_msgs/msg/ServiceEventInfo``)."""

    REQUEST_SENT = 0
    REQUEST_RECEIVED = 1
    RESPONSE_SENT = 2
    RESPONSE_RECEIVED = 3


class RequestId(NamedTuple):
    """The identifier of a request: its client and its sequence number.

    Attributes:
        client_gid: the GID of the client, 16 bytes.
        sequence_number: the request's sequence number, counted by the client from 1.
    """

    client_gid: bytes
    sequence_number: int


NO_REQUEST_ID = RequestId(bytes(16), 0)


class ServiceEvents:
    """A publisher of introspection events for the requests of a client or service.

    Args:
        endpoint: the client or service, whose node owns the publisher.
        clock: stamps the events.
        qos_profile: the QoS of the publisher.
        contents: whether the events include requests and responses.
    """

    def __init__(self, endpoint: ServiceEndpoint, clock: Clock, qos_profile: QoSProfile, *, contents: bool) -> None:
        self.clock = clock
        self.contents = contents
        self._event_class: Any = endpoint.interface.Event
        self._info_class: Any = get_message("service_msgs/msg/ServiceEventInfo")
        node = endpoint.node
        name = node.resolve_topic_name(endpoint.name + EVENT_TOPIC_SUFFIX)
        qos = resolve_best_available(QoSProfile.of(qos_profile), (), is_publisher=True)
        self._publisher: Publisher[Any] = node.add(Publisher(node, self._event_class, name, qos))

    def publish_event(
        self, event_type: EventType, request_id: RequestId, *, request: Any = None, response: Any = None
    ) -> None:
        """Publish an event, including its request or response if contents are enabled."""
        info = self._info_class(
            event_type=int(event_type),
            stamp=self.clock.now().to_msg(),
            client_gid=list(request_id.client_gid),
            sequence_number=request_id.sequence_number,
        )
        event = self._event_class(info=info)
        if self.contents:
            event.request = [] if request is None else [request]
            event.response = [] if response is None else [response]
        self._publisher.publish(event)

    def close(self) -> None:
        """Destroy the publisher of the events."""
        self._publisher.destroy()


class IntrospectedEndpoint(ServiceEndpoint):
    """A client or service whose requests can be introspected.

    Attributes:
        service_events: publishes the events; None while introspection is off, which is the default.
    """

    service_events: ServiceEvents | None = None

    def configure_introspection(
        self, clock: Clock, service_event_qos_profile: QoSProfile, introspection_state: ServiceIntrospectionState
    ) -> None:
        """Start or stop publishing the events of requests on ``SERVICE/_service_event``.

        Args:
            clock: stamps the events.
            service_event_qos_profile: the QoS of the publisher; an existing publisher keeps its QoS.
            introspection_state: whether events are published, and whether they include requests and responses.

        Raises:
            InvalidHandleError: the client or service was destroyed.
        """
        self.check_alive()
        state = ServiceIntrospectionState(introspection_state)
        events = self.service_events
        if state is ServiceIntrospectionState.OFF:
            self.end_introspection()
        elif events is None:
            contents = state is ServiceIntrospectionState.CONTENTS
            self.service_events = ServiceEvents(self, clock, service_event_qos_profile, contents=contents)
        else:
            events.clock = clock
            events.contents = state is ServiceIntrospectionState.CONTENTS

    def end_introspection(self) -> None:
        """Stop publishing events."""
        events, self.service_events = self.service_events, None
        if events is not None:
            events.close()


Request = TypeVar("Request")
Response = TypeVar("Response")

Reply = Callable[[Any], None]
"""Sends the response to the client, called once, from any thread."""

_NO_REQUESTS: deque[Any] = deque(maxlen=0)


class Service(IntrospectedEndpoint, Entity, Generic[Request, Response]):
    """A service server, which answers requests (rclpy ``Service``).

    ``Node.create_service`` creates services.

    Args:
        callback: a function or coroutine function that is called with the request and an empty response, and returns
            the response.
        replying: whether the callback receives, instead of the empty response, a function that sends the response and
            may be called later.
        raw: whether requests and responses are bytes (CDR with its header), which requires `replying`.
    """

    kind = EndpointKind.SERVICE

    _waiting: deque[tuple[Request, Reply, RequestId]] = _NO_REQUESTS
    """The queue of requests. It is created with the first request, because an empty queue takes 700 bytes and each node
    has six parameter services, which are rarely called."""

    def __init__(
        self,
        node: NodeHandle,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback: Callable[[Request, Response], Response | Awaitable[Response]],
        callback_group: CallbackGroup | None = None,
        *,
        replying: bool = False,
        raw: bool = False,
    ) -> None:
        Entity.__init__(self, node, callback_group)
        self._describe(node, srv_type, srv_name, qos_profile)
        self.callback: Callable[[Any, Any], Any] = callback
        self._replying = replying
        self.raw = raw

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return f"callback of service '{self.name}'"

    def receive(self, request: Request, reply: Reply, request_id: RequestId = NO_REQUEST_ID) -> None:
        """Queue a request for the callback, from any thread.

        Args:
            request: the request.
            reply: called with the response, from any thread, or never.
            request_id: the request's client and sequence number, for service introspection.
        """
        if self._waiting is _NO_REQUESTS:
            vars(self).setdefault("_waiting", deque(maxlen=self.qos_profile.queue_length))  # `setdefault` is atomic
        self._waiting.append((request, reply, request_id))
        self.announce()

    def has_work(self) -> bool:
        """Return whether requests are queued."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """Remove the oldest request from the queue and return the call that answers it.

        Returns None if the queue is empty.
        """
        entry = self._take_from(self._waiting)
        return None if entry is None else partial(self._answer, *entry)

    def send_response(self, response: Response, header: Reply) -> None:
        """Send a response.

        Args:
            response: the response.
            header: the reply callable that was received with the request; it replaces rclpy's request header.

        Raises:
            TypeError: the response is not of the service's type.
        """
        self.check_message(response, "Response")
        header(deep_copy(response) if self.node.copies_messages else response)

    def retire(self) -> None:
        """Remove the service from the graph, and drop queued requests without a response."""
        super().retire()
        self._waiting.clear()
        self.end_introspection()

    def _answer(self, request: Request, reply: Reply, request_id: RequestId) -> object:
        events = self.service_events
        if events is not None:
            events.publish_event(EventType.REQUEST_RECEIVED, request_id, request=request)
            reply = partial(self._reply_with_event, reply, request_id)
        if self._replying:
            return self.callback(request, partial(self.send_response, header=reply))
        response = self.callback(request, self.srv_type.Response())
        if isawaitable(response):
            return self._answer_later(response, reply)
        self.send_response(response, reply)
        return None

    async def _answer_later(self, response: Awaitable[Response], reply: Reply) -> None:
        self.send_response(await response, reply)

    def _reply_with_event(self, reply: Reply, request_id: RequestId, response: Response) -> None:
        reply(response)
        events = self.service_events
        if events is not None:
            events.publish_event(EventType.RESPONSE_SENT, request_id, response=response)


M = TypeVar("M")


def deep_copy(message: M) -> M:
    """Return a deep copy of a message, made by serialization and deserialization.

    Raises:
        MessageDataError: MSG202, the value of a field does not fit its type.
    """
    copied: Any = message
    return deserialize(serialize(copied), type(copied))  # type: ignore[no-any-return]  # the same type


class RemoteService(Protocol):
    """A service server in another process, as seen by a client."""

    def send(self, request: Any, on_response: Callable[[Any], None], sequence_number: int) -> Callable[[], None]:
        """Send a request.

        Args:
            request: the request.
            on_response: called with the response, from any thread, at most once.
            sequence_number: the request's sequence number, unique within the client.

        Returns:
            A function that cancels the request.
        """


class Client(IntrospectedEndpoint, Entity, Generic[Request, Response]):
    """A service client, which sends requests (rclpy ``Client``).

    ``Node.create_client`` creates clients.

    Requests that are made before a server is available are queued; the QoS depth limits their number. If several
    servers have the same name, the oldest server of this process is called. A server of another process is called only
    if this process has no such server.
    """

    kind = EndpointKind.CLIENT

    def __init__(
        self,
        node: NodeHandle,
        srv_type: Any,
        srv_name: str,
        qos_profile: QoSProfile,
        callback_group: CallbackGroup | None = None,
        *,
        raw: bool = False,
    ) -> None:
        Entity.__init__(self, node, callback_group)
        self._describe(node, srv_type, srv_name, qos_profile)
        self.unblockable = not node.strict_callback_groups  # see `linkwright.graph.loop.future` for the reason
        self.raw = raw
        self.remote_service: RemoteService | None = None
        """The server in another process, or None while there is none. See `set_remote_service`."""
        self._server: Service[Request, Response] | None = None
        self._sequence_numbers = itertools.count(1)
        self._lock = threading.RLock()
        self._unsent: deque[tuple[Future[Response], Request]] = deque(maxlen=qos_profile.queue_length)
        self._pending: dict[Future[Response], Callable[[], None]] = {}
        self._completions: deque[Callable[[], None]] = deque()

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return f"client of service '{self.name}'"

    def service_is_ready(self) -> bool:
        """Return whether a server is available.

        Raises:
            InvalidHandleError: the client was destroyed.
        """
        self.check_alive()
        return self._server is not None or self.remote_service is not None

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a server is available.

        Args:
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            Whether a server is available. Closing the graph ends the wait with False.
        """
        return self.node.graph.wait_until(self.service_is_ready, timeout_sec)

    def call_async(self, request: Request) -> Future[Response]:
        """Send a request without blocking.

        Returns:
            A future that gets the response.

        Raises:
            TypeError: the request is not of the service's type.
            InvalidHandleError: the client was destroyed.
            RclError: a signal has shut down the context.
        """
        self.check_alive()
        self.check_message(request, "Request")
        if self.node.copies_messages:
            request = deep_copy(request)
        future: Future[Response] = Future()
        future.source = self
        self._pending[future] = _ignore_cancellation
        if not self._send(future, request):
            with self._lock:
                self._unsent.append((future, request))
            self._send_queued()
        return future

    def call(self, request: Request, timeout_sec: float | None = None) -> Response | None:
        """Send a request, and block until the response arrives.

        Another thread must run the node's callbacks in the meantime.

        Args:
            request: the request.
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            The response; None, as in Jazzy, if it does not arrive in time.

        Raises:
            TypeError: the request is not of the service's type.
            RuntimeError: the calling thread runs the event loop that must receive the response.
        """
        is_own_thread = getattr(self.dispatcher, "is_own_thread", None)
        if is_own_thread is not None and is_own_thread():
            raise RuntimeError(
                f"call() of service '{self.name}' would block the event loop that receives the response; "
                "await call_async() instead"
            )
        future = self.call_async(request)
        if not future.wait(timeout_sec):
            self.remove_pending_request(future)
            return None
        return future.result()

    def remove_pending_request(self, future: Future[Any]) -> None:
        """Cancel a pending request.

        The future never receives a response.
        """
        with self._lock:
            cancel = self._pending.pop(future, None)
            self._unsent = deque(
                (unsent for unsent in self._unsent if unsent[0] is not future), maxlen=self._unsent.maxlen
            )
        if cancel is not None:
            cancel()

    # --- called by dispatchers ---------------------------------------------------------------------------------------

    def has_work(self) -> bool:
        """Return whether responses are queued."""
        return bool(self._completions)

    def take(self) -> Callable[[], object] | None:
        """Remove the oldest response from the queue and return the call that completes its future.

        Returns None if the queue is empty.
        """
        return self._take_from(self._completions)

    def retire(self) -> None:
        """Remove the client from the graph, and cancel all requests."""
        with self._lock:
            pending, self._pending = self._pending, {}
            self._unsent.clear()
        for cancel in pending.values():
            cancel()
        super().retire()
        self._completions.clear()
        self._server = None
        self.remote_service = None
        self.end_introspection()

    # --- called by the bus and the transport ---------------------------------------------------------------------

    def set_server(self, server: Service[Request, Response] | None) -> None:
        """Set the service of this process that receives the requests, or None if there is none."""
        self._server = server
        self._send_queued()

    def set_remote_service(self, remote_service: RemoteService | None) -> None:
        """Set the server in another process, or None if there is none.

        The transport calls this method.

        The client uses this server only if this process has none.
        """
        self.remote_service = remote_service
        self._send_queued()
        self.node.graph.notify_change()

    def _send_queued(self) -> None:
        while self._server is not None or self.remote_service is not None:
            with self._lock:
                if not self._unsent:
                    return
                future, request = self._unsent.popleft()
            try:
                was_sent = self._send(future, request)
            except LinkwrightError as error:  # the caller has returned, so the future gets the error
                self._queue_completion(future, partial(future.fail, error, self.dispatcher))
                continue
            if not was_sent:
                with self._lock:
                    self._unsent.appendleft((future, request))

    def _send(self, future: Future[Response], request: Request) -> bool:
        server, remote_service = self._server, self.remote_service
        if server is None and remote_service is None:
            return False
        request_id = RequestId(self.gid, next(self._sequence_numbers))
        on_response = partial(self._receive, future, request_id)
        if self.service_events is not None:
            self.service_events.publish_event(EventType.REQUEST_SENT, request_id, request=request)
        if server is not None:
            server.receive(request, on_response, request_id)
        elif remote_service is not None:
            cancel = remote_service.send(request, on_response, request_id.sequence_number)
            if future in self._pending:
                self._pending[future] = cancel
        return True

    def _receive(self, future: Future[Response], request_id: RequestId, response: Response) -> None:
        self._queue_completion(future, partial(self._hand_over, future, request_id, response))

    def _queue_completion(self, future: Future[Response], complete: Callable[[], None]) -> None:
        """Queue the function `complete`, which completes a future.

        A cancelled request is ignored.
        """
        if self._pending.pop(future, None) is not None:
            self._completions.append(complete)
            self.announce()

    def _hand_over(self, future: Future[Response], request_id: RequestId, response: Response) -> None:
        if self.service_events is not None:
            self.service_events.publish_event(EventType.RESPONSE_RECEIVED, request_id, response=response)
        future.hand_over(response, self.dispatcher)


def _ignore_cancellation() -> None:
    """Do nothing, because a request to a service of this process cannot be cancelled."""
