"""The nodes of slam_toolbox, with scans of known walls and a stepped clock."""

from __future__ import annotations

from math import inf, nan, pi
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import SENSOR_DATA_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.grids.grid import FREE, OCCUPIED
from linkwright.navigation.grids.occupancy import grid_from_message
from linkwright.navigation.maps.map_files import load_map
from linkwright.navigation.nodes.slam_toolbox.nodes import (
    AsyncSlamToolbox,
    LifelongSlamToolbox,
    LocalizationSlamToolbox,
    MapAndLocalizationSlamToolbox,
    SyncSlamToolbox,
)
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph
from tests.navigation.slam.scenes import add_drift, flat_walls, measure_ranges, path_along

FLAT_WALLS = flat_walls()
PATH = path_along([(-4, -3), (-1, -3), (3, -3)], step=0.25, turn=0.25)


class Robot:
    """A robot in the flat that publishes transforms and scans."""

    def __init__(self, test: SteppedGraph, mounting: tuple[float, ...] = (0, 0, 0.2, 0, 0, 0)) -> None:
        self.test = test
        self.mounting = mounting
        node = test.create_node("robot")
        self._static = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self._tf = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self.scans = node.create_publisher(get_message("sensor_msgs/msg/LaserScan"), "/scan", SENSOR_DATA_QOS)
        x, y, z, roll, pitch, yaw = mounting
        pose = (x, y, z, *quaternion_from_rpy((roll, pitch, yaw)))
        batch = TransformBatch(("base_footprint",), ("laser",), 0, np.array([pose]))
        self._static.publish(TFMessage(batch=batch))

    def publish_odometry(self, odometry: np.ndarray) -> None:
        pose = (odometry[0], odometry[1], 0.0, *quaternion_from_rpy((0.0, 0.0, float(odometry[2]))))
        stamp_ns = self.test.clock.now_ns()
        self.send(TransformBatch(("odom",), ("base_footprint",), stamp_ns, np.array([pose])))

    def send(self, batch: TransformBatch) -> None:
        self._tf.publish(TFMessage(batch=batch))

    def scan(self, pose: np.ndarray) -> Any:
        x, y, _, roll, _, yaw = self.mounting
        ranges, angles = measure_ranges(FLAT_WALLS, compose(pose, np.array((x, y, yaw))), 180)
        if roll:
            ranges = np.roll(ranges[::-1], 1)
        message = get_message("sensor_msgs/msg/LaserScan")()
        message.header.frame_id = "laser"
        message.header.stamp = Time.from_nanoseconds(self.test.clock.now_ns())
        message.angle_min, message.angle_max = float(angles[0]), float(angles[-1])
        message.angle_increment = float(angles[1] - angles[0])
        message.range_min, message.range_max = 0.05, 12.0
        message.ranges = ranges.astype(np.float32)
        return message

    def go(self, path: np.ndarray, odometry: np.ndarray, seconds: float = 0.5) -> None:
        """Publish the scan and the odometry at each pose of a path."""
        for pose, text in zip(path, odometry, strict=True):
            self.publish_odometry(text)
            self.scans.publish(self.scan(pose))
            self.test.advance(seconds)


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


@pytest.fixture(autouse=True)
def humble(monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)


def start_node(test: SteppedGraph, node_type: Any = AsyncSlamToolbox, **parameters: Any) -> Any:
    return node_type(test.graph, NodeOptions(parameters={"map_update_interval": 2.0, **parameters}))


def logged(test: SteppedGraph, level: str) -> list[str]:
    return [record.text for record in test.log if record.level.name == level]


def call_service(test: SteppedGraph, service: str, service_type: str, **fields: Any) -> Any:
    return test.call(f"/slam_toolbox/{service}", get_service(service_type).Request(**fields))


def planar_pose(transform: Any) -> np.ndarray:
    translation, rotation = transform.translation, transform.rotation
    return np.array(
        (translation.x, translation.y, rpy_from_quaternion((rotation.x, rotation.y, rotation.z, rotation.w))[2])
    )


