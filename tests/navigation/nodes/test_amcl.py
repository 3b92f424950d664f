"""amcl in the house, in lock-step with the simulation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import atan2, cos, hypot, pi, sin
from typing import Any

import numpy as np
import pytest

from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import LogLevel, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import get_message, get_service
from linkwright.navigation.maps.map_files import load_map
from linkwright.navigation.nodes.amcl import Amcl
from linkwright.navigation.nodes.map_server import MapServer
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedSimulation
from tests.places import GAZEBO_PACKAGE, PACKAGE

HOUSE = GAZEBO_PACKAGE / "worlds" / "house.world"
MAP = GAZEBO_PACKAGE / "maps" / "house.yaml"
MBOT = PACKAGE / "urdf" / "mbot_gazebo.xacro"
POSE = "geometry_msgs/msg/PoseWithCovarianceStamped"
TOUR_POINTS = [
    (-2.0, 0.0),
    (-2.2, -2.4),
    (-0.2, -2.4),
    (0.4, -1.7),
    (2.4, -1.7),
    (3.2, -0.6),
    (2.2, -1.7),
    (0.4, -1.7),
    (0.0, 0.0),
]
"""A path through the living room into the kitchen, and back."""


class House:
    """mbot in the house, with a map server and amcl."""

    def __init__(self, test: SteppedSimulation, **parameters: object) -> None:
        self.test = test
        self.buffer = BufferCore()
        TransformListener(self.buffer, test.node)
        self.poses = test.record("/amcl_pose", get_message(POSE))
        common = {"use_sim_time": True, "autostart_node": True}
        self.server = MapServer(test.graph, NodeOptions(parameters={"yaml_filename": str(MAP), **common}))
        self.amcl = Amcl(test.graph, NodeOptions(parameters={**common, **parameters}))
        self.errors: list[float] = []
        test.advance(0.5)

    def close(self) -> None:
        self.amcl.close()
        self.server.close()

    def send_pose_estimate(self, x: float, y: float, yaw: float) -> None:
        """Publish a pose estimate, as RViz's tool does."""
        message = get_message(POSE)()
        message.header.frame_id = "map"
        message.pose.pose.position.x, message.pose.pose.position.y = x, y
        orientation = message.pose.pose.orientation
        orientation.x, orientation.y, orientation.z, orientation.w = quaternion_from_rpy((0.0, 0.0, yaw))
        covariance = np.zeros((6, 6))
        covariance[0, 0] = covariance[1, 1] = 0.25
        covariance[5, 5] = 0.0685
        message.pose.covariance = covariance.reshape(36)
        self.test.publish("/initialpose", message)
        self.test.settle()

    def error(self) -> tuple[float, float]:
        """Return the error of amcl's pose, in meters and radians."""
        true_pose = self.test.robot_pose()
        transform, _ = self.buffer.lookup("map", "base_footprint", 0)
        yaw_error = rpy_from_quaternion(transform[3:])[2] - rpy_from_quaternion(true_pose[3:])[2]
        return hypot(transform[0] - true_pose[0], transform[1] - true_pose[1]), abs(
            atan2(sin(yaw_error), cos(yaw_error))
        )

    def drive(self, corners: list[tuple[float, float]], speed: float = 0.5) -> None:
        """Drive from corner to corner by the robot's true pose."""
        test = self.test
        for x, y in corners:
            for _ in range(300):
                pose = test.robot_pose()
                distance = hypot(x - pose[0], y - pose[1])
                if distance < 0.12:
                    break
                bearing = (atan2(y - pose[1], x - pose[0]) - rpy_from_quaternion(pose[3:])[2] + pi) % (2 * pi) - pi
                forward_speed = min(speed, 1.5 * distance) * max(0.0, cos(bearing)) ** 3
                test.drive(forward_speed if abs(bearing) < 1.0 else 0.0, max(-1.0, min(1.0, 2.0 * bearing)))
                test.advance(0.1)
                try:
                    self.errors.append(self.error()[0])
                except TransformException:
                    continue
            else:
                raise AssertionError(f"stuck at {pose} on the way to {x}, {y}")
        test.drive(0.0)
        test.advance(0.5)

    def logged(self, level: LogLevel) -> list[str]:
        return [record.text for record in self.test.log if record.level is level and record.node.endswith("amcl")]


