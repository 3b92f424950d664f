"""Skid steering of ROS 1: ``libgazebo_ros_skid_steer_drive.so``.

Skid steering is a differential drive with two pairs of wheels.

Source: gazebo_ros_pkgs for ROS 1 (parameters, topics, defaults; the odometry is the robot's true pose in the world).
"""

from __future__ import annotations

from dataclasses import dataclass

from linkwright.simulation.plugins.diff_drive import ClassicDiffDrive, ClassicParameters
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import Environment, PluginContext


@dataclass(frozen=True, kw_only=True)
class SkidSteerParameters:
    """Parameters of ``libgazebo_ros_skid_steer_drive.so``."""

    left_front_joint: str = parameter("left_front_joint", aliases=("leftFrontJoint",))
    right_front_joint: str = parameter("right_front_joint", aliases=("rightFrontJoint",))
    left_rear_joint: str = parameter("left_rear_joint", aliases=("leftRearJoint",))
    right_rear_joint: str = parameter("right_rear_joint", aliases=("rightRearJoint",))
    wheel_separation: float = parameter(0.4, aliases=("wheelSeparation",))
    wheel_diameter: float = parameter(0.15, aliases=("wheelDiameter",))
    max_wheel_torque: float = parameter(5.0, aliases=("torque",))
    update_rate: float = parameter(100.0, aliases=("updateRate",))
    command_topic: str = parameter("cmd_vel", aliases=("commandTopic",))
    odometry_topic: str = parameter("odom", aliases=("odometryTopic",))
    odometry_frame: str = parameter("odom", aliases=("odometryFrame",))
    robot_base_frame: str = parameter("base_footprint", aliases=("robotBaseFrame",))
    publish_odom_tf: bool = parameter(default=True, aliases=("broadcastTF",))
    covariance_x: float = 1e-4
    covariance_y: float = 1e-4
    covariance_yaw: float = 1e-2

    def as_diff_drive(self) -> ClassicParameters:
        """Return the parameters of the equivalent differential drive."""
        return ClassicParameters(
            left_joint=(self.left_front_joint, self.left_rear_joint),
            right_joint=(self.right_front_joint, self.right_rear_joint),
            num_wheel_pairs=2,
            wheel_separation=(self.wheel_separation,),
            wheel_diameter=(self.wheel_diameter,),
            max_wheel_torque=self.max_wheel_torque,
            update_rate=self.update_rate,
            command_topic=self.command_topic,
            odometry_topic=self.odometry_topic,
            odometry_frame=self.odometry_frame,
            robot_base_frame=self.robot_base_frame,
            publish_odom=True,
            publish_odom_tf=self.publish_odom_tf,
            covariance_x=self.covariance_x,
            covariance_y=self.covariance_y,
            covariance_yaw=self.covariance_yaw,
        )


class SkidSteer(ClassicDiffDrive):
    """The substitute for ``libgazebo_ros_skid_steer_drive.so``."""

    PARAMETERS = SkidSteerParameters

    def __init__(
        self, context: PluginContext, node: PluginNode, parameters: SkidSteerParameters, environment: Environment
    ) -> None:
        super().__init__(context, node, parameters.as_diff_drive(), environment)
