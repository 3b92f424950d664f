"""Creates, serves and deletes the mirrors of this process's endpoints in a domain.

There are two threads. One thread creates and deletes readers and writers in the order of the requests, and updates the
tables of the remote graph. The other thread takes samples and passes them on.
"""

from __future__ import annotations

import time
from typing import Any

from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.dds.cyclone import CycloneError
from linkwright.wire.dds.departures import DdsDepartureMonitor
from linkwright.wire.dds.discovery import Discovery
from linkwright.wire.dds.discovery_info import NodeEntities
from linkwright.wire.dds.domain import Domain
from linkwright.wire.dds.pacing import Pacer
from linkwright.wire.dds.participant import SERVICES_NAME, Participant
from linkwright.wire.dds.presences import QuietClient, QuietReader, open_presence
from linkwright.wire.dds.remote import RemoteGraph
from linkwright.wire.dds.rtps.participant import RtpsParticipant
from linkwright.wire.dds.rtps.values import Address
from linkwright.wire.dds.services import IncomingService, RemoteServer
from linkwright.wire.dds.settings import Range, Settings
from linkwright.wire.dds.topics import IncomingTopic, OutgoingTopic
from linkwright.wire.dds.waiting import WaitingThread
from linkwright.wire.engine import Engine as AnyEngine
from linkwright.wire.engine import Work, is_ending_by_error

CLOSING_TIMEOUT_S = 1.0
"""The maximum time, in seconds, for which closing waits until reliable samples are acknowledged."""

_POLL_INTERVAL_S = 0.01
_NODE_NAME_TIMEOUT_S = 1.0
"""Seconds within which a participant announces which node an endpoint belongs to."""

_MAX_ANNOUNCE_DELAY_S = 0.1
"""Seconds after which new nodes are announced even if more nodes are being created."""

_FIRST_ANNOUNCE_SPAN_S = 1.0
"""The same for the first announcement, which other processes regard as complete."""


