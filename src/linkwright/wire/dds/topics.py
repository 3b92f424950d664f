"""Publishers and subscriptions over DDS, with one writer or reader for each."""

from __future__ import annotations

import ctypes as c
import time
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from linkwright.graph.endpoints.base import MessageInfo
from linkwright.graph.endpoints.bus import describe_mismatch, report_to_publisher, report_to_subscription
from linkwright.graph.qos.compatibility import find_incompatible_policies
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import InterfaceNotFoundError, serialize, type_hash
from linkwright.wire.dds.backlog import Backlog
from linkwright.wire.dds.cyclone import (
    ANY_STATE,
    DATA_AVAILABLE,
    LIVELINESS_CHANGED,
    OFFERED_INCOMPATIBLE_QOS,
    PUBLICATION_MATCHED,
    REQUESTED_INCOMPATIBLE_QOS,
    SAMPLE_LOST,
    SUBSCRIPTION_MATCHED,
    TIMEOUT,
    CountStatus,
    LivelinessChangedStatus,
    MatchedStatus,
    Sample,
    describe_code,
    load,
)
from linkwright.wire.dds.domain import Domain
from linkwright.wire.dds.names import Role, to_dds_topic
from linkwright.wire.dds.pacing import PacedWriter
from linkwright.wire.dds.qos import endpoint_qos
from linkwright.wire.dds.rtps.messages import FRAGMENT_SIZE
from linkwright.wire.dds.settings import LEASE_S

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import Endpoint
    from linkwright.graph.endpoints.publisher import Publisher
    from linkwright.graph.endpoints.subscription import Subscription

_PUBLISH_TIMEOUT_S = 2 * LEASE_S
"""Seconds for which a publisher with KEEP_ALL waits for slow readers."""

_UNNAMED = "a node whose name is not known"

MAX_SAMPLES = 256
"""The maximum number of samples that are taken before other readers are served."""


_MAX_KEPT_BLOCK = 16 << 20
"""The maximum size, in bytes, of memory blocks that are kept.

glibc then keeps up to twice as many free bytes for each thread.
"""


@lru_cache(maxsize=1)
def keep_large_blocks() -> None:
    """Make the C library reuse freed memory blocks of the size of images.

    By default, glibc returns them to the system, which must then clear each page again. This takes half of the
    processor time of an image publisher. glibc keeps blocks up to the size of the largest block that was ever mapped
    and freed (``M_MMAP_THRESHOLD`` in mallopt(3)), so this function maps and frees such a block, without using its
    pages.
    """
    bytes(_MAX_KEPT_BLOCK)


def make_type_user_data(message_class: Any) -> bytes:
    """Return the USER_DATA with the type's hash, as ROS 2 announces it from Iron on.

    Older distributions ignore the hash.
    """
    return f"typehash={type_hash(message_class)};".encode()


class MirroredTopic(ABC):
    """A reader or a writer that represents an endpoint of this process.

    Args:
        endpoint: the subscription or publisher.
        domain: the domain.
        on_mismatch: called when an endpoint of another process has incompatible QoS.
    """

    _STATUS_MASK: int
    """The mask of the statuses that `on_status` handles."""

    def __init__(self, endpoint: Endpoint, domain: Domain, on_mismatch: Callable[[Any], None]) -> None:
        self._dds = load()
        self._on_mismatch = on_mismatch
        self._participant = domain.participant
        self._remote = domain.remote
        profile = self._get_profile(endpoint)
        self.topic_name = to_dds_topic(Role.TOPIC, endpoint.name, plain=profile.avoid_ros_namespace_conventions)
        type_description, user_data = self._describe_type(endpoint, domain)
        self._topic = self._participant.create_topic(self.topic_name, type_description)
        with endpoint_qos(profile, user_data) as qos:
            self.entity = self._create(qos)
        self.guid = self._dds.guid(self.entity)
        endpoint.gid = self.guid
        self._dds.dds_set_status_mask(self.entity, self._STATUS_MASK)
        self._log_limits = _LogLimits()

    def _describe_type(self, endpoint: Endpoint, domain: Domain) -> tuple[Any, bytes]:
        """Return the type's description for Cyclone, and the USER_DATA with the type's hash.

        For a type that no package here defines, the description is only its name. This suffices if the messages are raw
        bytes.
        """
        announced_hash = f"typehash={endpoint.type_hash};".encode() if endpoint.type_hash else b""
        try:
            return domain.types.message(endpoint.interface), announced_hash or make_type_user_data(endpoint.interface)
        except InterfaceNotFoundError:
            if not endpoint.raw:
                raise
            return domain.types.by_name(endpoint.type_name), announced_hash

    def _get_profile(self, endpoint: Any) -> QoSProfile:
        """Return the QoS profile to offer or to request."""
        profile: QoSProfile = endpoint.qos_profile
        return profile

    @abstractmethod
    def _create(self, qos: Any) -> int:
        """Create the reader or the writer."""


