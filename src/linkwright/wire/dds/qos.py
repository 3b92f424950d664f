"""Convert ROS QoS profiles to DDS policies and back, as in rmw_cyclonedds_cpp."""

from __future__ import annotations

import ctypes as c
from collections.abc import Iterator
from contextlib import contextmanager

from linkwright.graph.qos.compatibility import limit_ns
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import INFINITE, Duration
from linkwright.wire.dds.cyclone import INFINITY_NS, load

UNLIMITED = -1

MAX_BLOCKING_NS = 100_000_000
"""The time for which a reliable write waits for slow readers, 100 ms."""

_KEEP_LAST, _KEEP_ALL = 0, 1
_BEST_EFFORT, _RELIABLE = 0, 1
_VOLATILE, _TRANSIENT_LOCAL = 0, 1
_AUTOMATIC, _MANUAL_BY_TOPIC = 0, 2
_IGNORE_PARTICIPANT = 1
_XCDR1 = 0


@contextmanager
def endpoint_qos(profile: QoSProfile, user_data: bytes = b"") -> Iterator[int]:
    """Yield the policies of a reader or writer, valid only inside the ``with`` block.

    The participant does not receive its own samples, because the bus of the process has already delivered them.

    Args:
        profile: the offered or requested QoS; policies left to the middleware have Cyclone's defaults for ROS.
        user_data: key-value data for rmw.
    """
    dds = load()
    qos: int = dds.dds_create_qos()
    try:
        history_kind = _KEEP_ALL if profile.history is HistoryPolicy.KEEP_ALL else _KEEP_LAST
        depth = UNLIMITED if history_kind == _KEEP_ALL else max(profile.depth, 1)
        dds.dds_qset_history(qos, history_kind, depth)
        if profile.reliability is ReliabilityPolicy.BEST_EFFORT:
            dds.dds_qset_reliability(qos, _BEST_EFFORT, 0)
        else:
            dds.dds_qset_reliability(qos, _RELIABLE, MAX_BLOCKING_NS)
        if profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            dds.dds_qset_durability(qos, _TRANSIENT_LOCAL)
            dds.dds_qset_durability_service(qos, 0, history_kind, depth, UNLIMITED, UNLIMITED, UNLIMITED)
        else:
            dds.dds_qset_durability(qos, _VOLATILE)
        deadline, lifespan = limit_ns(profile.deadline), limit_ns(profile.lifespan)
        if deadline is not None:
            dds.dds_qset_deadline(qos, deadline)
        if lifespan is not None:
            dds.dds_qset_lifespan(qos, lifespan)
        is_manual = profile.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
        lease = limit_ns(profile.liveliness_lease_duration)
        dds.dds_qset_liveliness(
            qos, _MANUAL_BY_TOPIC if is_manual else _AUTOMATIC, INFINITY_NS if lease is None else lease
        )
        dds.dds_qset_ignorelocal(qos, _IGNORE_PARTICIPANT)
        dds.dds_qset_writer_data_lifecycle(qos, False)
        dds.dds_qset_data_representation(qos, 1, (c.c_int16 * 1)(_XCDR1))
        if user_data:
            dds.dds_qset_userdata(qos, user_data, len(user_data))
        yield qos
    finally:
        dds.dds_delete_qos(qos)


@contextmanager
def participant_qos(user_data: bytes, entity_name: str) -> Iterator[int]:
    """Yield the policies of a participant, valid only inside the ``with`` block."""
    dds = load()
    qos: int = dds.dds_create_qos()
    try:
        dds.dds_qset_userdata(qos, user_data, len(user_data))
        dds.dds_qset_entity_name(qos, entity_name.encode())
        yield qos
    finally:
        dds.dds_delete_qos(qos)


def profile_from_policies(qos: int, *, announces_history: bool = True) -> QoSProfile:
    """Return the ROS profile for a remote endpoint's policies.

    Args:
        qos: the policies.
        announces_history: whether the endpoint announces its history; if not, Cyclone reports only a default.
    """
    dds = load()
    value, depth, duration = c.c_int(), c.c_int32(), c.c_int64()

    def read_limit(getter: str) -> Duration:
        is_set = getattr(dds, getter)(qos, c.byref(duration))
        return Duration(nanoseconds=duration.value) if is_set and 0 < duration.value < INFINITY_NS else INFINITE

    history, length = HistoryPolicy.UNKNOWN, 0
    if announces_history and dds.dds_qget_history(qos, c.byref(value), c.byref(depth)):
        history = HistoryPolicy.KEEP_ALL if value.value == _KEEP_ALL else HistoryPolicy.KEEP_LAST
        length = 0 if history is HistoryPolicy.KEEP_ALL else max(depth.value, 1)
    reliability = ReliabilityPolicy.UNKNOWN
    if dds.dds_qget_reliability(qos, c.byref(value), c.byref(duration)):
        reliability = ReliabilityPolicy.RELIABLE if value.value == _RELIABLE else ReliabilityPolicy.BEST_EFFORT
    durability = DurabilityPolicy.UNKNOWN
    if dds.dds_qget_durability(qos, c.byref(value)):
        durability = DurabilityPolicy.VOLATILE if value.value == _VOLATILE else DurabilityPolicy.TRANSIENT_LOCAL
    liveliness, lease = LivelinessPolicy.UNKNOWN, INFINITE
    if dds.dds_qget_liveliness(qos, c.byref(value), c.byref(duration)):
        is_manual = value.value == _MANUAL_BY_TOPIC
        liveliness = LivelinessPolicy.MANUAL_BY_TOPIC if is_manual else LivelinessPolicy.AUTOMATIC
        lease = Duration(nanoseconds=duration.value) if duration.value < INFINITY_NS else INFINITE
    return QoSProfile(
        depth=length,
        history=history,
        reliability=reliability,
        durability=durability,
        deadline=read_limit("dds_qget_deadline"),
        lifespan=read_limit("dds_qget_lifespan"),
        liveliness=liveliness,
        liveliness_lease_duration=lease,
    )
