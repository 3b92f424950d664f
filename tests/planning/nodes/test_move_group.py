"""move_group on the graph: kinematics, plans, the planning scene, and its start."""

from __future__ import annotations

import asyncio
from typing import Any

import numpy as np
import pytest

from linkwright.graph import LATCHED_QOS
from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import get_message
from linkwright.planning.nodes.conversions import RequestError
from tests.planning.nodes.bench import (
    PARAMETERS,
    START,
    Bench,
    box,
    closed_room,
    endless_request,
    joint_constraints,
    message,
    motion_request,
    position_constraint,
    stamped,
    state,
)

pytestmark = pytest.mark.extra("arm")


class TestKinematics:
    async def test_fk_of_state_in_frame_of_link(self, bench) -> None:
        response = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["shoulder", "tool"])
        assert response.error_code.val == 1
        assert response.pose_stamped[0].pose.position.z == pytest.approx(0.1)
        header = message("std_msgs/msg/Header", frame_id="tool")
        response = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"], header=header)
        assert response.pose_stamped[0].pose.position.x == pytest.approx(0.0, abs=1e-9)

    async def test_fk_of_unknown_link(self, bench) -> None:
        response = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["nose"])
        assert response.error_code.val == response.error_code.INVALID_LINK_NAME

    async def test_ik_and_fk_agree(self, bench) -> None:
        request = message("moveit_msgs/msg/PositionIKRequest", group_name="arm", avoid_collisions=True)
        request.pose_stamped = stamped(0.35, 0.1, 0.3)
        response = await bench.call("GetPositionIK", "compute_ik", ik_request=request)
        assert response.error_code.val == 1
        response = await bench.call(
            "GetPositionFK", "compute_fk", fk_link_names=["tool"], robot_state=response.solution
        )
        position = response.pose_stamped[0].pose.position
        np.testing.assert_allclose((position.x, position.y, position.z), (0.35, 0.1, 0.3), atol=1e-4)

    @pytest.mark.parametrize(
        ("group", "frame", "x", "code"),
        [
            ("leg", "base", 0.35, "INVALID_GROUP_NAME"),
            ("arm", "moon", 0.35, "FRAME_TRANSFORM_FAILURE"),
            ("arm", "world", 3.5, "NO_IK_SOLUTION"),
        ],
    )
    async def test_ik_failures(self, bench, group: str, frame: str, x: float, code: str) -> None:
        request = message("moveit_msgs/msg/PositionIKRequest", group_name=group)
        request.pose_stamped = stamped(x, 0.1, 0.3, frame)
        response = await bench.call("GetPositionIK", "compute_ik", ik_request=request)
        assert response.error_code.val == getattr(response.error_code, code)


