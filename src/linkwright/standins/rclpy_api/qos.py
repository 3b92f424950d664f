"""Older names of policies, which many programs still use (rclpy ``qos``)."""

from __future__ import annotations

import warnings
from typing import Any

from linkwright.graph.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPolicyEnum,
    ReliabilityPolicy,
)


class _OldName:
    """Gives the value of a policy by its old name, and says the new one."""

    def __init__(self, policy: type[QoSPolicyEnum], old: str, new: str) -> None:
        self._policy = policy
        self._old = old
        self._new = new

    def __get__(self, instance: Any, owner: Any) -> QoSPolicyEnum:
        kind = self._policy.__name__
        warnings.warn(f"{kind}.{self._old} is deprecated. Use {kind}.{self._new} instead.", stacklevel=2)
        return self._policy[self._new]


def add_old_names() -> None:
    """Let values be found by names such as ``ReliabilityPolicy.RMW_QOS_POLICY_RELIABILITY_BEST_EFFORT``."""
    for policy in (DurabilityPolicy, HistoryPolicy, LivelinessPolicy, ReliabilityPolicy):
        word = policy.__name__.removesuffix("Policy").upper()
        for value in policy:
            if value.name != "BEST_AVAILABLE":
                old = f"RMW_QOS_POLICY_{word}_{value.name}"
                setattr(policy, old, _OldName(policy, old, value.name))
