"""A node with services and an action that are asked all at once, on whichever rclpy the interpreter has.

``-m tests.wire.load_peer NODE_NAME``. Below ``/NODE_NAME`` it serves `SetBool`, `BasicTypes`, `SetCameraInfo` and its
parameters, and one goal at a time of `Fibonacci`: a new one aborts the one before.
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

from tests.wire.node_program import SECONDS, result_of, serve_node

AT_ONCE = 3
"""So many calls of one process wait for their answers: with three such processes no more than the 10
that a service keeps."""
LONG = 1_000_000
"""The order of a goal that does not end by itself."""


class LoadPeer(Node):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.declare_parameters("", [(f"number_{number}", number) for number in range(10)])
        self.create_service(SetBool, f"/{name}/flip", flip)
        self.create_service(BasicTypes, f"/{name}/basic", basic)
        self.create_service(SetCameraInfo, f"/{name}/camera", camera)
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
        self._others_states = 0

    def chatter(self, rate: float, other: str) -> None:
        """Publish for as long as it lives, and hear somebody else who does."""
        self.create_subscription(JointState, f"/{other}/states", self._hear, 10)
        self.create_timer(1 / rate, lambda: self._states.publish(JointState(name=["a"] * 12, position=[0.5] * 12)))

    def heard(self) -> int:
        return self._others_states

    def storm(self, server: str, count: int, tag: str) -> int:
        """How many of many calls of four kinds got the answer that was meant for them; several wait at a time."""
        kinds = {"flip": SetBool, "basic": BasicTypes, "camera": SetCameraInfo, "get_parameters": GetParameters}
        clients = [self.create_client(kind, f"/{server}/{own}") for own, kind in kinds.items()]
        assert all(client.wait_for_service(SECONDS) for client in clients)
        room = threading.Semaphore(AT_ONCE)
        futures = []
        for number in range(count):
            if not room.acquire(timeout=SECONDS):
                break
            future = clients[number % 4].call_async(request(number, tag))
            future.add_done_callback(lambda _: room.release())
            futures.append(future)
        for _ in range(AT_ONCE):
            room.acquire(timeout=SECONDS)  # the last ones
        return sum(future.done() and is_right(number, tag, future.result()) for number, future in enumerate(futures))

    def goals(self, server: str, count: int) -> list[str]:
        """What becomes of long goals one after another: each third is cancelled, all others by the next one."""
        client = ActionClient(self, Fibonacci, f"/{server}/single")
        assert client.wait_for_server(SECONDS)
        results = []
        for number in range(count):
            feedback_event = threading.Event()
            order = LONG if number < count - 1 else 5
            sent = client.send_goal_async(
                Fibonacci.Goal(order=order), feedback_callback=lambda _, on=feedback_event: on.set()
            )
            goal = result_of(sent)
            assert goal.accepted
            results.append(goal.get_result_async())
            if order == LONG:
                assert feedback_event.wait(SECONDS)
            if number % 3 == 2 and order == LONG:
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
            sequence = [*sequence, 1][-20:] if goal.request.order == LONG else [*sequence, sequence[-1] + sequence[-2]]
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            time.sleep(0.02)
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    def _hear(self, _: JointState) -> None:
        self._others_states += 1


def request(number: int, tag: str) -> Any:
    """The request number n of the four kinds in turn."""
    if number % 4 == 0:
        return SetBool.Request(data=number % 8 == 0)
    if number % 4 == 1:
        return BasicTypes.Request(int64_value=number, string_value=tag)
    if number % 4 == 2:
        camera_request = SetCameraInfo.Request()
        camera_request.camera_info.distortion_model = f"{tag} {number}"
        return camera_request
    return GetParameters.Request(names=[f"number_{number % 10}"])


def is_right(number: int, tag: str, answer: Any) -> bool:
    """Whether an answer is that to the request of this number."""
    if number % 4 == 0:
        return bool(answer.success) != (number % 8 == 0)
    if number % 4 == 1:
        return (answer.int64_value, answer.string_value) == (-number, f"{tag} {number}")
    if number % 4 == 2:
        return bool(answer.status_message == f"{tag} {number}")
    return [value.integer_value for value in answer.values] == [number % 10]


def flip(request: Any, response: Any) -> Any:
    response.success = not request.data
    return response


def basic(request: Any, response: Any) -> Any:
    response.int64_value, response.string_value = -request.int64_value, f"{request.string_value} {request.int64_value}"
    return response


def camera(request: Any, response: Any) -> Any:
    response.success, response.status_message = True, request.camera_info.distortion_model
    return response


if __name__ == "__main__":
    serve_node(LoadPeer, "chatter heard storm goals", threads=6)