class TestScene:
    async def test_object_makes_state_invalid(self, bench) -> None:
        assert (await bench.call("GetStateValidity", "check_state_validity", group_name="arm")).valid
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("crate", 0.0, 0.0, 0.45, size=(0.3, 0.3, 0.3))]
        assert (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        response = await bench.call("GetStateValidity", "check_state_validity", group_name="arm")
        assert not response.valid
        pair = response.contacts[0]
        assert {(pair.contact_body_1, pair.body_type_1), (pair.contact_body_2, pair.body_type_2)} >= {("crate", 1)}

    async def test_object_is_attached_and_detached(self, bench) -> None:
        publisher = bench.node.create_publisher("moveit_msgs/msg/CollisionObject", "collision_object", 10)
        publisher.publish(box("cup", 0.0, 0.0, 0.05, size=(0.04, 0.04, 0.04), frame="tool"))
        await bench.graph.settle()
        attached = message("moveit_msgs/msg/AttachedCollisionObject", link_name="tool")
        attached.object.id, attached.touch_links = "cup", ["flange"]
        publisher = bench.node.create_publisher(
            "moveit_msgs/msg/AttachedCollisionObject", "attached_collision_object", 10
        )
        publisher.publish(attached)
        await bench.graph.settle()
        scene = (await bench.call("GetPlanningScene", "get_planning_scene")).scene
        assert not scene.world.collision_objects
        held = scene.robot_state.attached_collision_objects[0]
        assert (held.object.id, held.link_name, held.object.header.frame_id) == ("cup", "tool", "tool")
        assert held.object.pose.position.z == pytest.approx(0.05)
        await bench.set_state(pan=0.5)
        attached.object.operation = b"\x01"
        publisher.publish(attached)
        await bench.graph.settle()
        scene = (await bench.call("GetPlanningScene", "get_planning_scene")).scene
        assert not scene.robot_state.attached_collision_objects
        position = scene.world.collision_objects[0].pose.position
        assert np.arctan2(position.y, position.x) == pytest.approx(0.5, abs=1e-6)

    async def test_objects_move_grow_and_go(self, bench) -> None:
        async def apply(collision_object: Any) -> Any:
            scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
            scene.world.collision_objects = [collision_object]
            response = await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)
            components = message("moveit_msgs/msg/PlanningSceneComponents", components=24)
            objects = (await bench.call("GetPlanningScene", "get_planning_scene", components=components)).scene
            return response.success, objects.world.collision_objects

        crate = box("crate", 1.0, 0.0, 0.2, size=(0.1, 0.1, 0.1))
        assert (await apply(crate))[0]
        moved = message("moveit_msgs/msg/CollisionObject", id="crate", operation=b"\x03")
        moved.header.frame_id, moved.pose.position.y = "base", 2.0
        is_applied, objects = await apply(moved)
        assert is_applied
        assert (objects[0].pose.position.x, objects[0].pose.position.y) == (0.0, 2.0)
        grown = box("crate", 0.0, 3.0, 0.0, size=(0.1, 0.1, 0.1))
        grown.operation = b"\x02"
        _, objects = await apply(grown)
        assert len(objects[0].primitives) == 2
        assert objects[0].primitive_poses[1].position.y == pytest.approx(1.0)
        is_applied, objects = await apply(message("moveit_msgs/msg/CollisionObject", id="crate", operation=b"\x01"))
        assert (is_applied, objects) == (True, [])
        assert not (await apply(moved))[0]
        assert not (await apply(box("crate", 0.0, 0.0, 0.0, size=(0.0, 1.0, 1.0))))[0]

    async def test_allowed_collisions_are_set_and_told(self, bench) -> None:
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("crate", 0.0, 0.0, 0.45, size=(0.3, 0.3, 0.3))]
        scene.allowed_collision_matrix.default_entry_names = ["crate"]
        scene.allowed_collision_matrix.default_entry_values = [True]
        await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)
        assert (await bench.call("GetStateValidity", "check_state_validity", group_name="arm")).valid
        matrix = (await bench.call("GetPlanningScene", "get_planning_scene")).scene.allowed_collision_matrix
        assert matrix.default_entry_names == ["crate"]

    async def test_thin_mesh_collides(self, bench) -> None:
        point = get_message("geometry_msgs/msg/Point")
        corners = [point(x=x, y=y, z=z) for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1e-4)]
        sheet = message("moveit_msgs/msg/CollisionObject", id="sheet")
        sheet.header.frame_id, sheet.pose.position.z = "base", 0.45
        sheet.pose.position.x = sheet.pose.position.y = -0.5
        sheet.meshes = [message("shape_msgs/msg/Mesh", vertices=corners)]
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [sheet]
        assert (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        response = await bench.call("GetStateValidity", "check_state_validity", group_name="arm")
        pairs = {frozenset((contact.contact_body_1, contact.contact_body_2)) for contact in response.contacts}
        assert frozenset(("sheet", "upper_arm")) in pairs

    async def test_object_must_not_have_the_name_of_a_link(self, bench, logged) -> None:
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("forearm", 0.0, 0.0, 0.0, size=(0.1, 0.1, 0.1))]
        assert not (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        assert "Cannot add object 'forearm': a link of the robot has this name" in logged("WARN")

    async def test_object_cannot_be_attached_to_unknown_link(self, bench, logged) -> None:
        attached = message("moveit_msgs/msg/AttachedCollisionObject", link_name="world")
        attached.object = box("cup", 0.0, 0.0, 0.0, size=(0.1, 0.1, 0.1))
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.robot_state.attached_collision_objects = [attached]
        assert not (await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)).success
        assert "Cannot attach object 'cup': the robot has no link 'world'" in logged("WARN")

    async def test_constraints_with_unknown_names_get_a_response(self, bench, logged) -> None:
        unknown = message("moveit_msgs/msg/JointConstraint", joint_name="tail")
        constraints = message("moveit_msgs/msg/Constraints", joint_constraints=[unknown])
        response = await bench.call("GetStateValidity", "check_state_validity", constraints=constraints)
        assert not response.valid
        request = motion_request(joint_constraints(), path_constraints=constraints)
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        code = response.motion_plan_response.error_code
        assert code.val == code.INVALID_GOAL_CONSTRAINTS
        assert "the robot has no 'tail'" in logged("ERROR")