class OutgoingTopic(MirroredTopic):
    """A publisher's writer.

    Args:
        publisher: the publisher.
        domain: the domain to write in.
        on_mismatch: called when a subscription of another process requests more than the publisher offers.
        on_waiting: called when messages are queued, so that `write_queued` must be called again soon.
    """

    _STATUS_MASK = PUBLICATION_MATCHED | OFFERED_INCOMPATIBLE_QOS

    def __init__(
        self,
        publisher: Publisher[Any],
        domain: Domain,
        on_mismatch: Callable[[Any], None],
        on_waiting: Callable[[OutgoingTopic], None],
    ) -> None:
        super().__init__(publisher, domain, on_mismatch)
        self._publisher = publisher
        self._on_waiting = on_waiting
        self._paced_writer = self._make_paced_writer(domain)
        self._backlog = self._make_backlog(domain.fragment_size)
        publisher.assert_remote_liveliness = self._assert_liveliness
        self._is_transient_local = publisher.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._send = self._make_sender()
        self.on_status()

    def on_status(self) -> bool:
        """Handle status changes: matched readers and incompatible QoS.

        Returns False, because a writer has no samples to take.
        """
        status = c.c_uint32()
        self._dds.dds_take_status(self.entity, c.byref(status), self._STATUS_MASK)
        match_status = MatchedStatus()
        if self._dds.dds_get_publication_matched_status(self.entity, c.byref(match_status)) >= 0:
            is_needed = self._is_transient_local or match_status.current_count > 0
            self._publisher.set_remote_sender(self._send if is_needed else None, self._wait_for_readers)
            self._publisher.set_remote_count(match_status.current_count)
        if status.value & OFFERED_INCOMPATIBLE_QOS:
            self._on_mismatch(self)
        return False

    def write_queued(self) -> bool:
        """Write the samples that no longer need to wait for acknowledgments.

        Returns whether samples are still queued.
        """
        return self._backlog is not None and self._backlog.write_queued()

    def wait_until_acknowledged(self, nanoseconds: int) -> bool:
        """Wait until all reliable readers have acknowledged all published samples.

        Returns False if that takes longer than the given time.
        """
        deadline_ns = time.monotonic_ns() + nanoseconds
        while self.write_queued():
            if not self._wait_for_acks(max(0, deadline_ns - time.monotonic_ns())):
                return False
        return self._wait_for_acks(max(0, deadline_ns - time.monotonic_ns()))

    def close(self) -> None:
        """Delete the writer."""
        self._publisher.set_remote_sender(None)
        if self._paced_writer is not None:
            self._paced_writer.close()
        self._participant.delete(self.entity, self._topic)

    def abandon(self) -> None:
        """Stop sending, without calling Cyclone."""
        self._publisher.send_remote = None
        self._publisher.assert_remote_liveliness = None

    def _create(self, qos: Any) -> int:
        return self._participant.create_writer(self._topic, qos)

    def _assert_liveliness(self) -> None:
        self._dds.dds_assert_liveliness(self.entity)

    def _wait_for_readers(self, seconds: float | None) -> bool:
        return self.wait_until_acknowledged(0x7FFF_FFFF_FFFF_FFFF if seconds is None else int(seconds * 1e9))

    def _wait_for_acks(self, nanoseconds: int) -> bool:
        """Wait until all readers have acknowledged the written samples.

        Return False on timeout.

        Samples in the backlog are not considered.
        """
        deadline_ns = time.monotonic_ns() + nanoseconds
        if self._paced_writer is not None and not self._paced_writer.wait_until_written(nanoseconds / 1e9):
            return False
        code: int = self._dds.dds_wait_for_acks(self.entity, max(0, deadline_ns - time.monotonic_ns()))
        return code >= 0

    def _make_paced_writer(self, domain: Domain) -> PacedWriter | None:
        """Return a writer that sends through the pacer, or None if the pacer cannot be used.

        The pacer requires that newer samples replace older ones, and that Cyclone's packets have the size that the
        pacer sends.
        """
        profile = self._publisher.qos_profile
        if profile.history is HistoryPolicy.KEEP_ALL or domain.fragment_size != FRAGMENT_SIZE:
            return None
        depth = max(profile.depth, 1)
        return PacedWriter(self.guid, depth, self._write_published, self._find_fast_readers, domain.pacer)

    def _find_fast_readers(self) -> list[bytes]:
        """Return the GUIDs of the readers of Fast DDS that match the writer."""
        endpoints = map(self._remote.endpoint, self._dds.matching_handles(self.entity, writer=True))
        return [endpoint.guid for endpoint in endpoints if endpoint is not None and endpoint.is_fast]

    def _make_backlog(self, fragment_size: int) -> Backlog | None:
        """Return a queue for large samples, or None if the writer never replaces requested samples."""
        profile = self._publisher.qos_profile
        is_reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
        if not is_reliable or profile.history is HistoryPolicy.KEEP_ALL:
            return None
        depth = max(profile.depth, 1)
        return Backlog(
            depth,
            fragment_size,
            self._write,
            acknowledged=lambda: self._wait_for_acks(0),
            has_vulnerable_reader=lambda: self._remote.is_read_by_fast(self.topic_name),
        )

    def _make_sender(self) -> Callable[[Any], None]:
        backlog = self._backlog

        def send(message: Any) -> None:
            data = message if type(message) is bytes else _to_bytes(message)
            if backlog is None:
                self._write(data)
            elif backlog.send(data):
                self._on_waiting(self)

        return send

    def _write(self, data: bytes) -> None:
        if len(data) > FRAGMENT_SIZE:
            keep_large_blocks()
        if len(data) & 3:
            data += bytes(-len(data) & 3)
        if self._paced_writer is not None:
            self._paced_writer.write(data)
        else:
            self._write_published(data, None)

    def _write_published(self, data: bytes, published_ns: int | None) -> bool:
        """Write a sample with Cyclone, and return whether Cyclone accepted it.

        If the writer keeps all samples, or the pacer has already sent the sample, writing is retried until slow readers
        have caught up or the lease of dead readers has expired.

        Args:
            data: the sample.
            published_ns: when the sample was published, in ns since the epoch; None for now.
        """
        sample = Sample(data, len(data))
        deadline = time.monotonic() + _PUBLISH_TIMEOUT_S
        must_retry = published_ns is not None or self._publisher.qos_profile.history is HistoryPolicy.KEEP_ALL
        code = self._try_write(sample, published_ns)
        while code == TIMEOUT and must_retry and time.monotonic() < deadline and not self._participant.closed:
            code = self._try_write(sample, published_ns)
        self._log_failure(code)
        return code >= 0

    def _try_write(self, sample: Sample, published_ns: int | None) -> int:
        if published_ns is None:
            code: int = self._dds.dds_write(self.entity, c.byref(sample))
        else:
            code = self._dds.dds_write_ts(self.entity, c.byref(sample), published_ns)
        return code

    def _log_failure(self, code: int) -> None:
        """Log that a message was not sent, if writing failed.

        Further failures are logged only after some time.
        """
        if code >= 0 or self._participant.closed or self._publisher.destroyed or not self._log_limits.may_log("failed"):
            return
        reason = "the subscriptions in other processes do not keep up" if code == TIMEOUT else describe_code(code)
        self._publisher.node.logger.warning(
            f"A message of topic '{self._publisher.name}' was not sent to other processes: {reason}"
        )

    def log_mismatches(self, *, include_unnamed: bool) -> None:
        """Report subscriptions of other processes that request more than this publisher offers.

        Args:
            include_unnamed: whether to report also subscriptions whose node name is not known yet.
        """
        offered = self._publisher.qos_profile
        for reader in self._remote.find_topic_endpoints(self.topic_name, writers=False):
            policies = find_incompatible_policies(offered, reader.qos)
            name = self._remote.find_node_name(reader)
            if policies and (name or include_unnamed) and self._log_limits.mark_seen(reader.guid):
                mismatch = describe_mismatch(self._publisher.node_name, offered, name or _UNNAMED, reader.qos, policies)
                report_to_publisher(self._publisher, policies[-1].name, mismatch)


