"""The QoS profile that fits the publishers of a topic."""

from __future__ import annotations

from linkwright.graph.qos.compatibility import fit_profile
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy

REQUESTED = QoSProfile(depth=7, reliability=ReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=1)
TRANSIENT_LOCAL = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def test_fit_returns_requested_profile_without_publishers():
    fitting = fit_profile(REQUESTED, [])
    assert fitting.profile == REQUESTED
    assert fitting.profile is not REQUESTED


def test_fit_uses_policies_offered_by_all_publishers():
    fitting = fit_profile(REQUESTED, [TRANSIENT_LOCAL, TRANSIENT_LOCAL])
    assert fitting.profile.reliability is ReliabilityPolicy.RELIABLE
    assert fitting.profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert fitting.profile.depth == 7
    assert fitting.mixed == ()


def test_fit_uses_weaker_policy_and_reports_differences():
    fitting = fit_profile(REQUESTED, [TRANSIENT_LOCAL, RELIABLE, BEST_EFFORT])
    assert fitting.profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert fitting.profile.durability is DurabilityPolicy.VOLATILE
    assert [offered for offered, _ in fitting.mixed] == [
        "QoSReliabilityPolicy.RELIABLE",
        "QoSDurabilityPolicy.TRANSIENT_LOCAL",
    ]
