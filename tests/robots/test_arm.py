"""The package of mbot's bigger sister: her description, her configuration for MoveIt, and how she grasps and sees."""

from __future__ import annotations

import importlib
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from linkwright import standins
from linkwright.descriptions import examine
from linkwright.geometry.arrays import matrix_from_pose
from linkwright.graph import ActionClient
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.launch.frontend.launch_file import load_launch_file
from linkwright.messages import get_action, get_message, get_service
from linkwright.packages import PackageFinder, use_finder
from linkwright.planning.groups import resolve_groups
from linkwright.planning.inverse_kinematics import ChainSolver
from linkwright.planning.robot_model import RobotModel
from linkwright.planning.semantics import Semantics, read_semantics
from linkwright.planning.setup.collision_pairs import ClosedGripper, find_collision_pairs
from linkwright.planning.setup.link_surfaces import LinkSurfaces
from linkwright.planning.shapes import robot_shapes
from linkwright.testing import SteppedSimulation
from linkwright.urdf import Robot
from tests.places import ARM_PACKAGE, GAZEBO_PACKAGE, PACKAGE, REPOSITORY

pytestmark = pytest.mark.extra("arm")

URDF = ARM_PACKAGE / "config" / "mbot_arm.urdf.xacro"
ARGUMENTS = {"simulator": "gz", "controllers": str(ARM_PACKAGE / "config" / "gz_controllers.yaml")}
CONTROLLERS = ("joint_state_broadcaster", "arm_controller", "gripper_controller")
TABLE_M, CUBE_M = 0.3, 0.04


