"""collision_monitor: velocities are passed on, limited or stopped by the data of sensors."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LogLevel
from linkwright.graph.lifecycle.states import ACTIVE, UNCONFIGURED
from linkwright.messages import get_message
from linkwright.navigation.following.follower import ZERO_VELOCITY
from linkwright.navigation.nodes.collision_monitor import CollisionMonitor
from linkwright.nodes import NodeOptions
from tests.navigation.nodes.robots import DrivingRobot

STOP = {
    "polygons": ["stop"],
    "stop.type": "polygon",
    "stop.action_type": "stop",
    "stop.points": "[[0.6, 0.3], [0.6, -0.3], [0.0, -0.3], [0.0, 0.3]]",
    "stop.min_points": 1,
}
SCAN = {"observation_sources": ["scan"], "base_frame_id": "base_link", "autostart_node": True}


class CommandedRobot(DrivingRobot):
    """A fake robot that is commanded to drive forward ten times a second."""

    def __init__(self, graph, clock):
        super().__init__(graph, clock)
        self.commanded_speed = 0.4
        self.wall = None
        self._driver = self.node.create_publisher("geometry_msgs/msg/Twist", "/cmd_vel_smoothed", 10)
        self.node.create_timer(0.1, self._drive)

    def publish_scan(self, *ranges):
        """Publish a scan, with the wall ahead if there is one."""
        super().publish_scan(*ranges, *([] if self.wall is None else [(0, self.wall - self.pose[0])]))

    def _drive(self):
        message = self._driver.msg_type()
        message.linear.x = self.commanded_speed
        self._driver.publish(message)


@pytest.fixture
def robot(graph, clock):
    return CommandedRobot(graph, clock)


@pytest.fixture
def start_monitor(graph, robot):
    monitors = []

    def make(**parameters):
        monitors.append(CollisionMonitor(graph, NodeOptions(parameters={**SCAN, **parameters})))
        return monitors[-1].node

    yield make
    for start_monitor in monitors:
        start_monitor.close()


async def test_velocity_passes_in_free_space(robot, start_monitor):
    start_monitor(**STOP)
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)


async def test_robot_stops_for_obstacle_in_zone_and_resumes(robot, start_monitor, log):
    node = start_monitor(**STOP, state_topic="state")
    states = []
    robot.node.create_subscription("nav2_msgs/msg/CollisionMonitorState", "state", states.append, 10)
    await robot.run(1.0)
    robot.obstacles = ((0, 0.5),)
    await robot.run(1.0)
    assert robot.velocity == ZERO_VELOCITY
    robot.obstacles = ()
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)
    assert [(state.action_type, state.polygon_name) for state in states[-2:]] == [(1, "stop"), (0, "")]
    assert any(record.text == "Robot to stop due to stop" for record in log)
    assert node.lifecycle_state == ACTIVE


async def test_publishing_ends_after_stop_pub_timeout(robot, start_monitor):
    start_monitor(**STOP, stop_pub_timeout=1.0)
    robot.obstacles = ((0, 0.5),)
    await robot.run(3.0)
    robot.speeds.clear()
    await robot.run(1.0)
    assert robot.speeds == []


async def test_silent_sensor_stops_robot(robot, start_monitor):
    start_monitor(**STOP, source_timeout=1.0)
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)
    robot.publishes_scans = False
    await robot.run(2.0)
    assert robot.velocity == ZERO_VELOCITY


async def test_sensor_with_zero_timeout_may_be_silent(robot, start_monitor):
    start_monitor(**STOP, **{"scan.source_timeout": 0.0})
    robot.publishes_scans = False
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)


async def test_slowdown_zone_reduces_velocity(robot, start_monitor):
    start_monitor(**{**STOP, "stop.action_type": "slowdown", "stop.slowdown_ratio": 0.3})
    robot.obstacles = ((0, 0.5),)
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.12)


async def test_points_and_max_points_of_humble_are_read(robot, start_monitor):
    humble = {**STOP, "stop.points": [0.6, 0.3, 0.6, -0.3, 0.0, -0.3, 0.0, 0.3], "stop.max_points": 1}
    start_monitor(**humble)
    robot.obstacles = ((0, 0.5),)
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)  # one point is allowed
    robot.obstacles = ((0, 0.5), (1, 0.5))
    await robot.run(1.0)
    assert robot.velocity == ZERO_VELOCITY


async def test_old_observations_stay_fixed_in_odometry_frame(robot, start_monitor):
    start_monitor(**STOP)
    robot.obstacles = ((0, 0.9),)
    await robot.run(0.5)
    assert robot.velocity.x == pytest.approx(0.4)
    robot.publishes_scans = False  # for less than the timeout
    robot.publish_pose(x=robot.pose[0] + 0.35)
    await robot.run(0.5)
    assert robot.velocity == ZERO_VELOCITY


async def test_approach_with_costmap_footprint_slows_down_before_wall(robot, start_monitor):
    polygon, point = get_message("geometry_msgs/msg/PolygonStamped"), get_message("geometry_msgs/msg/Point32")
    footprints = robot.node.create_publisher(polygon, "/local_costmap/published_footprint", 10)

    def publish_reading():
        x, y, _ = robot.pose
        corners = [(x + a, y + b) for a, b in ((0.2, 0.2), (0.2, -0.2), (-0.2, -0.2), (-0.2, 0.2))]
        message = polygon()
        message.header.frame_id, message.header.stamp = "odom", robot.stamp()
        message.polygon.points = [point(x=float(a), y=float(b)) for a, b in corners]
        footprints.publish(message)

    robot.node.create_timer(0.1, publish_reading)
    approach = {"polygons": ["body"], "body.type": "polygon", "body.action_type": "approach", "body.min_points": 1}
    start_monitor(**approach, **{"body.time_before_collision": 2.0})
    robot.wall = robot.pose[0] + 1.5
    await robot.run(8.0)
    assert 0.2 < robot.wall - robot.pose[0] < 0.45
    speeds = [speed.x for speed in robot.speeds if speed.x > 0]
    assert speeds[0] == pytest.approx(0.4)
    assert 0 < speeds[-1] < 0.2


async def test_velocity_polygon_follows_speed(robot, start_monitor):
    zone = {
        "polygons": ["v"],
        "v.type": "velocity_polygon",
        "v.action_type": "stop",
        "v.min_points": 1,
        "v.velocity_polygons": ["fast", "slow"],
    }
    for name, size, lowest, highest in (("fast", 1.0, 0.3, 1.0), ("slow", 0.4, -1.0, 0.3)):
        zone[f"v.{name}.points"] = f"[[{size}, 0.3], [{size}, -0.3], [0.0, -0.3], [0.0, 0.3]]"
        zone |= {f"v.{name}.linear_min": lowest, f"v.{name}.linear_max": highest}
        zone |= {f"v.{name}.theta_min": -1.0, f"v.{name}.theta_max": 1.0}
    start_monitor(**zone)
    robot.obstacles = ((0, 0.7),)
    await robot.run(1.0)
    assert robot.velocity == ZERO_VELOCITY
    robot.commanded_speed = 0.2
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.2)


async def test_zone_can_be_disabled_by_parameter(robot, start_monitor):
    node = start_monitor(**STOP)
    robot.obstacles = ((0, 0.5),)
    await robot.run(1.0)
    assert robot.velocity == ZERO_VELOCITY
    node.set_parameters([type(node.get_parameter("stop.enabled"))("stop.enabled", value=False)])
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)


async def test_point_cloud_is_filtered_by_height(robot, start_monitor):
    cloud, field = get_message("sensor_msgs/msg/PointCloud2"), get_message("sensor_msgs/msg/PointField")
    clouds = robot.node.create_publisher(cloud, "/points", 5)
    height = [0.01]

    def publish_reading():
        points = np.array([[0.5, 0.0, height[0]], [np.nan, 0.0, 0.2]], np.float32)
        message = cloud(height=1, width=2, point_step=12, row_step=24, data=points.tobytes())
        message.fields = [field(name=name, offset=4 * i, datatype=7, count=1) for i, name in enumerate("xyz")]
        message.header.frame_id, message.header.stamp = "base_link", robot.stamp()
        clouds.publish(message)

    robot.node.create_timer(0.1, publish_reading)
    start_monitor(**STOP, **{"scan.type": "pointcloud", "scan.topic": "points"})
    await robot.run(1.0)
    assert robot.velocity.x == pytest.approx(0.4)
    height[0] = 0.2
    await robot.run(1.0)
    assert robot.velocity == ZERO_VELOCITY


@pytest.mark.parametrize(("distance", "passes"), [(0.5, False), (2.0, True), (9.0, True)])
async def test_range_message_is_arc_of_points(robot, start_monitor, distance, passes):
    message_type = get_message("sensor_msgs/msg/Range")
    ranges = robot.node.create_publisher(message_type, "/sonar", 5)

    def publish_reading():
        message = message_type(field_of_view=0.5, min_range=0.1, max_range=4.0, range=distance)
        message.header.frame_id, message.header.stamp = "base_link", robot.stamp()
        ranges.publish(message)

    robot.node.create_timer(0.1, publish_reading)
    start_monitor(**STOP, **{"scan.type": "range", "scan.topic": "sonar"})
    await robot.run(1.0)
    assert (robot.velocity != ZERO_VELOCITY) is passes


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("stop.action_type", "halt"),
        ("stop.type", "triangle"),
        ("stop.points", "[[0, 0]]"),
        ("stop.points", ""),
        ("scan.type", "sonar"),
    ],
)
async def test_invalid_parameter_is_reported_and_node_stays_unconfigured(robot, start_monitor, log, name, value):
    node = start_monitor(**{**STOP, name: value})
    await robot.run(0.5)
    assert node.lifecycle_state == UNCONFIGURED
    errors = [record.text for record in log if record.level == LogLevel.ERROR]
    assert any("NODE433" in error and name in error for error in errors)
    assert robot.speeds == []


def test_topic_name_of_wrong_type_is_an_error(graph):
    with pytest.raises(LinkwrightError):
        CollisionMonitor(graph, NodeOptions(parameters={**SCAN, "cmd_vel_out_topic": 5}))
