"""Measure the executors: messages per second in one process, and the latency from publish to callback.

Run it with ``python -m benchmarks executors``. "Copied" is what the nodes of rclpy's stand-in pay for being able to
fill the same message again after it was published.
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

MESSAGES = 200_000
LATENCIES = 2_000
QUEUE = 1_000
ROUNDS = 3


def messages_per_second(executor: SingleThreadedExecutor | MultiThreadedExecutor, *, reentrant: bool = False) -> float:
    """Return the rate of messages that are published in batches of the queue's size."""
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    received = 0

    def receive(_message: String) -> None:
        nonlocal received
        received += 1

    group = ReentrantCallbackGroup() if reentrant else None
    node.create_subscription(String, "chatter", receive, QUEUE, callback_group=group)
    publisher = node.create_publisher(String, "chatter", QUEUE)
    executor.add_node(node)
    message = String(data="hello")
    spinner = threading.Thread(target=executor.spin) if isinstance(executor, MultiThreadedExecutor) else None
    start = time.perf_counter()
    if spinner is not None:
        spinner.start()
    for batch in range(0, MESSAGES, QUEUE):
        for _ in range(QUEUE):
            publisher.publish(message)
        while received < batch + QUEUE:
            if spinner is None:
                executor.spin_once(0)
            else:
                time.sleep(0)
    seconds = time.perf_counter() - start
    executor.shutdown()
    if spinner is not None:
        spinner.join()
    graph.close_threadsafe()
    return MESSAGES / seconds


def spinning_messages_per_second(*, copies: bool = False) -> float:
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
        if received < MESSAGES:
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
    return MESSAGES / seconds


def latencies_us() -> list[float]:
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
    for number in range(LATENCIES):
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


def in_same_thread_us() -> float:
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
    for number in range(LATENCIES):
        start = time.perf_counter_ns()
        publisher.publish(message)
        executor.spin_once(0)
        latencies.append((begun[number] - start) / 1_000)
    executor.shutdown()
    graph.close_threadsafe()
    return statistics.median(latencies)


def run_user_program() -> tuple[float, float]:
    """Return messages per second, and the latency in microseconds, of a program that uses rclpy's stand-in."""
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

    node.create_subscription(UsersString, "chatter", receive, QUEUE)
    publisher = node.create_publisher(UsersString, "chatter", QUEUE)
    executor = UsersExecutor()
    executor.add_node(node)
    message = UsersString(data="hello")
    start = time.perf_counter()
    for batch in range(0, MESSAGES, QUEUE):
        for _ in range(QUEUE):
            publisher.publish(message)
        while received < batch + QUEUE:
            executor.spin_once(0)
    rate = MESSAGES / (time.perf_counter() - start)
    start = time.perf_counter()
    for _ in range(LATENCIES):
        publisher.publish(message)
        executor.spin_once(0)
    latency = (time.perf_counter() - start) / LATENCIES * 1e6
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
        rate("small messages, one thread, spin", spinning_messages_per_second, "200"),
        rate(
            "small messages, one thread, copied as for rclpy", lambda: spinning_messages_per_second(copies=True), "200"
        ),
        rate("small messages, one thread, spin_once", lambda: messages_per_second(SingleThreadedExecutor())),
        rate("small messages, four threads, exclusive", lambda: messages_per_second(MultiThreadedExecutor(4))),
        rate(
            "small messages, four threads, reentrant",
            lambda: messages_per_second(MultiThreadedExecutor(4), reentrant=True),
        ),
        Row("one message, publish to callback, same thread", in_same_thread_us(), "us", "20"),
        Row("one message, publish to callback, a thread that waits", statistics.median(latencies_us()), "us"),
    ]
