"""controller_server: it follows paths, stops at the end, and reports why it fails."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import get_message
from linkwright.navigation.following.follower import ZERO_VELOCITY
from linkwright.navigation.nodes.controller_server import ControllerServer
from linkwright.nodes import NodeOptions
from tests.navigation.following.driving import path_through
from tests.navigation.nodes.robots import DrivingRobot, GoalSender, path_message

LOCAL = {
    "global_frame": "odom",
    "rolling_window": True,
    "width": 3,
    "height": 3,
    "resolution": 0.05,
    "robot_radius": 0.15,
    "update_frequency": 5.0,
    "publish_frequency": 2.0,
    "plugins": ["obstacle_layer", "inflation_layer"],
    "obstacle_layer.plugin": "nav2_costmap_2d::ObstacleLayer",
    "obstacle_layer.observation_sources": "scan",
    "obstacle_layer.scan.topic": "/scan",
    "obstacle_layer.scan.expected_update_rate": 0.5,
    "inflation_layer.plugin": "nav2_costmap_2d::InflationLayer",
    "inflation_layer.inflation_radius": 0.3,
}
PURE_PURSUIT = "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController"
DWB = {
    "FollowPath.plugin": "dwb_core::DWBLocalPlanner",
    "FollowPath.max_vel_x": 0.26,
    "FollowPath.max_vel_theta": 1.0,
    "FollowPath.acc_lim_x": 2.5,
    "FollowPath.acc_lim_theta": 3.2,
    "FollowPath.decel_lim_x": -2.5,
    "FollowPath.decel_lim_theta": -3.2,
    "FollowPath.critics": ["Oscillation"],
}
PATH = path_through((1.0, 1.0), (2.5, 1.0), (2.5, 2.0))


@pytest.fixture
async def start(graph, clock):
    """Return a function that starts the server with parameters.

    It returns the robot and the action client.
    """
    servers = []

    async def start(**parameters):
        robot = DrivingRobot(graph, clock)
        options = NodeOptions(parameters={"FollowPath.plugin": PURE_PURSUIT, "autostart_node": True, **parameters})
        for name, value in LOCAL.items():
            options.parameters_of_others.set("/local_costmap/local_costmap", name, value)
        server = ControllerServer(graph, options)
        servers.append(server)
        await robot.run(1.0)
        return robot, GoalSender(robot, "FollowPath", "follow_path"), server

    yield start
    for server in servers:
        server.close()


@pytest.mark.parametrize("parameters", [{}, DWB], ids=["pure pursuit", "dwb"])
async def test_path_is_followed_to_end(start, parameters):
    robot, goal, _ = await start(**parameters)
    await goal.send(path=path_message(PATH))
    assert await goal.status_after(60.0) == GoalStatus.SUCCEEDED
    assert robot.distance_to(2.5, 2.0) < 0.26
    assert abs(robot.pose[2] - pi / 2) < 0.26
    assert robot.velocity == ZERO_VELOCITY
    assert goal.feedback[0].distance_to_goal == pytest.approx(2.5, abs=0.15)
    assert max(feedback.speed for feedback in goal.feedback) > 0.15


async def test_canceling_stops_robot(start):
    robot, goal, _ = await start()
    await goal.send(path=path_message(PATH))
    await robot.run(2.0)
    assert robot.velocity.x > 0.0
    goal.handle.cancel_goal_async()
    assert await goal.status_after(2.0) == GoalStatus.CANCELED
    assert robot.velocity == ZERO_VELOCITY


async def test_new_path_preempts_running_path(start, log):
    robot, goal, _ = await start()
    await goal.send(path=path_message(PATH))
    await robot.run(2.0)
    second = GoalSender(robot, "FollowPath", "follow_path")
    await second.send(path=path_message(path_through((1.5, 1.0), (3.0, 1.0))))
    assert ZERO_VELOCITY not in robot.speeds[5:]
    assert await goal.status_after(1.0) == GoalStatus.ABORTED
    assert await second.status_after(30.0) == GoalStatus.SUCCEEDED
    assert robot.distance_to(3.0, 1.0) < 0.26
    beginnings = ["Received a goal, begin computing control effort.", "Passing new path to controller."]
    assert [record.text for record in log if record.text in beginnings] == beginnings


async def test_obstacle_on_path_stops_robot(start, log):
    robot, goal, _ = await start()
    await goal.send(path=path_message(path_through((1.0, 1.0), (4.5, 1.0))))
    robot.obstacles = tuple((degree % 360, 0.8) for degree in range(-20, 21))
    assert await goal.status_after(30.0) == GoalStatus.ABORTED
    assert robot.velocity == ZERO_VELOCITY
    assert any("there is an obstacle ahead" in record.text for record in log)


async def test_held_robot_fails_to_make_progress(start, log):
    robot, goal, _ = await start(**{"progress_checker.movement_time_allowance": 3.0})
    await goal.send(path=path_message(PATH))
    robot.is_blocked = True
    assert await goal.status_after(6.0) == GoalStatus.ABORTED
    assert any("Failed to make progress" in record.text for record in log)


async def test_lost_transforms_stop_robot(start, log):
    robot, goal, _ = await start()
    await goal.send(path=path_message(PATH))
    await robot.run(1.0)
    assert robot.velocity.x > 0.0
    robot.publishes_pose = False
    await robot.run(0.5)
    assert robot.velocity == ZERO_VELOCITY, "the robot waits"
    robot.publishes_pose = True
    await robot.run(1.0)
    assert robot.velocity.x > 0.0, "the robot continues"
    robot.publishes_pose = False
    assert await goal.status_after(5.0) == GoalStatus.ABORTED
    assert robot.velocity == ZERO_VELOCITY
    assert any("s old; the goal is aborted" in record.text for record in log)


async def test_silent_laser_stops_robot(start, log):
    robot, goal, _ = await start()
    await goal.send(path=path_message(path_through((1.0, 1.0), (4.5, 1.0))))
    await robot.run(0.5)
    assert robot.velocity.x > 0.0
    robot.publishes_scans = False
    await robot.run(1.5)
    assert robot.velocity == ZERO_VELOCITY
    assert await goal.status_after(10.0) == GoalStatus.ABORTED
    assert any("the costmap is not current" in record.text for record in log)


async def test_deactivation_stops_robot(start):
    robot, goal, server = await start()
    await goal.send(path=path_message(PATH))
    await robot.run(1.0)
    server.node.trigger_deactivate()
    await robot.run(0.1)
    assert robot.velocity == ZERO_VELOCITY
    assert await goal.status_after(1.0) == GoalStatus.ABORTED
    await goal.send(path=path_message(PATH))
    assert not goal.handle.accepted


async def test_speed_limit_is_respected(start):
    robot, goal, _ = await start()
    limit = get_message("nav2_msgs/msg/SpeedLimit")(percentage=True, speed_limit=20.0)
    publisher = robot.node.create_publisher(type(limit), "/speed_limit", 10)
    publisher.publish(limit)
    await goal.send(path=path_message(PATH))
    await robot.run(3.0)
    assert 0.05 < max(speed.x for speed in robot.speeds) <= 0.1 + 1e-9


async def test_empty_path_and_unknown_controller_are_rejected(start, log):
    _, goal, _ = await start()
    await goal.send(path=path_message([]))
    assert await goal.status_after(1.0) == GoalStatus.ABORTED
    await goal.send(path=path_message(PATH), controller_id="Fast")
    assert await goal.status_after(1.0) == GoalStatus.ABORTED
    texts = [record.text for record in log]
    assert "Path is empty." in texts
    assert "there is no controller 'Fast'; available: FollowPath" in texts


async def test_parameters_without_effect_are_reported(start, log):
    await start(**DWB)
    assert any("these parameters have no effect: critics" in record.text for record in log)
