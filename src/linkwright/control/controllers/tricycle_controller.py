"""``tricycle_controller/TricycleController``: one driven and steered front wheel.

Source: ros2_controllers for Humble and Jazzy (parameters, defaults, topics; the wheel is slow while it is far from its
angle). A deliberate difference: open-loop odometry is computed from the limited commands of the wheel.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, isnan, nan, pi
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.drive_odometry import DriveOdometry, check_variances
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.control.motion.axle_limits import UNLIMITED, SteeringLimiter, TractionLimiter
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import TricycleDrive
from linkwright.kinematics.limits import UNBOUNDED, Bounds
from linkwright.messages import get_message
from linkwright.nodes.parameter_tables import above, not_empty, parameter

_NO_VARIANCES = (0.0,) * 6
_MAX_FULL_SPEED_ERROR, _MIN_CREEP_ERROR = pi / 6.0, pi / 2.0
"""The steering errors, in rad, below which the wheel has its full speed, and above which it hardly moves."""
_CREEP_FRACTION = 0.01
"""The fraction of the speed while the steering angle is far from its target."""


@dataclass(frozen=True, kw_only=True)
class TractionLimits:
    """The limits of the wheel's velocity, in rad/s, and of its derivatives, in both directions."""

    max_velocity: float = nan
    min_velocity: float = nan
    max_acceleration: float = nan
    min_acceleration: float = nan
    max_deceleration: float = nan
    min_deceleration: float = nan
    max_jerk: float = nan
    min_jerk: float = nan


@dataclass(frozen=True, kw_only=True)
class SteeringLimits:
    """The limits of the steering angle, in rad, and of its derivatives.

    The limits of the derivatives apply in both directions.
    """

    max_position: float = nan
    min_position: float = nan
    max_velocity: float = nan
    min_velocity: float = nan
    max_acceleration: float = nan
    min_acceleration: float = nan


_NO_TRACTION_LIMITS, _NO_STEERING_LIMITS = TractionLimits(), SteeringLimits()


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """The parameters of a tricycle_controller."""

    traction_joint_name: str = parameter("", description="the joint that drives the wheel")
    steering_joint_name: str = parameter("", description="the joint that steers the wheel")
    wheelbase: float = parameter(0.0, description="the distance from the wheel to the rear axle, in m")
    wheel_radius: float = parameter(0.0, description="the radius of the wheel, in m")
    odom_frame_id: str = parameter("odom", description="the frame in which the robot moves")
    base_frame_id: str = parameter("base_link", description="the frame of the robot")
    pose_covariance_diagonal: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the pose")
    twist_covariance_diagonal: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the velocity")
    open_loop: bool = parameter(False, description="whether odometry uses commands instead of states")
    enable_odom_tf: bool = parameter(False, description="whether the transform of odometry is published")
    odom_only_twist: bool = parameter(False, description="whether odometry messages contain no pose")
    cmd_vel_timeout: int = parameter(500, description="how long a command is valid, in milliseconds")
    publish_ackermann_command: bool = parameter(False, description="whether ~/cmd_ackermann is published")
    velocity_rolling_window_size: int = parameter(10, description="the window of the rolling mean of odometry")
    use_stamped_vel: bool = parameter(True, description="whether commands have headers")
    traction: TractionLimits = _NO_TRACTION_LIMITS
    steering: SteeringLimits = _NO_STEERING_LIMITS


