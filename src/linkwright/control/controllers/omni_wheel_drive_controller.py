"""``omni_wheel_drive_controller/OmniWheelDriveController``: three or more omni wheels.

Source: ros2_controllers (parameters, defaults, topics, the order of wheels). Deliberate differences: odometry follows
arcs, and a command that is not finite stops the robot.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import isfinite

from linkwright.control.controllers.controller import ControllerError, InterfaceNames
from linkwright.control.controllers.drive_controller import DriveController
from linkwright.control.controllers.drive_odometry import OdometryParameters, check_variances, create_odometry
from linkwright.control.controllers.velocity_input import VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.kinematics.drives import OmniDrive
from linkwright.nodes.parameter_tables import above, not_empty, parameter

_NO_VARIANCES = (0.0,) * 6
_MIN_WHEELS = 3


@dataclass(frozen=True, kw_only=True)
class DiagonalCovariance:
    """The variances of the odometry: x, y, z, roll, pitch, yaw."""

    pose: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the pose")
    twist: tuple[float, ...] = parameter(_NO_VARIANCES, description="the variances of the velocity")


@dataclass(frozen=True, kw_only=True)
class OmniWheelParameters(OdometryParameters):
    """The parameters of an omni_wheel_drive_controller."""

    wheel_offset: float = parameter(0.0, description="the angle of the first wheel from x, in rad")
    wheel_names: tuple[str, ...] = parameter(
        (), description="the joints of the wheels, counterclockwise", check=not_empty
    )
    robot_radius: float = parameter(0.0, description="the distance between the center and the wheels, in m")
    wheel_radius: float = parameter(0.0, description="the radius of the wheels, in m")
    diagonal_covariance: DiagonalCovariance = DiagonalCovariance()
    open_loop: bool = parameter(False, description="whether odometry uses wheel commands instead of wheel states")
    position_feedback: bool = parameter(True, description="whether odometry uses wheel positions instead of velocities")
    cmd_vel_timeout: float = parameter(0.5, description="how long a command is valid, in seconds")


class OmniWheelDriveController(DriveController[OmniWheelParameters]):
    """A controller of an omni wheel drive.

    Wheel velocities are computed from velocity commands, sideways motion included, and odometry from the states of the
    wheels.
    """

    PARAMETERS = OmniWheelParameters

    def command_interfaces(self) -> InterfaceNames:
        """Return the wheels' velocity interfaces."""
        return [f"{name}/{VELOCITY}" for name in self.parameters.wheel_names]

    def state_interfaces(self) -> InterfaceNames:
        """Return the position or velocity interfaces of the wheels, or none for open-loop odometry."""
        if self.parameters.open_loop:
            return ()
        kind = POSITION if self.parameters.position_feedback else VELOCITY
        return [f"{name}/{kind}" for name in self.parameters.wheel_names]

    def reference_interfaces(self) -> Sequence[str]:
        """Return the references: the velocities forward and to the left, and the yaw rate.

        Units are m/s and rad/s.
        """
        return ("linear/x/velocity", "linear/y/velocity", "angular/z/velocity")

    def on_configure(self) -> None:
        """Check the parameters, and create the topics.

        Raises:
            ControllerError: there are fewer than three wheels, or a radius is missing.
        """
        parameters, node = self.parameters, self.node
        self._has_angles = parameters.position_feedback
        for name in ("robot_radius", "wheel_radius"):
            problem = above(0.0)(name, getattr(parameters, name))
            if problem is not None:
                raise ControllerError(problem)
        count = len(parameters.wheel_names)
        if count < _MIN_WHEELS:
            raise ControllerError(
                "The number of wheels is less than 3. If there are more wheels please pass them all to the controller "
                "or use a different one for your wheel configuration."
            )
        self._drive = OmniDrive(count, parameters.robot_radius, parameters.wheel_radius, parameters.wheel_offset)
        self._input = VelocityInput(node, "~/cmd_vel", timeout_s=parameters.cmd_vel_timeout)
        covariance = parameters.diagonal_covariance
        self._odometry = create_odometry(
            node,
            parameters,
            "~/odom",
            "/tf",
            pose_variances=check_variances("diagonal_covariance.pose", covariance.pose),
            velocity_variances=check_variances("diagonal_covariance.twist", covariance.twist),
        )
        self._odometry.create_reset_service(node)

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the velocity command into the references, or zeros if there is no valid command."""
        velocity = self._input.velocity(time_ns) or (0.0, 0.0, 0.0)
        for reference, value in zip(self.references, velocity, strict=True):
            reference.value = value

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels, and publish the odometry."""
        forward, sideways, angular = [reference.value for reference in self.references]
        if not all(map(isfinite, (forward, sideways, angular))):
            forward = sideways = angular = 0.0
        for command, value in zip(self.commands, self._drive.wheel_speeds(forward, sideways, angular), strict=True):
            command.value = value
        if self.parameters.open_loop:
            self._odometry.odometer.integrate_command((forward, sideways, angular), period_s)
        else:
            self._measure([state.value for state in self.states], period_s)
        self._odometry.publish(time_ns)

    def _measure(self, values: list[float], period_s: float) -> None:
        """Integrate the measured motion. States that are not finite leave the odometry unchanged."""
        speeds = self._compute_speeds(values, period_s) if all(map(isfinite, values)) else None
        if speeds is not None:
            self._odometry.odometer.measure(self._drive.motion(speeds), period_s)
