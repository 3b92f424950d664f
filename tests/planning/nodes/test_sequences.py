"""Sequences of motions through the service and the action of move_group, with Pilz' error codes."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest

from linkwright.graph.actions.goal import GoalStatus
from tests.planning.nodes.bench import (
    START,
    Bench,
    box,
    closed_room,
    endless_request,
    joint_constraints,
    message,
    motion_request,
    state,
)

pytestmark = pytest.mark.extra("arm")

PILZ = {"pipeline_id": "pilz_industrial_motion_planner", "planner_id": "PTP", "max_velocity_scaling_factor": 1.0}


def item(radius: float = 0.0, group: str = "arm", **joints: float) -> Any:
    goal = joint_constraints(**START | joints)
    if group == "gripper":
        constraint = message("moveit_msgs/msg/JointConstraint", joint_name="left", position=0.02)
        goal = message("moveit_msgs/msg/Constraints", joint_constraints=[constraint])
    request = motion_request(goal, **PILZ)
    request.group_name = group
    return message("moveit_msgs/msg/MotionSequenceItem", req=request, blend_radius=radius)


async def plan(bench: Bench, *items: Any) -> Any:
    request = message("moveit_msgs/msg/MotionSequenceRequest", items=list(items))
    return (await bench.call("GetMotionSequence", "plan_sequence_path", request=request)).response


class TestService:
    async def test_blended_motions_are_one_trajectory_that_does_not_stop(self, bench) -> None:
        response = await plan(bench, item(0.05, pan=0.5), item(pan=0.5, lift=0.3))
        assert response.error_code.val == 1
        (trajectory,) = response.planned_trajectories
        points = trajectory.joint_trajectory.points
        np.testing.assert_allclose(points[0].positions, (0.0, 0.6, 1.2, 0.0, 1.0, 0.0), atol=1e-6)
        np.testing.assert_allclose(points[-1].positions, (0.5, 0.3, 1.2, 0.0, 1.0, 0.0), atol=1e-6)
        speeds = [np.linalg.norm(point.velocities) for point in points[len(points) // 4 : -len(points) // 4]]
        assert min(speeds) > 0.1
        assert response.sequence_start.joint_state.name[:2] == ["pan", "lift"]

    async def test_each_group_has_its_own_trajectory(self, bench, logged) -> None:
        response = await plan(bench, item(0.05, pan=0.3), item(group="gripper"), item(pan=0.0))
        assert response.error_code.val == 1
        names = [trajectory.joint_trajectory.joint_names for trajectory in response.planned_trajectories]
        assert [len(group) for group in names] == [6, 1, 6]
        assert any("Blend radii set to zero" in text for text in logged("WARN"))

    async def test_empty_request_succeeds(self, bench, logged) -> None:
        response = await plan(bench)
        assert (response.error_code.val, response.planned_trajectories) == (1, [])
        assert any(text.startswith("Received empty request") for text in logged("WARN"))

    @pytest.mark.parametrize(
        ("items", "code", "reason"),
        [
            ([item(-1.0), item()], "INVALID_MOTION_PLAN", "All blending radii MUST be non negative"),
            ([item(0.1)], "INVALID_MOTION_PLAN", "The last blending radius must be zero"),
            ([item(0.5, pan=0.3), item()], "FAILURE", "Blend radius too large."),
            ([item(group="leg")], "INVALID_GROUP_NAME", "Could not solve command [0] of the sequence: there is no"),
        ],
    )
    async def test_invalid_sequences(self, bench, logged, items: list[Any], code: str, reason: str) -> None:
        response = await plan(bench, *items)
        assert response.error_code.val == getattr(response.error_code, code)
        assert any(text.startswith(reason) for text in logged("ERROR"))
        assert response.planned_trajectories == []

    async def test_only_the_first_motion_has_a_start(self, bench, logged) -> None:
        second = item(pan=0.2)
        second.req.start_state = state(pan=1.0)
        response = await plan(bench, item(pan=0.1), second)
        assert response.error_code.val == response.error_code.INVALID_ROBOT_STATE
        assert any("Only the first request is allowed to have a start state" in text for text in logged("ERROR"))


class TestAction:
    async def send(self, bench: Bench, *items: Any, **options: Any) -> tuple[int, Any]:
        request = message("moveit_msgs/msg/MotionSequenceRequest", items=list(items))
        planning_options = message("moveit_msgs/msg/PlanningOptions", **options)
        status, result = await bench.send(
            "MoveGroupSequence", "sequence_move_group", request=request, planning_options=planning_options
        )
        return status, result.response

    async def test_sequence_is_executed(self, bench) -> None:
        status, response = await self.send(bench, item(0.05, pan=0.5), item(pan=0.5, lift=0.3), item(group="gripper"))
        assert (status, response.error_code.val) == (GoalStatus.SUCCEEDED, 1)
        assert len(bench.received) == 2
        assert bench.received[0].points[-1].positions[:2] == pytest.approx([0.5, 0.3])

    async def test_nothing_is_executed_if_one_motion_has_no_plan(self, bench) -> None:
        scene = message("moveit_msgs/msg/PlanningScene")
        scene.world.collision_objects = [box("wall", 0.0, 0.3, 0.5, size=(1.0, 0.1, 1.0))]
        status, response = await self.send(bench, item(pan=-0.5), item(pan=2.0), planning_scene_diff=scene)
        assert status == GoalStatus.ABORTED
        assert response.error_code.val != 1
        assert bench.received == []

    async def test_plan_only_sends_nothing(self, bench) -> None:
        status, response = await self.send(bench, item(pan=0.1), plan_only=True)
        assert status == GoalStatus.SUCCEEDED
        assert len(response.planned_trajectories) == 1
        assert bench.received == []

    async def test_canceled_sequence_ends(self, bench) -> None:
        motion = item(pan=0.1)
        motion.req = endless_request()
        motion.req.pipeline_id = "ompl"
        goal = await bench.start(
            "MoveGroupSequence",
            "sequence_move_group",
            request=message("moveit_msgs/msg/MotionSequenceRequest", items=[motion]),
            planning_options=message("moveit_msgs/msg/PlanningOptions", planning_scene_diff=closed_room()),
        )
        await asyncio.sleep(0.2)
        goal.cancel_goal_async()
        status, result = await bench.end(goal)
        assert (status, result.response.error_code.val) == (
            GoalStatus.CANCELED,
            result.response.error_code.PREEMPTED,
        )
        assert bench.received == []
