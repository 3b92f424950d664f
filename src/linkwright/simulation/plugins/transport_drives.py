"""Drives of Gazebo Classic without ROS: ``libDiffDrivePlugin.so`` and ``libSkidSteerDrivePlugin.so``.

A command is a pose: its x is the forward velocity in m/s, and its yaw the turning rate in rad/s. In Gazebo, the first
drive turns in the wrong direction, and the second one turns twice as fast. Here both turn as commanded, unless Gazebo's
mistakes are requested.

Source: Gazebo Classic (parameters, topic, formulas). The topic of Gazebo's transport is ``geometry_msgs/msg/Pose`` in
the namespace of the model. The wheels have a motor with a limited torque.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import dist
from typing import Any, ClassVar, Generic, TypeVar

from linkwright.diagnostics import phrase
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.kinematics.drives import DifferentialDrive
from linkwright.simulation.plugins.gz_drive import GZ_MAX_TORQUE, MOTOR_GAIN
from linkwright.simulation.plugins.parameters import NoParameters, parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

P = TypeVar("P")


@dataclass(frozen=True, kw_only=True)
class TransportDiffDriveParameters:
    """Parameters of ``libDiffDrivePlugin.so``; the rest is measured."""

    left_joint: str = parameter()
    right_joint: str = parameter()


class _TransportDrive(SimulatedPlugin[P], ABC, Generic[P]):
    """A drive with pairs of wheels, whose separation and radius are those of the model."""

    CARRIED = ("_command",)
    MISTAKEN_FACTOR: ClassVar[float]
    """The factor of the turning rate with Gazebo's mistake."""

    @abstractmethod
    def find_joints(self) -> tuple[list[str], list[str]]:
        """Return the full names of the joints of the left and the right wheels."""

    def start(self) -> None:
        """Measure the wheels, create their motors, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, there is no such joint; SIM160, a wheel has no known radius, or the wheels are at
                the same position.
        """
        simulation, sides = self.simulation, self.find_joints()
        left, right = (simulation.scene.joints[joints[0]].child for joints in sides)
        radius = simulation.wheel_radius(right)
        separation = dist(simulation.link_pose(left)[:3], simulation.link_pose(right)[:3])
        if radius is None or not radius > 0.0:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': the wheel on '{joint}' needs a collision that is a cylinder or a sphere",
                    plugin=self.context.name,
                    joint=sides[1][0],
                )
            )
        if not separation > 0.0:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': its wheels have the same position; place them apart", plugin=self.context.name
                )
            )
        self._drive = DifferentialDrive(separation, radius, radius)
        self._motors = [
            [simulation.add_velocity_motor(joint, MOTOR_GAIN, GZ_MAX_TORQUE) for joint in joints] for joints in sides
        ]
        simulation.keep_awake(self.first_link)
        self.reset()
        guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            "geometry_msgs/msg/Pose",
            f"/{self.context.path}/vel_cmd",
            self._on_command,
            command_guard=guard,
            stop_motion=self._stop_motion,
        )

    def reset(self) -> None:
        """Stop the wheels."""
        self._set_command((0.0, 0.0))

    def resume(self, previous: SimulatedPlugin[P]) -> None:
        """Take over the command of the previous instance."""
        super().resume(previous)
        self._set_command(self._command)

    def _on_command(self, pose: Any) -> None:
        turn = pose.orientation
        yaw = rpy_from_quaternion((turn.x, turn.y, turn.z, turn.w))[2]
        self._set_command((float(pose.position.x), yaw))

    def _stop_motion(self) -> bool:
        old_command = self._command
        self.reset()
        return old_command != (0.0, 0.0)

    def _set_command(self, command: tuple[float, float]) -> None:
        self._command = command
        forward, angular = command
        factor = self.MISTAKEN_FACTOR if self.gazebo_mistakes else 1.0
        speeds = self._drive.wheel_speeds(forward, factor * angular)
        for motors, speed in zip(self._motors, speeds, strict=True):
            for motor in motors:
                motor.target = speed


class TransportDiffDrive(_TransportDrive[TransportDiffDriveParameters]):
    """The substitute for ``libDiffDrivePlugin.so``."""

    PARAMETERS = TransportDiffDriveParameters
    IGNORED = ("torque",)
    MISTAKEN_FACTOR = -1.0

    def find_joints(self) -> tuple[list[str], list[str]]:
        """Return the full names of the joints of the left and the right wheel."""
        return [self.joint(self.parameters.left_joint)], [self.joint(self.parameters.right_joint)]


class TransportSkidSteer(_TransportDrive[NoParameters]):
    """The substitute for ``libSkidSteerDrivePlugin.so``, whose joints have fixed names."""

    MISTAKEN_FACTOR = 2.0

    def find_joints(self) -> tuple[list[str], list[str]]:
        """Return the full names of the joints of the left and the right wheels."""
        left, right = ([self.joint(f"{side}_{end}") for end in ("front", "rear")] for side in ("left", "right"))
        return left, right