def map_to_odom(tf: Any) -> Any:
    """Return the last transform that the node published."""
    transforms = [transform for message in tf for transform in message.transforms if transform.header.frame_id == "map"]
    assert transforms[-1].child_frame_id == "odom"
    return transforms[-1]


def is_map_of_walls(message: Any) -> bool:
    grid = grid_from_message(message)
    return bool((grid.cells == FREE).sum() > 2000 and (grid.cells == OCCUPIED).sum() > 100)


@pytest.mark.parametrize("kind", [AsyncSlamToolbox, SyncSlamToolbox, LifelongSlamToolbox])
def test_map_pose_and_transform_are_published_and_accurate(test, kind):
    start_node(test, kind)
    maps, sizes, poses, tf = (test.record(topic) for topic in ("/map", "/map_metadata", "/pose", "/tf"))
    robot, odometry = Robot(test), add_drift(relative_pose(PATH[0], PATH), 1.04, 0.05)
    robot.go(PATH, odometry)
    assert is_map_of_walls(maps.last)
    assert maps.last.header.frame_id == "map"
    assert maps.last.info.resolution == pytest.approx(0.05)
    assert sizes.last == maps.last.info
    true = relative_pose(PATH[0], PATH[-1])  # the origin of the map is at the first scan
    correction = map_to_odom(tf)
    assert compose(planar_pose(correction.transform), odometry[-1]) == pytest.approx(true, abs=0.03)
    # The stamp is ahead by the timeout.
    assert correction.header.stamp.nanoseconds == test.clock.now_ns() - 500_000_000 + 500_000_000
    publish_at = poses.last.pose.pose.position
    assert [publish_at.x, publish_at.y] == pytest.approx(true[:2], abs=0.3)
    covariance = np.reshape(poses.last.pose.covariance, (6, 6))
    assert 0 < covariance[0, 0] < 0.01
    assert 0 < covariance[5, 5] < 0.01


def test_laser_may_be_mounted_backward_and_upside_down(test):
    start_node(test)
    maps, tf = test.record("/map"), test.record("/tf")
    robot = Robot(test, (0.15, 0.0, 0.3, pi, 0.0, 2.0))
    odometry = add_drift(relative_pose(PATH[0], PATH), 1.04, 0.05)
    robot.go(PATH, odometry)
    assert compose(planar_pose(map_to_odom(tf).transform), odometry[-1]) == pytest.approx(
        relative_pose(PATH[0], PATH[-1]), abs=0.04
    )
    assert is_map_of_walls(maps.last)


def test_scans_without_valid_ranges_give_no_map(test):
    start_node(test)
    maps, tf, robot = test.record("/map"), test.record("/tf"), Robot(test)
    for number, value in enumerate((inf, nan, 0.0, inf, -1.0)):
        robot.publish_odometry(np.array((0.6 * number, 0.0, 0.0)))
        message = robot.scan(PATH[0])
        message.ranges = np.full(180, value, dtype=np.float32)
        robot.scans.publish(message)
        test.advance(1.0)
    assert len(maps) == 0
    assert planar_pose(map_to_odom(tf).transform) == pytest.approx([0, 0, 0], abs=1e-9)
    response = call_service(test, "save_map", "slam_toolbox/srv/SaveMap")
    assert response.result == response.RESULT_NO_MAP_RECEIEVD


def test_scans_without_transforms_are_dropped_with_warning(test):
    node = start_node(test)
    robot, maps = Robot(test), test.record("/map")
    for _ in range(8):
        robot.scans.publish(robot.scan(PATH[0]))
        test.advance(0.5)
    assert len(maps) == 0
    assert any("scans are dropped" in line and "odom" in line for line in logged(test, "WARN"))
    robot.go(PATH[:4], relative_pose(PATH[0], PATH[:4]))
    assert len(maps) > 0
    node.close()


