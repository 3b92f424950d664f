"""Action servers and clients as users write them, and managed nodes."""

from __future__ import annotations

import threading
import time
from collections import deque

import pytest
import rclpy
from action_msgs.msg import GoalStatus
from example_interfaces.action import Fibonacci
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.action import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    get_action_names_and_types,
    get_action_server_names_and_types_by_node,
)
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, State, TransitionCallbackReturn
from rclpy.node import Node
from std_msgs.msg import String

from tests.waiting import wait_until


@pytest.fixture(autouse=True)
def _ros(monkeypatch):
    monkeypatch.setenv("LINKWRIGHT_DDS", "0")
    rclpy.init(args=[])
    yield
    rclpy.try_shutdown()


def fibonacci_sequence(order):
    sequence = [0, 1]
    while len(sequence) <= order:
        sequence.append(sequence[-1] + sequence[-2])
    return sequence


class FibonacciServer(Node):
    """An action server that counts, sends feedback, and can be canceled."""

    def __init__(self, pause=0.005, **options):
        super().__init__("fibonacci_server")
        self.pause = pause
        self._action_server = ActionServer(
            self,
            Fibonacci,
            "fibonacci",
            execute_callback=self.execute_callback,
            callback_group=ReentrantCallbackGroup(),
            goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 100 else GoalResponse.REJECT,
            cancel_callback=lambda _handle: CancelResponse.ACCEPT,
            **options,
        )

    async def execute_callback(self, goal_handle):
        feedback = Fibonacci.Feedback()
        for length in range(2, goal_handle.request.order + 2):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return Fibonacci.Result(sequence=fibonacci_sequence(length - 2))
            feedback.sequence = fibonacci_sequence(length - 1)
            goal_handle.publish_feedback(feedback)
            time.sleep(self.pause)  # noqa: ASYNC251  # as users write it
        goal_handle.succeed()
        return Fibonacci.Result(sequence=fibonacci_sequence(goal_handle.request.order))


class FibonacciClient(Node):
    """An action client that continues in callbacks."""

    def __init__(self):
        super().__init__("fibonacci_client")
        self.client = ActionClient(self, Fibonacci, "fibonacci")
        self.feedback, self.outcome = [], rclpy.task.Future()

    def send_goal(self, order, cancel_after=None):
        assert self.client.wait_for_server(timeout_sec=60.0)
        self.cancel_after = cancel_after
        sent = self.client.send_goal_async(Fibonacci.Goal(order=order), feedback_callback=self.feedback_callback)
        sent.add_done_callback(self.goal_response_callback)

    def goal_response_callback(self, future):
        self.goal = future.result()
        if not self.goal.accepted:
            self.outcome.set_result("rejected")
            return
        self.goal.get_result_async().add_done_callback(self.get_result_callback)

    def feedback_callback(self, feedback):
        self.feedback.append(feedback.feedback.sequence.tolist())
        if len(self.feedback) == self.cancel_after:
            self.goal.cancel_goal_async().add_done_callback(self.canceled_callback)

    def canceled_callback(self, future):
        self.canceling = len(future.result().goals_canceling)

    def get_result_callback(self, future):
        self.outcome.set_result(future.result())


@pytest.fixture
def spin_nodes():
    """Spin nodes in one of several threads."""
    executor = MultiThreadedExecutor(4)
    thread = threading.Thread(target=executor.spin, daemon=True)
    thread.start()
    yield lambda *nodes: [executor.add_node(node) for node in nodes]
    executor.shutdown()
    thread.join(60.0)


