"""The nodes of cartographer_ros, with scans of known walls and a stepped clock."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import SENSOR_DATA_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS
from linkwright.messages import TFMessage, Time, TransformBatch, get_message, get_service
from linkwright.navigation.grids.grid import FREE, OCCUPIED
from linkwright.navigation.grids.occupancy import grid_from_message
from linkwright.navigation.nodes.cartographer.nodes import CartographerNode
from linkwright.navigation.nodes.cartographer.occupancy_grid import OccupancyGridNode
from linkwright.navigation.slam.poses import compose, relative_pose
from linkwright.nodes import NodeOptions
from linkwright.testing import SteppedGraph
from tests.navigation.slam.scenes import add_drift, flat_walls, measure_ranges, path_along

FLAT_WALLS = flat_walls()
PATH = path_along([(-4, -3), (-1, -3), (3, -3)], step=0.1, turn=0.1)
LASER_HEIGHT_M, IMU_HEIGHT_M = 0.2, 0.1
CONFIGURATION = """
include "map_builder.lua"
include "trajectory_builder.lua"

options = {
  map_builder = MAP_BUILDER,
  trajectory_builder = TRAJECTORY_BUILDER,
  map_frame = "map",
  tracking_frame = "base_footprint",
  published_frame = "base_footprint",
  odom_frame = "odom",
  provide_odom_frame = true,
  publish_frame_projected_to_2d = true,
  use_odometry = false,
  use_nav_sat = false,
  use_landmarks = false,
  num_laser_scans = 1,
  num_multi_echo_laser_scans = 0,
  num_subdivisions_per_laser_scan = 1,
  num_point_clouds = 0,
  lookup_transform_timeout_sec = 0.2,
  submap_publish_period_sec = 0.3,
  pose_publish_period_sec = 5e-3,
  trajectory_publish_period_sec = 30e-3,
  rangefinder_sampling_ratio = 1.,
  odometry_sampling_ratio = 1.,
  fixed_frame_pose_sampling_ratio = 1.,
  imu_sampling_ratio = 1.,
  landmarks_sampling_ratio = 1.,
}

