"""The requests of commands to nodes: action goals, service calls, messages, launch files."""

from __future__ import annotations

import subprocess
import threading
from collections.abc import Callable
from functools import partial
from math import cos, sin
from typing import Any

from linkwright.graph import ActionClient, Client, Node, Publisher
from linkwright.graph.actions.goal import GoalStatus
from linkwright.graph.endpoints.base import EndpointKind
from linkwright.messages import get_action, get_message, get_service, set_fields
from linkwright.packages.programs.child_python import python_command
from linkwright.process.interruption import interrupt
from linkwright.speech.commands.actions import (
    CallService,
    GoTo,
    Launch,
    Publish,
    SendGoal,
    Values,
    fill_template,
    format_value,
)
from linkwright.speech.commands.command_set import Destination

NAVIGATE = "nav2_msgs/action/NavigateToPose"
_QUEUE_DEPTH = 10
_EXIT_TIMEOUT_S = 5.0
"""The time in s that a launch file has to end before it is killed."""


class ActionGoals:
    """A client of one action with at most one goal at a time.

    Args:
        node: the node that sends the goals.
        type_name: the type of the action.
        name: the name of the action.
        on_end: called when a goal ends, with whether it was reached, and the server's reason or an empty string. It is
            not called for a goal that was canceled or replaced.
    """

    def __init__(self, node: Node, type_name: str, name: str, on_end: Callable[[bool, str], None]) -> None:
        self._on_end = on_end
        self._client = ActionClient(node, type_name, name)
        self._cancel_client = node.create_client("action_msgs/srv/CancelGoal", f"{name}/_action/cancel_goal")
        self._number = 0
        self._handle: Any = None
        self.is_active = False

    @property
    def is_served(self) -> bool:
        """Whether an action server is available."""
        return self._client.server_is_ready()

    def send(self, goal: Any) -> None:
        """Send a goal, replacing the previous one."""
        self._number += 1
        self.is_active = True
        self._client.send_goal_async(goal).add_done_callback(partial(self._receive_response, self._number))

    def cancel(self) -> None:
        """Cancel the goal of this client."""
        handle, self._handle = self._handle, None
        self._number += 1
        if self.is_active and handle is not None:
            handle.cancel_goal_async()
        self.is_active = False

    def cancel_all(self) -> None:
        """Cancel all goals of the action, including goals of other clients."""
        self.cancel()
        if self._cancel_client.service_is_ready():
            self._cancel_client.call_async(self._cancel_client.srv_type.Request())

    def _receive_response(self, number: int, future: Any) -> None:
        handle = future.result()
        if number != self._number:
            if handle.accepted and not self.is_active:
                handle.cancel_goal_async()
        elif handle.accepted:
            self._handle = handle
            handle.get_result_async().add_done_callback(partial(self._receive_result, number))
        else:
            self._finish(False, "")

    def _receive_result(self, number: int, future: Any) -> None:
        if number == self._number:
            result = future.result()
            self._finish(result.status == GoalStatus.SUCCEEDED, getattr(result.result, "error_msg", ""))

    def _finish(self, is_reached: bool, reason: str) -> None:
        self._handle, self.is_active = None, False
        self._on_end(is_reached, reason)


def make_pose_goal(node: Node, place: Destination) -> Any:
    """Return a goal of ``navigate_to_pose`` for a place, stamped now."""
    goal = get_action(NAVIGATE).Goal()
    goal.pose.header.frame_id = place.frame
    goal.pose.header.stamp = node.get_clock().now().to_msg()
    goal.pose.pose.position.x, goal.pose.pose.position.y = place.x, place.y
    goal.pose.pose.orientation.z, goal.pose.pose.orientation.w = sin(place.yaw / 2), cos(place.yaw / 2)
    return goal


