"""move_group on the graph: execution by controllers, and the margins around the robot."""

from __future__ import annotations

import asyncio
from typing import Any

import pytest

from linkwright.graph.actions.goal import GoalStatus
from tests.planning.nodes.bench import (
    PARAMETERS,
    Bench,
    box,
    joint_constraints,
    message,
    motion_request,
    short_trajectory,
    state,
)

pytestmark = pytest.mark.extra("arm")


class TestExecution:
    async def test_goal_is_planned_and_executed(self, bench) -> None:
        feedback: list[str] = []
        status, result = await bench.send(
            "MoveGroup", "move_action", request=motion_request(joint_constraints(pan=0.3))
        )
        assert status == GoalStatus.SUCCEEDED, result.error_code
        assert result.error_code.val == 1
        assert len(bench.received) == 1
        assert bench.received[0].joint_names == ["pan", "lift", "elbow", "roll", "bend", "twist"]
        assert bench.received[0].points[-1].positions[0] == pytest.approx(0.3)
        assert feedback == []

    async def test_plan_only_sends_nothing(self, bench) -> None:
        options = message("moveit_msgs/msg/PlanningOptions", plan_only=True)
        status, result = await bench.send(
            "MoveGroup", "move_action", request=motion_request(joint_constraints()), planning_options=options
        )
        assert status == GoalStatus.SUCCEEDED
        assert result.planned_trajectory.joint_trajectory.points
        assert bench.received == []

    async def test_failed_controller_fails_the_goal(self, bench, logged) -> None:
        bench.fails = True
        status, result = await bench.send("MoveGroup", "move_action", request=motion_request(joint_constraints()))
        assert status == GoalStatus.ABORTED
        assert result.error_code.val == result.error_code.CONTROL_FAILED
        assert "Controller 'arm_controller' failed: aborted" in logged("ERROR")

    @pytest.mark.parametrize(
        ("execution", "arm", "limit"),
        [
            ({}, {}, 0.61),
            ({"allowed_execution_duration_scaling": 2.0, "allowed_goal_duration_margin": 0.3}, {}, 0.5),
            ({"allowed_goal_duration_margin": 9.0}, {"allowed_goal_duration_margin": 0.0}, 0.11),
        ],
    )
    async def test_controller_that_takes_too_long_is_stopped(self, graph, clock, logged, execution, arm, limit) -> None:
        manager = PARAMETERS["moveit_simple_controller_manager"]
        manager = {**manager, "arm_controller": {**manager["arm_controller"], **arm}}
        bench = Bench(graph, moveit_simple_controller_manager=manager, trajectory_execution=execution)
        result = await self.start_endless(bench)
        elapsed_s = 0.0
        while not result.done():
            clock.jump(0.05)
            elapsed_s += 0.05
            await asyncio.sleep(0.03)
        assert elapsed_s > limit
        response = result.result()
        assert (response.status, response.result.error_code.val) == (GoalStatus.ABORTED, -6)  # TIMED_OUT
        assert any(f"trajectory execution was {limit:f} seconds" in text for text in logged("ERROR"))
        bench.move_group.close()

    async def start_endless(self, bench: Bench) -> Any:
        """Start a trajectory that the controller does not end, and return the future of the result."""
        bench.end_of_motion = asyncio.Event()
        handle = await bench.start("ExecuteTrajectory", "execute_trajectory", trajectory=short_trajectory())
        await bench.motion_started.wait()
        return handle.get_result_async()

    async def test_duration_is_not_monitored_if_not_wanted(self, graph, clock) -> None:
        bench = Bench(graph, trajectory_execution={"execution_duration_monitoring": False})
        result = await self.start_endless(bench)
        clock.jump(1000.0)
        await asyncio.sleep(0.1)
        assert not result.done()
        bench.end_of_motion.set()
        assert (await bench.wait(result)).status == GoalStatus.SUCCEEDED
        bench.move_group.close()

    async def test_gripper_gets_its_last_position(self, bench) -> None:
        trajectory = message("moveit_msgs/msg/RobotTrajectory")
        trajectory.joint_trajectory.joint_names = ["left"]
        trajectory.joint_trajectory.points = [
            message("trajectory_msgs/msg/JointTrajectoryPoint", positions=[position]) for position in (0.0, 0.02)
        ]
        status, _ = await bench.send("ExecuteTrajectory", "execute_trajectory", trajectory=trajectory)
        assert status == GoalStatus.SUCCEEDED
        assert bench.received[0].position == pytest.approx(0.02)

    async def test_trajectory_must_start_at_the_robot(self, bench, logged) -> None:
        trajectory = message("moveit_msgs/msg/RobotTrajectory")
        trajectory.joint_trajectory.joint_names = ["pan"]
        trajectory.joint_trajectory.points = [message("trajectory_msgs/msg/JointTrajectoryPoint", positions=[1.0])]
        status, result = await bench.send("ExecuteTrajectory", "execute_trajectory", trajectory=trajectory)
        assert (status, result.error_code.val) == (GoalStatus.ABORTED, result.error_code.CONTROL_FAILED)
        assert any("start point deviates from current robot state" in text for text in logged("ERROR"))

    async def test_joint_without_controller(self, bench) -> None:
        trajectory = message("moveit_msgs/msg/RobotTrajectory")
        trajectory.joint_trajectory.joint_names = ["tail"]
        trajectory.joint_trajectory.points = [message("trajectory_msgs/msg/JointTrajectoryPoint", positions=[0.0])]
        status, result = await bench.send("ExecuteTrajectory", "execute_trajectory", trajectory=trajectory)
        assert (status, result.error_code.val) == (GoalStatus.ABORTED, result.error_code.CONTROL_FAILED)


