"""Services: requests wait in a queue until a dispatcher runs the callback, which gives the response."""

from __future__ import annotations

from collections import deque
from collections.abc import Awaitable, Callable
from functools import partial
from inspect import isawaitable
from typing import Any, Generic, TypeVar

from linkwright.graph.endpoints.info import EndpointKind
from linkwright.graph.endpoints.service_introspection import NO_REQUEST_ID, EventType, IntrospectedEndpoint, RequestId
from linkwright.graph.loop.callback_groups import CallbackGroup
from linkwright.graph.loop.entity import Entity
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.qos.profile import QoSProfile
from linkwright.messages import deserialize, serialize

Request = TypeVar("Request")
Response = TypeVar("Response")

Reply = Callable[[Any], None]
"""Sends the response to the client; called once, from any thread."""

_NO_REQUESTS: deque[Any] = deque(maxlen=0)


class Service(IntrospectedEndpoint, Entity, Generic[Request, Response]):
    """Answers the requests to a service (rclpy ``Service``); made by ``Node.create_service``.

    Args:
        callback: called with the request and an empty response, returns the response; it may be a coroutine function.
        replying: whether the callback gets, in place of the empty response, a function that sends the response, which
            it may call later.
        raw: whether requests and responses are bytes, CDR with its header; the callback has to be `replying` then.
    """

    kind = EndpointKind.SERVICE

    _waiting: deque[tuple[Request, Reply, RequestId]] = _NO_REQUESTS
    """The queue of requests. A service gets its own with its first request: an empty one takes 700 bytes, and each node
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
    def what(self) -> str:
        """How log messages name it."""
        return f"callback of service '{self.name}'"

    def receive(self, request: Request, reply: Reply, request_id: RequestId = NO_REQUEST_ID) -> None:
        """Queue a request for the callback, from any thread.

        Args:
            request: the request.
            reply: called with the response, from any thread, or never.
            request_id: the client and the request's number, for service introspection.
        """
        if self._waiting is _NO_REQUESTS:
            vars(self).setdefault("_waiting", deque(maxlen=self.qos_profile.queue_length))  # safe in any thread
        self._waiting.append((request, reply, request_id))
        self.announce()

    def has_work(self) -> bool:
        """Whether requests wait."""
        return bool(self._waiting)

    def take(self) -> Callable[[], object] | None:
        """The call that answers the oldest request."""
        waiting = self._next_of(self._waiting)
        return None if waiting is None else partial(self._answer, *waiting)

    def send_response(self, response: Response, header: Reply) -> None:
        """Send a response.

        Args:
            response: the response.
            header: the reply callable that came with the request, in the place of rclpy's request header.

        Raises:
            TypeError: the response is not of the service's type.
        """
        self.check_half(response, "Response")
        header(copy_of(response) if self.node.copies_messages else response)

    def retire(self) -> None:
        """Remove it from the graph; requests in the queue get no response."""
        super().retire()
        self._waiting.clear()
        self.end_introspection()

    def _answer(self, request: Request, reply: Reply, request_id: RequestId) -> object:
        events = self.service_events
        if events is not None:
            events.publish_event(EventType.REQUEST_RECEIVED, request_id, request=request)
            reply = partial(self._reply_watched, reply, request_id)
        if self._replying:
            return self.callback(request, partial(self.send_response, header=reply))
        response = self.callback(request, self.srv_type.Response())
        if isawaitable(response):
            return self._answer_later(response, reply)
        self.send_response(response, reply)
        return None

    async def _answer_later(self, response: Awaitable[Response], reply: Reply) -> None:
        self.send_response(await response, reply)

    def _reply_watched(self, reply: Reply, request_id: RequestId, response: Response) -> None:
        reply(response)
        events = self.service_events
        if events is not None:
            events.publish_event(EventType.RESPONSE_SENT, request_id, response=response)


M = TypeVar("M")


def copy_of(message: M) -> M:
    """A deep copy of a message, made by serializing it.

    Raises:
        MessageDataError: MSG202, the value of a field does not fit the type.
    """
    copied: Any = message
    return deserialize(serialize(copied), type(copied))  # type: ignore[no-any-return]  # the same type
