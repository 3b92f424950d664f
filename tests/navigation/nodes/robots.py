"""A robot in a room with walls that follows ``/cmd_vel``.

It publishes its pose and scans.
"""

from __future__ import annotations

from math import hypot
from typing import Any

import numpy as np

from linkwright.graph import ActionClient, Graph, JumpClock
from linkwright.messages import get_action, get_message
from linkwright.navigation.following.follower import ZERO_VELOCITY, Velocity, predict_poses
from tests.navigation.nodes.fake_robot import FakeRobot

PERIOD_S = 0.02


class DrivingRobot(FakeRobot):
    """A fake robot that drives.

    Attributes:
        speeds: the commanded velocities, in order.
        publishes_pose: whether it publishes its pose.
        is_blocked: whether it cannot move.
        obstacles: the rays, in degrees, that meet an obstacle, and the range of each.
        publishes_scans: whether its laser publishes.
    """

    def __init__(self, graph: Graph, clock: JumpClock) -> None:
        super().__init__(graph, clock)
        self.speeds: list[Velocity] = []
        self.velocity = ZERO_VELOCITY
        self.publishes_pose, self.is_blocked = True, False
        self.obstacles: tuple[tuple[int, float], ...] = ()
        self.publishes_scans = True
        self._odometry = self.node.create_publisher("nav_msgs/msg/Odometry", "/odom", 10)
        self.node.create_subscription("geometry_msgs/msg/Twist", "/cmd_vel", self._on_velocity, 10)
        self.node.create_timer(PERIOD_S, self._move)
        self.node.create_timer(0.2, lambda: self.publish_scan(*self.obstacles) if self.publishes_scans else None)
        self.publish_pose()

    def _on_velocity(self, message: Any) -> None:
        self.velocity = Velocity(message.linear.x, message.linear.y, message.angular.z)
        self.speeds.append(self.velocity)

    def _move(self) -> None:
        velocity = ZERO_VELOCITY if self.is_blocked else self.velocity
        self.pose = tuple(map(float, predict_poses(self.pose, np.array([velocity]), np.array([PERIOD_S]))[0, 0]))
        if self.publishes_pose:
            self.publish_pose()
        message = self._odometry.msg_type()
        message.twist.twist.linear.x, message.twist.twist.angular.z = float(velocity.x), float(velocity.yaw)
        self._odometry.publish(message)

    def distance_to(self, x: float, y: float) -> float:
        return hypot(self.pose[0] - x, self.pose[1] - y)


class GoalSender:
    """An action client for the goals of a test."""

    def __init__(self, robot: FakeRobot, action_type: str, name: str) -> None:
        self._scene = robot
        self.action_type = get_action(f"nav2_msgs/action/{action_type}")
        self.client = ActionClient(robot.node, self.action_type, name)
        self.feedback: list[Any] = []
        self.handle: Any = None
        self.answer: Any = None

    async def send(self, **fields: Any) -> None:
        await self._scene.run(0.1)
        self.answer = None
        self.client.send_goal_async(
            self.action_type.Goal(**fields), feedback_callback=lambda message: self.feedback.append(message.feedback)
        ).add_done_callback(self._accepted)
        await self._scene.graph.settle()

    def _accepted(self, future: Any) -> None:
        self.handle = future.result()
        if self.handle.accepted:
            self.handle.get_result_async().add_done_callback(self._ended)

    def _ended(self, future: Any) -> None:
        self.answer = future.result()

    async def status_after(self, seconds: float) -> int:
        """Return the goal's final status, or 0 if it has not ended within the seconds."""
        for _ in range(round(seconds / 0.5)):
            if self.answer is not None:
                return int(self.answer.status)
            await self._scene.run(0.5)
        return 0 if self.answer is None else int(self.answer.status)


def pose_stamped(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> Any:
    message = get_message("geometry_msgs/msg/PoseStamped")()
    message.header.frame_id = frame
    message.pose.position.x, message.pose.position.y = float(x), float(y)
    message.pose.orientation.z, message.pose.orientation.w = float(np.sin(yaw / 2)), float(np.cos(yaw / 2))
    return message


def path_message(poses: Any, frame: str = "map") -> Any:
    message = get_message("nav_msgs/msg/Path")()
    message.header.frame_id = frame
    message.poses = [pose_stamped(*pose, frame=frame) for pose in poses]
    return message
