"""The action that visits actions after a period of ROS time, real or simulated."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from linkwright.launch.model.actions.timer import TimerAction
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.expose import expose_action

if TYPE_CHECKING:
    from linkwright.graph import Node, Timer
    from linkwright.launch.model.running_launch import Schedule, Scheduled


@expose_action("ros_timer")
class RosTimer(TimerAction):
    """An action that visits actions once, after a period of ROS time.

    The timer uses the clock of the launcher's node. This node follows ``/clock`` after a `SetUseSimTime` was visited,
    even if the timer was started before that.
    """

    def _schedule(self, context: LaunchContext) -> Schedule:
        node = context.session.host.launcher_node

        def schedule(seconds: float, callback: Callable[[], None]) -> Scheduled:
            return _OneShotTimer(node, seconds, callback)

        return schedule


class _OneShotTimer:
    """A timer of a node that calls a function once.

    Args:
        node: the node that owns the timer.
        seconds: the delay in seconds, on the clock of the node.
        callback: the function to call.
    """

    def __init__(self, node: Node, seconds: float, callback: Callable[[], None]) -> None:
        self._node = node
        self._due = callback
        self._timer: Timer | None = node.create_timer(seconds, self._fire)

    def cancel(self) -> None:
        """Cancel the timer."""
        if self._timer is not None:
            self._node.destroy_timer(self._timer)
            self._timer = None

    def _fire(self) -> None:
        self.cancel()
        self._due()
