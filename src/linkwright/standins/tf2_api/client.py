"""Looks up transforms in the buffer of another process (tf2_ros ``BufferClient``)."""

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

_ERRORS: dict[int, type[TransformException]] = {
    1: LookupException,
    2: ConnectivityException,
    3: ExtrapolationException,
    4: InvalidArgumentException,
    5: TimeoutException,
    6: TransformException,
}
"""The exceptions by the numbers of tf2_msgs/msg/TF2Error."""

_NO_ERROR = 0


class BufferClient(BufferInterface):
    """Requests transforms from a buffer server through its action; another thread must spin the node.

    Args:
        node: the node of the client.
        ns: the name of the action.
        check_frequency: ignored, because the client does not poll.
        timeout_padding: the time to wait for the response in addition to the timeout of the lookup, as a duration or in
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
        self._lookup = get_action("tf2_msgs/action/LookupTransform")
        self.action_client = ActionClient(node, self._lookup, ns)
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
        return self._ask(
            self._lookup.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_message(time),
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
        """Return the transform from the source frame at one time to the target frame at another time.

        Raises:
            TransformException: there is no transform or no response.
        """
        return self._ask(
            self._lookup.Goal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=_message(source_time),
                timeout=timeout.to_msg(),
                target_time=_message(target_time),
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

    def _ask(self, goal: Any, timeout: Duration) -> Any:
        if not self.action_client.server_is_ready():
            raise TimeoutException(phrase("The BufferServer is not ready."))
        wait_sec = (timeout.nanoseconds + self.timeout_padding.nanoseconds) / 1e9
        sent = self.action_client.send_goal_async(goal)
        if not sent.wait(wait_sec) or sent.cancelled():
            raise TimeoutException(_NO_ANSWER.format("in the specified time"))
        handle = sent.result()
        if handle is None or not handle.accepted:
            raise TimeoutException(_NO_ANSWER.format("with accepted status"))
        asked = handle.get_result_async()
        answer = asked.result() if asked.wait(wait_sec) else None
        if answer is None:
            raise TimeoutException(_NO_ANSWER.format("in the specified time"))
        result = answer.result
        if result.error.error != _NO_ERROR:
            raise _ERRORS.get(result.error.error, TransformException)(result.error.error_string)
        return result.transform


_NO_ANSWER = phrase(
    "The LookupTransform goal sent to the BufferServer did not come back {}. Something is likely wrong with the server."
)


def _message(time: Any) -> Any:
    return time.to_msg() if isinstance(time, Time) else time