class TestMargins:
    async def is_free_beside_a_post(self, bench: Bench) -> bool:
        """Return whether the straight arm is free, 3 cm away from a post."""
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("post", 0.12, 0.0, 0.35, size=(0.1, 0.1, 0.1))]
        await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)
        straight = state(lift=0.0, elbow=0.0, bend=0.0)
        fields = {"group_name": "arm", "robot_state": straight}
        return bool((await bench.call("GetStateValidity", "check_state_validity", **fields)).valid)

    @pytest.mark.parametrize(
        ("planning", "is_free"),
        [
            ({}, True),
            ({"default_robot_padding": 0.04}, False),
            ({"default_robot_padding": 0.02}, True),
            ({"default_robot_link_padding": {"upper_arm": 0.04}}, False),
            ({"default_robot_scale": 2.0}, False),
            ({"default_robot_padding": 0.04, "default_robot_link_padding": {"upper_arm": 0.0, "shoulder": 0}}, True),
        ],
    )
    async def test_padding_in_parameters(self, graph, planning: dict[str, Any], is_free: bool) -> None:
        bench = Bench(graph, robot_description_planning=planning)
        assert await self.is_free_beside_a_post(bench) is is_free
        bench.move_group.close()

    async def test_padding_in_the_scene(self, bench) -> None:
        assert await self.is_free_beside_a_post(bench)
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.link_padding = [message("moveit_msgs/msg/LinkPadding", link_name="upper_arm", padding=0.04)]
        assert (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        assert not await self.is_free_beside_a_post(bench)
        components = message("moveit_msgs/msg/PlanningSceneComponents", components=256)
        told = (await bench.call("GetPlanningScene", "get_planning_scene", components=components)).scene
        assert {item.link_name: item.padding for item in told.link_padding if item.padding} == {"upper_arm": 0.04}
        assert {item.scale for item in told.link_scale} == {1.0}

    @pytest.mark.parametrize(
        ("field", "entry", "reason"),
        [
            ("link_padding", {"link_name": "palm", "padding": -0.1}, "Padding must be finite and cannot be negative"),
            ("link_scale", {"link_name": "palm", "scale": float("nan")}, "Scale must be positive and finite"),
            ("link_padding", {"link_name": "nose", "padding": 0.1}, "the robot has no such link"),
        ],
    )
    async def test_invalid_padding_in_the_scene(self, bench, logged, field: str, entry: Any, reason: str) -> None:
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        kind = "LinkPadding" if field == "link_padding" else "LinkScale"
        setattr(scene, field, [message(f"moveit_msgs/msg/{kind}", **entry)])
        assert not (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        assert logged("WARN")[-1].endswith(reason)

    async def test_invalid_padding_in_parameters(self, graph, logged) -> None:
        planning = {"default_robot_padding": "wide", "default_robot_link_scale": {"nose": 1.0, "palm": 0.0}}
        bench = Bench(graph, robot_description_planning=planning)
        assert logged("ERROR") == [
            "robot_description_planning.default_robot_padding: 'wide' is not a number",
            "robot_description_planning.default_robot_link_scale.nose: the robot has no link 'nose'",
            "robot_description_planning.default_robot_link_scale.palm: Scale must be positive and finite",
        ]
        bench.move_group.close()
