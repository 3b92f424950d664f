"""Drives in a simulated world.

Controllers turn motors, wheels roll, and odometry is compared with the truth.
"""

from __future__ import annotations

import json
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest

from linkwright.control.odometry import get_yaw
from linkwright.kinematics.planar import PlanarPose
from tests.control.controllers.driving import stamped_twist
from tests.simulation.ros2_control.test_plugin import PLUGINS, ControlledRobot
from tests.simulation.test_ackermann import TRACK_WIDTH, WHEEL_RADIUS, WHEELBASE, car
from tests.simulation.test_gz_drives import LENGTH, WIDTH, mecanum_robot
from tests.simulation.test_plugins import running_server
from tests.simulation.test_skid_steering import SIDES, skid_robot
from tests.simulation.worlds import GROUND, mbot

TIMEOUT_S = 0.2


@dataclass(frozen=True)
class RobotSetup:
    """The model of a robot, with its command interfaces and controller.

    Each joint has a command interface, and the controller has parameters.
    """

    model: str
    text: str
    joints: Mapping[str, str]
    type: str
    parameters: Mapping[str, Any]
    command: str = "/base/reference"
    odometry: str = "/base/odometry"

    def description(self, plugin: str) -> str:
        """Return the robot's description."""
        wheels = "".join(
            f"<link name='{name}_link'/><joint name='{name}' type='continuous'><parent link='base'/>"
            f"<child link='{name}_link'/></joint>"
            for name in self.joints
        )
        hardware = "".join(
            f"<joint name='{name}'><command_interface name='{kind}'/><state_interface name='position'/>"
            "<state_interface name='velocity'/></joint>"
            for name, kind in self.joints.items()
        )
        return (
            f"<robot name='{self.model}'><link name='base'/>{wheels}<ros2_control name='drive' type='system'>"
            f"<hardware><plugin>{plugin}</plugin></hardware>{hardware}</ros2_control></robot>"
        )

    def controllers(self) -> str:
        """Return the robot's parameter file; JSON is also YAML."""
        manager = {"update_rate": 100, "base": {"type": self.type}}
        return json.dumps(
            {
                name: {"ros__parameters": text}
                for name, text in (("controller_manager", manager), ("base", self.parameters))
            }
        )


DIFFERENTIAL = RobotSetup(
    "mbot",
    mbot(),
    dict.fromkeys(("left_joint", "right_joint"), "velocity"),
    "diff_drive_controller/DiffDriveController",
    {
        "left_wheel_names": ["left_joint"],
        "right_wheel_names": ["right_joint"],
        "wheel_separation": 0.38,
        "wheel_radius": 0.06,
        "cmd_vel_timeout": TIMEOUT_S,
        "publish_rate": 100.0,
        "linear": {"x": {"max_acceleration": 2.0}},
    },
    "/base/cmd_vel",
    "/base/odom",
)
_REAR, _STEERING = ["rear_right_joint", "rear_left_joint"], ["right_steering_joint", "left_steering_joint"]
ACKERMANN = RobotSetup(
    "car",
    car(""),
    dict.fromkeys(_REAR, "velocity") | dict.fromkeys(_STEERING, "position"),
    "ackermann_steering_controller/AckermannSteeringController",
    {
        "traction_joints_names": _REAR,
        "steering_joints_names": _STEERING,
        "wheelbase": WHEELBASE,
        "traction_track_width": TRACK_WIDTH,
        "traction_wheels_radius": WHEEL_RADIUS,
        "reference_timeout": TIMEOUT_S,
        "position_feedback": True,
    },
)
_CORNERS = {
    "front_left": "front_left",
    "front_right": "front_right",
    "rear_left": "back_left",
    "rear_right": "back_right",
}
MECANUM = RobotSetup(
    "robot",
    mecanum_robot().partition("<plugin")[0] + "</model>",
    {f"{corner}_joint": "velocity" for corner in _CORNERS.values()},
    "mecanum_drive_controller/MecanumDriveController",
    {
        **{f"{name}_wheel_command_joint_name": f"{corner}_joint" for name, corner in _CORNERS.items()},
        "kinematics": {
            "wheels_radius": WHEEL_RADIUS,
            "sum_of_robot_center_projection_on_X_Y_axis": (LENGTH + WIDTH) / 2.0,
        },
        "reference_timeout": TIMEOUT_S,
    },
)
HEAVY_SKID = RobotSetup(
    "robot",
    skid_robot(0.4).partition("<plugin")[0].replace("<mass>5.0</mass>", "<mass>90.0</mass>") + "</model>",
    {f"{end}_{side}_joint": "velocity" for end, side in SIDES},
    "diff_drive_controller/DiffDriveController",
    {
        **{f"{side}_wheel_names": [f"{end}_{side}_joint" for end in ("front", "back")] for side in ("left", "right")},
        "wheel_separation": 0.4,
        "wheel_radius": 0.1,
        "cmd_vel_timeout": TIMEOUT_S,
    },
    "/base/cmd_vel",
    "/base/odom",
)
all_drives = pytest.mark.parametrize(
    "robot", [DIFFERENTIAL, ACKERMANN, MECANUM], ids=["differential", "ackermann", "mecanum"]
)


