"""An arm with mock hardware and a controller manager.

The tests follow trajectories of the action, from goal to result.
"""

from __future__ import annotations

from typing import Any

import pytest

from linkwright.control.manager.switching import STRICT
from linkwright.messages import get_action
from tests.control.controllers.arm import SentGoal, trajectory
from tests.control.robots import joint, make_manager, robot

ACTION = "control_msgs/action/FollowJointTrajectory"
TYPE = "joint_trajectory_controller/JointTrajectoryController"
JOINTS = ("hip", "knee")
PARAMETERS = {"joints": list(JOINTS), "command_interfaces": ["position"], "state_interfaces": ["position", "velocity"]}
SUCCEEDED, CANCELED = 4, 5


class ControlledArm:
    """A robot with an active trajectory controller."""

    def __init__(self, graph: Any) -> None:
        self.graph, self.node, self.time_ns = graph, graph.create_node("test_node"), 0
        text = robot(joint("hip", initial="0.2") + joint("knee"))
        self.manager = make_manager(graph, text, {"arm": {"type": TYPE}}, arm=PARAMETERS)
        assert self.manager.load("arm")
        assert self.manager.configure("arm")
        assert self.manager.switch(["arm"], [], STRICT)[0]

    async def advance(self, seconds: float) -> None:
        for _ in range(round(seconds * 100)):
            await self.graph.settle()
            self.time_ns += 10_000_000
            self.manager.cycle(self.time_ns, 0.01)
        await self.graph.settle()

    def send_goal(self, *points: Any) -> SentGoal:
        goal = get_action(ACTION).Goal(trajectory=trajectory(*points, names=JOINTS))
        return SentGoal(self, ACTION, "/arm/follow_joint_trajectory", goal)  # type: ignore[arg-type]  # the arm has a node

    def positions(self) -> list[float]:
        return [state.value for state in self.manager.resources.states([f"{name}/position" for name in JOINTS])]


async def test_arm_holds_position_and_follows_trajectory(graph):
    arm = ControlledArm(graph)
    await arm.advance(0.1)
    assert arm.positions() == [0.2, 0.0]
    goal = arm.send_goal((1.0, [1.2, -1.0]))
    await arm.advance(0.5)
    assert arm.positions() == pytest.approx([0.7, -0.5], abs=0.021)
    await arm.advance(0.6)
    assert goal.status == SUCCEEDED
    assert arm.positions() == [1.2, -1.0]


async def test_goal_can_be_canceled_on_event_loop(graph):
    arm = ControlledArm(graph)
    goal = arm.send_goal((1.0, [1.2, 1.0]))
    await arm.advance(0.5)
    goal.cancel()
    await arm.advance(0.1)
    assert goal.status == CANCELED
    stop_positions = arm.positions()
    await arm.advance(0.5)
    assert arm.positions() == pytest.approx(stop_positions)
    assert stop_positions[0] == pytest.approx(0.7, abs=0.03)


async def test_deactivation_ends_goal_and_allows_new_one(graph):
    arm = ControlledArm(graph)
    first = arm.send_goal((1.0, [1.2, 1.0]))
    await arm.advance(0.5)
    assert arm.manager.switch([], ["arm"], STRICT)[0]
    await arm.advance(0.1)
    assert first.status == CANCELED
    new_goal = arm.send_goal((1.0, [0.0, 0.0]))
    await arm.advance(0.1)
    assert new_goal.accepted is False
    assert arm.manager.switch(["arm"], [], STRICT)[0]
    second = arm.send_goal((0.5, [0.0, 0.0]))
    await arm.advance(0.7)
    assert second.status == SUCCEEDED
    assert arm.positions() == [0.0, 0.0]
