"""An RTPS participant with readers and writers of services, for Fast DDS.

All participants in the domain learn that this participant exists, because the address of a Fast DDS participant is not
known before it has answered. Endpoints are announced only to Fast DDS.
"""

from __future__ import annotations

import os
import select
import socket
import threading
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from linkwright.wire.dds.rtps import values as v
from linkwright.wire.dds.rtps.discovery_data import (
    EndpointData,
    ParticipantData,
    describe_endpoint,
    describe_participant,
    find_departed_guid,
    make_key_parameters,
    read_endpoint,
    read_participant,
)
from linkwright.wire.dds.rtps.messages import (
    AckNack,
    Data,
    Gap,
    Heartbeat,
    NackFrag,
    Submessage,
    acknack,
    build_message,
    data,
    heartbeat,
    parse,
    read_vendor,
)
from linkwright.wire.dds.rtps.network import Network
from linkwright.wire.dds.rtps.reader import Reader
from linkwright.wire.dds.rtps.values import Address, MalformedError
from linkwright.wire.dds.rtps.writer import Packet, Writer
from linkwright.wire.dds.settings import Settings
from linkwright.wire.guarded_calls import call_guarded

_LEASE_S = 10.0
_ANNOUNCEMENT_INTERVAL_S = 3.0
_SEARCH_INTERVALS_S = (0.0, 0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.0)
"""Seconds between the messages that search for a participant. The last interval is repeated."""

_MAX_EARLY_SAMPLES = 64
"""The maximum number of stored samples whose writers are not known yet."""

_MAX_WAIT_S = 1.0


@dataclass(slots=True)
class _Peer:
    participant: ParticipantData
    expires_at: float
    discovery_addresses: tuple[Address, ...]
    user_addresses: tuple[Address, ...]
    endpoints: dict[bytes, EndpointData] = field(default_factory=dict)


@dataclass(eq=False, slots=True)
class LocalReader:
    """One of our readers, created by `RtpsParticipant.add_reader`."""

    reader: Reader
    topic: str
    type_name: str
    announced: int
    on_data: Callable[[Data], None]


@dataclass(eq=False, slots=True)
class LocalWriter:
    """One of our writers, created by `RtpsParticipant.add_writer`."""

    writer: Writer
    topic: str
    type_name: str
    announced: int


