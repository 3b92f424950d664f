"""States of batteries, one by one and combined."""

from __future__ import annotations

from math import isnan, nan

import pytest

from linkwright.control.controllers.battery_state_broadcaster import BatteryStateBroadcaster
from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.registry import controller_class
from linkwright.diagnostics import LinkwrightError

BATTERY_STATE, BATTERY_STATES = "sensor_msgs/msg/BatteryState", "control_msgs/msg/BatteryStateArray"
PARAMETERS = {
    "batteries": ["left", "right"],
    "interfaces": {"left": {"battery_current": True, "battery_charge": True, "battery_power_supply_status": True}},
    "left": {"minimum_voltage": 10.0, "maximum_voltage": 14.0, "capacity": 5.0, "location": "slot 1"},
    "right": {"capacity": 3.0, "power_supply_technology": 2},
}


@pytest.fixture
def battery_bench(bench):
    """Return a test bench with two batteries, of which one only measures its voltage."""
    bench.joint("left", battery_voltage=13.0, battery_current=-2.0, battery_charge=4.0, battery_power_supply_status=2.0)
    bench.joint("right", battery_voltage=11.0)
    return bench


def test_broadcaster_is_found_by_type():
    assert controller_class("battery_state_broadcaster/BatteryStateBroadcaster") is BatteryStateBroadcaster


async def test_batteries_are_published_one_by_one(battery_bench):
    broadcaster = battery_bench.start(BatteryStateBroadcaster, **PARAMETERS)
    messages = battery_bench.record(BATTERY_STATES, "/controller/raw_battery_states")
    await battery_bench.step(broadcaster)
    left, right = messages[-1].battery_states
    assert (left.header.frame_id, left.voltage, left.current, left.charge) == ("left", 13.0, -2.0, 4.0)
    assert (left.percentage, left.capacity, left.power_supply_status, left.location) == (75.0, 5.0, 2, "slot 1")
    assert left.present
    assert right.present
    assert (right.voltage, right.power_supply_technology) == (11.0, 2)
    assert isnan(right.current)
    assert isnan(right.percentage)
    battery_bench.states["right/battery_voltage"].value = nan
    await battery_bench.step(broadcaster)
    assert not messages[-1].battery_states[1].present


async def test_combined_state_has_means_and_sums_of_measured_quantities(battery_bench):
    broadcaster = battery_bench.start(BatteryStateBroadcaster, **PARAMETERS)
    messages = battery_bench.record(BATTERY_STATE, "/controller/battery_state")
    await battery_bench.step(broadcaster)
    state = messages[-1]
    assert (state.voltage, state.current, state.charge, state.percentage) == (12.0, -2.0, 4.0, 75.0)
    assert (state.capacity, state.power_supply_status, state.power_supply_technology) == (8.0, 2, 0)
    assert (state.location, isnan(state.temperature)) == ("slot 1, , ", True)


async def test_sensor_name_publishes_voltage_only(bench):
    bench.joint("pack", voltage=12.5)
    broadcaster = bench.start(BatteryStateBroadcaster, sensor_name="pack", design_capacity=7.0)
    messages = bench.record(BATTERY_STATE, "/controller/battery_state")
    await bench.step(broadcaster)
    assert (messages[-1].voltage, messages[-1].design_capacity, messages[-1].present) == (12.5, 7.0, True)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({}, "No batteries configured"),
        ({"sensor_name": "pack", "batteries": ["left"]}, "cannot use both 'sensor_name' and 'batteries'"),
        (
            {"batteries": ["left"], "left": {"minimum_voltage": 12.0, "maximum_voltage": 12.0}},
            "Maximum battery voltage level must be greater",
        ),
        ({"power_supply_technology": 9}, "'power_supply_technology' must be from 0 to 8, but it is 9"),
    ],
)
async def test_invalid_parameters_are_rejected(bench, settings, message):
    expected = LinkwrightError if "power_supply_technology" in settings else ControllerError
    with pytest.raises(expected, match=message):
        bench.make(BatteryStateBroadcaster, **settings).on_configure()