def test_scan_waits_for_its_transform(test):
    start_node(test)
    robot, poses = Robot(test), test.record("/pose")
    robot.publish_odometry(np.zeros(3))
    test.advance(0.1)
    robot.scans.publish(robot.scan(PATH[0]))
    test.advance(0.05)
    assert len(poses) == 0
    robot.publish_odometry(np.zeros(3))
    test.advance(0.1)
    assert len(poses) == 1


def test_scans_are_dropped_unless_robot_moved(test):
    node = start_node(test)
    robot, poses = Robot(test), test.record("/pose")
    for number in range(200):
        robot.publish_odometry(np.array((0.005 * number, 0.0, 0.0)))
        robot.scans.publish(robot.scan(PATH[0] + np.array((0.005 * number, 0.0, 0.0))))
        test.advance(0.01)
    assert 3 <= len(poses) <= 4
    assert not node._work[0].queue


def test_throttled_scans_are_skipped(test):
    start_node(test, throttle_scans=3, minimum_travel_distance=0.1)
    robot, poses = Robot(test), test.record("/pose")
    robot.go(PATH[:9], relative_pose(PATH[0], PATH[:9]))
    assert len(poses) == 3


def test_measuring_can_be_paused(test):
    start_node(test)
    robot, poses = Robot(test), test.record("/pose")
    robot.go(PATH[:5], relative_pose(PATH[0], PATH[:5]))
    count = len(poses)
    assert call_service(test, "pause_new_measurements", "slam_toolbox/srv/Pause").status
    robot.go(PATH[5:12], relative_pose(PATH[0], PATH[5:12]))
    assert len(poses) == count
    assert call_service(test, "pause_new_measurements", "slam_toolbox/srv/Pause").status
    robot.go(PATH[12:16], relative_pose(PATH[0], PATH[12:16]))
    assert len(poses) > count


def test_map_is_saved_and_returned_by_services(test, tmp_path):
    start_node(test)
    robot, maps = Robot(test), test.record("/map")
    robot.go(PATH[:6], relative_pose(PATH[0], PATH[:6]))
    name = get_message("std_msgs/msg/String")(data=str(tmp_path / "flat"))
    response = call_service(test, "save_map", "slam_toolbox/srv/SaveMap", name=name)
    assert response.result == response.RESULT_SUCCESS
    dynamic_map = call_service(test, "dynamic_map", "nav_msgs/srv/GetMap").map
    test.advance(2.5)
    assert dynamic_map.info.width == maps.last.info.width
    saved_map = load_map(tmp_path / "flat.yaml")
    assert ((saved_map.cells == OCCUPIED) == (grid_from_message(dynamic_map).cells == OCCUPIED)).all()


def test_reset_service_starts_new_map(test):
    start_node(test)
    robot, tf = Robot(test), test.record("/tf")
    odometry = add_drift(relative_pose(PATH[0], PATH), 1.04, 0.05)
    robot.go(PATH[:16], odometry[:16])
    response = call_service(test, "reset", "slam_toolbox/srv/Reset", pause_new_measurements=True)
    assert response.result == response.RESULT_SUCCESS
    test.advance(0.2)
    assert planar_pose(map_to_odom(tf).transform) == pytest.approx([0, 0, 0], abs=1e-9)
    assert call_service(test, "dynamic_map", "nav_msgs/srv/GetMap").map.info.width == 0


def serialize_map(test: SteppedGraph, path: Path, node: Any) -> str:
    robot = Robot(test)
    robot.go(PATH, relative_pose(PATH[0], PATH))
    name = str(path / "flat")
    response = call_service(test, "serialize_map", "slam_toolbox/srv/SerializePoseGraph", filename=name)
    assert response.result == response.RESULT_SUCCESS
    node.close()
    return name