class RtpsParticipant:
    """An RTPS participant with its socket and thread.

    Args:
        settings: the domain and the discovery range.
        name: the name that the participant announces for itself.
        on_change: called when a remote reader or writer was matched, has sent its first packet or has left. The call
            is made in the participant's thread or in the caller's thread.

    Raises:
        OSError: no socket is available.
    """

    def __init__(self, settings: Settings, name: str, on_change: Callable[[], None]) -> None:
        self.prefix = v.OWN_VENDOR + os.urandom(v.PREFIX_SIZE - len(v.OWN_VENDOR))
        self.changed = on_change
        """Called when the graph may have changed; see the argument."""
        self._network = Network(settings)
        self._self = describe_participant(self.prefix, name, _LEASE_S, self._network.addresses)
        self._lock = threading.RLock()
        self._peers: dict[bytes, _Peer] = {}
        self._expected_prefixes: frozenset[bytes] = frozenset()
        self._search_count = 0
        self._search_at = 0.0
        self._announce_at = 0.0
        self._announcement_count = 0
        self._last_entity = 0
        self._count = 0
        self._publications_writer = Writer(self.prefix + v.PUBLICATIONS_WRITER, keeps_history=True)
        self._subscriptions_writer = Writer(self.prefix + v.SUBSCRIPTIONS_WRITER, keeps_history=True)
        self._publications_reader = Reader(self.prefix + v.PUBLICATIONS_READER)
        self._subscriptions_reader = Reader(self.prefix + v.SUBSCRIPTIONS_READER)
        self._readers: dict[bytes, LocalReader] = {}
        self._writers: dict[bytes, LocalWriter] = {}
        self._early_samples: list[Data] = []
        self._is_closing = False
        self._wake_receiver, self._wake_sender = socket.socketpair()
        self._wake_receiver.setblocking(False)
        self._wake_sender.setblocking(False)
        self._thread = threading.Thread(target=self._run, name="linkwright-rtps", daemon=True)
        self._thread.start()

    # --- called by services and clients ------------------------------------------------------------------------------

    def add_reader(self, topic: str, type_name: str, user_data: bytes, on_data: Callable[[Data], None]) -> LocalReader:
        """Create a reader.

        Args:
            topic: the DDS topic.
            type_name: the DDS type.
            user_data: the reader's USER_DATA.
            on_data: called in the participant's thread with each sample.
        """
        with self._lock:
            guid = self._create_guid(v.READER_KIND)
            packets = self._subscriptions_writer.write(
                describe_endpoint(guid, topic, type_name, user_data), inline=make_key_parameters(guid)
            )
            local = LocalReader(Reader(guid), topic, type_name, self._subscriptions_writer.last, on_data)
            self._readers[guid[v.PREFIX_SIZE :]] = local
            packets += self._match_all(topic)
        self._network.send(packets)
        return local

    def add_writer(self, topic: str, type_name: str, user_data: bytes) -> LocalWriter:
        """Create a writer. See `add_reader` for the arguments."""
        with self._lock:
            guid = self._create_guid(v.WRITER_KIND)
            packets = self._publications_writer.write(
                describe_endpoint(guid, topic, type_name, user_data), inline=make_key_parameters(guid)
            )
            local = LocalWriter(Writer(guid), topic, type_name, self._publications_writer.last)
            self._writers[guid[v.PREFIX_SIZE :]] = local
            packets += self._match_all(topic)
        self._network.send(packets)
        self._wake()
        return local

    def remove(self, local: LocalReader | LocalWriter) -> None:
        """Delete a reader or writer."""
        is_reader = isinstance(local, LocalReader)
        guid = local.reader.guid if isinstance(local, LocalReader) else local.writer.guid
        announcer = self._subscriptions_writer if is_reader else self._publications_writer
        with self._lock:
            self._readers.pop(guid[v.PREFIX_SIZE :], None)
            self._writers.pop(guid[v.PREFIX_SIZE :], None)
            announcer.withdraw(local.announced)
            packets = announcer.write(None, inline=make_key_parameters(guid, is_gone=True))
        self._network.send(packets)

    def write(self, local: LocalWriter, payload: bytes, *, inline: bytes = b"", to: bytes = b"") -> int:
        """Write a sample. See `Writer.write` for the arguments.

        Returns:
            The sequence number of the sample.
        """
        with self._lock:
            packets = local.writer.write(payload, inline=inline, to=to)
            sequence_number = local.writer.last
        self._network.send(packets)
        self._wake()
        return sequence_number

    def find_matched_readers(self, local: LocalWriter) -> list[bytes]:
        """Return the GUIDs of the remote readers that match one of our writers."""
        with self._lock:
            return list(local.writer.readers)

    def find_matched_writers(self, local: LocalReader) -> dict[bytes, float | None]:
        """Return the GUIDs of the writers that match one of our readers, each with a time.

        The time is when the writer's first heartbeat arrived, in seconds of the steady clock; None if none has arrived.
        """
        with self._lock:
            return {guid: local.reader.heard_at(guid) for guid in local.reader.writers}

    def find_reader_address(self, reader: bytes) -> Address | None:
        """Return the address of a remote reader on this machine, or None if it is not known."""
        with self._lock:
            peer = self._peers.get(reader[: v.PREFIX_SIZE])
            endpoint = peer.endpoints.get(reader) if peer is not None else None
            if peer is None or endpoint is None:
                return None
            addresses = self._network.choose_addresses(endpoint.addresses) or peer.user_addresses
        return next((address for address in addresses if self._network.is_local(address[0])), None)

    def get_last_number(self, local: LocalReader, writer: bytes) -> int:
        """Return the highest sequence number that a writer has announced to one of our readers."""
        with self._lock:
            return local.reader.get_last_number(writer)

    def expect(self, prefixes: Iterable[bytes]) -> None:
        """Look for participants that were discovered elsewhere, until each has answered."""
        with self._lock:
            expected_prefixes = frozenset(prefixes)
            if expected_prefixes - self._expected_prefixes:
                self._search_count, self._search_at = 0, 0.0
            self._expected_prefixes = expected_prefixes
        self._wake()

    def close(self) -> None:
        """Announce the departure of the participant, and end the thread."""
        self._is_closing = True
        self._wake()
        if threading.current_thread() is not self._thread:
            self._thread.join()
        self._send_to_peers(self._make_announcement(is_leaving=True))
        self._network.close()
        self._wake_receiver.close()
        self._wake_sender.close()

    # --- the thread ---------------------------------------------------------------------------------------------------

    def _run(self) -> None:
        while not self._is_closing:
            seconds = call_guarded(self._do_due_work)
            timeout = _MAX_WAIT_S if seconds is None else seconds
            readable, _, _ = select.select([self._network.socket, self._wake_receiver], [], [], timeout)
            if self._wake_receiver in readable:
                with suppress(BlockingIOError):
                    self._wake_receiver.recv(4096)
            if self._network.socket in readable:
                self._receive()

    def _receive(self) -> None:
        for _ in range(64):
            received = self._network.receive()
            if received is None:
                return
            packet, source = received
            calls: list[Callable[[], None]] = []
            call_guarded(partial(self._process_and_respond, packet, source, calls))
            for call in calls:
                call_guarded(call)

    def _process_and_respond(self, packet: bytes, source: Address, calls: list[Callable[[], None]]) -> None:
        with self._lock:
            packets = self._process_packet(packet, source, calls)
        self._network.send(packets)

    def _do_due_work(self) -> float:
        """Do the work that is due, and return the seconds until the next work is due."""
        now = time.monotonic()
        packets: list[Packet] = []
        with self._lock:
            expired_prefixes = [prefix for prefix, peer in self._peers.items() if peer.expires_at < now]
            for prefix in expired_prefixes:
                self._remove_peer(prefix)
            must_search = bool(self._expected_prefixes - self._peers.keys()) and now >= self._search_at
            if must_search:
                self._search_at = now + _SEARCH_INTERVALS_S[min(self._search_count + 1, len(_SEARCH_INTERVALS_S) - 1)]
                self._search_count += 1
            must_announce = now >= self._announce_at
            if must_announce:
                self._announce_at = now + _ANNOUNCEMENT_INTERVAL_S
            entities = self._list_entities()
            for entity in entities:
                packets += entity.remind(now)
            due_times = [reminder for entity in entities if (reminder := entity.next_reminder()) is not None]
            due_times.append(self._announce_at)
            if self._expected_prefixes - self._peers.keys():
                due_times.append(self._search_at)
        self._network.send(packets)
        if expired_prefixes:
            self.changed()
        if must_search:
            self._network.send_everywhere(self._make_announcement())
        if must_announce:
            self._send_to_peers(self._make_announcement())
        return max(0.0, min(_MAX_WAIT_S, min(due_times) - time.monotonic()))

    def _list_entities(self) -> list[Reader | Writer]:
        writers = [
            self._publications_writer,
            self._subscriptions_writer,
            *(writer.writer for writer in self._writers.values()),
        ]
        readers = [self._publications_reader, self._subscriptions_reader]
        return [*writers, *readers, *(reader.reader for reader in self._readers.values())]

    def _wake(self) -> None:
        with suppress(OSError):
            self._wake_sender.send(b"!")

    # --- discovery ----------------------------------------------------------------------------------------------------

    def _make_announcement(self, *, is_leaving: bool = False) -> bytes:
        self._announcement_count += 1
        inline = make_key_parameters(self.prefix + v.PARTICIPANT, is_gone=is_leaving)
        payload = None if is_leaving else self._self
        return build_message(self.prefix, data(v.SPDP_READER, v.SPDP_WRITER, self._announcement_count, payload, inline))

    def _send_to_peers(self, packet: bytes) -> None:
        with self._lock:
            peers = list(self._peers.values())
        self._network.send((packet, peer.discovery_addresses) for peer in peers)

    def _on_participant(self, sample: Data, vendor: bytes, calls: list[Callable[[], None]]) -> list[Packet]:
        if find_departed_guid(sample):
            self._remove_peer(find_departed_guid(sample)[: v.PREFIX_SIZE])
            calls.append(self.changed)
            return []
        if sample.payload is None:
            return []
        participant = read_participant(sample.payload)
        if participant.vendor != v.FAST_DDS_VENDOR or vendor != v.FAST_DDS_VENDOR:
            return []
        discovery, user = (
            self._network.choose_addresses(participant.discovery_addresses),
            self._network.choose_addresses(participant.user_addresses),
        )
        expires_at = time.monotonic() + participant.lease_s
        peer = self._peers.get(participant.prefix)
        if peer is not None and peer.participant == participant:
            peer.expires_at = expires_at
            return []
        if not discovery or not user:
            return []
        self._peers[participant.prefix] = _Peer(
            participant, expires_at, discovery, user, peer.endpoints if peer else {}
        )
        packets: list[Packet] = [(self._make_announcement(), discovery)]
        for reader, entity in (
            (self._publications_reader, v.PUBLICATIONS_WRITER),
            (self._subscriptions_reader, v.SUBSCRIPTIONS_WRITER),
        ):
            packets += reader.match(participant.prefix + entity, discovery)
        for writer, entity in (
            (self._publications_writer, v.PUBLICATIONS_READER),
            (self._subscriptions_writer, v.SUBSCRIPTIONS_READER),
        ):
            packets += writer.match(participant.prefix + entity, discovery)
        return packets

    def _remove_peer(self, prefix: bytes) -> None:
        peer = self._peers.pop(prefix, None)
        if peer is None:
            return
        for guid in tuple(peer.endpoints):
            self._unmatch(guid)
        self._publications_reader.unmatch(prefix + v.PUBLICATIONS_WRITER)
        self._subscriptions_reader.unmatch(prefix + v.SUBSCRIPTIONS_WRITER)
        self._publications_writer.unmatch(prefix + v.PUBLICATIONS_READER)
        self._subscriptions_writer.unmatch(prefix + v.SUBSCRIPTIONS_READER)

    def _on_endpoint(self, sample: Data, *, is_writer: bool) -> list[Packet]:
        peer = self._peers[sample.source]
        departed_guid = find_departed_guid(sample)
        if departed_guid:
            peer.endpoints.pop(departed_guid, None)
            self._unmatch(departed_guid)
            return []
        if sample.payload is None:
            return []
        endpoint = read_endpoint(sample.payload, is_writer=is_writer)
        if not endpoint.guid.startswith(sample.source):
            return []
        peer.endpoints[endpoint.guid] = endpoint
        return self._match(endpoint, peer)

    def _match_all(self, topic: str) -> list[Packet]:
        return [
            packet
            for peer in self._peers.values()
            for endpoint in peer.endpoints.values()
            if endpoint.topic == topic
            for packet in self._match(endpoint, peer)
        ]

    def _match(self, endpoint: EndpointData, peer: _Peer) -> list[Packet]:
        if not endpoint.is_reliable:
            return []
        addresses = self._network.choose_addresses(endpoint.addresses) or peer.user_addresses
        packets = []
        if v.is_reader(endpoint.guid):
            for local in self._writers.values():
                if (local.topic, local.type_name) == (endpoint.topic, endpoint.type_name):
                    packets += local.writer.match(endpoint.guid, addresses)
        else:
            for local_reader in self._readers.values():
                if (local_reader.topic, local_reader.type_name) == (endpoint.topic, endpoint.type_name):
                    packets += local_reader.reader.match(endpoint.guid, addresses)
        return packets

    def _unmatch(self, guid: bytes) -> None:
        for local in self._writers.values():
            local.writer.unmatch(guid)
        for local_reader in self._readers.values():
            local_reader.reader.unmatch(guid)

    # --- incoming packets ---------------------------------------------------------------------------------------------

    def _process_packet(self, packet: bytes, source: Address, calls: list[Callable[[], None]]) -> list[Packet]:
        """Process a packet, and return the packets that answer it.

        Callbacks are appended to `calls`, because they must be called without holding the lock.
        """
        packets: list[Packet] = []
        vendor = read_vendor(packet)
        for submessage in parse(packet, self.prefix):
            if submessage.source == self.prefix:
                return []
            peer = self._peers.get(submessage.source)
            if peer is not None:
                peer.expires_at = time.monotonic() + peer.participant.lease_s
            try:
                if isinstance(submessage, Data) and submessage.writer[v.PREFIX_SIZE :] == v.SPDP_WRITER:
                    packets += self._on_participant(submessage, vendor, calls)
                elif peer is not None:
                    packets += self._on_submessage(submessage, calls)
                else:
                    packets += self._on_unmatched_peer(submessage, source)
            except MalformedError:
                break
        return packets

    def _on_unmatched_peer(self, submessage: Submessage, source: Address) -> list[Packet]:
        """Return the packets that answer an unmatched participant.

        They state that no samples are missing on either side.

        After this answer, the participant stops repeating its messages.
        """
        self._count += 1
        if isinstance(submessage, AckNack) and submessage.writer in (v.PUBLICATIONS_WRITER, v.SUBSCRIPTIONS_WRITER):
            response = heartbeat(submessage.reader[v.PREFIX_SIZE :], submessage.writer, 1, 0, self._count, final=True)
        elif isinstance(submessage, Heartbeat) and submessage.writer[v.PREFIX_SIZE :] in (
            v.PUBLICATIONS_WRITER,
            v.SUBSCRIPTIONS_WRITER,
        ):
            response = acknack(
                submessage.reader, submessage.writer[v.PREFIX_SIZE :], submessage.last + 1, (), self._count
            )
        else:
            return []
        return [(build_message(self.prefix, response, to=submessage.source), (source,))]

    def _on_submessage(self, submessage: Submessage, calls: list[Callable[[], None]]) -> list[Packet]:
        if isinstance(submessage, AckNack | NackFrag):
            writer = self._find_writer(submessage.writer)
            if writer is None:
                return []
            if isinstance(submessage, NackFrag):
                return writer.on_nack_frag(submessage)
            had_answered = writer.has_answered(submessage.reader)
            packets = writer.on_acknack(submessage)
            if not had_answered and writer.has_answered(submessage.reader):
                calls.append(self.changed)
            return packets
        if isinstance(submessage, Data):
            return self._on_sample(submessage, calls)
        packets = []
        for reader in self._find_readers(submessage):
            if isinstance(submessage, Gap):
                reader.on_gap(submessage)
                continue
            first_heard_at = reader.heard_at(submessage.writer)
            packets += reader.on_heartbeat(submessage)
            if first_heard_at is None and reader.heard_at(submessage.writer) is not None:
                calls.append(self.changed)
        return packets

    def _on_sample(self, sample: Data, calls: list[Callable[[], None]]) -> list[Packet]:
        builtin = {
            v.PUBLICATIONS_WRITER: (self._publications_reader, True),
            v.SUBSCRIPTIONS_WRITER: (self._subscriptions_reader, False),
        }.get(sample.writer[v.PREFIX_SIZE :])
        if builtin is not None:
            reader, is_writer = builtin
            complete = reader.on_data(sample)
            packets = [] if complete is None else self._on_endpoint(complete, is_writer=is_writer)
            if complete is not None:
                self._deliver_early_samples(calls)
                calls.append(self.changed)
            return packets
        if sample.writer not in self._peers[sample.source].endpoints:
            self._early_samples = [*self._early_samples[-_MAX_EARLY_SAMPLES:], sample]
            return []
        self._deliver(sample, calls)
        return []

    def _deliver(self, sample: Data, calls: list[Callable[[], None]]) -> None:
        for local in self._readers.values():
            if sample.reader in (v.UNKNOWN_ENTITY, local.reader.guid[v.PREFIX_SIZE :]):
                complete = local.reader.on_data(sample)
                if complete is not None:
                    calls.append(partial(local.on_data, complete))

    def _deliver_early_samples(self, calls: list[Callable[[], None]]) -> None:
        """Pass on the samples that arrived before their writer was known."""
        early_samples, self._early_samples = self._early_samples, []
        for sample in early_samples:
            peer = self._peers.get(sample.source)
            if peer is not None and sample.writer in peer.endpoints:
                self._deliver(sample, calls)
            elif peer is not None:
                self._early_samples.append(sample)

    def _find_readers(self, submessage: Heartbeat | Gap) -> Iterable[Reader]:
        entity = submessage.writer[v.PREFIX_SIZE :]
        if entity == v.PUBLICATIONS_WRITER:
            return (self._publications_reader,)
        if entity == v.SUBSCRIPTIONS_WRITER:
            return (self._subscriptions_reader,)
        if submessage.reader == v.UNKNOWN_ENTITY:
            return tuple(reader.reader for reader in self._readers.values())
        local = self._readers.get(submessage.reader)
        return () if local is None else (local.reader,)

    def _find_writer(self, entity: bytes) -> Writer | None:
        if entity == v.PUBLICATIONS_WRITER:
            return self._publications_writer
        if entity == v.SUBSCRIPTIONS_WRITER:
            return self._subscriptions_writer
        local = self._writers.get(entity)
        return local.writer if local is not None else None

    def _create_guid(self, kind: bytes) -> bytes:
        self._last_entity += 1
        return self.prefix + self._last_entity.to_bytes(3, "big") + kind
