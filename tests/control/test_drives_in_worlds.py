"""Drives in a simulated world: controllers turn motors, wheels roll on the ground, and odometry is beside the truth."""

from __future__ import annotations

from math import inf
from typing import Any

import pytest

from linkwright.control.controllers.ackermann_steering_controller import AckermannSteeringController
from linkwright.control.controllers.controller import Controller
from linkwright.control.controllers.diff_drive_controller import DiffDriveController
from linkwright.control.controllers.mecanum_drive_controller import MecanumDriveController
from linkwright.kinematics.planar import PlanarPose
from linkwright.simulation.plugins.odometry import yaw_of
from tests.control.controllers.driving import stamped
from tests.control.stand import Stand
from tests.simulation.test_ackermann import BASE, RADIUS, TRACK, car
from tests.simulation.test_gz_drives import LENGTH, WIDTH, mecanum
from tests.simulation.worlds import GROUND, mbot, simulated

SECOND = 1_000_000_000
PERIOD = SECOND // 100
TIMEOUT = 0.2


class Drive:
    """A robot in a world, and the controller of its wheels, which is updated a hundred times a second."""

    def __init__(self, stand: Stand, robot: str, name: str, command: str, odometry: str) -> None:
        self.stand, self.name, self.command = stand, name, command
        self.simulation = simulated(GROUND, robot)
        self.told = stand.heard("nav_msgs/msg/Odometry", odometry)
        self.joints: dict[str, Any] = {}

    def wheels(self, *names: str) -> None:
        """Joints that motors turn, whatever that takes: Gazebo sets their velocities."""
        for name in names:
            self.joints[name] = self.simulation.add_velocity_motor(f"{self.name}::{name}", 20.0, inf)
            self.stand.joint(name, commands=("velocity",), position=0.0, velocity=0.0)

    def servos(self, *names: str) -> None:
        """Joints that are held at angles."""
        for name in names:
            self.joints[name] = self.simulation.add_servo(f"{self.name}::{name}")
            self.stand.joint(name, commands=("position",), position=0.0)

    def start(self, kind: type[Controller[Any]], **parameters: Any) -> None:
        """Activate the controller, and let the robot come to rest."""
        self.controller = self.stand.start(kind, "base", **parameters)
        self.simulation.call_every(PERIOD, self._update)
        self.simulation.advance(SECOND // 2)

    async def drive(self, seconds: float, *velocity: float) -> None:
        """Tell a velocity as often as it has to be, for so long."""
        for _ in range(round(seconds / 0.1)):
            message = stamped(self.simulation.time, *velocity)
            self.stand.say("geometry_msgs/msg/TwistStamped", self.command, message)
            await self.pass_by(0.1)

    async def pass_by(self, seconds: float) -> None:
        """Let time pass."""
        await self.stand.graph.settle()
        self.simulation.advance(round(seconds * SECOND))
        self.stand.exchange.deliver()
        await self.stand.graph.settle()

    @property
    def truth(self) -> PlanarPose:
        """Where the robot is in the world."""
        pose = self.simulation.model_pose(self.name)
        return PlanarPose(pose[0], pose[1], yaw_of(pose))

    @property
    def odometry(self) -> PlanarPose:
        """Where its odometry says that it is."""
        place = self.told[-1].pose.pose
        rotation = place.orientation
        pose = (place.position.x, place.position.y, 0.0, rotation.x, rotation.y, rotation.z, rotation.w)
        return PlanarPose(pose[0], pose[1], yaw_of(pose))

    def _update(self) -> None:
        stand = self.stand
        for name in self.joints:
            position, velocity = self.simulation.joint_state(f"{self.name}::{name}")
            for kind, value in (("position", position), ("velocity", velocity)):
                if f"{name}/{kind}" in stand.states:
                    stand.states[f"{name}/{kind}"].value = value
        stand.exchange.work()
        self.controller.step(self.simulation.time, PERIOD / SECOND)
        for name, joint in self.joints.items():
            if f"{name}/velocity" in stand.commands:
                joint.target = stand.commands[f"{name}/velocity"].value
            elif (angle := stand.commands[f"{name}/position"].value) == angle:
                joint.move(angle, PERIOD / SECOND)


def differential(stand: Stand) -> Drive:
    drive = Drive(stand, mbot(), "mbot", "/base/cmd_vel", "/base/odom")
    drive.wheels("left_joint", "right_joint")
    drive.start(
        DiffDriveController,
        left_wheel_names=["left_joint"],
        right_wheel_names=["right_joint"],
        wheel_separation=0.38,
        wheel_radius=0.06,
        cmd_vel_timeout=TIMEOUT,
        publish_rate=100.0,
        linear={"x": {"max_acceleration": 2.0}},
    )
    return drive


def ackermann(stand: Stand) -> Drive:
    drive = Drive(stand, car(""), "car", "/base/reference", "/base/odometry")
    drive.wheels("rear_right_joint", "rear_left_joint")
    drive.servos("right_steering_joint", "left_steering_joint")
    for joint in ("front_right_joint", "front_left_joint"):
        drive.simulation.let_roll(f"car::{joint}")
    drive.start(
        AckermannSteeringController,
        traction_joints_names=["rear_right_joint", "rear_left_joint"],
        steering_joints_names=["right_steering_joint", "left_steering_joint"],
        wheelbase=BASE,
        traction_track_width=TRACK,
        traction_wheels_radius=RADIUS,
        reference_timeout=TIMEOUT,
        position_feedback=True,
    )
    return drive


def four_wheels(stand: Stand) -> Drive:
    text = mecanum()
    drive = Drive(stand, text[: text.index("<plugin")] + "</model>", "robot", "/base/reference", "/base/odometry")
    corners = {"front_left": "front_left", "front_right": "front_right", "rear_left": "back_left"}
    corners["rear_right"] = "back_right"
    drive.wheels(*(f"{corner}_joint" for corner in corners.values()))
    drive.start(
        MecanumDriveController,
        **{f"{name}_wheel_command_joint_name": f"{corner}_joint" for name, corner in corners.items()},
        kinematics={"wheels_radius": RADIUS, "sum_of_robot_center_projection_on_X_Y_axis": (LENGTH + WIDTH) / 2.0},
        reference_timeout=TIMEOUT,
    )
    return drive


DRIVES = pytest.mark.parametrize("made", [differential, ackermann, four_wheels])


@DRIVES
async def test_five_metres_straight(stand, made):
    drive = made(stand)
    await drive.drive(5.0, 1.0)
    await drive.pass_by(1.0)
    truth, odometry = drive.truth, drive.odometry
    assert odometry.x == pytest.approx(5.0 + TIMEOUT / 2.0, abs=0.01)
    assert (truth.x, truth.y) == pytest.approx((odometry.x, 0.0), abs=0.05)


@pytest.mark.parametrize("made", [differential, ackermann])
async def test_an_arc(stand, made):
    drive = made(stand)
    await drive.drive(6.0, 0.4, 0.3)
    await drive.pass_by(1.0)
    truth, odometry = drive.truth, drive.odometry
    assert odometry.yaw == pytest.approx(0.3 * (6.0 + TIMEOUT / 2.0), abs=0.05)
    assert (odometry.x, odometry.y, odometry.yaw) == pytest.approx((truth.x, truth.y, truth.yaw), abs=0.04)


@DRIVES
async def test_a_robot_stops_when_commands_stop(stand, made):
    drive = made(stand)
    await drive.drive(1.0, 0.5)
    await drive.pass_by(0.09)
    moving = drive.truth
    await drive.pass_by(1.0)
    stopped = drive.truth
    await drive.pass_by(0.5)
    assert 0.0 < stopped.x - moving.x < 0.1
    assert drive.truth.x == pytest.approx(stopped.x, abs=1e-3)
