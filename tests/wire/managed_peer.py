"""A managed node with an action, on whichever rclpy the interpreter has: ``-m tests.wire.managed_peer NODE_NAME``.

The action is ``/NODE_NAME/fibonacci``; it refuses negative orders and aborts order 0. The node hears all parameter
events and, of the node that it is asked to watch, the transitions.
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

from tests.wire.node_program import SECONDS, result_of, serve_node


class ManagedPeer(LifecycleNode):
    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.changes: list[list[str]] = []
        self.events: list[list[Any]] = []
        self._asking: dict[str, Any] = {}
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

    def act(self, action: str, order: int, cancel_after: int = -1) -> dict[str, Any]:
        """What becomes of a goal, which may be cancelled after some feedback."""
        feedback: list[list[int]] = []
        client = self._asking.get(action) or ActionClient(self, Fibonacci, action)
        self._asking[action] = client  # another one would have to be found by the server first, to get feedback
        assert client.wait_for_server(SECONDS)
        sent = client.send_goal_async(
            Fibonacci.Goal(order=order), feedback_callback=lambda text: feedback.append(list(text.feedback.sequence))
        )
        goal = result_of(sent)
        if not goal.accepted:
            return {"accepted": False}
        result = goal.get_result_async()
        if cancel_after >= 0:
            until = time.monotonic() + SECONDS
            while len(feedback) < cancel_after and time.monotonic() < until:
                time.sleep(0.01)
            assert len(result_of(goal.cancel_goal_async()).goals_canceling) == 1
        answer = result_of(result)
        names = {getattr(GoalStatus, f"STATUS_{name}"): name for name in ("SUCCEEDED", "ABORTED", "CANCELED")}
        sequence = list(answer.result.sequence)
        return {"accepted": True, "status": names[answer.status], "sequence": sequence, "feedback": feedback}

    def acts_are_right(self, action: str, count: int) -> int:
        """How many of many goals had the result that was meant for them."""
        client = ActionClient(self, Fibonacci, action)
        assert client.wait_for_server(SECONDS)
        goals = [result_of(client.send_goal_async(Fibonacci.Goal(order=number % 5 + 2))) for number in range(count)]
        results = [result_of(goal.get_result_async()).result for goal in goals]
        client.destroy()
        return sum(list(result.sequence) == fibonacci(number % 5 + 2) for number, result in enumerate(results))

    def watch(self, node: str) -> None:
        self.create_subscription(
            TransitionEvent,
            f"/{node}/transition_event",
            lambda text: self.changes.append([node, text.start_state.label, text.goal_state.label]),
            10,
        )

    def change(self, node: str, transition: str) -> bool:
        request = ChangeState.Request(transition=Transition(label=transition))
        request.transition.id = getattr(Transition, f"TRANSITION_{transition.upper()}")
        return bool(self._called(ChangeState, f"/{node}/change_state", request).success)

    def state(self, node: str) -> str:
        return str(self._called(GetState, f"/{node}/get_state", GetState.Request()).current_state.label)

    def possible(self, node: str) -> list[str]:
        request = GetAvailableTransitions.Request()
        answer = self._called(GetAvailableTransitions, f"/{node}/get_available_transitions", request)
        return sorted(available_transition.transition.label for available_transition in answer.available_transitions)

    def ends_of(self, topic: str) -> list[int]:
        """How many publishers and subscriptions it knows."""
        return [self.count_publishers(topic), self.count_subscribers(topic)]

    def declare(self, name: str, value: float) -> None:
        self.declare_parameter(name, value)

    def set(self, name: str, value: float) -> None:
        self.set_parameters([Parameter(name, value=value)])

    def events_of(self, node: str, parameter: str) -> list[Any]:
        return [event[1:] for event in self.events if event[0] == f"/{node}" and event[2] == parameter]

    def changes_seen(self) -> list[list[str]]:
        return self.changes

    def _execute(self, goal: Any) -> Any:
        until = time.monotonic() + SECONDS
        while not self.count_subscribers(f"{self._action}/_action/feedback") and time.monotonic() < until:
            time.sleep(0.01)  # whose request has come may not have been found yet by the publisher of feedback
        sequence = fibonacci(1)
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
        for kind in ("new", "changed", "deleted"):
            for parameter in getattr(event, f"{kind}_parameters"):
                self.events.append([event.node, kind, parameter.name, parameter.value.double_value])

    def _called(self, kind: Any, name: str, request: Any) -> Any:
        client = self.create_client(kind, name)
        assert client.wait_for_service(SECONDS)
        answer = result_of(client.call_async(request))
        self.destroy_client(client)
        return answer


def fibonacci(order: int) -> list[int]:
    sequence = [0, 1]
    while len(sequence) <= order:
        sequence.append(sequence[-1] + sequence[-2])
    return sequence


if __name__ == "__main__":
    serve_node(
        ManagedPeer,
        "act acts_are_right watch change state possible ends_of declare set events_of changes_seen",
        threads=4,
    )
