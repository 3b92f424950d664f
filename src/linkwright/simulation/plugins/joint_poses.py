"""Joints set to a trajectory's positions: ``libgazebo_ros_joint_pose_trajectory.so``.

Source: gazebo_ros_pkgs for ROS 2 and ROS 1 (topic, parameters). Joints jump from point to point, and the
``time_from_start`` of a point is the time until the next point.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.sdf.poses import WORLD
from linkwright.simulation.plugins.entities import Entities
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin


@dataclass(frozen=True, kw_only=True)
class JointPoseParameters:
    """Parameters of ``libgazebo_ros_joint_pose_trajectory.so``."""

    update_rate: float = parameter(100.0, aliases=("updateRate",))
    topic_name: str = parameter("set_joint_trajectory", aliases=("topicName",))


class ClassicJointPoses(SimulatedPlugin[JointPoseParameters]):
    """The substitute for ``libgazebo_ros_joint_pose_trajectory.so``."""

    PARAMETERS = JointPoseParameters
    IGNORED = ("serviceName",)

    def start(self) -> None:
        """Subscribe to the trajectories."""
        self.reset()
        self.node.subscribe(
            "trajectory_msgs/msg/JointTrajectory",
            self.parameters.topic_name,
            self._on_trajectory,
            1,
            stop_motion=lambda: None,
        )
        self.every(self.parameters.update_rate, self._move)

    def reset(self) -> None:
        """Drop the trajectory."""
        self._points = deque[Any]()
        self._joints: list[str] = []
        self._next_point_time = 0

    def _on_trajectory(self, message: Any) -> None:
        try:
            if message.header.frame_id not in (WORLD, "map", "/map"):
                Entities(self.simulation).link(message.header.frame_id)
            self._joints = [self.joint(name) for name in message.joint_names]
        except LinkwrightError as error:
            self.node.logger.warning(error.diagnostics[0].message)
            return
        for joint in self._joints:
            self.simulation.keep_awake(self.simulation.scene.joints[joint].child)
        self._points = deque(message.points)
        stamp = message.header.stamp
        self._next_point_time = max(int(stamp.sec) * NANOSECONDS_PER_SECOND + int(stamp.nanosec), self.simulation.time)

    def _move(self) -> None:
        """Set the joints to the next point of the trajectory if the point is due."""
        if not self._points or self.simulation.time < self._next_point_time:
            return
        point = self._points.popleft()
        for joint, position in zip(self._joints, point.positions, strict=False):
            self.simulation.set_joint_position(joint, float(position))
        self._next_point_time += int(point.time_from_start.sec) * NANOSECONDS_PER_SECOND + int(
            point.time_from_start.nanosec
        )
