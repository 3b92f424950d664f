"""MoveIt's Python library as users write it, with a controller that answers in another thread."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
import rclpy
from control_msgs.action import FollowJointTrajectory
from geometry_msgs.msg import Pose, PoseStamped
from moveit.core.kinematic_constraints import construct_joint_constraint, construct_link_constraint
from moveit.core.robot_model import RobotModel
from moveit.core.robot_state import RobotState, robotStateToRobotStateMsg
from moveit.core.robot_trajectory import RobotTrajectory
from moveit.planning import MoveItPy, MultiPipelinePlanRequestParameters, PlanRequestParameters
from moveit.utils import create_params_file_from_dict, get_launch_params_filepaths
from moveit_msgs.msg import CollisionObject
from rclpy.action import ActionServer
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from sensor_msgs.msg import JointState
from shape_msgs.msg import SolidPrimitive

from tests.planning.arms import SRDF, urdf
from tests.planning.nodes.bench import PARAMETERS

pytestmark = pytest.mark.extra("arm")

CONFIG = {
    **PARAMETERS,
    "planning_pipelines": {"pipeline_names": ["ompl", "pilz_industrial_motion_planner"]},
    "plan_request_params": {"planning_pipeline": "ompl", "planning_time": 5.0},
    "line": {"plan_request_params": {"planning_pipeline": "pilz_industrial_motion_planner", "planner_id": "PTP"}},
    "search": {"plan_request_params": {"planning_pipeline": "ompl", "planning_time": 5.0}},
}
NAMES = ["pan", "lift", "elbow", "roll", "bend", "twist"]


class Robot(Node):
    """A robot that is at once where its controller sends it."""

    def __init__(self) -> None:
        super().__init__("robot")
        self.positions = dict.fromkeys([*NAMES, "left"], 0.0) | {"lift": 0.4, "elbow": 1.2}
        self.goals: list[FollowJointTrajectory.Goal] = []
        self.fails = False
        self.publisher = self.create_publisher(JointState, "joint_states", 10)
        self.create_timer(0.02, self.publish)
        ActionServer(self, FollowJointTrajectory, "arm_controller/follow_joint_trajectory", self.follow)

    def publish(self) -> None:
        self.publisher.publish(JointState(name=list(self.positions), position=list(self.positions.values())))

    def follow(self, goal):
        trajectory = goal.request.trajectory
        self.goals.append(goal.request)
        if self.fails:
            goal.abort()
            return FollowJointTrajectory.Result()
        self.positions.update(zip(trajectory.joint_names, trajectory.points[-1].positions, strict=True))
        self.publish()
        goal.succeed()
        return FollowJointTrajectory.Result()


@pytest.fixture
def robot() -> Iterator[Robot]:
    rclpy.init(args=[])
    node, executor = Robot(), SingleThreadedExecutor()
    executor.add_node(node)

    def spin() -> None:
        with suppress(ExternalShutdownException):
            executor.spin()

    thread = threading.Thread(target=spin, daemon=True)
    thread.start()
    yield node
    rclpy.shutdown()
    thread.join()


@pytest.fixture
def moveit(robot) -> Iterator[MoveItPy]:
    instance = MoveItPy(node_name="moveit_py", config_dict=CONFIG)
    yield instance
    instance.shutdown()


def block(name: str, *position: float, size: float = 0.2) -> CollisionObject:
    result = CollisionObject(id=name, operation=CollisionObject.ADD)
    result.header.frame_id = "base"
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = position
    pose.orientation.w = 1.0
    result.primitives, result.primitive_poses = [SolidPrimitive(type=SolidPrimitive.BOX, dimensions=[size] * 3)], [pose]
    return result


def test_the_arm_moves_to_a_named_state_and_to_a_pose(moveit, robot):
    arm = moveit.get_planning_component("arm")
    target = RobotState(moveit.get_robot_model())
    target.joint_positions = {"pan": 0.8, "lift": 0.5, "elbow": 1.0, "bend": 0.5}
    assert arm.named_target_states == ["ready"]
    assert arm.set_goal_state(robot_state=target)
    assert moveit.execute(arm.plan().trajectory, controllers=[])
    assert robot.positions["pan"] == pytest.approx(0.8, abs=1e-3)

    arm.set_start_state_to_current_state()
    goal = PoseStamped()
    goal.header.frame_id = "base"
    target.joint_positions = {"pan": -0.4}
    goal.pose = target.get_pose("tool")
    arm.set_goal_state(pose_stamped_msg=goal, pose_link="tool")
    moveit.get_planning_scene_monitor().wait_for_current_robot_state()
    response = arm.plan()
    assert response
    assert response.error_code.val == 1
    assert moveit.execute("arm", response.trajectory)
    with moveit.get_planning_scene_monitor().read_only() as scene:
        reached = scene.current_state.get_pose("tool").position
    assert (reached.x, reached.y) == pytest.approx((goal.pose.position.x, goal.pose.position.y), abs=3e-3)


def test_a_start_far_from_the_robot_is_planned_but_not_executed(moveit, robot):
    arm = moveit.get_planning_component("arm")
    start = RobotState(moveit.get_robot_model())
    start.joint_positions = {"pan": 2.0}
    arm.set_start_state(robot_state=start)
    arm.set_goal_state(configuration_name="ready")
    status = moveit.execute(arm.plan().trajectory)
    assert (bool(status), status.status) == (False, "ABORTED")
    assert not robot.goals


def test_a_controller_that_fails_aborts_the_execution(moveit, robot):
    robot.fails = True
    arm = moveit.get_planning_component("arm")
    goal = RobotState(moveit.get_robot_model())
    goal.joint_positions = {"lift": 0.4, "elbow": 1.0}
    arm.set_goal_state(robot_state=goal)
    assert moveit.execute(arm.plan().trajectory).status == "ABORTED"
    assert moveit.get_trajectory_execution_manager().get_last_execution_status().status == "ABORTED"


def test_of_several_plans_the_shortest_path_is_taken(moveit):
    arm = moveit.get_planning_component("arm")
    goal = RobotState(moveit.get_robot_model())
    goal.joint_positions = {"pan": 1.0, "lift": 0.4, "elbow": 1.2}
    group = moveit.get_robot_model().get_joint_model_group("arm")
    arm.set_goal_state(motion_plan_constraints=[construct_joint_constraint(goal, group)])
    parameters = MultiPipelinePlanRequestParameters(moveit, ["search", "line"])
    assert [item.planner_id for item in parameters.multi_plan_request_parameters] == ["", "PTP"]
    lengths = []

    def choose(responses):
        lengths.extend(response.trajectory.path_length() for response in responses)
        return responses[0]

    arm.plan(multi_plan_parameters=parameters, solution_selection_function=choose)
    shortest = arm.plan(multi_plan_parameters=parameters)
    assert len(lengths) == 2
    assert shortest.trajectory.path_length() == pytest.approx(min(1.0, *lengths), rel=0.02)


def test_an_arc_leads_through_its_interim_point(moveit):
    arm, tool = moveit.get_planning_component("arm"), RobotState(moveit.get_robot_model())
    tool.joint_positions = {"lift": 0.4, "elbow": 1.2}
    arm.set_start_state(robot_state=tool)
    pose = tool.get_pose("tool")
    goal = PoseStamped(pose=tool.get_pose("tool"))
    goal.header.frame_id = "base"
    goal.pose.position.y += 0.1
    arm.set_goal_state(pose_stamped_msg=goal, pose_link="tool")
    parameters = PlanRequestParameters(moveit, "line")
    parameters.planner_id = "CIRC"
    response = arm.plan(single_plan_parameters=parameters)
    assert (bool(response), response.error_code.val) == (False, response.error_code.INVALID_MOTION_PLAN)
    interim = (pose.position.x, pose.position.y + 0.05, pose.position.z + 0.05)
    constraints = construct_link_constraint("tool", "base", interim, 0.001)
    constraints.name = "interim"
    arm.set_path_constraints(constraints)
    trajectory = arm.plan(single_plan_parameters=parameters).trajectory
    heights = [state.get_pose("tool").position.z for state, _ in trajectory]
    assert max(heights) == pytest.approx(interim[2], abs=3e-3)


def test_objects_are_found_until_they_are_removed(moveit):
    monitor = moveit.get_planning_scene_monitor()
    state = RobotState(moveit.get_robot_model())
    with monitor.read_write() as scene:
        tip = scene.current_state.get_pose("tool").position
        assert not scene.is_state_colliding("arm")
        scene.apply_collision_object(block("crate", tip.x, tip.y, tip.z))
        assert scene.is_state_colliding(robot_state=scene.current_state, joint_model_group_name="arm", verbose=True)
        assert not scene.is_state_colliding(robot_state=state, joint_model_group_name="arm")
        assert scene.knows_frame_transform("crate")
    arm = moveit.get_planning_component("arm")
    arm.set_goal_state(robot_state=state)
    response = arm.plan()
    assert not response
    assert response.error_code.val == response.error_code.START_STATE_IN_COLLISION
    with monitor.read_write() as scene:
        scene.allowed_collision_matrix.set_entry("crate", "flange", True)
        assert scene.allowed_collision_matrix.get_entry("crate", "flange") == (True, "ALWAYS")
        assert [item.id for item in scene.planning_scene_message.world.collision_objects] == ["crate"]
        scene.remove_all_collision_objects()
    assert arm.plan()


def test_a_state_has_frames_jacobians_and_inverse_kinematics(tmp_path: Path):
    (tmp_path / "arm.urdf").write_text(urdf(), encoding="utf-8")
    (tmp_path / "arm.srdf").write_text(SRDF, encoding="utf-8")
    model = RobotModel(urdf_xml_path=str(tmp_path / "arm.urdf"), srdf_xml_path=str(tmp_path / "arm.srdf"))
    assert (model.name, model.root_joint_name) == ("elbow_arm", "fixed")
    assert model.joint_model_group_names == ["arm", "gripper", "all"]
    assert model.get_joint_model_group("arm").joint_model_names == NAMES
    assert [group.eef_name for group in model.end_effectors] == ["hand"]
    state = RobotState(model)
    state.set_joint_group_positions("arm", [0.3, 0.4, 0.9, 0.1, 0.5, 0.0])
    step = 1e-6
    jacobian = state.get_jacobian("arm", link_name="tool", reference_point_position=np.zeros(3))
    before = state.get_frame_transform("tool")[:3, 3]
    state.joint_positions = {"lift": 0.4 + step}
    np.testing.assert_allclose((state.get_frame_transform("tool")[:3, 3] - before) / step, jacobian[:3, 1], atol=1e-5)
    pose = state.get_pose("tool")
    state.set_to_default_values("arm", "ready")
    assert state.joint_positions["elbow"] == pytest.approx(1.2)
    assert state.set_from_ik("arm", pose, "tool")
    np.testing.assert_allclose(state.get_frame_transform("tool")[:3, 3], before, atol=1e-4)
    assert "right" in robotStateToRobotStateMsg(state).joint_state.name
    state.set_to_random_positions()
    bounds = [bound for (bound,) in model.get_joint_model_group("arm").active_joint_model_bounds]
    positions = state.get_joint_group_positions("arm")
    assert all(b.min_position <= p <= b.max_position for b, p in zip(bounds, positions, strict=True))


def test_a_trajectory_becomes_a_message_and_back(moveit):
    arm = moveit.get_planning_component("arm")
    goal = RobotState(moveit.get_robot_model())
    goal.joint_positions = {"lift": 0.4, "elbow": 0.6}
    arm.set_goal_state(robot_state=goal)
    parameters = PlanRequestParameters(moveit)
    parameters.max_velocity_scaling_factor = 0.5
    trajectory = arm.plan(single_plan_parameters=parameters).trajectory
    copied = RobotTrajectory(moveit.get_robot_model())
    copied.set_robot_trajectory_msg(trajectory[0], trajectory.get_robot_trajectory_msg())
    copied.joint_model_group_name = "arm"
    assert len(copied) == len(trajectory)
    assert copied.duration == pytest.approx(trajectory.duration)
    assert copied[-1].joint_positions["elbow"] == pytest.approx(0.6, abs=1e-3)
    assert copied.apply_totg_time_parameterization(0.1, 0.1)
    assert copied.duration > trajectory.duration
    assert trajectory.get_robot_trajectory_msg(["pan"]).joint_trajectory.joint_names == ["pan"]


def test_what_is_missing_is_said(moveit):
    with pytest.raises(ValueError, match="no group 'leg'; it has arm, gripper, all"):
        moveit.get_planning_component("leg")
    arm = moveit.get_planning_component("arm")
    with pytest.raises(ValueError, match="set a goal"):
        arm.plan()
    with pytest.raises(ValueError, match="pose_link"):
        arm.set_goal_state(pose_stamped_msg=PoseStamped())
    with pytest.raises(ValueError, match="each with its tolerance"):
        construct_link_constraint("tool", "base", cartesian_position=[0.0, 0.0, 1.0])
    assert not arm.set_start_state(configuration_name="sleep")


def test_parameter_files_are_written_and_found():
    path = create_params_file_from_dict({"a": 1}, "moveit_py")
    assert "ros__parameters" in Path(path).read_text(encoding="utf-8")
    Path(path).unlink()
    assert get_launch_params_filepaths(["x", "--params-file", "p.yaml"]) == ["p.yaml"]
