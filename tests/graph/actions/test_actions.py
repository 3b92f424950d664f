"""Action servers and clients: goals, feedback, results and cancellation."""

import asyncio
import threading
import time

import pytest

from linkwright.graph import (
    ActionClient,
    ActionServer,
    CancelResponse,
    GoalResponse,
    GoalStatus,
    Graph,
)
from linkwright.graph.actions.server import ERROR_GOAL_TERMINATED, ERROR_NONE, ERROR_REJECTED, ERROR_UNKNOWN_GOAL_ID
from linkwright.graph.executors import MultiThreadedExecutor
from linkwright.messages import get_action, get_message

Fibonacci = get_action("example_interfaces/action/Fibonacci")
Time = get_message("builtin_interfaces/msg/Time")


def fibonacci_sequence(order):
    numbers = [0, 1]
    while len(numbers) <= order:
        numbers.append(numbers[-1] + numbers[-2])
    return numbers[: order + 1]


def execute_fibonacci(goal):
    for order in range(1, goal.request.order + 1):
        goal.publish_feedback(Fibonacci.Feedback(sequence=fibonacci_sequence(order)))
    goal.succeed()
    return Fibonacci.Result(sequence=fibonacci_sequence(goal.request.order))


class ActionHarness:
    def __init__(self, graph):
        self.graph = graph
        self.server_node, self.client_node = graph.create_node("server"), graph.create_node("client")
        self.client = ActionClient(self.client_node, Fibonacci, "fibonacci")
        self.handles = []

    def serve(self, execute=execute_fibonacci, **options):
        self.server = ActionServer(self.server_node, Fibonacci, "fibonacci", execute, **options)
        return self.server

    def defer(self, **options):
        """Return a server that leaves goals to the test."""
        return self.serve(handle_accepted_callback=self.handles.append, **options)

    async def send(self, order=4, **options):
        return await self.client.send_goal_async(Fibonacci.Goal(order=order), **options)


@pytest.fixture
def harness(graph):
    return ActionHarness(graph)


async def test_goal_succeeds_with_feedback_and_result(harness):
    harness.serve()
    assert harness.client.server_is_ready()
    assert harness.client.wait_for_server(0.1)
    sequences = []
    handle = await harness.send(4, feedback_callback=lambda message: sequences.append(list(message.feedback.sequence)))
    assert handle.accepted
    response = await handle.get_result_async()
    assert list(response.result.sequence) == [0, 1, 1, 2, 3]
    assert response.status == GoalStatus.SUCCEEDED
    assert sequences == [[0, 1], [0, 1, 1], [0, 1, 1, 2], [0, 1, 1, 2, 3]]
    await harness.graph.settle()
    assert handle.status == GoalStatus.SUCCEEDED


async def test_action_client_is_not_ready_without_server(harness):
    assert not harness.client.server_is_ready()
    assert not harness.client.wait_for_server(0.01)
    server = harness.serve()
    assert harness.client.server_is_ready()
    server.destroy()
    assert not harness.client.server_is_ready()


async def test_coroutine_execute_callback_does_not_block_other_callbacks(harness, clock):
    rate = harness.server_node.create_rate(10.0)

    async def work(goal):
        for _ in range(goal.request.order):
            await rate.wait()
        goal.succeed()
        return Fibonacci.Result()

    harness.serve(work)
    short, long = await harness.send(2), await harness.send(5)
    results = [handle.get_result_async() for handle in (short, long)]
    await clock.advance(0.21)
    assert [result.done() for result in results] == [True, False]
    await clock.advance(0.31)
    assert [result.done() for result in results] == [True, True]


async def test_goal_callback_rejects_goals(harness, log):
    harness.serve(goal_callback=lambda goal: GoalResponse.ACCEPT if goal.order < 10 else GoalResponse.REJECT)
    assert not (await harness.send(10)).accepted
    assert (await harness.send(9)).accepted
    harness.server.register_goal_callback(lambda _goal: True)
    assert not (await harness.send(1)).accepted
    assert log[-1].text == "Goal request callback did not return a GoalResponse type. Rejecting goal."


async def test_duplicate_goal_uuid_is_rejected(harness):
    harness.defer()
    first = await harness.send()
    duplicate = await harness.send(goal_uuid=first.goal_id)
    assert first.accepted
    assert not duplicate.accepted


