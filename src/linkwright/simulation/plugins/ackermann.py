"""Ackermann steering of Gazebo classic: ``libgazebo_ros_ackermann_drive.so``.

Source: gazebo_ros_pkgs for ROS 2 (parameters, topics, defaults, the angles of the wheels; ``angular.z`` of a command is
the steering angle). Unlike in gazebo_ros_pkgs, servos hold the front wheels at their angles, and the steering gains
have no effect. The torque of each rear wheel is limited to the torque at which the wheel would slip.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, dist, hypot, tan
from typing import Any

from linkwright.control.odometry import OdometryTopics, create_transform_output, planar_variances, to_planar_velocity
from linkwright.diagnostics import phrase
from linkwright.kinematics.drives import ackermann_angles
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_MOTOR_GAIN = 20.0
"""The gain of a wheel motor, in N m of torque per rad/s of velocity error."""
_GRAVITY_M_S2 = 9.81
"""The acceleration of gravity in m/s2."""


@dataclass(frozen=True, kw_only=True)
class AckermannParameters:
    """Parameters of ``libgazebo_ros_ackermann_drive.so``."""

    front_left_joint: str = "front_left_joint"
    front_right_joint: str = "front_right_joint"
    rear_left_joint: str = "rear_left_joint"
    rear_right_joint: str = "rear_right_joint"
    left_steering_joint: str = "left_steering_joint"
    right_steering_joint: str = "right_steering_joint"
    max_speed: float = 20.0
    max_steer: float = 0.6
    update_rate: float = 100.0
    odometry_frame: str = "odom"
    robot_base_frame: str = "base_footprint"
    publish_odom: bool = False
    publish_odom_tf: bool = False
    publish_distance: bool = False
    covariance_x: float = 1e-5
    covariance_y: float = 1e-5
    covariance_yaw: float = 1e-3


class ClassicAckermann(SimulatedPlugin[AckermannParameters]):
    """The substitute for ``libgazebo_ros_ackermann_drive.so``: drives and steers a car."""

    PARAMETERS = AckermannParameters
    CARRIED = ("_speed", "_angle", "_distance")
    IGNORED = (
        *("left_steering_pid_gain", "right_steering_pid_gain", "linear_velocity_pid_gain"),
        *("left_steering_i_range", "right_steering_i_range", "linear_velocity_i_range"),
        *("steering_wheel_joint", "max_steering_angle", "publish_wheel_tf"),
    )

    def start(self) -> None:
        """Create motors and servos for the wheels, and subscribe to the commands.

        Raises:
            LinkwrightError: SIM134, a joint does not exist; SIM160, a wheel has no known radius, or the track or the
                wheelbase is zero.
        """
        parameters, node, simulation = self.parameters, self.node, self.simulation
        front = [self.joint(name) for name in (parameters.front_left_joint, parameters.front_right_joint)]
        rear = [self.joint(name) for name in (parameters.rear_left_joint, parameters.rear_right_joint)]
        steering = [self.joint(name) for name in (parameters.left_steering_joint, parameters.right_steering_joint)]
        for joint in (*front, *rear):
            simulation.enable_rolling(joint)
        self._radius = self._get_wheel_radius(rear[1])
        self._measure_geometry(front, rear)
        simulation.keep_awake(self.first_link)
        torque = simulation.mass_of(self.context.path) * _GRAVITY_M_S2 * self._radius / 2.0
        self._motors = [simulation.add_velocity_motor(joint, _MOTOR_GAIN, torque) for joint in rear]
        self._servos = [simulation.add_servo(joint) for joint in steering]
        odometry = node.publisher("nav_msgs/msg/Odometry", "odom", 1) if parameters.publish_odom else None
        transforms = create_transform_output(node) if parameters.publish_odom_tf else None
        variances = planar_variances(parameters.covariance_x, parameters.covariance_y, parameters.covariance_yaw)
        self._topics = OdometryTopics(
            parameters.odometry_frame, parameters.robot_base_frame, odometry, transforms, variances
        )
        self._distance_topic = (
            node.publisher("std_msgs/msg/Float32", "distance", 1) if parameters.publish_distance else None
        )
        command_guard = node.command_guard(self._stop_motion)
        node.subscribe(
            "geometry_msgs/msg/Twist",
            "cmd_vel",
            self._on_command,
            1,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self._reset_motion()
        self.every(parameters.update_rate, self._update)

    def _reset_motion(self) -> None:
        self._speed = self._angle = self._distance = 0.0
        self._pose = self.simulation.model_pose(self.context.path)
        self._time = self.simulation.time

    def reset(self) -> None:
        """Stop the car, and reset its steering angle and the traveled distance."""
        self._reset_motion()
        for servo in self._servos:
            servo.restart()
        self._drive(0.0)

    def _get_wheel_radius(self, joint: str) -> float:
        radius = self.simulation.wheel_radius(self.simulation.scene.joints[joint].child)
        if radius is None:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': the wheel on '{joint}' needs a collision that is a cylinder or a sphere",
                    plugin=self.context.name,
                    joint=self.parameters.rear_right_joint,
                )
            )
        return radius

    def _measure_geometry(self, front: list[str], rear: list[str]) -> None:
        """Measure the track of the front wheels and the wheelbase, in m.

        Raises an error if either is zero.
        """
        simulation = self.simulation
        left, right, rear_left, rear_right = (
            simulation.link_pose(simulation.scene.joints[joint].child)[:3] for joint in (*front, *rear)
        )
        self._track_width = dist(left, right)
        self._wheelbase = dist(
            [(a + b) / 2.0 for a, b in zip(left, right, strict=True)],
            [(a + b) / 2.0 for a, b in zip(rear_left, rear_right, strict=True)],
        )
        if not (self._track_width > 0.0 and self._wheelbase > 0.0):
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': its wheels have the same position; place them apart", plugin=self.context.name
                )
            )

    def _on_command(self, twist: Any) -> None:
        parameters = self.parameters
        self._speed = min(max(float(twist.linear.x), -parameters.max_speed), parameters.max_speed)
        angle = float(twist.angular.z) * copysign(1.0, self._speed)
        self._angle = min(max(angle, -parameters.max_steer), parameters.max_steer)

    def _stop_motion(self) -> bool:
        """Stop the car but keep the steering angle.

        Returns whether the car was commanded to move.
        """
        old_speed, self._speed = self._speed, 0.0
        return old_speed != 0.0

    def _update(self) -> None:
        now = self.simulation.time
        seconds, self._time = (now - self._time) / NANOSECONDS_PER_SECOND, now
        self._drive(seconds)
        old_pose, self._pose = self._pose, self.simulation.model_pose(self.context.path)
        self._distance += hypot(self._pose[0] - old_pose[0], self._pose[1] - old_pose[1])
        velocity = to_planar_velocity(self._pose, *self.simulation.link_velocity(self.first_link))
        self._topics.publish(self.stamp(), self._pose, *velocity)
        if self._distance_topic is not None:
            self._distance_topic.publish(get_message("std_msgs/msg/Float32")(data=self._distance))

    def _drive(self, seconds: float) -> None:
        """Set the speeds of the rear wheels, and steer towards the commanded angle for `seconds`.

        The inner front wheel is steered further than the outer one, so that both roll about one point.
        """
        for motor in self._motors:
            motor.target = self._speed / self._radius
        slope = tan(self._angle)
        angles = ackermann_angles(slope, self._track_width / self._wheelbase * slope)
        for servo, angle in zip(self._servos, angles, strict=True):
            servo.move(angle, seconds)
