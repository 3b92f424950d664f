"""The participants, nodes and endpoints of other processes."""

from __future__ import annotations

import os
import time
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from typing import Protocol

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.qos.profile import QoSProfile
from linkwright.wire.dds.discovery_info import NodeEntities, ParticipantEntities
from linkwright.wire.dds.names import (
    DISCOVERY_TOPIC,
    Role,
    RosName,
    parse_ros_name,
    parse_service_type,
)
from linkwright.wire.dds.participant import NAME, read_process_namespace
from linkwright.wire.remote_entities import RemoteEntities
from linkwright.wire.type_names import to_ros_type

_FAST_DDS_VENDOR = b"\x01\x0f"
"""The prefix of the GUIDs of entities of Fast DDS."""

_PREFIX_SIZE = 12
"""The number of bytes of a GUID that identify the participant."""

_FIRST_ENDPOINT_TIMEOUT_S = 1.3
"""Seconds within which a participant's first endpoint is discovered. Fast DDS repeats lost announcements after 1 s."""

_ANNOUNCEMENT_TIMEOUT_S = 3.0
"""Seconds within which a participant that reads announcements sends one, and its endpoints are discovered."""


@dataclass(slots=True)
class RemoteParticipant:
    """A participant in the domain: another process, or a part of one.

    Attributes:
        guid: the participant's GUID, 16 bytes.
        enclave: the security enclave from the USER_DATA.
        entity_name: the name that the participant announces for itself.
        peer_process: for a participant that does not belong to Linkwright, the id of its process if it runs on this
            machine.
        host: the machine that the participant runs on; empty if it is not announced.
        entities: the participant's announcement in ``ros_discovery_info``; None until it arrives.
    """

    guid: bytes
    enclave: str = "/"
    entity_name: str = ""
    peer_process: int | None = None
    host: str = ""
    entities: ParticipantEntities | None = None
    discovered_at: float = field(default_factory=time.monotonic)
    """The steady time at which the participant was discovered, in seconds."""

    def endpoints(self) -> set[bytes]:
        """Return the GUIDs of the endpoints that the participant announces for its nodes."""
        return {gid for node in (self.entities.nodes if self.entities else ()) for gid in _iterate_gids(node)}

    @property
    def is_ours(self) -> bool:
        """Whether the participant belongs to Linkwright.

        Such a participant does not indicate a ROS 2 distribution.
        """
        return self.entity_name.startswith(NAME + "/")

    @property
    def process(self) -> int | None:
        """The id of the participant's process, or None unless it is known to run on this machine."""
        if not self.is_ours:
            return self.peer_process
        _, _, process_path = self.entity_name.partition("/")
        namespace, _, process = process_path.partition("/")
        if not namespace or namespace != read_process_namespace() or not process.isdecimal():
            return None
        return int(process)

    def has_died(self) -> bool:
        """Return whether the participant's process has ended before the lease expired.

        This is known only for processes on this machine.
        """
        return self.process is not None and not is_process_running(self.process)


