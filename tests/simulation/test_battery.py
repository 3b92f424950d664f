"""Batteries that drain, are charged, and stop thrusters."""

from __future__ import annotations

from math import exp

import pytest

from linkwright.messages import get_message
from linkwright.simulation.server.server import ServerOptions
from linkwright.testing import Recording
from tests.simulation.fluids.server import running_server, weightless_server
from tests.simulation.test_plugins import SECOND_NS
from tests.simulation.worlds import box

STATE = "/model/robot/battery/pack/state"
BATTERY = "sensor_msgs/msg/BatteryState"
ARM = (
    '<link name="arm"><inertial><mass>0.1</mass></inertial></link><joint name="hinge" type="revolute">'
    "<parent>link</parent><child>arm</child><axis><xyz>0 0 1</xyz></axis></joint>"
)


def battery_plugin(parameters: str) -> str:
    return (
        '<plugin name="gz::sim::systems::LinearBatteryPlugin" filename="gz-sim-linearbatteryplugin-system">'
        f"<battery_name>pack</battery_name><voltage>12</voltage>{parameters}</plugin>"
    )


def powered_box(parameters: str, extra: str = "") -> str:
    """Return a box with a battery of 12 V, whose voltage does not change with its charge."""
    constant = "<open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef>"
    return box("robot", "0 0 5 0 0 0").replace("</model>", f"{extra}{battery_plugin(constant + parameters)}</model>")


