"""Many nodes, many messages, many threads at once."""

import asyncio
import threading
import time

import pytest

from linkwright.graph import Graph, JumpClock
from linkwright.graph.executors import MultiThreadedExecutor
from linkwright.messages import String, get_service

Trigger = get_service("std_srvs/srv/Trigger")
NODE_COUNT = 500


async def test_five_hundred_nodes_exchange_messages():
    clock = JumpClock()
    graph = Graph(clock=clock, on_log=print)
    counts = [0] * NODE_COUNT
    for number in range(NODE_COUNT):
        node = graph.create_node(f"node_{number}", namespace=f"robot_{number % 10}")

        def on_message(_message, number=number):
            counts[number] += 1

        node.create_subscription(String, "/all", on_message, 10)
        node.create_subscription(String, "ours", on_message, 10)
        publisher = node.create_publisher(String, "ours", 10)
        node.create_timer(1.0, lambda publisher=publisher: publisher.publish(String()))
    broadcaster = graph.create_node("everybody").create_publisher(String, "/all", 10)
    assert len(graph.node_names()) == NODE_COUNT + 1
    broadcaster.publish(String())
    await graph.settle()
    assert counts == [1] * NODE_COUNT
    await clock.advance(1.0)
    # There are ten topics with fifty nodes each, and a queue of ten messages for each subscription.
    assert min(counts) > 10
    before = len(graph.endpoints())
    graph.nodes()[0].destroy()
    assert len(graph.endpoints()) < before
    await graph.close()
    assert graph.endpoints() == []


def test_graph_can_change_while_other_threads_use_it():
    """Some threads create and destroy nodes while others publish, call and query."""
    graph = Graph(threads=True, on_log=lambda _record: None)
    steady = graph.create_node("steady")
    received = []
    steady.create_subscription(String, "topic", received.append, 100)
    steady.create_service(Trigger, "trigger", lambda _request, response: response)
    executor = MultiThreadedExecutor(2)
    executor.add_node(steady)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    failures = []
    stop = time.monotonic() + 1.0

    def guarded(work):
        def run(number):
            try:
                while time.monotonic() < stop:
                    work(number)
            except Exception as error:  # noqa: BLE001  # any at all is what is looked for
                failures.append(error)

        return run

    def come_and_go(number):
        node = graph.create_node(f"guest_{number}")
        publisher = node.create_publisher(String, "topic", 10)
        for _ in range(10):
            publisher.publish(String())
        node.create_subscription(String, "topic", lambda _message: None, 10)
        node.create_client(Trigger, "trigger").call_async(Trigger.Request())
        node.create_timer(0.001, lambda: None)
        executor.add_node(node)
        executor.remove_node(node)
        node.destroy_node()

    def look(_number):
        graph.get_topic_names_and_types()
        graph.get_node_names_and_namespaces()

    threads = [
        threading.Thread(target=guarded(work), args=(number,))
        for number, work in enumerate((come_and_go,) * 3 + (look,))
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60.0)
    executor.shutdown()
    spinner.join(60.0)
    assert failures == []
    assert received
    assert graph.node_names() == ["/steady"]
    graph.close_threadsafe()
    assert graph.endpoints() == []


async def test_thread_loses_no_reliable_messages_to_event_loop():
    """The queue can hold all of the hundred thousand messages."""
    graph = Graph(on_log=print)
    node = graph.create_node("node")
    numbers, all_received = [], asyncio.Event()

    def on_message(message):
        numbers.append(int(message.data))
        if len(numbers) == 100_000:
            all_received.set()

    node.create_subscription(String, "topic", on_message, 100_000)
    publisher = node.create_publisher(String, "topic", 10)

    def talk():
        for number in range(100_000):
            publisher.publish(String(data=str(number)))

    thread = threading.Thread(target=talk)
    thread.start()
    await asyncio.wait_for(all_received.wait(), 60.0)
    thread.join()
    assert numbers == list(range(100_000))
    await graph.close()


async def test_failed_node_creation_leaves_nothing_in_graph(graph, monkeypatch):
    from linkwright.graph.simulated_time import SimulatedTime

    def refuse(*_arguments):
        raise ValueError("no")

    monkeypatch.setattr(SimulatedTime, "__init__", refuse)
    with pytest.raises(ValueError, match="no"):
        graph.create_node("node")
    assert graph.node_names() == []
    assert graph.endpoints() == []