def test_robot_is_localized_in_saved_map(test, tmp_path):
    name = serialize_map(test, tmp_path, start_node(test))
    start_node(test, LocalizationSlamToolbox, map_file_name=name, map_start_pose=[1.9, 0.2, 0.1])
    maps, poses = test.record("/map"), test.record("/pose")
    test.advance(3.0)
    assert is_map_of_walls(maps.last)
    robot, return_path = Robot(test), path_along([(-2, -3), (0, -3), (2, -2.8)], step=0.25)
    robot.go(return_path, add_drift(relative_pose(return_path[0], return_path), 1.05, 0.03))
    expected_poses = [relative_pose(PATH[0], pose) for pose in return_path]
    publish_at = poses.last.pose.pose.position
    assert min(np.hypot(publish_at.x - pose[0], publish_at.y - pose[1]) for pose in expected_poses[-3:]) < 0.05
    initial = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")()
    initial.header.frame_id = "map"
    initial.pose.pose.position.x, initial.pose.pose.position.y = 4.6, 0.5
    initial.pose.pose.orientation.w = 1.0
    test.publish("/initialpose", initial)
    test.advance(0.1)
    pose = np.array((0.3, -3.0, 0.0))
    robot.go(pose[None], np.array([[20.0, 7.0, 2.0]]))  # the robot was carried away
    publish_at = poses.last.pose.pose.position
    assert [publish_at.x, publish_at.y] == pytest.approx(relative_pose(PATH[0], pose)[:2], abs=0.05)


def test_mapping_continues_in_saved_map(test, tmp_path):
    name = serialize_map(test, tmp_path, start_node(test))
    node = start_node(test, MapAndLocalizationSlamToolbox)
    request = get_service("slam_toolbox/srv/DeserializePoseGraph").Request
    pose = get_message("geometry_msgs/msg/Pose2D")(x=6.6, y=0.5, theta=0.2)
    assert call_service(
        test,
        "deserialize_map",
        "slam_toolbox/srv/DeserializePoseGraph",
        filename=name,
        match_type=request.START_AT_GIVEN_POSE,
        initial_pose=pose,
    )
    robot, poses = Robot(test), test.record("/pose")
    scan_count = len(node._work[0].mapper.scans)
    new_path = path_along([(3, -3), (4, -3), (4, 2)], step=0.25, turn=0.25)
    robot.go(new_path, add_drift(relative_pose(new_path[0], new_path), 1.02, 0.02))
    assert len(node._work[0].mapper.scans) > scan_count
    publish_at = poses.last.pose.pose.position
    assert [publish_at.x, publish_at.y] == pytest.approx(relative_pose(PATH[0], new_path[-1])[:2], abs=0.3)
    assert call_service(test, "set_localization_mode", "std_srvs/srv/SetBool", data=True).success
    count = len(node._work[0].mapper.scans)
    robot.go(new_path[::-1], relative_pose(new_path[0], new_path[::-1]))
    assert len(node._work[0].mapper.scans) == count


def test_invalid_pose_graph_file_is_rejected_with_reason(test, tmp_path):
    (tmp_path / "other.posegraph").write_bytes(b"22 serialization::archive 17 0 0")
    (tmp_path / "broken.posegraph").write_bytes(b"nothing of the kind")
    for name, reason in (
        ("other", "slam_toolbox wrote it"),
        ("broken", "it does not contain a pose graph"),
        ("none", "does not exist"),
    ):
        with pytest.raises(LinkwrightError) as error:
            start_node(test, LocalizationSlamToolbox, map_file_name=str(tmp_path / name), map_start_at_dock=True)
        assert error.value.diagnostics[0].code == "NAV501"
        assert reason in str(error.value)
    start_node(test)
    service_type = "slam_toolbox/srv/DeserializePoseGraph"
    call_service(test, "deserialize_map", service_type, filename=str(tmp_path / "none"), match_type=1)
    call_service(test, "deserialize_map", service_type, filename="x", match_type=3)
    call_service(test, "deserialize_map", service_type, filename="x")
    errors = logged(test, "ERROR")
    assert "does not exist" in errors[-3]
    assert "non-localization" in errors[-2]
    assert "match_type is not set" in errors[-1]


def test_localization_without_map_is_reported(test):
    start_node(test, LocalizationSlamToolbox)
    Robot(test).go(PATH[:3], relative_pose(PATH[0], PATH[:3]))
    assert any("map_file_name" in line for line in logged(test, "ERROR"))


