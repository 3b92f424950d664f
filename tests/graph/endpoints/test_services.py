"""Services and clients within one graph."""

import asyncio
import threading

import pytest

from linkwright.graph import Graph, InvalidHandleError, InvalidServiceNameError
from linkwright.graph.executors import MultiThreadedExecutor, SingleThreadedExecutor
from linkwright.messages import get_service

AddTwoInts = get_service("example_interfaces/srv/AddTwoInts")
SetBool = get_service("std_srvs/srv/SetBool")


def add_two_ints(request, response):
    response.sum = request.a + request.b
    return response


@pytest.fixture
def nodes(graph):
    return graph.create_node("server", namespace="robot"), graph.create_node("client", namespace="robot")


async def test_service_answers_request(graph, nodes):
    server, user = nodes
    service = server.create_service(AddTwoInts, "add", add_two_ints)
    client = user.create_client(AddTwoInts, "add")
    assert (service.service_name, client.srv_name) == ("/robot/add", "/robot/add")
    assert client.service_is_ready()
    future = client.call_async(AddTwoInts.Request(a=2, b=3))
    assert not future.done()
    assert (await future).sum == 5
    assert future.done()


async def test_concurrent_requests_receive_matching_responses(graph, nodes):
    server, user = nodes
    server.create_service(AddTwoInts, "add", add_two_ints)
    client = user.create_client(AddTwoInts, "add")
    futures = [client.call_async(AddTwoInts.Request(a=number, b=1)) for number in range(5)]
    assert [response.sum for response in await asyncio.gather(*futures)] == [1, 2, 3, 4, 5]


async def test_service_callback_can_be_coroutine(graph, nodes):
    server, user = nodes
    may_finish = asyncio.Event()

    async def slow(request, response):
        await may_finish.wait()
        return add_two_ints(request, response)

    server.create_service(AddTwoInts, "add", slow)
    future = user.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request(a=1, b=1))
    await graph.settle()
    assert not future.done()
    may_finish.set()
    assert (await future).sum == 2


async def test_service_can_reply_later(graph, nodes):
    server, user = nodes
    replies = []
    server.create_service(AddTwoInts, "add", lambda request, reply: replies.append(reply), replying=True)
    future = user.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request())
    await graph.settle()
    assert not future.done()
    replies[0](AddTwoInts.Response(sum=7))
    assert (await future).sum == 7


async def test_request_waits_for_server(graph, nodes):
    server, user = nodes
    client = user.create_client(AddTwoInts, "add")
    assert not client.service_is_ready()
    assert not client.wait_for_service(timeout_sec=0.01)
    future = client.call_async(AddTwoInts.Request(a=1, b=2))
    server.create_service(AddTwoInts, "add", add_two_ints)
    assert client.wait_for_service(timeout_sec=0.01)
    assert (await future).sum == 3


async def test_removed_pending_request_receives_no_response(graph, nodes):
    server, user = nodes
    server.create_service(AddTwoInts, "add", add_two_ints)
    client = user.create_client(AddTwoInts, "add")
    future = client.call_async(AddTwoInts.Request())
    client.remove_pending_request(future)
    await graph.settle()
    assert not future.done()


async def test_next_server_takes_over_when_first_is_destroyed(graph, nodes):
    server, user = nodes
    first = server.create_service(AddTwoInts, "add", lambda _request, response: AddTwoInts.Response(sum=1))
    server.create_service(AddTwoInts, "add", lambda _request, response: AddTwoInts.Response(sum=2))
    client = user.create_client(AddTwoInts, "add")
    assert (await client.call_async(AddTwoInts.Request())).sum == 1
    first.destroy()
    assert (await client.call_async(AddTwoInts.Request())).sum == 2


async def test_service_of_another_type_is_not_ready(graph, nodes):
    server, user = nodes
    server.create_service(SetBool, "add", lambda _request, response: response)
    assert not user.create_client(AddTwoInts, "add").service_is_ready()


async def test_invalid_request_and_response_types_are_reported(graph, nodes, log):
    server, user = nodes
    server.create_service(AddTwoInts, "add", lambda _request, _response: "five")
    client = user.create_client(AddTwoInts, "add")
    with pytest.raises(TypeError, match=r"the request of '/robot/add'"):
        client.call_async(AddTwoInts.Response())
    future = client.call_async(AddTwoInts.Request())
    await graph.settle()
    assert not future.done()
    assert "callback of service '/robot/add' failed:" in log[-1].text
    assert "got <class 'str'>" in log[-1].text
    with pytest.raises(RuntimeError, match="would block the event loop"):
        client.call(AddTwoInts.Request())
    with pytest.raises(InvalidServiceNameError, match="must not contain characters"):
        user.create_client(AddTwoInts, "a b")
    with pytest.raises(AttributeError, match="is not an interface class"):
        user.create_client(int, "add")
    client.destroy()
    with pytest.raises(InvalidHandleError):
        client.call_async(AddTwoInts.Request())


async def test_service_names_are_remapped(graph):
    server = graph.create_node("server", remappings=[("add", "sum"), ("rostopic://sum", "never")])
    server.create_service(AddTwoInts, "add", add_two_ints)
    client = graph.create_node("client").create_client(AddTwoInts, "/sum")
    assert (await client.call_async(AddTwoInts.Request(a=1, b=1))).sum == 2


def test_blocking_call_is_answered_in_another_thread():
    graph = Graph(threads=True, on_log=print)
    server, user = graph.create_node("server"), graph.create_node("client")
    server.create_service(AddTwoInts, "add", add_two_ints)
    client = user.create_client(AddTwoInts, "add")
    executor = MultiThreadedExecutor(2)
    executor.add_node(server)
    executor.add_node(user)
    thread = threading.Thread(target=executor.spin)
    thread.start()
    try:
        assert client.call(AddTwoInts.Request(a=20, b=22), timeout_sec=60.0).sum == 42
    finally:
        executor.shutdown()
        thread.join(60.0)
        graph.close_threadsafe()
    assert not thread.is_alive()


def test_call_returns_none_after_timeout():
    graph = Graph(threads=True, on_log=print)
    node = graph.create_node("node")
    client = node.create_client(AddTwoInts, "add")
    assert client.call(AddTwoInts.Request(), timeout_sec=0.01) is None
    graph.close_threadsafe()


def test_wait_for_service_ends_when_graph_closes():
    graph = Graph(threads=True, on_log=print)
    client = graph.create_node("node").create_client(AddTwoInts, "add")
    results = []
    thread = threading.Thread(target=lambda: results.append(_has_pending_requests(client)))
    thread.start()
    graph.close_threadsafe()
    thread.join(60.0)
    assert results == [False]


def _has_pending_requests(client):
    try:
        return client.wait_for_service()
    except InvalidHandleError:
        return False


def test_spinning_executor_answers_service():
    graph = Graph(threads=True, on_log=print)
    node = graph.create_node("node")
    node.create_service(AddTwoInts, "add", add_two_ints)
    future = node.create_client(AddTwoInts, "add").call_async(AddTwoInts.Request(a=1, b=2))
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    executor.spin_until_future_complete(future, timeout_sec=60.0)
    assert future.result().sum == 3
    executor.shutdown()
    graph.close_threadsafe()