@dataclass(frozen=True, slots=True)
class RemoteEndpoint:
    """A reader or a writer of another participant.

    Attributes:
        guid: the endpoint's GUID, 16 bytes.
        handle: Cyclone's handle of the endpoint in this process.
        participant: the GUID of the endpoint's participant.
        is_writer: whether the endpoint is a writer.
        topic: the DDS topic.
        type_name: the DDS type.
        qos: the policies.
        user_data: the entries of the USER_DATA.
    """

    guid: bytes
    handle: int
    participant: bytes
    is_writer: bool
    topic: str
    type_name: str
    qos: QoSProfile
    user_data: dict[str, str] = field(default_factory=dict)

    @property
    def name(self) -> RosName | None:
        """The ROS name of the DDS topic, or None if the topic does not belong to ROS."""
        return parse_ros_name(self.topic)

    @property
    def is_fast(self) -> bool:
        """Whether the endpoint belongs to a participant of Fast DDS (RTPS vendor 1.15)."""
        return is_fast(self.guid)

    def endpoint_info(self, node: NodeIdentity | None, host: str = "") -> EndpointInfo | None:
        """Return the description of the endpoint in ROS terms.

        Returns None for an endpoint outside ROS, and for the second half of a service or client.

        Args:
            node: the node that the endpoint belongs to, if known.
            host: the machine that the endpoint is on.
        """
        name = self.name
        if name is None:
            return None
        if name.role is Role.TOPIC:
            endpoint_kind = EndpointKind.PUBLISHER if self.is_writer else EndpointKind.SUBSCRIPTION
            type_name = to_ros_type(self.type_name)
        elif name.role is Role.REQUEST:
            endpoint_kind = EndpointKind.CLIENT if self.is_writer else EndpointKind.SERVICE
            type_name = parse_service_type(self.type_name)
        else:
            return None
        if type_name is None:
            return None
        # rmw_fastrtps announces the hash of the request or response type. Other implementations announce the hash of
        # the service type.
        announces_hash = name.role is Role.TOPIC or not self.is_fast
        type_hash = self.user_data.get("typehash", "") if announces_hash else ""
        return EndpointInfo(endpoint_kind, node, name.name, type_name, self.qos, self.guid, type_hash, host=host)


class DepartureWatch(Protocol):
    """Receives notifications about endpoints that disappear.

    `wire.dds.departures.DdsDepartureMonitor` implements this protocol.
    """

    def on_endpoint_left(self, endpoint: RemoteEndpoint, node: NodeIdentity | None) -> None:
        """Handle the disappearance of an endpoint.

        Args:
            endpoint: the endpoint.
            node: the node that still announces the endpoint; None if the endpoint was withdrawn.
        """

    def on_announcement(self, participant: bytes, endpoints: Collection[bytes]) -> None:
        """Handle an announcement of the current endpoints of a participant's nodes."""


