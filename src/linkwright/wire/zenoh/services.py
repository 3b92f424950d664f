"""Services and clients over Zenoh: a queryable for each service, a querier for each client."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, Any
from weakref import WeakSet

import zenoh
from zenoh.handlers import Callback

from linkwright.graph.endpoints.service import RequestId
from linkwright.wire.service_messages import forward_request, forward_response, to_cdr
from linkwright.wire.zenoh import attachment
from linkwright.wire.zenoh.tokens import Token

if TYPE_CHECKING:
    from linkwright.graph.endpoints.service import Client, Service

_REPLY_TIMEOUT_S = 600.0
"""Seconds for which a request waits for its reply."""

_RESULT_SUFFIX = "/_action/get_result"
_RESULT_TIMEOUT_S = 30 * 24 * 3600.0
"""The same for the result of an action, which may take any time."""


class RemoteServer:
    """The connection of a client to the servers of other processes.

    Implements `linkwright.graph.endpoints.service.RemoteService`.

    Args:
        client: the client.
        token: the client's token.
        session: the session.
        on_change: called, from any thread, when a server appears or leaves.
    """

    def __init__(
        self, client: Client[Any, Any], token: Token, session: zenoh.Session, on_change: Callable[[], None]
    ) -> None:
        self._client = client
        self.token = token
        self._response_callbacks: dict[int, Callable[[Any], None]] = {}
        self._is_ready = False
        self._has_warned = False
        client.gid = token.gid
        self._querier: Any = session.declare_querier(
            token.data_key,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=_RESULT_TIMEOUT_S if client.name.endswith(_RESULT_SUFFIX) else _REPLY_TIMEOUT_S,
            allowed_destination=zenoh.Locality.REMOTE,
        )
        listener: Any = Callback(lambda _: on_change(), indirect=False)
        self._listener = self._querier.declare_matching_listener(listener)

    def send(self, request: Any, on_response: Callable[[Any], None], sequence_number: int) -> Callable[[], None]:
        """Send a request, and return a function that cancels it."""
        self._response_callbacks[sequence_number] = on_response
        handler: Any = Callback(
            partial(self._receive, sequence_number), partial(self._end, sequence_number), indirect=False
        )
        metadata = attachment.write(sequence_number, time.time_ns(), self.token.gid)
        self._querier.get(handler, payload=to_cdr(request), attachment=metadata)
        return partial(self._cancel_request, sequence_number)

    def update_match_count(self, count: int) -> None:
        """Check whether a server is reachable, and update the client.

        Args:
            count: the number of known remote servers.
        """
        is_ready = count > 0 and self._querier.matching_status.matching
        if is_ready != self._is_ready:
            self._is_ready = is_ready
            self._client.set_remote_service(self if is_ready else None)

    def close(self) -> None:
        """Withdraw the client.

        Pending requests stay unanswered.
        """
        self._client.set_remote_service(None)
        self._response_callbacks.clear()
        self._listener.undeclare()
        self._querier.undeclare()

    def abandon(self) -> None:
        """Stop sending requests, without calling Zenoh."""
        self._client.remote_service = None

    def _receive(self, sequence_number: int, reply: zenoh.Reply) -> None:
        """Pass the first reply to a request on to the client.

        Zenoh calls this method in one of its threads.
        """
        sample = reply.ok
        if sample is None:
            return
        on_response = self._response_callbacks.pop(sequence_number, None)
        if on_response is not None:
            forward_response(sample.payload.to_bytes(), self._client, on_response)

    def _end(self, sequence_number: int) -> None:
        """Handle the end of a request.

        A request without a reply is logged once per client. The future of such a request stays pending, as in rclpy.
        """
        if (
            self._response_callbacks.pop(sequence_number, None) is not None
            and not self._has_warned
            and not self._client.destroyed
        ):
            self._has_warned = True
            self._client.node.logger.warning(
                f"A request to service '{self._client.name}' was not answered: its server has left, failed, or took "
                "too long"
            )

    def _cancel_request(self, sequence_number: int) -> None:
        self._response_callbacks.pop(sequence_number, None)


class IncomingService:
    """The connection of a service to the clients of other processes.

    Args:
        service: the service.
        token: the service's token.
        session: the session.
    """

    def __init__(self, service: Service[Any, Any], token: Token, session: zenoh.Session) -> None:
        self._service = service
        self.token = token
        service.gid = token.gid
        handler: Any = Callback(self._receive, indirect=False)
        self._queryable = session.declare_queryable(
            token.data_key, handler, complete=True, allowed_origin=zenoh.Locality.REMOTE
        )
        self._open: WeakSet[_PendingRequest] = WeakSet()
        """The requests that wait for a reply. A request that will receive none, because the queue was full or the
        callback failed, is freed, which notifies its client."""
        self._closed = False
        self._lock = Lock()

    def close(self) -> None:
        """Stop answering other processes, and notify clients that wait for a reply."""
        self._queryable.undeclare()
        with self._lock:
            self._closed = True  # A thread of Zenoh may be about to deliver a request.
            requests = list(self._open)
            self._open.clear()
        for request in requests:
            request.drop()

    def _receive(self, query: zenoh.Query) -> None:
        """Pass a request to the service.

        Zenoh calls this method in one of its threads.
        """
        metadata = attachment.read(None if query.attachment is None else query.attachment.to_bytes())
        body = None if query.payload is None else query.payload.to_bytes()
        if metadata is None or body is None:
            query.drop()
            return
        request = _PendingRequest(query, metadata)
        with self._lock:
            is_closed = self._closed
            if not is_closed:
                self._open.add(request)
        reply, request_id = partial(self._reply, request), RequestId(metadata.gid, metadata.sequence_number)
        if is_closed or not forward_request(body, self._service, reply, request_id):
            with self._lock:
                self._open.discard(request)
            request.drop()

    def _reply(self, request: _PendingRequest, response: Any) -> None:
        with self._lock:
            if request not in self._open:  # already dropped or answered
                return
            self._open.discard(request)
        request.answer(response, self.token.data_key)


class _PendingRequest:
    """A request that waits for its reply.

    Args:
        query: Zenoh's query; while it exists, the client waits.
        metadata: the attachment of the query.
    """

    def __init__(self, query: zenoh.Query, metadata: attachment.Attachment) -> None:
        self._query = query
        self._metadata = metadata

    def answer(self, response: Any, key: str) -> None:
        """Send the response."""
        encoded = attachment.write(self._metadata.sequence_number, time.time_ns(), self._metadata.gid)
        self._query.reply(key, to_cdr(response), attachment=encoded)
        self._query.drop()

    def drop(self) -> None:
        """Drop the query.

        This notifies the client that no reply will follow.
        """
        self._query.drop()
