"""An arm in a simulated world.

It follows trajectories by position, velocity and effort commands.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.messages import String, get_action, get_service
from tests.control.controllers.arm import SentGoal, trajectory
from tests.simulation.test_plugins import SECOND_NS, running_server

ACTION = "control_msgs/action/FollowJointTrajectory"
JOINTS = ("shoulder", "elbow")
SUCCEEDED, CANCELED = 4, 5
ARM_LENGTH_M, ARM_MASS_KG = 0.5, 1.0
"""The length of each link in m, and its mass in kg."""


def model(write_parameters: Path) -> str:
    """Return an arm of two links of 1 kg that turn up and down.

    It is fixed to the world at a height of 2 m.
    """
    inertia = "<ixx>0.001</ixx><iyy>0.02</iyy><izz>0.02</izz>"
    links = joints = ""
    for number, (name, parent) in enumerate(zip(JOINTS, ("world", "shoulder_link"), strict=True)):
        links += (
            f'<link name="{name}_link"><pose>{number * ARM_LENGTH_M} 0 0 0 0 0</pose><inertial>'
            f"<pose>{ARM_LENGTH_M / 2} 0 0 0 0 0</pose><mass>{ARM_MASS_KG}</mass>"
            f"<inertia>{inertia}</inertia></inertial></link>"
        )
        joints += (
            f'<joint name="{name}" type="revolute"><parent>{parent}</parent><child>{name}_link</child><axis>'
            "<xyz>0 1 0</xyz><limit><lower>-3</lower><upper>3</upper><effort>100</effort></limit></axis></joint>"
        )
    plugin = (
        '<plugin name="gz_ros2_control::GazeboSimROS2ControlPlugin" filename="gz_ros2_control-system">'
        f"<parameters>{write_parameters}</parameters></plugin>"
    )
    return f'<model name="arm"><pose>0 0 2 0 0 0</pose>{links}{joints}{plugin}</model>'


def description(command_interface: str) -> str:
    """Return the description for the controllers.

    All joints have one kind of command interface.
    """
    interfaces = f"<command_interface name='{command_interface}'/>" + "".join(
        f"<state_interface name='{state_interface}'/>" for state_interface in ("position", "velocity")
    )
    links = "".join(f"<link name='{link}'/>" for link in ("world", *(f"{joint}_link" for joint in JOINTS)))
    joints = "".join(
        f"<joint name='{name}' type='revolute'><parent link='{parent}'/><child link='{name}_link'/><axis xyz='0 1 0'/>"
        "<limit lower='-3' upper='3' effort='100' velocity='5'/></joint>"
        for name, parent in zip(JOINTS, ("world", "shoulder_link"), strict=True)
    )
    control = "".join(f"<joint name='{name}'>{interfaces}</joint>" for name in JOINTS)
    return (
        f"<robot name='arm'>{links}{joints}<ros2_control name='arm' type='system'><hardware>"
        f"<plugin>gz_ros2_control/GazeboSimSystem</plugin></hardware>{control}</ros2_control></robot>"
    )


def write_parameters(interface: str, folder: Path) -> Path:
    """Write the controllers' parameter file."""
    path = folder / "controllers.yaml"
    gains = "{p: 50.0, i: 50.0}" if interface == "velocity" else "{p: 200.0, i: 200.0, d: 8.0}"
    scale = ", ff_velocity_scale: 1.0" if interface == "velocity" else ""
    path.write_text(
        "controller_manager:\n  ros__parameters:\n    update_rate: 500\n"
        "    arm: {type: joint_trajectory_controller/JointTrajectoryController}\n"
        f"arm:\n  ros__parameters:\n    joints: [shoulder, elbow]\n    command_interfaces: [{interface}]\n"
        "    state_interfaces: [position, velocity]\n    constraints:\n      goal_time: 1.0\n"
        "      shoulder: {trajectory: 0.3, goal: 0.02}\n      elbow: {trajectory: 0.3, goal: 0.02}\n"
        f"    gains:\n      shoulder: {gains[:-1]}{scale}}}\n      elbow: {gains[:-1]}{scale}}}\n"
    )
    return path


