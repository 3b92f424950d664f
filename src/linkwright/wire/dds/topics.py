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
from linkwright.graph.qos.compatibility import incompatible_policies
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
    describe,
    load,
)
from linkwright.wire.dds.domain import Domain
from linkwright.wire.dds.names import Role, dds_topic
from linkwright.wire.dds.pacing import PacedWriter
from linkwright.wire.dds.qos import endpoint_qos
from linkwright.wire.dds.rtps.messages import FRAGMENT
from linkwright.wire.dds.settings import LEASE

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import Endpoint
    from linkwright.graph.endpoints.publisher import Publisher
    from linkwright.graph.endpoints.subscription import Subscription

_PATIENCE = 2 * LEASE
"""Seconds for which a publisher that keeps everything waits for readers."""

_NAMELESS = "a node that is not known by name"

AT_ONCE = 256
"""How many samples are taken before other readers have their turn."""


_LARGEST_KEPT = 16 << 20
"""Bytes of the largest blocks that are kept; of each thread's memory, glibc then keeps twice as many that are free."""


@lru_cache(maxsize=1)
def keep_large_blocks() -> None:
    """Make the C library keep freed memory blocks of the size of images for the next image.

    By default glibc returns them to the system, which must clear each page again: half of the processor time of an
    image publisher. It keeps blocks up to the size of the largest block that was ever mapped and freed
    (``M_MMAP_THRESHOLD`` in mallopt(3)), so this function maps and frees such a block, without using its pages.
    """
    bytes(_LARGEST_KEPT)


def type_facts(message_class: Any) -> bytes:
    """Return the USER_DATA with the type's hash, as ROS 2 announces it from Iron on.

    Older distributions ignore the hash.
    """
    return f"typehash={type_hash(message_class)};".encode()


