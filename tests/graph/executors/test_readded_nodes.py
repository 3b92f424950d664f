"""Nodes that are added to an executor for a single callback, as `rclpy.spin_once` does."""

from __future__ import annotations

import pytest

from linkwright.graph import Graph
from linkwright.graph.executors import SingleThreadedExecutor
from linkwright.messages import String

TOPICS = ("a", "b", "c")


@pytest.fixture
def node():
    graph = Graph(threads=True, on_log=lambda _record: None)
    yield graph.create_node("tested", start_parameter_services=False, enable_rosout=False)
    graph.close_threadsafe()


@pytest.fixture
def executor():
    with SingleThreadedExecutor() as executor:
        yield executor


def spin_once(executor, node):
    executor.add_node(node)
    executor.spin_once(timeout_sec=0)
    executor.remove_node(node)


def test_each_spin_runs_callback_and_topics_take_turns(node, executor):
    received = []
    for topic in TOPICS:
        node.create_subscription(String, topic, lambda message, topic=topic: received.append(topic), 10)
        publisher = node.create_publisher(String, topic, 10)
        for _ in range(10):
            publisher.publish(String())
    for _ in range(30):
        spin_once(executor, node)
    assert received == list(TOPICS) * 10


def test_flood_does_not_delay_other_callbacks(node, executor):
    received = []
    for topic in TOPICS:
        publisher = node.create_publisher(String, topic, 10)
        node.create_subscription(String, topic, lambda message, publisher=publisher: publisher.publish(message), 10)
        publisher.publish(String())
    for _ in range(100):
        spin_once(executor, node)
    node.create_subscription(String, "quiet", received.append, 10)
    node.create_publisher(String, "quiet", 10).publish(String())
    for _ in range(len(TOPICS) + 1):
        spin_once(executor, node)
    assert len(received) == 1


def test_removed_node_runs_in_next_executor(node, executor):
    received = []
    node.create_subscription(String, "a", received.append, 10)
    publisher = node.create_publisher(String, "a", 10)
    executor.add_node(node)
    publisher.publish(String())
    executor.remove_node(node)
    executor.spin_once(timeout_sec=0)
    assert received == []
    with SingleThreadedExecutor() as other:
        spin_once(other, node)
    publisher.publish(String())
    spin_once(executor, node)
    assert len(received) == 2