class TestActions:
    def test_goal_succeeds_with_feedback_and_result(self, spin_nodes):
        server, client = FibonacciServer(), FibonacciClient()
        spin_nodes(server, client)
        client.send_goal(6)
        assert client.outcome.wait(60.0)
        outcome = client.outcome.result()
        assert outcome.status == GoalStatus.STATUS_SUCCEEDED
        assert outcome.result.sequence.tolist() == fibonacci_sequence(6)
        assert client.feedback == [fibonacci_sequence(length) for length in range(1, 7)]

    def test_server_and_client_share_one_executor(self):
        server, client = FibonacciServer(), FibonacciClient()
        executor = SingleThreadedExecutor()
        executor.add_node(server)
        executor.add_node(client)
        client.send_goal(4)
        executor.spin_until_future_complete(client.outcome, timeout_sec=60.0)
        assert client.outcome.result().result.sequence.tolist() == fibonacci_sequence(4)

    def test_goal_is_canceled(self, spin_nodes):
        server, client = FibonacciServer(pause=0.02), FibonacciClient()
        spin_nodes(server, client)
        client.send_goal(90 // 2, cancel_after=3)
        assert client.outcome.wait(60.0)
        assert client.outcome.result().status == GoalStatus.STATUS_CANCELED
        assert client.canceling == 1
        assert len(client.feedback) < 40

    def test_goal_is_rejected(self, spin_nodes):
        server, client = FibonacciServer(), FibonacciClient()
        spin_nodes(server, client)
        client.send_goal(200)
        assert client.outcome.wait(60.0)
        assert client.outcome.result() == "rejected"

    def test_goal_without_final_state_is_aborted(self, spin_nodes):
        node, client = Node("silent"), FibonacciClient()
        ActionServer(node, Fibonacci, "fibonacci", lambda _handle: Fibonacci.Result())
        spin_nodes(node, client)
        client.send_goal(1)
        assert client.outcome.wait(60.0)
        assert client.outcome.result().status == GoalStatus.STATUS_ABORTED

    def test_accepted_goal_is_executed_later(self, spin_nodes):
        waiting = []
        server, client = FibonacciServer(handle_accepted_callback=waiting.append), FibonacciClient()
        spin_nodes(server, client)
        client.send_goal(2)
        wait_until(lambda: waiting)
        assert not client.outcome.wait(0.1)
        waiting[0].execute()
        assert client.outcome.wait(60.0)
        assert client.outcome.result().status == GoalStatus.STATUS_SUCCEEDED

    def test_queued_goals_run_one_after_another(self, spin_nodes):
        class Queued(FibonacciServer):
            def __init__(self):
                self.queue, self.current, self.lock, self.most = deque(), None, threading.Lock(), 0
                super().__init__(handle_accepted_callback=self.handle_accepted)

            def handle_accepted(self, handle):
                with self.lock:
                    if self.current is not None:
                        self.queue.append(handle)
                    else:
                        self.current = handle
                        handle.execute()

            async def execute_callback(self, goal_handle):
                try:
                    return await super().execute_callback(goal_handle)
                finally:
                    with self.lock:
                        self.current = self.queue.popleft() if self.queue else None
                        if self.current is not None:
                            self.current.execute()

        server, clients = Queued(), [FibonacciClient() for _ in range(3)]
        spin_nodes(server, *clients)
        for client in clients:
            client.send_goal(3)
        for client in clients:
            assert client.outcome.wait(60.0)
            assert client.outcome.result().result.sequence.tolist() == fibonacci_sequence(3)

    def test_new_goal_aborts_previous_goal(self, spin_nodes):
        class Single(FibonacciServer):
            goal = None

            def __init__(self):
                super().__init__(pause=0.02, handle_accepted_callback=self.handle_accepted)

            def handle_accepted(self, handle):
                if self.goal is not None and self.goal.is_active:
                    self.goal.abort()
                self.goal = handle
                handle.execute()

            async def execute_callback(self, goal_handle):
                for _ in range(20):
                    if not goal_handle.is_active:
                        return Fibonacci.Result()
                    time.sleep(self.pause)  # noqa: ASYNC251
                goal_handle.succeed()
                return Fibonacci.Result()

        server, first, second = Single(), FibonacciClient(), FibonacciClient()
        spin_nodes(server, first, second)
        first.send_goal(1)
        wait_until(lambda: server.goal is not None)
        second.send_goal(1)
        assert first.outcome.wait(60.0)
        assert second.outcome.wait(60.0)
        assert first.outcome.result().status == GoalStatus.STATUS_ABORTED
        assert second.outcome.result().status == GoalStatus.STATUS_SUCCEEDED

    def test_send_goal_blocks_beside_spinning_thread(self, spin_nodes):
        server, client = FibonacciServer(), FibonacciClient()
        spin_nodes(server, client)
        result = client.client.send_goal(Fibonacci.Goal(order=3))
        assert result.result.sequence.tolist() == fibonacci_sequence(3)

    def test_goal_and_result_are_awaited_in_coroutine(self, spin_nodes):
        server, client = FibonacciServer(), FibonacciClient()
        results = []

        async def work():
            timer.cancel()
            handle = await client.client.send_goal_async(Fibonacci.Goal(order=2))
            results.append((await handle.get_result_async()).result.sequence.tolist())

        timer = client.create_timer(0.01, work, callback_group=ReentrantCallbackGroup())
        spin_nodes(server, client)
        wait_until(lambda: results)
        assert results == [fibonacci_sequence(2)]

    def test_action_names_and_types_are_listed(self):
        server = FibonacciServer()
        assert ("/fibonacci", ["example_interfaces/action/Fibonacci"]) in get_action_names_and_types(server)
        assert get_action_server_names_and_types_by_node(server, "fibonacci_server", "/") == [
            ("/fibonacci", ["example_interfaces/action/Fibonacci"])
        ]

    def test_wait_for_server_times_out(self):
        client = FibonacciClient()
        assert not client.client.wait_for_server(timeout_sec=0.05)
        assert not client.client.server_is_ready()


class ManagedNode(LifecycleNode):
    """Publishes while it is active."""

    def __init__(self, name, **options):
        self.seen = []
        super().__init__(name, **options)

    def publish(self):
        self.pub.publish(String(data="active"))

    def on_configure(self, state: State) -> TransitionCallbackReturn:
        self.seen.append(state.label)
        self.pub = self.create_lifecycle_publisher(String, "lifecycle_chatter", 10)
        self.timer_ = self.create_timer(0.005, self.publish)
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: State) -> TransitionCallbackReturn:
        self.seen.append(state.label)
        return super().on_activate(state)

    def on_cleanup(self, state: State) -> TransitionCallbackReturn:
        self.destroy_timer(self.timer_)
        self.destroy_publisher(self.pub)
        return TransitionCallbackReturn.SUCCESS