class MirroredTopic(ABC):
    """A reader or a writer that represents an endpoint of this process.

    Args:
        endpoint: the subscription or publisher.
        domain: the domain.
        mismatch: called when an endpoint of another process has incompatible QoS.
    """

    _STATUS: int
    """Called with changes."""

    def __init__(self, endpoint: Endpoint, domain: Domain, mismatch: Callable[[Any], None]) -> None:
        self._dds = load()
        self._mismatch = mismatch
        self._participant = domain.participant
        self._remote = domain.remote
        profile = self._profile_of(endpoint)
        self.topic_name = dds_topic(Role.TOPIC, endpoint.name, plain=profile.avoid_ros_namespace_conventions)
        described, facts = self._describe_type(endpoint, domain)
        self._topic = self._participant.create_topic(self.topic_name, described)
        with endpoint_qos(profile, facts) as qos:
            self.entity = self._create(qos)
        self.guid = self._dds.guid(self.entity)
        endpoint.gid = self.guid
        self._dds.dds_set_status_mask(self.entity, self._STATUS)
        self._log_limits = _LogLimits()

    def _describe_type(self, endpoint: Endpoint, domain: Domain) -> tuple[Any, bytes]:
        """Return the type's description for Cyclone, and the USER_DATA with the type's hash.

        For a type that no package here defines, the description is only its name. This suffices if the messages are raw
        bytes.
        """
        announced = f"typehash={endpoint.type_hash};".encode() if endpoint.type_hash else b""
        try:
            return domain.types.message(endpoint.interface), announced or type_facts(endpoint.interface)
        except InterfaceNotFoundError:
            if not endpoint.raw:
                raise
            return domain.types.by_name(endpoint.type_name), announced

    def _profile_of(self, endpoint: Any) -> QoSProfile:
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
        mismatch: called when a subscription of another process requests more than the publisher offers.
        waiting: called when messages are queued, so that `review` must be called again soon.
    """

    _STATUS = PUBLICATION_MATCHED | OFFERED_INCOMPATIBLE_QOS

    def __init__(
        self,
        publisher: Publisher[Any],
        domain: Domain,
        mismatch: Callable[[Any], None],
        waiting: Callable[[OutgoingTopic], None],
    ) -> None:
        super().__init__(publisher, domain, mismatch)
        self._publisher = publisher
        self._waiting = waiting
        self._paced = self._make_paced(domain)
        self._backlog = self._make_backlog(domain.fragment_size)
        publisher.assert_outside = self._assert_liveliness
        self._always = publisher.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._send = self._sender()
        self.on_status()

    def on_status(self) -> bool:
        """Handle status changes: matched readers and incompatible QoS."""
        status = c.c_uint32()
        self._dds.dds_take_status(self.entity, c.byref(status), self._STATUS)
        matched = MatchedStatus()
        if self._dds.dds_get_publication_matched_status(self.entity, c.byref(matched)) >= 0:
            listened_to = self._always or matched.current_count > 0
            self._publisher.set_outside(self._send if listened_to else None, self._acknowledged)
            self._publisher.set_outside_count(matched.current_count)
        if status.value & OFFERED_INCOMPATIBLE_QOS:
            self._mismatch(self)
        return False

    def review(self) -> bool:
        """Write the samples that need not wait for acknowledgements any longer.

        Returns whether samples are still queued.
        """
        return self._backlog is not None and self._backlog.review()

    def acknowledged(self, nanoseconds: int) -> bool:
        """Wait until all reliable readers have acknowledged all published samples.

        Returns False if that takes longer than the given time.
        """
        until = time.monotonic_ns() + nanoseconds
        while self.review():
            if not self._wait_for_acks(max(0, until - time.monotonic_ns())):
                return False
        return self._wait_for_acks(max(0, until - time.monotonic_ns()))

    def close(self) -> None:
        """Delete the writer."""
        self._publisher.set_outside(None)
        if self._paced is not None:
            self._paced.close()
        self._participant.delete(self.entity, self._topic)

    def abandon(self) -> None:
        """Stop sending, without calling Cyclone."""
        self._publisher.outside = None
        self._publisher.assert_outside = None

    def _create(self, qos: Any) -> int:
        return self._participant.create_writer(self._topic, qos)

    def _assert_liveliness(self) -> None:
        self._dds.dds_assert_liveliness(self.entity)

    def _acknowledged(self, seconds: float | None) -> bool:
        return self.acknowledged(0x7FFF_FFFF_FFFF_FFFF if seconds is None else int(seconds * 1e9))

    def _wait_for_acks(self, nanoseconds: int) -> bool:
        """Wait until all readers have acknowledged the written samples; return False on timeout.

        Samples in the backlog are not considered.
        """
        until = time.monotonic_ns() + nanoseconds
        if self._paced is not None and not self._paced.wait_until_written(nanoseconds / 1e9):
            return False
        code: int = self._dds.dds_wait_for_acks(self.entity, max(0, until - time.monotonic_ns()))
        return code >= 0

    def _make_paced(self, domain: Domain) -> PacedWriter | None:
        """Return a writer that sends through the pacer, or None if the pacer cannot be used.

        The pacer requires that newer samples replace older ones, and that Cyclone's packets have the size that the
        pacer sends.
        """
        profile = self._publisher.qos_profile
        if profile.history is HistoryPolicy.KEEP_ALL or domain.fragment_size != FRAGMENT:
            return None
        depth = max(profile.depth, 1)
        return PacedWriter(self.guid, depth, self._write_published, self._fast_readers, domain.pacer)

    def _fast_readers(self) -> list[bytes]:
        """Return the GUIDs of the readers of Fast DDS that match the writer."""
        known = map(self._remote.endpoint, self._dds.matched(self.entity, writer=True))
        return [endpoint.guid for endpoint in known if endpoint is not None and endpoint.is_fast]

    def _make_backlog(self, fragment_size: int) -> Backlog | None:
        """Return a queue for large samples; None if the writer never replaces requested samples."""
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
            matters=lambda: self._remote.is_read_by_fast(self.topic_name),
        )

    def _sender(self) -> Callable[[Any], None]:
        backlog = self._backlog

        def send(message: Any) -> None:
            data = message if type(message) is bytes else _bytes_of(message)
            if backlog is None:
                self._write(data)
            elif backlog.send(data):
                self._waiting(self)

        return send

    def _write(self, data: bytes) -> None:
        if len(data) > FRAGMENT:
            keep_large_blocks()
        if len(data) & 3:
            data += bytes(-len(data) & 3)
        if self._paced is not None:
            self._paced.write(data)
        else:
            self._write_published(data, None)

    def _write_published(self, data: bytes, published: int | None) -> bool:
        """Write a sample with Cyclone; return whether Cyclone accepted it.

        If the writer keeps all samples, or the pacer has already sent the sample, writing is retried until slow readers
        have caught up or the lease of dead readers has expired.

        Args:
            data: the sample.
            published: when the sample was published, in ns since the epoch; None for now.
        """
        sample = Sample(data, len(data))
        now = time.monotonic()
        insists = published is not None or self._publisher.qos_profile.history is HistoryPolicy.KEEP_ALL
        code = self._hand_over(sample, published)
        while code == TIMEOUT and insists and time.monotonic() < now + _PATIENCE and not self._participant.closed:
            code = self._hand_over(sample, published)
        self._failed(code)
        return code >= 0

    def _hand_over(self, sample: Sample, published: int | None) -> int:
        if published is None:
            code: int = self._dds.dds_write(self.entity, c.byref(sample))
        else:
            code = self._dds.dds_write_ts(self.entity, c.byref(sample), published)
        return code

    def _failed(self, code: int) -> None:
        """Log that messages are not sent: once, and again after some time if they still fail."""
        if code >= 0 or self._participant.closed or self._publisher.destroyed or not self._log_limits.is_due("failed"):
            return
        reason = "the subscribers outside do not keep up" if code == TIMEOUT else describe(code)
        self._publisher.node.logger.warning(
            f"A message of topic '{self._publisher.name}' was not sent out of this process: {reason}"
        )

    def log_mismatches(self, *, finally_: bool) -> None:
        """Report subscriptions of other processes that request more than this publisher offers.

        Args:
            finally_: whether to report also subscriptions whose node name is not known yet.
        """
        offered = self._publisher.qos_profile
        for reader in self._remote.endpoints_of(self.topic_name, writers=False):
            policies = incompatible_policies(offered, reader.qos)
            name = self._remote.node_name(reader)
            if policies and (name or finally_) and self._log_limits.is_new(reader.guid):
                sides = describe_mismatch(self._publisher.node_name, offered, name or _NAMELESS, reader.qos, policies)
                report_to_publisher(self._publisher, policies[-1].name, sides)


class IncomingTopic(MirroredTopic):
    """A subscription's reader; see `MirroredTopic` for the arguments."""

    _STATUS = DATA_AVAILABLE | SUBSCRIPTION_MATCHED | REQUESTED_INCOMPATIBLE_QOS | SAMPLE_LOST | LIVELINESS_CHANGED

    def __init__(self, subscription: Subscription[Any], domain: Domain, mismatch: Callable[[Any], None]) -> None:
        super().__init__(subscription, domain, mismatch)
        self._subscription = subscription

    def on_status(self) -> bool:
        """Pass on the samples that have arrived, and handle status changes.

        Returns whether there are more samples.
        """
        status = c.c_uint32()
        self._dds.dds_take_status(self.entity, c.byref(status), self._STATUS & ~DATA_AVAILABLE)
        if status.value:
            self._on_change(status.value)
        return self._receive()

    def close(self) -> None:
        """Delete the reader."""
        self._participant.delete(self.entity, self._topic)

    def _create(self, qos: Any) -> int:
        return self._participant.create_reader(self._topic, qos)

    def _receive(self) -> bool:
        samples = self._dds.take_bytes(self.entity, ANY_STATE, AT_ONCE)
        if not isinstance(samples, list):
            return False
        receive, received = self._subscription.receive, time.time_ns()
        publisher, gid = None, bytes(16)
        for data, info in samples:
            if info.valid_data:
                if info.publication_handle != publisher:
                    publisher = info.publication_handle
                    gid = self._gid_of(publisher)
                try:
                    receive(data, MessageInfo(info.source_timestamp, received, gid, True))
                except Exception as error:  # noqa: BLE001 - the other samples taken from Cyclone must not be lost
                    self._subscription.report(error)
        return len(samples) == AT_ONCE

    def _gid_of(self, handle: int) -> bytes:
        """Return the GID of a publisher; zeros if it is not known.

        The reader may know the GID before the discovery tables do.
        """
        endpoint = self._remote.endpoint(handle)
        if endpoint is not None:
            return endpoint.guid
        return self._dds.writer_guid(self.entity, handle) or bytes(16)

    def _on_change(self, changed: int) -> None:
        if changed & SUBSCRIPTION_MATCHED:
            matched = MatchedStatus()
            self._dds.dds_get_subscription_matched_status(self.entity, c.byref(matched))
            self._subscription.set_outside_count(matched.current_count)
        if changed & SAMPLE_LOST:
            lost = CountStatus()
            self._dds.dds_get_sample_lost_status(self.entity, c.byref(lost))
            if lost.total_count_change > 0:
                self._subscription.count_lost_outside(lost.total_count_change)
        if changed & LIVELINESS_CHANGED:
            lives = LivelinessChangedStatus()
            self._dds.dds_get_liveliness_changed_status(self.entity, c.byref(lives))
            self._subscription.set_outside_liveliness(lives.alive_count, lives.not_alive_count)
        if changed & REQUESTED_INCOMPATIBLE_QOS:
            self._mismatch(self)

    def log_mismatches(self, *, finally_: bool) -> None:
        """Report publishers of other processes that offer less than this subscription requests.

        Args:
            finally_: whether to report also publishers whose node name is not known yet.
        """
        requested = self._subscription.qos_profile
        for writer in self._remote.endpoints_of(self.topic_name, writers=True):
            policies = incompatible_policies(writer.qos, requested)
            name = self._remote.node_name(writer)
            if policies and (name or finally_) and self._log_limits.is_new(writer.guid):
                sides = describe_mismatch(
                    name or _NAMELESS, writer.qos, self._subscription.node_name, requested, policies
                )
                report_to_subscription(self._subscription, policies[-1].name, sides)


class _LogLimits:
    """Limits how often warnings of a topic are logged."""

    _AGAIN_AFTER = 30.0

    def __init__(self) -> None:
        self._guids: set[bytes] = set()
        self._logged: dict[str, float] = {}

    def is_new(self, guid: bytes) -> bool:
        """Return whether this is the first call for an endpoint, whose mismatch must be logged."""
        is_new = guid not in self._guids
        self._guids.add(guid)
        return is_new

    def is_due(self, what: str) -> bool:
        """Return whether a message should be logged, for the first time or again after some time."""
        now = time.monotonic()
        is_due = now - self._logged.get(what, -self._AGAIN_AFTER) >= self._AGAIN_AFTER
        if is_due:
            self._logged[what] = now
        return is_due


def _bytes_of(message: Any) -> bytes:
    return bytes(message) if isinstance(message, bytearray) else serialize(message)
