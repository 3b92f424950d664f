"""``tricycle_controller/TricycleController``: a vehicle whose front wheel is driven and steered.

Source: ros2_controllers for Humble and Jazzy (parameters, defaults, topics; the wheel is slow while it is far from its
angle). One thing differs: open-loop odometry is computed from the limited commands of the wheel.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, isnan, nan, pi
from typing import Any

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.drive_odometry import DriveOdometry, variances
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.control.motion.axle_limits import ANY, SteeringLimiter, TractionLimiter
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import TricycleDrive
from linkwright.kinematics.limits import UNBOUNDED, Bounds
from linkwright.messages import get_message
from linkwright.nodes.parameter_tables import above, not_empty, parameter

_NONE = (0.0,) * 6
_NEAR, _FAR = pi / 6.0, pi / 2.0
"""Steering errors in rad: below the first the wheel has its commanded speed, beyond the second it hardly moves."""
_CREEPING = 0.01


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


_ANY_TRACTION, _ANY_STEERING = TractionLimits(), SteeringLimits()


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the controller."""

    traction_joint_name: str = parameter("", description="the joint that the wheel turns on")
    steering_joint_name: str = parameter("", description="the joint that the wheel is steered by")
    wheelbase: float = parameter(0.0, description="from the wheel to the axle behind, in m")
    wheel_radius: float = parameter(0.0, description="in m")
    odom_frame_id: str = parameter("odom", description="the frame that the robot moves in")
    base_frame_id: str = parameter("base_link", description="the frame of the robot")
    pose_covariance_diagonal: tuple[float, ...] = parameter(_NONE, description="variances of the pose")
    twist_covariance_diagonal: tuple[float, ...] = parameter(_NONE, description="variances of the velocity")
    open_loop: bool = parameter(False, description="odometry by the commands of the wheel, not by its motion")
    enable_odom_tf: bool = parameter(False, description="whether the transform of odometry is published")
    odom_only_twist: bool = parameter(False, description="odometry without the pose")
    cmd_vel_timeout: int = parameter(500, description="how long a command holds, in milliseconds")
    publish_ackermann_command: bool = parameter(False, description="whether ~/cmd_ackermann is published")
    velocity_rolling_window_size: int = parameter(10, description="window of the rolling mean of odometry")
    use_stamped_vel: bool = parameter(True, description="whether commands have headers")
    traction: TractionLimits = _ANY_TRACTION
    steering: SteeringLimits = _ANY_STEERING


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
            wrong = check(name, getattr(parameters, name))
            if wrong is not None:
                raise ControllerError(wrong)
        self._drive = TricycleDrive(parameters.wheelbase, parameters.wheel_radius)
        self._traction, self._steering = _traction_limiter(parameters.traction), _steering_limiter(parameters.steering)
        timeout = parameters.cmd_vel_timeout / 1000.0
        unstamped = "" if parameters.use_stamped_vel else "~/cmd_vel"
        self._input = VelocityInput(node, "~/cmd_vel", timeout_s=timeout, unstamped=unstamped)
        self._odometry = DriveOdometry(
            node,
            "~/odom",
            "/tf",
            frame=parameters.odom_frame_id,
            child=parameters.base_frame_id,
            of_pose=variances("pose_covariance_diagonal", parameters.pose_covariance_diagonal),
            of_velocity=variances("twist_covariance_diagonal", parameters.twist_covariance_diagonal),
            publishes_transforms=parameters.enable_odom_tf,
            publishes_pose=not parameters.odom_only_twist,
            window=parameters.velocity_rolling_window_size,
        )
        node.service("std_srvs/srv/Empty", "~/reset_odometry", self._reset)
        asked = parameters.publish_ackermann_command
        self._output = node.publisher("ackermann_msgs/msg/AckermannDrive", "~/cmd_ackermann") if asked else None

    def on_activate(self) -> None:
        """Start at rest, and accept commands."""
        self._traction.restart()
        angle = self.states[1].value
        self._steering.restart(0.0 if isnan(angle) else angle)
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
        measured, angle_now = (state.value for state in self.states)
        if isnan(measured) or isnan(angle_now):
            raise ControllerError(phrase("Could not read feedback value"))
        forward, _, angular = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        speed, angle = self._drive.wheel(forward, angular)
        speed = self._traction.follow(speed * _speed_fraction(abs(angle - angle_now)), period_s)
        angle = self._steering.follow(angle, period_s)
        self.commands[0].value, self.commands[1].value = speed, angle
        if self._settings.open_loop:
            forward, angular = self._drive.motion(speed, angle)
            self._odometry.odometer.add_commanded((forward, 0.0, angular), period_s)
        else:
            forward, angular = self._drive.motion(measured, angle_now)
            self._odometry.odometer.measure((forward, 0.0, angular), period_s)
        self._odometry.publish(time_ns)
        if self._output is not None and self._output.is_wanted:
            command = get_message("ackermann_msgs/msg/AckermannDrive")(steering_angle=angle, speed=speed)
            self._output.publish(command)

    def _reset(self, request: Any, response: Any) -> Any:
        self._odometry.odometer.reset()
        return response


def _speed_fraction(error: float) -> float:
    """Return the fraction of the speed at which to drive at a steering error in rad."""
    if error < _NEAR:
        return 1.0
    return _CREEPING if error > _FAR else cos(error)


def _traction_limiter(limits: TractionLimits) -> TractionLimiter:
    part = "traction"
    return TractionLimiter(
        _magnitudes(part, "velocity", limits.min_velocity, limits.max_velocity),
        _magnitudes(part, "acceleration", limits.min_acceleration, limits.max_acceleration),
        _magnitudes(part, "deceleration", limits.min_deceleration, limits.max_deceleration),
        _magnitudes(part, "jerk", limits.min_jerk, limits.max_jerk),
    )


def _steering_limiter(limits: SteeringLimits) -> SteeringLimiter:
    part, least, greatest = "steering", limits.min_position, limits.max_position
    position = UNBOUNDED
    if not (isnan(least) and isnan(greatest)):
        position = (-greatest if isnan(least) else least, -least if isnan(greatest) else greatest)
    if position[0] > position[1]:
        raise _wrong_order(part, "position")
    return SteeringLimiter(
        position,
        _magnitudes(part, "velocity", limits.min_velocity, limits.max_velocity),
        _magnitudes(part, "acceleration", limits.min_acceleration, limits.max_acceleration),
    )


def _magnitudes(part: str, kind: str, least: float, greatest: float) -> Bounds:
    """Return the bounds of a magnitude, with defaults for bounds that are NaN.

    Raises:
        ControllerError: a bound is negative, or the minimum is above the maximum.
    """
    if least < 0.0 or greatest < 0.0:
        raise ControllerError(
            phrase(
                "Error configuring {part} limiter: {kind} limits cannot be negative, they are for both directions",
                part=part,
                kind=kind,
            )
        )
    bounds = (ANY[0] if isnan(least) else least, inf if isnan(greatest) else greatest)
    if bounds[0] > bounds[1]:
        raise _wrong_order(part, kind)
    return bounds


def _wrong_order(part: str, kind: str) -> ControllerError:
    return ControllerError(
        phrase("Error configuring {part} limiter: Min {kind} cannot be greater than max {kind}", part=part, kind=kind)
    )
