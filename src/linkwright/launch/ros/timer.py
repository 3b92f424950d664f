"""The action that visits actions after a period of ROS time, which may be simulated."""

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
    """Visits actions once, after a period of ROS time.

    The timer uses the clock of the launcher's node. This node follows ``/clock`` as soon as `SetUseSimTime` has been
    visited, even if that happens after the timer starts.
    """

    def _schedule(self, context: LaunchContext) -> Schedule:
        node = context.session.host.launcher_node

        def schedule(seconds: float, due: Callable[[], None]) -> Scheduled:
            return _OneShotTimer(node, seconds, due)

        return schedule


class _OneShotTimer:
    """A timer of a node that calls a function once."""

    def __init__(self, node: Node, seconds: float, due: Callable[[], None]) -> None:
        self._node = node
        self._due = due
        self._timer: Timer | None = node.create_timer(seconds, self._fire)

    def cancel(self) -> None:
        """Cancel the timer."""
        if self._timer is not None:
            self._node.destroy_timer(self._timer)
            self._timer = None

    def _fire(self) -> None:
        self.cancel()
        self._due()
