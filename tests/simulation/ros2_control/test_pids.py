"""PID controllers of the hardware, which push joints to their commands."""

from __future__ import annotations

import pytest

from linkwright.graph.log.logger import LogLevel
from tests.simulation.ros2_control.test_plugin import ControlledRobot, robot_description, robot_with_plugin, wheel_joint
from tests.simulation.test_plugins import running_server

INTERFACES_BY_KIND = {
    "position": "position_controllers/JointGroupPositionController",
    "velocity": "velocity_controllers/JointGroupVelocityController",
}
GAINS = {"position": {"kp": 0.02, "kd": 0.005}, "velocity": {"kp": 0.003, "ki": 0.01, "max_integral_error": 10.0}}


def write_parameter_file(path, kind: str, extra: str = ""):
    path.write_text(
        f"controller_manager: {{ros__parameters: {{arm: {{type: {INTERFACES_BY_KIND[kind]}}}}}}}\n"
        f"arm: {{ros__parameters: {{joints: [left_joint]}}}}\n{extra}"
    )
    return path


def description_with_gains(kind: str, **overrides: object) -> str:
    prefix = {"position": "pos_", "velocity": "vel_"}[kind]
    gains = {**GAINS[kind], **overrides}
    params = "".join(f"<param name='{prefix}{name}'>{value}</param>" for name, value in gains.items())
    return robot_description(wheel_joint("left_joint", f"{kind}_pid").replace("<state", f"{params}<state", 1))


def file_with_gains(kind: str) -> str:
    return f"gazebo_ros2_control: {{ros__parameters: {{pid_gains: {{{kind}: {{left_joint: {GAINS[kind]}}}}}}}}}\n"


@pytest.mark.parametrize("source", ["description", "file"])
@pytest.mark.parametrize("kind", INTERFACES_BY_KIND)
async def test_pid_moves_joint_to_command_and_stops_with_controller(tmp_path, kind, source):
    is_in_description = source == "description"
    path = write_parameter_file(tmp_path / "controllers.yaml", kind, "" if is_in_description else file_with_gains(kind))
    async with running_server(robot_with_plugin(path)) as (server, graph, log):
        world = ControlledRobot(server, graph)
        await world.describe(
            description_with_gains(kind) if is_in_description else robot_description(wheel_joint("left_joint", kind))
        )
        await world.start("arm")
        server.simulation.push("mbot::base_link", (0.0, 0.0, 40.0), by="test")  # lift the wheels into the air
        await world.command(1.5, topic="/arm/commands")
        await world.advance(0.02)
        position, velocity = server.simulation.joint_state("mbot::left_joint")
        # The controller pushes the joint, and does not set its position or velocity.
        assert 0.0 < (position if kind == "position" else velocity) < 1.2
        await world.advance(2.0)
        position, velocity = server.simulation.joint_state("mbot::left_joint")
        assert (position if kind == "position" else velocity) == pytest.approx(1.5, abs=0.15)
        assert [record.text for record in log if record.level >= LogLevel.ERROR] == []
        assert (await world.call("switch_controller", deactivate_controllers=["arm"], strictness=2)).ok
        await world.advance(1.0)
        assert server.simulation.joint_state("mbot::left_joint")[1] == pytest.approx(0.0, abs=0.05)


async def test_gain_that_is_not_a_number_is_reported(tmp_path):
    path = write_parameter_file(tmp_path / "controllers.yaml", "position")
    async with running_server(robot_with_plugin(path)) as (server, graph, log):
        await ControlledRobot(server, graph).describe(description_with_gains("position", kp="stiff"))
        logged = [record.text for record in log if record.level == LogLevel.WARN]
        assert logged == ["the PID parameter kp of joint 'left_joint' is not a number: 'stiff'"]
