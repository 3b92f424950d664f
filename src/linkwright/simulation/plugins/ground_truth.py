"""True poses as odometry, in Gazebo Classic, in gz, and for robots of PAL.

They are ``libgazebo_ros_p3d.so``, ``gz-sim-odometry-publisher-system`` and ``libgazebo_world_odometry.so``.

Source: gazebo_ros_pkgs, gz-sim and pal_gazebo_plugins (parameters, topics, frames, defaults).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.control.odometry import TRANSFORMS_DEPTH, TRANSFORMS_TYPE, to_planar_velocity, transform_message
from linkwright.geometry.arrays import Array
from linkwright.geometry.single import (
    Transform,
    Vector3,
    compose,
    invert,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
)
from linkwright.messages import Header, Quaternion, from_values, get_message
from linkwright.messages import Vector3 as VectorMessage
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_WORLD_FRAMES = ("world", "/world", "map", "/map")


@dataclass(frozen=True, kw_only=True)
class ClassicPoseParameters:
    """Parameters of ``libgazebo_ros_p3d.so``."""

    body_name: str = parameter(aliases=("bodyName",))
    frame_name: str = parameter("world", aliases=("frameName",))
    topic_name: str = parameter("odom", aliases=("topicName",))
    xyz_offset: Vector3 = parameter((0.0, 0.0, 0.0), aliases=("xyz_offsets", "xyzOffset", "xyzOffsets"))
    rpy_offset: Vector3 = parameter((0.0, 0.0, 0.0), aliases=("rpy_offsets", "rpyOffset", "rpyOffsets"))
    gaussian_noise: float = parameter(0.0, aliases=("gaussianNoise",))
    update_rate: float = parameter(0.0, aliases=("updateRate",))


@dataclass(frozen=True, kw_only=True)
class GzOdometryParameters:
    """Parameters of ``gz-sim-odometry-publisher-system``."""

    odom_frame: str = ""
    robot_base_frame: str = ""
    odom_publish_frequency: float = 50.0
    odom_topic: str = ""
    odom_covariance_topic: str = ""
    tf_topic: str = ""
    dimensions: int = 2
    xyz_offset: Vector3 = (0.0, 0.0, 0.0)
    rpy_offset: Vector3 = (0.0, 0.0, 0.0)
    gaussian_noise: float = 0.0


@dataclass(frozen=True, kw_only=True)
class PalOdometryParameters:
    """Parameters of ``libgazebo_world_odometry.so``."""

    frame_name: str = parameter("world", aliases=("frameName",))
    body_name: str = parameter("", aliases=("bodyName",))
    topic_name: str = parameter("ft_data", aliases=("topicName",))
    update_rate: float = parameter(1000.0, aliases=("updateRate",))


class ClassicPose(SimulatedPlugin[ClassicPoseParameters]):
    """The substitute for ``libgazebo_ros_p3d.so``: the pose and velocity of a link.

    The pose is expressed in the world or in the frame of another link, and the velocities in the axes of the same
    frame. gazebo_ros_p3d rotates velocities in the wrong direction into the axes of another link. The plugin does the
    same if Gazebo's mistakes are requested.
    """

    PARAMETERS = ClassicPoseParameters

    def start(self) -> None:
        """Find the links, and create the odometry topic."""
        parameters = self.parameters
        self._link = self.link(parameters.body_name)
        self._reference = "" if parameters.frame_name in _WORLD_FRAMES else self.link(parameters.frame_name)
        self._rotation_offset = quaternion_from_rpy(parameters.rpy_offset)
        self._random = self.random
        self._output = self.node.publisher("nav_msgs/msg/Odometry", parameters.topic_name, 1)
        self.every(parameters.update_rate, self._publish)

    def reset(self) -> None:
        """Restart the noise generator."""
        self._random = self.random

    def _publish(self) -> None:
        if not self._output.is_wanted:
            return
        parameters, simulation = self.parameters, self.simulation
        pose, (linear, angular) = simulation.link_pose(self._link), simulation.link_velocity(self._link)
        if self._reference:
            frame, (base_linear, base_angular) = (
                simulation.link_pose(self._reference),
                simulation.link_velocity(self._reference),
            )
            pose = compose(invert(frame), pose)
            express = _rotate_by_frame if self.gazebo_mistakes else _to_frame_axes
            linear, angular = express(frame, linear - base_linear), express(frame, angular - base_angular)
        x, y, z = (a + b for a, b in zip(pose[:3], parameters.xyz_offset, strict=True))
        offset_pose = (x, y, z, *quaternion_multiply(self._rotation_offset, pose[3:]))
        linear, angular = _add_noise(self._random, parameters.gaussian_noise, linear, angular)
        header = Header(stamp=self.stamp(), frame_id=parameters.frame_name)
        message = _create_odometry(
            header, parameters.body_name, offset_pose, linear, angular, parameters.gaussian_noise**2
        )
        self._output.publish(message)


class GzOdometry(SimulatedPlugin[GzOdometryParameters]):
    """The substitute for ``gz-sim-odometry-publisher-system``: a model's pose and velocity.

    The pose is expressed in the world, and the velocity in the axes of the model.
    """

    PARAMETERS = GzOdometryParameters

    def start(self) -> None:
        """Create the publishers of odometry and transforms."""
        parameters, model, node = self.parameters, self.context.path, self.node
        self._child_frame = parameters.robot_base_frame or f"{model}/base_footprint"
        self._frame = parameters.odom_frame or f"{model}/odom"
        self._offset: Transform = (*parameters.xyz_offset, *quaternion_from_rpy(parameters.rpy_offset))
        self._random = self.random
        topic = parameters.odom_topic or f"/model/{model}/odometry"
        covariance_topic = parameters.odom_covariance_topic or f"/model/{model}/odometry_with_covariance"
        self._odometry = node.publisher("nav_msgs/msg/Odometry", topic, conventional_topic="/odom")
        self._covariance_odometry = node.publisher("nav_msgs/msg/Odometry", covariance_topic)
        self._transforms = node.publisher(
            TRANSFORMS_TYPE, parameters.tf_topic or f"/model/{model}/pose", TRANSFORMS_DEPTH, conventional_topic="/tf"
        )
        self.every(parameters.odom_publish_frequency, self._publish)

    def reset(self) -> None:
        """Restart the noise generator."""
        self._random = self.random

    def _publish(self) -> None:
        if not any(output.is_wanted for output in (self._odometry, self._covariance_odometry, self._transforms)):
            return
        parameters, simulation = self.parameters, self.simulation
        pose = compose(simulation.model_pose(self.context.path), self._offset)
        linear, angular = simulation.link_velocity(self.first_link)
        if parameters.dimensions == 3:
            linear, angular = _to_frame_axes(pose, linear), _to_frame_axes(pose, angular)
        else:
            forward, sideways, yaw_rate = to_planar_velocity(pose, linear, angular)
            linear, angular = np.array((forward, sideways, 0.0)), np.array((0.0, 0.0, yaw_rate))
            pose = (pose[0], pose[1], 0.0, *pose[3:])
        linear, angular = _add_noise(self._random, parameters.gaussian_noise, linear, angular)
        header = Header(stamp=self.stamp(), frame_id=self._frame)
        self._odometry.publish(_create_odometry(header, self._child_frame, pose, linear, angular, 0.0))
        self._covariance_odometry.publish(
            _create_odometry(header, self._child_frame, pose, linear, angular, parameters.gaussian_noise**2)
        )
        self._transforms.publish(transform_message(header, self._child_frame, pose))


class PalOdometry(SimulatedPlugin[PalOdometryParameters]):
    """The substitute for ``libgazebo_world_odometry.so``: the pose and velocity of a link.

    The linear velocity is in the axes of the world, and the angular velocity in those of the link. The offsets that
    the original has as parameters of its node are 0.
    """

    PARAMETERS = PalOdometryParameters

    def start(self) -> None:
        """Find the link, and create the odometry topic.

        Raises:
            LinkwrightError: SIM133, there is no such link.
        """
        parameters = self.parameters
        self._body = parameters.body_name or parameters.frame_name
        self._link = self.link(self._body)
        self._output = self.node.publisher("nav_msgs/msg/Odometry", parameters.topic_name, 10)
        self.every(parameters.update_rate, self._publish)

    def _publish(self) -> None:
        if not self._output.is_wanted:
            return
        pose, (linear, angular) = self.simulation.link_pose(self._link), self.simulation.link_velocity(self._link)
        header = Header(stamp=self.stamp(), frame_id=self.parameters.frame_name)
        self._output.publish(_create_odometry(header, self._body, pose, linear, _to_frame_axes(pose, angular), 0.0))


def _to_frame_axes(frame: Transform, vector: Array) -> Array:
    """Return a vector, given in the axes of the world, in the axes of a frame."""
    x, y, z = vector
    return np.array(rotate(quaternion_inverse(frame[3:]), (float(x), float(y), float(z))))


def _rotate_by_frame(frame: Transform, vector: Array) -> Array:
    """Return a vector rotated by the orientation of a frame: the mistake of gazebo_ros_p3d."""
    x, y, z = vector
    return np.array(rotate(frame[3:], (float(x), float(y), float(z))))


def _add_noise(
    random: np.random.Generator, standard_deviation: float, linear: Array, angular: Array
) -> tuple[Array, Array]:
    if standard_deviation <= 0.0:
        return linear, angular
    return linear + random.normal(0.0, standard_deviation, 3), angular + random.normal(0.0, standard_deviation, 3)


def _create_odometry(
    header: Header, child_frame: str, pose: Transform, linear: Array, angular: Array, variance: float
) -> Any:
    """Return an odometry message with the same variance for all components of pose and twist."""
    message = get_message("nav_msgs/msg/Odometry")(header=header, child_frame_id=child_frame)
    x, y, z, *rotation = pose
    message.pose.pose.position.x, message.pose.pose.position.y, message.pose.pose.position.z = x, y, z
    message.pose.pose.orientation = from_values(Quaternion, rotation)
    message.twist.twist.linear = from_values(VectorMessage, linear.tolist())
    message.twist.twist.angular = from_values(VectorMessage, angular.tolist())
    for estimate in (message.pose, message.twist):
        estimate.covariance[::7] = [variance] * 6
    return message