class Requests:
    """The clients and publishers for all requests of commands.

    Args:
        node: the node that sends requests.
        on_goal_end: called when a goal has ended; see `ActionGoals`.
        respond: called with the field ``message`` of a service's response.
    """

    def __init__(self, node: Node, on_goal_end: Callable[[bool, str], None], respond: Callable[[str], None]) -> None:
        self._node, self._on_goal_end, self._respond = node, on_goal_end, respond
        self._goals: dict[str, ActionGoals] = {}
        self._publishers: dict[str, Publisher[Any]] = {}
        self._launch_process: subprocess.Popen[bytes] | None = None
        self._end_thread: threading.Thread | None = None

    @property
    def is_active(self) -> bool:
        """Whether one of the goals, or the launch file, is active."""
        return self._is_launched or any(goals.is_active for goals in self._goals.values())

    def prepare(self, action: object) -> None:
        """Create the clients and publishers for an action, because they take some time to connect.

        A client of a service is only created for a call, so that nothing waits for services that only some commands
        need.
        """
        if isinstance(action, GoTo):
            self._goals.setdefault(action.action, ActionGoals(self._node, NAVIGATE, action.action, self._on_goal_end))
        elif isinstance(action, SendGoal) and action.action not in self._goals:
            self._goals[action.action] = ActionGoals(self._node, action.type_name, action.action, self._on_goal_end)
        elif isinstance(action, Publish) and action.topic not in self._publishers:
            message_class = get_message(action.type_name)
            self._publishers[action.topic] = self._node.create_publisher(message_class, action.topic, _QUEUE_DEPTH)

    def send_pose(self, action: str, place: Destination) -> bool:
        """Send a goal to navigate to a place, or return False if there is no server."""
        goals = self._goals[action]
        if goals.is_served:
            goals.send(make_pose_goal(self._node, place))
            return True
        return False

    def send_goal(self, action: SendGoal, values: Values) -> bool:
        """Send a goal of any action, or return False if there is no server."""
        goals = self._goals[action.action]
        if not goals.is_served:
            return False
        goal = get_action(action.type_name).Goal()
        self._set_fields(goal, fill_template(action.goal, values))
        goals.send(goal)
        return True

    def call(self, action: CallService, values: Values) -> bool:
        """Call a service, or return False if there is no server."""
        if not self._is_served(action):
            return False
        client = self._node.create_client(get_service(action.type_name), action.name)
        request = client.srv_type.Request()
        self._set_fields(request, fill_template(action.request, values))
        client.call_async(request).add_done_callback(partial(self._receive_service_response, client))
        return True

    def publish(self, action: Publish, values: Values) -> None:
        """Publish a message."""
        publisher = self._publishers[action.topic]
        message = publisher.msg_type()
        self._set_fields(message, fill_template(action.message, values))
        publisher.publish(message)

    def launch(self, action: Launch, values: Values) -> None:
        """Start a launch file in a separate process, and end the previous one."""
        self._interrupt_launch()
        launch_arguments = [
            f"{name}:={_format_argument(value)}" for name, value in fill_template(action.arguments, values).items()
        ]
        command = python_command(["-m", "linkwright", "launch", action.package, action.file, *launch_arguments])
        self._launch_process = subprocess.Popen(command, stdin=subprocess.DEVNULL)  # noqa: S603 - fixed words, no shell

    def cancel(self, except_action: str = "") -> None:
        """Cancel the goals of these requests, and shut down the launch.

        Goals of the action `except_action` are not canceled.
        """
        for name, goals in self._goals.items():
            if name != except_action:
                goals.cancel()
        self._interrupt_launch()

    def cancel_all(self) -> None:
        """Shut down the launch, and cancel all goals of the commands' actions.

        Goals that other clients have sent to these actions are included.
        """
        for goals in self._goals.values():
            goals.cancel_all()
        self._interrupt_launch()

    def close(self) -> None:
        """Cancel all goals, shut down the launch, and wait until its process exits."""
        self.cancel()
        if self._end_thread is not None:
            self._end_thread.join()

    @property
    def _is_launched(self) -> bool:
        return self._launch_process is not None and self._launch_process.poll() is None

    def _interrupt_launch(self) -> None:
        """Interrupt the process of the launch without waiting for its exit."""
        process, self._launch_process = self._launch_process, None
        if process is None or process.poll() is not None:
            return
        interrupt(process)
        self._end_thread = threading.Thread(target=_wait_or_kill, args=(process,), daemon=True)
        self._end_thread.start()

    def _set_fields(self, message: Any, values: Any) -> None:
        stamp = self._node.get_clock().now().to_msg()
        for set_stamp in set_fields(message, values, expand_header_auto=True, expand_time_now=True):
            set_stamp(stamp)

    def _is_served(self, action: CallService) -> bool:
        service = (EndpointKind.SERVICE, self._node.resolve_service_name(action.name), action.type_name)
        return any(
            (endpoint.kind, endpoint.name, endpoint.type_name) == service for endpoint in self._node.graph.endpoints()
        )

    def _receive_service_response(self, client: Client[Any, Any], future: Any) -> None:
        self._node.destroy_client(client)
        text = getattr(future.result(), "message", "")
        if text and isinstance(text, str):
            self._respond(text)


def _format_argument(value: Any) -> str:
    """Return the value of a launch argument as text."""
    return str(value).lower() if isinstance(value, bool) else format_value(value)


def _wait_or_kill(process: subprocess.Popen[bytes]) -> None:
    """Wait for an interrupted launch file to end, and kill it if it does not."""
    try:
        process.wait(_EXIT_TIMEOUT_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
