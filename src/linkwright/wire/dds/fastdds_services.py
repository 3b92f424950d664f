"""Services and clients as rmw_fastrtps implements them.

In rmw_fastrtps, a reply identifies its request in the inline QoS of RTPS, outside the sample. Cyclone neither writes
inline QoS nor passes it on. Therefore a participant of our own does this (`linkwright.wire.dds.rtps`), with a reader
and a writer for each service and client in addition to Cyclone's.
"""

from __future__ import annotations

import os
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from threading import Lock
from typing import TYPE_CHECKING, Any

from linkwright.graph.endpoints.service import RequestId
from linkwright.wire.dds.names import Role, to_dds_topic
from linkwright.wire.dds.rtps.participant import RtpsParticipant
from linkwright.wire.dds.rtps.values import (
    NO_NUMBER,
    PREFIX_SIZE,
    encode_related_identity,
    is_reader,
    read_related_identity,
)
from linkwright.wire.dds.service_types import make_service_user_data, request_and_response_types
from linkwright.wire.service_messages import forward_request, forward_response, to_cdr
from linkwright.wire.type_names import to_wire_type

if TYPE_CHECKING:
    from linkwright.graph.endpoints.service import Client, Service
    from linkwright.wire.dds.rtps.messages import Data

_REPLY_TIMEOUT_S = 10.0
"""Seconds for which a reply waits until the client's reader is known. After that, the client counts as gone."""

_SETTLING_TIME_S = 0.1
"""Seconds after the discovery of a client's writer within which all its earlier samples arrive."""

_EARLY_REQUEST_TIMEOUT_S = 10.0
"""Seconds for which an early request waits until its client is discovered."""

_TIME_TOLERANCE_NS = 1000
"""The maximum difference, in ns, between two readings of one time stamp, whose unit on the wire is 2^-32 s."""

_MAX_NUMBERED_REQUESTS = 64


@dataclass(frozen=True, slots=True)
class EarlyRequest:
    """A request that Cyclone's reader received, without its sequence number.

    Attributes:
        writer: the GUID of the client's writer.
        body: the request as CDR, with the encapsulation header.
        written_ns: the time of writing by the client's clock, in ns.
        arrived_at: the time of arrival, in seconds of the steady clock.
    """

    writer: bytes
    body: bytes
    written_ns: int
    arrived_at: float


class FastServer:
    """The part of a service that answers clients on Fast DDS.

    Such a client considers a service ready as soon as it has discovered one reader and one writer of the service. These
    may be Cyclone's. The client's request then reaches only Cyclone's reader, which does not provide the sequence
    number. `on_early_request` accepts the request. Its number is determined when the client is discovered here.

    Args:
        service: the service.
        participant: our participant for Fast DDS.
    """

    def __init__(self, service: Service[Any, Any], participant: RtpsParticipant) -> None:
        self._service = service
        self._participant = participant
        user_data = make_service_user_data(os.urandom(16), service, is_server=True)
        request, response = map(to_wire_type, request_and_response_types(service.type_name))
        self._late_replies: deque[tuple[float, bytes, int, Any]] = deque()
        self._early_requests: list[EarlyRequest] = []
        self._first_samples: dict[bytes, tuple[int, int]] = {}
        """The number and time of each writer's first sample that arrived here. All later samples also arrive here."""
        self._numbered_requests: dict[bytes, deque[tuple[int, int]]] = {}
        self._lock = Lock()
        self._replies = participant.add_writer(to_dds_topic(Role.REPLY, service.name), response, user_data)
        self._requests = participant.add_reader(
            to_dds_topic(Role.REQUEST, service.name), request, user_data, self._on_data
        )

    def on_early_request(self, request: EarlyRequest) -> None:
        """Accept a request from Cyclone's reader, unless this reader also receives it."""
        discovered_at = self._participant.find_matched_writers(self._requests).get(request.writer)
        if discovered_at is None or time.monotonic() < discovered_at + _SETTLING_TIME_S:
            with self._lock:
                self._early_requests.append(request)

    def write_pending_replies(self) -> None:
        """Write replies to clients that are now known.

        Early requests whose sequence numbers are now known are passed on.
        """
        now = time.monotonic()
        with self._lock:
            late_replies, self._late_replies = self._late_replies, deque()
        for deadline, client, sequence_number, response in late_replies:
            if now < deadline:
                self._reply(client, sequence_number, response, deadline)
        if self._early_requests:
            self._number_early_requests(now)

    @property
    def has_pending_work(self) -> bool:
        """Whether `write_pending_replies` must be called again soon."""
        return bool(self._late_replies or self._early_requests)

    def close(self) -> None:
        """Stop answering requests, and delete the endpoints."""
        self._participant.remove(self._requests)
        self._participant.remove(self._replies)

    def _on_data(self, sample: Data) -> None:
        with self._lock:
            self._first_samples.setdefault(sample.writer, (sample.sequence_number, sample.time))
            numbered = self._numbered_requests.get(sample.writer, ())
            if any(
                sequence_number == sample.sequence_number and abs(time_ns - sample.time) < _TIME_TOLERANCE_NS
                for sequence_number, time_ns in numbered
            ):
                return  # already handled: it was first taken from Cyclone's reader
        identity = read_related_identity(sample.inline, sample.order)
        client = sample.writer
        if identity is not None and is_reader(identity[0]) and identity[0].startswith(sample.source):
            client = identity[0]
        self._forward(sample.payload or b"", sample.writer, client, sample.sequence_number)

    def _forward(self, body: bytes, writer: bytes, client: bytes, sequence_number: int) -> None:
        forward_request(
            body, self._service, partial(self._reply, client, sequence_number), RequestId(writer, sequence_number)
        )

    def _reply(self, client: bytes, sequence_number: int, response: Any, deadline: float | None = None) -> None:
        if self._service.destroyed:
            return
        if self._can_reach(client):
            inline = encode_related_identity(client, sequence_number)
            self._participant.write(self._replies, to_cdr(response), inline=inline, to=client[:PREFIX_SIZE])
        else:
            with self._lock:
                self._late_replies.append(
                    (deadline or time.monotonic() + _REPLY_TIMEOUT_S, client, sequence_number, response)
                )
            self._participant.changed()

    def _can_reach(self, client: bytes) -> bool:
        """Return whether the client's reader is known.

        For an early request, only the client's participant is known.
        """
        prefix = client if is_reader(client) else client[:PREFIX_SIZE]
        return any(reader.startswith(prefix) for reader in self._participant.find_matched_readers(self._replies))

    def _number_early_requests(self, now: float) -> None:
        """Pass on early requests, numbered in order before the first request that arrived here.

        Requests that wait for too long without a number are dropped.
        """
        discovered_at_by_writer = self._participant.find_matched_writers(self._requests)
        with self._lock:
            early_requests, self._early_requests = self._early_requests, []
            settled_writers = {
                early_request.writer
                for early_request in early_requests
                if _is_settled(discovered_at_by_writer.get(early_request.writer), now)
            }
            self._early_requests = [
                early_request
                for early_request in early_requests
                if early_request.writer not in settled_writers
                and now < early_request.arrived_at + _EARLY_REQUEST_TIMEOUT_S
            ]
        for writer in settled_writers:
            for sequence_number, request in self._assign_numbers(
                writer, [early_request for early_request in early_requests if early_request.writer == writer]
            ):
                self._forward(request.body, writer, writer, sequence_number)

    def _assign_numbers(self, writer: bytes, early_requests: list[EarlyRequest]) -> list[tuple[int, EarlyRequest]]:
        """Return a writer's numbered early requests.

        Requests that this reader also receives are left out.
        """
        last_number = self._participant.get_last_number(self._requests, writer)
        with self._lock:
            if writer in self._first_samples:
                sequence_number, written_first = self._first_samples[writer]
                last_number = sequence_number - 1
                early_requests = [
                    early_request
                    for early_request in early_requests
                    if early_request.written_ns < written_first - _TIME_TOLERANCE_NS
                ]
            numbered = list(
                zip(range(last_number - len(early_requests) + 1, last_number + 1), early_requests, strict=True)
            )
            numbered_requests = self._numbered_requests.setdefault(writer, deque(maxlen=_MAX_NUMBERED_REQUESTS))
            numbered_requests.extend((sequence_number, request.written_ns) for sequence_number, request in numbered)
        return numbered


