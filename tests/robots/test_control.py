"""The package of control nodes.

Each drives mbot through a simulated world, and its motion is checked.
"""

from __future__ import annotations

import importlib
import math
import sys
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest
import yaml

from linkwright import standins
from linkwright.cli.command import main
from linkwright.messages import get_message
from linkwright.testing import SteppedSimulation
from tests.places import CONTROL_PACKAGE, GAZEBO_PACKAGE
from tests.robots.workspaces import colcon_build

pytest.importorskip("mujoco")

ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"
NODES = ("drive_square", "follow_wall", "go_to_pose", "follow_line", "avoid_obstacles")
ROBOT_RADIUS_M = 0.2
"""The radius of mbot in meters."""


@pytest.fixture
def load_module(monkeypatch: pytest.MonkeyPatch) -> Iterator[Any]:
    """Return a function that imports a module of the package, as a sourced workspace does."""
    standins.activate()
    monkeypatch.syspath_prepend(str(CONTROL_PACKAGE))

    def module(name: str) -> ModuleType:
        return importlib.import_module(f"my_robot_control.{name}")

    yield module
    for name in [name for name in sys.modules if name.partition(".")[0] == "my_robot_control"]:
        del sys.modules[name]


def world_path(name: str) -> Path:
    return GAZEBO_PACKAGE / "worlds" / f"{name}.world"


def true_position(test: SteppedSimulation) -> tuple[float, float]:
    """Return the robot's true position."""
    x, y, *_ = test.robot_pose()
    return x, y


def logged_texts(test: SteppedSimulation) -> list[str]:
    return [record.text for record in test.log]


@pytest.mark.slow
def test_drive_square_closes_square(load_module: Any) -> None:
    with SteppedSimulation(world_path("empty"), ROBOT) as test:
        test.init_rclpy()
        load_module("drive_square").DriveSquare()
        odometry = test.record("/odom")
        corners: list[tuple[float, float]] = []
        for _ in range(60):
            test.advance(1.0)
            reached = sum("corner reached" in text for text in logged_texts(test))
            if reached > len(corners):
                corners.append(true_position(test))
            if "the square is closed" in logged_texts(test):
                break
        measured = odometry.last.pose.pose.position
        assert math.hypot(measured.x, measured.y) < 0.05, "by odometry"
        assert math.dist(true_position(test), (0.0, 0.0)) < 0.25, "in the world, because wheels slip"
        for corner, expected in zip(corners, [(1, 0), (1, 1), (0, 1)], strict=True):
            assert math.dist(corner, expected) < 0.25
        test.advance(1.0)
        speed = odometry.last.twist.twist
        assert abs(speed.linear.x) < 1e-3
        assert abs(speed.angular.z) < 1e-3


