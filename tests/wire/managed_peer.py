"""A managed node with an action, on any rclpy of the interpreter.

Run it with ``-m tests.wire.managed_peer NODE_NAME``.

The action is ``/NODE_NAME/fibonacci``; it rejects negative orders and aborts order 0. The node records all parameter
events, and the transitions of the nodes that it watches.
"""

from __future__ import annotations

import time
from typing import Any

from action_msgs.msg import GoalStatus
from lifecycle_msgs.msg import Transition, TransitionEvent
from lifecycle_msgs.srv import ChangeState, GetAvailableTransitions, GetState
from rcl_interfaces.msg import ParameterEvent
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.lifecycle import LifecycleNode
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from test_msgs.action import Fibonacci

from tests.wire.node_program import TIMEOUT_S, result_of, serve_node


class ManagedPeer(LifecycleNode):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.changes: list[list[str]] = []
        self.events: list[list[Any]] = []
        self._action_clients: dict[str, Any] = {}
        self._action = f"/{name}/fibonacci"
        self._server = ActionServer(
            self,
            Fibonacci,
            self._action,
            self._execute,
            goal_callback=lambda goal: GoalResponse.REJECT if goal.order < 0 else GoalResponse.ACCEPT,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
        )
        self.create_subscription(ParameterEvent, "/parameter_events", self._on_parameters, QoSProfile(depth=1000))

    def send_goal(self, action: str, order: int, cancel_after: int = -1) -> dict[str, Any]:
        """Send a goal, cancel it after some feedback if asked to, and return its result."""
        feedback: list[list[int]] = []
        client = self._action_clients.get(action) or ActionClient(self, Fibonacci, action)
        self._action_clients[action] = client  # a new client gets no feedback until the server has discovered it
        assert client.wait_for_server(TIMEOUT_S)
        sent = client.send_goal_async(
            Fibonacci.Goal(order=order),
            feedback_callback=lambda message: feedback.append(list(message.feedback.sequence)),
        )
        goal = result_of(sent)
        if not goal.accepted:
            return {"accepted": False}
        result = goal.get_result_async()
        if cancel_after >= 0:
            deadline = time.monotonic() + TIMEOUT_S
            while len(feedback) < cancel_after and time.monotonic() < deadline:
                time.sleep(0.01)
            assert len(result_of(goal.cancel_goal_async()).goals_canceling) == 1
        answer = result_of(result)
        names = {getattr(GoalStatus, f"STATUS_{name}"): name for name in ("SUCCEEDED", "ABORTED", "CANCELED")}
        sequence = list(answer.result.sequence)
        return {"accepted": True, "status": names[answer.status], "sequence": sequence, "feedback": feedback}

    def count_correct_goals(self, action: str, count: int) -> int:
        """Send many goals, and return the number of correct results."""
        client = ActionClient(self, Fibonacci, action)
        assert client.wait_for_server(TIMEOUT_S)
        goals = [result_of(client.send_goal_async(Fibonacci.Goal(order=number % 5 + 2))) for number in range(count)]
        results = [result_of(goal.get_result_async()).result for goal in goals]
        client.destroy()
        return sum(list(result.sequence) == fibonacci_sequence(number % 5 + 2) for number, result in enumerate(results))

    def watch(self, node: str) -> None:
        self.create_subscription(
            TransitionEvent,
            f"/{node}/transition_event",
            lambda event: self.changes.append([node, event.start_state.label, event.goal_state.label]),
            10,
        )

    def change(self, node: str, transition: str) -> bool:
        request = ChangeState.Request(transition=Transition(label=transition))
        request.transition.id = getattr(Transition, f"TRANSITION_{transition.upper()}")
        return bool(self._call(ChangeState, f"/{node}/change_state", request).success)

    def state(self, node: str) -> str:
        return str(self._call(GetState, f"/{node}/get_state", GetState.Request()).current_state.label)

    def available_transitions(self, node: str) -> list[str]:
        request = GetAvailableTransitions.Request()
        response = self._call(GetAvailableTransitions, f"/{node}/get_available_transitions", request)
        return sorted(available_transition.transition.label for available_transition in response.available_transitions)

    def endpoint_counts(self, topic: str) -> list[int]:
        """Return the number of publishers and of subscriptions that the node has discovered."""
        return [self.count_publishers(topic), self.count_subscribers(topic)]

    def declare(self, name: str, value: float) -> None:
        self.declare_parameter(name, value)

    def set(self, name: str, value: float) -> None:
        self.set_parameters([Parameter(name, value=value)])

    def events_of(self, node: str, parameter: str) -> list[Any]:
        return [event[1:] for event in self.events if event[0] == f"/{node}" and event[2] == parameter]

    def watched_transitions(self) -> list[list[str]]:
        return self.changes

    def _execute(self, goal: Any) -> Any:
        deadline = time.monotonic() + TIMEOUT_S
        while not self.count_subscribers(f"{self._action}/_action/feedback") and time.monotonic() < deadline:
            time.sleep(0.01)  # a request may arrive before the feedback publisher has discovered its client
        sequence = fibonacci_sequence(1)
        for _ in range(goal.request.order - 1):
            if goal.is_cancel_requested:
                goal.canceled()
                return Fibonacci.Result(sequence=sequence)
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
            if goal.request.order > 10:
                time.sleep(0.02)
        if goal.request.order:
            goal.succeed()
        else:
            goal.abort()
        return Fibonacci.Result(sequence=sequence)

    def _on_parameters(self, event: ParameterEvent) -> None:
        for change in ("new", "changed", "deleted"):
            for parameter in getattr(event, f"{change}_parameters"):
                self.events.append([event.node, change, parameter.name, parameter.value.double_value])

    def _call(self, service_type: Any, name: str, request: Any) -> Any:
        client = self.create_client(service_type, name)
        assert client.wait_for_service(TIMEOUT_S)
        response = result_of(client.call_async(request))
        self.destroy_client(client)
        return response


def fibonacci_sequence(order: int) -> list[int]:
    sequence = [0, 1]
    while len(sequence) <= order:
        sequence.append(sequence[-1] + sequence[-2])
    return sequence


if __name__ == "__main__":
    serve_node(
        ManagedPeer,
        "send_goal count_correct_goals watch change state available_transitions endpoint_counts declare set events_of "
        "watched_transitions",
        threads=4,
    )