class Arm:
    """The arm with an active controller."""

    def __init__(self, server: Any, graph: Any) -> None:
        self.server, self.graph, self.node = server, graph, graph.create_node("test_node")

    async def start_controller(self, interface: str, wait: float = 0.02) -> None:
        """Start the controller; ``wait`` is the simulated time after each call, in s."""
        node = self.graph.create_node("robot_state_publisher")
        node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(data=description(interface)))
        await self.advance(wait / 2)
        for service, fields in (
            ("LoadController", {"name": "arm"}),
            ("ConfigureController", {"name": "arm"}),
            ("SwitchController", {"activate_controllers": ["arm"], "strictness": 2}),
        ):
            service_type = get_service(f"controller_manager_msgs/srv/{service}")
            name = service.replace("Controller", "_controller").lower()
            future = self.node.create_client(service_type, f"/controller_manager/{name}").call_async(
                service_type.Request(**fields)
            )
            await self.advance(wait)
            assert future.result().ok, service

    async def advance(self, seconds: float) -> None:
        """Advance the time in steps, and deliver messages between them."""
        remaining = round(seconds * SECOND_NS)
        while True:
            await self.graph.settle()
            self.server.advance(min(remaining, SECOND_NS // 100))
            remaining -= SECOND_NS // 100
            if remaining <= 0:
                break
        await self.graph.settle()

    def positions(self) -> list[float]:
        return [self.server.simulation.joint_state(f"arm::{joint}")[0] for joint in JOINTS]

    def call(self, *points: Any) -> SentGoal:
        goal = get_action(ACTION).Goal(trajectory=trajectory(*points))
        return SentGoal(self, ACTION, "/arm/follow_joint_trajectory", goal)  # type: ignore[arg-type]  # the arm has a node


async def test_controller_can_start_before_first_update(tmp_path):
    async with running_server(model(write_parameters("position", tmp_path))) as (server, graph, log):
        await Arm(server, graph).start_controller("position", wait=0.0)
        assert server.simulation.time == 0
        assert not [record.text for record in log if record.level.name in ("WARN", "ERROR")]


STATE = "control_msgs/msg/JointTrajectoryControllerState"


@pytest.mark.parametrize("interface", ["position", "velocity", "effort"])
async def test_arm_follows_trajectory_against_gravity(interface, tmp_path):
    async with running_server(model(write_parameters(interface, tmp_path))) as (server, graph, _):
        arm = Arm(server, graph)
        await arm.start_controller(interface)
        states: list[Any] = []
        graph.create_node("listener").create_subscription(STATE, "/arm/controller_state", states.append, 10)
        future = arm.call((2.0, [-0.6, 0.9], [0.0, 0.0]))
        await arm.advance(2.5)
        assert future.status == SUCCEEDED, future.result
        assert arm.positions() == pytest.approx([-0.6, 0.9], abs=0.02)
        errors = [abs(error) for state in states for error in state.error.positions]
        assert max(errors) < 0.2
        references = [state.reference.positions[1] for state in states]
        assert max(references) == pytest.approx(0.9, abs=0.01)
        await arm.advance(1.0)
        assert arm.positions() == pytest.approx([-0.6, 0.9], abs=0.02)


async def test_canceled_goal_stops_arm(tmp_path):
    async with running_server(model(write_parameters("position", tmp_path))) as (server, graph, _):
        arm = Arm(server, graph)
        await arm.start_controller("position")
        future = arm.call((2.0, [-0.6, 0.9]))
        await arm.advance(1.0)
        future.cancel()
        await arm.advance(0.1)
        stop_positions = arm.positions()
        await arm.advance(1.0)
        assert future.status == CANCELED
        assert arm.positions() == pytest.approx(stop_positions, abs=0.01)
        assert stop_positions == pytest.approx([-0.3, 0.45], abs=0.05)


async def test_trajectory_is_bitwise_reproducible(tmp_path):
    async def run() -> list[float]:
        async with running_server(model(write_parameters("effort", tmp_path))) as (server, graph, _):
            arm = Arm(server, graph)
            await arm.start_controller("effort")
            arm.call((1.0, [-0.3, 0.4]))
            await arm.advance(1.5)
            return arm.positions()

    assert await run() == await run()