def test_node_is_managed_in_jazzy(test, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    running = start_node(test)
    robot, maps = Robot(test), test.record("/map")
    robot.go(PATH[:3], relative_pose(PATH[0], PATH[:3]))
    assert len(maps) == 0
    running.node.trigger_configure()
    running.node.trigger_activate()
    robot.go(PATH[:3], relative_pose(PATH[0], PATH[:3]))
    assert len(maps) > 0
    running.node.trigger_deactivate()
    count = len(maps)
    robot.go(PATH[3:12], relative_pose(PATH[0], PATH[3:12]))
    assert len(maps) == count
    running.node.trigger_cleanup()
    running.node.trigger_configure()
    running.node.trigger_activate()
    robot.go(PATH[:3], relative_pose(PATH[0], PATH[:3]))
    assert len(maps) > count
    running.close()


def test_parameters_without_effect_and_misspelled_ones_are_reported(test):
    start_node(
        test, solver_plugin="solver_plugins::SpaSolver", ceres_loss_function="None", resolutoin=0.1, resolution=-1.0
    )
    assert any("solver_plugins::SpaSolver" in line for line in logged(test, "INFO"))
    warnings = logged(test, "WARN")
    assert any("resolutoin" in line for line in warnings)
    assert any("zero or negative" in line for line in warnings)
    assert not any("ceres" in line for line in (*warnings, *logged(test, "INFO")))


def test_pose_graph_markers_are_published(test):
    start_node(test)
    markers = test.record("/slam_toolbox/graph_visualization")
    Robot(test).go(PATH[:12], relative_pose(PATH[0], PATH[:12]))
    nodes, edges, removed = markers.last.markers
    assert len(edges.points) == 2 * (len(nodes.points) - 1) > 4
    assert removed.action == removed.DELETE


def test_map_restarts_when_time_jumps_back(test):
    clock = test.create_node("clock").create_publisher(get_message("rosgraph_msgs/msg/Clock"), "/clock", 10)
    node = start_node(test, use_sim_time=True)
    robot, poses = Robot(test), test.record("/pose")

    def publish_at(seconds: float, pose: np.ndarray) -> None:
        clock.publish(get_message("rosgraph_msgs/msg/Clock")(clock=Time.from_nanoseconds(round(seconds * 1e9))))
        test.settle()
        stamp = Time.from_nanoseconds(round(seconds * 1e9))
        batch = TransformBatch(
            ("odom",), ("base_footprint",), round(seconds * 1e9), np.array([(*pose[:2], 0, 0, 0, 0, 1)])
        )
        robot.send(batch)
        message = robot.scan(PATH[0] + pose)
        message.header.stamp = stamp
        robot.scans.publish(message)
        test.settle()

    for number in range(5):
        publish_at(100.0 + number, np.array((0.5 * number, 0.0, 0.0)))
    assert len(node._work[0].mapper.scans) == 5
    publish_at(1.0, np.zeros(3))
    publish_at(2.0, np.array((0.5, 0.0, 0.0)))
    assert any("Time has jumped back" in line for line in logged(test, "WARN"))
    assert len(node._work[0].mapper.scans) == 2
    assert poses.last.header.stamp.sec == 2


def test_clear_queue_service_empties_scan_queue(test):
    node = start_node(test, SyncSlamToolbox)
    robot = Robot(test)
    robot.go(PATH[:4], relative_pose(PATH[0], PATH[:4]))
    node._work[0].queue.append((None, np.zeros(3)))
    assert call_service(test, "clear_queue", "slam_toolbox/srv/ClearQueue").status
    assert not node._work[0].queue


def test_autostart_node_parameter_activates_node_in_jazzy(test, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    start_node(test, autostart_node=True)
    maps = test.record("/map")
    Robot(test).go(PATH[:3], relative_pose(PATH[0], PATH[:3]))
    assert len(maps) > 0
