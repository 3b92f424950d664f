"""``mecanum_drive_controller/MecanumDriveController``: a drive of four mecanum wheels.

Source: ros2_controllers for Jazzy (parameters, defaults, topics, the order of wheels). Deliberate differences: odometry
follows arcs, and a command that is not finite stops the robot.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from math import cos, isfinite, nan, sin
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.drive_controller import DriveController
from linkwright.control.controllers.drive_odometry import OdometryParameters, check_variances, create_odometry
from linkwright.control.controllers.husarion_mecanum_controller import HusarionMecanumController, LinearLimits
from linkwright.control.controllers.limited_drive import AngularLimits
from linkwright.control.controllers.velocity_input import REFERENCE_QOS, VelocityInput
from linkwright.control.hardware.interfaces import VELOCITY
from linkwright.kinematics.drives import MecanumDrive
from linkwright.messages import Header, Time, Vector3, get_message
from linkwright.nodes.parameter_tables import above, not_empty, parameter

_DEFAULT_VARIANCES = (0.0, 7.0, 14.0, 21.0, 28.0, 35.0)


@dataclass(frozen=True, kw_only=True)
class BaseFrameOffset:
    """The pose of the robot's frame relative to the center of the wheels, in m and rad."""

    x: float = 0.0
    y: float = 0.0
    theta: float = 0.0


_NO_OFFSET = BaseFrameOffset()


@dataclass(frozen=True, kw_only=True)
class Kinematics:
    """The dimensions of the drive."""

    base_frame_offset: BaseFrameOffset = _NO_OFFSET
    wheels_radius: float = parameter(0.0, description="the radius of the wheels, in m")
    sum_of_robot_center_projection_on_X_Y_axis: float = parameter(  # noqa: N815 - the name in ros2_controllers
        0.0, description="half the wheelbase plus half the track, in m"
    )


_NO_KINEMATICS = Kinematics()
_NO_LINEAR_LIMITS = LinearLimits()
_NO_ANGULAR_LIMITS = AngularLimits()


@dataclass(frozen=True, kw_only=True)
class Parameters(OdometryParameters):
    """The parameters of a mecanum_drive_controller."""

    reference_timeout: float = parameter(0.0, description="how long a command is valid, in seconds; 0 for one update")
    front_left_wheel_command_joint_name: str = parameter("", description="the joint of the wheel")
    front_right_wheel_command_joint_name: str = parameter("", description="the joint of the wheel")
    rear_right_wheel_command_joint_name: str = parameter("", description="the joint of the wheel")
    rear_left_wheel_command_joint_name: str = parameter("", description="the joint of the wheel")
    front_left_wheel_state_joint_name: str = parameter("", description="the measured joint, if it differs")
    front_right_wheel_state_joint_name: str = parameter("", description="the measured joint, if it differs")
    rear_right_wheel_state_joint_name: str = parameter("", description="the measured joint, if it differs")
    rear_left_wheel_state_joint_name: str = parameter("", description="the measured joint, if it differs")
    kinematics: Kinematics = _NO_KINEMATICS
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        _DEFAULT_VARIANCES, description="the variances of the velocity"
    )
    pose_covariance_diagonal: tuple[float, ...] = parameter(_DEFAULT_VARIANCES, description="the variances of the pose")
    linear: LinearLimits = _NO_LINEAR_LIMITS
    angular: AngularLimits = _NO_ANGULAR_LIMITS


_CORNERS = ("front_left", "front_right", "rear_right", "rear_left")


