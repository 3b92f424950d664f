"""Ackermann steering of gz: ``gz-sim-ackermann-steering-system``.

Source: gz-sim (parameters, topics, defaults, the angles of the wheels, odometry; ``angular.z`` of a command is the yaw
rate of the car). Unlike in gz-sim, the steering speed depends only on the gain, not on the load of the wheel.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan, copysign, cos, sin, tan
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import ackermann_angles
from linkwright.kinematics.planar import PlanarPose
from linkwright.simulation.plugins.gz_drive import (
    GZ_MAX_TORQUE,
    GZ_RATE_HZ,
    MOTOR_GAIN,
    DriveCommands,
    GzDriveParameters,
    connect_drive,
)
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MIN_YAW_RATE = 1e-3
"""A car drives straight ahead if its commanded yaw rate is less than this, in rad/s."""


@dataclass(frozen=True, kw_only=True)
class SteeringParameters(GzDriveParameters):
    """Parameters of ``gz-sim-ackermann-steering-system``."""

    left_joint: tuple[str, ...] = ()
    right_joint: tuple[str, ...] = ()
    left_steering_joint: tuple[str, ...] = parameter()
    right_steering_joint: tuple[str, ...] = parameter()
    wheel_separation: float = 1.0
    kingpin_width: float = 0.8
    wheel_base: float = 1.0
    wheel_radius: float = 0.2
    steering_limit: float = 0.5
    steering_only: bool = False
    sub_topic: str = ""
    steer_p_gain: float = 1.0
    steer_cmd_max: float = 1000.0
    steer_cmd_min: float = -1000.0


class GzAckermann(SimulatedPlugin[SteeringParameters]):
    """The substitute for ``gz-sim-ackermann-steering-system``: drives a car, or only steers it."""

    PARAMETERS = SteeringParameters
    CARRIED = ("_angle", "_pose")
    IGNORED = (
        *("steer_i_gain", "steer_d_gain", "steer_i_max", "steer_i_min", "steer_cmd_offset"),
        *("use_actuator_msg", "actuator_number"),
    )

    def start(self) -> None:
        """Create motors and servos for the wheels, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, a joint does not exist; SIM160, a size is not positive, or a side has no wheel.
        """
        parameters, simulation = self.parameters, self.simulation
        sizes = (parameters.wheel_separation, parameters.wheel_base, parameters.wheel_radius)
        if not (min(sizes) > 0.0 and parameters.left_joint and parameters.right_joint) and not parameters.steering_only:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}' needs wheel joints on both sides, and positive dimensions",
                    plugin=self.context.name,
                )
            )
        joint_names = (parameters.left_joint, parameters.right_joint)
        wheels = [] if parameters.steering_only else [[self.joint(name) for name in names] for names in joint_names]
        steering = [
            [self.joint(name) for name in side]
            for side in (parameters.left_steering_joint, parameters.right_steering_joint)
        ]
        steered_links = {simulation.scene.joints[joint].child for joints in steering for joint in joints}
        for name, scene_joint in simulation.scene.joints.items():
            if scene_joint.parent in steered_links:
                simulation.enable_rolling(name)
        simulation.keep_awake(self.first_link)
        self._odometry_joints = [joints[0] for joints in wheels]
        self._steering_joints = [joints[0] for joints in steering]
        self._motors = [
            [simulation.add_velocity_motor(joint, MOTOR_GAIN, GZ_MAX_TORQUE) for joint in joints] for joints in wheels
        ]
        max_steering_speed = max(parameters.steer_cmd_max, -parameters.steer_cmd_min)
        self._servos = [[simulation.add_servo(joint, max_steering_speed) for joint in joints] for joints in steering]
        self._commands, self._limiter = DriveCommands(parameters), parameters.create_limiter("angular")
        self._angle = 0.0
        self._reset_motion()
        if parameters.steering_only:
            self._subscribe_to_angles()
            self.every(GZ_RATE_HZ, self._steer_only)
            return
        self._topics = connect_drive(self, self._create_drive_parameters(), self._commands)
        self.every(GZ_RATE_HZ, self._drive)
        self.every(parameters.odom_publish_frequency, self._publish)

    def _create_drive_parameters(self) -> SteeringParameters:
        parameters = self.parameters
        model_topic = f"/model/{self.context.path}/{parameters.sub_topic}" if parameters.sub_topic else ""
        return replace(parameters, topic=parameters.topic or model_topic)

    def _subscribe_to_angles(self) -> None:
        parameters = self.parameters
        topic = parameters.topic or f"/model/{self.context.path}/{parameters.sub_topic or 'steer_angle'}"
        self.node.subscribe("std_msgs/msg/Float64", topic, self._on_angle, stop_motion=lambda: None)

    def _on_angle(self, message: Any) -> None:
        self._angle = float(message.data)

    def _reset_motion(self) -> None:
        self._angle = 0.0
        self._pose = PlanarPose()
        self._angles = self._read_wheel_angles()

    def reset(self) -> None:
        """Stop the car, and reset its steering command and its odometry."""
        self._reset_motion()
        self._commands.restart()
        self._limiter.restart()
        for servo in (servo for servos in self._servos for servo in servos):
            servo.restart()
        self._set_wheel_targets(0.0, 0.0)

    def resume(self, previous: SimulatedPlugin[SteeringParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(previous)
        assert isinstance(previous, GzAckermann)
        self._commands.resume(previous._commands)
        self._limiter = previous._limiter

    # --- the wheels ---------------------------------------------------------------------------------------------------

    def _drive(self) -> None:
        """Drive and steer as commanded.

        The inner wheels turn slower and are steered further than the outer wheels.
        """
        self._update_odometry()
        parameters = self.parameters
        forward, _, angular = self._commands.next_velocity()
        curvature = self._compute_curvature(forward, angular)
        offset_ratio = parameters.wheel_separation / 2.0 * curvature
        self._set_wheel_targets(forward * (1.0 - offset_ratio), forward * (1.0 + offset_ratio))
        self._steer(*ackermann_angles(parameters.wheel_base * curvature, parameters.kingpin_width * curvature))

    def _compute_curvature(self, forward: float, angular: float) -> float:
        """Return the commanded curvature in 1/m, clipped to the steering limit.

        A curvature to the left is positive.
        """
        parameters = self.parameters
        max_curvature = sin(parameters.steering_limit) / parameters.wheel_base
        if abs(angular) < _MIN_YAW_RATE:
            return 0.0
        if forward == 0.0:
            return copysign(max_curvature, angular)
        return min(max(angular / forward, -max_curvature), max_curvature)

    def _set_wheel_targets(self, left: float, right: float) -> None:
        for motors, speed in zip(self._motors, (left, right), strict=False):
            for motor in motors:
                motor.target = speed / self.parameters.wheel_radius

    def _steer_only(self) -> None:
        parameters = self.parameters
        angle = self._limiter.approach(self._angle, 1.0 / GZ_RATE_HZ)
        angle = min(max(angle, -parameters.steering_limit), parameters.steering_limit)
        longitudinal, lateral = 2.0 * parameters.wheel_base * cos(angle), parameters.wheel_separation * sin(angle)
        slope = 2.0 * parameters.wheel_base * sin(angle)
        self._steer(atan(slope / (longitudinal - lateral)), atan(slope / (longitudinal + lateral)))

    def _steer(self, left: float, right: float) -> None:
        """Steer towards the angles in rad for one update period.

        The steering speed is the gain times the error, within the limits of the parameters.
        """
        parameters = self.parameters
        for servos, angle in zip(self._servos, (left, right), strict=True):
            for servo in servos:
                speed = parameters.steer_p_gain * (angle - servo.position)
                speed = min(max(speed, parameters.steer_cmd_min), parameters.steer_cmd_max)
                servo.move(servo.position + speed / GZ_RATE_HZ, 1.0 / GZ_RATE_HZ)

    # --- odometry -----------------------------------------------------------------------------------------------------

    def _read_wheel_angles(self) -> tuple[float, ...]:
        return tuple(self.simulation.joint_state(joint)[0] for joint in self._odometry_joints)

    @property
    def _yaw_per_meter(self) -> float:
        """The change of yaw in rad per meter driven, at the measured steering angles."""
        left, right = (self.simulation.joint_state(joint)[0] for joint in self._steering_joints)
        return tan((left + right) / 2.0) / self.parameters.wheel_base

    def _update_odometry(self) -> None:
        """Update the odometry from the rotation of the first wheel on each side."""
        old_angles, self._angles = self._angles, self._read_wheel_angles()
        distance = (
            sum(new_angle - old_angle for new_angle, old_angle in zip(self._angles, old_angles, strict=True))
            / 2.0
            * self.parameters.wheel_radius
        )
        self._pose.advance(distance, 0.0, distance * self._yaw_per_meter)

    def _publish(self) -> None:
        self._update_odometry()
        speeds = [self.simulation.joint_state(joint)[1] for joint in self._odometry_joints]
        forward = sum(speeds) / 2.0 * self.parameters.wheel_radius
        self._topics.publish(self.stamp(), self._pose.transform, forward, 0.0, forward * self._yaw_per_meter)