class TestLifecycle:
    def test_transitions_are_triggered_by_methods(self):
        node = ManagedNode("managed", enable_communication_interface=False)
        assert node.trigger_configure() == TransitionCallbackReturn.SUCCESS
        assert node.trigger_activate() == TransitionCallbackReturn.SUCCESS
        assert node.trigger_deactivate() == TransitionCallbackReturn.SUCCESS
        assert node.trigger_cleanup() == TransitionCallbackReturn.SUCCESS
        assert node.trigger_shutdown() == TransitionCallbackReturn.SUCCESS
        assert node.seen == ["unconfigured", "inactive"]

    def test_lifecycle_publisher_is_silent_unless_active(self):
        node, heard = ManagedNode("managed", enable_communication_interface=False), []
        listener = rclpy.create_node("listener")
        listener.create_subscription(String, "lifecycle_chatter", heard.append, 10)
        executor = SingleThreadedExecutor()
        executor.add_node(node)
        executor.add_node(listener)
        node.trigger_configure()
        for _ in range(5):
            executor.spin_once(timeout_sec=0.02)
        assert heard == []
        node.trigger_activate()
        for _ in range(5):
            executor.spin_once(timeout_sec=0.05)
        assert heard

    def test_transitions_are_triggered_by_services(self, spin_nodes):
        node, client = ManagedNode("managed"), rclpy.create_node("client")
        spin_nodes(node, client)
        change = client.create_client(ChangeState, "/managed/change_state")
        state = client.create_client(GetState, "/managed/get_state")
        assert change.wait_for_service(timeout_sec=60.0)
        request = ChangeState.Request()
        request.transition.id = Transition.TRANSITION_CONFIGURE
        assert change.call(request).success
        assert state.call(GetState.Request()).current_state.label == "inactive"
        request.transition.id = Transition.TRANSITION_CONFIGURE
        assert not change.call(request).success

    def test_exception_in_transition_returns_error(self):
        class Failing(LifecycleNode):
            def on_configure(self, _state):
                raise ValueError("mine")

        node = Failing("failing", enable_communication_interface=False)
        assert node.trigger_configure() == TransitionCallbackReturn.ERROR
        assert node._state_machine.state.label == "unconfigured"

    def test_communication_interface_must_be_bool(self):
        with pytest.raises(TypeError):
            LifecycleNode("wrong", enable_communication_interface="yes")
