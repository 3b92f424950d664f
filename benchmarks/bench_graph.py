"""Measure the graph: messages, timers, nodes, and the chain from sliders to the tf buffer.

Run it with ``python -m benchmarks graph``. Everything is in one process without connections to others.
"""

from __future__ import annotations

import asyncio
import random
import statistics
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.measure import Row
from benchmarks.robots import make_tree_robot
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import Graph, TransformBuffer, TransformListener
from linkwright.messages import JointState, String, TFMessage
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.testing import SteppedGraph

BURST_SIZE = 1000
BURST_COUNT = 200
ROUNDS = 5
PING_COUNT = 3000
JOINT_COUNT = 500
RATE_HZ = 30
DURATION_S = 5.0
MOVE_COUNT = 60
NODE_COUNT = 500


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    rate, latency = asyncio.run(_measure_messages())
    creation, memory = asyncio.run(_measure_many_nodes())
    table = [
        Row("small messages, publish to callback, event loop", rate / 1000, "1000/s", "200"),
        Row("one message, publish to callback, event loop", latency, "us", "20"),
        Row("a coroutine waits, message to coroutine", asyncio.run(_measure_round_trip()), "us"),
        Row(f"{NODE_COUNT} nodes with parameter services and rosout, each", creation, "ms"),
        Row(f"{NODE_COUNT} nodes, memory of each", memory, "KB"),
        Row("an hour of a 10 Hz timer that publishes, stepped clock", _measure_stepped_hour(), "s"),
        Row("robot_state_publisher, 100 joints at 1 kHz", asyncio.run(_measure_state_publisher()), "% of a core", "25"),
    ]
    for name, branching in (("one chain", 1), ("tree", 3), ("star", JOINT_COUNT)):
        share = asyncio.run(_measure_chain(make_tree_robot(JOINT_COUNT + 1, branching)))
        table.append(
            Row(f"sliders to tf buffer, {JOINT_COUNT} joints, {RATE_HZ} Hz, {name}", share * 100, "% of a core")
        )
    text = make_tree_robot(JOINT_COUNT + 1)
    for name, pause in (
        ("single moves", lambda: random.uniform(0.12, 0.25)),
        ("60 moves a second", lambda: 1.0 / 60.0),
    ):
        moves = asyncio.run(_measure_move_latencies(text, pause))
        table.append(Row(f"slider to tf buffer, {JOINT_COUNT} joints, {name}", statistics.median(moves), "ms"))
    return table


async def _measure_messages() -> tuple[float, float]:
    """Return messages per second in bursts, and the latency of a single message in us."""
    graph = Graph(on_log=lambda _record: None)
    node = graph.create_node("node")
    received = 0

    def count(_message: String) -> None:
        nonlocal received
        received += 1

    node.create_subscription(String, "burst", count, BURST_SIZE)
    publisher = node.create_publisher(String, "burst", BURST_SIZE)
    message = String(data="x")
    rates = []
    for _ in range(ROUNDS):
        received, begin = 0, time.perf_counter()
        for _ in range(BURST_COUNT):
            for _ in range(BURST_SIZE):
                publisher.publish(message)
            await graph.settle()
        rates.append(received / (time.perf_counter() - begin))
        assert received == BURST_SIZE * BURST_COUNT
    arrived: list[int] = []
    node.create_subscription(String, "ping", lambda _message: arrived.append(time.perf_counter_ns()), 1)
    pinger = node.create_publisher(String, "ping", 1)
    latencies = []
    for _ in range(PING_COUNT):
        sent = time.perf_counter_ns()
        pinger.publish(message)
        await graph.settle()
        latencies.append((arrived.pop() - sent) / 1000)
    await graph.close()
    return statistics.median(rates), statistics.median(latencies)


async def _measure_round_trip() -> float:
    """Return the microseconds from `publish` until a task that waits for the message continues."""
    graph = Graph(on_log=lambda _record: None)
    node = graph.create_node("node")
    has_arrived = asyncio.Event()
    node.create_subscription(String, "ping", lambda _message: has_arrived.set(), 1)
    pinger = node.create_publisher(String, "ping", 1)
    message, trips = String(), []
    for _ in range(PING_COUNT):
        has_arrived.clear()
        begin = time.perf_counter_ns()
        pinger.publish(message)
        await has_arrived.wait()
        trips.append((time.perf_counter_ns() - begin) / 1000)
    await graph.close()
    return statistics.median(trips)


