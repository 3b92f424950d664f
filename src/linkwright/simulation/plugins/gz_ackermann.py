"""Ackermann steering of gz: ``gz-sim-ackermann-steering-system``.

Source: gz-sim (parameters, topics, defaults, the angles of the wheels, odometry; ``angular.z`` of a command is the yaw
rate of the car). Unlike in gz-sim, the gain determines how fast a wheel is steered to its angle, whatever the load.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import atan, copysign, cos, sin, tan
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import ackermann_angles
from linkwright.kinematics.planar import PlanarPose
from linkwright.simulation.plugins.gz_drive import (
    GZ_RATE,
    GZ_TORQUE,
    MOTOR_GAIN,
    DriveCommands,
    GzDriveParameters,
    connect_drive,
)
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_SLOW = 1e-3
"""A car that is to turn no faster than this, in rad/s, goes straight ahead."""


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
    CARRIED = ("_angle", "_place")
    IGNORED = (
        *("steer_i_gain", "steer_d_gain", "steer_i_max", "steer_i_min", "steer_cmd_offset"),
        *("use_actuator_msg", "actuator_number"),
    )

    def start(self) -> None:
        """Create motors and servos for the wheels, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, a joint does not exist; SIM160, a dimension is not positive, or no wheel is named.
        """
        parameters, simulation = self.parameters, self.simulation
        sizes = (parameters.wheel_separation, parameters.wheel_base, parameters.wheel_radius)
        if not (min(sizes) > 0.0 and parameters.left_joint and parameters.right_joint) and not parameters.steering_only:
            raise self.parameter_error(
                phrase("plugin '{plugin}' needs wheel joints and positive dimensions", plugin=self.place.name)
            )
        sides = (parameters.left_joint, parameters.right_joint)
        wheels = [] if parameters.steering_only else [[self.joint(name) for name in side] for side in sides]
        steering = [
            [self.joint(name) for name in side]
            for side in (parameters.left_steering_joint, parameters.right_steering_joint)
        ]
        steered = {simulation.scene.joints[joint].child for side in steering for joint in side}
        for name, placed in simulation.scene.joints.items():
            if placed.parent in steered:
                simulation.let_roll(name)
        simulation.keep_awake(self.first_link)
        self._turned = [joints[0] for joints in wheels]
        self._steering = [joints[0] for joints in steering]
        self._motors = [
            [simulation.add_velocity_motor(joint, MOTOR_GAIN, GZ_TORQUE) for joint in joints] for joints in wheels
        ]
        greatest = max(parameters.steer_cmd_max, -parameters.steer_cmd_min)
        self._servos = [[simulation.add_servo(joint, greatest) for joint in joints] for joints in steering]
        self._commands, self._limiter = DriveCommands(parameters), parameters.limiter("angular")
        self._angle = 0.0
        self._begin()
        if parameters.steering_only:
            self._listen_to_angles()
            self.every(GZ_RATE, self._steer_only)
            return
        self._topics = connect_drive(self, self._with_topic(), self._commands)
        self.every(GZ_RATE, self._drive)
        self.every(parameters.odom_publish_frequency, self._publish)

    def _with_topic(self) -> SteeringParameters:
        parameters = self.parameters
        inside = f"/model/{self.place.path}/{parameters.sub_topic}" if parameters.sub_topic else ""
        return replace(parameters, topic=parameters.topic or inside)

    def _listen_to_angles(self) -> None:
        parameters = self.parameters
        topic = parameters.topic or f"/model/{self.place.path}/{parameters.sub_topic or 'steer_angle'}"
        self.node.subscribe("std_msgs/msg/Float64", topic, self._receive_angle, rest=lambda: None)

    def _receive_angle(self, message: Any) -> None:
        self._angle = float(message.data)

    def _begin(self) -> None:
        self._angle = 0.0
        self._place = PlanarPose()
        self._angles = self._wheel_angles()

    def reset(self) -> None:
        """Stop the car, with the wheels straight ahead."""
        self._begin()
        self._commands.restart()
        self._limiter.restart()
        for servo in (servo for side in self._servos for servo in side):
            servo.restart()
        self._turn_wheels(0.0, 0.0)

    def resume(self, before: SimulatedPlugin[SteeringParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(before)
        assert isinstance(before, GzAckermann)
        self._commands.resume(before._commands)
        self._limiter = before._limiter

    # --- the wheels ---------------------------------------------------------------------------------------------------

    def _drive(self) -> None:
        """Drive and steer as commanded; the inner wheels turn more slowly and are steered further."""
        self._measure()
        parameters = self.parameters
        forward, _, angular = self._commands.next_velocity()
        curvature = self._curvature(forward, angular)
        half = parameters.wheel_separation / 2.0 * curvature
        self._turn_wheels(forward * (1.0 - half), forward * (1.0 + half))
        self._steer(*ackermann_angles(parameters.wheel_base * curvature, parameters.kingpin_width * curvature))

    def _curvature(self, forward: float, angular: float) -> float:
        """Return the commanded curvature in 1/m, positive to the left, clipped to the steering limit."""
        parameters = self.parameters
        greatest = sin(parameters.steering_limit) / parameters.wheel_base
        if abs(angular) < _SLOW:
            return 0.0
        if forward == 0.0:
            return copysign(greatest, angular)
        return min(max(angular / forward, -greatest), greatest)

    def _turn_wheels(self, left: float, right: float) -> None:
        for motors, speed in zip(self._motors, (left, right), strict=False):
            for motor in motors:
                motor.target = speed / self.parameters.wheel_radius

    def _steer_only(self) -> None:
        parameters = self.parameters
        angle = self._limiter.follow(self._angle, 1.0 / GZ_RATE)
        angle = min(max(angle, -parameters.steering_limit), parameters.steering_limit)
        along, across = 2.0 * parameters.wheel_base * cos(angle), parameters.wheel_separation * sin(angle)
        slope = 2.0 * parameters.wheel_base * sin(angle)
        self._steer(atan(slope / (along - across)), atan(slope / (along + across)))

    def _steer(self, left: float, right: float) -> None:
        """Steer towards the angles in rad for one update period.

        The steering speed is the gain times the error, within the limits of the parameters.
        """
        parameters = self.parameters
        for servos, angle in zip(self._servos, (left, right), strict=True):
            for servo in servos:
                speed = parameters.steer_p_gain * (angle - servo.position)
                speed = min(max(speed, parameters.steer_cmd_min), parameters.steer_cmd_max)
                servo.move(servo.position + speed / GZ_RATE, 1.0 / GZ_RATE)

    # --- odometry -----------------------------------------------------------------------------------------------------

    def _wheel_angles(self) -> tuple[float, ...]:
        return tuple(self.simulation.joint_state(joint)[0] for joint in self._turned)

    @property
    def _turn(self) -> float:
        """The change of yaw in rad per metre driven, at the measured steering angles."""
        left, right = (self.simulation.joint_state(joint)[0] for joint in self._steering)
        return tan((left + right) / 2.0) / self.parameters.wheel_base

    def _measure(self) -> None:
        """Update the odometry from the rotation of the first wheel on each side."""
        before, self._angles = self._angles, self._wheel_angles()
        way = sum(new - old for new, old in zip(self._angles, before, strict=True)) / 2.0 * self.parameters.wheel_radius
        self._place.advance(way, 0.0, way * self._turn)

    def _publish(self) -> None:
        self._measure()
        speeds = [self.simulation.joint_state(joint)[1] for joint in self._turned]
        forward = sum(speeds) / 2.0 * self.parameters.wheel_radius
        self._topics.publish(self.stamp(), self._place.transform, forward, 0.0, forward * self._turn)
