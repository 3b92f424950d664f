"""buffer_server of tf2_ros: looks up transforms for processes that do not receive ``/tf``."""

from __future__ import annotations

from typing import Any

from linkwright.graph import ActionServer, Graph, TransformException
from linkwright.graph.actions.goal import CancelResponse, ServerGoalHandle
from linkwright.graph.time.values import Duration, Time
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
)
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import get_action, get_message
from linkwright.nodes.options import NodeOptions, SingleNode, create_node

_BUFFER_DURATION_S = 120.0
_CHECK_PERIOD_S = 0.01
_OTHER_ERROR_CODE = 6
_ERROR_CODES: dict[type[TransformException], int] = {
    LookupException: 1,
    ConnectivityException: 2,
    ExtrapolationException: 3,
    InvalidArgumentException: 4,
    TimeoutException: 5,
}
"""The codes of tf2_msgs/msg/TF2Error, by exception."""


class Tf2BufferServer(SingleNode):
    """The running buffer_server node.

    It serves the action ``tf2_buffer_server`` (tf2_msgs LookupTransform).

    If the transform for a goal is not available yet, the lookup is repeated until the goal's timeout. As in tf2_ros, an
    error is returned in the result, so every goal that is not canceled succeeds.
    """

    DEFAULT_NAME = "tf_buffer"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        seconds = float(self._node.declare_parameter("buffer_size", _BUFFER_DURATION_S).value)
        self._buffer = BufferCore(Duration(seconds=seconds), logger=self._node.get_logger().get_child("tf2"))
        TransformListener(self._buffer, self._node)
        self._waiting: dict[ServerGoalHandle, int] = {}
        self._check_timer = self._node.create_timer(_CHECK_PERIOD_S, self._execute_ready_goals, autostart=False)
        self._action_type = get_action("tf2_msgs/action/LookupTransform")
        self._error_type = get_message("tf2_msgs/msg/TF2Error")
        ActionServer(
            self._node,
            self._action_type,
            "tf2_buffer_server",
            self._execute,
            handle_accepted_callback=self._handle_accepted,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
        )

    def _handle_accepted(self, handle: ServerGoalHandle) -> None:
        deadline_ns = self._now_ns() + Duration.from_msg(handle.request.timeout).nanoseconds
        if deadline_ns <= self._now_ns() or self._is_available(handle.request):
            handle.execute()
            return
        self._waiting[handle] = deadline_ns
        self._check_timer.reset()

    def _execute_ready_goals(self) -> None:
        now_ns = self._now_ns()
        for handle, deadline_ns in tuple(self._waiting.items()):
            if handle.is_cancel_requested or now_ns >= deadline_ns or self._is_available(handle.request):
                del self._waiting[handle]
                handle.execute()
        if not self._waiting:
            self._check_timer.cancel()

    def _execute(self, handle: ServerGoalHandle) -> Any:
        result = self._action_type.Result()
        if handle.is_cancel_requested:
            handle.canceled()
            return result
        try:
            result.transform = self._look_up_transform(handle.request)
        except TransformException as error:
            error_code = _ERROR_CODES.get(type(error), _OTHER_ERROR_CODE)
            result.error = self._error_type(error=error_code, error_string=error.diagnostics[0].message)
        handle.succeed()
        return result

    def _look_up_transform(self, goal: Any) -> Any:
        source_time = Time.from_msg(goal.source_time)
        if not goal.advanced:
            return self._buffer.lookup_transform_core(goal.target_frame, goal.source_frame, source_time)
        target_time = Time.from_msg(goal.target_time)
        return self._buffer.lookup_transform_full_core(
            goal.target_frame, target_time, goal.source_frame, source_time, goal.fixed_frame
        )

    def _is_available(self, goal: Any) -> bool:
        try:
            self._look_up_transform(goal)
        except TransformException:
            return False
        return True

    def _now_ns(self) -> int:
        return self._node.get_clock().now().nanoseconds