StartHouse = Callable[..., House]


@pytest.fixture
def start_house() -> Iterator[StartHouse]:
    running_nodes: list[Any] = []

    def start(pose: tuple[float, float, float] = (0.0, 0.0, 0.0), **parameters: object) -> House:
        spawn_pose = (pose[0], pose[1], 0, 0, 0, pose[2])
        test = SteppedSimulation(
            HOUSE, MBOT, arguments={"laser": "true"}, pose=spawn_pose, robot_state_publisher=True, seed=3
        )
        running_nodes.append(test.__enter__())
        house = House(running_nodes[0], **parameters)
        running_nodes.insert(0, house)
        return house

    yield start
    if running_nodes:
        running_nodes[0].close()
        running_nodes[1].__exit__(None, None, None)


def test_map_matches_house() -> None:
    grid = load_map(MAP)
    cells = grid.cells_of(np.array([(0.0, 0.0), (4.9, 2.0), (4.95, 2.0), (20.0, 0.0)]))
    assert grid.contains(cells).tolist() == [True, True, True, False]
    assert grid.cells[tuple(cells[0])] == 0
    assert 100 in (grid.cells[tuple(cells[1])], grid.cells[tuple(cells[2])])


def test_amcl_tracks_drive_through_house(start_house: StartHouse) -> None:
    house = start_house(set_initial_pose=True)
    house.drive(TOUR_POINTS)
    assert max(house.errors) < 0.2
    assert sum(house.errors) / len(house.errors) < 0.08
    assert house.error()[1] < 0.05
    assert house.logged(LogLevel.WARN) == house.logged(LogLevel.ERROR) == []


def test_wrong_pose_estimate_is_corrected_while_driving(start_house: StartHouse) -> None:
    house = start_house((-2.0, 0.0, 0.5))
    house.test.advance(1.0)
    with pytest.raises(TransformException):
        house.error()
    assert "Please set the initial pose" in house.logged(LogLevel.WARN)[0]
    house.send_pose_estimate(-1.6, 0.3, 0.2)  # wrong by 0.5 m and 0.3 rad
    house.test.advance(0.5)
    house.drive([(-2.2, -0.4), (-2.2, -2.0), (-0.2, -2.4)])
    distance, angle = house.error()
    assert distance < 0.1
    assert angle < 0.1
    covariance = np.asarray(house.poses.last.pose.covariance).reshape(6, 6)
    assert 0.0 < covariance[0, 0] < 0.2


def _call_service(house: House, service: str, kind: str = "std_srvs/srv/Empty", **fields: object) -> Any:
    return house.test.call(service, get_service(kind).Request(**fields))


def test_global_localization_finds_robot(start_house: StartHouse) -> None:
    house = start_house((-2.0, 0.0, 0.5), max_particles=5000)
    _call_service(house, "/reinitialize_global_localization")
    house.drive([(-2.2, -2.4), (-0.2, -2.4), (0.4, -1.7), (2.4, -1.7), (3.2, -0.6), (2.2, -1.7)])
    distance, angle = house.error()
    assert distance < 0.15
    assert angle < 0.1


def test_kidnapped_robot_is_relocalized(start_house: StartHouse) -> None:
    house = start_house(
        set_initial_pose=True,
        recovery_alpha_slow=0.001,
        recovery_alpha_fast=0.1,
        max_particles=5000,
    )
    house.drive([(-1.0, 0.0)])
    house.test.simulation.set_model_pose("mbot", (2.8, -1.7, 0.0, *quaternion_from_rpy((0.0, 0.0, 1.0))))
    house.test.advance(0.5)
    house.drive(
        [
            (3.2, -0.6),
            (2.2, -1.7),
            (0.4, -1.7),
            (-0.2, -2.4),
            (-2.2, -2.4),
            (-2.0, 0.0),
            (0.0, 0.0),
            (0.4, -1.7),
            (2.4, -1.7),
        ]
    )
    assert house.error()[0] < 0.15


