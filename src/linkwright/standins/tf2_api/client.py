"""Lookup of transforms in the buffer of another process (tf2_ros ``BufferClient``)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import phrase
from linkwright.graph.time.values import Duration, Time
from linkwright.graph.transforms.errors import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)
from linkwright.messages import get_action
from linkwright.standins.rclpy_api.action import ActionClient
from linkwright.standins.tf2_api.interface import NO_TIME, BufferInterface

if TYPE_CHECKING:
    from linkwright.standins.rclpy_api.node import Node

_EXCEPTION_CLASSES: dict[int, type[TransformException]] = {
    1: LookupException,
    2: ConnectivityException,
    3: ExtrapolationException,
    4: InvalidArgumentException,
    5: TimeoutException,
    6: TransformException,
}
"""The exception classes by the error numbers of tf2_msgs/msg/TF2Error."""

_NO_ERROR = 0


class BufferClient(BufferInterface):
    """A client that requests transforms from a buffer server through an action.

    Another thread must spin the node.

    Args:
        node: the node of the client.
        ns: the name of the action.
        check_frequency: accepted for compatibility and ignored, because the client does not poll.
        timeout_padding: the additional time to wait for the response after the timeout of a lookup, as a duration or in
            seconds.
    """

    def __init__(
        self,
        node: Node,
        ns: str,
        check_frequency: float = 10.0,
        timeout_padding: Duration | float = Duration(seconds=2.0),  # noqa: B008  # a constant
    ) -> None:
        super().__init__()
        self.node = node
        self._lookup_action = get_action("tf2_msgs/action/LookupTransform")
        self.action_client = ActionClient(node, self._lookup_action, ns)
        self.check_frequency = check_frequency
        self.timeout_padding = (
            timeout_padding if isinstance(timeout_padding, Duration) else Duration(seconds=timeout_padding)
        )

    def destroy(self) -> None:
        """Destroy the action client."""
        self.action_client.destroy()

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NO_TIME) -> Any:
        """Return the transform from the source frame to the target frame at a time.

        Raises:
            TransformException: there is no transform or no response.
        """
        return self._request_transform(
            self._lookup_action.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_to_time_message(time),
                timeout=timeout.to_msg(),
                advanced=False,
            ),
            timeout,
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NO_TIME,
    ) -> Any:
        """Return the transform from a frame at one time to another frame at another time.

        Raises:
            TransformException: there is no transform or no response.
        """
        return self._request_transform(
            self._lookup_action.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_to_time_message(source_time),
                timeout=timeout.to_msg(),
                target_time=_to_time_message(target_time),
                fixed_frame=fixed_frame,
                advanced=True,
            ),
            timeout,
        )

    def can_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Duration = NO_TIME) -> bool:
        """Return whether `lookup_transform` would return a transform."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Duration = NO_TIME,
    ) -> bool:
        """Return whether `lookup_transform_full` would return a transform."""
        try:
            self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        except TransformException:
            return False
        return True

    def _request_transform(self, goal: Any, timeout: Duration) -> Any:
        if not self.action_client.server_is_ready():
            raise TimeoutException(phrase("The BufferServer is not ready."))
        timeout_s = (timeout.nanoseconds + self.timeout_padding.nanoseconds) / 1e9
        goal_future = self.action_client.send_goal_async(goal)
        if not goal_future.wait(timeout_s) or goal_future.cancelled():
            raise TimeoutException(_NO_RESPONSE_TEXT.format("in the specified time"))
        goal_handle = goal_future.result()
        if goal_handle is None or not goal_handle.accepted:
            raise TimeoutException(_NO_RESPONSE_TEXT.format("with accepted status"))
        result_future = goal_handle.get_result_async()
        response = result_future.result() if result_future.wait(timeout_s) else None
        if response is None:
            raise TimeoutException(_NO_RESPONSE_TEXT.format("in the specified time"))
        result = response.result
        if result.error.error != _NO_ERROR:
            raise _EXCEPTION_CLASSES.get(result.error.error, TransformException)(result.error.error_string)
        return result.transform


_NO_RESPONSE_TEXT = phrase(
    "The LookupTransform goal sent to the BufferServer did not come back {}. Something is likely wrong with the server."
)


def _to_time_message(time: Any) -> Any:
    return time.to_msg() if isinstance(time, Time) else time
