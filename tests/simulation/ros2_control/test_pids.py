"""Joints that a PID controller of the hardware pushes to their commands."""

from __future__ import annotations

import pytest

from linkwright.graph.log.logger import LogLevel
from tests.simulation.ros2_control.test_plugin import Controlled, controlled, description, wheel
from tests.simulation.test_plugins import served

KINDS = {
    "position": "position_controllers/JointGroupPositionController",
    "velocity": "velocity_controllers/JointGroupVelocityController",
}
GAINS = {"position": {"kp": 0.02, "kd": 0.005}, "velocity": {"kp": 0.003, "ki": 0.01, "max_integral_error": 10.0}}


def parameter_file(path, kind: str, more: str = ""):
    path.write_text(
        f"controller_manager: {{ros__parameters: {{arm: {{type: {KINDS[kind]}}}}}}}\n"
        f"arm: {{ros__parameters: {{joints: [left_joint]}}}}\n{more}"
    )
    return path


def in_description(kind: str, **changed: object) -> str:
    prefix = {"position": "pos_", "velocity": "vel_"}[kind]
    gains = {**GAINS[kind], **changed}
    params = "".join(f"<param name='{prefix}{name}'>{value}</param>" for name, value in gains.items())
    return description(wheel("left_joint", f"{kind}_pid").replace("<state", f"{params}<state", 1))


def in_file(kind: str) -> str:
    return f"gazebo_ros2_control: {{ros__parameters: {{pid_gains: {{{kind}: {{left_joint: {GAINS[kind]}}}}}}}}}\n"


@pytest.mark.parametrize("written", ["description", "file"])
@pytest.mark.parametrize("kind", KINDS)
async def test_pid_moves_joint_to_command_and_stops_with_controller(tmp_path, kind, written):
    result = written == "description"
    path = parameter_file(tmp_path / "controllers.yaml", kind, "" if result else in_file(kind))
    async with served(controlled(path)) as (server, graph, log):
        world = Controlled(server, graph)
        await world.describe(in_description(kind) if result else description(wheel("left_joint", kind)))
        await world.start("arm")
        server.simulation.push("mbot::base_link", (0.0, 0.0, 40.0), by="test")  # the wheels are in the air
        await world.command(1.5, topic="/arm/commands")
        await world.advance(0.02)
        position, velocity = server.simulation.joint_state("mbot::left_joint")
        assert 0.0 < (position if kind == "position" else velocity) < 1.2  # pushed, and not put there
        await world.advance(2.0)
        position, velocity = server.simulation.joint_state("mbot::left_joint")
        assert (position if kind == "position" else velocity) == pytest.approx(1.5, abs=0.15)
        assert [record.text for record in log if record.level >= LogLevel.ERROR] == []
        assert (await world.ask("switch_controller", deactivate_controllers=["arm"], strictness=2)).ok
        await world.advance(1.0)
        assert server.simulation.joint_state("mbot::left_joint")[1] == pytest.approx(0.0, abs=0.05)


async def test_gain_that_is_not_a_number_is_reported(tmp_path):
    path = parameter_file(tmp_path / "controllers.yaml", "position")
    async with served(controlled(path)) as (server, graph, log):
        await Controlled(server, graph).describe(in_description("position", kp="stiff"))
        logged = [record.text for record in log if record.level == LogLevel.WARN]
        assert logged == ["the PID parameter kp of joint 'left_joint' is not a number: 'stiff'"]
