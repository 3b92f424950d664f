"""Drive to an object with nav2's action ``navigate_to_pose``."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, cos, hypot, sin
from typing import Any

from linkwright.graph import ActionClient, GoalStatus, Node
from linkwright.messages import get_action

_ACTION = "nav2_msgs/action/NavigateToPose"


class Nav2Trip:
    """A client of nav2 that has one goal at a time.

    Args:
        node: the node that owns the action client.
        ended: called when a goal that was not canceled has ended, with whether it was reached.
    """

    def __init__(self, node: Node, ended: Callable[[bool], None]) -> None:
        self._node, self._ended = node, ended
        self._client = ActionClient(node, _ACTION, "navigate_to_pose")
        self._trip: object | None = None
        self._goal: Any = None

    @property
    def is_served(self) -> bool:
        """Whether nav2's action server is available."""
        return self._client.server_is_ready()

    @property
    def is_under_way(self) -> bool:
        """Whether a goal is active."""
        return self._trip is not None

    def begin(self, frame: str, robot: tuple[float, float], target: tuple[float, float], distance: float) -> None:
        """Send a goal in front of an object: on the robot's side of it and facing it.

        Args:
            frame: the frame of both positions.
            robot: the robot's position, x and y in metres.
            target: the position of the object.
            distance: the final distance between the centres of robot and object, metres.
        """
        yaw = atan2(target[1] - robot[1], target[0] - robot[0])
        way = max(0.0, hypot(target[0] - robot[0], target[1] - robot[1]) - distance)
        goal = get_action(_ACTION).Goal()
        goal.pose.header.frame_id = frame
        goal.pose.header.stamp = self._node.get_clock().now().to_msg()
        at, turn = goal.pose.pose.position, goal.pose.pose.orientation
        at.x, at.y = robot[0] + way * cos(yaw), robot[1] + way * sin(yaw)
        turn.z, turn.w = sin(yaw / 2), cos(yaw / 2)
        trip = self._trip = object()
        self._client.send_goal_async(goal).add_done_callback(lambda future: self._answered(trip, future.result()))

    def cancel(self) -> None:
        """Cancel the active goal, if there is one."""
        self._trip = None
        if self._goal is not None:
            self._goal.cancel_goal_async()
            self._goal = None

    def _answered(self, trip: object, goal: Any) -> None:
        if trip is not self._trip:
            if goal.accepted:
                goal.cancel_goal_async()
        elif goal.accepted:
            self._goal = goal
            goal.get_result_async().add_done_callback(lambda future: self._end(trip, future.result().status))
        else:
            self._end(trip, GoalStatus.ABORTED)

    def _end(self, trip: object, status: int) -> None:
        if trip is self._trip:
            self._trip = self._goal = None
            self._ended(status == GoalStatus.SUCCEEDED)
