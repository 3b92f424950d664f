"""Services and clients over DDS.

A service consists of two topics. rmw_cyclonedds_cpp writes a header before each request: the id of the client (64 bits)
and the sequence number of the request. The server writes the same header before its reply. All replies reach all
clients of a service, and each client picks its own replies. The USER_DATA of both endpoints of a client or a server
links them.

rmw_fastrtps_cpp sends the same data outside the samples (inline QoS), which Cyclone neither passes on nor writes. For
the clients and servers of rmw_fastrtps_cpp, each service and client has a second reader and writer
(`linkwright.wire.dds.fastdds_services`).
"""

from __future__ import annotations

import ctypes as c
import os
import struct
import time
from collections import deque
from collections.abc import Callable, Iterator
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, Any

from linkwright.graph.endpoints.service import RequestId
from linkwright.wire.dds.cyclone import (
    ANY_STATE,
    DATA_AVAILABLE,
    PUBLICATION_MATCHED,
    SUBSCRIPTION_MATCHED,
    load,
    write,
)
from linkwright.wire.dds.domain import Domain
from linkwright.wire.dds.fastdds_services import EarlyRequest, FastClient, FastServer
from linkwright.wire.dds.names import Role, to_dds_topic
from linkwright.wire.dds.qos import endpoint_qos
from linkwright.wire.dds.remote import RemoteEndpoint, is_fast
from linkwright.wire.dds.service_types import make_service_user_data, request_and_response_types
from linkwright.wire.service_messages import forward_request, forward_response, to_cdr

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import Endpoint
    from linkwright.graph.endpoints.service import Client, Service
    from linkwright.wire.dds.rtps.participant import RtpsParticipant

HEADER = struct.Struct("<Qq")
"""The id of the client, and the sequence number of the request."""

_ENCAPSULATION_SIZE = 4
_BODY_OFFSET = _ENCAPSULATION_SIZE + HEADER.size
_LITTLE_ENDIAN = b"\x00\x01\x00\x00"
_MAX_SAMPLES = 64
_REPLY_TIMEOUT_S = 1.0
"""Seconds for which a reply waits until the client's reader is known. After that, the reply is written anyway."""


class EndpointPair:
    """The reader and the writer that make up a client or a service.

    Args:
        endpoint: the client or service.
        domain: the domain in which they are created.
        is_server: whether the endpoint is a service.
    """

    def __init__(self, endpoint: Endpoint, domain: Domain, *, is_server: bool) -> None:
        self._dds = load()
        self._participant = participant = domain.participant
        self.name = endpoint.name
        self.request_topic = to_dds_topic(Role.REQUEST, endpoint.name)
        self.reply_topic = to_dds_topic(Role.REPLY, endpoint.name)
        user_data = make_service_user_data(os.urandom(16), endpoint, is_server=is_server)
        # Only the names of the types are described, because requests of Fast DDS arrive without the header.
        type_descriptions = (
            domain.types.by_name(type_name) for type_name in request_and_response_types(endpoint.type_name)
        )
        request = participant.create_topic(self.request_topic, next(type_descriptions))
        reply = participant.create_topic(self.reply_topic, next(type_descriptions))
        self._topics = (request, reply)
        with endpoint_qos(endpoint.qos_profile, user_data) as qos:
            self.reader = participant.create_reader(request if is_server else reply, qos)
            self.writer = participant.create_writer(reply if is_server else request, qos)
        self.reader_guid = self._dds.guid(self.reader)
        self.writer_guid = self._dds.guid(self.writer)
        endpoint.gid = self.reader_guid if is_server else self.writer_guid
        # Cyclone wakes a thread until a status is taken. A server takes none, because it queries the matches when it
        # replies.
        self._dds.dds_set_status_mask(self.reader, DATA_AVAILABLE | (0 if is_server else SUBSCRIPTION_MATCHED))
        self._dds.dds_set_status_mask(self.writer, 0 if is_server else PUBLICATION_MATCHED)

    def has_matched(self, entity: int) -> bool:
        """Return whether the matches of a reader or writer have changed since the last call."""
        mask = SUBSCRIPTION_MATCHED if entity == self.reader else PUBLICATION_MATCHED
        status = c.c_uint32()
        self._dds.dds_take_status(entity, c.byref(status), mask)
        return bool(status.value)

    def take_samples(self) -> Iterator[tuple[bytes, Any]]:
        """Take the samples that have arrived.

        Yield each as CDR, with Cyclone's sample info.
        """
        results = self._dds.take_bytes(self.reader, ANY_STATE, _MAX_SAMPLES)
        return (sample for sample in (results if isinstance(results, list) else ()) if sample[1].valid_data)

    def write(self, client_id: int, sequence_number: int, message: Any) -> None:
        """Write a request or a reply, with the header that identifies the request."""
        write(
            self.writer,
            _LITTLE_ENDIAN + HEADER.pack(client_id, sequence_number) + to_cdr(message)[_ENCAPSULATION_SIZE:],
        )

    def close(self) -> None:
        """Delete the reader and the writer."""
        self._participant.delete(self.reader, self.writer, *self._topics)


