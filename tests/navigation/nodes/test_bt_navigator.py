"""bt_navigator and waypoint_follower.

The tests cover navigation to and through poses, recoveries, feedback and rejections.
"""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.graph import DESCRIPTION_QOS, ActionServer
from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import get_action
from linkwright.navigation.costmaps.costmap import LETHAL, Costmap
from linkwright.navigation.following.follower import ZERO_VELOCITY
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.nodes.behavior_server import BehaviorServer
from linkwright.navigation.nodes.bt_navigator import BtNavigator
from linkwright.navigation.nodes.controller_server import ControllerServer
from linkwright.navigation.nodes.costmap_messages import raw_message
from linkwright.navigation.nodes.waypoint_follower import WaypointFollower
from linkwright.nodes import NodeOptions
from tests.navigation.following.driving import path_through
from tests.navigation.nodes.robots import DrivingRobot, GoalSender, path_message, pose_stamped
from tests.navigation.nodes.test_controller_server import LOCAL, PURE_PURSUIT


class Planner:
    """A planner of straight lines that fails a given number of times."""

    def __init__(self, robot):
        self.scene = robot
        self.failures = 0
        self.plans = 0
        for name in ("ComputePathToPose", "ComputePathThroughPoses"):
            kind = get_action(f"nav2_msgs/action/{name}")
            topic = "compute_path_to_pose" if name.endswith("ToPose") else "compute_path_through_poses"
            ActionServer(robot.node, kind, topic, lambda handle, kind=kind: self._plan(handle, kind.Result()))

    def _plan(self, handle, result):
        self.plans += 1
        if self.failures > 0:
            self.failures -= 1
            handle.abort()
            return result
        goal = handle.request
        poses = [pose.pose.position for pose in (goal.goals if hasattr(goal, "goals") else [goal.goal])]
        result.path = path_message(path_through(self.scene.pose[:2], *[(pose.x, pose.y) for pose in poses]))
        handle.succeed()
        return result


@pytest.fixture
async def robot(graph, clock):
    robot = DrivingRobot(graph, clock)
    planner = Planner(robot)
    options = NodeOptions(parameters={"FollowPath.plugin": PURE_PURSUIT, "autostart_node": True})
    for name, value in LOCAL.items():
        options.parameters_of_others.set("/local_costmap/local_costmap", name, value)
    navigator_options = NodeOptions(parameters={"autostart_node": True})
    nodes = [
        ControllerServer(graph, options),
        BehaviorServer(graph, navigator_options),
        BtNavigator(graph, navigator_options),
    ]
    follower = {"autostart_node": True, "stop_on_failure": False}
    nodes.append(WaypointFollower(graph, NodeOptions(parameters=follower)))
    robot.planner = planner
    await robot.run(1.0)
    yield robot
    for node in nodes:
        node.close()


async def test_navigate_to_pose_reaches_goal_with_feedback(robot):
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(3.0, 1.0))
    assert await goal.status_after(60.0) == GoalStatus.SUCCEEDED
    assert robot.distance_to(3.0, 1.0) < 0.26
    assert robot.velocity == ZERO_VELOCITY
    distances = [feedback.distance_remaining for feedback in goal.feedback]
    assert max(distances) == pytest.approx(2.0, abs=0.2)
    assert distances[-1] < 0.4
    assert goal.feedback[-1].number_of_recoveries == 0
    assert goal.feedback[-1].current_pose.header.frame_id == "map"
    assert robot.planner.plans > 3, "a path is planned each second"


async def test_goal_pose_topic_of_rviz_moves_robot(robot):
    publisher = robot.node.create_publisher("geometry_msgs/msg/PoseStamped", "/goal_pose", 10)
    publisher.publish(pose_stamped(2.0, 1.0))
    for _ in range(60):
        await robot.run(0.5)
    assert robot.distance_to(2.0, 1.0) < 0.26


async def test_navigate_through_poses_visits_all_poses(robot):
    goal = GoalSender(robot, "NavigateThroughPoses", "navigate_through_poses")
    await goal.send(poses=[pose_stamped(2.0, 1.0), pose_stamped(2.0, 2.0), pose_stamped(3.0, 2.0)])
    assert await goal.status_after(90.0) == GoalStatus.SUCCEEDED
    assert robot.distance_to(3.0, 2.0) < 0.26
    assert {feedback.number_of_poses_remaining for feedback in goal.feedback} >= {1, 2, 3}


async def test_canceling_stops_robot(robot):
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(3.5, 1.0))
    await robot.run(3.0)
    assert robot.velocity.x > 0.0
    goal.handle.cancel_goal_async()
    assert await goal.status_after(2.0) == GoalStatus.CANCELED
    await robot.run(0.2)
    assert robot.velocity == ZERO_VELOCITY


