"""Service clients: requests go to a service of this process or, over the transport, to one of another."""

from __future__ import annotations

import itertools
import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, Generic, Protocol, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.graph.endpoints.base import EndpointKind
from linkwright.graph.endpoints.service import EventType, IntrospectedEndpoint, RequestId, Service, copy_of
from linkwright.graph.loop.entity import Entity
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.node_handle import CallbackGroup, NodeHandle
from linkwright.graph.qos.profile import QoSProfile

Request = TypeVar("Request")
Response = TypeVar("Response")


class OutsideService(Protocol):
    """A server in another process, as a client sees it."""

    def send(self, request: Any, answer: Callable[[Any], None], number: int) -> Callable[[], None]:
        """Send a request.

        Args:
            request: the request.
            answer: called with the response, from any thread, at most once.
            number: the request's sequence number, unique for the client.

        Returns:
            A function that gives the request up.
        """


class Client(IntrospectedEndpoint, Entity, Generic[Request, Response]):
    """Calls a service (rclpy ``Client``); made by ``Node.create_client``.

    Requests that are made before there is a server wait for one, as many as the QoS depth says. Of several servers of
    the name the oldest of this process is called, else one of another process.
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
        self.unblockable = not node.strict_callback_groups  # see `linkwright.graph.loop.future`
        self.raw = raw
        self.outside: OutsideService | None = None
        """The server in another process; None while there is none. See `set_outside`."""
        self._server: Service[Request, Response] | None = None
        self._numbers = itertools.count(1)
        self._lock = threading.RLock()
        self._unsent: deque[tuple[Future[Response], Request]] = deque(maxlen=qos_profile.queue_length)
        self._pending: dict[Future[Response], Callable[[], None]] = {}
        self._endings: deque[Callable[[], None]] = deque()

    @property
    def what(self) -> str:
        """How log messages name it."""
        return f"client of service '{self.name}'"

    def service_is_ready(self) -> bool:
        """Whether a server is available.

        Raises:
            InvalidHandleError: the client was destroyed.
        """
        self.check_alive()
        return self._server is not None or self.outside is not None

    def wait_for_service(self, timeout_sec: float | None = None) -> bool:
        """Block the calling thread until a server is available.

        Args:
            timeout_sec: seconds to wait at most; None for any time.

        Returns:
            Whether one is available. False also when the graph is closed meanwhile.
        """
        return self.node.graph.wait_until(self.service_is_ready, timeout_sec)

    def call_async(self, request: Request) -> Future[Response]:
        """Send a request; the future gets the response.

        Raises:
            TypeError: the request is not of the service's type.
            InvalidHandleError: the client was destroyed.
        """
        self.check_alive()
        self.check_half(request, "Request")
        if self.node.copies_messages:
            request = copy_of(request)
        future: Future[Response] = Future()
        future.source = self
        self._pending[future] = _nothing
        if not self._send(future, request):
            with self._lock:
                self._unsent.append((future, request))
            self._send_waiting()
        return future

    def call(self, request: Request, timeout_sec: float | None = None) -> Response | None:
        """Send a request, and block until the response arrives. Another thread must run the node's callbacks.

        Args:
            request: the request.
            timeout_sec: seconds to wait at most; None for any time.

        Returns:
            The response; None, as in Jazzy, if none arrives in time.

        Raises:
            TypeError: the request is not of the service's type.
            RuntimeError: the calling thread is the one that would have to receive the response.
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
        """Give a request up: its future will get no response."""
        with self._lock:
            forget = self._pending.pop(future, None)
            self._unsent = deque(
                (unsent for unsent in self._unsent if unsent[0] is not future), maxlen=self._unsent.maxlen
            )
        if forget is not None:
            forget()

    # --- for dispatchers ---------------------------------------------------------------------------------------------

    def has_work(self) -> bool:
        """Whether responses wait."""
        return bool(self._endings)

    def take(self) -> Callable[[], object] | None:
        """The call that completes the future of the oldest response."""
        return self._next_of(self._endings)

    def retire(self) -> None:
        """Remove it from the graph, and give up all requests."""
        with self._lock:
            pending, self._pending = self._pending, {}
            self._unsent.clear()
        for forget in pending.values():
            forget()
        super().retire()
        self._endings.clear()
        self._server = None
        self.outside = None
        self.end_introspection()

    # --- for the bus and the transport ---------------------------------------------------------------------------

    def set_server(self, server: Service[Request, Response] | None) -> None:
        """Call a service of this process from now on; None for none."""
        self._server = server
        self._send_waiting()

    def set_outside(self, outside: OutsideService | None) -> None:
        """Called by the transport: the server in another process to call where this one has none; None for none."""
        self.outside = outside
        self._send_waiting()
        self.node.graph.notify_change()

    def _send_waiting(self) -> None:
        while self._server is not None or self.outside is not None:
            with self._lock:
                if not self._unsent:
                    return
                future, request = self._unsent.popleft()
            try:
                was_sent = self._send(future, request)
            except LinkwrightError as error:  # the caller has returned
                self._end(future, partial(future.fail, error, self.dispatcher))
                continue
            if not was_sent:
                with self._lock:
                    self._unsent.appendleft((future, request))

    def _send(self, future: Future[Response], request: Request) -> bool:
        server, outside = self._server, self.outside
        if server is None and outside is None:
            return False
        request_id = RequestId(self.gid, next(self._numbers))
        answer = partial(self._receive, future, request_id)
        if self.service_events is not None:
            self.service_events.publish_event(EventType.REQUEST_SENT, request_id, request=request)
        if server is not None:
            server.receive(request, answer, request_id)
        elif outside is not None:
            forget = outside.send(request, answer, request_id.number)
            if future in self._pending:
                self._pending[future] = forget
        return True

    def _receive(self, future: Future[Response], request_id: RequestId, response: Response) -> None:
        self._end(future, partial(self._hand_over, future, request_id, response))

    def _end(self, future: Future[Response], end: Callable[[], None]) -> None:
        """Schedule the end of a future as a callback, unless the request was cancelled."""
        if self._pending.pop(future, None) is not None:
            self._endings.append(end)
            self.announce()

    def _hand_over(self, future: Future[Response], request_id: RequestId, response: Response) -> None:
        if self.service_events is not None:
            self.service_events.publish_event(EventType.RESPONSE_RECEIVED, request_id, response=response)
        future.hand_over(response, self.dispatcher)


def _nothing() -> None:
    """Cancels a request to a service of this process: nothing needs to be undone."""