async def _measure_many_nodes() -> tuple[float, float]:
    """Return the milliseconds and kilobytes per node among many nodes."""
    graph = Graph(on_log=lambda _record: None)
    graph.create_node("first")
    start_kb, begin = _get_resident_kb(), time.perf_counter()
    for number in range(NODE_COUNT):
        graph.create_node(f"node_{number}")
    seconds, end_kb = time.perf_counter() - begin, _get_resident_kb()
    await graph.close()
    return seconds / NODE_COUNT * 1000, (end_kb - start_kb) / NODE_COUNT


def _get_resident_kb() -> float:
    return int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1]) * 4


def _measure_stepped_hour() -> float:
    with SteppedGraph() as test:
        node = test.create_node("node")
        publisher = node.create_publisher(String, "topic", 10)
        node.create_subscription(String, "topic", lambda _message: None, 10)
        node.create_timer(0.1, lambda: publisher.publish(String()))
        begin = time.perf_counter()
        test.advance(3600.0)
        return time.perf_counter() - begin


async def _measure_state_publisher() -> float:
    """Return the load of publishing transforms of moving joints, in percent of a core.

    The load includes the joint states.
    """
    graph = Graph(on_log=lambda _record: None)
    described = {"robot_description": make_tree_robot(101), "publish_frequency": 1000.0}
    publisher = RobotStatePublisher(graph, NodeOptions(parameters=described, library=DescriptionLibrary()))
    node = graph.create_node("source")
    source = node.create_publisher(JointState, "joint_states", 10)
    names = [f"joint_{number}" for number in range(1, 101)]
    clock, angle = node.get_clock(), 0.0

    def move() -> None:
        nonlocal angle
        angle += 0.001
        message = JointState(name=names, position=[angle] * 100)
        message.header.stamp = clock.now().to_msg()
        source.publish(message)

    node.create_timer(0.001, move)
    share = await _measure_load()
    publisher.close()
    await graph.close()
    return share * 100


async def _measure_load() -> float:
    await asyncio.sleep(0.5)
    cpu, wall = time.process_time(), time.perf_counter()
    await asyncio.sleep(DURATION_S)
    return (time.process_time() - cpu) / (time.perf_counter() - wall)


class _Chain:
    """The three nodes of a display.launch.py, with the viewer's buffer in place of the viewer."""

    def __init__(self, text: str, *, publish_frequency: float, **parameters: Any) -> None:
        self.graph = Graph(on_log=lambda _record: None)
        library = DescriptionLibrary()
        described = {"robot_description": text, "publish_frequency": publish_frequency}
        RobotStatePublisher(self.graph, NodeOptions(parameters=described, library=library))
        sliders = JointStatePublisherGui(self.graph, NodeOptions(parameters=parameters, library=library))
        self.panel = sliders.panel
        self.node = self.graph.create_node("viewer")
        self.buffer = TransformBuffer()
        TransformListener(self.buffer, self.node)


async def _measure_chain(text: str) -> float:
    """Return the share of a core with all joints moving.

    All transforms are read for each frame.
    """
    chain = _Chain(text, publish_frequency=1000.0, rate=RATE_HZ, delta=0.01)
    clock = chain.graph.clock
    chain.node.create_timer(1.0 / RATE_HZ, lambda: chain.buffer.snapshot("link_0", clock.now_ns()))
    share = await _measure_load()
    await chain.graph.close()
    return share


async def _measure_move_latencies(text: str, pause: Callable[[], float]) -> list[float]:
    """Return the ms from each slider move until the tf buffer has this or a later move."""
    chain = _Chain(text, publish_frequency=20.0)
    await asyncio.sleep(0.3)
    waiting: list[float] = []
    latencies: list[float] = []

    def arrived(_message: TFMessage) -> None:
        now = time.perf_counter()
        latencies.extend((now - since) * 1000.0 for since in waiting)
        waiting.clear()

    chain.node.create_subscription(TFMessage, "/tf", arrived, 100)
    for _ in range(MOVE_COUNT):
        await asyncio.sleep(pause())
        waiting.append(time.perf_counter())
        chain.panel.set_position("joint_1", random.uniform(-1.0, 1.0))
    await asyncio.sleep(0.2)
    await chain.graph.close()
    return latencies