class TestPlans:
    async def test_plan_of_service_starts_at_current_state(self, bench) -> None:
        request = motion_request(joint_constraints(pan=1.0), max_velocity_scaling_factor=1.0)
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        result = response.motion_plan_response
        assert result.error_code.val == 1
        points = result.trajectory.joint_trajectory.points
        np.testing.assert_allclose(points[0].positions, (0.0, 0.6, 1.2, 0.0, 1.0, 0.0), atol=1e-6)
        np.testing.assert_allclose(points[-1].positions, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), atol=1e-6)
        assert points[-1].time_from_start.sec + points[-1].time_from_start.nanosec * 1e-9 > 0.3

    @pytest.mark.parametrize(("right", "code"), [(0.01, "SUCCESS"), (0.02, "INVALID_GOAL_CONSTRAINTS")])
    async def test_goal_with_a_finger_that_mimics_another_one(self, bench, logged, right, code) -> None:
        joints = [
            message("moveit_msgs/msg/JointConstraint", joint_name=name, position=position)
            for name, position in (("left", 0.01), ("right", right))
        ]
        request = motion_request(message("moveit_msgs/msg/Constraints", joint_constraints=joints))
        request.group_name = "gripper"
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        error = response.motion_plan_response.error_code
        assert error.val == getattr(error, code)
        assert any("'right' contradict" in text for text in logged("ERROR")) is (code != "SUCCESS")

    async def test_failure_has_a_code_and_a_reason(self, bench, logged) -> None:
        request = motion_request(joint_constraints(lift=2.0, elbow=-2.0))
        request.start_state.attached_collision_objects = []
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        code = response.motion_plan_response.error_code
        assert code.val in (code.GOAL_IN_COLLISION, code.SUCCESS)
        request = motion_request(joint_constraints(pan=9.0))
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        assert response.motion_plan_response.error_code.val == code.INVALID_GOAL_CONSTRAINTS
        assert "a joint of the goal is outside of its bounds" in logged("ERROR")

    @pytest.mark.parametrize(
        ("changes", "code"),
        [
            ({"group_name": "leg"}, "INVALID_GROUP_NAME"),
            ({"goal_constraints": []}, "INVALID_GOAL_CONSTRAINTS"),
        ],
    )
    async def test_invalid_request(self, bench, changes: dict[str, Any], code: str) -> None:
        request = motion_request(joint_constraints())
        for name, value in changes.items():
            setattr(request, name, value)
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        error_code = response.motion_plan_response.error_code
        assert error_code.val == getattr(error_code, code)

    @pytest.mark.parametrize("value", [float("nan"), float("inf")])
    async def test_numbers_that_are_not_finite_have_a_code_and_a_reason(self, bench, logged, value: float) -> None:
        request = motion_request(joint_constraints(pan=value))
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        code = response.motion_plan_response.error_code
        assert code.val == code.INVALID_GOAL_CONSTRAINTS
        assert "a constraint of 'pan' has a number that is not finite" in logged("ERROR")
        request = motion_request(joint_constraints(), start_state=state(lift=value))
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        assert response.motion_plan_response.error_code.val == code.INVALID_ROBOT_STATE
        assert "the position of joint 'lift' at the start is not finite" in logged("ERROR")

    async def test_speed_of_a_link_is_limited(self, bench) -> None:
        async def duration(**fields: Any) -> float:
            request = motion_request(joint_constraints(**START | {"pan": 1.0}), **fields)
            request.max_velocity_scaling_factor = request.max_acceleration_scaling_factor = 1.0
            response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
            time = response.motion_plan_response.trajectory.joint_trajectory.points[-1].time_from_start
            return float(time.sec + time.nanosec * 1e-9)

        assert await duration(max_cartesian_speed=0.05) > 3.0 * await duration()

    @pytest.mark.parametrize(
        ("fields", "code"),
        [
            ({"max_cartesian_speed": float("nan")}, "INVALID_MOTION_PLAN"),
            ({"max_cartesian_speed": 0.1, "cartesian_speed_end_effector_link": "nose"}, "INVALID_LINK_NAME"),
        ],
    )
    async def test_invalid_limit_of_a_speed(self, bench, fields: dict[str, Any], code: str) -> None:
        request = motion_request(joint_constraints(**START), **fields)
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        error_code = response.motion_plan_response.error_code
        assert error_code.val == getattr(error_code, code)

    async def test_unavailable_planner_is_replaced_with_a_warning(self, bench, logged) -> None:
        request = motion_request(joint_constraints(**START), planner_id="Unknown")
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        assert response.motion_plan_response.error_code.val == 1
        await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        assert logged("WARN").count("The planner 'Unknown' is not available; RRTConnect takes its place") == 1

    async def test_unavailable_pipeline_is_replaced_with_one_warning(self, bench, logged) -> None:
        for _ in range(2):
            request = motion_request(joint_constraints(**START), pipeline_id="chomp", planner_id="CHOMP")
            response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
            assert response.motion_plan_response.error_code.val == 1
        warning = "The planner 'chomp_interface/CHOMPPlanner' of the pipeline 'chomp' is not available"
        assert logged("WARN").count(f"{warning}; RRTConnect takes its place") == 1

    @pytest.mark.parametrize(
        ("pipeline", "planner", "code", "reason"),
        [
            ("stomp", "", "FAILURE", "Couldn't find requested planning pipeline 'stomp'"),
            (
                "pilz_industrial_motion_planner",
                "ARC",
                "PLANNING_FAILED",
                "No ContextLoader for planner_id 'ARC' found. Planning not possible.",
            ),
        ],
    )
    async def test_unknown_pipelines_and_commands_are_refused(
        self, bench, logged, pipeline: str, planner: str, code: str, reason: str
    ) -> None:
        request = motion_request(joint_constraints(**START), pipeline_id=pipeline, planner_id=planner)
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        error_code = response.motion_plan_response.error_code
        assert error_code.val == getattr(error_code, code)
        assert reason in logged("ERROR")

    async def test_pilz_line(self, bench) -> None:
        fk = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"])
        start = fk.pose_stamped[0].pose
        region = message("moveit_msgs/msg/BoundingVolume")
        region.primitives = [message("shape_msgs/msg/SolidPrimitive", type=2, dimensions=[0.001])]
        region.primitive_poses = [message("geometry_msgs/msg/Pose", position=start.position)]
        region.primitive_poses[0].position.y += 0.1
        position = message("moveit_msgs/msg/PositionConstraint", link_name="tool", constraint_region=region)
        position.header.frame_id = "base"
        orientation = message("moveit_msgs/msg/OrientationConstraint", link_name="tool", orientation=start.orientation)
        orientation.header.frame_id = "base"
        goal = message(
            "moveit_msgs/msg/Constraints", position_constraints=[position], orientation_constraints=[orientation]
        )
        request = motion_request(goal, pipeline_id="pilz_industrial_motion_planner", planner_id="LIN")
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        result = response.motion_plan_response
        assert result.error_code.val == 1
        for point in result.trajectory.joint_trajectory.points[::3]:
            names = result.trajectory.joint_trajectory.joint_names
            robot_state = state(**dict(zip(names, point.positions, strict=True)))
            fk = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"], robot_state=robot_state)
            tool = fk.pose_stamped[0].pose.position
            assert tool.x == pytest.approx(start.position.x, abs=2e-3)

    @pytest.mark.parametrize(
        ("name", "y", "code"),
        [("interim", 0.05, 1), ("center", 0.05, 1), ("interim", None, -2), ("center", 0.09, -2), ("via", 0.05, -2)],
    )
    async def test_pilz_circle(self, bench, name: str, y: float | None, code: int) -> None:
        fk = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"])
        start = fk.pose_stamped[0].pose
        goal = message("moveit_msgs/msg/Constraints", position_constraints=[position_constraint(start, 0.1, 0.0)])
        goal.position_constraints[0].constraint_region.primitives = [
            message("shape_msgs/msg/SolidPrimitive", type=2, dimensions=[0.001])
        ]
        orientation = message("moveit_msgs/msg/OrientationConstraint", link_name="tool", orientation=start.orientation)
        orientation.header.frame_id = "base"
        goal.orientation_constraints = [orientation]
        constraints = message("moveit_msgs/msg/Constraints", name=name)
        if y is not None:
            constraints.position_constraints = [position_constraint(start, y, 0.05)]
        request = motion_request(goal, pipeline_id="pilz_industrial_motion_planner", planner_id="CIRC")
        request.path_constraints = constraints
        response = await bench.call("GetMotionPlan", "plan_kinematic_path", motion_plan_request=request)
        result = response.motion_plan_response
        assert result.error_code.val == code
        points = result.trajectory.joint_trajectory.points
        if code != 1:
            assert not points
            return
        names = result.trajectory.joint_trajectory.joint_names
        middle = state(**dict(zip(names, points[len(points) // 2].positions, strict=True)))
        fk = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"], robot_state=middle)
        tool, origin = fk.pose_stamped[0].pose.position, start.position
        height = 0.0 if name == "interim" else 0.05
        distance = np.hypot(tool.y - origin.y - 0.05, tool.z - origin.z - height)
        assert distance == pytest.approx(np.hypot(0.05, height), abs=3e-3)
        assert tool.z != pytest.approx(origin.z, abs=5e-3)

    async def test_cartesian_path_stops_before_obstacle(self, bench) -> None:
        fk = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"])
        waypoint = fk.pose_stamped[0].pose
        waypoint.position.y += 0.2
        fields = {"group_name": "arm", "waypoints": [waypoint], "max_step": 0.01}
        free = await bench.call("GetCartesianPath", "compute_cartesian_path", avoid_collisions=True, **fields)
        assert (free.error_code.val, free.fraction) == (1, 1.0)
        position = waypoint.position
        scene = message("moveit_msgs/msg/PlanningScene", is_diff=True)
        scene.world.collision_objects = [box("wall", position.x, position.y, position.z, size=(0.3, 0.1, 0.3))]
        await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=scene)
        blocked = await bench.call("GetCartesianPath", "compute_cartesian_path", avoid_collisions=True, **fields)
        assert 0.0 < blocked.fraction < 0.8
        ignoring = await bench.call("GetCartesianPath", "compute_cartesian_path", **fields)
        assert ignoring.fraction == 1.0

    @pytest.mark.parametrize(
        ("changes", "code"),
        [
            ({"group_name": "leg"}, "INVALID_GROUP_NAME"),
            ({"link_name": "nose"}, "INVALID_LINK_NAME"),
            ({"max_step": 0.0}, "FAILURE"),
            ({"header": get_message("std_msgs/msg/Header")(frame_id="moon")}, "FRAME_TRANSFORM_FAILURE"),
        ],
    )
    async def test_invalid_cartesian_request(self, bench, changes: dict[str, Any], code: str) -> None:
        fields = {"group_name": "arm", "max_step": 0.01, "waypoints": [message("geometry_msgs/msg/Pose")], **changes}
        response = await bench.call("GetCartesianPath", "compute_cartesian_path", **fields)
        assert response.error_code.val == getattr(response.error_code, code)


class TestCancellation:
    async def start(self, bench: Bench) -> Any:
        options = message("moveit_msgs/msg/PlanningOptions", planning_scene_diff=closed_room())
        return await bench.start("MoveGroup", "move_action", request=endless_request(), planning_options=options)

    async def test_canceled_plan_ends(self, bench) -> None:
        goal = await self.start(bench)
        await asyncio.sleep(0.2)
        goal.cancel_goal_async()
        status, result = await bench.end(goal)
        assert (status, result.error_code.val) == (GoalStatus.CANCELED, result.error_code.PREEMPTED)
        assert bench.received == []

    async def test_canceled_plan_does_not_wait_for_others(self, bench) -> None:
        first, second = await self.start(bench), await self.start(bench)
        second.cancel_goal_async()
        assert (await bench.end(second))[0] == GoalStatus.CANCELED
        third = await bench.start("MoveGroup", "move_action", request=motion_request(joint_constraints(pan=0.3)))
        first.cancel_goal_async()
        assert (await bench.end(first))[0] == GoalStatus.CANCELED
        assert (await bench.end(third))[0] == GoalStatus.SUCCEEDED

    async def test_node_that_closes_ends_its_plan(self, bench) -> None:
        await bench.call("ApplyPlanningScene", "apply_planning_scene", scene=closed_room())
        planning = bench.move_group._planning
        plan = asyncio.ensure_future(planning.plan(endless_request(), bench.move_group._monitor.scene))
        await asyncio.sleep(0.2)
        bench.move_group.close()
        with pytest.raises(RequestError, match="canceled"):
            await plan


class TestStart:
    @pytest.mark.parametrize("name", ["robot_description", "robot_description_semantic"])
    async def test_missing_description_is_read_from_topic(self, graph, logged, name: str) -> None:
        bench = Bench(graph, **{name: ""})
        assert not logged("INFO")
        publisher = bench.node.create_publisher("std_msgs/msg/String", name, LATCHED_QOS)
        publisher.publish(message("std_msgs/msg/String", data="<robot"))
        await graph.settle()
        assert len(logged("ERROR")) == 1
        publisher.publish(message("std_msgs/msg/String", data=PARAMETERS[name]))
        await graph.settle()
        response = await bench.call("GetPositionFK", "compute_fk", fk_link_names=["tool"])
        assert response.error_code.val == 1
        bench.move_group.close()

    async def test_description_that_does_not_arrive_is_reported(self, graph, clock, logged) -> None:
        bench = Bench(graph, robot_description="", robot_description_timeout=2.0)
        await clock.advance(1.9)
        assert not logged("ERROR")
        await clock.advance(5.0)
        (text,) = logged("ERROR")
        assert text.startswith("Could not find parameter robot_description and did not receive robot_description")
        assert text.endswith("within 2.000000 seconds.")
        bench.move_group.close()

    async def test_planners_are_listed_by_pipeline(self, bench) -> None:
        interfaces = (await bench.call("QueryPlannerInterfaces", "query_planner_interface")).planner_interfaces
        assert {item.pipeline_id: item.planner_ids for item in interfaces} == {
            "ompl": ["RRTConnectkConfigDefault", "Unknown"],
            "pilz_industrial_motion_planner": ["PTP", "LIN", "CIRC"],
            "chomp": ["RRTConnect"],
        }
