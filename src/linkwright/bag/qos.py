"""Quality of service in recordings: conversion of profiles, and their choice.

The choice follows the rules of rosbag2 (``rosbag2_transport/qos.cpp``).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, joined, phrase
from linkwright.graph import (
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from rosbags.interfaces import Qos

_RECORDING_DEPTH = 1000
"""The depth of recording subscriptions. rosbag2 uses 10, but has another queue behind it in C++."""

_PLAYING_DEPTH = 10
"""The depth of a publisher if the recorded publishers are unknown or differ: that of rosbag2's player."""

_POLICIES: Mapping[str, Any] = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
_DURATIONS = ("deadline", "lifespan", "liveliness_lease_duration")


def to_library(qos: QoSProfile) -> Qos:
    """Convert a profile to the library's type."""
    from rosbags.interfaces import Qos, QosDurability, QosHistory, QosLiveliness, QosReliability, QosTime

    def time(duration: Duration) -> QosTime:
        return QosTime(*divmod(duration.nanoseconds, NANOSECONDS_PER_SECOND))

    return Qos(
        QosHistory[qos.history.name],
        qos.depth,
        QosReliability[qos.reliability.name],
        QosDurability[qos.durability.name],
        time(qos.deadline),
        time(qos.lifespan),
        QosLiveliness[qos.liveliness.name],
        time(qos.liveliness_lease_duration),
        qos.avoid_ros_namespace_conventions,
    )


def from_library(qos: Qos) -> QoSProfile:
    """Convert a recorded profile from the library's type."""

    def policy(kind: Any, value: Any) -> Any:
        return kind.__members__.get(value.name, kind.SYSTEM_DEFAULT)

    def duration(value: Any) -> Duration:
        return Duration(nanoseconds=value.sec * NANOSECONDS_PER_SECOND + value.nsec)

    # Fast DDS does not announce the history of a publisher.
    history = policy(HistoryPolicy, qos.history)
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST if history is HistoryPolicy.UNKNOWN else history,
        depth=qos.depth or _PLAYING_DEPTH,
        reliability=policy(ReliabilityPolicy, qos.reliability),
        durability=policy(DurabilityPolicy, qos.durability),
        deadline=duration(qos.deadline),
        lifespan=duration(qos.lifespan),
        liveliness=policy(LivelinessPolicy, qos.liveliness),
        liveliness_lease_duration=duration(qos.liveliness_lease_duration),
        avoid_ros_namespace_conventions=qos.avoid_ros_namespace_conventions,
    )


def to_text(profiles: Sequence[QoSProfile]) -> str:
    """Format profiles as the string that ``metadata.yaml`` contains up to version 8."""
    from rosbags.rosbag2.metadata import dump_qos_v8

    return dump_qos_v8([to_library(profile) for profile in profiles])


def from_text(text: Any) -> list[QoSProfile]:
    """Parse the profiles in a ``metadata.yaml``: a string or, from version 9 on, a list."""
    from rosbags.rosbag2.metadata import parse_qos

    return [from_library(profile) for profile in parse_qos(text)]


def choose_recording_profile(offered: Sequence[QoSProfile]) -> QoSProfile:
    """Return a profile for a subscription that is compatible with all publishers of a topic.

    The subscription requests reliable or transient local only if all publishers offer it.

    Args:
        offered: the profiles of the publishers.
    """
    is_reliable = all(qos.reliability is not ReliabilityPolicy.BEST_EFFORT for qos in offered)
    is_latched = bool(offered) and all(qos.durability is DurabilityPolicy.TRANSIENT_LOCAL for qos in offered)
    return QoSProfile(
        depth=_RECORDING_DEPTH,
        reliability=ReliabilityPolicy.RELIABLE if is_reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL if is_latched else DurabilityPolicy.VOLATILE,
    )


def choose_playing_profile(recorded: Sequence[QoSProfile]) -> QoSProfile:
    """Return the recorded profile if all publishers offered equivalent ones, or the default.

    Depth and lifespan may differ. The largest depth is then used, because one publisher now represents all of them.
    rosbag2 always uses a depth of 10 messages.
    """
    if recorded and len({_make_compatibility_key(qos) for qos in recorded}) == 1:
        return max(recorded, key=lambda qos: (qos.history is HistoryPolicy.KEEP_ALL, qos.depth))
    return QoSProfile(depth=_PLAYING_DEPTH)


def _make_compatibility_key(qos: QoSProfile) -> tuple[object, ...]:
    """Return the policies of a profile that decide which subscriptions are compatible."""
    durations = (qos.deadline.nanoseconds, qos.liveliness_lease_duration.nanoseconds)
    return (qos.reliability, qos.durability, qos.liveliness, *durations)


def parse_overrides(document: object, source: str) -> dict[str, QoSProfile]:
    """Return the profiles in a file of QoS overrides, by topic.

    Args:
        document: the parsed YAML file of ``--qos-profile-overrides-path``: policies by name, for each topic.
        source: the name of the file, for errors.

    Raises:
        LinkwrightError: BAG106, the structure of the file is invalid.
    """
    if not isinstance(document, Mapping) or not all(isinstance(item, Mapping) for item in document.values()):
        raise _overrides_error(
            source,
            phrase("the file must map topics to policies"),
            phrase("write the topic's name, and below it a policy such as `reliability: reliable`"),
        )
    return {str(topic): _parse_profile(policies, str(topic), source) for topic, policies in document.items()}


def _parse_profile(policies: Mapping[str, Any], topic: str, source: str) -> QoSProfile:
    values: dict[str, Any] = {}
    for name, value in policies.items():
        if name in _POLICIES:
            policy_class = _POLICIES[name]
            if str(value).upper() not in policy_class.__members__:
                policy_names = policy_class.short_keys()
                hint = did_you_mean(str(value).lower(), policy_names) or phrase(
                    "choose from {names}", names=joined(policy_names)
                )
                raise _overrides_error(
                    source,
                    phrase(
                        "policy '{name}' of topic '{topic}' cannot be '{value}'", value=value, name=name, topic=topic
                    ),
                    hint,
                )
            values[name] = policy_class[str(value).upper()]
        elif name in _DURATIONS:
            if not isinstance(value, Mapping) or set(value) - {"sec", "nsec"}:
                raise _overrides_error(
                    source,
                    phrase("policy '{name}' of topic '{topic}' is not a duration", name=name, topic=topic),
                    phrase("write `sec: 1` and `nsec: 0` below it"),
                )
            values[name] = Duration(seconds=value.get("sec", 0), nanoseconds=value.get("nsec", 0))
        elif _is_valid_value(name, value):
            values[name] = value
        else:
            policy_names = [*_POLICIES, *_DURATIONS, "depth", "avoid_ros_namespace_conventions"]
            raise _overrides_error(
                source,
                phrase("policy '{name}' of topic '{topic}' is not valid", name=name, topic=topic),
                did_you_mean(str(name), policy_names),
            )
    if "depth" not in values and values.get("history") is not HistoryPolicy.KEEP_ALL:
        values["depth"] = _PLAYING_DEPTH
    return QoSProfile(**values)


def _is_valid_value(name: str, value: object) -> bool:
    if name == "depth":
        return type(value) is int and value > 0
    return name == "avoid_ros_namespace_conventions" and isinstance(value, bool)


def _overrides_error(source: str, reason: Phrase, hint: Phrase | None = None) -> LinkwrightError:
    return LinkwrightError(
        Diagnostic(
            "BAG106",
            phrase("the QoS overrides in '{source}' cannot be used: {reason}", source=source, reason=reason),
            hint=hint,
        )
    )
