"""Services and clients as rmw_fastrtps implements them.

In rmw_fastrtps, a reply identifies its request in the inline QoS of RTPS, outside the sample. Cyclone neither writes
inline QoS nor passes it on. Therefore a participant of our own does this (`linkwright.wire.dds.rtps`), with a reader
and a writer for each service and client in addition to those of Cyclone.
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
from linkwright.wire.dds.names import Role, dds_topic
from linkwright.wire.dds.rtps.participant import RtpsParticipant
from linkwright.wire.dds.rtps.values import NO_NUMBER, PREFIX, is_reader, read_related_identity, related_identity
from linkwright.wire.dds.service_types import request_and_response_types, service_facts
from linkwright.wire.service_messages import forward_request, forward_response, to_cdr
from linkwright.wire.type_names import dds_type

if TYPE_CHECKING:
    from linkwright.graph.endpoints.service import Client, Service
    from linkwright.wire.dds.rtps.messages import Data

_REPLY_WAITS = 10.0
"""Seconds for which a reply waits until the client's reader is known; then the client is taken to be gone."""

_SETTLED = 0.1
"""Seconds after a client's writer was heard first, after which all is here that it had sent before."""

_EARLY_WAITS = 10.0
"""Seconds for which an early request waits for its client to be heard."""

_SAME_TIME = 1000
"""Two readings of one time stamp differ by less (ns): it is a fraction of 2^-32 s on the wire."""

_REMEMBERED = 64


@dataclass(frozen=True, slots=True)
class EarlyRequest:
    """A request that Cyclone's reader received, without its sequence number.

    Attributes:
        writer: the GUID of the client's writer.
        body: CDR with its header.
        written: the time of writing by the client's clock, in ns.
        came: the time of arrival, in seconds of the steady clock.
    """

    writer: bytes
    body: bytes
    written: int
    came: float


class FastServer:
    """A service of this process, as clients on Fast DDS call it.

    Such a client considers a service ready as soon as it knows one reader and one writer of it, which may be those of
    Cyclone. The client's request then reaches only Cyclone's reader, which does not provide the sequence number.
    `on_early_request` accepts the request. Its number is determined when the client is discovered here.

    Args:
        service: the service.
        participant: our participant for Fast DDS.
    """

    def __init__(self, service: Service[Any, Any], participant: RtpsParticipant) -> None:
        self._service = service
        self._participant = participant
        facts = service_facts(os.urandom(16), service, is_server=True)
        request, response = map(dds_type, request_and_response_types(service.type_name))
        self._late: deque[tuple[float, bytes, int, Any]] = deque()
        self._early: list[EarlyRequest] = []
        self._first: dict[bytes, tuple[int, int]] = {}
        """Number and time of the first sample of each writer that arrived here; all that follow do."""
        self._numbered: dict[bytes, deque[tuple[int, int]]] = {}
        self._lock = Lock()
        self._replies = participant.add_writer(dds_topic(Role.REPLY, service.name), response, facts)
        self._requests = participant.add_reader(dds_topic(Role.REQUEST, service.name), request, facts, self._on_data)

    def on_early_request(self, request: EarlyRequest) -> None:
        """Accept a request from Cyclone's reader. It is dropped if this reader receives it, too."""
        heard_at = self._participant.matched_writers(self._requests).get(request.writer)
        if heard_at is None or time.monotonic() < heard_at + _SETTLED:
            with self._lock:
                self._early.append(request)

    def review(self) -> None:
        """Write replies whose clients are now known; pass on early requests whose numbers are known."""
        now = time.monotonic()
        with self._lock:
            late, self._late = self._late, deque()
        for due, client, number, response in late:
            if now < due:
                self._reply(client, number, response, due)
        if self._early:
            self._number_early(now)

    @property
    def has_more_to_do(self) -> bool:
        """Whether `review` must be called again soon."""
        return bool(self._late or self._early)

    def close(self) -> None:
        """Stop answering requests, and delete the endpoints."""
        self._participant.remove(self._requests)
        self._participant.remove(self._replies)

    def _on_data(self, sample: Data) -> None:
        with self._lock:
            self._first.setdefault(sample.writer, (sample.number, sample.time))
            numbered = self._numbered.get(sample.writer, ())
            if any(number == sample.number and abs(time_ - sample.time) < _SAME_TIME for number, time_ in numbered):
                return  # already handled: it was first taken from Cyclone's reader
        identity = read_related_identity(sample.inline, sample.order)
        client = sample.writer
        if identity is not None and is_reader(identity[0]) and identity[0].startswith(sample.source):
            client = identity[0]
        self._ask(sample.payload or b"", sample.writer, client, sample.number)

    def _ask(self, body: bytes, writer: bytes, client: bytes, number: int) -> None:
        forward_request(body, self._service, partial(self._reply, client, number), RequestId(writer, number))

    def _reply(self, client: bytes, number: int, response: Any, due: float | None = None) -> None:
        if self._service.destroyed:
            return
        if self._can_reach(client):
            inline = related_identity(client, number)
            self._participant.write(self._replies, to_cdr(response), inline=inline, to=client[:PREFIX])
        else:
            with self._lock:
                self._late.append((due or time.monotonic() + _REPLY_WAITS, client, number, response))
            self._participant.changed()

    def _can_reach(self, client: bytes) -> bool:
        """Return whether the client's reader is known.

        For an early request, only the client's participant is known.
        """
        wanted = client if is_reader(client) else client[:PREFIX]
        return any(reader.startswith(wanted) for reader in self._participant.matched_readers(self._replies))

    def _number_early(self, now: float) -> None:
        """Pass on early requests, numbered in order before the first request that arrived here.

        Requests that wait for too long without a number are dropped.
        """
        heard = self._participant.matched_writers(self._requests)
        with self._lock:
            early, self._early = self._early, []
            ready = {
                early_request.writer for early_request in early if _is_settled(heard.get(early_request.writer), now)
            }
            self._early = [
                early_request
                for early_request in early
                if early_request.writer not in ready and now < early_request.came + _EARLY_WAITS
            ]
        for writer in ready:
            for number, request in self._assign_numbers(
                writer, [early_request for early_request in early if early_request.writer == writer]
            ):
                self._ask(request.body, writer, writer, number)

    def _assign_numbers(self, writer: bytes, early: list[EarlyRequest]) -> list[tuple[int, EarlyRequest]]:
        """Return a writer's early requests that do not arrive here, too, each with its number."""
        last = self._participant.last_of(self._requests, writer)
        with self._lock:
            if writer in self._first:
                number, written_first = self._first[writer]
                last = number - 1
                early = [early_request for early_request in early if early_request.written < written_first - _SAME_TIME]
            numbered = list(zip(range(last - len(early) + 1, last + 1), early, strict=True))
            asked = self._numbered.setdefault(writer, deque(maxlen=_REMEMBERED))
            asked.extend((number, request.written) for number, request in numbered)
        return numbered


