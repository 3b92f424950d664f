"""Motion in a plane: ``libgazebo_ros_planar_move.so``, including its names in ROS 1.

Source: gazebo_ros_pkgs (parameters, topics, defaults). Unlike in gazebo_ros_pkgs, the velocity is set after each step.
Wheels with grip therefore hardly slow the robot down, and gravity still makes it fall and tilt.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import Any, Generic, TypeVar

from linkwright.control.odometry import (
    OdometryTopics,
    create_transform_output,
    get_yaw,
    planar_variances,
    to_planar_velocity,
)
from linkwright.diagnostics import phrase
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

P = TypeVar("P")


@dataclass(frozen=True, kw_only=True)
class PlanarMoveParameters:
    """Parameters of ``libgazebo_ros_planar_move.so``."""

    publish_rate: float = parameter(20.0, aliases=("odometryRate",))
    command_topic: str = parameter("cmd_vel", aliases=("commandTopic",))
    odometry_topic: str = parameter("odom", aliases=("odometryTopic",))
    odometry_frame: str = parameter("odom", aliases=("odometryFrame",))
    robot_base_frame: str = parameter("base_footprint", aliases=("robotBaseFrame",))
    publish_odom: bool = True
    publish_odom_tf: bool = True
    covariance_x: float = 1e-5
    covariance_y: float = 1e-5
    covariance_yaw: float = 1e-3


class PlanarDrive(SimulatedPlugin[P], Generic[P]):
    """A plugin that sets the velocity of a model in its horizontal plane."""

    def require_free_model(self) -> None:
        """Raise an error if the model cannot move, or else prevent it from sleeping.

        Raises:
            LinkwrightError: SIM160, the model is fixed to the world.
        """
        if not self.simulation.moves_freely(self.context.path):
            raise self.parameter_error(
                phrase("plugin '{plugin}' cannot move a model that is fixed to the world", plugin=self.context.name)
            )
        self.simulation.keep_awake(self.first_link)

    def set_planar_velocity(self, forward: float, left: float, yaw_rate: float) -> None:
        """Set the planar velocities in m/s and rad/s for the next step.

        The vertical velocity and the roll and pitch rates remain unchanged.
        """
        yaw = get_yaw(self.simulation.model_pose(self.context.path))
        linear, angular = self.simulation.link_velocity(self.first_link)
        world_velocity = (forward * cos(yaw) - left * sin(yaw), forward * sin(yaw) + left * cos(yaw), float(linear[2]))
        self.simulation.set_model_velocity(
            self.context.path, world_velocity, (float(angular[0]), float(angular[1]), yaw_rate)
        )


class PlanarMove(PlanarDrive[PlanarMoveParameters]):
    """The substitute for ``libgazebo_ros_planar_move.so``."""

    PARAMETERS = PlanarMoveParameters
    IGNORED = ("update_rate",)
    CARRIED = ("_command",)

    def start(self) -> None:
        """Subscribe to the commands, and create the odometry topics.

        Raises:
            LinkwrightError: SIM160, the model is fixed to the world.
        """
        parameters, node = self.parameters, self.node
        self.require_free_model()
        self._command = (0.0, 0.0, 0.0)
        odometry = (
            node.publisher("nav_msgs/msg/Odometry", parameters.odometry_topic, 1) if parameters.publish_odom else None
        )
        transforms = create_transform_output(node) if parameters.publish_odom_tf else None
        variances = planar_variances(parameters.covariance_x, parameters.covariance_y, parameters.covariance_yaw)
        self._topics = OdometryTopics(
            parameters.odometry_frame, parameters.robot_base_frame, odometry, transforms, variances
        )
        command_guard = node.command_guard(self._stop_motion)
        node.subscribe(
            "geometry_msgs/msg/Twist",
            parameters.command_topic,
            self._on_command,
            1,
            command_guard=command_guard,
            stop_motion=self._stop_motion,
        )
        self.every(0.0, self._move)
        if odometry is not None or transforms is not None:
            self.every(parameters.publish_rate, self._publish)

    def _on_command(self, twist: Any) -> None:
        self._command = (float(twist.linear.x), float(twist.linear.y), float(twist.angular.z))

    def _stop_motion(self) -> bool:
        old_command, self._command = self._command, (0.0, 0.0, 0.0)
        return old_command != self._command

    def _move(self) -> None:
        self.set_planar_velocity(*self._command)

    def _publish(self) -> None:
        pose = self.simulation.model_pose(self.context.path)
        self._topics.publish(
            self.stamp(), pose, *to_planar_velocity(pose, *self.simulation.link_velocity(self.first_link))
        )

    def reset(self) -> None:
        """Stop the robot."""
        self._stop_motion()
