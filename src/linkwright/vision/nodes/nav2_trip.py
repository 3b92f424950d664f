"""The drive to an object with nav2's action ``navigate_to_pose``."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, hypot, sin
from typing import Any

from linkwright.graph import ActionClient, GoalStatus, Node
from linkwright.messages import get_action

_ACTION = "nav2_msgs/action/NavigateToPose"


class Nav2Trip:
    """A client of nav2's action with at most one goal at a time.

    Args:
        node: the node that owns the action client.
        on_end: called with whether the goal was reached, when a goal that was not canceled has ended.
    """

    def __init__(self, node: Node, on_end: Callable[[bool], None]) -> None:
        self._node, self._on_end = node, on_end
        self._client = ActionClient(node, _ACTION, "navigate_to_pose")
        self._active_trip: object | None = None
        self._goal_handle: Any = None

    @property
    def is_served(self) -> bool:
        """Whether nav2's action server is available."""
        return self._client.server_is_ready()

    @property
    def is_under_way(self) -> bool:
        """Whether a goal is active."""
        return self._active_trip is not None

    def begin(self, frame: str, robot: tuple[float, float], target: tuple[float, float], distance: float) -> None:
        """Send a goal in front of an object, on the robot's side and facing the object.

        Args:
            frame: the frame of both positions.
            robot: the robot's position, x and y in meters.
            target: the object's position, x and y in meters.
            distance: the distance to keep between the centers of robot and object, meters.
        """
        yaw = atan2(target[1] - robot[1], target[0] - robot[0])
        travel = max(0.0, hypot(target[0] - robot[0], target[1] - robot[1]) - distance)
        goal = get_action(_ACTION).Goal()
        goal.pose.header.frame_id = frame
        goal.pose.header.stamp = self._node.get_clock().now().to_msg()
        position, orientation = goal.pose.pose.position, goal.pose.pose.orientation
        position.x, position.y = robot[0] + travel * cos(yaw), robot[1] + travel * sin(yaw)
        orientation.z, orientation.w = sin(yaw / 2), cos(yaw / 2)
        trip = self._active_trip = object()
        self._client.send_goal_async(goal).add_done_callback(
            lambda future: self._receive_response(trip, future.result())
        )

    def cancel(self) -> None:
        """Cancel the active goal, if there is one."""
        self._active_trip = None
        if self._goal_handle is not None:
            self._goal_handle.cancel_goal_async()
            self._goal_handle = None

    def _receive_response(self, trip: object, goal: Any) -> None:
        if trip is not self._active_trip:
            if goal.accepted:
                goal.cancel_goal_async()
        elif goal.accepted:
            self._goal_handle = goal
            goal.get_result_async().add_done_callback(lambda future: self._finish(trip, future.result().status))
        else:
            self._finish(trip, GoalStatus.ABORTED)

    def _finish(self, trip: object, status: int) -> None:
        if trip is self._active_trip:
            self._active_trip = self._goal_handle = None
            self._on_end(status == GoalStatus.SUCCEEDED)