class FastClient:
    """The servers on Fast DDS, as a client of this process calls them.

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
        facts = service_facts(os.urandom(16), client, is_server=False)
        request, response = map(dds_type, request_and_response_types(client.type_name))
        self._answers: dict[int, Callable[[Any], None]] = {}
        self._identities: tuple[bytes, ...] = ()
        self._lock = Lock()
        # From now on replies may arrive, including replies to other clients of the service.
        self._replies = participant.add_reader(dds_topic(Role.REPLY, client.name), response, facts, self._on_data)
        self._requests = participant.add_writer(dds_topic(Role.REQUEST, client.name), request, facts)
        self._identities = (self._replies.reader.guid, self._requests.writer.guid)

    def send(self, request: Any, answer: Callable[[Any], None]) -> Callable[[], None]:
        """Write a request; return a function that cancels it."""
        inline = related_identity(self._replies.reader.guid, NO_NUMBER)
        with self._lock:
            number = self._participant.write(self._requests, to_cdr(request), inline=inline)
            self._answers[number] = answer
        return partial(self._forget, number)

    def is_ready(self) -> bool:
        """Return whether a server knows both endpoints of this client; otherwise its reply is lost."""
        listening = {guid[:PREFIX] for guid in self._participant.matched_readers(self._requests)}
        return any(
            heard_at is not None and guid[:PREFIX] in listening and not self._is_dead(guid[:PREFIX])
            for guid, heard_at in self._participant.matched_writers(self._replies).items()
        )

    def close(self) -> None:
        """Delete the endpoints. Pending requests stay unanswered."""
        self._answers.clear()
        self._participant.remove(self._requests)
        self._participant.remove(self._replies)

    def _forget(self, number: int) -> None:
        self._answers.pop(number, None)

    def _on_data(self, sample: Data) -> None:
        identity = read_related_identity(sample.inline, sample.order)
        if identity is None or identity[0] not in self._identities:
            return
        with self._lock:
            answer = self._answers.pop(identity[1], None)
        if answer is not None:
            forward_response(sample.payload or b"", self._client, answer)


def _is_settled(heard_at: float | None, now: float) -> bool:
    return heard_at is not None and now >= heard_at + _SETTLED
