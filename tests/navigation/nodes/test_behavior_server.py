"""behavior_server: behaviors as actions, with obstacles, time allowances and cancellation."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.graph import DESCRIPTION_QOS
from linkwright.graph.actions.goal import GoalStatus
from linkwright.graph.time.values import Duration
from linkwright.messages import get_message
from linkwright.navigation.costmaps.costmap import LETHAL, Costmap
from linkwright.navigation.costmaps.footprints import make_circle, place_footprint
from linkwright.navigation.following.follower import ZERO_VELOCITY
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.nodes.behavior_server import BehaviorServer, RecoveriesServer
from linkwright.navigation.nodes.costmap_messages import raw_message
from linkwright.nodes import NodeOptions
from tests.navigation.nodes.robots import DrivingRobot, GoalSender


class CostmapRobot(DrivingRobot):
    """A fake robot that also publishes a costmap and a footprint."""

    def __init__(self, graph, clock):
        super().__init__(graph, clock)
        self.costmap = Costmap(Grid(cells=np.zeros((100, 100), np.uint8), resolution=0.05))
        raw, polygon = get_message("nav2_msgs/msg/Costmap"), get_message("geometry_msgs/msg/PolygonStamped")
        self._raw = self.node.create_publisher(raw, "/local_costmap/costmap_raw", DESCRIPTION_QOS)
        self._footprint = self.node.create_publisher(polygon, "/local_costmap/published_footprint", 10)
        self.node.create_timer(0.2, self.publish_costmap)

    def publish_costmap(self):
        if not self.publishes_scans:
            return
        self._raw.publish(raw_message(self.costmap, "odom", self.stamp()))
        message = self._footprint.msg_type()
        message.header.frame_id, message.header.stamp = "odom", self.stamp()
        point = get_message("geometry_msgs/msg/Point32")
        corners = place_footprint(make_circle(0.2), *self.pose)
        message.polygon.points = [point(x=float(x), y=float(y)) for x, y in corners]
        self._footprint.publish(message)


@pytest.fixture
async def robot(graph, clock):
    robot = CostmapRobot(graph, clock)
    robot.pose = (2.5, 2.5, 0.4)
    server = BehaviorServer(graph, NodeOptions(parameters={"autostart_node": True}))
    await robot.run(1.0)
    yield robot
    server.close()


async def test_spin_turns_by_requested_angle(robot):
    goal = GoalSender(robot, "Spin", "spin")
    await goal.send(target_yaw=pi / 2, time_allowance=Duration(seconds=10.0).to_msg())
    assert await goal.status_after(10.0) == GoalStatus.SUCCEEDED
    assert robot.pose[2] == pytest.approx(0.4 + pi / 2, abs=0.1)
    assert robot.velocity == ZERO_VELOCITY
    assert goal.feedback[-1].angular_distance_traveled == pytest.approx(pi / 2, abs=0.15)
    assert goal.answer.result.total_elapsed_time.sec >= 1


@pytest.mark.parametrize(
    ("name", "action_type", "sign"), [("backup", "BackUp", -1), ("drive_on_heading", "DriveOnHeading", 1)]
)
async def test_straight_drives_cover_requested_distance(robot, name, action_type, sign):
    goal = GoalSender(robot, action_type, name)
    start = robot.pose
    await goal.send(target=get_message("geometry_msgs/msg/Point")(x=0.3), speed=0.2)
    assert await goal.status_after(10.0) == GoalStatus.SUCCEEDED
    assert robot.distance_to(*start[:2]) == pytest.approx(0.3, abs=0.05)
    assert np.sign(robot.pose[0] - start[0]) == sign
    assert robot.velocity == ZERO_VELOCITY


async def test_backup_stops_before_obstacle(robot, log):
    robot.costmap.grid.cells[:, :30] = LETHAL  # up to x = 1.5 m
    await robot.run(0.5)
    goal = GoalSender(robot, "BackUp", "backup")
    await goal.send(target=get_message("geometry_msgs/msg/Point")(x=3.0), speed=0.2)
    assert await goal.status_after(20.0) == GoalStatus.ABORTED
    assert 1.65 < robot.pose[0] < 2.4
    assert robot.velocity == ZERO_VELOCITY
    assert any("there is an obstacle ahead" in record.text for record in log)


async def test_drive_on_heading_ends_after_time_allowance(robot):
    goal = GoalSender(robot, "DriveOnHeading", "drive_on_heading")
    target = get_message("geometry_msgs/msg/Point")(x=1.5)
    await goal.send(target=target, speed=0.05, time_allowance=Duration(seconds=2.0).to_msg())
    assert await goal.status_after(4.0) == GoalStatus.ABORTED
    assert robot.velocity == ZERO_VELOCITY


async def test_silent_costmap_stops_robot(robot, log):
    goal = GoalSender(robot, "DriveOnHeading", "drive_on_heading")
    await goal.send(target=get_message("geometry_msgs/msg/Point")(x=2.0), speed=0.02)
    robot.publishes_scans = False
    assert await goal.status_after(10.0) == GoalStatus.ABORTED
    assert robot.velocity == ZERO_VELOCITY
    assert any("the costmap is no longer published" in record.text for record in log)


async def test_wait_ends_or_is_canceled(robot):
    goal = GoalSender(robot, "Wait", "wait")
    await goal.send(time=Duration(seconds=2.0).to_msg())
    assert await goal.status_after(5.0) == GoalStatus.SUCCEEDED
    await goal.send(time=Duration(seconds=60.0).to_msg())
    await robot.run(1.0)
    goal.handle.cancel_goal_async()
    assert await goal.status_after(2.0) == GoalStatus.CANCELED


async def test_assisted_teleop_stops_before_wall(robot):
    robot.costmap.grid.cells[:, 70:] = LETHAL  # from x = 3.5 m on
    robot.pose = (2.5, 2.5, 0.0)
    await robot.run(0.5)
    teleop = robot.node.create_publisher("geometry_msgs/msg/Twist", "/cmd_vel_teleop", 10)
    goal = GoalSender(robot, "AssistedTeleop", "assisted_teleop")
    await goal.send(time_allowance=Duration(seconds=8.0).to_msg())
    twist = teleop.msg_type()
    twist.linear.x = 0.4
    for _ in range(70):
        teleop.publish(twist)
        await robot.run(0.1)
    assert 2.9 < robot.pose[0] < 3.31
    assert await goal.status_after(3.0) == GoalStatus.ABORTED
    assert robot.velocity == ZERO_VELOCITY


async def test_backup_target_beside_robot_is_rejected(robot):
    goal = GoalSender(robot, "BackUp", "backup")
    await goal.send(target=get_message("geometry_msgs/msg/Point")(x=0.3, y=0.1), speed=0.2)
    assert await goal.status_after(1.0) == GoalStatus.ABORTED


async def test_recoveries_server_of_foxy_has_three_behaviors(graph, clock, log):
    robot = CostmapRobot(graph, clock)
    robot.pose = (2.5, 2.5, 0.4)
    parameters = {
        "recovery_plugins": ["spin", "backup", "wait"],
        "spin.plugin": "nav2_recoveries/Spin",
        "backup.plugin": "nav2_recoveries/BackUp",
        "wait.plugin": "nav2_recoveries/Wait",
        "global_frame": "odom",
    }
    server = RecoveriesServer(graph, NodeOptions(parameters={"autostart_node": True, **parameters}))
    await robot.run(1.0)
    goal = GoalSender(robot, "Spin", "spin")
    await goal.send(target_yaw=pi / 2, time_allowance=Duration(seconds=10.0).to_msg())
    assert await goal.status_after(10.0) == GoalStatus.SUCCEEDED
    assert robot.pose[2] == pytest.approx(0.4 + pi / 2, abs=0.1)
    created = [record.text for record in log if "Creating recovery plugin" in record.text]
    assert created[1] == "Creating recovery plugin backup of type nav2_recoveries/BackUp"
    assert server.node.get_name() == "recoveries_server"
    server.close()


async def test_recoveries_server_refuses_behaviors_that_came_later(graph, log):
    parameters = {"recovery_plugins": ["drive"], "drive.plugin": "nav2_recoveries/DriveOnHeading"}
    server = RecoveriesServer(graph, NodeOptions(parameters={"autostart_node": True, **parameters}))
    await graph.settle()
    assert any("cannot be 'nav2_recoveries/DriveOnHeading'" in str(record.text) for record in log)
    server.close()
