"""Measure the executors: messages per second, and the latency from publish to callback.

Run it with ``python -m benchmarks executors``. "Copied" means that messages are copied when they are published, so that
a program can fill the same message again, as with rclpy's stand-in.
"""

from __future__ import annotations

import os
import statistics
import threading
import time
from collections.abc import Callable
from unittest.mock import patch

from benchmarks.measure import Row
from linkwright.graph import Graph
from linkwright.graph.executors import MultiThreadedExecutor, ReentrantCallbackGroup, SingleThreadedExecutor
from linkwright.messages import String

MESSAGE_COUNT = 200_000
LATENCY_COUNT = 2_000
QUEUE_DEPTH = 1_000
ROUNDS = 3


def measure_messages_per_second(
    executor: SingleThreadedExecutor | MultiThreadedExecutor, *, reentrant: bool = False
) -> float:
    """Return the rate of messages that are published in batches of the queue's size."""
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    received = 0

    def receive(_message: String) -> None:
        nonlocal received
        received += 1

    group = ReentrantCallbackGroup() if reentrant else None
    node.create_subscription(String, "chatter", receive, QUEUE_DEPTH, callback_group=group)
    publisher = node.create_publisher(String, "chatter", QUEUE_DEPTH)
    executor.add_node(node)
    message = String(data="hello")
    spinner = threading.Thread(target=executor.spin) if isinstance(executor, MultiThreadedExecutor) else None
    start = time.perf_counter()
    if spinner is not None:
        spinner.start()
    for batch in range(0, MESSAGE_COUNT, QUEUE_DEPTH):
        for _ in range(QUEUE_DEPTH):
            publisher.publish(message)
        while received < batch + QUEUE_DEPTH:
            if spinner is None:
                executor.spin_once(0)
            else:
                time.sleep(0)
    seconds = time.perf_counter() - start
    executor.shutdown()
    if spinner is not None:
        spinner.join()
    graph.close_threadsafe()
    return MESSAGE_COUNT / seconds


def measure_spinning_messages_per_second(*, copies: bool = False) -> float:
    """Return the rate inside one ``spin`` if each callback publishes the next message.

    Args:
        copies: whether messages are copied, as in rclpy's nodes.
    """
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    node.handle.copies_messages = copies
    executor = SingleThreadedExecutor()
    publisher = node.create_publisher(String, "chatter", 10)
    message = String(data="hello")
    received = 0

    def receive(_message: String) -> None:
        nonlocal received
        received += 1
        if received < MESSAGE_COUNT:
            publisher.publish(message)
        else:
            executor.shutdown()

    node.create_subscription(String, "chatter", receive, 10)
    executor.add_node(node)
    publisher.publish(message)
    start = time.perf_counter()
    executor.spin()
    seconds = time.perf_counter() - start
    graph.close_threadsafe()
    return MESSAGE_COUNT / seconds


def measure_latencies_us() -> list[float]:
    """Return the latencies from publish in one thread to the callback in a waiting thread."""
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    executor = SingleThreadedExecutor()
    begun: list[int] = []
    node.create_subscription(String, "chatter", lambda _message: begun.append(time.perf_counter_ns()), 10)
    publisher = node.create_publisher(String, "chatter", 10)
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    latencies = []
    message = String(data="hello")
    for number in range(LATENCY_COUNT):
        time.sleep(0.0005)
        start = time.perf_counter_ns()
        publisher.publish(message)
        while len(begun) <= number:
            time.sleep(0)
        latencies.append((begun[number] - start) / 1_000)
    executor.shutdown()
    spinner.join()
    graph.close_threadsafe()
    return latencies


def measure_in_same_thread_us() -> float:
    """Return the time from publish to the callback in one ``spin_once`` of the same thread."""
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    executor = SingleThreadedExecutor()
    begun: list[int] = []
    node.create_subscription(String, "chatter", lambda _message: begun.append(time.perf_counter_ns()), 10)
    publisher = node.create_publisher(String, "chatter", 10)
    executor.add_node(node)
    latencies = []
    message = String(data="hello")
    for number in range(LATENCY_COUNT):
        start = time.perf_counter_ns()
        publisher.publish(message)
        executor.spin_once(0)
        latencies.append((begun[number] - start) / 1_000)
    executor.shutdown()
    graph.close_threadsafe()
    return statistics.median(latencies)


def run_user_program() -> tuple[float, float]:
    """Return messages per second and the latency in us of a program with rclpy's stand-in."""
    from linkwright.standins import activate

    activate()
    import rclpy
    from rclpy.executors import SingleThreadedExecutor as UsersExecutor
    from std_msgs.msg import String as UsersString

    with patch.dict(os.environ, LINKWRIGHT_DDS="0"):
        rclpy.init()
        node = rclpy.create_node("bench")
    received = 0

    def receive(_message: UsersString) -> None:
        nonlocal received
        received += 1

    node.create_subscription(UsersString, "chatter", receive, QUEUE_DEPTH)
    publisher = node.create_publisher(UsersString, "chatter", QUEUE_DEPTH)
    executor = UsersExecutor()
    executor.add_node(node)
    message = UsersString(data="hello")
    start = time.perf_counter()
    for batch in range(0, MESSAGE_COUNT, QUEUE_DEPTH):
        for _ in range(QUEUE_DEPTH):
            publisher.publish(message)
        while received < batch + QUEUE_DEPTH:
            executor.spin_once(0)
    rate = MESSAGE_COUNT / (time.perf_counter() - start)
    start = time.perf_counter()
    for _ in range(LATENCY_COUNT):
        publisher.publish(message)
        executor.spin_once(0)
    latency = (time.perf_counter() - start) / LATENCY_COUNT * 1e6
    node.destroy_node()
    rclpy.shutdown()
    return rate, latency


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""

    def rate(what: str, messages: Callable[[], float], target: str = "") -> Row:
        return Row(what, statistics.median(messages() for _ in range(ROUNDS)) / 1000, "1000/s", target)

    users_rate, users_latency = run_user_program()
    return [
        Row("small messages, a program over rclpy, spin_once", users_rate / 1000, "1000/s", "200"),
        Row("one message, a program over rclpy, spin_once", users_latency, "us", "20"),
        rate("small messages, one thread, spin", measure_spinning_messages_per_second, "200"),
        rate(
            "small messages, one thread, copied as for rclpy",
            lambda: measure_spinning_messages_per_second(copies=True),
            "200",
        ),
        rate("small messages, one thread, spin_once", lambda: measure_messages_per_second(SingleThreadedExecutor())),
        rate("small messages, four threads, exclusive", lambda: measure_messages_per_second(MultiThreadedExecutor(4))),
        rate(
            "small messages, four threads, reentrant",
            lambda: measure_messages_per_second(MultiThreadedExecutor(4), reentrant=True),
        ),
        Row("one message, publish to callback, same thread", measure_in_same_thread_us(), "us", "20"),
        Row("one message, publish to callback, a thread that waits", statistics.median(measure_latencies_us()), "us"),
    ]