@pytest.mark.slow
def test_follow_wall_goes_through_maze(load_module: Any) -> None:
    with SteppedSimulation(world_path("maze"), ROBOT, arguments={"laser": True}) as test:
        test.init_rclpy()
        load_module("follow_wall").FollowWall()
        scans = test.record("/scan")
        test.advance(2.0)
        way, before, beside, nearest = 0.0, true_position(test), [], []
        for _ in range(60):
            test.advance(1.0)
            way, before = way + math.dist(before, true_position(test)), true_position(test)
            nearest.append(min(scans.last.ranges))
            beside.append(scans.last.ranges[90])  # 90 degrees to the right
        assert way > 8.0
        assert min(nearest) > ROBOT_RADIUS_M + 0.1, "mbot touches nothing"
        near_distances = [distance for distance in beside if distance < 0.9]
        assert len(near_distances) > 40, "there is a wall on the right most of the time"
        assert sorted(near_distances)[len(near_distances) // 2] == pytest.approx(0.5, abs=0.1)
        assert math.dist(true_position(test), (0.0, 0.0)) > 4.0, "mbot gets through the maze"


def test_follow_wall_works_on_left_side(load_module: Any) -> None:
    with SteppedSimulation(world_path("maze"), ROBOT, arguments={"laser": True}) as test:
        test.init_rclpy(["--ros-args", "-p", "side:=left"])
        load_module("follow_wall").FollowWall()
        scans = test.record("/scan")
        test.advance(5.0)
        assert true_position(test)[0] > 0.7
        assert scans.last.ranges[270] == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize(("x", "y", "yaw"), [(1.0, 0.5, 1.57), (-0.8, -0.4, 0.0)])
def test_go_to_pose_reaches_pose(load_module: Any, x: float, y: float, yaw: float) -> None:
    with SteppedSimulation(world_path("empty"), ROBOT) as test:
        test.init_rclpy()
        load_module("go_to_pose").GoToPose()
        odometry = test.record("/odom")
        test.advance(0.2)
        goal = get_message("geometry_msgs/msg/PoseStamped")()
        goal.pose.position.x, goal.pose.position.y = x, y
        goal.pose.orientation.z, goal.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        goal.header.frame_id = "map"
        test.publish("/goal_pose", goal)
        test.advance(0.2)
        assert any("set the Fixed Frame to 'odom'" in text for text in logged_texts(test))
        goal.header.frame_id = "odom"
        test.publish("/goal_pose", goal)
        for _ in range(40):
            test.advance(1.0)
            if "goal reached" in logged_texts(test):
                break
        pose = odometry.last.pose.pose
        assert math.dist((pose.position.x, pose.position.y), (x, y)) < 0.1
        heading = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        assert math.cos(heading - yaw) > math.cos(0.1)
        assert "goal reached" in logged_texts(test)


@pytest.mark.slow
def test_follow_line_follows_line(load_module: Any) -> None:
    line = _line_piece_centers()
    with SteppedSimulation(world_path("line_track"), ROBOT, arguments={"camera": True}) as test:
        test.init_rclpy()
        load_module("follow_line").FollowLine()
        way, before = 0.0, true_position(test)
        for _ in range(18):
            test.advance(1.0)
            way, before = way + math.dist(before, true_position(test)), true_position(test)
            assert min(math.dist(true_position(test), piece) for piece in line) < 0.15, "mbot is on the line"
        assert way > 2.5


@pytest.mark.slow
def test_avoid_obstacles_touches_nothing(load_module: Any) -> None:
    with SteppedSimulation(world_path("obstacles"), ROBOT, arguments={"laser": True}) as test:
        test.init_rclpy()
        load_module("avoid_obstacles").AvoidObstacles()
        scans = test.record("/scan")
        way, before = 0.0, true_position(test)
        for _ in range(60):
            test.advance(1.0)
            way, before = way + math.dist(before, true_position(test)), true_position(test)
            assert min(scans.last.ranges) > ROBOT_RADIUS_M + 0.05
        assert way > 6.0
        assert any("m ahead" in text for text in logged_texts(test))


def test_avoid_obstacles_stops_before_box(load_module: Any) -> None:
    with SteppedSimulation(world_path("obstacles"), ROBOT, arguments={"laser": True}) as test:
        test.init_rclpy(["--ros-args", "-p", "wander:=false"])
        load_module("avoid_obstacles").AvoidObstacles()
        scans, odometry = test.record("/scan"), test.record("/odom")
        test.advance(20.0)
        assert true_position(test)[0] > 2.0, "mbot drives toward the boxes, which are 3.6 m away"
        distance_ahead = min(distance for number, distance in enumerate(scans.last.ranges) if abs(number - 180) <= 40)
        assert 0.35 < distance_ahead < 0.6
        assert abs(odometry.last.twist.twist.linear.x) < 1e-3


def test_silent_laser_stops_robot(load_module: Any) -> None:
    with SteppedSimulation(world_path("empty"), ROBOT) as test:
        test.init_rclpy()
        load_module("avoid_obstacles").AvoidObstacles()
        velocities = test.record("/cmd_vel")
        scan = get_message("sensor_msgs/msg/LaserScan")(angle_min=-math.pi, angle_increment=math.pi / 180)
        scan.range_max, scan.ranges = 6.0, [6.0] * 360
        for _ in range(5):
            test.publish("/scan", scan)
            test.advance(0.1)
        assert velocities.last.linear.x > 0.1
        test.advance(1.0)
        assert velocities.last.linear.x == 0.0


def test_decision_tests_of_package_pass(load_module: Any) -> None:
    path = CONTROL_PACKAGE / "test" / "test_decisions.py"
    load_module("driving_node")
    names: dict[str, Any] = {"__name__": "test_decisions"}
    exec(compile(path.read_text(encoding="utf-8"), str(path), "exec"), names)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    assert len(tests) == 5
    for test in tests:
        test()


def test_package_has_no_findings(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["check", "--strict", str(CONTROL_PACKAGE)]) == 0, capsys.readouterr().out


def test_nodes_have_parameters_launch_files_and_entry_points() -> None:
    parameters = yaml.safe_load((CONTROL_PACKAGE / "config" / "control.yaml").read_text(encoding="utf-8"))
    assert set(parameters) == set(NODES)
    setup = (CONTROL_PACKAGE / "setup.py").read_text(encoding="utf-8")
    for name in NODES:
        assert f"'{name} = my_robot_control.{name}:main'" in setup
        assert (CONTROL_PACKAGE / "launch" / f"{name}.launch.py").is_file()


@pytest.mark.parametrize("name", NODES)
def test_parameter_file_matches_declared_parameters(load_module: Any, name: str) -> None:
    text = yaml.safe_load((CONTROL_PACKAGE / "config" / "control.yaml").read_text(encoding="utf-8"))
    with SteppedSimulation(world_path("empty")) as test:
        test.init_rclpy()
        module = load_module(name)
        (kind,) = [
            member
            for member in vars(module).values()
            if isinstance(member, type) and member.__module__ == module.__name__ and hasattr(member, "drive")
        ]
        node = kind()
        expected = text[name]["ros__parameters"]
        assert {key: node.get_parameter(key).value for key in expected} == expected


@pytest.mark.parametrize("name", NODES)
def test_launch_files_start_simulation_and_node(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["launch", str(CONTROL_PACKAGE / "launch" / f"{name}.launch.py"), "--print"]) == 0
    printed = capsys.readouterr().out
    assert name in printed
    assert "gazebo" in printed


@pytest.mark.slow
def test_colcon_installs_package_completely(tmp_path: Path) -> None:
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / CONTROL_PACKAGE.name).symlink_to(CONTROL_PACKAGE)
    colcon_build(tmp_path, CONTROL_PACKAGE.name)
    installed = tmp_path / "install" / CONTROL_PACKAGE.name
    share = installed / "share" / CONTROL_PACKAGE.name
    for name in NODES:
        assert (installed / "lib" / CONTROL_PACKAGE.name / name).is_file()
        assert (share / "launch" / f"{name}.launch.py").is_file()
    assert (share / "config" / "control.yaml").is_file()


def _line_piece_centers() -> list[tuple[float, float]]:
    """Return the centers of the line's pieces, x and y in m."""
    model = ET.parse(world_path("line_track")).find(".//model[@name='line']")
    assert model is not None
    poses = [pose.text.split() for pose in model.iterfind(".//visual/pose") if pose.text]
    return [(float(x), float(y)) for x, y, *_ in poses]