class MecanumDriveController(DriveController[Parameters]):
    """A controller of a mecanum drive.

    Wheel velocities are computed from velocity commands, sideways motion included, and odometry from the states of the
    wheels.
    """

    PARAMETERS = Parameters

    @classmethod
    def variant(cls, parameter_names: Collection[str]) -> type[Controller[Any]]:
        """Return Husarion's controller if its parameters are set, and this class otherwise.

        Both controllers have the same type name.
        """
        return HusarionMecanumController if "front_left_wheel_name" in parameter_names else cls

    def command_interfaces(self) -> InterfaceNames:
        """Return the wheels' velocity interfaces: front left, front right, rear right, rear left."""
        return [f"{name}/{VELOCITY}" for name in self._list_joint_names("command")]

    def state_interfaces(self) -> InterfaceNames:
        """Return the wheels' velocity interfaces: front left, front right, rear right, rear left."""
        pairs = zip(self._list_joint_names("state"), self._list_joint_names("command"), strict=True)
        return [f"{measured or commanded}/{VELOCITY}" for measured, commanded in pairs]

    def _list_joint_names(self, kind: str) -> list[str]:
        return [getattr(self.parameters, f"{corner}_wheel_{kind}_joint_name") for corner in _CORNERS]

    def reference_interfaces(self) -> Sequence[str]:
        """Return the references: the velocities forward and to the left, and the yaw rate.

        Units are m/s and rad/s.
        """
        return ("linear/x/velocity", "linear/y/velocity", "angular/z/velocity")

    def on_configure(self) -> None:
        """Check the parameters, and create the topics.

        Raises:
            ControllerError: wheels or their dimensions are missing, or a limit is invalid.
        """
        parameters, node = self.parameters, self.node
        self._settings, kinematics = parameters, parameters.kinematics
        problems = [
            not_empty(f"{corner}_wheel_command_joint_name", name)
            for corner, name in zip(_CORNERS, self._list_joint_names("command"), strict=True)
        ]
        problems += [
            above(0.0)(f"kinematics.{name}", getattr(kinematics, name))
            for name in ("wheels_radius", "sum_of_robot_center_projection_on_X_Y_axis")
        ]
        for problem in problems:
            if problem is not None:
                raise ControllerError(problem)
        self._drive = MecanumDrive(kinematics.sum_of_robot_center_projection_on_X_Y_axis, kinematics.wheels_radius)
        linear = parameters.linear
        axes = {"linear.x": linear.x, "linear.y": linear.y, "angular.z": parameters.angular.z}
        self._limiters = [limits.create_limiter(axis) for axis, limits in axes.items()]
        timeout = parameters.reference_timeout
        self._input = VelocityInput(node, "~/reference", timeout_s=timeout, qos=REFERENCE_QOS)
        self._odometry = create_odometry(
            node,
            parameters,
            "~/odometry",
            "~/tf_odometry",
            pose_variances=check_variances("pose_covariance_diagonal", parameters.pose_covariance_diagonal),
            velocity_variances=check_variances("twist_covariance_diagonal", parameters.twist_covariance_diagonal),
        )
        self._odometry.create_reset_service(node)
        self._state = node.publisher("control_msgs/msg/MecanumDriveControllerState", "~/controller_state")

    def on_activate(self) -> None:
        """Reset the velocities to zero, and accept commands."""
        self._restart_limiters()
        super().on_activate()

    def _restart_limiters(self) -> None:
        for limiter in self._limiters:
            limiter.restart()

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the velocity command into the references, or NaN if there is no valid command."""
        velocity = self._input.velocity(time_ns) or (nan, nan, nan)
        for reference, value in zip(self.references, velocity, strict=True):
            reference.value = value

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry."""
        front_left, front_right, rear_right, rear_left = measured = [state.value for state in self.states]
        if all(map(isfinite, measured)):
            motion = self._drive.motion(front_left, front_right, rear_left, rear_right)
            self._odometry.odometer.measure(self._to_base_velocity(*motion), period_s)
        requested = [reference.value for reference in self.references]
        self._command_wheels(self._limit_velocity(requested, period_s))
        self._odometry.publish(time_ns)
        if self._state.is_wanted:
            self._publish_state(time_ns, measured, requested)
        for reference in self.references:
            reference.value = nan

    def _limit_velocity(self, requested: list[float], period_s: float) -> list[float]:
        """Return the velocities within the limits.

        If a requested velocity is not finite, all are 0 at once, without limits of the acceleration.
        """
        if not all(map(isfinite, requested)):
            self._restart_limiters()
            return [0.0] * len(requested)
        pairs = zip(self._limiters, requested, strict=True)
        return [limiter.approach(speed, period_s) for limiter, speed in pairs]

    def _command_wheels(self, velocity: list[float]) -> None:
        forward, sideways, angular = velocity
        offset = self._settings.kinematics.base_frame_offset
        forward_at_wheels, sideways_at_wheels = _rotate(forward, sideways, offset.theta)
        speeds = self._drive.wheel_speeds(
            forward_at_wheels + offset.y * angular, sideways_at_wheels - offset.x * angular, angular
        )
        front_left, front_right, rear_left, rear_right = speeds
        for command, value in zip(self.commands, (front_left, front_right, rear_right, rear_left), strict=True):
            command.value = value

    def _to_base_velocity(self, forward: float, sideways: float, angular: float) -> tuple[float, float, float]:
        """Return the velocity of the robot's frame from the velocity of the wheels' center."""
        offset = self._settings.kinematics.base_frame_offset
        base_forward, base_sideways = _rotate(
            forward - offset.y * angular, sideways + offset.x * angular, -offset.theta
        )
        return base_forward, base_sideways, angular

    def _publish_state(self, time_ns: int, measured: list[float], requested: list[float]) -> None:
        front_left, front_right, rear_right, rear_left = measured
        state = get_message("control_msgs/msg/MecanumDriveControllerState")(
            header=Header(stamp=Time.from_nanoseconds(time_ns), frame_id=self._odometry.frame),
            front_left_wheel_velocity=front_left,
            front_right_wheel_velocity=front_right,
            back_right_wheel_velocity=rear_right,
            back_left_wheel_velocity=rear_left,
        )
        state.reference_velocity.linear = Vector3(x=requested[0], y=requested[1], z=0.0)
        state.reference_velocity.angular = Vector3(x=0.0, y=0.0, z=requested[2])
        self._state.publish(state)


def _rotate(x: float, y: float, angle: float) -> tuple[float, float]:
    """Return a vector rotated by an angle in rad."""
    return x * cos(angle) - y * sin(angle), x * sin(angle) + y * cos(angle)
