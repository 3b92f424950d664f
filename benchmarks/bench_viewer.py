"""What the viewer costs the server, and how fast a slider reaches a page.

Run it with ``python -m benchmarks viewer``. The page is a WebSocket client in a process of its own, which answers as a
browser's socket does but draws nothing. "Viewer" is the cost with the viewer less that of the same publishers alone.
"""

from __future__ import annotations

import asyncio
import json
import multiprocessing
import statistics
import struct
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import aiohttp
import numpy as np

from benchmarks.measure import Row
from benchmarks.robots import tree_robot
from linkwright.graph import DESCRIPTION_QOS, TF_QOS, Graph
from linkwright.messages import String, TFMessage, TransformBatch
from linkwright.nodes import NodeOptions
from linkwright.nodes.joint_state_publisher_gui import JointStatePublisherGui
from linkwright.nodes.robot_state_publisher import RobotStatePublisher
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer import RvizConfig, Viewer
from linkwright.workspace import PackageFinder

LINKS = 500
RATE = 30
SECONDS = 6.0
MOVES = 60


class Publisher:
    """Publishes a chain of moving frames, all in one message, at a steady rate."""

    def __init__(self, graph: Graph, links: int) -> None:
        self._tf = graph.create_node("publisher").create_publisher(TFMessage, "/tf", TF_QOS)
        self._parents = tuple(f"link_{number // 2}" for number in range(1, links))
        self._children = tuple(f"link_{number}" for number in range(1, links))
        self._poses = np.tile([0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], (links - 1, 1))

    async def run(self, seconds: float) -> None:
        """Publish for a while."""
        start = time.perf_counter()
        for turn in range(round(seconds * RATE)):
            poses = self._poses.copy()
            poses[:, 2] = 0.01 * turn
            self._tf.publish(TFMessage(batch=TransformBatch(self._parents, self._children, time.time_ns(), poses)))
            await asyncio.sleep(max(0.0, start + (turn + 1) / RATE - time.perf_counter()))


@asynccontextmanager
async def viewer_of(graph: Graph, library: DescriptionLibrary) -> AsyncIterator[Viewer]:
    """A started viewer of a robot with the root ``link_0``."""
    config = RvizConfig.for_model("link_0")
    viewer = Viewer(graph, library=library, finder=PackageFinder(), config=config, port=0)
    await viewer.start()
    try:
        yield viewer
    finally:
        await viewer.close()


def listen(url: str, ready: Any, stop: Any, counted: Any) -> None:
    """In another process: be a page, and count what comes."""

    async def be_a_page() -> None:
        frames = size = 0
        async with aiohttp.ClientSession() as session, session.ws_connect(url, max_msg_size=0) as socket:
            ready.set()
            while not stop.is_set():
                try:
                    message = await socket.receive(timeout=0.1)
                except asyncio.TimeoutError:
                    continue
                if message.type is aiohttp.WSMsgType.BINARY:
                    frames += 1
                size += len(message.data)
            counted.put((frames, size))

    asyncio.run(be_a_page())


async def cost(pages: int | None) -> tuple[float, float]:
    """Share of a core, and binary frames a second to each page; None pages for no viewer at all."""
    graph = Graph(on_log=lambda _: None)
    publisher = Publisher(graph, LINKS)
    if pages is None:
        await publisher.run(0.5)
        return await _measured(publisher), 0.0
    spawn = multiprocessing.get_context("spawn")
    library = DescriptionLibrary()
    async with viewer_of(graph, library) as viewer:
        description = graph.create_node("describer").create_publisher(String, "robot_description", DESCRIPTION_QOS)
        description.publish(String(tree_robot(LINKS)))
        stop, counted = spawn.Event(), spawn.Queue()
        url = viewer.url.replace("/?", "/ws?")
        readies = [spawn.Event() for _ in range(pages)]
        processes = [spawn.Process(target=listen, args=(url, ready, stop, counted)) for ready in readies]
        for process in processes:
            process.start()
        for ready in readies:
            await asyncio.to_thread(ready.wait)
        await publisher.run(1.0)
        share = await _measured(publisher)
        stop.set()
        totals = [await asyncio.to_thread(counted.get) for _ in processes]
        for process in processes:
            await asyncio.to_thread(process.join)
    await graph.close()
    frames = statistics.mean(total[0] for total in totals) if totals else 0.0
    return share, frames / (SECONDS + 1.0)


async def _measured(publisher: Publisher) -> float:
    cpu, wall = time.process_time(), time.perf_counter()
    await publisher.run(SECONDS)
    return (time.process_time() - cpu) / (time.perf_counter() - wall)


async def slider_latencies(joints: int) -> list[float]:
    """Milliseconds from a page's slider move to the transforms in the page, through all nodes, one process."""
    graph, library = Graph(on_log=lambda _: None), DescriptionLibrary()
    text = tree_robot(joints)
    async with viewer_of(graph, library) as viewer:
        panel = JointStatePublisherGui(graph, NodeOptions(library=library)).panel
        viewer.attach_joint_panel(panel)
        RobotStatePublisher(graph, NodeOptions(parameters={"robot_description": text}, library=library))
        async with (
            aiohttp.ClientSession() as session,
            session.ws_connect(viewer.url.replace("/?", "/ws?"), max_msg_size=0) as socket,
        ):
            await _drained(socket)
            name = panel.sliders()[0].name
            delays = []
            for turn in range(MOVES):
                await asyncio.sleep(0.05 + 0.01 * (turn % 7))
                start = time.perf_counter()
                await socket.send_str(json.dumps({"type": "set_joint", "name": name, "position": 0.01 * (turn + 1)}))
                while (await socket.receive(timeout=2)).type is not aiohttp.WSMsgType.BINARY:
                    pass
                delays.append((time.perf_counter() - start) * 1e3)
    await graph.close()
    return delays


async def opening(joints: int) -> tuple[float, int]:
    """Milliseconds from connecting to the last opening message, and their size in bytes."""
    graph, library = Graph(on_log=lambda _: None), DescriptionLibrary()
    async with viewer_of(graph, library) as viewer:
        JointStatePublisherGui(graph, NodeOptions(library=library))
        RobotStatePublisher(graph, NodeOptions(parameters={"robot_description": tree_robot(joints)}, library=library))
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


async def _drained(socket: aiohttp.ClientWebSocketResponse) -> None:
    try:
        while True:
            await socket.receive(timeout=0.5)
    except asyncio.TimeoutError:
        return


def rows() -> list[Row]:
    """The table."""
    alone, _ = asyncio.run(cost(None))
    table = [Row(f"publisher alone, {LINKS} links at {RATE} Hz", alone * 100, "% of a core")]
    for pages, label in ((0, "nobody watches"), (1, "one page"), (4, "four pages")):
        share, rate = asyncio.run(cost(pages))
        table.append(Row(f"viewer, {LINKS} links at {RATE} Hz, {label}", (share - alone) * 100, "% of a core"))
        if pages:
            table.append(Row(f"frames to each page, {label}", rate, "1/s"))
    for joints in (5, LINKS):
        delays = asyncio.run(slider_latencies(joints))
        table.append(
            Row(f"slider to page, {joints} joints ({max(delays):.3g} at most)", statistics.median(delays), "ms")
        )
        took, size = asyncio.run(opening(joints))
        table.append(Row(f"page opens, {joints} joints, {size / 1024:.0f} KiB", took, "ms"))
    return table
