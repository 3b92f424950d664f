"""Tricycles: ``libgazebo_ros_tricycle_drive.so``.

One wheel drives and steers; a command is its speed (``linear.x``) and its steering angle (``angular.z``). The odometry
is the true pose, or it is computed from the rotation of the two other wheels.

Source: gazebo_ros_pkgs for ROS 1 (parameters, topics, defaults, formulas). A servo steers, with a limited speed. The
odometry of gazebo_ros_pkgs turns in the wrong direction for wheels with axes to the left; here it does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any

from linkwright.control.odometry import OdometryTopics, create_transform_output, to_planar_velocity, transform_message
from linkwright.diagnostics import phrase
from linkwright.geometry.single import compose, invert
from linkwright.graph.stepped.node import Output
from linkwright.kinematics.drives import DifferentialDrive
from linkwright.kinematics.planar import PlanarPose
from linkwright.messages import Header, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.plugins.gz_drive import MOTOR_GAIN
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class TricycleParameters:
    """Parameters of ``libgazebo_ros_tricycle_drive.so``: sizes in m, accelerations in rad/s2, speeds in rad/s."""

    steering_joint: str = parameter("front_steering_joint", aliases=("steeringJoint",))
    actuated_wheel_joint: str = parameter("front_wheel_joint", aliases=("actuatedWheelJoint",))
    encoder_wheel_left_joint: str = parameter("left_wheel_joint", aliases=("encoderWheelLeftJoint",))
    encoder_wheel_right_joint: str = parameter("right_wheel_joint", aliases=("encoderWheelRightJoint",))
    actuated_wheel_diameter: float = parameter(0.15, aliases=("actuatedWheelDiameter",))
    encoder_wheel_diameter: float = parameter(0.15, aliases=("encoderWheelDiameter",))
    encoder_wheel_separation: float = parameter(0.5, aliases=("encoderWheelSeparation",))
    wheel_torque: float = parameter(5.0, aliases=("wheelTorque",))
    wheel_acceleration: float = parameter(0.0, aliases=("wheelAcceleration",))
    wheel_deceleration: float | None = parameter(None, aliases=("wheelDeceleration",))
    wheel_speed_tolerance: float = parameter(0.01, aliases=("wheelSpeedTolerance",))
    steering_speed: float = parameter(0.0, aliases=("steeringSpeed",))
    update_rate: float = parameter(100.0, aliases=("updateRate",))
    command_topic: str = parameter("cmd_vel", aliases=("commandTopic",))
    odometry_topic: str = parameter("odom", aliases=("odometryTopic",))
    odometry_frame: str = parameter("odom", aliases=("odometryFrame",))
    robot_base_frame: str = parameter("base_link", aliases=("robotBaseFrame",))
    odometry_source: str = parameter("world", aliases=("odometrySource",))
    publish_wheel_tf: bool = parameter(default=False, aliases=("publishWheelTF",))
    publish_wheel_joint_state: bool = parameter(default=False, aliases=("publishWheelJointState",))


class Tricycle(SimulatedPlugin[TricycleParameters]):
    """The substitute for ``libgazebo_ros_tricycle_drive.so``."""

    PARAMETERS = TricycleParameters
    IGNORED = ("steeringAngleTolerance",)
    CARRIED = ("_command", "_speed", "_pose")

    def start(self) -> None:
        """Create the motor, the servo and the topics.

        Raises:
            LinkwrightError: SIM134, there is no such joint; SIM160, a diameter or the separation is not positive.
        """
        parameters, node, simulation = self.parameters, self.node, self.simulation
        names = (
            parameters.steering_joint,
            parameters.actuated_wheel_joint,
            parameters.encoder_wheel_left_joint,
            parameters.encoder_wheel_right_joint,
        )
        self._joints = [self.joint(name) for name in names]
        sizes = (
            parameters.actuated_wheel_diameter,
            parameters.encoder_wheel_diameter,
            parameters.encoder_wheel_separation,
        )
        if not all(size > 0.0 for size in sizes):
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': the separation and the diameter of the wheels must be positive",
                    plugin=self.context.name,
                )
            )
        radius = parameters.encoder_wheel_diameter / 2.0
        self._encoders = DifferentialDrive(parameters.encoder_wheel_separation, radius, radius)
        self._motor = simulation.add_velocity_motor(self._joints[1], MOTOR_GAIN, parameters.wheel_torque)
        speed = (parameters.steering_speed,) if parameters.steering_speed > 0.0 else ()
        self._servo = simulation.add_servo(self._joints[0], *speed)
        simulation.keep_awake(self.first_link)
        self._transforms = create_transform_output(node)
        odometry = node.publisher("nav_msgs/msg/Odometry", parameters.odometry_topic, 1)
        self._topics = OdometryTopics(
            parameters.odometry_frame, parameters.robot_base_frame, odometry, self._transforms
        )
        self._states: Output | None = None
        if parameters.publish_wheel_joint_state:
            self._states = node.publisher("sensor_msgs/msg/JointState", "joint_states", 1000)
        self._command, self._speed, self._pose = (0.0, 0.0), 0.0, PlanarPose()
        self._angles = self._read_angles()
        guard = node.command_guard(self._stop_motion)
        node.subscribe(
            "geometry_msgs/msg/Twist",
            parameters.command_topic,
            self._on_command,
            1,
            command_guard=guard,
            stop_motion=self._stop_motion,
        )
        self.every(parameters.update_rate, self._update)

    def reset(self) -> None:
        """Stop, steer straight on, and reset the odometry."""
        self._command, self._speed, self._pose = (0.0, 0.0), 0.0, PlanarPose()
        self._angles = self._read_angles()
        self._motor.target = 0.0
        self._servo.restart()

    def _on_command(self, twist: Any) -> None:
        self._command = float(twist.linear.x), min(max(float(twist.angular.z), -pi / 2.0), pi / 2.0)

    def _stop_motion(self) -> bool:
        """Stop the wheel, but keep the steering angle; return whether the wheel was commanded to move."""
        speed, angle = self._command
        self._command = 0.0, angle
        return speed != 0.0

    def _read_angles(self) -> tuple[float, float]:
        """Return the angles of the left and the right wheel in rad."""
        left, right = (self.simulation.joint_state(joint)[0] for joint in self._joints[2:])
        return left, right

    def _update(self) -> None:
        parameters, simulation = self.parameters, self.simulation
        rate = parameters.update_rate
        seconds = 1.0 / rate if rate > 0.0 else simulation.step / NANOSECONDS_PER_SECOND
        (left, right), self._angles = self._angles, self._read_angles()
        distance, yaw = self._encoders.motion(self._angles[0] - left, self._angles[1] - right)
        self._pose.advance(distance, 0.0, yaw)
        self._publish(distance / seconds, yaw / seconds)
        speed, angle = self._command
        self._speed = self._limit_speed(speed / (parameters.actuated_wheel_diameter / 2.0), seconds)
        self._motor.target = self._speed
        self._servo.move(angle, seconds)

    def _limit_speed(self, target: float, seconds: float) -> float:
        """Return the speed of the driven wheel for the next period, in rad/s.

        The acceleration limits a decrease of the speed, and the deceleration an increase, as in gazebo_ros_pkgs.
        """
        parameters, current = self.parameters, self.simulation.joint_state(self._joints[1])[1]
        acceleration = parameters.wheel_acceleration
        if acceleration <= 0.0:
            return target
        if abs(current - target) < parameters.wheel_speed_tolerance:
            return current
        if abs(current - target) <= acceleration * seconds:
            return target
        deceleration = acceleration if parameters.wheel_deceleration is None else parameters.wheel_deceleration
        return current - acceleration * seconds if current > target else current + deceleration * seconds

    def _publish(self, forward: float, angular: float) -> None:
        stamp = self.stamp()
        if self.parameters.odometry_source.strip().lower() == "encoder":
            self._topics.publish(stamp, self._pose.transform, forward, 0.0, angular)
        else:
            pose = self.simulation.model_pose(self.context.path)
            velocity = to_planar_velocity(pose, *self.simulation.link_velocity(self.first_link))
            self._topics.publish(stamp, pose, *velocity)
        if self.parameters.publish_wheel_tf:
            self._publish_wheels()
        if self._states is not None and self._states.is_wanted:
            states = [self.simulation.joint_state(joint) for joint in self._joints]
            message = get_message("sensor_msgs/msg/JointState")(header=Header(stamp=stamp))
            message.name = [joint.rpartition(SEPARATOR)[2] for joint in self._joints]
            message.position, message.velocity = [state[0] for state in states], [state[1] for state in states]
            self._states.publish(message)

    def _publish_wheels(self) -> None:
        """Publish the transform of each joint's child link; its frame is named after the joint."""
        for name in self._joints:
            joint = self.simulation.scene.joints[name]
            pose = compose(invert(self.simulation.link_pose(joint.parent)), self.simulation.link_pose(joint.child))
            header = Header(stamp=self.stamp(), frame_id=joint.parent.rpartition(SEPARATOR)[2])
            self._transforms.publish(transform_message(header, name.rpartition(SEPARATOR)[2], pose))
