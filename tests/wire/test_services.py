"""Services between processes over DDS."""

from __future__ import annotations

from linkwright.graph.actions.client import ActionClient
from linkwright.graph.actions.server import ActionServer
from linkwright.graph.parameters.client import AsyncParameterClient
from linkwright.messages import get_action, get_service
from linkwright.wire.dds.services import IncomingService
from tests.waiting import TIMEOUT_S
from tests.wire.conftest import both_wires

SetBool = get_service("std_srvs/srv/SetBool")
Empty = get_service("std_srvs/srv/Empty")
Fibonacci = get_action("example_interfaces/action/Fibonacci")


def flip(request, response):
    response.success = not request.data
    return response


@both_wires
def test_requests_made_before_server_exists_are_answered(processes):
    a = processes("a")
    client = a.node.create_client(SetBool, "flip")
    futures = [client.call_async(SetBool.Request(data=value)) for value in (True, False)]
    assert not client.service_is_ready()
    b = processes("b")
    b.node.create_service(SetBool, "flip", flip)

    def both_spin():
        b.executor.spin_once(timeout_sec=0.01)
        return all(future.done() for future in futures)

    a.spin_until(both_spin)
    assert [future.result().success for future in futures] == [False, True]


@both_wires
def test_client_is_ready_while_server_exists(processes):
    a, b = processes("a"), processes("b")
    client = a.node.create_client(SetBool, "flip")
    service = b.node.create_service(SetBool, "flip", flip)
    assert client.wait_for_service(60)
    b.node.destroy_service(service)
    a.spin_until(lambda: not client.service_is_ready())


@both_wires
def test_responses_go_to_requesting_client(processes):
    a, b, server = processes("a"), processes("b"), processes("server")
    server.node.create_service(SetBool, "flip", flip)
    clients = [process.node.create_client(SetBool, "flip") for process in (a, b)]
    assert all(client.wait_for_service(60) for client in clients)
    requests = [SetBool.Request(data=data) for data in (True, False)]
    futures = [client.call_async(request) for client, request in zip(clients, requests, strict=True)]

    def all_spin():
        for process in (a, b):
            process.executor.spin_once(timeout_sec=0.01)
        return all(future.done() for future in futures)

    server.spin_until(all_spin)
    assert [future.result().success for future in futures] == [False, True]


def test_server_is_woken_by_requests_and_not_repeatedly_by_matches(processes, monkeypatch):
    on_data, woken = IncomingService.on_data, []
    monkeypatch.setattr(IncomingService, "on_data", lambda self: woken.append(self.pair.name) or on_data(self))
    a, b = processes("a"), processes("b")
    b.node.create_service(SetBool, "flip", flip)
    client = a.node.create_client(SetBool, "flip")
    for _ in range(20):
        future = client.call_async(SetBool.Request(data=True))
        a.spin_until(lambda future=future: b.executor.spin_once(timeout_sec=0.01) or future.done())
    assert 20 <= woken.count("/flip") <= 40


@both_wires
def test_messages_without_fields_are_transferred(processes):
    a, b = processes("a"), processes("b")
    calls = []
    b.node.create_service(Empty, "poke", lambda _request, response: calls.append(1) or response)
    client = a.node.create_client(Empty, "poke")
    future = client.call_async(Empty.Request())
    a.spin_until(lambda: b.executor.spin_once(timeout_sec=0.01) or future.done())
    assert calls == [1]
    assert future.result() == Empty.Response()


@both_wires
def test_parameters_of_remote_node_are_read_and_set(processes):
    a, b = processes("a"), processes("b")
    b.node.declare_parameter("speed", 1.5)
    parameters = AsyncParameterClient(a.node, "/b")

    def result_of(future):
        a.spin_until(lambda: b.executor.spin_once(timeout_sec=0.01) or future.done())
        return future.result()

    assert "speed" in result_of(parameters.list_parameters()).result.names
    assert result_of(parameters.get_parameters(["speed"])).values[0].double_value == 1.5


@both_wires
def test_remote_action_is_executed(processes):
    a, b = processes("a"), processes("b")

    def execute(goal):
        sequence = [0, 1]
        for _ in range(goal.request.order - 1):
            sequence.append(sequence[-1] + sequence[-2])
            goal.publish_feedback(Fibonacci.Feedback(sequence=sequence))
        goal.succeed()
        return Fibonacci.Result(sequence=sequence)

    server = ActionServer(b.node, Fibonacci, "count", execute)
    client = ActionClient(a.node, Fibonacci, "count")
    assert client.wait_for_server(TIMEOUT_S)
    b.spin_until(lambda: b.node.count_clients("/count/_action/send_goal"))  # the server has discovered the client too
    b.spin_until(lambda: b.node.count_clients("/count/_action/get_result"))
    b.spin_until(lambda: b.node.count_subscribers("/count/_action/feedback"))
    feedback = []

    def result_of(future):
        a.spin_until(lambda: b.executor.spin_once(timeout_sec=0.01) or future.done())
        return future.result()

    handle = result_of(client.send_goal_async(Fibonacci.Goal(order=4), feedback_callback=feedback.append))
    assert handle.accepted
    result = result_of(handle.get_result_async())
    assert list(result.result.sequence) == [0, 1, 1, 2, 3]
    a.spin_until(lambda: len(feedback) == 3)
    client.destroy()
    server.destroy()