class IncomingTopic(MirroredTopic):
    """A subscription's reader. See `MirroredTopic` for the arguments."""

    _STATUS_MASK = DATA_AVAILABLE | SUBSCRIPTION_MATCHED | REQUESTED_INCOMPATIBLE_QOS | SAMPLE_LOST | LIVELINESS_CHANGED

    def __init__(self, subscription: Subscription[Any], domain: Domain, on_mismatch: Callable[[Any], None]) -> None:
        super().__init__(subscription, domain, on_mismatch)
        self._subscription = subscription

    def on_status(self) -> bool:
        """Pass on the samples that have arrived, and handle status changes.

        Returns whether there are more samples.
        """
        status = c.c_uint32()
        self._dds.dds_take_status(self.entity, c.byref(status), self._STATUS_MASK & ~DATA_AVAILABLE)
        if status.value:
            self._on_change(status.value)
        return self._receive()

    def close(self) -> None:
        """Delete the reader."""
        self._participant.delete(self.entity, self._topic)

    def _create(self, qos: Any) -> int:
        return self._participant.create_reader(self._topic, qos)

    def _receive(self) -> bool:
        samples = self._dds.take_bytes(self.entity, ANY_STATE, MAX_SAMPLES)
        if not isinstance(samples, list):
            return False
        receive, received_ns = self._subscription.receive, time.time_ns()
        publisher, gid = None, bytes(16)
        for data, info in samples:
            if info.valid_data:
                if info.publication_handle != publisher:
                    publisher = info.publication_handle
                    gid = self._find_publisher_gid(publisher)
                try:
                    receive(data, MessageInfo(info.source_timestamp, received_ns, gid, True))
                except Exception as error:  # noqa: BLE001 - the other samples taken from Cyclone must not be lost
                    self._subscription.report(error)
        return len(samples) == MAX_SAMPLES

    def _find_publisher_gid(self, handle: int) -> bytes:
        """Return the GID of a publisher, or 16 zero bytes if it is not known.

        The reader may know the GID before the discovery tables do.
        """
        endpoint = self._remote.endpoint(handle)
        if endpoint is not None:
            return endpoint.guid
        return self._dds.writer_guid(self.entity, handle) or bytes(16)

    def _on_change(self, status: int) -> None:
        if status & SUBSCRIPTION_MATCHED:
            match_status = MatchedStatus()
            self._dds.dds_get_subscription_matched_status(self.entity, c.byref(match_status))
            self._subscription.set_remote_count(match_status.current_count)
        if status & SAMPLE_LOST:
            lost_status = CountStatus()
            self._dds.dds_get_sample_lost_status(self.entity, c.byref(lost_status))
            if lost_status.total_count_change > 0:
                self._subscription.count_lost_remote(lost_status.total_count_change)
        if status & LIVELINESS_CHANGED:
            liveliness_status = LivelinessChangedStatus()
            self._dds.dds_get_liveliness_changed_status(self.entity, c.byref(liveliness_status))
            self._subscription.set_remote_liveliness(liveliness_status.alive_count, liveliness_status.not_alive_count)
        if status & REQUESTED_INCOMPATIBLE_QOS:
            self._on_mismatch(self)

    def log_mismatches(self, *, include_unnamed: bool) -> None:
        """Report publishers of other processes that offer less than this subscription requests.

        Args:
            include_unnamed: whether to report also publishers whose node name is not known yet.
        """
        requested = self._subscription.qos_profile
        for writer in self._remote.find_topic_endpoints(self.topic_name, writers=True):
            policies = find_incompatible_policies(writer.qos, requested)
            name = self._remote.find_node_name(writer)
            if policies and (name or include_unnamed) and self._log_limits.mark_seen(writer.guid):
                mismatch = describe_mismatch(
                    name or _UNNAMED, writer.qos, self._subscription.node_name, requested, policies
                )
                report_to_subscription(self._subscription, policies[-1].name, mismatch)


class _LogLimits:
    """Limits for the frequency of a topic's log messages."""

    _LOG_INTERVAL_S = 30.0

    def __init__(self) -> None:
        self._guids: set[bytes] = set()
        self._logged: dict[str, float] = {}

    def mark_seen(self, guid: bytes) -> bool:
        """Remember an endpoint, and return whether this is the first call for it.

        The mismatch must then be logged.
        """
        is_new = guid not in self._guids
        self._guids.add(guid)
        return is_new

    def may_log(self, key: str) -> bool:
        """Return whether to log a message now, and remember the time if so."""
        now = time.monotonic()
        is_due = now - self._logged.get(key, -self._LOG_INTERVAL_S) >= self._LOG_INTERVAL_S
        if is_due:
            self._logged[key] = now
        return is_due


def _to_bytes(message: Any) -> bytes:
    return bytes(message) if isinstance(message, bytearray) else serialize(message)