async def test_new_goal_preempts_running_goal(robot):
    first, second = (GoalSender(robot, "NavigateToPose", "navigate_to_pose") for _ in range(2))
    await first.send(pose=pose_stamped(3.5, 1.0))
    await robot.run(2.0)
    await second.send(pose=pose_stamped(1.0, 2.0))
    assert await second.status_after(60.0) == GoalStatus.SUCCEEDED
    assert await first.status_after(0.5) == GoalStatus.ABORTED
    assert robot.distance_to(1.0, 2.0) < 0.26


async def test_recoveries_run_in_order_of_nav2(robot, log):
    robot.planner.failures = 8
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(2.0, 1.0))
    assert await goal.status_after(120.0) == GoalStatus.SUCCEEDED
    texts = [record.text for record in log]
    order = [texts.index(text) for text in ("Running spin", "Running wait", "Running backup")]
    assert order == sorted(order)
    assert goal.feedback[-1].number_of_recoveries >= 4


async def test_goal_aborts_after_six_recoveries(robot, log):
    robot.planner.failures = 1000
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(2.0, 1.0))
    assert await goal.status_after(120.0) == GoalStatus.ABORTED
    assert any(record.text.startswith("Goal failed: the planner found no path") for record in log)


async def test_goal_in_wall_aborts_with_reason(robot, log):
    costmap = Costmap(Grid(cells=np.zeros((100, 100), np.uint8), resolution=0.05))
    costmap.grid.cells[:, 40:44] = LETHAL
    publisher = robot.node.create_publisher("nav2_msgs/msg/Costmap", "/global_costmap/costmap_raw", DESCRIPTION_QOS)
    publisher.publish(raw_message(costmap, "map", robot.stamp()))
    robot.planner.failures = 1000
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(2.1, 1.0))
    assert await goal.status_after(10.0) == GoalStatus.ABORTED
    assert any("the goal (2.10, 1.00) is in an obstacle" in record.text for record in log)
    assert robot.velocity == ZERO_VELOCITY


async def test_goal_without_frame_aborts_without_recoveries(robot, log):
    robot.planner.failures = 1000  # planners reject a pose without a frame
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(2.0, 1.0, frame=""))
    assert await goal.status_after(10.0) == GoalStatus.ABORTED
    assert any("the goal has no frame_id, such as map" in record.text for record in log)
    assert all(feedback.number_of_recoveries == 0 for feedback in goal.feedback)


async def test_empty_pose_list_is_rejected(robot):
    goal = GoalSender(robot, "NavigateThroughPoses", "navigate_through_poses")
    await goal.send(poses=[])
    assert not goal.handle.accepted


async def test_custom_behavior_tree_is_ignored_with_warning(robot, log):
    goal = GoalSender(robot, "NavigateToPose", "navigate_to_pose")
    await goal.send(pose=pose_stamped(1.2, 1.0), behavior_tree="/tmp/mine.xml")
    assert await goal.status_after(30.0) == GoalStatus.SUCCEEDED
    assert any("behavior trees are not supported" in record.text for record in log)


async def test_waypoints_are_followed_and_missed_ones_are_reported(robot):
    goal = GoalSender(robot, "FollowWaypoints", "follow_waypoints")
    costmap = Costmap(Grid(cells=np.zeros((100, 100), np.uint8), resolution=0.05))
    costmap.grid.cells[60:] = LETHAL  # above y = 3 m
    publisher = robot.node.create_publisher("nav2_msgs/msg/Costmap", "/global_costmap/costmap_raw", DESCRIPTION_QOS)
    publisher.publish(raw_message(costmap, "map", robot.stamp()))
    await goal.send(poses=[pose_stamped(2.0, 1.0), pose_stamped(2.0, 2.0)])
    assert await goal.status_after(90.0) == GoalStatus.SUCCEEDED
    assert list(goal.answer.result.missed_waypoints) == []
    assert {feedback.current_waypoint for feedback in goal.feedback} == {0, 1}
    robot.planner.failures = 2
    await goal.send(poses=[pose_stamped(1.0, 3.5), pose_stamped(2.0, 1.0)])
    assert await goal.status_after(90.0) == GoalStatus.SUCCEEDED
    # In Jazzy, missed waypoints are messages.
    missed_waypoints = [
        getattr(missed_waypoint, "index", missed_waypoint) for missed_waypoint in goal.answer.result.missed_waypoints
    ]
    assert missed_waypoints == [0]
    assert robot.distance_to(2.0, 1.0) < 0.26