class FastClient:
    """The part of a client that calls servers on Fast DDS.

    Args:
        client: the client.
        participant: our participant for Fast DDS.
        is_dead: returns whether a participant, given by its GUID prefix, is known to have been killed.
    """

    def __init__(
        self, client: Client[Any, Any], participant: RtpsParticipant, is_dead: Callable[[bytes], bool]
    ) -> None:
        self._client = client
        self._participant = participant
        self._is_dead = is_dead
        user_data = make_service_user_data(os.urandom(16), client, is_server=False)
        request, response = map(to_wire_type, request_and_response_types(client.type_name))
        self._response_callbacks: dict[int, Callable[[Any], None]] = {}
        self._identities: tuple[bytes, ...] = ()
        self._lock = Lock()
        # From now on replies may arrive, including replies to other clients of the service.
        self._replies = participant.add_reader(
            to_dds_topic(Role.REPLY, client.name), response, user_data, self._on_data
        )
        self._requests = participant.add_writer(to_dds_topic(Role.REQUEST, client.name), request, user_data)
        self._identities = (self._replies.reader.guid, self._requests.writer.guid)

    def send(self, request: Any, on_response: Callable[[Any], None]) -> Callable[[], None]:
        """Write a request, and return a function that cancels it."""
        inline = encode_related_identity(self._replies.reader.guid, NO_NUMBER)
        with self._lock:
            sequence_number = self._participant.write(self._requests, to_cdr(request), inline=inline)
            self._response_callbacks[sequence_number] = on_response
        return partial(self._cancel_request, sequence_number)

    def is_ready(self) -> bool:
        """Return whether a server has discovered both endpoints of this client.

        Otherwise the server's reply would be lost.
        """
        listening_prefixes = {guid[:PREFIX_SIZE] for guid in self._participant.find_matched_readers(self._requests)}
        return any(
            discovered_at is not None
            and guid[:PREFIX_SIZE] in listening_prefixes
            and not self._is_dead(guid[:PREFIX_SIZE])
            for guid, discovered_at in self._participant.find_matched_writers(self._replies).items()
        )

    def close(self) -> None:
        """Delete the endpoints.

        Pending requests stay unanswered.
        """
        self._response_callbacks.clear()
        self._participant.remove(self._requests)
        self._participant.remove(self._replies)

    def _cancel_request(self, sequence_number: int) -> None:
        self._response_callbacks.pop(sequence_number, None)

    def _on_data(self, sample: Data) -> None:
        identity = read_related_identity(sample.inline, sample.order)
        if identity is None or identity[0] not in self._identities:
            return
        with self._lock:
            on_response = self._response_callbacks.pop(identity[1], None)
        if on_response is not None:
            forward_response(sample.payload or b"", self._client, on_response)


def _is_settled(discovered_at: float | None, now: float) -> bool:
    return discovered_at is not None and now >= discovered_at + _SETTLING_TIME_S
