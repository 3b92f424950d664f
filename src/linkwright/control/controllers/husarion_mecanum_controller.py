"""Husarion's ``mecanum_drive_controller/MecanumDriveController``.

The controller is for the robots ROSbot XL and Panther.

A different controller of ros2_controllers has the same type name. Husarion's controller has the parameters and topics
of diff_drive_controller, with four named wheels.

Source: husarion_controllers (parameters, defaults, topics). Deliberate differences: odometry multiplies the wheelbase
by its own multiplier, as the wheel commands do, and a wheel state that is not finite leaves the odometry unchanged.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isfinite

from linkwright.control.controllers.controller import ControllerError, InterfaceNames
from linkwright.control.controllers.limited_drive import LimitedDrive, LimitedDriveParameters
from linkwright.control.controllers.speed_limits import NO_LIMITS, SpeedLimits
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.kinematics.drives import MecanumDrive
from linkwright.nodes.parameter_tables import above, not_empty, parameter


@dataclass(frozen=True, kw_only=True)
class LinearLimits:
    """The limits of linear velocities."""

    x: SpeedLimits = NO_LIMITS
    y: SpeedLimits = NO_LIMITS


_NO_LINEAR_LIMITS = LinearLimits()


@dataclass(frozen=True, kw_only=True)
class Parameters(LimitedDriveParameters):
    """The parameters of a Husarion mecanum drive controller."""

    front_left_wheel_name: str = parameter("", description="the joint of the front left wheel")
    front_right_wheel_name: str = parameter("", description="the joint of the front right wheel")
    rear_left_wheel_name: str = parameter("", description="the joint of the rear left wheel")
    rear_right_wheel_name: str = parameter("", description="the joint of the rear right wheel")
    wheel_separation_x: float = parameter(0.0, description="the distance between front and rear wheels, in m")
    wheel_separation_y: float = parameter(0.0, description="the distance between left and right wheels, in m")
    wheel_radius: float = parameter(0.0, description="the radius of the wheels, in m")
    wheel_separation_x_multiplier: float = parameter(1.0, description="a factor for wheel_separation_x")
    wheel_separation_y_multiplier: float = parameter(1.0, description="a factor for wheel_separation_y")
    wheel_radius_multiplier: float = parameter(1.0, description="a factor for wheel_radius")
    use_stamped_vel: bool = parameter(True, description="false to receive ~/cmd_vel_unstamped, too")
    linear: LinearLimits = _NO_LINEAR_LIMITS


class HusarionMecanumController(LimitedDrive[Parameters]):
    """A controller of a mecanum drive.

    Wheel velocities are computed from velocity commands, sideways motion included, and odometry from the states of the
    wheels.
    """

    PARAMETERS = Parameters

    def _list_wheel_interfaces(self, kind: str) -> list[str]:
        parameters = self.parameters
        names = parameters.front_left_wheel_name, parameters.front_right_wheel_name, parameters.rear_left_wheel_name
        return [f"{name}/{kind}" for name in (*names, parameters.rear_right_wheel_name)]

    def command_interfaces(self) -> InterfaceNames:
        """Return the wheels' velocity interfaces: front left, front right, rear left, rear right."""
        return self._list_wheel_interfaces(VELOCITY)

    def state_interfaces(self) -> InterfaceNames:
        """Return the position or velocity interfaces of the wheels, or none for open-loop odometry."""
        if self.parameters.open_loop:
            return ()
        return self._list_wheel_interfaces(POSITION if self.parameters.position_feedback else VELOCITY)

    def limits(self) -> Mapping[str, SpeedLimits]:
        """Return the limits of the velocities forward, to the left, and about z."""
        parameters = self.parameters
        return {"linear.x": parameters.linear.x, "linear.y": parameters.linear.y, "angular.z": parameters.angular.z}

    def on_configure(self) -> None:
        """Check the parameters, and create the topics.

        Raises:
            ControllerError: wheels or their dimensions are missing, or a limit is invalid.
        """
        self._check_parameters()
        parameters = self.parameters
        self._drive = MecanumDrive(
            parameters.wheel_separation_x_multiplier * parameters.wheel_separation_x / 2.0
            + parameters.wheel_separation_y_multiplier * parameters.wheel_separation_y / 2.0,
            parameters.wheel_radius_multiplier * parameters.wheel_radius,
        )
        super().on_configure()

    def _check_parameters(self) -> None:
        parameters = self.parameters
        corners = ("front_left", "front_right", "rear_left", "rear_right")
        names = [f"{corner}_wheel_name" for corner in corners]
        sizes = ("wheel_separation_x", "wheel_separation_y", "wheel_radius")
        problems = [not_empty(name, getattr(parameters, name)) for name in names]
        problems += [above(0.0)(name, getattr(parameters, name)) for name in sizes]
        for problem in problems:
            if problem is not None:
                raise ControllerError(problem)

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry."""
        requested = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        pairs = zip(self._limiters, requested, strict=True)
        forward, sideways, angular = (limiter.approach(speed, period_s) for limiter, speed in pairs)
        speeds = self._drive.wheel_speeds(forward, sideways, angular)
        for command, value in zip(self.commands, speeds, strict=True):
            command.value = value
        if self._settings.open_loop:
            self._odometry.odometer.integrate_command((forward, sideways, angular), period_s)
        else:
            self._measure(period_s)
        self._publish(time_ns, forward, sideways, angular)

    def _measure(self, period_s: float) -> None:
        values = [state.value for state in self.states]
        if not all(map(isfinite, values)):
            return
        speeds = self._compute_speeds(values, period_s)
        if speeds is not None:
            self._odometry.odometer.measure(self._drive.motion(*speeds), period_s)
