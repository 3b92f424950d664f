"""QoS overrides through parameters, as in ``rclpy.qos_overriding_options``.

An example of such a parameter is ``qos_overrides./topic.publisher.depth``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from copy import copy
from typing import Any, Literal

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, did_you_mean, foreign, joined, phrase
from linkwright.graph.parameters.node_parameters import NodeParameters
from linkwright.graph.parameters.parameter import ParameterDescriptor
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyKind,
    QoSProfile,
    ReliabilityPolicy,
)
from linkwright.graph.time.values import Duration

_POLICIES: dict[QoSPolicyKind, Any] = {
    QoSPolicyKind.HISTORY: HistoryPolicy,
    QoSPolicyKind.RELIABILITY: ReliabilityPolicy,
    QoSPolicyKind.DURABILITY: DurabilityPolicy,
    QoSPolicyKind.LIVELINESS: LivelinessPolicy,
}
_DURATIONS = (QoSPolicyKind.DEADLINE, QoSPolicyKind.LIFESPAN, QoSPolicyKind.LIVELINESS_LEASE_DURATION)


class InvalidQosOverridesError(LinkwrightError):
    """Raised when QoS parameters have invalid values, or values that the node refuses."""

    def __init__(self, message: Phrase, hint: Phrase | None = None) -> None:
        super().__init__(Diagnostic("GRAPH208", message, hint=hint))


class QoSOverridingOptions:
    """The policies of a publisher or subscription that parameters may override.

    Args:
        policy_kinds: the policies.
        callback: decides whether the resulting profile is valid; returns a result, as a parameter callback does, or a
            bool.
        entity_id: distinguishes several publishers or subscriptions of a node on the same topic.
    """

    def __init__(
        self,
        policy_kinds: Iterable[QoSPolicyKind],
        *,
        callback: Callable[[QoSProfile], Any] | None = None,
        entity_id: str | None = None,
    ) -> None:
        self.policy_kinds = tuple(policy_kinds)
        self.callback = callback
        self.entity_id = entity_id

    @classmethod
    def with_default_policies(
        cls, *, callback: Callable[[QoSProfile], Any] | None = None, entity_id: str | None = None
    ) -> QoSOverridingOptions:
        """Return options that allow parameters to override history, depth and reliability."""
        kinds = (QoSPolicyKind.HISTORY, QoSPolicyKind.DEPTH, QoSPolicyKind.RELIABILITY)
        return cls(kinds, callback=callback, entity_id=entity_id)


def override_qos(
    node: NodeParameters,
    entity: Literal["publisher", "subscription"],
    topic: str,
    qos: QoSProfile,
    options: QoSOverridingOptions | None,
) -> QoSProfile:
    """Declare the QoS parameters of a new endpoint, and return the resulting profile.

    Args:
        node: the node that declares the parameters, as read-only.
        entity: ``publisher`` or ``subscription``.
        topic: the absolute name of the endpoint's topic.
        qos: the profile that the source code specifies.
        options: the policies that may be overridden; None for none.

    Raises:
        InvalidQosOverridesError: GRAPH208, the profile is refused, or a value is not one of its policy's values.
    """
    if options is None:
        return qos
    suffix = "" if options.entity_id is None else f"_{options.entity_id}"
    profile = copy(qos)
    for policy_kind in options.policy_kinds:
        if entity == "subscription" and policy_kind is QoSPolicyKind.LIFESPAN:
            continue
        policy_name = policy_kind.name.lower()
        name = f"qos_overrides.{topic}.{entity}{suffix}.{policy_name}"
        if node.has_parameter(name):
            value = node.get_parameter(name).value
        else:
            description = f"{policy_name} for {entity} `{topic}` with id `{options.entity_id}`"
            descriptor = ParameterDescriptor(description=description, read_only=True)
            value = node.declare_parameter(name, _to_parameter(profile, policy_kind), descriptor).value
        setattr(profile, policy_name, _from_parameter(policy_kind, value, name))
    result = True if options.callback is None else options.callback(profile)
    if not getattr(result, "successful", result):
        reason = getattr(result, "reason", "")
        message = phrase(
            "Provided QoS overrides for {entity} `{topic}` with id `{entity_id}`, are not valid",
            entity=entity,
            topic=topic,
            entity_id=options.entity_id,
        )
        raise InvalidQosOverridesError(joined([message, foreign(reason)], ": ") if reason else message)
    return profile


def _to_parameter(profile: QoSProfile, kind: QoSPolicyKind) -> Any:
    value = getattr(profile, kind.name.lower())
    if kind in _POLICIES:
        return _POLICIES[kind](value).name.lower()
    return value.nanoseconds if kind in _DURATIONS else value


def _from_parameter(kind: QoSPolicyKind, value: Any, name: str) -> Any:
    if kind in _DURATIONS:
        return Duration(nanoseconds=value)
    policy_class = _POLICIES.get(kind)
    if policy_class is None:
        return value
    try:
        return policy_class[str(value).upper()]
    except KeyError:
        value_names = [value.name.lower() for value in policy_class]
        raise InvalidQosOverridesError(
            phrase(
                "Unexpected QoS override for policy `{name}`: `{value}` (parameter '{other_name}')",
                name=kind.name.lower(),
                value=value,
                other_name=name,
            ),
            did_you_mean(str(value).lower(), value_names) or phrase("choose from {names}", names=joined(value_names)),
        ) from None