async def publish_and_advance(
    graph, server, topic: str, type_name: str = "std_msgs/msg/Bool", seconds: float = 0.0, **values
) -> None:
    """Publish a message, and advance the time."""
    publisher = graph.create_node("operator").create_publisher(type_name, topic, 10)
    server.advance(SECOND_NS // 5)  # time to find the topic
    publisher.publish(get_message(type_name)(**values))
    await graph.settle()
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()


async def last_state_after(server, graph, seconds: float):
    """Return the last state after a time."""
    recording = Recording(graph, server.node, STATE)
    server.advance(round(seconds * SECOND_NS))
    await graph.settle()
    return recording.last


DRAINING = "<capacity>2</capacity><power_load>24</power_load><start_draining>true</start_draining>"


async def test_load_drains_battery_with_smoothed_current():
    async with running_server(powered_box(DRAINING + "<smooth_current_tau>0.5</smooth_current_tau>")) as (
        server,
        graph,
        log,
    ):
        state = await last_state_after(server, graph, 1.0)
        assert state.current == pytest.approx(2.0 * (1 - exp(-2)), rel=0.01)
        server.advance(9 * SECOND_NS)
        state = await last_state_after(server, graph, 1.0)
        drained = 2.0 * (11.0 - 0.5) / 3600.0  # 24 W at 12 V for 11 s, less the delay
        assert 2.0 - state.charge == pytest.approx(drained, rel=0.02)
        assert state.percentage == pytest.approx(state.charge / 2.0)
        assert state.capacity == 2.0
        assert state.power_supply_status == get_message(BATTERY).POWER_SUPPLY_STATUS_DISCHARGING
        assert state.header.stamp.sec == 11
        server.reset()
        assert (await last_state_after(server, graph, 0.02)).charge == pytest.approx(2.0, abs=1e-5)
        assert not log


async def test_voltage_falls_with_charge_and_current():
    parameters = (
        "<capacity>2</capacity><initial_charge>0.5</initial_charge><power_load>24</power_load><resistance>0.5</resistance>"
        "<open_circuit_voltage_constant_coef>12</open_circuit_voltage_constant_coef><start_draining>1</start_draining>"
        "<open_circuit_voltage_linear_coef>-4</open_circuit_voltage_linear_coef>"
        "<invert_current_sign>true</invert_current_sign>"
    )
    text = box("robot", "0 0 5 0 0 0").replace("</model>", battery_plugin(parameters) + "</model>")
    async with running_server(text) as (server, graph, _):
        server.advance(20 * SECOND_NS)
        state = await last_state_after(server, graph, 1.0)
        assert state.current * state.voltage == pytest.approx(-24.0, rel=0.01)
        open_circuit_voltage = 12.0 - 4.0 * (1.0 - state.charge / 2.0)
        assert state.voltage == pytest.approx(open_circuit_voltage + 0.5 * state.current, rel=1e-4)


async def test_battery_rests_until_joint_is_commanded():
    force = '<plugin name="f" filename="gz-sim-apply-joint-force-system"><joint_name>hinge</joint_name></plugin>'
    text = powered_box("<capacity>2</capacity><power_load>24</power_load>", ARM + force)
    async with running_server(text) as (server, graph, _):
        state = await last_state_after(server, graph, 1.0)
        assert (state.charge, state.power_supply_status) == (2.0, get_message(BATTERY).POWER_SUPPLY_STATUS_FULL)
        await publish_and_advance(
            graph, server, "/model/robot/joint/hinge/cmd_force", "std_msgs/msg/Float64", 0.1, data=0.01
        )
        assert (await last_state_after(server, graph, 1.0)).charge < 2.0


async def test_message_of_any_type_starts_and_stops_draining():
    topics = (
        "<power_draining_topic>/work</power_draining_topic><stop_power_draining_topic>/rest</stop_power_draining_topic>"
    )
    async with running_server(powered_box(f"<capacity>2</capacity><power_load>24</power_load>{topics}")) as (
        server,
        graph,
        _,
    ):
        await publish_and_advance(graph, server, "/work", "geometry_msgs/msg/Twist", 1.0)
        charge = (await last_state_after(server, graph, 0.1)).charge
        assert charge < 2.0
        await publish_and_advance(graph, server, "/rest", "std_msgs/msg/Empty")
        charge = (await last_state_after(server, graph, 0.1)).charge
        assert (await last_state_after(server, graph, 1.0)).charge == charge


async def test_battery_is_charged_until_it_is_nearly_full():
    recharge = "<enable_recharge>true</enable_recharge><charging_time>0.01</charging_time>"
    text = powered_box(f"<capacity>2</capacity><initial_charge>0</initial_charge>{recharge}")
    async with running_server(text) as (server, graph, _):
        await publish_and_advance(graph, server, "/model/robot/battery/pack/recharge/start", seconds=10.0)
        state = await last_state_after(server, graph, 0.1)
        assert state.charge == pytest.approx(2.0 * (10.1 - 1.0) / 36.0, rel=0.02)
        assert state.power_supply_status == get_message(BATTERY).POWER_SUPPLY_STATUS_CHARGING
        server.advance(60 * SECOND_NS)
        assert (await last_state_after(server, graph, 0.1)).percentage == pytest.approx(0.93, abs=0.03)
        await publish_and_advance(graph, server, "/model/robot/battery/pack/recharge/stop")
        state = await last_state_after(server, graph, 0.1)
        assert state.power_supply_status == get_message(BATTERY).POWER_SUPPLY_STATUS_FULL


async def test_percentage_is_fraction_or_percent():
    async with running_server(powered_box("<capacity>2</capacity><fix_issue_225>true</fix_issue_225>")) as (
        server,
        graph,
        _,
    ):
        assert (await last_state_after(server, graph, 0.1)).percentage == 100.0


async def test_state_of_charge_falls_too_fast_only_with_mistakes_of_gazebo():
    options = ServerOptions(gazebo_mistakes=True)
    for extra, is_wrong in (("", True), ("<fix_issue_225>true</fix_issue_225>", False)):
        async with running_server(powered_box(DRAINING + extra), options=options) as (server, graph, _):
            state = await last_state_after(server, graph, 5.0)
            level = state.percentage / (100.0 if extra else 1.0)
            loss = 1.0 - state.charge / 2.0
            assert 1.0 - level == pytest.approx(loss * (100.0 if is_wrong else 1.0), rel=0.5)


async def test_empty_battery_is_reported_once():
    async with running_server(powered_box(f"{DRAINING}<initial_charge>0.0005</initial_charge>")) as (server, _, log):
        server.advance(5 * SECOND_NS)
        assert [record.text for record in log] == ["the battery 'pack' of 'robot' is empty"]


@pytest.mark.parametrize(
    ("parameters", "tag"),
    [
        ("<capacity>0</capacity>", "capacity"),
        ("<capacity>1</capacity><enable_recharge>1</enable_recharge>", "charging_time"),
    ],
)
async def test_capacity_and_charging_time_must_be_positive(parameters, tag):
    async with running_server(powered_box(parameters)) as (_, __, log):
        assert any(f"<{tag}> must be greater than 0" in record.text for record in log)


@pytest.mark.parametrize("control", ["", "<velocity_control>true</velocity_control>"])
async def test_thruster_draws_power_and_stops_when_battery_is_empty(control):
    thruster = (
        '<plugin name="t" filename="gz-sim-thruster-system"><joint_name>hinge</joint_name><power_load>60</power_load>'
        f"<battery_name>pack</battery_name><thrust_coefficient>1</thrust_coefficient>{control}</plugin>"
    )
    parameters = "<capacity>0.01</capacity><start_draining>true</start_draining>"
    async with weightless_server(powered_box(parameters, ARM + thruster)) as (server, graph, _):
        await publish_and_advance(
            graph, server, "/model/robot/joint/hinge/cmd_thrust", "std_msgs/msg/Float64", 1.0, data=10.0
        )
        force = server.simulation.data.body("robot::arm").xfrc_applied
        assert force[2] == pytest.approx(10.0)
        assert (await last_state_after(server, graph, 3.0)).current == pytest.approx(5.0, rel=0.05)
        server.advance(10 * SECOND_NS)
        force = server.simulation.data.body("robot::arm").xfrc_applied
        assert force == pytest.approx([0.0] * 6)
