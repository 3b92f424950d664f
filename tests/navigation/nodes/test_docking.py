"""The docking server: approaches, detection, charging, retries and undocking, with a robot that drives."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest

from linkwright.graph import ActionServer
from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import get_action, get_message, get_service
from linkwright.navigation.following.follower import ZERO_VELOCITY
from linkwright.navigation.following.smooth_control import SmoothControl
from linkwright.navigation.nodes.docking.server import DockingServer
from linkwright.nodes import NodeOptions
from tests.navigation.nodes.robots import DrivingRobot, GoalSender, pose_stamped

DOCK = (3.0, 1.0, 0.0)
PARAMETERS = {
    "autostart_node": True,
    "dock_plugins": ["charger"],
    "charger.plugin": "opennav_docking::SimpleChargingDock",
    "charger.use_battery_status": False,
    "docks": ["home"],
    "home.type": "charger",
    "home.frame": "map",
    "home.pose": list(DOCK),
}


class DockedRobot(DrivingRobot):
    """A robot with a battery, a navigator that jumps to its goals, and a docking server."""

    def __init__(self, graph, clock):
        super().__init__(graph, clock)
        self._battery = self.node.create_publisher("sensor_msgs/msg/BatteryState", "/battery_state", 10)
        self._detection = self.node.create_publisher("geometry_msgs/msg/PoseStamped", "/detected_dock_pose", 10)
        self.navigated, self.server = [], None
        ActionServer(self.node, "nav2_msgs/action/NavigateToPose", "navigate_to_pose", self._navigate)

    def _navigate(self, goal):
        pose = goal.request.pose
        yaw = 2 * np.arctan2(pose.pose.orientation.z, pose.pose.orientation.w)
        self.pose = (pose.pose.position.x, pose.pose.position.y, float(yaw))
        self.navigated.append(pose.header.frame_id)
        self.publish_pose()
        goal.succeed()
        return get_action("nav2_msgs/action/NavigateToPose").Result()

    def charge(self, current):
        self._battery.publish(get_message("sensor_msgs/msg/BatteryState")(current=current))

    def detect(self, x, y, yaw):
        """Publish the pose of a marker on the dock, whose z axis points at the robot."""
        message = pose_stamped(x, y, yaw)
        message.header.stamp = self.stamp()
        self._detection.publish(message)

    async def start(self, **parameters):
        self.server = DockingServer(self.graph, NodeOptions(parameters={**PARAMETERS, **parameters}))
        await self.run(0.5)


@pytest.fixture(autouse=True)
def jazzy(monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")


@pytest.fixture
async def robot(graph, clock):
    robot = DockedRobot(graph, clock)
    robot.pose = (1.0, 1.2, 0.3)
    yield robot
    if robot.server is not None:
        robot.server.close()


def logged_texts(log, level):
    return [record.text for record in log if record.level.name == level]


async def dock(robot, seconds=30.0, **fields):
    goal = GoalSender(robot, "DockRobot", "dock_robot")
    await goal.send(**{"dock_id": "home", **fields})
    return goal, await goal.status_after(seconds)


async def test_robot_is_staged_docks_and_undocks(robot):
    await robot.start()
    goal, status = await dock(robot)
    assert status == GoalStatus.SUCCEEDED
    assert (goal.answer.result.success, goal.answer.result.num_retries, goal.answer.result.error_code) == (True, 0, 0)
    assert robot.navigated == ["map"]
    assert robot.distance_to(*DOCK[:2]) < 0.06
    assert abs(robot.pose[2]) < 0.1
    assert robot.velocity == ZERO_VELOCITY
    assert {message.state for message in goal.feedback} >= {1, 3}
    assert max(speed.x for speed in robot.speeds) <= 0.25
    undock = GoalSender(robot, "UndockRobot", "undock_robot")
    await undock.send()
    assert await undock.status_after(20.0) == GoalStatus.SUCCEEDED
    assert robot.pose[0] == pytest.approx(DOCK[0] - 0.7, abs=0.12)
    assert min(speed.x for speed in robot.speeds) < 0.0
    assert robot.velocity == ZERO_VELOCITY


async def test_robot_near_the_dock_needs_no_navigation(robot):
    robot.pose = (2.2, 1.05, 0.1)
    await robot.start()
    _, status = await dock(robot)
    assert status == GoalStatus.SUCCEEDED
    assert not robot.navigated


async def test_dock_can_be_given_as_a_pose_and_approached_backward(robot):
    robot.pose = (2.0, 2.0, -pi / 2)
    await robot.start(dock_backwards=True)
    pose = pose_stamped(2.0, 2.8, pi / 2)
    _, status = await dock(robot, use_dock_id=False, dock_pose=pose, navigate_to_staging_pose=False)
    assert status == GoalStatus.SUCCEEDED
    assert robot.distance_to(2.0, 2.8) < 0.06
    assert min(speed.x for speed in robot.speeds) < 0.0 <= robot.velocity.x


async def test_charge_ends_docking_and_its_absence_is_retried(robot, log):
    await robot.start(**{"charger.use_battery_status": True, "max_retries": 1, "wait_charge_timeout": 1.0})
    goal, status = await dock(robot, 60.0)
    assert status == GoalStatus.ABORTED
    result = goal.answer.result
    assert (result.success, result.error_code, result.num_retries) == (False, 906, 1)
    assert "Timed out waiting for charge" in result.error_msg
    assert sum("will retry" in text for text in logged_texts(log, "WARN")) == 1
    robot.charge(2.0)
    goal, status = await dock(robot)
    assert (status, goal.answer.result.success) == (GoalStatus.SUCCEEDED, True)
    undock = GoalSender(robot, "UndockRobot", "undock_robot")
    await undock.send()
    assert await undock.status_after(20.0) == GoalStatus.ABORTED  # the charge goes on
    assert undock.answer.result.error_code == 905


async def test_detected_poses_move_the_dock(robot):
    await robot.start(
        **{
            "charger.use_external_detection_pose": True,
            "charger.external_detection_translation_x": -0.2,
            "charger.external_detection_rotation_pitch": 0.0,
            "charger.external_detection_rotation_roll": 0.0,
            "charger.filter_coef": 1.0,
        }
    )
    robot.node.create_timer(0.1, lambda: robot.detect(3.3, 1.1, 0.0))
    goal, status = await dock(robot)
    assert status == GoalStatus.SUCCEEDED
    assert robot.distance_to(3.1, 1.1) < 0.06
    assert goal.answer.result.num_retries == 0


async def test_undetected_dock_fails(robot):
    await robot.start(**{"charger.use_external_detection_pose": True, "initial_perception_timeout": 1.0})
    goal, status = await dock(robot)
    assert (status, goal.answer.result.error_code) == (GoalStatus.ABORTED, 904)


async def test_blocked_robot_gives_up(robot):
    await robot.start(dock_approach_timeout=1.0, max_retries=0)
    robot.is_blocked = True
    goal, status = await dock(robot, navigate_to_staging_pose=False)
    assert (status, goal.answer.result.error_code) == (GoalStatus.ABORTED, 905)
    assert robot.velocity == ZERO_VELOCITY


@pytest.mark.parametrize(
    ("fields", "code"),
    [
        ({"dock_id": "office"}, 901),
        ({"use_dock_id": False, "dock_pose": pose_stamped(1, 1), "dock_type": "pad"}, 902),
    ],
)
async def test_unknown_docks_are_refused(robot, fields, code):
    await robot.start()
    goal, status = await dock(robot, **fields)
    assert (status, goal.answer.result.error_code) == (GoalStatus.ABORTED, code)


async def test_canceled_docking_stops_the_robot(robot):
    await robot.start()
    goal = GoalSender(robot, "DockRobot", "dock_robot")
    await goal.send(dock_id="home", navigate_to_staging_pose=False)
    await robot.run(1.0)
    assert robot.velocity != ZERO_VELOCITY
    goal.handle.cancel_goal_async()
    assert await goal.status_after(2.0) == GoalStatus.CANCELED
    assert robot.velocity == ZERO_VELOCITY


async def test_dock_without_charge_is_reached(robot):
    await robot.start(**{"charger.plugin": "opennav_docking::SimpleNonChargingDock"})
    _, status = await dock(robot)
    assert status == GoalStatus.SUCCEEDED


async def test_docks_are_read_from_a_file(robot, tmp_path):
    path = tmp_path / "docks.yaml"
    path.write_text("docks:\n  desk:\n    type: charger\n    pose: [2.0, 2.0, 1.57]\n")
    await robot.start()
    service = get_service("nav2_msgs/srv/ReloadDockDatabase")
    client = robot.node.create_client(service, "/docking_server/reload_database")
    for name, succeeded in ((path, True), (tmp_path / "missing.yaml", False)):
        answer = client.call_async(service.Request(filepath=str(name)))
        await robot.run(0.2)
        assert answer.result().success is succeeded
    _, status = await dock(robot, dock_id="desk")
    assert status == GoalStatus.SUCCEEDED
    assert robot.distance_to(2.0, 2.0) < 0.06


@pytest.mark.parametrize(
    ("changes", "text"),
    [
        ({"home.pose": [1.0, 2.0]}, "must be [x, y, yaw]"),
        ({"home.type": ""}, "the dock 'home' has no type"),
        ({"dock_plugins": []}, "lists no plugin"),
        ({"charger.plugin": "mine::Dock"}, "SimpleChargingDock"),
        ({"dock_database": "/no/such/file.yaml"}, "cannot be read"),
    ],
)
async def test_invalid_docks_keep_the_server_unconfigured(robot, log, changes, text):
    await robot.start(**changes)
    assert any(text in line for line in logged_texts(log, "ERROR"))
    goal = GoalSender(robot, "DockRobot", "dock_robot")
    await goal.send(dock_id="home")
    assert goal.handle is None or not goal.handle.accepted


@pytest.mark.parametrize("start", [(-1.0, 0.3, 0.0), (-0.8, -0.4, 0.5), (-1.2, 0.0, -0.6)])
@pytest.mark.parametrize("backward", [False, True])
def test_control_law_ends_at_the_pose(start, backward):
    control, sign = SmoothControl(), -1.0 if backward else 1.0
    x, y, yaw = sign * start[0], start[1], sign * start[2]
    for _ in range(1000):
        cos, sin = np.cos(yaw), np.sin(yaw)
        target = (-cos * x - sin * y, sin * x - cos * y, -yaw)
        if np.hypot(x, y) < 0.03:
            break
        speed, rotation = control.find_velocity(target, backward=backward)
        assert 0.0 < sign * speed <= 0.25
        assert abs(rotation) <= 0.75
        yaw += rotation * 0.02
        x, y = x + speed * np.cos(yaw) * 0.02, y + speed * np.sin(yaw) * 0.02
    assert np.hypot(x, y) < 0.03
    assert abs(yaw) < 0.15
