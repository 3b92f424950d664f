"""QoS profiles, and which of them are compatible."""

import itertools

import pytest

from linkwright.graph import (
    DEFAULT_QOS,
    SENSOR_DATA_QOS,
    DurabilityPolicy,
    Duration,
    HistoryPolicy,
    InvalidQoSProfileError,
    LivelinessPolicy,
    QoSCompatibility,
    QoSPolicyKind,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
    qos_check_compatible,
)
from linkwright.graph.qos.compatibility import find_incompatible_policies, resolve_best_available, resolve_defaults
from linkwright.graph.qos.profile import BEST_AVAILABLE_QOS, SYSTEM_DEFAULT_QOS, qos_policy_name_from_kind
from linkwright.graph.time.values import INFINITE

RELIABLE, BEST_EFFORT = ReliabilityPolicy.RELIABLE, ReliabilityPolicy.BEST_EFFORT
VOLATILE, TRANSIENT_LOCAL = DurabilityPolicy.VOLATILE, DurabilityPolicy.TRANSIENT_LOCAL
MANUAL_BY_TOPIC = LivelinessPolicy.MANUAL_BY_TOPIC


def seconds(value):
    return Duration(seconds=value)


class TestProfiles:
    def test_history_or_depth_is_required(self):
        with pytest.raises(InvalidQoSProfileError, match="History and/or depth settings are required"):
            QoSProfile()
        with pytest.raises(InvalidQoSProfileError, match="KEEP_LAST without a depth"):
            QoSProfile(history=HistoryPolicy.KEEP_LAST)
        assert QoSProfile(history=HistoryPolicy.KEEP_ALL).queue_length is None
        assert QoSProfile(depth=3).history is HistoryPolicy.KEEP_LAST

    def test_zero_depth_warns_and_keeps_one_message(self):
        with pytest.warns(UserWarning, match="A zero depth with KEEP_LAST doesn't make sense"):
            profile = QoSProfile(depth=0)
        assert profile.queue_length == 1
        with pytest.raises(ValueError, match="depth"):
            QoSProfile(depth=-1)

    def test_policy_values_are_checked_and_integers_accepted(self):
        profile = QoSProfile(depth=1)
        profile.reliability = 2
        assert profile.reliability is BEST_EFFORT
        with pytest.raises(AssertionError):
            profile.durability = "volatile"
        with pytest.raises(ValueError, match="7"):
            profile.history = 7
        with pytest.raises(AssertionError):
            profile.deadline = 1.0

    def test_profiles_with_equal_policies_are_equal(self):
        assert QoSProfile(depth=5, reliability=BEST_EFFORT) == SENSOR_DATA_QOS
        assert QoSProfile(depth=6, reliability=BEST_EFFORT) != SENSOR_DATA_QOS
        assert DEFAULT_QOS != 10

    def test_integers_are_converted_to_depths(self):
        assert QoSProfile.of(10) == DEFAULT_QOS
        with pytest.raises(TypeError, match="Expected QoSProfile or int"):
            QoSProfile.of("10")

    def test_policy_short_names_match_command_line(self):
        assert ReliabilityPolicy.short_keys() == [
            "system_default",
            "reliable",
            "best_effort",
            "unknown",
            "best_available",
        ]
        assert DurabilityPolicy.get_from_short_key("Transient_Local") == TRANSIENT_LOCAL
        assert LivelinessPolicy.MANUAL_BY_TOPIC.short_key == "manual_by_topic"
        assert QoSPresetProfiles.get_from_short_key("sensor_data") == SENSOR_DATA_QOS
        assert "services_default" in QoSPresetProfiles.short_keys()
        assert qos_policy_name_from_kind(16) == "RELIABILITY"

    def test_profile_string_matches_rclpy(self):
        assert str(SENSOR_DATA_QOS).startswith(
            "QoSProfile(history=HistoryPolicy.KEEP_LAST, depth=5, reliability=ReliabilityPolicy.BEST_EFFORT, "
        )

    def test_system_defaults_are_resolved(self):
        chosen = resolve_defaults(SYSTEM_DEFAULT_QOS)
        assert (chosen.history, chosen.depth) == (HistoryPolicy.KEEP_LAST, 1)
        assert (chosen.reliability, chosen.durability) == (RELIABLE, VOLATILE)
        assert chosen.liveliness is LivelinessPolicy.AUTOMATIC
        assert chosen.deadline == chosen.lifespan == chosen.liveliness_lease_duration == INFINITE


