"""Compatibility of offered and requested QoS profiles (DDS "requested versus offered").

`fit_profile` chooses a profile that all publishers of a topic satisfy, as ros2cli does.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from copy import copy
from dataclasses import dataclass
from enum import IntEnum
from typing import TypeVar

from linkwright.graph.qos.profile import (
    BEST_AVAILABLE_DURATION,
    UNSPECIFIED,
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import INFINITE, Duration

V = TypeVar("V", bound=QoSPolicyEnum)


class QoSCompatibility(IntEnum):
    """The compatibility of two profiles (rmw ``rmw_qos_compatibility_type_t``)."""

    OK = 0
    WARNING = 1
    ERROR = 2


def limit_ns(duration: Duration) -> int | None:
    """Return a deadline, lifespan or lease in nanoseconds, or None if it is unlimited."""
    nanoseconds = duration.nanoseconds
    return None if nanoseconds <= 0 or nanoseconds >= BEST_AVAILABLE_DURATION.nanoseconds else nanoseconds


def resolve_defaults(qos: QoSProfile) -> QoSProfile:
    """Return a profile with Cyclone DDS's values for the policies left to the middleware.

    Unspecified durations become infinite.
    """
    return QoSProfile(
        depth=max(qos.depth, 1),
        history=_resolve_policy(qos.history, HistoryPolicy.KEEP_LAST),
        reliability=_resolve_policy(qos.reliability, ReliabilityPolicy.RELIABLE),
        durability=_resolve_policy(qos.durability, DurabilityPolicy.VOLATILE),
        lifespan=_resolve_duration(qos.lifespan),
        deadline=_resolve_duration(qos.deadline),
        liveliness=_resolve_policy(qos.liveliness, LivelinessPolicy.AUTOMATIC),
        liveliness_lease_duration=_resolve_duration(qos.liveliness_lease_duration),
        avoid_ros_namespace_conventions=qos.avoid_ros_namespace_conventions,
    )


def _resolve_policy(value: V, default: V) -> V:
    return default if value.name in ("SYSTEM_DEFAULT", "UNKNOWN", "BEST_AVAILABLE") else value


def _resolve_duration(duration: Duration) -> Duration:
    return INFINITE if limit_ns(duration) is None else duration


def find_incompatible_policies(offered: QoSProfile, requested: QoSProfile) -> list[QoSPolicyKind]:
    """Return the policies that a subscription requests and a publisher does not offer.

    The list is empty if the profiles are compatible.

    A reliable subscription needs a reliable publisher, a transient local subscription needs a transient local
    publisher, a subscription with a deadline needs a publisher that offers at most that deadline, and so on.
    """
    policies = []
    if requested.reliability is ReliabilityPolicy.RELIABLE and offered.reliability is ReliabilityPolicy.BEST_EFFORT:
        policies.append(QoSPolicyKind.RELIABILITY)
    if requested.durability is DurabilityPolicy.TRANSIENT_LOCAL and not _is_transient_local(offered):
        policies.append(QoSPolicyKind.DURABILITY)
    if _is_stricter(requested.deadline, offered.deadline):
        policies.append(QoSPolicyKind.DEADLINE)
    manual = LivelinessPolicy.MANUAL_BY_TOPIC
    lacks_assertions = requested.liveliness is manual and offered.liveliness is not manual
    if lacks_assertions or _is_stricter(requested.liveliness_lease_duration, offered.liveliness_lease_duration):
        policies.append(QoSPolicyKind.LIVELINESS)
    return policies


def _is_transient_local(qos: QoSProfile) -> bool:
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def _is_stricter(requested: Duration, offered: Duration) -> bool:
    requested_ns, offered_ns = limit_ns(requested), limit_ns(offered)
    return requested_ns is not None and (offered_ns is None or requested_ns < offered_ns)


def resolve_best_available(qos: QoSProfile, peers: Iterable[QoSProfile], *, is_publisher: bool) -> QoSProfile:
    """Return a profile whose BEST_AVAILABLE values are resolved, as rmw_dds_common does.

    The chosen values match the endpoints that are known now.

    Args:
        qos: the profile; returned unchanged if it has no BEST_AVAILABLE value.
        peers: the profiles of the topic's subscriptions for a publisher, or of its publishers for a subscription.
        is_publisher: whether the profile is for a publisher, which offers as much as it can.
    """
    if not _has_best_available(qos):
        return qos
    peer_profiles = list(peers)
    reliability, durability, liveliness = qos.reliability, qos.durability, qos.liveliness
    if reliability is ReliabilityPolicy.BEST_AVAILABLE:
        is_strict = is_publisher or all(profile.reliability is ReliabilityPolicy.RELIABLE for profile in peer_profiles)
        reliability = ReliabilityPolicy.RELIABLE if is_strict else ReliabilityPolicy.BEST_EFFORT
    if durability is DurabilityPolicy.BEST_AVAILABLE:
        is_strict = is_publisher or all(_is_transient_local(profile) for profile in peer_profiles)
        durability = DurabilityPolicy.TRANSIENT_LOCAL if is_strict else DurabilityPolicy.VOLATILE
    manual = LivelinessPolicy.MANUAL_BY_TOPIC
    if liveliness is LivelinessPolicy.BEST_AVAILABLE:
        are_manual = [profile.liveliness is manual for profile in peer_profiles]
        is_strict = any(are_manual) if is_publisher else bool(are_manual) and all(are_manual)
        liveliness = manual if is_strict else LivelinessPolicy.AUTOMATIC
    choose_strictest = min if is_publisher else max

    def choose_duration(duration: Duration, peer_durations: Iterable[Duration]) -> Duration:
        if duration != BEST_AVAILABLE_DURATION:
            return duration
        limited_durations = [peer_duration for peer_duration in peer_durations if limit_ns(peer_duration) is not None]
        return choose_strictest(limited_durations) if limited_durations else UNSPECIFIED

    return QoSProfile(
        depth=qos.depth,
        history=qos.history,
        reliability=reliability,
        durability=durability,
        lifespan=qos.lifespan,
        deadline=choose_duration(qos.deadline, (profile.deadline for profile in peer_profiles)),
        liveliness=liveliness,
        liveliness_lease_duration=choose_duration(
            qos.liveliness_lease_duration, (profile.liveliness_lease_duration for profile in peer_profiles)
        ),
        avoid_ros_namespace_conventions=qos.avoid_ros_namespace_conventions,
    )


def _has_best_available(qos: QoSProfile) -> bool:
    return (
        qos.reliability is ReliabilityPolicy.BEST_AVAILABLE
        or qos.durability is DurabilityPolicy.BEST_AVAILABLE
        or qos.liveliness is LivelinessPolicy.BEST_AVAILABLE
        or BEST_AVAILABLE_DURATION in (qos.deadline, qos.liveliness_lease_duration)
    )


def qos_check_compatible(publisher_qos: QoSProfile, subscription_qos: QoSProfile) -> tuple[QoSCompatibility, str]:
    """Return whether two profiles are compatible, and the reasons if they are not.

    If a profile leaves a policy to the middleware, the first value may be a warning. The reasons are those of rmw's
    ``rmw_qos_profile_check_compatible``.
    """
    errors = "".join(f"ERROR: {reason};" for reason in _find_errors(publisher_qos, subscription_qos))
    if errors:
        return QoSCompatibility.ERROR, errors
    warnings = "".join(f"WARNING: {reason};" for reason in _find_warnings(publisher_qos, subscription_qos))
    return (QoSCompatibility.WARNING, warnings) if warnings else (QoSCompatibility.OK, "")


def _find_errors(publisher: QoSProfile, subscription: QoSProfile) -> Iterable[str]:
    if (
        publisher.reliability is ReliabilityPolicy.BEST_EFFORT
        and subscription.reliability is ReliabilityPolicy.RELIABLE
    ):
        yield "Best effort publisher and reliable subscription"
    if publisher.durability is DurabilityPolicy.VOLATILE and _is_transient_local(subscription):
        yield "Volatile publisher and transient local subscription"
    offered, requested = limit_ns(publisher.deadline), limit_ns(subscription.deadline)
    if requested is not None and offered is None:
        yield "Subscription has a deadline, but publisher does not"
    elif requested is not None and offered is not None and requested < offered:
        yield "Subscription deadline is less than publisher deadline"
    if (
        publisher.liveliness is LivelinessPolicy.AUTOMATIC
        and subscription.liveliness is LivelinessPolicy.MANUAL_BY_TOPIC
    ):
        yield "Publisher's liveliness is automatic and subscription's is manual by topic"
    offered = limit_ns(publisher.liveliness_lease_duration)
    requested = limit_ns(subscription.liveliness_lease_duration)
    if requested is not None and offered is None:
        yield "Subscription has a liveliness lease duration, but publisher does not"
    elif requested is not None and offered is not None and requested < offered:
        yield "Subscription liveliness lease duration is less than publisher"


def _find_warnings(publisher: QoSProfile, subscription: QoSProfile) -> Iterable[str]:
    offered, requested = publisher.reliability, subscription.reliability
    if _is_unknown(offered) and _is_unknown(requested):
        yield (
            f"Publisher reliability is {_unset_value_name(offered)} and subscription reliability is "
            f"{_unset_value_name(requested)}"
        )
    elif _is_unknown(offered) and requested is ReliabilityPolicy.RELIABLE:
        yield f"Reliable subscription, but publisher is {_unset_value_name(offered)}"
    elif offered is ReliabilityPolicy.BEST_EFFORT and _is_unknown(requested):
        yield f"Best effort publisher, but subscription is {_unset_value_name(requested)}"
    offered_durability, requested_durability = publisher.durability, subscription.durability
    if _is_unknown(offered_durability) and _is_unknown(requested_durability):
        yield (
            f"Publisher durabilty is {_unset_value_name(offered_durability)} and subscription durability is "
            f"{_unset_value_name(requested_durability)}"
        )
    elif _is_unknown(offered_durability) and requested_durability is DurabilityPolicy.TRANSIENT_LOCAL:
        yield f"Transient local subscription, but publisher is {_unset_value_name(offered_durability)}"
    elif offered_durability is DurabilityPolicy.VOLATILE and _is_unknown(requested_durability):
        yield f"Volatile publisher, but subscription is {_unset_value_name(requested_durability)}"
    offered_liveliness, requested_liveliness = publisher.liveliness, subscription.liveliness
    if _is_unknown(offered_liveliness) and _is_unknown(requested_liveliness):
        yield (
            f"Publisher liveliness is {_unset_value_name(offered_liveliness)} and subscription liveliness is "
            f"{_unset_value_name(requested_liveliness)}"
        )
    elif _is_unknown(offered_liveliness) and requested_liveliness is LivelinessPolicy.MANUAL_BY_TOPIC:
        yield (
            f"Subscription's liveliness is manual by topic, but publisher's is {_unset_value_name(offered_liveliness)}"
        )
    elif offered_liveliness is LivelinessPolicy.AUTOMATIC and _is_unknown(requested_liveliness):
        yield f"Publisher's liveliness is automatic, but subscription's is {_unset_value_name(requested_liveliness)}"


def _is_unknown(value: QoSPolicyEnum) -> bool:
    return value.name in ("SYSTEM_DEFAULT", "UNKNOWN")


def _unset_value_name(value: QoSPolicyEnum) -> str:
    return "system_default" if value.name == "SYSTEM_DEFAULT" else "unknown"


@dataclass(frozen=True, slots=True)
class FittedProfile:
    """A profile that fits the publishers of a topic.

    Attributes:
        profile: the profile to subscribe with.
        mixed: the policies in which the publishers differ, so that the weaker value was chosen. Each is a tuple of the
            value offered by some publishers and the chosen value, with the names of rclpy's enumerations.
    """

    profile: QoSProfile
    mixed: tuple[tuple[str, str], ...] = ()


def fit_profile(base: QoSProfile, offers: Sequence[QoSProfile]) -> FittedProfile:
    """Return a profile with the strongest reliability and durability that all publishers offer.

    Args:
        base: provides the other policies; if there are no publishers, this profile is returned.
        offers: the profiles that the publishers of the topic offer.
    """
    profile = copy(base)
    if not offers:
        return FittedProfile(profile)
    reliable_count = sum(offer.reliability is ReliabilityPolicy.RELIABLE for offer in offers)
    transient_local_count = sum(offer.durability is DurabilityPolicy.TRANSIENT_LOCAL for offer in offers)
    publisher_count = len(offers)
    profile.reliability = (
        ReliabilityPolicy.RELIABLE if reliable_count == publisher_count else ReliabilityPolicy.BEST_EFFORT
    )
    profile.durability = (
        DurabilityPolicy.TRANSIENT_LOCAL if transient_local_count == publisher_count else DurabilityPolicy.VOLATILE
    )
    mixed = []
    if 0 < reliable_count < publisher_count:
        mixed.append(("QoSReliabilityPolicy.RELIABLE", "QoSReliabilityPolicy.BEST_EFFORT"))
    if 0 < transient_local_count < publisher_count:
        mixed.append(("QoSDurabilityPolicy.TRANSIENT_LOCAL", "QoSDurabilityPolicy.VOLATILE"))
    return FittedProfile(profile, tuple(mixed))
