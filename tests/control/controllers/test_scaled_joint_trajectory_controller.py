"""The trajectory controller of Universal Robots.

The trajectory's time advances by the robot's speed scaling.
"""

from __future__ import annotations

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.control.hardware.interfaces import StateInterface
from linkwright.messages import get_action
from tests.control.controllers.arm import JOINTS, SentGoal, run, trajectory

ACTION = "control_msgs/action/FollowJointTrajectory"
TYPE = "ur_controllers/ScaledJointTrajectoryController"
SCALING_INTERFACE = "speed_scaling/speed_scaling_factor"
PARAMETERS = {"joints": list(JOINTS), "command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
SUCCEEDED = 4


async def run_goal(bench, seconds, factor=None, **parameters):
    """Return the first joint's position after some seconds, and the goal.

    The goal is 2 rad in 2 s.
    """
    for joint in JOINTS:
        bench.joint(joint, commands=("position",), position=0.0, velocity=0.0)
    if factor is not None:
        bench.states[SCALING_INTERFACE] = StateInterface(*SCALING_INTERFACE.split("/"), factor)
    controller = bench.start(controller_class(TYPE), **PARAMETERS, **parameters)

    def follow_commands():
        for name, command in bench.commands.items():
            bench.states[name].value = command.value

    message = trajectory((2.0, [2.0] * len(JOINTS)))
    goal = SentGoal(bench, ACTION, "/controller/follow_joint_trajectory", get_action(ACTION).Goal(trajectory=message))
    await run(bench, controller, seconds, follow_commands)
    return bench.commands[f"{JOINTS[0]}/position"].value, goal


@pytest.mark.parametrize(("factor", "expected"), [(1.0, 1.0), (0.5, 0.5), (0.0, 0.0)])
async def test_trajectory_advances_at_robot_speed_scaling(bench, factor, expected):
    position, _ = await run_goal(bench, 1.0, factor)
    assert position == pytest.approx(expected, abs=0.03)


async def test_scaled_goal_takes_longer_and_succeeds(bench):
    position, goal = await run_goal(bench, 4.2, 0.5)
    assert position == pytest.approx(2.0)
    assert goal.status == SUCCEEDED


async def test_trajectory_runs_unscaled_without_interface(bench):
    position, _ = await run_goal(bench, 1.0, speed_scaling_interface_name="")
    assert position == pytest.approx(1.0, abs=0.03)
