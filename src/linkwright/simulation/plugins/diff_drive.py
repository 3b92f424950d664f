"""Differential drive: ``libgazebo_ros_diff_drive.so`` and ``gz-sim-diff-drive-system``.

Source: gazebo_ros_pkgs for ROS 2 and gz-sim (parameters, topics, defaults, the limiter, odometry). In gazebo_ros_pkgs,
the wheel odometry of a robot that drives backward has a positive velocity. Here the velocity is negative, unless
Gazebo's mistakes are requested.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from math import inf
from typing import Any, ClassVar, Generic, TypeVar

from linkwright.control.odometry import (
    OdometryTopics,
    create_transform_output,
    planar_variances,
    to_planar_velocity,
    transform_message,
)
from linkwright.diagnostics import phrase
from linkwright.geometry.single import compose, invert
from linkwright.graph.stepped.node import Output
from linkwright.kinematics.drives import DifferentialDrive
from linkwright.kinematics.planar import PlanarPose
from linkwright.messages import Header
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import SEPARATOR
from linkwright.simulation.actuators import Motor
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

P = TypeVar("P")

_WORLD_ODOMETRY_SOURCE = 1


@dataclass(frozen=True, kw_only=True)
class ClassicParameters:
    """Parameters of ``libgazebo_ros_diff_drive.so``."""

    left_joint: tuple[str, ...] = parameter(aliases=("leftJoint",))
    right_joint: tuple[str, ...] = parameter(aliases=("rightJoint",))
    num_wheel_pairs: int = 1
    wheel_separation: tuple[float, ...] = parameter((0.34,), aliases=("wheelSeparation",))
    wheel_diameter: tuple[float, ...] = parameter((0.15,), aliases=("wheelDiameter",))
    max_wheel_torque: float = parameter(5.0, aliases=("wheelTorque", "torque"))
    max_wheel_acceleration: float = parameter(0.0, aliases=("wheelAcceleration",))
    update_rate: float = parameter(100.0, aliases=("updateRate",))
    command_topic: str = parameter("cmd_vel", aliases=("commandTopic",))
    odometry_topic: str = parameter("odom", aliases=("odometryTopic",))
    odometry_frame: str = parameter("odom", aliases=("odometryFrame",))
    robot_base_frame: str = parameter("base_footprint", aliases=("robotBaseFrame",))
    odometry_source: str = parameter("1", aliases=("odometrySource",))
    publish_odom: bool = False
    publish_odom_tf: bool = parameter(default=False, aliases=("publishTf", "publishOdomTF"))
    publish_wheel_tf: bool = parameter(default=False, aliases=("publishWheelTF",))
    covariance_x: float = 1e-5
    covariance_y: float = 1e-5
    covariance_yaw: float = 1e-3


@dataclass(frozen=True, kw_only=True)
class GzParameters(GzDriveParameters):
    """Parameters of ``gz-sim-diff-drive-system``."""

    left_joint: tuple[str, ...] = parameter()
    right_joint: tuple[str, ...] = parameter()
    wheel_separation: float = 1.0
    wheel_radius: float = 0.2


@dataclass(frozen=True, slots=True)
class _WheelPair:
    """The two wheels of one axle.

    Attributes:
        left: the motor of the left wheel.
        right: the motor of the right wheel.
        joints: the names of the left and the right joint in the simulation.
        drive: the kinematics of the two wheels.
    """

    left: Motor
    right: Motor
    joints: tuple[str, str]
    drive: DifferentialDrive


class _DiffDrive(SimulatedPlugin[P], Generic[P]):
    """A differential drive that follows a commanded velocity, with wheel odometry."""

    CARRIED: ClassVar[tuple[str, ...]] = ("_command", "_limited_command", "_pose")
    _pairs: tuple[_WheelPair, ...]
    _topics: OdometryTopics

    def _reset_motion(self) -> None:
        self._command = self._limited_command = (0.0, 0.0)
        self._pose = PlanarPose()
        self._wheel_angles = self._read_angles()

    def _create_motors(
        self, left: tuple[str, ...], right: tuple[str, ...], sizes: list[tuple[float, float]], torque: float
    ) -> None:
        """Create motors for the wheels.

        `sizes` contains the separation and radius of each pair, in m.

        Raises:
            LinkwrightError: SIM160, a size is not positive, or the numbers of left and right wheels differ.
        """
        if len(left) != len(right):
            message = phrase(
                "plugin '{plugin}' has {left_count} left wheels, but {right_count} right wheels; the numbers must "
                "be equal",
                plugin=self.context.name,
                left_count=len(left),
                right_count=len(right),
            )
            raise self.parameter_error(message)
        if any(not (separation > 0.0 and radius > 0.0) for separation, radius in sizes):
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': the separation and the diameter of the wheels must be positive",
                    plugin=self.context.name,
                )
            )
        pairs = []
        for names, (separation, radius) in zip(zip(left, right, strict=True), sizes, strict=False):
            joints = (self.joint(names[0]), self.joint(names[1]))
            motors = [self.simulation.add_velocity_motor(joint, MOTOR_GAIN, torque) for joint in joints]
            pairs.append(_WheelPair(motors[0], motors[1], joints, DifferentialDrive(separation, radius, radius)))
        self._pairs = tuple(pairs)
        self._reset_motion()

    def _on_command(self, twist: Any) -> None:
        self._command = (float(twist.linear.x), float(twist.angular.z))

    def _stop_motion(self) -> bool:
        """Stop the robot, and return whether it was commanded to move."""
        old_command, self._command = self._command, (0.0, 0.0)
        return old_command != self._command

    def _set_wheel_targets(self) -> None:
        forward, angular = self._limited_command
        for pair in self._pairs:
            pair.left.target, pair.right.target = pair.drive.wheel_speeds(forward, angular)

    def _read_angles(self) -> tuple[float, float]:
        """Return the angles of the first wheel pair in rad.

        The wheel velocities are stored for `_measure_velocity`.
        """
        state, (left, right) = self.simulation.joint_state, self._pairs[0].joints
        (left_angle, left_speed), (right_angle, right_speed) = state(left), state(right)
        self._wheel_velocities = left_speed, right_speed
        return left_angle, right_angle

    def _measure_velocity(self) -> tuple[float, float]:
        """Return the forward velocity in m/s and the yaw rate in rad/s.

        The values are those at the last call of `_read_angles`.
        """
        return self._pairs[0].drive.motion(*self._wheel_velocities)

    def _update_odometry(self) -> None:
        """Update the odometry from the rotation of the first pair of wheels."""
        pair, (left, right), self._wheel_angles = self._pairs[0], self._wheel_angles, self._read_angles()
        new_left, new_right = self._wheel_angles
        distance, yaw_change = pair.drive.motion(new_left - left, new_right - right)
        self._pose.advance(distance, 0.0, yaw_change)

    def reset(self) -> None:
        """Stop the robot, and reset the odometry to its origin."""
        self._reset_motion()
        self._set_wheel_targets()


class ClassicDiffDrive(_DiffDrive[ClassicParameters]):
    """The substitute for ``libgazebo_ros_diff_drive.so``."""

    PARAMETERS: ClassVar[type[Any]] = ClassicParameters
    CARRIED: ClassVar[tuple[str, ...]] = (*_DiffDrive.CARRIED, "_wheel_speeds")

    def start(self) -> None:
        """Create the motors and the odometry topics, and subscribe to the commands."""
        parameters, node = self.parameters, self.node
        count = max(len(parameters.left_joint), len(parameters.right_joint))
        separations, diameters = (
            _extend_to_count(parameters.wheel_separation, count),
            _extend_to_count(parameters.wheel_diameter, count),
        )
        sizes = [(separation, diameter / 2.0) for separation, diameter in zip(separations, diameters, strict=True)]
        self._create_motors(parameters.left_joint, parameters.right_joint, sizes, parameters.max_wheel_torque)
        self._wheel_speeds = [(0.0, 0.0)] * len(self._pairs)
        odometry = (
            node.publisher("nav_msgs/msg/Odometry", parameters.odometry_topic, 1) if parameters.publish_odom else None
        )
        transforms = create_transform_output(node) if parameters.publish_odom_tf else None
        variances = planar_variances(parameters.covariance_x, parameters.covariance_y, parameters.covariance_yaw)
        self._topics = OdometryTopics(
            parameters.odometry_frame, parameters.robot_base_frame, odometry, transforms, variances
        )
        self._uses_true_pose = parameters.odometry_source.strip().lower() in (str(_WORLD_ODOMETRY_SOURCE), "world")
        command_guard = node.command_guard(self._stop_motion)
        node.subscribe(
            "geometry_msgs/msg/Twist",
            parameters.command_topic,
            self._on_command,
            1,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self.every(parameters.update_rate, self._update)
        if parameters.publish_wheel_tf:
            self.every(
                parameters.update_rate, partial(self._publish_wheels, transforms or create_transform_output(node))
            )

    def _publish_wheels(self, output: Output) -> None:
        """Publish the transform of each wheel in the frame of its parent link."""
        for joint in [joint for pair in self._pairs for joint in pair.joints]:
            scene_joint = self.simulation.scene.joints[joint]
            pose = compose(
                invert(self.simulation.link_pose(scene_joint.parent)), self.simulation.link_pose(scene_joint.child)
            )
            parent, child = (link.rpartition(SEPARATOR)[2] for link in (scene_joint.parent, scene_joint.child))
            output.publish(transform_message(Header(stamp=self.stamp(), frame_id=parent), child, pose))

    def reset(self) -> None:
        """Stop the robot, and reset the odometry to its origin."""
        self._wheel_speeds = [(0.0, 0.0)] * len(self._pairs)
        super().reset()

    def _update(self) -> None:
        self._update_odometry()
        self._drive()
        if not self._topics.is_wanted:
            return
        stamp = self.stamp()
        if self._uses_true_pose:
            pose = self.simulation.model_pose(self.context.path)
            self._topics.publish(
                stamp, pose, *to_planar_velocity(pose, *self.simulation.link_velocity(self.first_link))
            )
        else:
            forward, angular = self._measure_velocity()
            published_forward = abs(forward) if self.gazebo_mistakes else forward
            self._topics.publish(stamp, self._pose.transform, published_forward, 0.0, angular)

    def _drive(self) -> None:
        """Accelerate the wheels towards the commanded velocity.

        The parameter ``max_wheel_acceleration`` limits the acceleration of the wheel rims, in m/s2.
        """
        forward, angular = self._command
        for index, pair in enumerate(self._pairs):
            target_speeds, current_speeds = pair.drive.wheel_speeds(forward, angular), self._wheel_speeds[index]
            if current_speeds == target_speeds:
                continue
            parameters = self.parameters
            max_change = (
                inf
                if parameters.max_wheel_acceleration <= 0
                else parameters.max_wheel_acceleration * self._update_period
            )
            max_wheel_change = max_change / pair.drive.left_radius
            self._set_wheel_speeds(
                index,
                _step_towards(current_speeds[0], target_speeds[0], max_wheel_change),
                _step_towards(current_speeds[1], target_speeds[1], max_wheel_change),
            )

    def _set_wheel_speeds(self, index: int, left: float, right: float) -> None:
        """Set the velocities of the two wheels of pair `index`, in rad/s."""
        pair = self._pairs[index]
        self._wheel_speeds[index] = left, right
        pair.left.target, pair.right.target = left, right

    def resume(self, previous: SimulatedPlugin[ClassicParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(previous)
        for index, (left, right) in enumerate(self._wheel_speeds):
            self._set_wheel_speeds(index, left, right)

    @property
    def _update_period(self) -> float:
        rate = self.parameters.update_rate
        return 1.0 / rate if rate > 0 else self.simulation.step / NANOSECONDS_PER_SECOND


class GzDiffDrive(_DiffDrive[GzParameters]):
    """The substitute for ``gz-sim-diff-drive-system``."""

    PARAMETERS = GzParameters

    def start(self) -> None:
        """Create the motors and the odometry topics, and subscribe to the commands."""
        parameters = self.parameters
        count = max(len(parameters.left_joint), len(parameters.right_joint))
        sizes = [(parameters.wheel_separation, parameters.wheel_radius)] * count
        self._create_motors(parameters.left_joint, parameters.right_joint, sizes, GZ_MAX_TORQUE)
        self._commands = DriveCommands(parameters)
        self._topics = connect_drive(self, parameters, self._commands)
        self.node.subscribe("std_msgs/msg/Bool", f"/model/{self.context.path}/enable", self._commands.enable)
        self.every(GZ_RATE_HZ, self._drive)
        self.every(parameters.odom_publish_frequency, self._publish)

    def reset(self) -> None:
        """Stop the robot, and reset the odometry to its origin."""
        self._commands.restart()
        super().reset()

    def resume(self, previous: SimulatedPlugin[GzParameters]) -> None:
        """Take over velocity and odometry from the previous instance."""
        super().resume(previous)
        assert isinstance(previous, GzDiffDrive)
        self._commands.resume(previous._commands)

    def _drive(self) -> None:
        self._update_odometry()
        forward, _, angular = self._commands.next_velocity()
        self._limited_command = (forward, angular)
        self._set_wheel_targets()

    def _publish(self) -> None:
        self._update_odometry()
        if not self._topics.is_wanted:
            return
        forward, angular = self._measure_velocity()
        self._topics.publish(self.stamp(), self._pose.transform, forward, 0.0, angular)


def _step_towards(value: float, target: float, max_step: float) -> float:
    """Return `value` changed towards `target` by at most `max_step`."""
    return min(max(target, value - max_step), value + max_step)


def _extend_to_count(values: tuple[float, ...], count: int) -> tuple[float, ...]:
    """Return exactly `count` values.

    The last value is repeated if there are too few, and surplus values are dropped.
    """
    return (*values, *(values[-1:] * count))[:count]
