"""The motion of joints for each kind of command interface, and without a controller."""

from __future__ import annotations

import pytest

from tests.simulation.ros2_control.test_plugin import ControlledRobot, robot_description, robot_with_plugin, wheel_joint
from tests.simulation.test_plugins import running_server

EFFORTS = (
    "controller_manager: {ros__parameters: {arm: {type: effort_controllers/JointGroupEffortController}}}\n"
    "arm: {ros__parameters: {joints: [left_joint]}}\n"
)
POSITIONS = (
    "controller_manager: {ros__parameters: {arm: {type: position_controllers/JointGroupPositionController}}}\n"
    "arm: {ros__parameters: {joints: [left_joint]}}\n"
)


@pytest.fixture
def write_parameters(tmp_path):
    """Return a function that writes a parameter file."""

    def write(text: str):
        path = tmp_path / "controllers.yaml"
        path.write_text(text)
        return path

    return write


def joint_angle(server) -> float:
    return server.simulation.joint_state("mbot::left_joint")[0]


@pytest.mark.parametrize(
    ("interfaces", "min_angle"),
    [("", 0.5), ("<command_interface name='velocity'/>", 0.03)],  # a motor's rotor slows the joint
    ids=["effort", "effort and velocity"],
)
async def test_unclaimed_effort_joint_is_held_and_released_by_controller(write_parameters, interfaces, min_angle):
    text = robot_description(wheel_joint("left_joint", "effort").replace("<state", f"{interfaces}<state", 1))
    async with running_server(robot_with_plugin(write_parameters(EFFORTS))) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(text)
        server.simulation.push("mbot::left_wheel", (0.0, 0.0, 0.0), (0.0, 0.01, 0.0), by="test")
        await world.advance(0.3)
        assert joint_angle(server) == pytest.approx(0.0, abs=0.01)
        await world.start("arm")
        start = joint_angle(server)
        await world.command(0.01, topic="/arm/commands")
        await world.advance(0.3)
        assert joint_angle(server) - start > min_angle
        assert (await world.call("switch_controller", deactivate_controllers=["arm"], strictness=2)).ok
        stop_angle = joint_angle(server)
        await world.advance(0.5)
        assert joint_angle(server) == pytest.approx(stop_angle, abs=0.3)


@pytest.mark.parametrize(("interface", "min_angle"), [("effort", 0.5), ("velocity", 0.01)])
async def test_unclaimed_joint_turns_freely_with_hold_joints_false(write_parameters, interface, min_angle):
    text = robot_with_plugin(write_parameters(EFFORTS), extra="<hold_joints>false</hold_joints>")
    async with running_server(text) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint", interface)))
        server.simulation.push("mbot::left_wheel", (0.0, 0.0, 0.0), (0.0, 0.01, 0.0), by="test")
        await world.advance(0.3)
        assert joint_angle(server) > min_angle


async def test_position_proportional_gain_approaches_gradually(write_parameters):
    gain = "<position_proportional_gain>0.1</position_proportional_gain>"
    async with running_server(robot_with_plugin(write_parameters(POSITIONS), "gz", gain)) as (server, graph, _):
        world = ControlledRobot(server, graph)
        await world.describe(robot_description(wheel_joint("left_joint", "position")))
        await world.start("arm")
        await world.command(1.0, topic="/arm/commands")
        await world.advance(0.08)
        assert 0.3 < joint_angle(server) < 1.0 - 0.9**10  # without the gain, the first step would be 0.9
        await world.advance(1.0)
        assert joint_angle(server) == pytest.approx(1.0, abs=0.01)