@pytest.fixture
def seeing(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    monkeypatch.syspath_prepend(str(ARM_PACKAGE))
    yield importlib.import_module("my_robot_arm.seeing")
    for name in [name for name in sys.modules if name.partition(".")[0] == "my_robot_arm"]:
        del sys.modules[name]


def robot(**arguments: str) -> Robot:
    finder = PackageFinder(start=[ARM_PACKAGE], environment={})
    description = examine(str(URDF), arguments=arguments, packages=finder)
    assert description.diagnostics == ()
    assert description.robot is not None
    return description.robot


def semantics() -> Semantics:
    return read_semantics((ARM_PACKAGE / "config" / "mbot_arm.srdf").read_text(encoding="utf-8"))


@pytest.mark.parametrize("simulator", ["mock", "classic", "gz"])
def test_description_has_no_findings(simulator: str) -> None:
    assert "left_finger_joint" in robot(simulator=simulator).joints


def test_disabled_collisions_are_those_of_arm_init() -> None:
    description, meshes = robot(), MeshLibrary(PackageFinder(), Path())
    shapes, _ = robot_shapes(description, meshes)
    closed = np.zeros(len(RobotModel(description).joint_names))
    gripper = ClosedGripper(frozenset(("hand_link", "left_finger_link", "right_finger_link")), closed)
    pairs = find_collision_pairs(description, shapes, LinkSurfaces(description, meshes), [gripper])
    assert dict(semantics().disabled_collisions) == {frozenset(pair): reason for pair, reason in pairs.disabled.items()}


def test_launch_files_load() -> None:
    standins.activate()
    with use_finder(PackageFinder(start=[ARM_PACKAGE], environment={})):
        for path in sorted((ARM_PACKAGE / "launch").iterdir()):
            load_launch_file(path)


def test_cube_is_found_in_a_picture(seeing: ModuleType) -> None:
    """A camera 0.4 m above a table sees the top and two sides of a turned cube."""
    place, yaw, height = np.array((0.62, 0.1)), 0.4, 0.34
    matrix = np.array([[381.4, 0.0, 320.5], [0.0, 381.4, 240.5], [0.0, 0.0, 1.0]])
    position, rotation = np.array((0.55, 0.0, 0.74)), np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
    columns, lines = np.meshgrid(np.arange(640), np.arange(480))
    every_pixel = np.column_stack((columns.ravel(), lines.ravel()))
    is_cube, is_top = np.zeros((2, len(every_pixel)), dtype=bool)
    axes = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
    for level in np.linspace(height - CUBE_M, height, 41):
        points = seeing.to_table(every_pixel, matrix, position, rotation, level)
        is_top = np.all(np.abs((points - place) @ axes.T) < CUBE_M / 2, axis=1)
        is_cube |= is_top
    assert is_cube.sum() > 1.2 * is_top.sum()
    picture = np.full((480 * 640, 3), (140, 97, 56), dtype=np.uint8)
    picture[is_cube] = (199, 13, 15)
    picture += np.random.default_rng(0).integers(0, 6, picture.shape, dtype=np.uint8)
    pixels = seeing.find_pixels(picture.reshape(480, 640, 3), "red")
    assert len(pixels) == is_cube.sum()
    points = seeing.to_table(pixels, matrix, position, rotation, height)
    found, turn = seeing.find_square(points, position[:2], CUBE_M)
    assert found == pytest.approx(place, abs=0.002)
    assert turn == pytest.approx(yaw, abs=0.06)
    assert len(seeing.find_pixels(picture.reshape(480, 640, 3), "blue")) == 0


class Bench:
    """The robot before the table, with active controllers."""

    def __init__(self, test: SteppedSimulation) -> None:
        self.test = test
        test.advance(0.2)
        for name in CONTROLLERS:
            self._call("LoadController", "load_controller", name=name)
            self._call("ConfigureController", "configure_controller", name=name)
        self._call("SwitchController", "switch_controller", activate_controllers=list(CONTROLLERS), strictness=2)
        self._arm = get_action("control_msgs/action/FollowJointTrajectory")
        self._gripper = get_action("control_msgs/action/GripperCommand")
        self._arm_client = ActionClient(test.node, self._arm, "arm_controller/follow_joint_trajectory")
        self._gripper_client = ActionClient(test.node, self._gripper, "gripper_controller/gripper_cmd")
        description = robot(**ARGUMENTS)
        model = RobotModel(description)
        self.group = resolve_groups(description, semantics(), model.joint_names)["arm"]
        self._solver = ChainSolver(model, self.group, "grasp_link")
        self._positions = np.zeros(len(model.joint_names))

    def _call(self, kind: str, service: str, **fields: Any) -> None:
        service_type = get_service(f"controller_manager_msgs/srv/{kind}")
        future = self.test.node.create_client(service_type, f"/controller_manager/{service}").call_async(
            service_type.Request(**fields)
        )
        self.test.advance(0.2)
        assert future.result().ok, service

    def solve(self, place: tuple[float, float], height: float, yaw: float, start: np.ndarray) -> np.ndarray:
        """Return the positions of the arm with the gripper pointing down."""
        ahead = math.atan2(place[1], place[0]) + math.pi
        yaw += math.pi / 2 * round((ahead - yaw) / (math.pi / 2))
        target = np.array((*place, TABLE_M + height, math.cos(yaw / 2), math.sin(yaw / 2), 0.0, 0.0))
        self._positions[self._solver.indexes] = start
        found = self._solver.solve(target, self._positions, 2.0)
        assert found is not None
        return found[self._solver.indexes] if len(found) > len(start) else found

    def move(self, positions: np.ndarray, seconds: float) -> None:
        point = get_message("trajectory_msgs/msg/JointTrajectoryPoint")(
            positions=positions.tolist(), velocities=[0.0] * len(positions)
        )
        point.time_from_start.sec = 1
        point.time_from_start.nanosec = round((seconds - 1.0) * 1e9)
        trajectory = get_message("trajectory_msgs/msg/JointTrajectory")(
            joint_names=list(self.group.joint_names), points=[point]
        )
        self._arm_client.send_goal_async(self._arm.Goal(trajectory=trajectory))
        self.test.advance(seconds + 0.4)

    def grip(self, position: float) -> None:
        goal = self._gripper.Goal()
        goal.command.position, goal.command.max_effort = position, 20.0
        self._gripper_client.send_goal_async(goal)
        self.test.advance(1.5)


@pytest.mark.slow
@pytest.mark.parametrize(("x", "y", "yaw"), [(0.6, 0.12, 0.3), (0.68, -0.1, -0.6), (0.57, -0.22, 0.0)])
def test_cube_is_held_by_friction(x: float, y: float, yaw: float) -> None:
    """A cube is lifted, carried around the robot for a second, held for three, and does not slip 3 mm."""
    with SteppedSimulation(
        GAZEBO_PACKAGE / "worlds" / "table.world", URDF, arguments=ARGUMENTS, robot_state_publisher=True
    ) as test:
        bench = Bench(test)
        for other in ("green_cube", "blue_cube"):
            test.delete(other)
        test.simulation.set_model_pose("red_cube", (x, y, 0.32, 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))
        look = np.array([semantics().states["arm"]["look"][name] for name in bench.group.joint_names])
        above = bench.solve((x, y), 0.12, yaw, look)
        bench.grip(0.035)
        bench.move(above, 2.0)
        bench.move(bench.solve((x, y), 0.032, yaw, above), 1.5)
        bench.grip(0.0)
        bench.move(above, 1.5)
        lifted = test.simulation.model_pose("red_cube")[2]
        carried = above.copy()
        carried[0] += 0.9
        bench.move(carried, 1.5)
        test.advance(3.0)
        pose = test.simulation.model_pose("red_cube")
    assert lifted > 0.4
    assert pose[2] == pytest.approx(lifted, abs=0.003)
    assert math.dist(pose[:2], (x, y)) > 0.3
    assert matrix_from_pose(np.array(pose))[2, 2] > 0.99


def test_course_has_the_same_macros() -> None:
    """The lesson adds the macros to the learner's my_robot_description, which hides the shipped package."""
    start = REPOSITORY / "courses" / "robot" / "13-picking" / "start" / "src" / "my_robot_description" / "urdf"
    for name in ("base/mbot_base_gazebo.xacro", "base/inertia.xacro", "sensor/camera_gazebo.xacro"):
        shipped = PACKAGE / "urdf" / name
        assert (start / name).read_text(encoding="utf-8") == shipped.read_text(encoding="utf-8")