class RemoteServer:
    """The connection of a client to the servers of other processes.

    Implements `linkwright.graph.endpoints.service.RemoteService`.

    Args:
        client: the client.
        domain: the domain with the servers.
        on_match: called in the receiving thread when an endpoint was matched or has left.
    """

    def __init__(self, client: Client[Any, Any], domain: Domain, on_match: Callable[[], None]) -> None:
        self._client = client
        self._on_match = on_match
        self._remote = domain.remote
        self._dds = load()
        self.pair = EndpointPair(client, domain, is_server=False)
        self._client_id = int.from_bytes(os.urandom(8), "little")
        self._response_callbacks: dict[int, Callable[[Any], None]] = {}
        self._is_ready = False
        self._uses_cyclone = False
        self._fast: FastClient | None = None

    def connect_fast(self, participant: RtpsParticipant) -> None:
        """Also start calling servers on Fast DDS."""
        self._fast = FastClient(self._client, participant, self._remote.is_dead)

    def send(self, request: Any, on_response: Callable[[Any], None], sequence_number: int) -> Callable[[], None]:
        """Write a request, and return a function that cancels it."""
        if self._fast is not None and not self._uses_cyclone:
            return self._fast.send(request, on_response)
        self._response_callbacks[sequence_number] = on_response
        self.pair.write(self._client_id, sequence_number, request)
        return partial(self._cancel_request, sequence_number)

    def on_data(self) -> bool:
        """Pass on the replies for this client, and return whether there are more samples."""
        if self.pair.has_matched(self.pair.reader):
            self._on_match()
        count = 0
        for data, _ in self.pair.take_samples():
            count += 1
            client_id, sequence_number, body = _split_sample(data)
            on_response = self._response_callbacks.pop(sequence_number, None) if client_id == self._client_id else None
            if on_response is not None:
                forward_response(body, self._client, on_response)
        return count == _MAX_SAMPLES

    def on_writer_status(self) -> bool:
        """Handle a change in the readers that match the writer.

        Returns False, because a status change brings no samples.
        """
        if self.pair.has_matched(self.pair.writer):
            self._on_match()
        return False

    def update_availability(self) -> None:
        """Check whether a server is available, and update the client.

        A server is available if both its reader and its writer match ours.
        """
        self._uses_cyclone = self._is_server_available()
        is_ready = self._uses_cyclone or (self._fast is not None and self._fast.is_ready())
        if is_ready != self._is_ready:
            self._is_ready = is_ready
            self._client.set_remote_service(self if is_ready else None)

    def close(self) -> None:
        """Delete the endpoints.

        Pending requests stay unanswered.
        """
        self._client.set_remote_service(None)
        self._response_callbacks.clear()
        if self._fast is not None:
            self._fast.close()
        self.pair.close()

    def abandon(self) -> None:
        """Stop sending requests, without calling Cyclone."""
        self._client.remote_service = None

    def _cancel_request(self, sequence_number: int) -> None:
        self._response_callbacks.pop(sequence_number, None)

    def _is_server_available(self) -> bool:
        request_readers = [
            self._remote.endpoint(handle) for handle in self._dds.matching_handles(self.pair.writer, writer=True)
        ]
        cyclone_readers = [endpoint for endpoint in request_readers if endpoint is not None and not endpoint.is_fast]
        reply_writers = [
            self._remote.endpoint(handle) for handle in self._dds.matching_handles(self.pair.reader, writer=False)
        ]
        return any(
            _have_same_owner(reader, writer, "serviceid") for reader in cyclone_readers for writer in reply_writers
        )


