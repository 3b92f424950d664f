"""Discovery through Cyclone's builtin topics and ``ros_discovery_info``."""

from __future__ import annotations

import socket
import time
from collections.abc import Callable, Iterator, Sequence
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile
from linkwright.wire.dds.cyclone import (
    ANY_STATE,
    BUILTIN_PARTICIPANTS,
    BUILTIN_PUBLICATIONS,
    BUILTIN_SUBSCRIPTIONS,
    DATA_AVAILABLE,
    INSTANCE_ALIVE,
    load,
    write,
)
from linkwright.wire.dds.discovery_info import (
    GID_SIZE,
    OLD_GID_SIZE,
    NodeEntities,
    ParticipantEntities,
    decode,
    encode,
)
from linkwright.wire.dds.names import DISCOVERY_TOPIC, parse_user_data
from linkwright.wire.dds.participant import SERVICES_NAME, Participant, read_process_namespace
from linkwright.wire.dds.qos import endpoint_qos, profile_from_policies
from linkwright.wire.dds.remote import RemoteEndpoint, RemoteGraph, RemoteParticipant, is_fast, is_process_running
from linkwright.wire.dds.type_descriptions import WireTypes
from linkwright.wire.dds.waiting import WaitingThread

DISCOVERY_TYPE_HASH = "RIHS01_91a0593bacdcc50ea9bdcf849a938b128412cc1ea821245c663bcd26f83c295e"
"""The hash of ``rmw_dds_common/msg/ParticipantEntitiesInfo`` in Iron and later."""

_PROCESS_PROPERTIES = (
    ("fastdds.physical_data.host", "fastdds.physical_data.process"),
    ("__Hostname", "__Pid"),
)
_HOST = socket.gethostname()
_MAX_SAMPLES = 256
_WRITER_QOS = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_READER_QOS = QoSProfile(1, durability=DurabilityPolicy.TRANSIENT_LOCAL, history=HistoryPolicy.KEEP_ALL)


