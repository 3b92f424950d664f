"""The sending and the receiving process of a measurement over DDS or Zenoh.

Each process prints its result as JSON.

Usage: ``python -m benchmarks.dds_sides send|receive ours|plain|zenoh KIND SECONDS RATE``; a rate of 0 means as fast as
possible. Kinds are `joints`, `transforms` (received as arrays, as by a tf buffer), `objects` (transforms received as
Python objects) and `images`. `ours` uses the transport of RMW_IMPLEMENTATION, `plain` is `cyclonedds` alone with its
own IdlStructs, and `zenoh` is zenoh-ros2-sdk. Each message differs from the previous one in its stamp and a position.
The receiver computes the age of a message from its stamp.
"""

from __future__ import annotations

import asyncio
import importlib
import itertools
import json
import os
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from linkwright.graph import Graph
from linkwright.graph.qos.profile import HistoryPolicy, QoSProfile
from linkwright.messages import get_message
from linkwright.wire.joining import join

JOINT_COUNT = 12
TRANSFORM_COUNT = 100
WIDTH, HEIGHT = 640, 480
LOSSLESS = QoSProfile(history=HistoryPolicy.KEEP_ALL)
TOPIC = "/measured"


@dataclass
class Result:
    """The result of one side.

    Attributes:
        count: messages sent or received.
        seconds: from the first message to the last.
        cores: the processor time divided by this duration.
        latency: the median age of messages at delivery in seconds; 0 if it was not measured.
    """

    count: int
    seconds: float
    cores: float
    latency: float = 0.0


def make_message(kind: str) -> Any:
    """Return a message of a kind as an object of Linkwright."""
    if kind == "joints":
        message = get_message("sensor_msgs/msg/JointState")()
        message.name = [f"joint_{number}" for number in range(JOINT_COUNT)]
        message.position = [0.1] * JOINT_COUNT
        message.velocity = [0.2] * JOINT_COUNT
        message.effort = [0.3] * JOINT_COUNT
    elif kind in ("transforms", "objects"):
        message = get_message("tf2_msgs/msg/TFMessage")()
        for number in range(TRANSFORM_COUNT):
            transform = get_message("geometry_msgs/msg/TransformStamped")()
            transform.header.frame_id = "base_link"
            transform.child_frame_id = f"link_{number}"
            message.transforms.append(transform)
    else:
        message = get_message("sensor_msgs/msg/Image")()
        message.width, message.height, message.step, message.encoding = WIDTH, HEIGHT, 3 * WIDTH, "rgb8"
        message.data = bytes(3 * WIDTH * HEIGHT)
    return message


def renew(message: Any, count: int) -> None:
    """Change the stamp and a value of a message of any library."""
    stamp = _get_stamp(message)
    stamp.sec, stamp.nanosec = divmod(time.time_ns(), 1_000_000_000)
    if hasattr(message, "position"):
        message.position[0] = float(count)


def get_age(message: Any) -> float:
    """Return the time since a message was renewed, in seconds."""
    stamp = _get_stamp(message)
    return float(time.time() - stamp.sec - 1e-9 * stamp.nanosec)


def compute_median_age(ages: list[float]) -> float:
    """Return the median of ages, or 0 if there are none."""
    return statistics.median(ages) if ages else 0.0


def _get_stamp(message: Any) -> Any:
    return (message.transforms[0].header if hasattr(message, "transforms") else message.header).stamp


def send_paced(send: Callable[[], object], seconds: float, rate: float) -> Result:
    """Send at a rate for a number of seconds."""
    count, begin, cpu = 0, time.perf_counter(), time.process_time()
    while time.perf_counter() - begin < seconds:
        send()
        count += 1
        if rate:
            time.sleep(max(0.0, begin + count / rate - time.perf_counter()))
    passed = time.perf_counter() - begin
    return Result(count, passed, (time.process_time() - cpu) / passed)


def send_ours(kind: str, seconds: float, rate: float) -> Result:
    """Publish through a graph."""
    graph = Graph(threads=True)
    message = make_message(kind)
    publisher = graph.create_node("sender").create_publisher(type(message), TOPIC, LOSSLESS)
    transport = join(graph)
    assert transport is not None
    while not publisher.get_subscription_count():
        time.sleep(0.01)
    numbers = itertools.count()

    def send() -> None:
        renew(message, next(numbers))
        publisher.publish(message)

    result = send_paced(send, seconds, rate)
    graph.close_threadsafe()
    return result


async def receive_ours(kind: str, seconds: float) -> Result:
    """Receive as the launcher does, in an event loop; each message is read as an object."""
    graph = Graph()
    message_class = type(make_message(kind))
    ages: list[float] = []
    count, first, last, cpu = 0, 0.0, 0.0, 0.0

    def received(message: Any) -> None:
        nonlocal count, first, last, cpu
        if kind != "transforms":  # its objects are never created
            ages.append(get_age(message))
        last = time.perf_counter()
        if not count:
            first, cpu = last, time.process_time()
        count += 1

    graph.create_node("receiver").create_subscription(message_class, TOPIC, received, LOSSLESS)
    join(graph)
    await _until_quiet(lambda: count, seconds)
    result = Result(
        count, last - first, (time.process_time() - cpu) / max(last - first, 1e-9), compute_median_age(ages)
    )
    await graph.close()
    return result


async def _until_quiet(count: Callable[[], int], seconds: float) -> None:
    """Wait until messages have arrived and then stopped, or until none arrive for too long."""
    limit, last_count = time.monotonic() + seconds + 20, 0
    while time.monotonic() < limit:
        await asyncio.sleep(0.7)
        if count() and count() == last_count:
            return
        last_count = count()


def main() -> None:
    """Run one side."""
    side, library, kind, seconds, rate = sys.argv[1:6]
    if library != "ours":
        peer = importlib.import_module(f"benchmarks.dds_{library}")
        result = getattr(peer, side)(kind, float(seconds), float(rate))
    elif side == "send":
        result = send_ours(kind, float(seconds), float(rate))
    else:
        result = asyncio.run(receive_ours(kind, float(seconds)))
    print(json.dumps(vars(result)))
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
