"""A node with services and an action for many simultaneous calls.

It runs on any rclpy of the interpreter.

``-m tests.wire.load_peer NODE_NAME``. Below ``/NODE_NAME`` it serves `SetBool`, `BasicTypes`, `SetCameraInfo` and its
parameters, and one goal of `Fibonacci` at a time: a new goal aborts the previous one.
"""

from __future__ import annotations

import threading
import time
from typing import Any

from action_msgs.msg import GoalStatus
from rcl_interfaces.srv import GetParameters
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from sensor_msgs.msg import JointState
from sensor_msgs.srv import SetCameraInfo
from std_srvs.srv import SetBool
from test_msgs.action import Fibonacci
from test_msgs.srv import BasicTypes

from tests.wire.node_program import TIMEOUT_S, result_of, serve_node

MAX_PENDING_CALLS = 3
"""The number of simultaneous calls of one process; three such processes stay within the 10 requests that a
service's queue holds."""
ENDLESS_ORDER = 1_000_000
"""The order of a goal that does not end on its own."""


class LoadPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.declare_parameters("", [(f"number_{number}", number) for number in range(10)])
        self.create_service(SetBool, f"/{name}/flip", answer_set_bool)
        self.create_service(BasicTypes, f"/{name}/basic", answer_basic_types)
        self.create_service(SetCameraInfo, f"/{name}/camera", answer_camera_info)
        self._current: Any = None
        self._lock = threading.Lock()
        self._server = ActionServer(
            self,
            Fibonacci,
            f"/{name}/single",
            self._execute,
            callback_group=ReentrantCallbackGroup(),
            handle_accepted_callback=self._accept,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        self._states = self.create_publisher(JointState, f"/{name}/states", 10)
        self._received_count = 0

    def exchange_states(self, rate: float, other: str) -> None:
        """Publish states until the node ends, and count the states of another node."""
        self.create_subscription(JointState, f"/{other}/states", self._on_state, 10)
        self.create_timer(1 / rate, lambda: self._states.publish(JointState(name=["a"] * 12, position=[0.5] * 12)))

    def received_count(self) -> int:
        return self._received_count

    def count_correct_calls(self, server: str, count: int, tag: str) -> int:
        """Make many calls to four kinds of services, several at a time.

        Return the number of correct responses.
        """
        service_types = {"flip": SetBool, "basic": BasicTypes, "camera": SetCameraInfo, "get_parameters": GetParameters}
        clients = [
            self.create_client(service_type, f"/{server}/{name}") for name, service_type in service_types.items()
        ]
        assert all(client.wait_for_service(TIMEOUT_S) for client in clients)
        slots = threading.Semaphore(MAX_PENDING_CALLS)
        futures = []
        for number in range(count):
            if not slots.acquire(timeout=TIMEOUT_S):
                break
            future = clients[number % 4].call_async(make_request(number, tag))
            future.add_done_callback(lambda _: slots.release())
            futures.append(future)
        for _ in range(MAX_PENDING_CALLS):
            slots.acquire(timeout=TIMEOUT_S)  # wait for the last calls
        return sum(future.done() and is_correct(number, tag, future.result()) for number, future in enumerate(futures))

    def run_goals(self, server: str, count: int) -> list[str]:
        """Send endless goals one after another, and return how each ends.

        Every third goal is cancelled; each of the others is aborted by the next goal.
        """
        client = ActionClient(self, Fibonacci, f"/{server}/single")
        assert client.wait_for_server(TIMEOUT_S)
        results = []
        for number in range(count):
            feedback_event = threading.Event()
            order = ENDLESS_ORDER if number < count - 1 else 5
            sent = client.send_goal_async(
                Fibonacci.Goal(order=order), feedback_callback=lambda _, on=feedback_event: on.set()
            )
            goal = result_of(sent)
            assert goal.accepted
            results.append(goal.get_result_async())
            if order == ENDLESS_ORDER:
                assert feedback_event.wait(TIMEOUT_S)
            if number % 3 == 2 and order == ENDLESS_ORDER:
                assert len(result_of(goal.cancel_goal_async()).goals_canceling) == 1
        names = {getattr(GoalStatus, f"STATUS_{name}"): name for name in ("SUCCEEDED", "ABORTED", "CANCELED")}
        ends = [names[result_of(result).status] for result in results]
        client.destroy()
        return ends

    def _accept(self, goal: Any) -> None:
        with self._lock:
            self._current = goal
        goal.execute()

    def _execute(self, goal: Any) -> Any:
        sequence = [0, 1]
        while len(sequence) <= goal.request.order:
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=sequence)
            if goal is not self._current:
                goal.abort()
                return Fibonacci.Result(sequence=sequence)
            sequence = (
                [*sequence, 1][-20:]
                if goal.request.order == ENDLESS_ORDER
                else [*sequence, sequence[-1] + sequence[-2]]
            )
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            time.sleep(0.02)
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    def _on_state(self, _: JointState) -> None:
        self._received_count += 1


def make_request(number: int, tag: str) -> Any:
    """Return request n; the four kinds of services take turns."""
    if number % 4 == 0:
        return SetBool.Request(data=number % 8 == 0)
    if number % 4 == 1:
        return BasicTypes.Request(int64_value=number, string_value=tag)
    if number % 4 == 2:
        camera_request = SetCameraInfo.Request()
        camera_request.camera_info.distortion_model = f"{tag} {number}"
        return camera_request
    return GetParameters.Request(names=[f"number_{number % 10}"])


def is_correct(number: int, tag: str, response: Any) -> bool:
    """Return whether a response belongs to the request of this number."""
    if number % 4 == 0:
        return bool(response.success) != (number % 8 == 0)
    if number % 4 == 1:
        return (response.int64_value, response.string_value) == (-number, f"{tag} {number}")
    if number % 4 == 2:
        return bool(response.status_message == f"{tag} {number}")
    return [value.integer_value for value in response.values] == [number % 10]


def answer_set_bool(request: Any, response: Any) -> Any:
    response.success = not request.data
    return response


def answer_basic_types(request: Any, response: Any) -> Any:
    response.int64_value, response.string_value = -request.int64_value, f"{request.string_value} {request.int64_value}"
    return response


def answer_camera_info(request: Any, response: Any) -> Any:
    response.success, response.status_message = True, request.camera_info.distortion_model
    return response


if __name__ == "__main__":
    serve_node(LoadPeer, "exchange_states received_count count_correct_calls run_goals", threads=6)
