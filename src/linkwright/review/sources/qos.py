"""Decide whether another QoS of a topic or service breaks its connections.

A subscription gets messages only if the publisher offers at least what the subscription asks for.
"""

from __future__ import annotations

import re

from linkwright.diagnostics import Phrase, phrase
from linkwright.review.sources.names import YES, Detail, NameKind, SourceName

_BEST_EFFORT = re.compile(r"best_?effort|sensor_?data", re.IGNORECASE)
_RELIABLE = re.compile(r"\breliable\b|[._]RELIABLE\b|_RELIABLE\b")
_TRANSIENT = re.compile(r"transient_?local|latching", re.IGNORECASE)
_VOLATILE = re.compile(r"volatile", re.IGNORECASE)
_MANUAL = re.compile(r"manual_?by_?topic", re.IGNORECASE)
_PROFILE = re.compile(r"\b(?!\d)\w*(?:qos|QoS|QOS)\w*")
_KNOWN_PROFILE = re.compile(
    r"(?:SensorData|Parameters|Services|ParameterEvents|Rosout|Clock)?QoS|QoSProfile|QoSPresetProfiles|qos|"
    r"QoS(?:Reliability|Durability|History|Liveliness)Policy|(?:RMW_)?QOS_\w+|"
    r"(?:rmw_)?qos_profile_(?:sensor_data|default|parameters|services_default)"
)
_AVAILABLE = re.compile(r"best_?available|system_?default", re.IGNORECASE)
_DEADLINE = re.compile(r"\bdeadline\s*[(=]\s*(?P<text>[^()]*(?:\([^()]*\))?)")
_DURATION = re.compile(
    r"(?P<number>\d+(?:\.\d+)?)(?P<suffix>ns|us|ms|s|min|h)\b|"
    r"\b(?P<unit>nanoseconds|microseconds|milliseconds|seconds|from_seconds)\s*[({=]\s*(?P<value>\d+(?:\.\d+)?)"
)
_SECONDS = {
    "ns": 1e-9,
    "us": 1e-6,
    "ms": 1e-3,
    "s": 1.0,
    "min": 60.0,
    "h": 3600.0,
    "from_seconds": 1.0,
    "nanoseconds": 1e-9,
    "microseconds": 1e-6,
    "milliseconds": 1e-3,
    "seconds": 1.0,
}
_DEPTH = re.compile(r"(?:QoS[({])?(?:KeepLast[({])?(?P<depth>\d+)[)}]*(?P<rest>(?:\.\w+\(\w*\))*)")
_DEFAULT_PROFILE = re.compile(
    r"\A(?:(?:\w+\.)*QoSPresetProfiles\.DEFAULT\.value|(?:\w+\.)*(?:rmw_)?qos_profile_default)\Z"
)
"""The profile that keeps ten messages, and is reliable and volatile."""
_DEFAULTS = re.compile(r"\.(?:reliable|durability_volatile)\(\)")


def normalize_qos(text: str) -> str:
    """Return a QoS in one notation: ``10``, ``rclcpp::QoS(10)`` and ``QoS(KeepLast(10)).reliable()`` are equal."""
    compact = _DEFAULT_PROFILE.sub("10", re.sub(r"\s+|\b(?:rclcpp|rmw)::", "", text))
    match = _DEPTH.fullmatch(compact)
    return compact if match is None else f"{match['depth']}{_DEFAULTS.sub('', match['rest'])}"


def list_policies(name: SourceName) -> list[str]:
    """Return the policies of a topic that differ from the default: ``best_effort``, ``transient_local``, ``latch``."""
    details = dict(name.details)
    text = details.get(Detail.QOS, "")
    policies = (("best_effort", _BEST_EFFORT), ("transient_local", _TRANSIENT))
    found = [policy for policy, pattern in policies if pattern.search(text) is not None]
    return [*found, "latch"] if details.get(Detail.LATCH) == YES else found


def find_depth(text: str) -> str | None:
    """Return the number of messages that a QoS keeps, or None if the text does not tell it."""
    match = _DEPTH.match(re.sub(r"\s+|\b(?:rclcpp|rmw)::", "", text))
    return None if match is None else match["depth"]


def find_qos_reason(name: SourceName, old: str, new: str) -> Phrase | None:
    """Return the reason why a different QoS is breaking, or None if it is not or is not known."""
    was_best_effort, is_best_effort = (_BEST_EFFORT.search(text) is not None for text in (old, new))
    was_reliable, is_reliable = (_is_known(text) or _RELIABLE.search(text) is not None for text in (old, new))
    becomes_best_effort = is_best_effort and not was_best_effort and was_reliable
    if name.kind in (NameKind.SERVICE, NameKind.CLIENT):
        return _find_service_reason(name.kind) if becomes_best_effort else None
    was_transient, is_transient = (_TRANSIENT.search(text) is not None for text in (old, new))
    was_volatile, is_volatile = (_is_known(text) or _VOLATILE.search(text) is not None for text in (old, new))
    was_manual, is_manual = (_MANUAL.search(text) is not None for text in (old, new))
    if name.kind is NameKind.PUBLISHER:
        if becomes_best_effort:
            return phrase("subscriptions that ask for reliable messages get nothing")
        if was_transient and not is_transient and is_volatile:
            return phrase("subscriptions that ask for messages from before their start get nothing")
        if was_manual and not is_manual and _is_known(new):
            return phrase("subscriptions that ask for manual liveliness get nothing")
        if _has_longer_deadline(old, new):
            return phrase("subscriptions that ask for the old deadline get nothing")
    if name.kind is NameKind.SUBSCRIPTION:
        if was_best_effort and not is_best_effort and is_reliable:
            return phrase("the node gets nothing from publishers that send with best effort")
        if is_transient and not was_transient and was_volatile:
            return phrase("the node gets nothing from publishers that keep no messages")
        if is_manual and not was_manual and _is_known(old):
            return phrase("the node gets nothing from publishers with automatic liveliness")
        if _has_longer_deadline(new, old):
            return phrase("the node gets nothing from publishers that offer the old deadline")
    return None


def _is_known(text: str) -> bool:
    """Return whether a text only uses the profiles of ROS, whose policies are known."""
    profiles = _PROFILE.findall(text)
    return all(_KNOWN_PROFILE.fullmatch(profile) for profile in profiles) and _AVAILABLE.search(text) is None


def _has_longer_deadline(first: str, second: str) -> bool:
    """Return whether the second of two QoS certainly has a longer deadline than the first one, or none."""
    deadlines = [_DEADLINE.search(text) for text in (first, second)]
    if deadlines[0] is None:
        return False
    if deadlines[1] is None:
        return _is_known(second)
    durations = [_DURATION.search(match["text"]) if match is not None else None for match in deadlines]
    if durations[0] is None or durations[1] is None:
        return False
    seconds = [
        float(match["number"] or match["value"]) * _SECONDS[match["suffix"] or match["unit"]]
        for match in durations
        if match is not None
    ]
    return seconds[1] > seconds[0] * (1 + 1e-9)


def _find_service_reason(kind: NameKind) -> Phrase:
    """Return the reason why best effort is breaking: services and their clients are reliable by default."""
    if kind is NameKind.SERVICE:
        return phrase("clients with the default QoS do not reach the service")
    return phrase("the client does not reach services with the default QoS")
