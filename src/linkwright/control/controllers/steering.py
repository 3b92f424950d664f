"""The base class of controllers of vehicles with a driven axle and a steered axle.

Source: steering_controllers_library of ros2_controllers, for Humble and Jazzy (parameters with their older names,
defaults, topics, the order of joints: right, left). Deliberate differences: odometry and wheels always use the tangent
of the steering angle, open-loop odometry does not move without a command, and a command that is not finite stops the
vehicle.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, isfinite, nan, pi
from typing import ClassVar, Generic, TypeVar

from linkwright.control.controllers.controller import Controller, ControllerError, InterfaceNames
from linkwright.control.controllers.drive_odometry import DriveOdometry, check_variances
from linkwright.control.controllers.velocity_input import REFERENCE_QOS, VelocityInput
from linkwright.control.hardware.interfaces import POSITION, VELOCITY
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import CarDrive
from linkwright.messages import Header, Time, get_message
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, above, parameter

_DEFAULT_VARIANCES = (0.0, 7.0, 14.0, 21.0, 28.0, 35.0)
_SLOWDOWN_START, _SLOWDOWN_END = pi / 6.0, 1.5608
"""The range of steering errors, in rad, in which the speed of the wheels decreases."""


@dataclass(frozen=True, kw_only=True)
class SteeringParameters:
    """Parameters of all steered vehicles."""

    reference_timeout: float = parameter(1.0, description="how long a command is valid, in seconds; 0 for one update")
    traction_joints_names: tuple[str, ...] = parameter((), description="the driven joints: right, left", only=JAZZY)
    steering_joints_names: tuple[str, ...] = parameter((), description="the steered joints: right, left", only=JAZZY)
    traction_joints_state_names: tuple[str, ...] = parameter(
        (), description="the measured joints, if they differ", only=JAZZY
    )
    steering_joints_state_names: tuple[str, ...] = parameter(
        (), description="the measured joints, if they differ", only=JAZZY
    )
    front_steering: bool = parameter(
        True, description="whether the front wheels steer and the rear wheels drive", only=HUMBLE
    )
    front_wheels_names: tuple[str, ...] = parameter((), description="the joints of the front wheels", only=HUMBLE)
    rear_wheels_names: tuple[str, ...] = parameter((), description="the joints of the rear wheels", only=HUMBLE)
    front_wheels_state_names: tuple[str, ...] = parameter((), description="the measured front joints", only=HUMBLE)
    rear_wheels_state_names: tuple[str, ...] = parameter((), description="the measured rear joints", only=HUMBLE)
    open_loop: bool = parameter(False, description="whether odometry uses commands instead of states")
    reduce_wheel_speed_until_steering_reached: bool = parameter(
        False, description="whether wheels slow down until the steering angle is reached", only=JAZZY
    )
    velocity_rolling_window_size: int = parameter(10, description="the window of the rolling mean of odometry")
    base_frame_id: str = parameter("base_link", description="the frame of the robot")
    odom_frame_id: str = parameter("odom", description="the frame in which the robot moves")
    enable_odom_tf: bool = parameter(True, description="whether the transform of odometry is published")
    twist_covariance_diagonal: tuple[float, ...] = parameter(
        _DEFAULT_VARIANCES, description="the variances of the velocity"
    )
    pose_covariance_diagonal: tuple[float, ...] = parameter(_DEFAULT_VARIANCES, description="the variances of the pose")
    position_feedback: bool = parameter(False, description="whether odometry uses wheel positions, not velocities")
    use_stamped_vel: bool = parameter(True, description="false to receive ~/reference_unstamped, too", only=HUMBLE)
    wheelbase: float = parameter(0.0, description="the distance between the axles, in m")

    def select_traction(self, front: float, rear: float) -> float:
        """Return the value of the driven axle, from the values of the front and the rear axle.

        Humble has parameters for the front and the rear axle.
        """
        return rear if self.front_steering else front

    @property
    def traction_names(self) -> tuple[str, ...]:
        """The names of the driven joints."""
        return self.traction_joints_names or (
            self.rear_wheels_names if self.front_steering else self.front_wheels_names
        )

    @property
    def steering_names(self) -> tuple[str, ...]:
        """The names of the steered joints."""
        return self.steering_joints_names or (
            self.front_wheels_names if self.front_steering else self.rear_wheels_names
        )

    @property
    def traction_state_names(self) -> tuple[str, ...]:
        """The names of the components that provide the states of the driven joints."""
        humble_names = self.rear_wheels_state_names if self.front_steering else self.front_wheels_state_names
        return self.traction_joints_state_names or humble_names or self.traction_names

    @property
    def steering_state_names(self) -> tuple[str, ...]:
        """The names of the components that provide the states of the steered joints."""
        humble_names = self.front_wheels_state_names if self.front_steering else self.rear_wheels_state_names
        return self.steering_joints_state_names or humble_names or self.steering_names


P = TypeVar("P", bound=SteeringParameters)


class SteeringController(Controller[P], Generic[P]):
    """The base class of controllers of steered vehicles.

    Wheel velocities and steering angles are computed from velocity commands, and odometry from the states of the
    joints.

    Attributes:
        VEHICLE: the vehicle's name in error messages.
        JOINT_COUNTS: the number of driven joints, and of steered joints.
    """

    VEHICLE: ClassVar[str]
    JOINT_COUNTS: ClassVar[tuple[int, int]]

    @abstractmethod
    def create_drive(self) -> CarDrive:
        """Return the drive with the dimensions of the vehicle, without checking them."""

    def command_interfaces(self) -> InterfaceNames:
        """Return the velocities of the driven joints, then the positions of the steered joints."""
        parameters = self.parameters
        return [f"{name}/{VELOCITY}" for name in parameters.traction_names] + [
            f"{name}/{POSITION}" for name in parameters.steering_names
        ]

    def state_interfaces(self) -> InterfaceNames:
        """Return the interfaces of the driven joints, then the positions of the steered joints.

        The interfaces of driven joints are velocities, or positions if ``position_feedback`` is set.
        """
        parameters = self.parameters
        kind = POSITION if parameters.position_feedback else VELOCITY
        return [f"{traction_state}/{kind}" for traction_state in parameters.traction_state_names] + [
            f"{steering_state}/{POSITION}" for steering_state in parameters.steering_state_names
        ]

    def reference_interfaces(self) -> Sequence[str]:
        """Return the references: the forward velocity in m/s, and the yaw rate in rad/s."""
        return ("linear/velocity", "angular/velocity")

    def on_configure(self) -> None:
        """Check the parameters, and create the topics.

        Raises:
            ControllerError: the number of joints is wrong, or a dimension is not positive.
        """
        parameters, node = self.parameters, self.node
        self._settings = parameters
        self._check_joints()
        self._drive = self.create_drive()
        for name, value in (("wheelbase", self._drive.wheelbase), ("traction_wheels_radius", self._drive.radius)):
            problem = above(0.0)(name, value)
            if problem is not None:
                raise ControllerError(problem)
        unstamped = "" if parameters.use_stamped_vel else "~/reference_unstamped"
        timeout = parameters.reference_timeout
        self._input = VelocityInput(
            node, "~/reference", timeout_s=timeout, unstamped_topic=unstamped, qos=REFERENCE_QOS
        )
        self._odometry = DriveOdometry(
            node,
            "~/odometry",
            "~/tf_odometry",
            frame=parameters.odom_frame_id,
            child_frame=parameters.base_frame_id,
            pose_variances=check_variances("pose_covariance_diagonal", parameters.pose_covariance_diagonal),
            velocity_variances=check_variances("twist_covariance_diagonal", parameters.twist_covariance_diagonal),
            publishes_transforms=parameters.enable_odom_tf,
            window=parameters.velocity_rolling_window_size,
        )
        self._odometry.create_reset_service(node)
        self._state = node.publisher("control_msgs/msg/SteeringControllerStatus", "~/controller_state")

    def _check_joints(self) -> None:
        parameters, (driven_count, steered_count) = self.parameters, self.JOINT_COUNTS
        for role, needed, names in (
            ("traction", driven_count, parameters.traction_names),
            ("steering", steered_count, parameters.steering_names),
            ("traction state", driven_count, parameters.traction_state_names),
            ("steering state", steered_count, parameters.steering_state_names),
        ):
            if len(names) != needed:
                raise ControllerError(
                    phrase(
                        "{kind} configuration requires exactly {expected_count} {role} joint(s), "
                        "but {count} were provided",
                        kind=self.VEHICLE,
                        expected_count=needed,
                        role=role,
                        count=len(names),
                    )
                )

    def on_activate(self) -> None:
        """Reset the velocities to zero, and accept commands."""
        for reference in self.references:
            reference.value = nan
        self._odometry.odometer.reset_velocity()
        self._last_angles: list[float] | None = None
        self._measured_angle = 0.0
        self._input.open()

    def on_deactivate(self) -> None:
        """Stop the wheels, and keep the steering angle."""
        self._input.close()
        for command in self.commands[: self.JOINT_COUNTS[0]]:
            command.value = 0.0

    def update_references(self, time_ns: int, period_s: float) -> None:
        """Copy the velocity command into the references, or NaN if there is no valid command."""
        velocity = self._input.velocity(time_ns) or (nan, nan, nan)
        forward, angular = self.references
        forward.value, angular.value = velocity[0], velocity[2]

    def update(self, time_ns: int, period_s: float) -> None:
        """Command the wheels and the steering, and publish the odometry."""
        forward, angular = (reference.value for reference in self.references)
        is_finite = isfinite(forward) and isfinite(angular)
        if self._settings.open_loop:
            self._odometry.odometer.integrate_command(
                (forward, 0.0, angular) if is_finite else (0.0, 0.0, 0.0), period_s
            )
        else:
            self._measure(period_s)
        if is_finite:
            self._command_wheels(forward, angular)
        else:
            for command in self.commands[: self.JOINT_COUNTS[0]]:
                command.value = 0.0
        self._odometry.publish(time_ns)
        if self._state.is_wanted:
            self._publish_state(time_ns)
        for reference in self.references:
            reference.value = nan

    def _measure(self, period_s: float) -> None:
        """Update the odometry from wheels and steering, unless a value is not finite."""
        driven_count, steered_count = self.JOINT_COUNTS
        values = [state.value for state in self.states]
        if not all(map(isfinite, values)) or period_s <= 0.0:
            return
        wheels, angles = values[:driven_count], values[driven_count:]
        if self._settings.position_feedback:
            last_angles, self._last_angles = self._last_angles or wheels, wheels
            wheels = [(angle - last_angle) / period_s for angle, last_angle in zip(wheels, last_angles, strict=True)]
        self._measured_angle = self._drive.middle_angle(angles[-1], angles[0]) if steered_count > 1 else angles[0]
        forward, angular = self._drive.motion(wheels[-1], wheels[0], self._measured_angle)
        self._odometry.odometer.measure((forward, 0.0, angular), period_s)

    def _command_wheels(self, forward: float, angular: float) -> None:
        """Command the steering, and wheel velocities that match the measured steering angle.

        In open loop, wheel velocities match the commanded angle.
        """
        parameters, (driven_count, steered_count) = self._settings, self.JOINT_COUNTS
        angle = self._drive.steering_angle(forward, angular)
        wheel_angle = angle if parameters.open_loop else self._measured_angle
        if parameters.reduce_wheel_speed_until_steering_reached:
            error = abs(wheel_angle - angle)
            forward *= cos(min(error, _SLOWDOWN_END)) / cos(_SLOWDOWN_START) if error >= _SLOWDOWN_START else 1.0
        left_speed, right_speed = self._drive.wheel_speeds(forward, wheel_angle)
        angles = self._drive.steering_angles(angle) if steered_count > 1 else (angle,)
        for command, value in zip(
            self.commands, ((right_speed, left_speed)[:driven_count] + angles[::-1]), strict=True
        ):
            command.value = value

    def _publish_state(self, time_ns: int) -> None:
        driven_count = self.JOINT_COUNTS[0]
        states, commands = [state.value for state in self.states], [command.value for command in self.commands]
        wheels: list[float] = states[:driven_count]
        has_positions = self._settings.position_feedback
        status = get_message("control_msgs/msg/SteeringControllerStatus")(
            header=Header(stamp=Time.from_nanoseconds(time_ns), frame_id=self._settings.odom_frame_id),
            traction_wheels_position=wheels if has_positions else [],
            traction_wheels_velocity=[] if has_positions else wheels,
            steer_positions=states[driven_count:],
            linear_velocity_command=commands[:driven_count],
            steering_angle_command=commands[driven_count:],
        )
        self._state.publish(status)