class Discovery:
    """The discovery of a domain.

    It fills the tables of the remote graph, and publishes the graph of this process.

    A gid has 24 bytes for ROS 2 up to Humble and 16 from Iron on. An announcement with the wrong size makes ``ros2 node
    list`` of Humble fail, or leaves our nodes without names. Our announcements use the size of the ROS 2 nodes that
    have been discovered. If both sizes occur, the older size is used, because ``ros2 node list`` of the older
    distribution would fail otherwise. Processes of Linkwright understand both sizes and do not affect the choice.

    Args:
        participant: our participant.
        thread: the thread in which all methods of this class run.
        remote: the tables.
        types: descriptions of types.
        gid_size: the size of a gid, in bytes, until a ROS 2 node is discovered.
    """

    def __init__(
        self, participant: Participant, thread: WaitingThread, remote: RemoteGraph, types: WireTypes, gid_size: int
    ) -> None:
        self._dds = load()
        self._participant = participant
        self._remote = remote
        self._types = types
        self.gid_size = gid_size
        self.changed = False
        """Whether the remote graph has changed since the flag was last read and reset."""
        self._nodes: Sequence[NodeEntities] = ()
        self._gid_sizes: dict[bytes, int] = {}
        self._participants = self._create_builtin_reader(BUILTIN_PARTICIPANTS)
        self._publications = self._create_builtin_reader(BUILTIN_PUBLICATIONS)
        self._subscriptions = self._create_builtin_reader(BUILTIN_SUBSCRIPTIONS)
        self._reader = self._create_reader()
        self._thread = thread
        self._requests = DiscoveryRequests(self._create_extra_reader)
        self._writer = self._create_writer()
        for reader, handler in (
            (self._participants, self._take_participants),
            (self._publications, lambda: self._take_endpoints(self._publications, is_writer=True)),
            (self._subscriptions, lambda: self._take_endpoints(self._subscriptions, is_writer=False)),
            (self._reader[1], lambda: self._take_entities(self._reader[1])),
        ):
            self._dds.dds_set_status_mask(reader, DATA_AVAILABLE)
            thread.attach(reader, handler)
            handler()

    def publish(self, nodes: Sequence[NodeEntities]) -> None:
        """Announce our nodes and the endpoints of each node."""
        self._nodes = nodes
        info = ParticipantEntities(self._participant.guid, nodes)
        write(self._writer[1], encode(info, self.gid_size))

    # --- receiving --------------------------------------------------------------------------------------------------

    def _create_builtin_reader(self, topic: int) -> int:
        return self._participant.create_reader(topic, None)

    def _create_reader(self) -> tuple[int, int]:
        topic = self._participant.create_topic(DISCOVERY_TOPIC, self._types.discovery())
        with endpoint_qos(_READER_QOS) as qos:
            return topic, self._participant.create_reader(topic, qos)

    def _take_participants(self) -> bool:
        samples = self._dds.take_participants(
            self._participants, _MAX_SAMPLES, self._on_participant_sample, _keep_pointer
        )
        return isinstance(samples, list) and len(samples) == _MAX_SAMPLES

    def _take_endpoints(self, reader: int, *, is_writer: bool) -> bool:
        def handle_sample(
            guid: bytes, owner: bytes, _: int, topic: str, type_name: str, qos: int, info: Any, *__: Any
        ) -> None:
            self._on_endpoint_sample(guid, owner, topic, type_name, qos, info, is_writer)

        samples = self._dds.take_endpoints(reader, _MAX_SAMPLES, handle_sample, _keep_pointer)
        return isinstance(samples, list) and len(samples) == _MAX_SAMPLES

    def _on_participant_sample(self, guid: bytes, qos: int, info: Any) -> None:
        if guid == self._participant.guid:
            return
        self.changed = True
        if info.instance_state != INSTANCE_ALIVE:
            self._remote.remove_participant(guid)
            self._remove_gid_size(guid)
            return
        user_data = parse_user_data(self._dds.user_data(qos))
        name, process, host = self._dds.entity_name(qos), self._find_local_process(qos), self._find_announced_host(qos)
        if name == SERVICES_NAME:
            return
        self._remote.add_participant(RemoteParticipant(guid, user_data.get("enclave", "/"), name, process, host))

    def _find_announced_host(self, qos: int) -> str:
        """Return the host name that a participant announces, or an empty string."""
        return next((host for host, _ in announced_processes(partial(self._dds.property, qos)) if host), "")

    def _find_local_process(self, qos: int) -> int | None:
        """Return the process id of a participant on this machine, or None if it is not known.

        The announced id is accepted only if such a process runs here. A process in a container may have the host name
        of this machine, and an id that belongs to another process here, or to none.
        """
        if not read_process_namespace():
            return None
        for host, number in announced_processes(partial(self._dds.property, qos)):
            if host == _HOST and number.isdecimal() and is_process_running(int(number)):
                return int(number)
        return None

    def _on_endpoint_sample(
        self, guid: bytes, owner: bytes, topic: str, type_name: str, qos: int, info: Any, is_writer: bool
    ) -> None:
        if owner == self._participant.guid:
            return
        self.changed = True
        if info.instance_state != INSTANCE_ALIVE:
            self._remote.remove_endpoint(guid)
            return
        user_data = parse_user_data(self._dds.user_data(qos))
        profile = profile_from_policies(qos, announces_history=not is_fast(guid))
        endpoint = RemoteEndpoint(guid, info.instance_handle, owner, is_writer, topic, type_name, profile, user_data)
        self._remote.add_endpoint(endpoint)
        if is_writer and topic == DISCOVERY_TOPIC:
            self._record_gid_size(endpoint)

    def _take_entities(self, reader: int) -> bool:
        samples = self._dds.take_bytes(reader, ANY_STATE, _MAX_SAMPLES)
        if not isinstance(samples, list):
            return False
        for data, info in samples:
            entities = decode(data) if info.valid_data else None
            if entities is not None:
                self._remote.on_entities_announced(entities)
                self.changed = True
        return len(samples) == _MAX_SAMPLES

    def request_missing_nodes(self) -> float | None:
        """Request announcements from participants that have not announced their nodes.

        Returns:
            The seconds until the next call, or None if no call is needed.
        """
        return self._requests.create_next_reader(is_complete=self._remote.have_all_announced())

    def _create_extra_reader(self) -> Callable[[], None]:
        topic, reader = self._create_reader()

        def delete_reader() -> None:
            self._thread.detach(reader)
            self._participant.delete(reader, topic)

        self._dds.dds_set_status_mask(reader, DATA_AVAILABLE)
        self._thread.attach(reader, lambda: self._take_entities(reader))
        return delete_reader

    # --- announcing --------------------------------------------------------------------------------------------------

    def update_gid_size(self) -> None:
        """Update the gid size to the size that the other participants understand."""
        own_participants = {participant.guid for participant in self._remote.participants() if participant.is_ours}
        sizes = {size for owner, size in self._gid_sizes.items() if owner not in own_participants}
        size = max(sizes, default=self.gid_size)
        if size != self.gid_size:
            self.gid_size = size
            self._participant.delete(self._writer[1], self._writer[0])
            self._writer = self._create_writer()
            self.publish(self._nodes)

    def _create_writer(self) -> tuple[int, int]:
        topic = self._participant.create_topic(DISCOVERY_TOPIC, self._types.discovery())
        user_data = f"typehash={DISCOVERY_TYPE_HASH};".encode() if self.gid_size == GID_SIZE else b""
        with endpoint_qos(_WRITER_QOS, user_data) as qos:
            return topic, self._participant.create_writer(topic, qos)

    def _record_gid_size(self, writer: RemoteEndpoint) -> None:
        self._gid_sizes[writer.participant] = GID_SIZE if "typehash" in writer.user_data else OLD_GID_SIZE

    def _remove_gid_size(self, participant: bytes) -> None:
        self._gid_sizes.pop(participant, None)