class DrivenRobot(ControlledRobot):
    """A robot that is driven in a world."""

    def __init__(self, server: Any, graph: Any, robot: RobotSetup) -> None:
        super().__init__(server, graph)
        self.robot = robot
        self._publisher = self.node.create_publisher("geometry_msgs/msg/TwistStamped", robot.command, 10)
        self._odometry: list[Any] = []
        self.node.create_subscription("nav_msgs/msg/Odometry", robot.odometry, self._odometry.append, 1000)

    async def drive(self, seconds: float, *velocity: float) -> None:
        """Publish a velocity command every 0.1 s."""
        for _ in range(round(seconds / 0.1)):
            self._publisher.publish(stamped_twist(self.server.simulation.time, *velocity))
            await self.advance(0.1)

    @property
    def truth(self) -> PlanarPose:
        """Return the robot's pose in the world."""
        pose = self.server.simulation.model_pose(self.robot.model)
        return PlanarPose(pose[0], pose[1], get_yaw(pose))

    @property
    def odometry(self) -> PlanarPose:
        """Return the pose of the last odometry message."""
        pose = self._odometry[-1].pose.pose
        orientation = pose.orientation
        return PlanarPose(
            pose.position.x,
            pose.position.y,
            get_yaw((0.0, 0.0, 0.0, orientation.x, orientation.y, orientation.z, orientation.w)),
        )


@asynccontextmanager
async def start_drive(robot: RobotSetup, folder: Path) -> AsyncIterator[DrivenRobot]:
    """Run a world with the robot at rest, and its controller active."""
    file = folder / "controllers.yaml"
    file.write_text(robot.controllers())
    filename, name, hardware = PLUGINS["gz"]
    plugin = f'<plugin filename="{filename}" name="{name}"><parameters>{file}</parameters></plugin>'
    async with running_server(GROUND, robot.text.replace("</model>", f"{plugin}</model>")) as (server, graph, log):
        drive = DrivenRobot(server, graph, robot)
        await drive.describe(robot.description(hardware))
        await drive.start("base")
        await drive.advance(0.5)
        yield drive
        assert not [record.text for record in log if record.level.name in ("WARN", "ERROR")]


@all_drives
async def test_odometry_matches_truth_over_five_meters(robot, tmp_path):
    async with start_drive(robot, tmp_path) as drive:
        await drive.drive(5.0, 1.0)
        await drive.advance(1.0)
        truth, odometry = drive.truth, drive.odometry
        assert odometry.x == pytest.approx(5.0 + TIMEOUT_S / 2.0, abs=0.02)
        assert (truth.x, truth.y) == pytest.approx((odometry.x, 0.0), abs=0.05)


@pytest.mark.parametrize("robot", [DIFFERENTIAL, ACKERMANN], ids=["differential", "ackermann"])
async def test_odometry_matches_truth_on_arc(robot, tmp_path):
    async with start_drive(robot, tmp_path) as drive:
        await drive.drive(6.0, 0.4, 0.3)
        await drive.advance(1.0)
        truth, odometry = drive.truth, drive.odometry
        assert odometry.yaw == pytest.approx(0.3 * (6.0 + TIMEOUT_S / 2.0), abs=0.05)
        assert (odometry.x, odometry.y, odometry.yaw) == pytest.approx((truth.x, truth.y, truth.yaw), abs=0.04)


@all_drives
async def test_robot_stops_when_commands_stop(robot, tmp_path):
    async with start_drive(robot, tmp_path) as drive:
        await drive.drive(1.0, 0.5)
        await drive.advance(0.09)
        moving = drive.truth
        await drive.advance(1.0)
        stopped = drive.truth
        await drive.advance(0.5)
        assert 0.0 < stopped.x - moving.x < 0.1
        assert drive.truth.x == pytest.approx(stopped.x, abs=1e-3)


async def test_wheels_of_robot_require_one_model_compilation(tmp_path):
    """Motors require a new compilation of MuJoCo's model.

    With one per wheel, many robots would start slowly.
    """
    async with start_drive(DIFFERENTIAL, tmp_path) as drive:
        assert drive.server.simulation.revision <= 1


async def test_wheels_of_heavy_skid_steered_robot_turn_as_commanded(tmp_path):
    """Friction holds the wheels back in a turn, but Gazebo sets velocities whatever the friction."""
    async with start_drive(HEAVY_SKID, tmp_path) as drive:
        await drive.drive(1.0, 0.3, 0.3)
        begin, begin_truth = drive.odometry.yaw, drive.truth.yaw
        await drive.drive(2.0, 0.3, 0.3)
        assert drive.odometry.yaw - begin == pytest.approx(0.6, rel=0.05)
        assert drive.truth.yaw - begin_truth == pytest.approx(0.3, rel=0.2)  # the track squared by the diagonal squared
