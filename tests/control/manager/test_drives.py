"""A drive with mock hardware and a controller manager.

The tests cover PID controllers in chained mode, and stops.
"""

from __future__ import annotations

from math import cos, nan, sin
from typing import Any

import pytest

from linkwright.control.manager.services import ManagerServices
from linkwright.control.manager.switching import STRICT
from linkwright.graph.lifecycle.states import ACTIVE, INACTIVE
from linkwright.graph.stepped.exchange import Exchange
from linkwright.graph.stepped.node import SteppedNode
from linkwright.messages import get_service
from tests.control.controllers.driving import stamped_twist
from tests.control.robots import joint, make_manager, robot

WHEELS = robot(joint("left", "velocity") + joint("right", "velocity"), joints=("left", "right"))
DRIVE_TYPE, PID_TYPE = "diff_drive_controller/DiffDriveController", "pid_controller/PidController"
MECANUM_TYPE = "mecanum_drive_controller/MecanumDriveController"
WHEEL_BY_CORNER = {"front_left": "left", "front_right": "right", "rear_left": "left", "rear_right": "right"}
DRIVE_PARAMETERS = {"wheel_separation": 0.4, "wheel_radius": 0.1, "cmd_vel_timeout": 9.0, "publish_rate": 100.0}


class ControlledBase:
    """A robot on two wheels with active controllers."""

    def __init__(self, graph: Any, types: dict[str, str], **parameters: dict[str, Any]) -> None:
        self.graph, self.node, self.time_ns = graph, graph.create_node("test_node"), 0
        self.manager = make_manager(
            graph, WHEELS, {name: {"type": controller_type} for name, controller_type in types.items()}, **parameters
        )
        for name in types:
            assert self.manager.load(name)
            assert self.manager.configure(name)
        assert self.manager.switch(list(types), [], STRICT)[0]
        self.odometry: list[Any] = []
        self.node.create_subscription("nav_msgs/msg/Odometry", "/base/odom", self.odometry.append, 1000)

    async def drive(self, forward: float, yaw_rate: float, updates: int) -> None:
        publisher = self.node.create_publisher("geometry_msgs/msg/TwistStamped", "/base/cmd_vel", 10)
        publisher.publish(stamped_twist(self.time_ns, forward, yaw_rate))
        for _ in range(updates):
            await self.graph.settle()
            self.time_ns += 10_000_000
            self.manager.cycle(self.time_ns, 0.01)
        await self.graph.settle()

    def wheels(self) -> list[float]:
        return [command.value for command in self.manager.resources.commands(["left/velocity", "right/velocity"])]


async def test_drive_commands_pid_controllers_in_chained_mode(graph):
    parameters = {
        f"pid_{side}": {
            "dof_names": [side],
            "command_interface": "velocity",
            "reference_and_state_interfaces": ["velocity"],
            "enable_feedforward": True,
            f"gains.{side}.feedforward_gain": 1.0,
        }
        for side in ("left", "right")
    }
    names = {"left_wheel_names": ["pid_left/left"], "right_wheel_names": ["pid_right/right"]}
    base = ControlledBase(
        graph,
        {"pid_left": PID_TYPE, "pid_right": PID_TYPE, "base": DRIVE_TYPE},
        base=DRIVE_PARAMETERS | names | {"position_feedback": False},
        **parameters,
    )
    await base.drive(0.0, 0.0, 2)
    await base.drive(1.0, 0.5, 301)
    assert base.wheels() == pytest.approx([9.0, 11.0])
    position, yaw = base.odometry[-1].pose.pose.position, 0.5 * 3.0
    assert (position.x, position.y) == pytest.approx((2.0 * sin(yaw), 2.0 * (1.0 - cos(yaw))), abs=0.05)
    assert base.manager.controllers["pid_left"].controller.is_chained
    exchange = Exchange()
    ManagerServices(base.manager, SteppedNode(base.manager.node, exchange, owned=False))
    service = get_service("controller_manager_msgs/srv/ListControllers")
    future = base.node.create_client(service, "/controller_manager/list_controllers").call_async(service.Request())
    await graph.settle()
    exchange.run_commands()
    exchange.deliver()
    await graph.settle()
    listed = {controller.name: controller for controller in future.result().controller}
    assert [(chain.name, list(chain.reference_interfaces)) for chain in listed["base"].chain_connections] == [
        ("pid_left", ["left/velocity"]),
        ("pid_right", ["right/velocity"]),
    ]
    assert list(listed["pid_left"].chain_connections) == []


async def test_drive_is_deactivated_if_wheel_state_is_not_a_number(graph, log):
    names = {"left_wheel_names": ["left"], "right_wheel_names": ["right"]}
    base = ControlledBase(graph, {"base": DRIVE_TYPE}, base=DRIVE_PARAMETERS | names)
    await base.drive(1.0, 0.0, 10)
    assert base.wheels() == pytest.approx([10.0, 10.0])
    assert base.manager.controllers["base"].controller.state is ACTIVE
    hardware = base.manager.resources.components["arm"]

    def read(*_: object) -> None:
        for state in hardware.states:
            state.value = nan

    hardware.read = read
    await base.drive(1.0, 0.0, 2)
    assert base.manager.controllers["base"].controller.state is INACTIVE
    assert base.wheels() == [0.0, 0.0]
    assert any("Either the left or right wheel position is invalid" in record.text for record in log)


async def test_manager_selects_controller_variant_by_parameters(graph):
    wheels = {f"{corner}_wheel_name": side for corner, side in WHEEL_BY_CORNER.items()}
    sizes = {"wheel_separation_x": 0.2, "wheel_separation_y": 0.2, "wheel_radius": 0.1, "open_loop": True}
    controller_manager = make_manager(graph, WHEELS, {"base": {"type": MECANUM_TYPE}}, base={**wheels, **sizes})
    assert controller_manager.load("base")
    assert controller_manager.configure("base")
    topics = dict(graph.get_topic_names_and_types())
    assert "/base/cmd_vel" in topics
    assert "/base/reference" not in topics
