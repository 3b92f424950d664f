"""The values of any state interfaces."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.control.controllers.state_interfaces_broadcaster import StateInterfacesBroadcaster
from linkwright.diagnostics import LinkwrightError
from linkwright.graph import DurabilityPolicy, QoSProfile


def test_broadcaster_is_found_by_type():
    assert controller_class("state_interfaces_broadcaster/StateInterfacesBroadcaster") is StateInterfacesBroadcaster


async def test_names_are_published_once_and_values_at_each_update(bench):
    bench.joint("elbow", position=1.5, velocity=0.2)
    bench.joint("tool", temperature=40.0)
    names = ["tool/temperature", "elbow/position"]
    broadcaster = bench.start(StateInterfacesBroadcaster, interfaces=names)
    values = bench.record("control_msgs/msg/Float64Values", "/controller/values")
    await bench.step(broadcaster, count=2)
    keys: list[Any] = []
    latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    bench.node.create_subscription("control_msgs/msg/Keys", "/controller/names", keys.append, latched)
    await bench.step(broadcaster)
    assert [message.keys for message in keys] == [names]
    assert keys[0].header.stamp.sec > 0
    assert [list(message.values) for message in values] == [[40.0, 1.5]] * 3
    assert values[0].header.stamp.nanosec == 10_000_000


async def test_interfaces_are_required(bench):
    with pytest.raises(LinkwrightError, match="Parameter 'interfaces' cannot be empty"):
        bench.make(StateInterfacesBroadcaster)