class Engine(AnyEngine):
    """A participant with its readers and writers.

    Args:
        settings: the domain and how to join it.
        remote: the tables to fill.
        departures: decides whether remote publishers that disappeared were lost.
        work: the queue of requests; other threads append to it and call `wake`.
        logger: logs problems.

    Raises:
        LinkwrightError: the domain cannot be joined.
    """

    library_error = CycloneError

    def __init__(
        self,
        settings: Settings,
        remote: RemoteGraph,
        departures: DdsDepartureMonitor,
        work: Work,
        logger: Logger,
    ) -> None:
        super().__init__(work, logger)
        self._remote = remote
        self._departures = departures
        self._settings = settings
        self._fast: RtpsParticipant | None = None
        self._is_fast_possible = settings.range is not Range.OFF
        self._participant = Participant(settings)
        types = self._participant.types
        self._pacer = Pacer(self._find_fast_address)
        self._domain = Domain(self._participant, remote, types, settings.fragment_size, self._pacer)
        owner = self._participant.entity
        self._control = WaitingThread("linkwright-dds", owner, self._report, self._process_pending)
        self._reception = WaitingThread("linkwright-dds-receive", owner, self._report)
        self._discovery = Discovery(self._participant, self._control, remote, types, settings.gid_size)
        self._nodes: dict[NodeIdentity, int] = {}
        self._outgoing: dict[Any, OutgoingTopic] = {}
        self._incoming: dict[Any, IncomingTopic] = {}
        self._services: dict[Any, IncomingService] = {}
        self._clients: dict[Any, RemoteServer] = {}
        self._presences: dict[Any, QuietReader | QuietClient] = {}
        self._closing_deadlines: dict[OutgoingTopic, float] = {}
        self._waiting: dict[OutgoingTopic, None] = {}
        self._is_announced = False
        self._announced_at = time.monotonic()
        self._max_announce_delay = _FIRST_ANNOUNCE_SPAN_S
        self._matches_changed = False
        self._mismatch_deadlines: dict[OutgoingTopic | IncomingTopic, float] = {}

    def start(self) -> None:
        """Start the threads."""
        self._control.start()
        self._reception.start()

    def wake(self) -> None:
        """Wake the thread that processes the queue of requests.

        Any thread may call this method.
        """
        self._control.wake()

    def close(self) -> None:
        """Leave the domain, after waiting at most a second for reliable samples to be acknowledged.

        The departure of our nodes is announced, unless the process ends because of an error (`departures`).
        """
        self._control.stop(CLOSING_TIMEOUT_S)
        self._reception.stop(CLOSING_TIMEOUT_S)
        self._process_all_requests()
        self.abandon()
        if not is_ending_by_error():
            self._discovery.publish([])
        deadline = time.monotonic() + CLOSING_TIMEOUT_S
        for topic in (*self._outgoing.values(), *self._closing_deadlines):
            if not topic.wait_until_acknowledged(max(0, int((deadline - time.monotonic()) * 1e9))):
                break
        self._pacer.stop(CLOSING_TIMEOUT_S)
        if self._fast is not None:
            self._fast.close()
        self._participant.close()

    def abandon(self) -> None:
        """Stop sending, without calling Cyclone."""
        for topic in self._outgoing.values():
            topic.abandon()
        for client in self._clients.values():
            client.abandon()

    # --- work in the thread that creates and deletes endpoints -------------------------------------------------------

    def add_node(self, node: NodeIdentity) -> None:
        """Announce a node."""
        self._nodes[node] = self._nodes.get(node, 0) + 1
        self._is_announced = False

    def remove_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""
        count = self._nodes.pop(node, 0) - 1
        if count > 0:
            self._nodes[node] = count
        self._is_announced = False

    def open_publisher(self, publisher: Any) -> None:
        """Mirror a publisher."""
        try:
            topic = OutgoingTopic(publisher, self._domain, self._on_mismatch, self._on_waiting)
        except BaseException:
            publisher.set_remote_sender(None)
            raise
        self._outgoing[publisher] = topic
        self._control.attach(topic.entity, topic.on_status)
        self._is_announced = False

    def close_publisher(self, publisher: Any) -> None:
        """Delete a publisher's writer once its samples are acknowledged, or after a second."""
        topic = self._outgoing.pop(publisher, None)
        if topic is not None:
            self._control.detach(topic.entity)
            topic.abandon()
            self._closing_deadlines[topic] = time.monotonic() + CLOSING_TIMEOUT_S
            self._is_announced = False

    def open_subscription(self, subscription: Any) -> None:
        """Mirror a subscription."""
        topic = IncomingTopic(subscription, self._domain, self._on_mismatch)
        self._incoming[subscription] = topic
        self._reception.attach(topic.entity, topic.on_status)
        self._is_announced = False

    def open_service(self, service: Any) -> None:
        """Mirror a service."""
        incoming = IncomingService(service, self._domain, self._control.wake)
        self._services[service] = incoming
        self._connect_fast(incoming)
        self._reception.attach(incoming.pair.reader, incoming.on_data)
        self._is_announced = False

    def open_client(self, client: Any) -> None:
        """Mirror a client."""
        remote_server = RemoteServer(client, self._domain, self._on_match)
        self._clients[client] = remote_server
        self._connect_fast(remote_server)
        self._reception.attach(remote_server.pair.reader, remote_server.on_data)
        self._control.attach(remote_server.pair.writer, remote_server.on_writer_status)
        self._is_announced = False

    def open_presence(self, presence: Any) -> None:
        """Announce an endpoint that neither sends nor receives."""
        self._presences[presence] = open_presence(presence, self._domain)
        self._is_announced = False

    def close_endpoint(self, endpoint: Any) -> None:
        """Delete the DDS entities of a subscription, service, client or presence."""
        self._is_announced = False
        presence = self._presences.pop(endpoint, None)
        if presence is not None:
            presence.close()
        topic = self._incoming.pop(endpoint, None)
        if topic is not None:
            self._reception.detach(topic.entity)
            topic.close()
        for mirrors in (self._services, self._clients):
            mirror = mirrors.pop(endpoint, None)
            if mirror is not None:
                self._reception.detach(mirror.pair.reader)
                self._control.detach(mirror.pair.writer)
                mirror.close()

    # --- between requests --------------------------------------------------------------------------------------------

    def _process_pending(self) -> float | None:
        """Process requests, and handle the results of discovery.

        Returns:
            The seconds until the next call, or None if no call is needed.
        """
        self._process_some_requests()
        self._handle_discovery()
        self._close_finished_topics()
        self._write_waiting()
        has_late_replies = self._write_pending_replies()
        self._log_mismatches()
        self._announce()
        next_request, next_check = self._discovery.request_missing_nodes(), self._departures.report_lost_publishers()
        if self._work:
            return 0.0
        if self._closing_deadlines or self._waiting or self._mismatch_deadlines or has_late_replies:
            return _POLL_INTERVAL_S
        return min((seconds for seconds in (next_request, next_check) if seconds is not None), default=None)

    def _handle_discovery(self) -> None:
        matches_changed, self._matches_changed = self._matches_changed, False
        has_changed, self._discovery.changed = self._discovery.changed, False
        if has_changed:
            self._discovery.update_gid_size()
            self._discover_fast()
        if has_changed or matches_changed:
            for client in tuple(self._clients.values()):
                client.update_availability()
        if has_changed:
            self._remote.announce()

    def _connect_fast(self, mirror: IncomingService | RemoteServer) -> None:
        """Announce a new service or client to the Fast DDS participants, if there are any."""
        if self._fast is None:
            self._discover_fast()
        else:
            mirror.connect_fast(self._fast)

    def _discover_fast(self) -> None:
        """Create the participant for Fast DDS if needed, and look for new participants.

        This participant is needed once a Fast DDS participant exists and this process has a service or a client.
        """
        fast_participants = self._remote.fast_participants()
        if self._fast is None and self._is_fast_possible and fast_participants and (self._services or self._clients):
            self._is_fast_possible = False
            try:
                self._fast = RtpsParticipant(self._settings, SERVICES_NAME, self._on_match)
            except OSError as error:
                self._logger.warning(f"Services and clients of nodes on Fast DDS are out of reach: {error}")
                return
            for service in self._services.values():
                service.connect_fast(self._fast)
            for client in self._clients.values():
                client.connect_fast(self._fast)
        if self._fast is not None:
            self._fast.expect(fast_participants)

    def _find_fast_address(self, reader: bytes) -> Address | None:
        """Return the address of a Fast DDS reader on this machine, or None if it is not known."""
        return None if self._fast is None else self._fast.find_reader_address(reader)

    def _on_match(self) -> None:
        self._matches_changed = True
        self._control.wake()

    def _on_waiting(self, topic: OutgoingTopic) -> None:
        """Record a topic whose messages wait for acknowledgments.

        Any thread may call this method.
        """
        if topic not in self._waiting:
            self._waiting[topic] = None
            self._control.wake()

    def _write_waiting(self) -> None:
        """Write the samples that waited for acknowledgments and can now be written."""
        for topic in tuple(self._waiting):
            del self._waiting[topic]  # removed first: an acknowledgment that arrives now adds it again
            if topic.write_queued():
                self._waiting[topic] = None

    def _on_mismatch(self, topic: OutgoingTopic | IncomingTopic) -> None:
        self._mismatch_deadlines[topic] = time.monotonic() + _NODE_NAME_TIMEOUT_S
        self._control.wake()

    def _log_mismatches(self) -> None:
        """Report incompatible QoS once the node names are known, or after a timeout."""
        for topic, deadline in tuple(self._mismatch_deadlines.items()):
            is_due = time.monotonic() >= deadline
            topic.log_mismatches(include_unnamed=is_due)
            if is_due:
                self._mismatch_deadlines.pop(topic, None)

    def _write_pending_replies(self) -> bool:
        busy_services = [service for service in tuple(self._services.values()) if service.has_pending_work]
        for service in busy_services:
            service.write_pending_replies()
        return any(service.has_pending_work for service in busy_services)

    def _close_finished_topics(self) -> None:
        now = time.monotonic()
        for topic, deadline in tuple(self._closing_deadlines.items()):
            if now >= deadline or topic.wait_until_acknowledged(0):
                del self._closing_deadlines[topic]
                self._waiting.pop(topic, None)
                topic.close()

    def _announce(self) -> None:
        """Announce our nodes if they have changed.

        Several changes in a row are announced together.
        """
        if not self._is_announced and (
            not self._work or time.monotonic() - self._announced_at > self._max_announce_delay
        ):
            self._discovery.publish(self._make_node_entities())
            self._is_announced = True
            self._max_announce_delay = _MAX_ANNOUNCE_DELAY_S
            self._announced_at = time.monotonic()

    def _make_node_entities(self) -> list[NodeEntities]:
        readers: dict[NodeIdentity, list[bytes]] = {node: [] for node in self._nodes}
        writers: dict[NodeIdentity, list[bytes]] = {node: [] for node in self._nodes}
        for publisher, outgoing in self._outgoing.items():
            writers.setdefault(publisher.node.identity, []).append(outgoing.guid)
        for subscription, incoming in self._incoming.items():
            readers.setdefault(subscription.node.identity, []).append(incoming.guid)
        for mirrors in (self._services, self._clients):
            for endpoint, mirror in mirrors.items():
                readers.setdefault(endpoint.node.identity, []).append(mirror.pair.reader_guid)
                writers.setdefault(endpoint.node.identity, []).append(mirror.pair.writer_guid)
        for presence, quiet_mirror in self._presences.items():
            readers.setdefault(presence.node.identity, []).append(quiet_mirror.reader_guid)
            writers.setdefault(presence.node.identity, []).extend(quiet_mirror.writer_guids)
        nodes = []
        for node, count in self._nodes.items():
            nodes.append(NodeEntities(node.namespace, node.name, readers[node], writers[node]))
            nodes += [NodeEntities(node.namespace, node.name)] * (count - 1)
        return nodes
