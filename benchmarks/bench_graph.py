"""What the computation graph costs: joint_state_publisher -> robot_state_publisher -> tf buffer -> snapshot.

Run it with ``python -m benchmarks graph``. It prints the share of one core for robots of 500 joints at 30 Hz, and how
long a slider move takes from ``set_position`` to the tf buffer.
"""

from __future__ import annotations

import asyncio
import random
import statistics
import time
from collections.abc import Callable
from typing import Any

from benchmarks.robots import tree_robot
from linkwright.graph import Graph, TransformBuffer, TransformListener
from linkwright.messages import TFMessage
from linkwright.nodes import JointStatePublisherGui, NodeOptions, RobotStatePublisher
from linkwright.urdf import DescriptionLibrary

JOINTS = 500
RATE = 30
SECONDS = 5.0
MOVES = 60


class _Bench:
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


async def cost(text: str, *, snapshots: bool) -> float:
    """Share of a core with all joints moving."""
    bench = _Bench(text, publish_frequency=1000.0, rate=RATE, delta=0.01)
    if snapshots:
        clock = bench.graph.clock
        bench.node.create_timer(1.0 / RATE, lambda: bench.buffer.snapshot("link_0", clock.now_ns()))
    await asyncio.sleep(0.5)
    cpu, wall = time.process_time(), time.perf_counter()
    await asyncio.sleep(SECONDS)
    used, passed = time.process_time() - cpu, time.perf_counter() - wall
    await bench.graph.close()
    return used / passed


async def move_latencies(text: str, pause: Callable[[], float]) -> list[float]:
    """Milliseconds from each slider move until the tf buffer knows of it or of a later one."""
    bench = _Bench(text, publish_frequency=20.0)
    await asyncio.sleep(0.3)
    waiting: list[float] = []
    latencies: list[float] = []

    def arrived(_message: TFMessage) -> None:
        now = time.perf_counter()
        latencies.extend((now - since) * 1000.0 for since in waiting)
        waiting.clear()

    bench.node.create_subscription(TFMessage, "/tf", arrived, 100)
    for _ in range(MOVES):
        await asyncio.sleep(pause())
        waiting.append(time.perf_counter())
        bench.panel.set_position("joint_1", random.uniform(-1.0, 1.0))
    await asyncio.sleep(0.2)
    await bench.graph.close()
    return sorted(latencies)


def main() -> None:
    """Print the table."""
    for name, branching in (("one chain", 1), ("tree", 3), ("star", JOINTS)):
        text = tree_robot(JOINTS + 1, branching)
        for snapshots in (False, True):
            share = asyncio.run(cost(text, snapshots=snapshots))
            what = "publishers, tf buffer" + (", snapshots" if snapshots else "")
            print(f"{JOINTS} joints, {RATE} Hz, {name:<10} {what:<36} {share:8.2%} of a core")
    text = tree_robot(JOINTS + 1)
    for name, pause in (
        ("single moves", lambda: random.uniform(0.12, 0.25)),
        ("a drag of 60 moves a second", lambda: 1.0 / 60.0),
    ):
        latencies = asyncio.run(move_latencies(text, pause))
        most = latencies[int(len(latencies) * 0.95)]
        print(
            f"slider to tf buffer, {JOINTS} joints, {name:<28} "
            f"median {statistics.median(latencies):5.1f} ms, 95 % {most:5.1f} ms"
        )


if __name__ == "__main__":
    main()
