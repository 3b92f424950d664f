"""Deprecated names of QoS policy values, and QoS overrides by parameters (rclpy ``qos``)."""

from __future__ import annotations

import warnings
from typing import Any, Literal

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.parameters.qos_overrides import QoSOverridingOptions, override_qos
from linkwright.graph.qos.profile import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    QoSProfile,
    ReliabilityPolicy,
)


class _DeprecatedName:
    """A descriptor for the deprecated name of a policy value.

    Reading the attribute returns the value and prints a deprecation warning with the new name.
    """

    def __init__(self, policy: type[QoSPolicyEnum], old_name: str, new_name: str) -> None:
        self._policy = policy
        self._old_name = old_name
        self._new = new_name

    def __get__(self, instance: Any, owner: Any) -> QoSPolicyEnum:
        kind = self._policy.__name__
        warnings.warn(f"{kind}.{self._old_name} is deprecated. Use {kind}.{self._new} instead.", stacklevel=2)
        return self._policy[self._new]


def add_old_names() -> None:
    """Add the deprecated names of policy values.

    An example is ``ReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT``.
    """
    for policy in (DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy):
        policy_name = policy.__name__.removesuffix("Policy").upper()
        for value in policy:
            if value.name != "BEST_AVAILABLE":
                old_name = f"RMW_QOS_POLICY_{policy_name}_{value.name}"
                setattr(policy, old_name, _DeprecatedName(policy, old_name, value.name))


def declare_qos_parameters(
    entity_type: type, node: Any, topic_name: str, qos: QoSProfile, options: QoSOverridingOptions
) -> QoSProfile:
    """Declare parameters that override the QoS of an endpoint, and apply their values.

    Args:
        entity_type: ``Publisher`` or ``Subscription``.
        node: the node that declares the parameters.
        topic_name: the absolute name of the topic.
        qos: the profile to modify.
        options: the policies that can be overridden.

    Returns:
        The modified profile `qos`.

    Raises:
        InvalidQosOverridesError: the profile is rejected, or a value is invalid for its policy.
    """
    entity: Literal["publisher", "subscription"] = "publisher" if issubclass(entity_type, Publisher) else "subscription"
    overridden_profile = override_qos(node, entity, topic_name, qos, options)
    for kind in options.policy_kinds:
        policy = kind.name.lower()
        setattr(qos, policy, getattr(overridden_profile, policy))
    return qos