async def test_goal_is_canceled(harness, clock):
    rate = harness.server_node.create_rate(1.0)

    async def work(goal):
        while not goal.is_cancel_requested:
            await rate.wait()
        goal.canceled()
        return Fibonacci.Result(sequence=[7])

    harness.serve(work, cancel_callback=lambda _goal: CancelResponse.ACCEPT)
    handle = await harness.send()
    response = await handle.cancel_goal_async()
    assert response.return_code == ERROR_NONE
    assert [bytes(info.goal_id.uuid) for info in response.goals_canceling] == [bytes(handle.goal_id.uuid)]
    result = handle.get_result_async()
    await clock.advance(1.1)
    assert (await result).status == GoalStatus.CANCELED
    assert list((await result).result.sequence) == [7]
    assert (await handle.cancel_goal_async()).return_code == ERROR_GOAL_TERMINATED


async def test_cancel_is_rejected_without_cancel_callback(harness):
    harness.defer()
    handle = await harness.send()
    response = await handle.cancel_goal_async()
    assert response.return_code == ERROR_REJECTED
    assert list(response.goals_canceling) == []
    assert harness.handles[0].status == GoalStatus.ACCEPTED


async def test_canceling_unknown_goal_is_rejected(harness):
    harness.defer()
    handle = await harness.send()
    harness.server.destroy()
    harness.defer()
    assert (await handle.cancel_goal_async()).return_code == ERROR_UNKNOWN_GOAL_ID
    assert (await handle.get_result_async()).status == GoalStatus.UNKNOWN


async def test_cancel_request_can_match_many_goals(harness, clock):
    harness.defer(cancel_callback=lambda _goal: CancelResponse.ACCEPT)
    for _ in range(3):
        await harness.send()
        await clock.advance(1.0)
    client = harness.client_node.create_client(Fibonacci.Impl.CancelGoalService, "fibonacci/_action/cancel_goal")
    request = Fibonacci.Impl.CancelGoalService.Request()
    request.goal_info.stamp = Time(sec=harness.handles[1].goal_info.stamp.sec, nanosec=0)
    assert len((await client.call_async(request)).goals_canceling) == 2
    assert [goal.is_cancel_requested for goal in harness.handles] == [True, True, False]
    assert len((await client.call_async(Fibonacci.Impl.CancelGoalService.Request())).goals_canceling) == 1
    assert all(goal.is_cancel_requested for goal in harness.handles)


async def test_newer_goal_preempts_older_goal(harness, clock):
    """As in the public example, handle_accepted_callback starts one goal at a time."""
    current = None
    beat = harness.server_node.create_rate(10.0)

    def begin(goal):
        nonlocal current
        if current is not None and current.is_active:
            current.abort()
        current = goal
        goal.execute()

    async def work(goal):
        for _ in range(20):
            if not goal.is_active:
                return Fibonacci.Result()
            await beat.wait()
        goal.succeed()
        return Fibonacci.Result()

    harness.serve(work, handle_accepted_callback=begin)
    results = [(await harness.send()).get_result_async() for _ in range(2)]
    await clock.advance(3.0)
    assert [(await result).status for result in results] == [GoalStatus.ABORTED, GoalStatus.SUCCEEDED]


async def test_goal_is_aborted_if_execute_callback_fails_or_sets_no_state(harness, log):
    def fail(_goal):
        raise ZeroDivisionError("no")

    harness.serve(fail)
    response = await (await harness.send()).get_result_async()
    assert response.status == GoalStatus.ABORTED
    assert "ZeroDivisionError: no" in log[-2].text
    assert log[-1].text.startswith("Goal state not set, assuming aborted. Goal ID: ")
    harness.server.register_execute_callback(lambda _goal: Fibonacci.Result(sequence=[5]))
    response = await (await harness.send()).get_result_async()
    assert (response.status, list(response.result.sequence)) == (GoalStatus.ABORTED, [5])


async def test_result_of_wrong_type_is_reported(harness, log):
    def work(goal):
        goal.succeed()
        return [1, 2]

    harness.serve(work)
    response = await (await harness.send()).get_result_async()
    assert (response.status, list(response.result.sequence)) == (GoalStatus.SUCCEEDED, [])
    assert "returned <class 'list'>, not" in log[-1].text


