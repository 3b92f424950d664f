from __future__ import annotations

from linkwright.graph.qos.compatibility import fit_profile
from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile, ReliabilityPolicy

WANTED = QoSProfile(depth=7, reliability=ReliabilityPolicy.BEST_EFFORT)
RELIABLE = QoSProfile(depth=1)
LASTING = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
WEAK = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


def test_fit_returns_requested_profile_without_publishers():
    fitting = fit_profile(WANTED, [])
    assert fitting.profile == WANTED
    assert fitting.profile is not WANTED


def test_fit_uses_policies_offered_by_all_publishers():
    fitting = fit_profile(WANTED, [LASTING, LASTING])
    assert fitting.profile.reliability is ReliabilityPolicy.RELIABLE
    assert fitting.profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert fitting.profile.depth == 7
    assert fitting.mixed == ()


def test_fit_uses_weaker_policy_and_reports_differences():
    fitting = fit_profile(WANTED, [LASTING, RELIABLE, WEAK])
    assert fitting.profile.reliability is ReliabilityPolicy.BEST_EFFORT
    assert fitting.profile.durability is DurabilityPolicy.VOLATILE
    assert [offered for offered, _ in fitting.mixed] == [
        "QoSReliabilityPolicy.RELIABLE",
        "QoSDurabilityPolicy.TRANSIENT_LOCAL",
    ]
