"""A graph with a viewer, and a connected page; for tests."""

from __future__ import annotations

import asyncio
import json
import struct
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import aiohttp
import numpy as np

from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DESCRIPTION_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph, LogRecord
from linkwright.messages import String, TFMessage, TransformBatch
from linkwright.packages import PackageFinder
from linkwright.rviz import RvizConfig
from linkwright.viewer import Viewer
from tests.skipping import graph_clock
from tests.waiting import TIMEOUT_S

ARM = """\
<robot name="arm">
  <link name="base">
    <visual>
      <geometry><box size="1 2 3"/></geometry>
      <material name="grey"><color rgba="0.5 0.5 0.5 1"/></material>
    </visual>
  </link>
  <link name="tip">
    <visual name="ball">
      <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>
      <geometry><sphere radius="0.1"/></geometry>
    </visual>
    <collision><geometry><cylinder radius="0.2" length="0.4"/></geometry></collision>
  </link>
  <link name="mark"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/></joint>
  <joint name="fix" type="fixed"><parent link="tip"/><child link="mark"/></joint>
</robot>
"""

IDENTITY = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


class World:
    """A graph with a viewer, and publishers of a description and of transforms."""

    def __init__(self, config: RvizConfig | None = None, packages: dict[str, Path] | None = None, **options) -> None:
        self.log: list[LogRecord] = []
        self.graph = Graph(clock=graph_clock(), on_log=self.log.append)
        node = self.graph.create_node("publishers")
        self._description = node.create_publisher(String, "robot_description", DESCRIPTION_QOS)
        self._tf = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._tf_static = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self.library = DescriptionLibrary()
        self.viewer = Viewer(
            self.graph,
            library=self.library,
            finder=PackageFinder(start=Path("/nonexistent"), environment={}, extra=packages or {}),
            config=config or RvizConfig.for_model("base"),
            port=0,
            **options,
        )

    def describe(self, text: str) -> None:
        self._description.publish(String(data=text))

    def move(self, poses: dict[tuple[str, str], tuple[float, ...]], *, static: bool = False) -> None:
        """Publish poses of children in parents: (parent, child) -> x y z qx qy qz qw."""
        batch = TransformBatch(
            tuple(parent for parent, _ in poses),
            tuple(child for _, child in poses),
            self.graph.timebase.now_ns(),
            np.array(list(poses.values()), dtype=np.float64).reshape(-1, 7),
        )
        (self._tf_static if static else self._tf).publish(TFMessage(batch=batch))

    def move_arm(self, x: float = 0.0) -> None:
        self.move({("base", "tip"): (x, 0, 0, 0, 0, 0, 1)})
        self.move({("tip", "mark"): IDENTITY}, static=True)

    async def settle(self) -> None:
        await self.graph.settle()
        await asyncio.sleep(0)

    def display(self, cls: str):
        return next(display for display in self.viewer.displays if display.CLASS.endswith(f"/{cls}"))

    def status(self, cls: str) -> dict[str, tuple[str, str]]:
        return {row.name: (row.level, row.text) for row in self.display(cls).status}

    def logged(self) -> str:
        return "\n".join(record.text for record in self.log)


@asynccontextmanager
async def open_world(config: RvizConfig | None = None, **options) -> AsyncIterator[World]:
    """Start a world, and close it at the end."""
    world = World(config, **options)
    await world.viewer.start()
    try:
        yield world
    finally:
        await world.viewer.close()
        await world.graph.close()


@dataclass
class Transforms:
    """A binary frame, unpacked."""

    revision: int
    stamp: float
    poses: np.ndarray
    ages: np.ndarray


def unpack(frame: bytes) -> Transforms:
    kind, revision, count, zero, stamp = struct.unpack_from("<IIIId", frame)
    assert (kind, zero) == (1, 0)
    assert len(frame) == 24 + count * 32
    numbers = np.frombuffer(frame, "<f4", offset=24)
    return Transforms(revision, stamp, numbers[: count * 7].reshape(count, 7), numbers[count * 7 :])


@dataclass
class Client:
    """A page without a scene, which stores the messages that it receives."""

    socket: aiohttp.ClientWebSocketResponse
    messages: list[dict | Transforms | bytes] = field(default_factory=list)

    async def receive(self, timeout: float = TIMEOUT_S) -> dict | Transforms | bytes:
        message = await self.socket.receive(timeout=timeout)
        if message.type is aiohttp.WSMsgType.BINARY:
            decoded: dict | Transforms | bytes = unpack(message.data) if message.data[0] == 1 else message.data
        elif message.type is aiohttp.WSMsgType.TEXT:
            decoded = json.loads(message.data)
        else:
            raise ConnectionError(f"{message.type.name} {self.socket.close_code}")
        self.messages.append(decoded)
        return decoded

    async def until(self, kind: str, **fields) -> dict:
        """Return the next message of a type with these fields."""
        while True:
            message = await self.receive()
            if isinstance(message, dict) and message["type"] == kind and fields.items() <= message.items():
                return message

    async def transforms(self) -> Transforms:
        while True:
            message = await self.receive()
            if isinstance(message, Transforms):
                return message

    async def drain(self, silence_s: float = 0.15) -> list[dict | Transforms | bytes]:
        """Receive messages until none arrives for a while, and return them."""
        start = len(self.messages)
        with suppress(asyncio.TimeoutError):
            while True:
                await self.receive(timeout=silence_s)
        return self.messages[start:]

    async def opened(self) -> dict[str, dict]:
        """Return the opening messages by type, up to the frame table."""
        first: dict[str, dict] = {}
        while "frame_table" not in first:
            message = await self.receive()
            assert isinstance(message, dict)
            first[message["type"]] = message
        return first

    async def send(self, kind: str, **fields) -> None:
        await self.socket.send_json({"type": kind, **fields})

    async def set(self, identity: str, value) -> None:
        await self.send("set_property", id=identity, value=value)


@asynccontextmanager
async def open_page(viewer: Viewer, options: str = "") -> AsyncIterator[Client]:
    """Open a connected page, with `options` appended to its address.

    Its end is not waited for long.
    """
    address = viewer.url.replace("/?", "/ws?") + options
    close_timeout = aiohttp.ClientWSTimeout(ws_close=1.0)
    async with aiohttp.ClientSession() as session, session.ws_connect(address, timeout=close_timeout) as socket:
        yield Client(socket)


def rows_by_id(properties: list[dict]) -> dict[str, dict]:
    """Return all property rows, including nested ones."""
    rows = {}
    for row in properties:
        rows[row["id"]] = row
        rows |= rows_by_id(row["children"])
    return rows