def test_scans_that_do_not_match_map_are_reported(start_house: StartHouse) -> None:
    house = start_house((-2.0, 0.0, 0.0))
    house.send_pose_estimate(3.0, 2.0, 2.0)
    house.test.advance(0.5)
    house.drive([(-2.2, -0.4), (-2.2, -2.0), (-0.2, -2.4), (0.0, 0.0)])
    assert house.error()[0] > 0.5
    assert any("of the beams end near an obstacle of the map" in text for text in house.logged(LogLevel.WARN))


def test_wait_for_map_is_reported(start_house: StartHouse) -> None:
    house = start_house(map_topic="nowhere", set_initial_pose=True)
    assert house.logged(LogLevel.WARN) == ["Waiting for map.... No node publishes on '/nowhere'."]
    assert len(house.poses) == 0


def test_missing_transform_is_reported(start_house: StartHouse) -> None:
    house = start_house(odom_frame_id="odometry", set_initial_pose=True)
    house.test.advance(3.0)
    assert "Couldn't determine robot's pose associated with laser scan" in house.logged(LogLevel.ERROR)[0]
    assert "odometry" in house.logged(LogLevel.ERROR)[0]


def test_poses_particles_and_transforms_match_nav2(start_house: StartHouse) -> None:
    house = start_house(set_initial_pose=True, transform_tolerance=0.5)
    clouds = house.test.record("/particle_cloud", get_message("nav2_msgs/msg/ParticleCloud"))
    count = len(house.poses)
    house.test.advance(1.0)
    assert len(house.poses) == count  # the robot does not move
    _call_service(house, "/request_nomotion_update")
    house.test.advance(0.5)
    assert len(house.poses) == count + 1
    assert house.poses.last.header.frame_id == "map"
    assert 500 <= len(clouds.last.particles) <= 2000
    assert sum(particle.weight for particle in clouds.last.particles) == pytest.approx(1.0)
    assert clouds.last.header.frame_id == "map"
    _, stamp_ns = house.buffer.lookup("map", "odom", 0)
    now_ns = house.amcl.node.get_clock().now().nanoseconds
    assert 0.2e9 < stamp_ns - now_ns <= 0.5e9


def test_pose_estimates_in_wrong_frame_or_not_finite_are_rejected(start_house: StartHouse) -> None:
    house = start_house()
    request = get_service("nav2_msgs/srv/SetInitialPose").Request()
    for frame, x in (("", 1.0), ("odom", 1.0), ("map", float("nan")), ("map", 1.5)):
        request.pose.header.frame_id = frame
        request.pose.pose.pose.position.x = x
        house.test.call("/set_initial_pose", request)
    warnings = house.logged(LogLevel.WARN)
    assert sum("empty frame_id" in text for text in warnings) == 1
    assert sum('Ignoring initial pose in frame "odom"' in text for text in warnings) == 1
    assert house.logged(LogLevel.ERROR) == ["Received initial pose contains NaNs or Infs! Ignoring as invalid!"]
    house.test.advance(0.5)
    assert house.poses.last.pose.pose.position.x == pytest.approx(1.5, abs=0.2)


@pytest.mark.parametrize(
    ("name", "value"),
    [("laser_model_type", "likelihod_field"), ("max_beams", 0), ("min_particles", 9000), ("alpha1", -1.0)],
)
def test_invalid_parameters_are_rejected(start_house: StartHouse, name: str, value: object) -> None:
    house = start_house(**{name: value})
    assert any(f"parameter '{name}' of 'amcl' cannot be" in text for text in house.logged(LogLevel.ERROR))
    node: Any = house.amcl.node
    assert not node.is_active
