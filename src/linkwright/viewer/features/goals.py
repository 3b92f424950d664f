"""Goals that tools send to actions."""

from __future__ import annotations

from typing import Any

from linkwright.graph import ActionClient, Node
from linkwright.graph.loop.future import Future
from linkwright.messages import get_action


class GoalSender:
    """Sends poses to an action whose goals have one, as ``navigate_to_pose`` of nav2.

    Args:
        node: to send with.
        name: the name of the action.
        kind: its type.
    """

    def __init__(self, node: Node, name: str, kind: str) -> None:
        self._name = name
        self._log = node.get_logger()
        self._goal = get_action(kind).Goal
        self._client = ActionClient(node, kind, name)

    def send(self, pose: Any) -> None:
        """Send a pose; the log warns when no server accepts it.

        Args:
            pose: a geometry_msgs/msg/PoseStamped.
        """
        if not self._client.server_is_ready():
            self._log.error(f"{self._name} action server is not available. Is the initial pose set?")
            return
        self._client.send_goal_async(self._goal(pose=pose)).add_done_callback(self._answered)

    def destroy(self) -> None:
        """Leave the graph."""
        self._client.destroy()

    def _answered(self, answer: Future[Any]) -> None:
        handle = None if answer.cancelled() or answer.exception() is not None else answer.result()
        if handle is not None and not handle.accepted:
            self._log.error("Goal was rejected by the action server")