def make_profile(**policies):
    return QoSProfile(depth=1, **policies)


MISMATCHES = [
    (
        make_profile(reliability=BEST_EFFORT),
        make_profile(),
        "RELIABILITY",
        "Best effort publisher and reliable subscription",
    ),
    (
        make_profile(),
        make_profile(durability=TRANSIENT_LOCAL),
        "DURABILITY",
        "Volatile publisher and transient local subscription",
    ),
    (
        make_profile(),
        make_profile(deadline=seconds(1)),
        "DEADLINE",
        "Subscription has a deadline, but publisher does not",
    ),
    (
        make_profile(deadline=seconds(2)),
        make_profile(deadline=seconds(1)),
        "DEADLINE",
        "Subscription deadline is less than publisher deadline",
    ),
    (
        make_profile(liveliness=LivelinessPolicy.AUTOMATIC),
        make_profile(liveliness=MANUAL_BY_TOPIC),
        "LIVELINESS",
        "Publisher's liveliness is automatic and subscription's is manual by topic",
    ),
    (
        make_profile(),
        make_profile(liveliness_lease_duration=seconds(1)),
        "LIVELINESS",
        "Subscription has a liveliness lease duration, but publisher does not",
    ),
    (
        make_profile(liveliness_lease_duration=seconds(2)),
        make_profile(liveliness_lease_duration=seconds(1)),
        "LIVELINESS",
        "Subscription liveliness lease duration is less than publisher",
    ),
]


class TestCompatibility:
    @pytest.mark.parametrize(("offered", "requested", "policy", "reason"), MISMATCHES)
    def test_offering_less_than_requested_is_incompatible(self, offered, requested, policy, reason):
        assert find_incompatible_policies(offered, requested) == [QoSPolicyKind[policy]]
        assert qos_check_compatible(offered, requested) == (QoSCompatibility.ERROR, f"ERROR: {reason};")
        assert find_incompatible_policies(requested, offered) == []

    def test_all_incompatible_policies_are_reported(self):
        verdict, reason = qos_check_compatible(
            make_profile(reliability=BEST_EFFORT), make_profile(durability=TRANSIENT_LOCAL, deadline=seconds(1))
        )
        assert verdict is QoSCompatibility.ERROR
        assert reason.count("ERROR: ") == 3

    def test_unknown_policies_cause_warning(self):
        unknown = make_profile(reliability=ReliabilityPolicy.UNKNOWN, liveliness=LivelinessPolicy.AUTOMATIC)
        assert qos_check_compatible(unknown, make_profile(liveliness=LivelinessPolicy.AUTOMATIC)) == (
            QoSCompatibility.WARNING,
            "WARNING: Reliable subscription, but publisher is unknown;",
        )

    @pytest.mark.parametrize(
        ("reliability", "durability"), [*itertools.product((RELIABLE, BEST_EFFORT), (VOLATILE, TRANSIENT_LOCAL))]
    )
    def test_best_available_profile_is_compatible(self, reliability, durability):
        remote_profile = make_profile(reliability=reliability, durability=durability, deadline=seconds(3))
        chosen = resolve_best_available(BEST_AVAILABLE_QOS, [remote_profile], is_publisher=False)
        assert (chosen.reliability, chosen.durability, chosen.deadline) == (reliability, durability, seconds(3))
        assert find_incompatible_policies(remote_profile, chosen) == []
        offered = resolve_best_available(BEST_AVAILABLE_QOS, [remote_profile], is_publisher=True)
        assert find_incompatible_policies(offered, remote_profile) == []