async def test_result_passed_to_succeed_is_sent_immediately(harness):
    may_finish = asyncio.Event()

    async def work(goal):
        goal.succeed(Fibonacci.Result(sequence=[3]))
        await may_finish.wait()
        return Fibonacci.Result(sequence=[4])

    harness.serve(work)
    response = await (await harness.send()).get_result_async()
    assert list(response.result.sequence) == [3]
    may_finish.set()
    await harness.graph.settle()


async def test_invalid_goal_state_transitions_are_rejected(harness):
    harness.defer()
    await harness.send()
    (goal,) = harness.handles
    with pytest.raises(RuntimeError, match="invalid transition from state ACCEPTED with event SUCCEED"):
        goal.succeed()
    with pytest.raises(RuntimeError, match="with event CANCELED"):
        goal.canceled()
    goal.execute()
    await harness.graph.settle()
    with pytest.raises(RuntimeError, match="invalid transition from state SUCCEEDED with event ABORT"):
        goal.abort()
    goal.destroy()
    assert goal.status == GoalStatus.UNKNOWN
    goal.abort()


async def test_goal_status_reaches_late_subscription(harness):
    harness.defer()
    handle = await harness.send()
    harness.handles[0].execute(lambda goal: (goal.succeed(), Fibonacci.Result())[1])
    await harness.graph.settle()
    statuses = []
    harness.client_node.create_subscription(
        Fibonacci.Impl.GoalStatusMessage,
        "fibonacci/_action/status",
        statuses.append,
        harness.client._status.qos_profile,
    )
    await harness.graph.settle()
    (status,) = statuses[-1].status_list
    assert bytes(status.goal_info.goal_id.uuid) == bytes(handle.goal_id.uuid)
    assert status.status == GoalStatus.SUCCEEDED


@pytest.mark.parametrize(("timeout", "counts_by_time"), [(10, [2, 2, 1, 0]), (-1, [2, 2, 2, 2])])
async def test_results_expire_after_result_timeout(harness, clock, timeout, counts_by_time):
    harness.serve(result_timeout=timeout)
    await (await harness.send()).get_result_async()
    await clock.advance(5.0)
    await (await harness.send()).get_result_async()
    counts = []
    for seconds in (0.0, 4.9, 0.2, 5.0):
        await clock.advance(seconds)
        counts.append(len(harness.server._goal_handles))
    assert counts == counts_by_time


async def test_invalid_callbacks_and_goal_types_are_rejected(harness):
    with pytest.raises(TypeError, match="not callable"):
        harness.serve(None)
    harness.serve()
    with pytest.raises(TypeError, match="Fibonacci_Goal"):
        harness.client.send_goal_async(Fibonacci.Result())
    with pytest.raises(TypeError, match="Expected type ClientGoalHandle"):
        harness.client.cancel("goal")


async def test_actions_are_listed_by_name(harness):
    harness.serve()
    graph, name = harness.graph, "example_interfaces/action/Fibonacci"
    assert graph.get_action_names_and_types() == [("/fibonacci", [name])]
    assert graph.get_action_server_names_and_types_by_node("server", "/") == [("/fibonacci", [name])]
    assert graph.get_action_server_names_and_types_by_node("client", "/") == []
    assert graph.get_action_client_names_and_types_by_node("client", "/") == [("/fibonacci", [name])]


async def test_actions_are_destroyed_with_node(harness):
    harness.serve()
    harness.server_node.destroy_node()
    harness.client_node.destroy_node()
    assert harness.graph.topics() == {}


def test_blocking_execute_callback_works_with_multi_threaded_executor():
    """The execute callback of the server blocks, as in most tutorials."""
    graph = Graph(threads=True, on_log=print)
    nodes = graph.create_node("server"), graph.create_node("client")

    def work(goal):
        time.sleep(0.05)
        return execute_fibonacci(goal)

    ActionServer(nodes[0], Fibonacci, "fibonacci", work)
    client = ActionClient(nodes[1], Fibonacci, "fibonacci")
    executor = MultiThreadedExecutor(3)
    for node in nodes:
        executor.add_node(node)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        assert client.wait_for_server(60.0)
        response = client.send_goal(Fibonacci.Goal(order=3), timeout_sec=60.0)
        assert list(response.result.sequence) == [0, 1, 1, 2]
    finally:
        executor.shutdown()
        thread.join(60.0)
        graph.close_threadsafe()
