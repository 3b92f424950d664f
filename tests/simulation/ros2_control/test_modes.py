"""What joints of a world do by which interface commands them, and while none does."""

from __future__ import annotations

import pytest

from tests.simulation.ros2_control.test_plugin import Controlled, controlled, description, wheel
from tests.simulation.test_plugins import served

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
    """A file of parameters with a text."""

    def write(text: str):
        path = tmp_path / "controllers.yaml"
        path.write_text(text)
        return path

    return write


def angle(server) -> float:
    return server.simulation.joint_state("mbot::left_joint")[0]


@pytest.mark.parametrize(
    ("more", "way"),
    [("", 0.5), ("<command_interface name='velocity'/>", 0.03)],  # the rotor of a motor turns with the joint
    ids=["effort", "effort and velocity"],
)
async def test_unclaimed_effort_joint_is_held_and_released_by_controller(write_parameters, more, way):
    text = description(wheel("left_joint", "effort").replace("<state", f"{more}<state", 1))
    async with served(controlled(write_parameters(EFFORTS))) as (server, graph, _):
        world = Controlled(server, graph)
        await world.describe(text)
        server.simulation.push("mbot::left_wheel", (0.0, 0.0, 0.0), (0.0, 0.01, 0.0), by="test")
        await world.advance(0.3)
        assert angle(server) == pytest.approx(0.0, abs=0.01)
        await world.start("arm")
        begin = angle(server)
        await world.command(0.01, topic="/arm/commands")
        await world.advance(0.3)
        assert angle(server) - begin > way
        assert (await world.ask("switch_controller", deactivate_controllers=["arm"], strictness=2)).ok
        stopped = angle(server)
        await world.advance(0.5)
        assert angle(server) == pytest.approx(stopped, abs=0.3)


@pytest.mark.parametrize(("kind", "way"), [("effort", 0.5), ("velocity", 0.01)])
async def test_unclaimed_joint_turns_freely_with_hold_joints_false(write_parameters, kind, way):
    text = controlled(write_parameters(EFFORTS), more="<hold_joints>false</hold_joints>")
    async with served(text) as (server, graph, _):
        world = Controlled(server, graph)
        await world.describe(description(wheel("left_joint", kind)))
        server.simulation.push("mbot::left_wheel", (0.0, 0.0, 0.0), (0.0, 0.01, 0.0), by="test")
        await world.advance(0.3)
        assert angle(server) > way


async def test_position_proportional_gain_approaches_gradually(write_parameters):
    more = "<position_proportional_gain>0.1</position_proportional_gain>"
    async with served(controlled(write_parameters(POSITIONS), "gz", more)) as (server, graph, _):
        world = Controlled(server, graph)
        await world.describe(description(wheel("left_joint", "position")))
        await world.start("arm")
        await world.command(1.0, topic="/arm/commands")
        await world.advance(0.08)
        assert 0.3 < angle(server) < 1.0 - 0.9**10  # and 0.9 without the gain
        await world.advance(1.0)
        assert angle(server) == pytest.approx(1.0, abs=0.01)
