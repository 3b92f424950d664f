"""Measure the load of the viewer, and the latency from a slider to a page.

Run it with ``python -m benchmarks viewer``. The page is a WebSocket client in a separate process, which responds as a
browser does but draws nothing. "Viewer" is the cost with the viewer minus the cost of the publishers alone.
"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import statistics
import struct
import subprocess
import sys
import time
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager
from dataclasses import dataclass
from typing import Any

import aiohttp
import numpy as np
import psutil

from benchmarks.data_scenes import FramePublisher, call_at_rate
from benchmarks.measure import ROOT, Row
from benchmarks.robots import make_tree_robot
from linkwright.bag import History
from linkwright.bag.stillness import extract_content
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS, Graph
from linkwright.messages import String, TFMessage, TransformBatch, get_message, serialize
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.packages import PackageFinder
from linkwright.rviz import RvizConfig
from linkwright.viewer import Viewer

LINK_COUNT = 500
RATE_HZ = 30
DURATION_S = 6.0
MOVE_COUNT = 60


@asynccontextmanager
async def start_viewer(graph: Graph, library: DescriptionLibrary) -> AsyncIterator[Viewer]:
    """Yield a started viewer of a robot with the root ``link_0``."""
    config = RvizConfig.for_model("link_0")
    viewer = Viewer(graph, library=library, finder=PackageFinder(), config=config, port=0)
    await viewer.start()
    try:
        yield viewer
    finally:
        await viewer.close()


@dataclass
class ReceivedTransforms:
    """The transforms that a page received: the rate in Hz, and their age at reception in ms."""

    rate: float
    ages: list[float]


@dataclass
class Cost:
    """The load in percent of a core, and the transforms that each page received."""

    share: float
    pages: list[ReceivedTransforms]


def receive_as_page(url: str, ready: Any, stop: Any, results: Any) -> None:
    """Act as a page in another process, and record the received transforms."""

    async def be_a_page() -> None:
        ages = []
        async with aiohttp.ClientSession() as session, session.ws_connect(url, max_msg_size=0) as socket:
            ready.set()
            begin = time.perf_counter()
            while not stop.is_set():
                try:
                    message = await socket.receive(timeout=0.1)
                except asyncio.TimeoutError:
                    continue
                if message.type is aiohttp.WSMsgType.BINARY:
                    (stamp,) = struct.unpack_from("<d", message.data, 16)
                    ages.append(1e3 * (time.time() - stamp))
            results.put(ReceivedTransforms(len(ages) / (time.perf_counter() - begin), ages))

    asyncio.run(be_a_page())


async def measure_cost(links: int, pages: int | None) -> Cost:
    """Return the cost of moving frames with a number of pages, or without a viewer for None."""
    graph = Graph(on_log=lambda _: None)
    publish = FramePublisher(graph, links).publish
    if pages is None:
        await call_at_rate(RATE_HZ, publish, 0.5)
        return Cost(await _measure_load(publish), [])
    spawn = multiprocessing.get_context("spawn")
    library = DescriptionLibrary()
    async with start_viewer(graph, library) as viewer:
        description = graph.create_node("describer").create_publisher(String, "robot_description", DESCRIPTION_QOS)
        description.publish(String(data=make_tree_robot(links)))
        stop, results = spawn.Event(), spawn.Queue()
        url = viewer.url.replace("/?", "/ws?")
        readies = [spawn.Event() for _ in range(pages)]
        processes = [spawn.Process(target=receive_as_page, args=(url, ready, stop, results)) for ready in readies]
        for process in processes:
            process.start()
        for ready in readies:
            await asyncio.to_thread(ready.wait)
        await call_at_rate(RATE_HZ, publish, 1.0)
        share = await _measure_load(publish)
        stop.set()
        received = [await asyncio.to_thread(results.get) for _ in processes]
        for process in processes:
            await asyncio.to_thread(process.join)
    await graph.close()
    return Cost(share, received)


async def _measure_load(publish: Callable[[int], None]) -> float:
    cpu, wall = time.process_time(), time.perf_counter()
    await call_at_rate(RATE_HZ, publish, DURATION_S)
    return 100 * (time.process_time() - cpu) / (time.perf_counter() - wall)


async def measure_slider_latencies(joints: int) -> list[float]:
    """Return the ms from slider moves to the transforms in the page.

    All nodes are in one process.
    """
    graph, library = Graph(on_log=lambda _: None), DescriptionLibrary()
    text = make_tree_robot(joints)
    async with start_viewer(graph, library) as viewer:
        panel = JointStatePublisherGui(graph, NodeOptions(library=library)).panel
        viewer.attach_joint_panel(panel)
        RobotStatePublisher(graph, NodeOptions(parameters={"robot_description": text}, library=library))
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(viewer.url.replace("/?", "/ws?"), max_msg_size=0) as socket,
        ):
            await _drain(socket)
            name = panel.sliders()[0].name
            delays = []
            for turn in range(MOVE_COUNT):
                await asyncio.sleep(0.05 + 0.01 * (turn % 7))
                start = time.perf_counter()
                await socket.send_str(json.dumps({"type": "set_joint", "name": name, "position": 0.01 * (turn + 1)}))
                while (await socket.receive(timeout=2)).type is not aiohttp.WSMsgType.BINARY:
                    pass
                delays.append((time.perf_counter() - start) * 1e3)
    await graph.close()
    return delays


async def measure_opening(joints: int) -> tuple[float, int]:
    """Return the ms until the last opening message, and the size of these messages in bytes."""
    graph, library = Graph(on_log=lambda _: None), DescriptionLibrary()
    async with start_viewer(graph, library) as viewer:
        JointStatePublisherGui(graph, NodeOptions(library=library))
        RobotStatePublisher(
            graph, NodeOptions(parameters={"robot_description": make_tree_robot(joints)}, library=library)
        )
        await asyncio.sleep(0.5)
        start, size = time.perf_counter(), 0
        address = viewer.url.replace("/?", "/ws?")
        async with aiohttp.ClientSession() as session, session.ws_connect(address, max_msg_size=0) as socket:
            while True:
                message = await socket.receive(timeout=2)
                size += len(message.data)
                if message.type is aiohttp.WSMsgType.BINARY:
                    assert struct.unpack_from("<I", message.data, 8)[0] >= joints
                    took = (time.perf_counter() - start) * 1e3
                    break
    await graph.close()
    return took, size


async def _drain(socket: aiohttp.ClientWebSocketResponse) -> None:
    try:
        while True:
            await socket.receive(timeout=0.5)
    except asyncio.TimeoutError:
        return


def measure_growth() -> float:
    """Return the growth of the process in MB in an hour of a simulated robot at rest."""
    now_ns = 0
    history = History(256_000_000, lambda: now_ns)

    def keep(topic: str, message: Any) -> None:
        data = serialize(message)
        history.add(topic, data, content=extract_content(message.TYPE_NAME, data))

    clock = get_message("rosgraph_msgs/msg/Clock")()
    process = psutil.Process()
    start_bytes = 0
    for tick in range(61 * 60 * 100):
        now_ns = tick * 10_000_000
        clock.clock.sec, clock.clock.nanosec = divmod(now_ns, 1_000_000_000)
        keep("/clock", clock)
        pose = [0.1 + 1e-13 * (tick % 7), 0, 0.05, 0, 0, 0, 1]
        for topic, every, parts in (
            ("/tf", 2, ["base"]),
            ("/tf", 3, ["left", "right"]),
            ("/world_poses", 3, ["a", "b"]),
        ):
            if tick % every == 0:
                poses = np.array([pose] * len(parts))
                keep(topic, TFMessage(batch=TransformBatch(("odom",) * len(parts), tuple(parts), now_ns, poses)))
        if tick == 60 * 100:  # the first minute fills caches
            start_bytes = process.memory_info().rss
    history.close()
    return (process.memory_info().rss - start_bytes) / 1e6


def measure_growth_in_new_process() -> Row:
    """Measure `measure_growth` in a new process.

    This process could reuse memory of earlier measurements.
    """
    program = "from benchmarks.bench_viewer import growth; print(growth())"
    result = subprocess.run([sys.executable, "-c", program], check=True, cwd=ROOT, capture_output=True, text=True)
    return Row("growth in an hour of a simulated robot at rest", float(result.stdout), "MB", "2")


def measure_moving_frames(links: int, target: str, pages: tuple[tuple[int, str], ...]) -> list[Row]:
    """Measure the cost and the age of moving frames with no page, one page and many pages."""
    what = f"{links} links at {RATE_HZ} Hz"
    alone = asyncio.run(measure_cost(links, None)).share
    table = [Row(f"publisher alone, {what}", alone, "% of a core")]
    for count, label in pages:
        costs = asyncio.run(measure_cost(links, count))
        table.append(Row(f"viewer, {what}, {label}", costs.share - alone, "% of a core", target if count == 1 else ""))
        if count:
            oldest = max(statistics.median(page.ages) for page in costs.pages)
            table.append(Row(f"frames to each page, {label}", min(page.rate for page in costs.pages), "1/s", "30"))
            table.append(Row(f"age of frames when they come, {label}", oldest, "ms"))
    return table


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    table = measure_moving_frames(12, "3", ((1, "one page"),))
    table += measure_moving_frames(LINK_COUNT, "5", ((0, "nobody watches"), (1, "one page"), (4, "four pages")))
    for joints in (5, LINK_COUNT):
        delays = asyncio.run(measure_slider_latencies(joints))
        table.append(
            Row(f"slider to page, {joints} joints ({max(delays):.3g} at most)", statistics.median(delays), "ms")
        )
        took, size = asyncio.run(measure_opening(joints))
        table.append(Row(f"page opens, {joints} joints, {size / 1024:.0f} KiB", took, "ms"))
    table.append(measure_growth_in_new_process())
    return table