MAP_BUILDER.use_trajectory_builder_2d = true
TRAJECTORY_BUILDER_2D.use_imu_data = false
"""
WITH_ODOMETRY = """
options.published_frame = "odom"
options.provide_odom_frame = false
options.use_odometry = true
"""


class Robot:
    """A robot in the flat that publishes transforms, odometry, rates of rotation and scans."""

    def __init__(self, test: SteppedGraph) -> None:
        self.test = test
        node = test.create_node("robot")
        static = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self._tf = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._publishers = {
            topic: node.create_publisher(get_message(message), topic, SENSOR_DATA_QOS)
            for topic, message in (
                ("scan", "sensor_msgs/msg/LaserScan"),
                ("points2", "sensor_msgs/msg/PointCloud2"),
                ("imu", "sensor_msgs/msg/Imu"),
                ("odom", "nav_msgs/msg/Odometry"),
            )
        }
        mountings = ((0.1, 0.0, LASER_HEIGHT_M, 0.0, 0.0, 0.0, 1.0), (0.0, 0.0, IMU_HEIGHT_M, 0.0, 0.0, 0.0, 1.0))
        frames = ("base_footprint",) * 2, ("laser", "imu_link")
        static.publish(TFMessage(batch=TransformBatch(*frames, 0, np.array(mountings))))

    def stamp(self) -> Any:
        return Time.from_nanoseconds(self.test.clock.now_ns())

    def publish_odometry(self, odometry: np.ndarray) -> None:
        quaternion = quaternion_from_rpy((0.0, 0.0, float(odometry[2])))
        pose = (odometry[0], odometry[1], 0.0, *quaternion)
        now_ns = self.test.clock.now_ns()
        self._tf.publish(TFMessage(batch=TransformBatch(("odom",), ("base_footprint",), now_ns, np.array([pose]))))
        message = get_message("nav_msgs/msg/Odometry")()
        message.header.stamp, message.header.frame_id, message.child_frame_id = self.stamp(), "odom", "base_footprint"
        message.pose.pose.position.x, message.pose.pose.position.y = float(odometry[0]), float(odometry[1])
        message.pose.pose.orientation.z, message.pose.pose.orientation.w = quaternion[2:]
        self._publishers["odom"].publish(message)

    def publish_scan(self, pose: np.ndarray, stamp: Any = None) -> None:
        ranges, angles = measure_ranges(FLAT_WALLS, compose(pose, np.array((0.1, 0.0, 0.0))), 240)
        message = get_message("sensor_msgs/msg/LaserScan")()
        message.header.frame_id, message.header.stamp = "laser", stamp or self.stamp()
        message.angle_min, message.angle_max = float(angles[0]), float(angles[-1])
        message.angle_increment = float(angles[1] - angles[0])
        message.range_min, message.range_max = 0.05, 12.0
        message.ranges = ranges.astype(np.float32)
        self._publishers["scan"].publish(message)

    def publish_cloud(self, pose: np.ndarray) -> None:
        """Publish points of the walls at several heights, with the floor and the ceiling."""
        ranges, angles = measure_ranges(FLAT_WALLS, compose(pose, np.array((0.1, 0.0, 0.0))), 240)
        walls = np.stack((ranges * np.cos(angles), ranges * np.sin(angles), 0 * angles), axis=1)[np.isfinite(ranges)]
        layers = [walls + np.array((0, 0, height)) for height in (0.0, 0.3, 0.6)]
        floor = np.random.default_rng(1).uniform(-3, 3, (500, 3)) * (1, 1, 0)
        points = np.concatenate([*layers, floor - np.array((0, 0, LASER_HEIGHT_M)), floor + np.array((0, 0, 2.3))])
        message = get_message("sensor_msgs/msg/PointCloud2")()
        message.header.frame_id, message.header.stamp = "laser", self.stamp()
        field = get_message("sensor_msgs/msg/PointField")
        message.fields = [field(name=name, offset=4 * i, datatype=7, count=1) for i, name in enumerate("xyz")]
        message.height, message.width = 1, len(points)
        message.point_step, message.row_step = 12, 12 * len(points)
        message.data = np.frombuffer(points.astype("<f4").tobytes(), np.uint8)
        self._publishers["points2"].publish(message)

    def publish_rotation(self, rate: float) -> None:
        message = get_message("sensor_msgs/msg/Imu")()
        message.header.frame_id, message.header.stamp = "imu_link", self.stamp()
        message.angular_velocity.z = rate
        self._publishers["imu"].publish(message)

    def go(self, path: np.ndarray, odometry: np.ndarray | None = None, *, cloud: bool = False) -> None:
        """Publish the scan, and the odometry if there is any, at each pose of a path, and stand at the last one."""
        for index in (*range(len(path)), *[len(path) - 1] * 2):
            pose = path[index]
            if odometry is not None:
                self.publish_odometry(odometry[index])
            (self.publish_cloud if cloud else self.publish_scan)(pose)
            self.test.advance(0.2)


@pytest.fixture
def test():
    with SteppedGraph() as graph:
        yield graph


@pytest.fixture
def start(test, tmp_path):
    """Return a function that starts a node with a configuration, and its arguments."""

    def start_node(changes: str = "", *flags: str, **options: Any) -> CartographerNode:
        path = tmp_path / "robot.lua"
        path.write_text(f"{CONFIGURATION}\n{changes}\nreturn options\n")
        arguments = ["-configuration_directory", str(tmp_path), "-configuration_basename", path.name, *flags]
        return CartographerNode(test.graph, NodeOptions(arguments=arguments, **options))

    return start_node


def logged(test: SteppedGraph, level: str) -> list[str]:
    return [record.text for record in test.log if record.level.name == level]


def call(test: SteppedGraph, service: str, name: str, **fields: Any) -> Any:
    return test.call(f"/{service}", get_service(f"cartographer_ros_msgs/srv/{name}").Request(**fields))


def planar_pose(transform: Any) -> np.ndarray:
    translation, rotation = transform.translation, transform.rotation
    return np.array(
        (translation.x, translation.y, rpy_from_quaternion((rotation.x, rotation.y, rotation.z, rotation.w))[2])
    )


def find_last(tf: Any, parent: str, child: str) -> Any:
    frames = (parent, child)
    return [
        transform
        for message in tf
        for transform in message.transforms
        if (transform.header.frame_id, transform.child_frame_id) == frames
    ][-1]


def error_of(start: Any, changes: str) -> Any:
    with pytest.raises(LinkwrightError) as error:
        start(changes)
    return error.value.diagnostics[0]


def assert_is_map_of_walls(message: Any, start_pose: np.ndarray) -> None:
    """Assert that the occupied cells are on the walls, for a map that starts at a pose in the flat."""
    grid = grid_from_message(message)
    assert (grid.cells == FREE).sum() > 2000
    occupied = np.argwhere(grid.cells == OCCUPIED)
    assert len(occupied) > 100
    centers = grid.centers_of(occupied)
    points = compose(start_pose, np.concatenate((centers, np.zeros((len(centers), 1))), axis=1))[:, :2]
    starts, directions = FLAT_WALLS[:, 0], FLAT_WALLS[:, 1] - FLAT_WALLS[:, 0]
    offsets = points[:, None] - starts
    share = np.clip((offsets * directions).sum(axis=2) / (directions**2).sum(axis=1), 0, 1)
    distances = np.linalg.norm(offsets - share[..., None] * directions, axis=2).min(axis=1)
    assert np.quantile(distances, 0.98) < 0.08


def test_scans_without_odometry_make_a_map_and_move_the_robot(test, start):
    start()
    OccupancyGridNode(test.graph, NodeOptions())
    maps, tf = test.record("/map"), test.record("/tf")
    Robot(test).go(PATH)
    test.advance(2.0)
    assert_is_map_of_walls(maps.last, PATH[0])
    assert maps.last.header.frame_id == "map"
    true = relative_pose(PATH[0], PATH[-1])
    correction, local = find_last(tf, "map", "odom"), find_last(tf, "odom", "base_footprint")
    pose = compose(planar_pose(correction.transform), planar_pose(local.transform))
    assert pose == pytest.approx(true, abs=0.06)


def test_published_frame_odom_is_moved_against_drifting_odometry(test, start):
    start(WITH_ODOMETRY + 'options.tracking_frame = "imu_link"')
    tf = test.record("/tf")
    odometry = add_drift(relative_pose(PATH[0], PATH), 1.04, 0.05)
    Robot(test).go(PATH, odometry)
    correction = find_last(tf, "map", "odom")
    true = relative_pose(PATH[0], PATH[-1])
    assert np.hypot(*(odometry[-1] - true)[:2]) > 0.3
    assert compose(planar_pose(correction.transform), odometry[-1]) == pytest.approx(true, abs=0.06)
    # The tracking frame moves in the plane, so the frame of odometry is below it.
    assert correction.transform.translation.z == pytest.approx(-IMU_HEIGHT_M)
    assert not [message for message in tf if message.transforms[0].child_frame_id == "imu_link"]


def test_clouds_are_mapped_between_two_heights(test, start):
    changes = "options.num_laser_scans = 0 options.num_point_clouds = 1 TRAJECTORY_BUILDER_2D.min_z = 0.1"
    start(WITH_ODOMETRY + changes)
    OccupancyGridNode(test.graph, NodeOptions())
    maps = test.record("/map")
    Robot(test).go(PATH[:40], relative_pose(PATH[0], PATH[:40]), cloud=True)
    test.advance(2.0)
    assert_is_map_of_walls(maps.last, PATH[0])


def test_gyroscope_predicts_fast_rotations(test, start):
    start("TRAJECTORY_BUILDER_2D.use_imu_data = true")
    tf, robot = test.record("/tf"), Robot(test)
    turns = np.array([(-4.0, -3.0, 0.35 * step) for step in range(12)])
    for pose in turns:
        robot.publish_rotation(1.75)
        robot.publish_scan(pose)
        test.advance(0.2)
    pose = planar_pose(find_last(tf, "odom", "base_footprint").transform)
    assert pose[:2] == pytest.approx((0, 0), abs=0.1)
    latest = relative_pose(turns[0], turns[-1])[2]
    assert abs((pose[2] - latest + np.pi) % (2 * np.pi) - np.pi) < 0.5  # the prediction runs ahead of the last scan


def test_topics_services_and_graph_are_those_of_cartographer(test, start):
    start("options.num_laser_scans = 2 options.publish_tracked_pose = true " + WITH_ODOMETRY)
    topics = dict(test.graph.get_topic_names_and_types())
    assert {"/scan_1", "/scan_2", "/odom", "/submap_list", "/trajectory_node_list", "/landmark_poses_list"} <= set(
        topics
    )
    assert {"/constraint_list", "/scan_matched_points2", "/tracked_pose"} <= set(topics)
    assert not {"/scan", "/imu", "/points2", "/echoes"} & set(topics)
    services = {name for name, _ in test.graph.get_service_names_and_types()}
    assert {
        *("/submap_query", "/trajectory_query", "/start_trajectory", "/finish_trajectory", "/write_state"),
        *("/get_trajectory_states", "/read_metrics"),
    } <= services


def test_poses_graph_and_matched_scans_can_be_displayed(test, start):
    start("options.publish_tracked_pose = true")
    records = {
        name: test.record(f"/{name}")
        for name in ("tracked_pose", "trajectory_node_list", "constraint_list", "scan_matched_points2")
    }
    Robot(test).go(PATH[:12])
    end = relative_pose(PATH[0], PATH[11])
    pose = records["tracked_pose"].last
    assert pose.header.frame_id == "map"
    assert pose.pose.position.x == pytest.approx(end[0], abs=0.15)
    line = records["trajectory_node_list"].last.markers[0]
    assert (line.ns, line.type, len(line.points) > 3) == ("Trajectory 0", line.LINE_STRIP, True)
    edges = records["constraint_list"].last.markers[0]
    assert (edges.ns, len(edges.points)) == ("Intra constraints", 2 * (len(line.points) - 1))
    cloud = records["scan_matched_points2"].last
    assert cloud.header.frame_id == "map"
    assert cloud.width > 100


def test_trajectories_finish_and_start(test, start, tmp_path):
    start()
    robot = Robot(test)
    robot.go(PATH[:15])
    states = call(test, "get_trajectory_states", "GetTrajectoryStates").trajectory_states
    assert (list(states.trajectory_id), list(states.trajectory_state)) == ([0], [states.ACTIVE])
    configuration = {"configuration_directory": str(tmp_path), "configuration_basename": "robot.lua"}
    refused = call(test, "start_trajectory", "StartTrajectory", **configuration)
    assert refused.status.message == "Topics are already used by another trajectory."
    unknown = call(test, "finish_trajectory", "FinishTrajectory", trajectory_id=3)
    assert (unknown.status.code, unknown.status.message) == (5, "Trajectory 3 doesn't exist.")
    finished = call(test, "finish_trajectory", "FinishTrajectory", trajectory_id=0)
    assert (finished.status.code, finished.status.message) == (0, "Finished trajectory 0.")
    again = call(test, "finish_trajectory", "FinishTrajectory", trajectory_id=0)
    assert (again.status.code, again.status.message) == (3, "Trajectory 0 is in 'FINISHED' state.")
    before = call(test, "trajectory_query", "TrajectoryQuery", trajectory_id=0).trajectory
    robot.go(PATH[15:20])  # nobody listens
    assert len(call(test, "trajectory_query", "TrajectoryQuery", trajectory_id=0).trajectory) == len(before) > 3
    pose = get_message("geometry_msgs/msg/Pose")()
    start_pose = relative_pose(PATH[0], PATH[20])
    pose.position.x, pose.position.y, pose.orientation.w = float(start_pose[0]) + 0.1, float(start_pose[1]), 1.0
    started = call(
        test, "start_trajectory", "StartTrajectory", use_initial_pose=True, initial_pose=pose, **configuration
    )
    assert (started.status.code, started.trajectory_id) == (0, 1)
    robot.go(PATH[20:30])
    second = call(test, "trajectory_query", "TrajectoryQuery", trajectory_id=1).trajectory
    true = relative_pose(PATH[0], PATH[20])
    assert second[0].pose.position.x == pytest.approx(true[0], abs=0.05)  # matched against the first trajectory
    assert len(call(test, "trajectory_query", "TrajectoryQuery", trajectory_id=0).trajectory) == len(before)


def test_state_files_are_refused_with_what_to_do(test, start):
    start("", "-load_state_filename=old.pbstream")
    assert any("map_saver_cli" in text for text in logged(test, "WARN"))
    answer = call(test, "write_state", "WriteState", filename="house.pbstream")
    assert answer.status.code == 12
    assert "map_saver_cli" in answer.status.message
    assert call(test, "read_metrics", "ReadMetrics").status.code == 14


def test_map_starts_from_scratch_when_time_jumps_back(test, start):
    clock = test.create_node("clock").create_publisher(get_message("rosgraph_msgs/msg/Clock"), "/clock", 10)
    node, robot = start(parameters={"use_sim_time": True}), Robot(test)

    def publish_scan_at(seconds: int, pose: np.ndarray) -> None:
        stamp = Time.from_nanoseconds(seconds * 10**9)
        clock.publish(get_message("rosgraph_msgs/msg/Clock")(clock=stamp))
        test.settle()
        robot.publish_scan(pose, stamp)
        test.settle()

    for number in range(12):
        publish_scan_at(100 + number, PATH[number])
    assert len(node.mapping.mapper.scans) > 3
    publish_scan_at(1, PATH[0])
    assert any("Time has jumped back" in line for line in logged(test, "WARN"))
    assert len(node.mapping.mapper.scans) == 1
    assert list(call(test, "get_trajectory_states", "GetTrajectoryStates").trajectory_states.trajectory_id) == [0]


def test_unknown_submap_is_not_found(test, start):
    start()
    assert call(test, "submap_query", "SubmapQuery").status.code == 5  # nothing is mapped yet
    Robot(test).go(PATH[:4])
    known, unknown = (call(test, "submap_query", "SubmapQuery", submap_index=index) for index in (0, 4))
    assert (known.status.code, len(known.textures)) == (0, 1)
    assert (unknown.status.code, unknown.textures) == (5, [])


def test_submap_without_cells_is_not_listed(test, start):
    start()
    lists = []
    test.create_node("listener").create_subscription(
        "cartographer_ros_msgs/msg/SubmapList", "submap_list", lists.append, 10
    )
    robot = Robot(test)
    outdoors = np.array((1000.0, 1000.0, 0.0))  # No wall is within the range of the laser.
    for _ in range(3):
        robot.publish_scan(outdoors)
        test.advance(0.5)
    assert lists
    assert not any(message.submap for message in lists)
    assert not logged(test, "ERROR")


# --- configurations ---------------------------------------------------------------------------------------------------


def test_options_without_effect_are_named_in_one_line(test, start):
    start(
        "POSE_GRAPH.constraint_builder.min_score = 0.7 TRAJECTORY_BUILDER_2D.voxel_filter_size = 0.1"
        " MAP_BUILDER.num_background_threads = 7 TRAJECTORY_BUILDER_2D.max_range = 9 options.use_nav_sat = true"
    )
    (line,) = [text for text in logged(test, "INFO") if "without effect" in text]
    names = line.partition(": ")[2].split(", ")
    assert sorted(names) == [
        "pose_graph.constraint_builder.min_score",
        "trajectory_builder_2d.voxel_filter_size",
        "use_nav_sat",
    ]


def test_default_options_cause_no_remark(test, start):
    start()
    assert not [text for text in (*logged(test, "INFO"), *logged(test, "WARN")) if "option" in text.lower()]


def test_misspelled_option_has_its_place_and_a_suggestion(test, start):
    start("TRAJECTORY_BUILDER_2D.max_rnge = 3")
    (warning,) = [text for text in logged(test, "WARN") if "NAV604" in text]
    assert "max_rnge" in warning
    assert "max_range" in warning
    assert "robot.lua:35:1" in warning


@pytest.mark.parametrize(
    ("change", "code", "part"),
    [
        ("options.tracking_frame = nil", "NAV603", "'tracking_frame' is missing"),
        ("options.map_frame = 3", "NAV603", "'map_frame' must be a string"),
        ('options.provide_odom_frame = "yes"', "NAV603", "must be true or false"),
        ("options.num_laser_scans = 0.5", "NAV603", "must be an integer"),
        ("options.num_laser_scans = 0", "NAV603", "are all 0"),
        ("TRAJECTORY_BUILDER_2D.submaps.grid_options_2d.resolution = 0", "NAV603", "greater than 0"),
        ("MAP_BUILDER.use_trajectory_builder_3d = true", "NAV603", "mapping in space"),
        ('include "missing.lua"', "NAV602", "does not exist"),
        ("TRAJECTORY_BUILDER_2D.sumaps.num_range_data = 3", "NAV601", "'sumaps' does not exist"),
        ("for i = 1, 3 do end", "NAV601", "'for' is not supported"),
    ],
)
def test_errors_of_configurations_have_a_place(start, change, code, part):
    diagnostic = error_of(start, change)
    assert diagnostic.code == code
    assert part in diagnostic.message
    assert diagnostic.span is not None


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ([], "NODE431"),
        (["-configuration_directory", "/tmp"], "NODE431"),
        (["-configuration_directori", "/tmp"], "NODE432"),
        (["-configuration_directory", "/nowhere", "-configuration_basename", "robot.lua"], "NAV602"),
    ],
)
def test_arguments_are_required_and_checked(test, arguments, code):
    with pytest.raises(LinkwrightError) as error:
        CartographerNode(test.graph, NodeOptions(arguments=arguments))
    assert error.value.diagnostics[0].code == code


def test_configuration_of_the_user_comes_before_cartographers(test, start, tmp_path):
    (tmp_path / "trajectory_builder_2d.lua").write_text("TRAJECTORY_BUILDER_2D = { max_range = 4 }")
    diagnostic = error_of(start, "")
    assert diagnostic.message == "the option 'trajectory_builder.trajectory_builder_2d.min_range' is missing"


def test_resolution_and_topic_of_the_grid_are_arguments(test, start):
    start()
    OccupancyGridNode(test.graph, NodeOptions(arguments=["-resolution", "0.1", "-occupancy_grid_topic=plan"]))
    maps = test.record("/plan")
    Robot(test).go(PATH[:6])
    test.advance(2.0)
    grid = grid_from_message(maps.last)
    assert grid.resolution == pytest.approx(0.1)
    assert (grid.cells == OCCUPIED).sum() > 50