class TricycleController(Controller[Parameters]):
    """A controller of a tricycle with a driven and steered front wheel.

    The velocity and angle of the wheel are computed from velocity commands. The controller also publishes odometry.
    """

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the wheel's velocity and angle."""
        parameters = self.parameters
        return [f"{parameters.traction_joint_name}/{VELOCITY}", f"{parameters.steering_joint_name}/{POSITION}"]

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the wheel's velocity and angle."""
        return self.command_interfaces()

    def on_configure(self) -> None:
        """Check the parameters, and create the topics and the service.

        Raises:
            ControllerError: joints or dimensions are missing, or limits are invalid.
        """
        parameters, node = self.parameters, self.node
        self._settings = parameters
        for name, check in (
            ("traction_joint_name", not_empty),
            ("steering_joint_name", not_empty),
            ("wheelbase", above(0.0)),
            ("wheel_radius", above(0.0)),
        ):
            problem = check(name, getattr(parameters, name))
            if problem is not None:
                raise ControllerError(problem)
        self._drive = TricycleDrive(parameters.wheelbase, parameters.wheel_radius)
        self._traction_limiter, self._steering_limiter = (
            _create_traction_limiter(parameters.traction),
            _create_steering_limiter(parameters.steering),
        )
        timeout = parameters.cmd_vel_timeout / 1000.0
        unstamped = "" if parameters.use_stamped_vel else "~/cmd_vel"
        self._input = VelocityInput(node, "~/cmd_vel", timeout_s=timeout, unstamped_topic=unstamped)
        self._odometry = DriveOdometry(
            node,
            "~/odom",
            "/tf",
            frame=parameters.odom_frame_id,
            child_frame=parameters.base_frame_id,
            pose_variances=check_variances("pose_covariance_diagonal", parameters.pose_covariance_diagonal),
            velocity_variances=check_variances("twist_covariance_diagonal", parameters.twist_covariance_diagonal),
            publishes_transforms=parameters.enable_odom_tf,
            publishes_pose=not parameters.odom_only_twist,
            window=parameters.velocity_rolling_window_size,
        )
        node.service("std_srvs/srv/Empty", "~/reset_odometry", self._on_reset)
        publishes_command = parameters.publish_ackermann_command
        self._output = (
            node.publisher("ackermann_msgs/msg/AckermannDrive", "~/cmd_ackermann") if publishes_command else None
        )

    def on_activate(self) -> None:
        """Reset the velocities to zero, and accept commands."""
        self._traction_limiter.reset()
        angle = self.states[1].value
        self._steering_limiter.reset(0.0 if isnan(angle) else angle)
        self._odometry.odometer.reset_velocity()
        self._input.open()

    def on_deactivate(self) -> None:
        """Stop the wheel, and steer straight ahead."""
        self._input.close()
        for command in self.commands:
            command.value = 0.0

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheel, and publish the odometry.

        Raises:
            ControllerError: the wheel has no valid state.
        """
        measured_speed, measured_angle = (state.value for state in self.states)
        if isnan(measured_speed) or isnan(measured_angle):
            raise ControllerError(phrase("Could not read feedback value"))
        forward, _, angular = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        speed, angle = self._drive.wheel_command(forward, angular)
        speed = self._traction_limiter.approach(speed * _compute_speed_fraction(abs(angle - measured_angle)), period_s)
        angle = self._steering_limiter.approach(angle, period_s)
        self.commands[0].value, self.commands[1].value = speed, angle
        if self._settings.open_loop:
            forward, angular = self._drive.motion(speed, angle)
            self._odometry.odometer.integrate_command((forward, 0.0, angular), period_s)
        else:
            forward, angular = self._drive.motion(measured_speed, measured_angle)
            self._odometry.odometer.measure((forward, 0.0, angular), period_s)
        self._odometry.publish(time_ns)
        if self._output is not None and self._output.is_wanted:
            command = get_message("ackermann_msgs/msg/AckermannDrive")(steering_angle=angle, speed=speed)
            self._output.publish(command)

    def _on_reset(self, request: Any, response: Any) -> Any:
        self._odometry.odometer.reset()
        return response


def _compute_speed_fraction(error: float) -> float:
    """Return the fraction of the commanded speed for a steering error in rad."""
    if error < _MAX_FULL_SPEED_ERROR:
        return 1.0
    return _CREEP_FRACTION if error > _MIN_CREEP_ERROR else cos(error)


def _create_traction_limiter(limits: TractionLimits) -> TractionLimiter:
    limiter_name = "traction"
    return TractionLimiter(
        _check_magnitude_bounds(limiter_name, "velocity", limits.min_velocity, limits.max_velocity),
        _check_magnitude_bounds(limiter_name, "acceleration", limits.min_acceleration, limits.max_acceleration),
        _check_magnitude_bounds(limiter_name, "deceleration", limits.min_deceleration, limits.max_deceleration),
        _check_magnitude_bounds(limiter_name, "jerk", limits.min_jerk, limits.max_jerk),
    )


def _create_steering_limiter(limits: SteeringLimits) -> SteeringLimiter:
    limiter_name, min_position, max_position = "steering", limits.min_position, limits.max_position
    position = UNBOUNDED
    if not (isnan(min_position) and isnan(max_position)):
        position = (
            -max_position if isnan(min_position) else min_position,
            -min_position if isnan(max_position) else max_position,
        )
    if position[0] > position[1]:
        raise _wrong_order_error(limiter_name, "position")
    return SteeringLimiter(
        position,
        _check_magnitude_bounds(limiter_name, "velocity", limits.min_velocity, limits.max_velocity),
        _check_magnitude_bounds(limiter_name, "acceleration", limits.min_acceleration, limits.max_acceleration),
    )


def _check_magnitude_bounds(limiter_name: str, kind: str, min_value: float, max_value: float) -> Bounds:
    """Return the bounds of a magnitude, with defaults for bounds that are NaN.

    Raises:
        ControllerError: a bound is negative, or the minimum is above the maximum.
    """
    if min_value < 0.0 or max_value < 0.0:
        raise ControllerError(
            phrase(
                "Error configuring {part} limiter: {kind} limits cannot be negative, they are for both directions",
                part=limiter_name,
                kind=kind,
            )
        )
    bounds = (UNLIMITED[0] if isnan(min_value) else min_value, inf if isnan(max_value) else max_value)
    if bounds[0] > bounds[1]:
        raise _wrong_order_error(limiter_name, kind)
    return bounds


def _wrong_order_error(limiter_name: str, kind: str) -> ControllerError:
    return ControllerError(
        phrase(
            "Error configuring {part} limiter: Min {kind} cannot be greater than max {kind}",
            part=limiter_name,
            kind=kind,
        )
    )
