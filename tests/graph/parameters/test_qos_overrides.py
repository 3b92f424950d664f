"""QoS profiles that parameters override."""

from __future__ import annotations

import pytest

from linkwright.graph.parameters.qos_overrides import InvalidQosOverridesError, QoSOverridingOptions, override_qos
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSPolicyKind, QoSProfile, ReliabilityPolicy
from linkwright.graph.time.values import Duration

PREFIX = "qos_overrides./chatter.publisher"


async def test_parameters_override_qos_in_code(graph):
    node = graph.create_node("node", parameters={f"{PREFIX}.depth": 3, f"{PREFIX}.reliability": "best_effort"})
    default_profile = QoSProfile(depth=10)
    profile = override_qos(node, "publisher", "/chatter", default_profile, QoSOverridingOptions.with_default_policies())
    assert (profile.depth, profile.reliability, profile.history) == (
        3,
        ReliabilityPolicy.BEST_EFFORT,
        HistoryPolicy.KEEP_LAST,
    )
    assert (default_profile.depth, default_profile.reliability) == (10, ReliabilityPolicy.RELIABLE)
    assert {name: node.get_parameter(f"{PREFIX}.{name}").value for name in ("history", "depth", "reliability")} == {
        "history": "keep_last",
        "depth": 3,
        "reliability": "best_effort",
    }
    descriptor = node.describe_parameter(f"{PREFIX}.depth")
    assert descriptor.read_only
    assert descriptor.description == "depth for publisher `/chatter` with id `None`"
    second_profile = override_qos(
        node, "publisher", "/chatter", default_profile, QoSOverridingOptions.with_default_policies()
    )
    assert second_profile.depth == 3


async def test_all_policies_and_entity_id_are_supported(graph):
    start = "qos_overrides./chatter.subscription_left"
    node = graph.create_node("node", parameters={f"{start}.deadline": 5, f"{start}.durability": "transient_local"})
    options = QoSOverridingOptions(
        [QoSPolicyKind.DEADLINE, QoSPolicyKind.DURABILITY, QoSPolicyKind.LIFESPAN, QoSPolicyKind.LIVELINESS],
        entity_id="left",
    )
    profile = override_qos(node, "subscription", "/chatter", QoSProfile(depth=1), options)
    assert (profile.deadline, profile.durability) == (Duration(nanoseconds=5), DurabilityPolicy.TRANSIENT_LOCAL)
    assert node.has_parameter(f"{start}.liveliness")
    assert not node.has_parameter(f"{start}.lifespan")


async def test_invalid_qos_overrides_are_rejected(graph):
    node = graph.create_node("node", parameters={f"{PREFIX}.reliability": "relyable"})
    with pytest.raises(InvalidQosOverridesError, match="Unexpected QoS override for policy `reliability`") as caught:
        override_qos(
            node, "publisher", "/chatter", QoSProfile(depth=1), QoSOverridingOptions([QoSPolicyKind.RELIABILITY])
        )
    assert caught.value.diagnostics[0].hint == "did you mean 'reliable'?"
    with pytest.raises(InvalidQosOverridesError, match=r"Provided QoS overrides for publisher `/x` .* are not valid"):
        override_qos(
            node,
            "publisher",
            "/x",
            QoSProfile(depth=1),
            QoSOverridingOptions([QoSPolicyKind.DEPTH], callback=lambda profile: profile.depth > 1),
        )
