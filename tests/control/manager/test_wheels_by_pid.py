"""A chain in which a drive commands PID controllers, and these command the wheels."""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.control.manager.switching import STRICT
from linkwright.messages import get_message, get_service
from tests.control.robots import joint, make_manager, robot

WHEELS = ("left", "right")
TWIST = "geometry_msgs/msg/Twist"
WHEEL_RADIUS = 0.015


def pid_parameters(wheel: str) -> dict[str, Any]:
    gains = {"p": 0.15, "i": 1.0, "i_clamp_min": -2.0, "i_clamp_max": 2.0, "antiwindup": True, "feedforward_gain": 0.95}
    return {
        "dof_names": [wheel],
        "command_interface": "velocity",
        "reference_and_state_interfaces": ["velocity"],
        "gains": {wheel: gains},
    }


async def test_drive_turns_wheels_through_pid_controllers(graph):
    types = {f"pid_{wheel}": {"type": "pid_controller/PidController"} for wheel in WHEELS}
    types["base"] = {"type": "diff_drive_controller/DiffDriveController"}
    base = {
        "left_wheel_names": ["pid_left/left"],
        "right_wheel_names": ["pid_right/right"],
        "wheel_separation": 0.1,
        "wheel_radius": WHEEL_RADIUS,
        "position_feedback": False,
        "use_stamped_vel": False,
    }
    text = robot("".join(joint(wheel, "velocity") for wheel in WHEELS), joints=WHEELS)
    controller_manager = make_manager(
        graph, text, types, pid_left=pid_parameters("left"), pid_right=pid_parameters("right"), base=base
    )
    for name in types:
        assert controller_manager.load(name)
        assert controller_manager.configure(name)
    assert controller_manager.switch(["pid_left", "pid_right"], [], STRICT)[0]
    assert controller_manager.switch(["base"], [], STRICT)[0]
    node = graph.create_node("driver")
    switch = get_service("std_srvs/srv/SetBool")
    for wheel in WHEELS:
        node.create_client(switch, f"/pid_{wheel}/set_feedforward_control").call_async(switch.Request(data=True))
    twists = node.create_publisher(TWIST, "/base/cmd_vel_unstamped", 10)
    command = get_message(TWIST)()
    command.linear.x = 0.3
    for number in range(1, 301):
        twists.publish(command)
        await graph.settle()
        controller_manager.cycle(number * 10_000_000, 0.01)
    speeds = [state.value for state in controller_manager.resources.states([f"{wheel}/velocity" for wheel in WHEELS])]
    assert speeds == pytest.approx([0.3 / WHEEL_RADIUS] * 2, rel=0.01)
