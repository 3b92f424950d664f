"""How fast the executors deliver: messages from publish to callback in one process, and how soon a callback begins.

Run with ``python benchmarks/bench_executors.py``.
"""

from __future__ import annotations

import statistics
import threading
import time

from linkwright.graph import Graph
from linkwright.graph.executors import MultiThreadedExecutor, ReentrantCallbackGroup, SingleThreadedExecutor
from linkwright.messages import String

MESSAGES = 200_000
LATENCIES = 2_000
QUEUE = 1_000


def messages_per_second(executor: SingleThreadedExecutor | MultiThreadedExecutor, *, reentrant: bool = False) -> float:
    """Publish in batches that the queue holds, run their callbacks, and count."""
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
    graph.close_now()
    return MESSAGES / seconds


def spinning_messages_per_second(*, copies: bool = False) -> float:
    """Each callback publishes the next message: publish to callback, without pause, inside of one ``spin``.

    Args:
        copies: whether messages are copied, as those of rclpy's nodes are.
    """
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    node.copies_messages = copies
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
    graph.close_now()
    return MESSAGES / seconds


def latencies_us() -> list[float]:
    """From publish in one thread to the beginning of the callback in another that waits."""
    graph = Graph(threads=True)
    node = graph.create_node("bench", start_parameter_services=False, enable_rosout=False)
    executor = SingleThreadedExecutor()
    begun: list[int] = []
    node.create_subscription(String, "chatter", lambda _message: begun.append(time.perf_counter_ns()), 10)
    publisher = node.create_publisher(String, "chatter", 10)
    executor.add_node(node)
    spinner = threading.Thread(target=executor.spin)
    spinner.start()
    found = []
    message = String(data="hello")
    for number in range(LATENCIES):
        time.sleep(0.0005)
        start = time.perf_counter_ns()
        publisher.publish(message)
        while len(begun) <= number:
            time.sleep(0)
        found.append((begun[number] - start) / 1_000)
    executor.shutdown()
    spinner.join()
    graph.close_now()
    return found


def main() -> None:
    """Print the figures."""
    print(f"single thread, spin         {spinning_messages_per_second():>10,.0f} messages a second")
    copied = spinning_messages_per_second(copies=True)
    print(f"single thread, copies       {copied:>10,.0f} messages a second")
    print(f"single thread, spin_once    {messages_per_second(SingleThreadedExecutor()):>10,.0f} messages a second")
    print(f"four threads, exclusive     {messages_per_second(MultiThreadedExecutor(4)):>10,.0f} messages a second")
    reentrant = messages_per_second(MultiThreadedExecutor(4), reentrant=True)
    print(f"four threads, reentrant     {reentrant:>10,.0f} messages a second")
    found = latencies_us()
    print(f"to another thread           {statistics.median(found):>10.0f} us, {max(found):.0f} at most")


if __name__ == "__main__":
    main()