def announced_processes(get_property: Callable[[str], str]) -> Iterator[tuple[str, str]]:
    """Yield the host and the process id of a participant, once for each vendor's properties.

    Fast DDS 3 identifies its machine by the machine id; the id of this machine is replaced by its host name.

    Args:
        get_property: returns the value of a property of the participant; empty if there is no such property.
    """
    for host, process in _PROCESS_PROPERTIES:
        host_name = get_property(host).partition(":")[0]
        yield _HOST if host_name and host_name == read_machine_id() else host_name, get_property(process)


@lru_cache(maxsize=1)
def read_machine_id() -> str:
    """Return the id in ``/etc/machine-id``, or an empty string if there is none."""
    try:
        return Path("/etc/machine-id").read_text(encoding="ascii").strip()
    except (OSError, UnicodeError):
        return ""


def _keep_pointer(qos: int) -> int:
    """Return the pointer unchanged.

    Policies are read on demand while the sample is on loan.
    """
    return qos


INTERVALS_S = (0.02, 0.1, 0.2, 0.4, 0.8)
"""Seconds before each request to a participant that has not announced its nodes."""


class DiscoveryRequests:
    """The extra readers of ``ros_discovery_info``.

    They exist until every participant has announced its nodes.

    Without these extra readers, some announcements would arrive only after seconds. A writer of Fast DDS repeats its
    last announcement to a reader when it discovers the reader. Often Cyclone does not know the writer at that
    moment, and the announcement is lost. Fast DDS ignores Cyclone's request to repeat the announcement, and repeats
    it only after 3 s. A reader that is created once the writer is known receives the announcement within
    milliseconds.

    Args:
        listen: creates such a reader; returns a function that deletes it.
    """

    def __init__(self, listen: Callable[[], Callable[[], None]]) -> None:
        self._listen = listen
        self._stop: Callable[[], None] | None = None
        self._request_count: int | None = None
        self._due = 0.0

    def create_next_reader(self, *, is_complete: bool) -> float | None:
        """Create the next reader if it is due, in place of the previous one.

        Args:
            is_complete: whether all participants have announced their nodes.

        Returns:
            The seconds until the next check; None when all have announced their nodes, or after the last attempt.
        """
        now = time.monotonic()
        if is_complete:
            self._delete_reader()
            self._request_count = None
            return None
        if self._request_count is None:
            self._request_count, self._due = 0, now + INTERVALS_S[0]
        elif now >= self._due and self._request_count < len(INTERVALS_S):
            self._delete_reader()
            self._stop = self._listen()
            self._request_count += 1
            self._due = now + INTERVALS_S[min(self._request_count, len(INTERVALS_S) - 1)]
        return None if self._request_count == len(INTERVALS_S) else max(self._due - now, 0.0)

    def _delete_reader(self) -> None:
        if self._stop is not None:
            self._stop()
            self._stop = None