class IncomingService:
    """The connection of a service to the clients of other processes.

    Args:
        service: the service.
        domain: the domain with the clients.
        on_waiting: called when a reply must wait until its client is reachable.
    """

    def __init__(self, service: Service[Any, Any], domain: Domain, on_waiting: Callable[[], None]) -> None:
        self._service = service
        self._on_waiting = on_waiting
        self._remote = domain.remote
        self._dds = load()
        self.pair = EndpointPair(service, domain, is_server=True)
        self._fast: FastServer | None = None
        self._early_requests: list[EarlyRequest] = []
        self._late_replies: deque[tuple[float, RemoteEndpoint | None, int, int, Any]] = deque()
        self._lock = Lock()

    def on_data(self) -> bool:
        """Pass requests that have arrived to the service, and return whether there are more."""
        count = 0
        for data, info in self.pair.take_samples():
            count += 1
            sender = self._remote.endpoint(info.publication_handle)
            if self._accept_from_fast(sender, data, info):
                continue
            client_id, sequence_number, body = _split_sample(data)
            if body:
                gid = bytes(16) if sender is None else sender.guid
                reply = partial(self._reply, sender, client_id, sequence_number)
                forward_request(body, self._service, reply, RequestId(gid, sequence_number))
        return count == _MAX_SAMPLES

    def connect_fast(self, participant: RtpsParticipant) -> None:
        """Also start answering clients on Fast DDS."""
        self._fast = FastServer(self._service, participant)
        early_requests, self._early_requests = self._early_requests, []
        for request in early_requests:
            self._fast.on_early_request(request)

    def write_pending_replies(self) -> None:
        """Write replies whose clients can now be reached or have been unreachable for too long."""
        with self._lock:
            for _ in range(len(self._late_replies)):
                deadline, sender, client_id, sequence_number, response = self._late_replies.popleft()
                if time.monotonic() >= deadline or self._can_reach(sender):
                    self.pair.write(client_id, sequence_number, response)
                else:
                    self._late_replies.append((deadline, sender, client_id, sequence_number, response))
        if self._fast is not None:
            self._fast.write_pending_replies()

    @property
    def has_pending_work(self) -> bool:
        """Whether replies or requests wait until their clients are discovered."""
        return bool(self._late_replies) or (self._fast is not None and self._fast.has_pending_work)

    def close(self) -> None:
        """Stop answering other processes."""
        if self._fast is not None:
            self._fast.close()
        self.pair.close()

    def _accept_from_fast(self, sender: RemoteEndpoint | None, data: bytes, info: Any) -> bool:
        """Pass a request from Fast DDS to `FastServer`.

        Return whether the request came from Fast DDS.
        """
        guid = sender.guid if sender else self._dds.writer_guid(self.pair.reader, info.publication_handle)
        if not is_fast(guid):
            return False
        request = EarlyRequest(guid, data, info.source_timestamp, time.monotonic())
        if self._fast is None:
            self._early_requests = [*self._early_requests[-_MAX_SAMPLES:], request]
        else:
            self._fast.on_early_request(request)
            self._on_waiting()
        return True

    def _reply(self, sender: RemoteEndpoint | None, client_id: int, sequence_number: int, response: Any) -> None:
        if not self._service.destroyed:
            if self._can_reach(sender):
                self.pair.write(client_id, sequence_number, response)
            else:
                with self._lock:
                    self._late_replies.append(
                        (time.monotonic() + _REPLY_TIMEOUT_S, sender, client_id, sequence_number, response)
                    )
                self._on_waiting()

    def _can_reach(self, sender: RemoteEndpoint | None) -> bool:
        """Return whether the client's reader matches our writer.

        Otherwise the client would miss the reply.
        """
        readers = (
            self._remote.endpoint(handle) for handle in self._dds.matching_handles(self.pair.writer, writer=True)
        )
        return any(_have_same_owner(sender, reader, "clientid") for reader in readers)


def _have_same_owner(first: RemoteEndpoint | None, second: RemoteEndpoint | None, key: str) -> bool:
    """Return whether two endpoints belong to the same client or server.

    The comparison uses the ID in the USER_DATA, or the participant if there is no ID.
    """
    if first is None or second is None:
        return False
    if key in first.user_data or key in second.user_data:
        return first.user_data.get(key) == second.user_data.get(key)
    return first.participant == second.participant


def _split_sample(data: bytes) -> tuple[int, int, bytes]:
    """Split a sample into the client's id, the sequence number and the body as CDR.

    If the sample is too short for the header, the body is empty.
    """
    if len(data) < _BODY_OFFSET:
        return 0, 0, b""
    client_id, sequence_number = HEADER.unpack_from(data, _ENCAPSULATION_SIZE)
    return client_id, sequence_number, data[:_ENCAPSULATION_SIZE] + data[_BODY_OFFSET:]
