"""Mecanum drive of gz: ``gz-sim-mecanum-drive-system``.

Source: gz-sim (parameters, topics, defaults, wheel speeds, wheel odometry). Unlike gz-sim, the
plugin does not simulate the rollers by anisotropic friction. The wheels slide, and the plugin sets the velocity that
mecanum wheels would give the robot, as `planar_move` does.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import MecanumDrive
from linkwright.kinematics.planar import PlanarPose
from linkwright.simulation.plugins.gz_drive import (
    GZ_RATE_HZ,
    MOTOR_GAIN,
    DriveCommands,
    GzDriveParameters,
    connect_drive,
)
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.planar_move import PlanarDrive
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class MecanumParameters(GzDriveParameters):
    """Parameters of ``gz-sim-mecanum-drive-system``."""

    front_left_joint: tuple[str, ...] = parameter()
    front_right_joint: tuple[str, ...] = parameter()
    back_left_joint: tuple[str, ...] = parameter()
    back_right_joint: tuple[str, ...] = parameter()
    wheel_separation: float = 1.0
    wheelbase: float = 1.0
    wheel_radius: float = 0.2


class GzMecanum(PlanarDrive[MecanumParameters]):
    """The substitute for ``gz-sim-mecanum-drive-system``."""

    PARAMETERS = MecanumParameters
    CARRIED = ("_pose",)

    def start(self) -> None:
        """Create the motors and the odometry topics, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, a joint does not exist; SIM160, a dimension is not positive, or the model is fixed.
        """
        parameters, simulation = self.parameters, self.simulation
        if not (min(parameters.wheel_separation, parameters.wheelbase) > 0.0 and parameters.wheel_radius > 0.0):
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': <wheel_separation>, <wheelbase> and <wheel_radius> must be positive",
                    plugin=self.context.name,
                )
            )
        self.require_free_model()
        joint_names = (
            parameters.front_left_joint,
            parameters.front_right_joint,
            parameters.back_left_joint,
            parameters.back_right_joint,
        )
        joints_by_wheel = [[self.joint(name) for name in names] for names in joint_names]
        for joint in (joint for joints in joints_by_wheel for joint in joints):
            simulation.enable_sliding(joint)
        self._motors = [
            [simulation.add_velocity_motor(joint, MOTOR_GAIN, inf) for joint in joints] for joints in joints_by_wheel
        ]
        self._wheels = [joints[0] for joints in joints_by_wheel]
        self._drive_train = MecanumDrive(
            (parameters.wheel_separation + parameters.wheelbase) / 2.0, parameters.wheel_radius
        )
        self._commands = DriveCommands(parameters)
        self._topics = connect_drive(self, parameters, self._commands)
        self._reset_motion()
        self.every(GZ_RATE_HZ, self._drive)
        self.every(0.0, self._move)
        self.every(parameters.odom_publish_frequency, self._publish)

    def _reset_motion(self) -> None:
        self._pose = PlanarPose()
        self._angles = self._read_wheel_states(0)

    def reset(self) -> None:
        """Stop the robot, and reset the odometry to its origin."""
        self._commands.restart()
        self._reset_motion()
        self._set_wheel_targets((0.0, 0.0, 0.0))

    def resume(self, previous: SimulatedPlugin[MecanumParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(previous)
        assert isinstance(previous, GzMecanum)
        self._commands.resume(previous._commands)

    def _drive(self) -> None:
        self._set_wheel_targets(self._commands.next_velocity())

    def _set_wheel_targets(self, velocity: tuple[float, float, float]) -> None:
        for motors, speed in zip(self._motors, self._drive_train.wheel_speeds(*velocity), strict=True):
            for motor in motors:
                motor.target = speed

    def _read_wheel_states(self, derivative: int) -> list[float]:
        """Return the angles in rad (derivative 0) or velocities in rad/s (1) of the four wheels."""
        return [self.simulation.joint_state(joint)[derivative] for joint in self._wheels]

    def _compute_robot_motion(self, wheel_values: list[float]) -> tuple[float, float, float]:
        """Return the robot's displacement for wheel angles, or its velocity for wheel velocities.

        Wheel angles are in rad, and wheel velocities in rad/s.
        """
        return self._drive_train.motion(*wheel_values)

    def _move(self) -> None:
        old_angles, self._angles = self._angles, self._read_wheel_states(0)
        self._pose.advance(
            *self._compute_robot_motion(
                [new_angle - old_angle for new_angle, old_angle in zip(self._angles, old_angles, strict=True)]
            )
        )
        self.set_planar_velocity(*self._compute_robot_motion(self._read_wheel_states(1)))

    def _publish(self) -> None:
        self._topics.publish(
            self.stamp(), self._pose.transform, *self._compute_robot_motion(self._read_wheel_states(1))
        )
