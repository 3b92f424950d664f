"""Encode QoS profiles as one chunk of a liveliness token.

The form is ``<reliability>:<durability>:<history>,<depth>:<deadline>:<lifespan>:<liveliness>,<lease>``. Times consist
of seconds and nanoseconds. Values that are the default of rmw_zenoh_cpp are left empty.
"""

from __future__ import annotations

from linkwright.graph.qos.compatibility import limit_ns, resolve_defaults
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import INFINITE, Duration
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_DEFAULT_DEPTH = 42


def write(profile: QoSProfile) -> str:
    """Return the chunk that encodes a profile."""
    qos = resolve_defaults(profile)
    # If the depth is left to the middleware, it becomes the default.
    keeps_all = qos.history is HistoryPolicy.KEEP_ALL
    depth = _DEFAULT_DEPTH if profile.depth == 0 else profile.depth
    reliability = "" if qos.reliability is ReliabilityPolicy.RELIABLE else str(int(qos.reliability))
    durability = "" if qos.durability is DurabilityPolicy.VOLATILE else str(int(qos.durability))
    history = str(int(qos.history)) if keeps_all else ""
    liveliness = "" if qos.liveliness is LivelinessPolicy.AUTOMATIC else str(int(qos.liveliness))
    return ":".join(
        (
            reliability,
            durability,
            f"{history},{'' if depth == _DEFAULT_DEPTH else depth}",
            _write_time(qos.deadline),
            _write_time(qos.lifespan),
            f"{liveliness},{_write_time(qos.liveliness_lease_duration)}",
        )
    )


def read(text: str) -> QoSProfile:
    """Return the profile that a chunk encodes.

    Raises:
        ValueError: the text is not a profile.
    """
    reliability, durability, history, deadline, lifespan, liveliness = text.split(":")
    history_kind, depth = history.split(",")
    liveliness_kind, lease_s, lease_ns = liveliness.split(",")
    history_policy = HistoryPolicy(int(history_kind or HistoryPolicy.KEEP_LAST))
    return QoSProfile(
        depth=0 if history_policy is HistoryPolicy.KEEP_ALL else max(int(depth or _DEFAULT_DEPTH), 1),
        history=history_policy,
        reliability=ReliabilityPolicy(int(reliability or ReliabilityPolicy.RELIABLE)),
        durability=DurabilityPolicy(int(durability or DurabilityPolicy.VOLATILE)),
        deadline=_read_time(*deadline.split(",")),
        lifespan=_read_time(*lifespan.split(",")),
        liveliness=LivelinessPolicy(int(liveliness_kind or LivelinessPolicy.AUTOMATIC)),
        liveliness_lease_duration=_read_time(lease_s, lease_ns),
    )


def _write_time(duration: Duration) -> str:
    nanoseconds = limit_ns(duration)
    if nanoseconds is None:
        return ","
    seconds, remainder = divmod(nanoseconds, NANOSECONDS_PER_SECOND)
    return f"{seconds},{remainder}"


def _read_time(seconds: str, nanoseconds: str) -> Duration:
    if not seconds and not nanoseconds:
        return INFINITE
    total = int(seconds or 0) * NANOSECONDS_PER_SECOND + int(nanoseconds or 0)
    return INFINITE if total <= 0 or total >= INFINITE.nanoseconds else Duration(nanoseconds=total)
