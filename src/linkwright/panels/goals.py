"""Send the goals of the page's tools to action servers."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph import ActionClient, Node
from linkwright.graph.loop.future import Future
from linkwright.messages import get_action


class GoalSender:
    """Sends poses as goals to an action such as nav2's ``navigate_to_pose``.

    Args:
        node: the node that owns the action client.
        name: the name of the action.
        action_type: the type of the action.
    """

    def __init__(self, node: Node, name: str, action_type: str) -> None:
        self._name = name
        self._log = node.get_logger()
        self._goal_type = get_action(action_type).Goal
        self._client = ActionClient(node, action_type, name)

    def send(self, pose: Any, on_refusal: Callable[[str], None]) -> None:
        """Send a pose as a goal, and report an error if no server accepts it.

        Args:
            pose: a geometry_msgs/msg/PoseStamped.
            on_refusal: called with the text of the error.
        """

        def report_refusal(reason: str) -> None:
            self._log.error(reason)
            on_refusal(reason)

        def on_response(response: Future[Any]) -> None:
            handle = None if response.cancelled() or response.exception() is not None else response.result()
            if handle is not None and not handle.accepted:
                report_refusal("Goal was rejected by the action server")

        if self._client.server_is_ready():
            self._client.send_goal_async(self._goal_type(pose=pose)).add_done_callback(on_response)
        else:
            report_refusal(f"{self._name} action server is not available. Is the initial pose set?")

    def destroy(self) -> None:
        """Destroy the action client."""
        self._client.destroy()
