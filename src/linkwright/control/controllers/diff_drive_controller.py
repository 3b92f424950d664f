"""``diff_drive_controller/DiffDriveController``: a differential drive.

Source: ros2_controllers for Humble and Jazzy (parameters, defaults, topics, messages). Deliberate differences:
open-loop odometry integrates the limited velocity, wheels may start at any angle, and a command that is not finite
stops the robot.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite, isnan

from linkwright.control.controllers.controller import ControllerError, InterfaceNames
from linkwright.control.controllers.limited_drive import LimitedDrive, LimitedDriveParameters
from linkwright.control.controllers.speed_limits import NO_LIMITS, SpeedLimits
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import DifferentialDrive
from linkwright.nodes.parameter_tables import HUMBLE, above, parameter


@dataclass(frozen=True, kw_only=True)
class LinearLimits:
    """The limits of the forward velocity."""

    x: SpeedLimits = NO_LIMITS


@dataclass(frozen=True, kw_only=True)
class Parameters(LimitedDriveParameters):
    """The parameters of a diff_drive_controller."""

    left_wheel_names: tuple[str, ...] = parameter((), description="the joints of the left wheels")
    right_wheel_names: tuple[str, ...] = parameter((), description="the joints of the right wheels")
    wheel_separation: float = parameter(0.0, description="the distance between the left and right wheels, in m")
    wheels_per_side: int = parameter(0, description="no effect: the wheel names determine it", only=HUMBLE)
    wheel_radius: float = parameter(0.0, description="the radius of the wheels, in m")
    wheel_separation_multiplier: float = parameter(1.0, description="a factor for wheel_separation")
    left_wheel_radius_multiplier: float = parameter(1.0, description="a factor for wheel_radius on the left")
    right_wheel_radius_multiplier: float = parameter(1.0, description="a factor for wheel_radius on the right")
    linear: LinearLimits = LinearLimits()


class DiffDriveController(LimitedDrive[Parameters]):
    """A controller of a differential drive.

    Wheel velocities are computed from velocity commands, and odometry from the states of the wheels.
    """

    PARAMETERS = Parameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the velocity interfaces of the left wheels, then of the right wheels."""
        parameters = self.parameters
        return [f"{wheel}/{VELOCITY}" for wheel in (*parameters.left_wheel_names, *parameters.right_wheel_names)]

    def state_interfaces(self) -> InterfaceNames:
        """Return the position or velocity interfaces of the wheels, or none for open-loop odometry."""
        parameters = self.parameters
        if parameters.open_loop:
            return ()
        kind = POSITION if parameters.position_feedback else VELOCITY
        return [f"{wheel}/{kind}" for wheel in (*parameters.left_wheel_names, *parameters.right_wheel_names)]

    def reference_interfaces(self) -> Sequence[str]:
        """Return the references: the forward velocity in m/s, and the yaw rate in rad/s."""
        return ("linear/velocity", "angular/velocity")

    def limits(self) -> Mapping[str, SpeedLimits]:
        """Return the limits of the forward velocity and of the angular velocity about z."""
        return {"linear.x": self.parameters.linear.x, "angular.z": self.parameters.angular.z}

    def on_configure(self) -> None:
        """Check the parameters, and create the topics.

        Raises:
            ControllerError: wheels or their dimensions are missing, or a limit is invalid.
        """
        self._check_wheels()
        parameters = self.parameters
        self._drive = DifferentialDrive(
            parameters.wheel_separation_multiplier * parameters.wheel_separation,
            parameters.left_wheel_radius_multiplier * parameters.wheel_radius,
            parameters.right_wheel_radius_multiplier * parameters.wheel_radius,
        )
        super().on_configure()
        self._odometry.create_reset_service(self.node)

    def _check_wheels(self) -> None:
        parameters = self.parameters
        left_count, right_count = len(parameters.left_wheel_names), len(parameters.right_wheel_names)
        if left_count != right_count:
            raise ControllerError(
                phrase(
                    "The number of left wheels [{left_count}] and the number of right wheels [{right_count}] are "
                    "different",
                    left_count=left_count,
                    right_count=right_count,
                )
            )
        if not left_count:
            raise ControllerError(phrase("Wheel names parameters are empty!"))
        for name in ("wheel_separation", "wheel_radius"):
            problem = above(0.0)(name, getattr(parameters, name))
            if problem is not None:
                raise ControllerError(problem)

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the velocity command into the references, or zero if it is missing or too old."""
        velocity = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        forward, angular = self.references
        forward.value, angular.value = velocity[0], velocity[2]

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry.

        Raises:
            ControllerError: the robot is moving, and a wheel has no valid state.
        """
        requested = [reference.value for reference in self.references]
        if not all(map(isfinite, requested)):
            requested = [0.0, 0.0]
        pairs = zip(self._limiters, requested, strict=True)
        forward, angular = (limiter.approach(speed, period_s) for limiter, speed in pairs)
        left_speed, right_speed = self._drive.wheel_speeds(forward, angular)
        count = len(self.commands) // 2
        for index, command in enumerate(self.commands):
            command.value = left_speed if index < count else right_speed
        if self._settings.open_loop:
            self._odometry.odometer.integrate_command((forward, 0.0, angular), period_s)
        else:
            self._measure(period_s, moves=forward != 0.0 or angular != 0.0)
        self._publish(time_ns, forward, 0.0, angular)

    def _measure(self, period_s: float, *, moves: bool) -> None:
        """Update the odometry with the mean of each side's wheels.

        Missing states are tolerated until the robot moves.
        """
        values = [state.value for state in self.states]
        count = len(values) // 2
        left_mean, right_mean = sum(values[:count]) / count, sum(values[count:]) / count
        if isnan(left_mean) or isnan(right_mean):
            if not moves:
                return
            invalid_index = next(index for index, value in enumerate(values) if isnan(value))
            raise ControllerError(
                phrase(
                    "Either the left or right wheel {kind} is invalid for index [{index}]",
                    kind=self.states[0].kind,
                    index=invalid_index % count,
                )
            )
        speeds = self._compute_speeds([left_mean, right_mean], period_s)
        if speeds is not None:
            forward, angular = self._drive.motion(*speeds)
            self._odometry.odometer.measure((forward, 0.0, angular), period_s)
