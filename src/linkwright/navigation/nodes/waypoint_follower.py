"""nav2's waypoint_follower, which navigates to poses in turn (``follow_waypoints``).

A deliberate difference: waiting is the only supported task at waypoints; other tasks are skipped with a log line.
"""

from __future__ import annotations

from typing import Any

from linkwright.graph import ActionClient
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.messages import get_action, get_message, is_before_iron
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedServer
from linkwright.navigation.nodes.plugins import get_or_declare, get_plugin_type
from linkwright.navigation.nodes.steps import Step, StepError, StepNode

_WAIT_TASK = "nav2_waypoint_follower/WaitAtWaypoint"


class WaypointNode(StepNode):
    """The managed node of waypoint_follower."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        self.declare_parameter("stop_on_failure", True)
        self.declare_parameter("loop_rate", 20)
        self.declare_parameter("global_frame_id", "map")
        self.declare_parameter("action_server_result_timeout", 900.0)
        self.declare_parameter("waypoint_task_executor_plugin", "wait_at_waypoint")
        self._missed_waypoints: list[Any] = []
        self._index = 0

    def configure(self) -> None:
        """Create the action server, and the client of ``navigate_to_pose``.

        Raises:
            LinkwrightError: a parameter has the wrong type.
        """
        task = str(self.get_parameter("waypoint_task_executor_plugin").value)
        plugin_type = get_plugin_type(self, task, {"wait_at_waypoint": _WAIT_TASK})
        self._pause_seconds = 0.0
        if plugin_type == _WAIT_TASK:
            is_enabled = bool(get_or_declare(self, f"{task}.enabled", True))
            self._pause_seconds = (
                int(get_or_declare(self, f"{task}.waypoint_pause_duration", 0)) / 1000.0 if is_enabled else 0.0
            )
        else:
            self.get_logger().warning(f"{task}: {plugin_type} is not supported; no task runs at waypoints")
        self._navigation_client = self.register(
            ActionClient(self, "nav2_msgs/action/NavigateToPose", "navigate_to_pose")
        )
        action_type = "nav2_msgs/action/FollowWaypoints"
        self._waypoint_server = self.register(GoalServer(self, action_type, "follow_waypoints", self._start))

    def publish_feedback(self, server: GoalServer) -> None:
        """Publish the index of the current waypoint as feedback for the goal."""
        server.publish_feedback(current_waypoint=self._index)

    def result(self) -> dict[str, Any]:
        """Return the result field with the missed waypoints."""
        return {"missed_waypoints": self._missed_waypoints}

    def _start(self, goal: ServerGoalHandle) -> None:
        self._missed_waypoints, self._index = [], 0
        self.get_logger().info(f"Received follow waypoint request with {len(goal.request.poses)} waypoints.")
        self.work_on(self._waypoint_server, self._follow_waypoints(goal.request))

    def _follow_waypoints(self, goal: Any) -> Step:
        if not goal.poses:
            raise StepError("UNKNOWN", "there are no waypoints")
        first_index = getattr(goal, "goal_index", 0)
        for loop in range(getattr(goal, "number_of_loops", 0) + 1):
            for index in range(first_index if loop == 0 else 0, len(goal.poses)):
                self._index = index
                yield from self._go_to(goal.poses[index])
        self.get_logger().info(f"Completed all {len(goal.poses)} waypoints requested.")

    def _go_to(self, pose: Any) -> Step:
        goal = get_action("nav2_msgs/action/NavigateToPose").Goal(pose=pose)
        try:
            yield from self.run_remote_goal(self._navigation_client, goal, f"waypoint {self._index} was not reached")
        except StepError as failure:
            self._missed_waypoints.append(self._make_missed_waypoint(pose, str(failure)))
            if self.get_parameter("stop_on_failure").value:
                raise
            self.get_logger().warning(f"{failure}; moving to next")
            return
        deadline_ns = self.now_ns() + round(self._pause_seconds * 1e9)
        while self.now_ns() < deadline_ns:
            yield

    def _make_missed_waypoint(self, pose: Any, reason: str) -> Any:
        """Return the result's item for the current, missed waypoint.

        The item is an index in Humble, and a message since Iron.
        """
        if is_before_iron():
            return self._index
        return get_message("nav2_msgs/msg/MissedWaypoint")(index=self._index, goal=pose, error_msg=reason)


class WaypointFollower(ManagedServer):
    """The running waypoint_follower node."""

    DEFAULT_NAME = "waypoint_follower"
    NODE = WaypointNode