class RemoteGraph(RemoteEntities):
    """The nodes and endpoints of other processes.

    `RemoteEntities` describes the thread safety.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lock = Lock()
        self._participants: dict[bytes, RemoteParticipant] = {}
        self._endpoints: dict[bytes, RemoteEndpoint] = {}
        self._by_handle: dict[int, RemoteEndpoint] = {}
        self._early_announcements: dict[bytes, ParticipantEntities] = {}
        self._dead_cache: tuple[float, frozenset[bytes]] = (0.0, frozenset())
        self.departures: DepartureWatch | None = None
        """The receiver of notifications of endpoints that disappear, or None."""

    # --- called by discovery ------------------------------------------------------------------------------------

    def add_participant(self, participant: RemoteParticipant) -> None:
        """Record a participant."""
        with self._lock:
            previous = self._participants.get(participant.guid)
            early_announcement = self._early_announcements.pop(participant.guid, None)
            participant.entities = previous.entities if previous else early_announcement
            if previous is not None:
                participant.discovered_at, participant.peer_process = previous.discovered_at, previous.peer_process
                participant.host = participant.host or previous.host
            self._participants[participant.guid] = participant

    def remove_participant(self, guid: bytes) -> None:
        """Remove a participant and its endpoints."""
        with self._lock:
            for endpoint in [endpoint for endpoint in self._endpoints.values() if endpoint.participant == guid]:
                self._remove_endpoint(endpoint)
            self._participants.pop(guid, None)
            self._early_announcements.pop(guid, None)

    def add_endpoint(self, endpoint: RemoteEndpoint) -> None:
        """Record a reader or writer."""
        with self._lock:
            self._endpoints[endpoint.guid] = endpoint
            self._by_handle[endpoint.handle] = endpoint

    def remove_endpoint(self, guid: bytes) -> None:
        """Remove a reader or writer."""
        with self._lock:
            endpoint = self._endpoints.get(guid)
            if endpoint is not None:
                self._remove_endpoint(endpoint)

    def on_entities_announced(self, entities: ParticipantEntities) -> None:
        """Record the nodes that a participant announces.

        The announcement may arrive before the participant is known.
        """
        with self._lock:
            participant = self._participants.get(entities.participant)
            if participant is None:
                self._early_announcements[entities.participant] = entities
            else:
                participant.entities = entities
            if self.departures is not None:
                self.departures.on_announcement(
                    entities.participant, {gid for node in entities.nodes for gid in _iterate_gids(node)}
                )

    def _remove_endpoint(self, endpoint: RemoteEndpoint) -> None:
        if self.departures is not None:
            self.departures.on_endpoint_left(endpoint, self._find_owner(endpoint))
        self._endpoints.pop(endpoint.guid, None)
        self._by_handle.pop(endpoint.handle, None)

    # --- queries of the transport -------------------------------------------------------------------------------

    def endpoint(self, handle: int) -> RemoteEndpoint | None:
        """Return the reader or writer with a handle, or None if it is not known."""
        return self._by_handle.get(handle)

    def find_topic_endpoints(self, topic: str, *, writers: bool) -> list[RemoteEndpoint]:
        """Return the writers or the readers of a DDS topic."""
        with self._lock:
            return [
                endpoint
                for endpoint in self._endpoints.values()
                if endpoint.topic == topic and endpoint.is_writer is writers
            ]

    def participants(self) -> list[RemoteParticipant]:
        """Return all participants."""
        with self._lock:
            return list(self._participants.values())

    def fast_participants(self) -> set[bytes]:
        """Return the GUID prefixes of the Fast DDS participants, except those known to be killed."""
        dead = self._find_dead_participants()
        with self._lock:
            return {guid[:_PREFIX_SIZE] for guid in self._participants if is_fast(guid) and guid not in dead}

    def is_read_by_fast(self, topic: str) -> bool:
        """Return whether a Fast DDS participant reads a DDS topic.

        Participants that are known to have been killed do not count.
        """
        dead = self._find_dead_participants()
        readers = self.find_topic_endpoints(topic, writers=False)
        return any(reader.is_fast and reader.participant not in dead for reader in readers)

    def is_dead(self, prefix: bytes) -> bool:
        """Return whether a participant, given by its GUID prefix, is known to have been killed."""
        return any(guid.startswith(prefix) for guid in self._find_dead_participants())

    def have_all_announced(self) -> bool:
        """Return whether every participant that can announce its nodes has announced them.

        Such a participant has a writer of ``ros_discovery_info``.
        """
        with self._lock:
            announcers = {
                endpoint.participant
                for endpoint in self._endpoints.values()
                if endpoint.is_writer and endpoint.topic == DISCOVERY_TOPIC
            }
            return all(
                participant.entities is not None
                for guid, participant in self._participants.items()
                if guid in announcers or participant.is_ours
            )

    def is_complete(self) -> bool:
        """Return whether discovery is complete.

        Discovery is complete when all participants have announced their nodes, and the endpoints of those nodes are
        known. A participant that listens to announcements belongs to ROS and will announce its own nodes. For a
        participant without known endpoints, discovery waits briefly. A participant that has been known for longer
        than the time limit counts only if it has announced itself to ROS.
        """
        now = time.monotonic()
        with self._lock:
            participants_with_endpoints = {endpoint.participant for endpoint in self._endpoints.values()}
            listeners = {
                endpoint.participant for endpoint in self._endpoints.values() if endpoint.topic == DISCOVERY_TOPIC
            }
            for guid, participant in self._participants.items():
                age = now - participant.discovered_at
                if guid not in participants_with_endpoints and age < _FIRST_ENDPOINT_TIMEOUT_S:
                    return False
                # Fast DDS may announce readers up to a second before writers.
                if age < _ANNOUNCEMENT_TIMEOUT_S and guid in listeners and participant.entities is None:
                    return False
                if age < _ANNOUNCEMENT_TIMEOUT_S and not self._endpoints.keys() >= participant.endpoints():
                    return False
        return self.have_all_announced()

    def find_linkwright_process_ids(self) -> set[int]:
        """Return the known process ids of running Linkwright processes on this machine."""
        own_participants = [
            participant for participant in self.participants() if participant.is_ours and not participant.has_died()
        ]
        return {participant.process for participant in own_participants if participant.process is not None}

    def nodes(self) -> list[NodeIdentity]:
        """Return the nodes of other processes, in the order of their participants.

        If several nodes have the same name, each is included.
        """
        dead = self._find_dead_participants()
        with self._lock:
            return [
                NodeIdentity(node.name, node.namespace, participant.enclave)
                for guid, participant in self._participants.items()
                if guid not in dead and participant.entities is not None
                for node in participant.entities.nodes
            ]

    def endpoints(self) -> list[EndpointInfo]:
        """Return the topic and service endpoints of other processes, in ROS terms."""
        dead = self._find_dead_participants()
        with self._lock:
            owners = self._find_owners()
            return [
                info
                for endpoint in self._endpoints.values()
                if endpoint.participant not in dead
                and (info := endpoint.endpoint_info(owners.get(endpoint.guid), self._find_host(endpoint))) is not None
            ]

    def _find_host(self, endpoint: RemoteEndpoint) -> str:
        participant = self._participants.get(endpoint.participant)
        return participant.host if participant else ""

    def find_node_name(self, endpoint: RemoteEndpoint) -> str:
        """Return the full name of the node that owns an endpoint.

        The name is empty until the node is announced.
        """
        with self._lock:
            owner = self._find_owner(endpoint)
        return owner.full_name if owner else ""

    def _find_owner(self, endpoint: RemoteEndpoint) -> NodeIdentity | None:
        participant = self._participants.get(endpoint.participant)
        if participant is None or participant.entities is None:
            return None
        for node in participant.entities.nodes:
            if endpoint.guid in _iterate_gids(node):
                return NodeIdentity(node.name, node.namespace, participant.enclave)
        return None

    def find_participant_writers(self, participant: bytes) -> list[tuple[RemoteEndpoint, NodeIdentity | None]]:
        """Return a participant's writers with their nodes.

        The node is None until it is announced.
        """
        with self._lock:
            writers = [
                endpoint
                for endpoint in self._endpoints.values()
                if endpoint.participant == participant and endpoint.is_writer
            ]
            return [(writer, self._find_owner(writer)) for writer in writers]

    def _find_owners(self) -> dict[bytes, NodeIdentity]:
        return {
            gid: NodeIdentity(node.name, node.namespace, participant.enclave)
            for participant in self._participants.values()
            if participant.entities is not None
            for node in participant.entities.nodes
            for gid in _iterate_gids(node)
        }

    def _find_dead_participants(self) -> frozenset[bytes]:
        """Return the GUIDs of participants whose process was killed.

        The result is cached briefly.
        """
        now = time.monotonic()
        checked_at, dead = self._dead_cache
        if now - checked_at > 0.25:
            dead = frozenset(participant.guid for participant in self.participants() if participant.has_died())
            self._dead_cache = (now, dead)
        return dead


def is_process_running(process: int) -> bool:
    """Return whether a process with the given id is running on this machine."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return not _is_zombie(process)


def _is_zombie(process: int) -> bool:
    """Return whether a process is a zombie: it has ended, but its parent has not waited for it.

    On systems other than Linux, the result is always False.
    """
    try:
        stat = Path(f"/proc/{process}/stat").read_bytes()
    except OSError:
        return False
    return stat.rpartition(b")")[2].split()[0] in (b"Z", b"X")


def is_fast(guid: bytes) -> bool:
    """Return whether an entity belongs to a participant of Fast DDS (RTPS vendor 1.15)."""
    return guid.startswith(_FAST_DDS_VENDOR)


def _iterate_gids(node: NodeEntities) -> Iterator[bytes]:
    yield from node.readers
    yield from node.writers
