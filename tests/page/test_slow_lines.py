"""Pages with slow connections: robots keep moving, and other messages are sent less often."""

from __future__ import annotations

import asyncio
import struct
from contextlib import asynccontextmanager

import aiohttp
import numpy as np
import pytest

from linkwright.messages import get_message
from linkwright.page.outbox import ConnectionMeter
from linkwright.page.protocol.message import PIECE_KIND
from linkwright.rviz import RvizConfig
from tests.skipping import skipping
from tests.viewer.contents import unpack as unpack_content
from tests.viewer.scene import open_world, unpack
from tests.viewer.throttle import slow_line
from tests.waiting import eventually

FILE = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/PointCloud2
      Enabled: true
      Name: Cloud
      Topic: {Value: /cloud}
    - Class: rviz_default_plugins/Image
      Enabled: true
      Name: Picture
      Topic: {Value: /image}
  Global Options:
    Fixed Frame: base
    Frame Rate: 50
"""
MEGABIT_IN_BYTES = 125_000.0


def make_cloud(count: int):
    message = get_message("sensor_msgs/msg/PointCloud2")()
    field = get_message("sensor_msgs/msg/PointField")
    message.header.frame_id = "base"
    message.height, message.width, message.point_step, message.row_step = 1, count, 12, 12 * count
    message.fields = [field(name=name, offset=4 * i, datatype=7, count=1) for i, name in enumerate("xyz")]
    message.data = np.random.default_rng(1).random((count, 3), np.float32).tobytes()
    return message


def make_image(width: int, height: int):
    message = get_message("sensor_msgs/msg/Image")()
    message.header.frame_id = "base"
    message.width, message.height, message.encoding, message.step = width, height, "rgb8", 3 * width
    ramp = np.add.outer(np.arange(height), np.arange(width)) // 8
    message.data = np.repeat(ramp[..., None], 3, axis=2).astype(np.uint8).tobytes()
    return message


class Watcher:
    """A page that records the time of each message."""

    def __init__(self, socket, *, answers: bool, busy: float = 0.0) -> None:
        self.now = asyncio.get_running_loop().time
        self.busy = busy
        self.delays: list[tuple[float, float]] = []
        self.contents: list[tuple[float, dict]] = []
        self.sizes = 0
        self.x = 0.0
        self._socket = socket
        self._answers = answers
        self._pieces = bytearray()

    async def run(self) -> None:
        count = 0
        async for message in self._socket:
            count += 1
            if count > 1:
                await asyncio.sleep(self.busy)
            if self._answers and (count == 1 or len(message.data) >= 1024):
                await self._socket.send_json({"type": "received", "count": count})
            self.sizes += len(message.data)
            if message.type is not aiohttp.WSMsgType.BINARY:
                continue
            if message.data[0] == 1:
                frame = unpack(message.data)
                if len(frame.poses) and frame.poses[-1][0] > 0:
                    x = float(frame.poses[-1][0])
                    self.delays.append((self.now(), self.now() - x))
                    self.x = x
            elif frame := self._whole(message.data):
                self.contents.append((self.now(), unpack_content(frame).fields))

    def _whole(self, data: bytes) -> bytes:
        """Return the frame that a message contains or completes.

        The frame is empty if pieces are missing.
        """
        kind, _, offset, length = struct.unpack_from("<IIII", data)
        if kind != PIECE_KIND:
            return data
        if offset == 0:
            self._pieces.clear()
        self._pieces += data[16:]
        return bytes(self._pieces) if len(self._pieces) == length else b""

    def contents_of_kind(self, kind: str) -> list[dict]:
        return [fields for _, fields in self.contents if fields["kind"] == kind]


@asynccontextmanager
async def watching(url: str, *, answers: bool = True, busy: float = 0.0):
    async with (
        aiohttp.ClientSession() as session,
        session.ws_connect(url.replace("/?", "/ws?"), max_msg_size=0) as socket,
    ):
        watcher = Watcher(socket, answers=answers, busy=busy)
        task = asyncio.ensure_future(watcher.run())
        try:
            yield watcher
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)


async def publish_all(world, seconds: float, *, rate: float = 50.0, points: int = 100_000) -> None:
    """Publish the robot's transform at a rate, with x = time.

    A cloud and an image are published ten times a second.
    """
    now = asyncio.get_running_loop().time
    node = world.graph.create_node("senses")
    clouds = node.create_publisher(get_message("sensor_msgs/msg/PointCloud2"), "/cloud", 1)
    images = node.create_publisher(get_message("sensor_msgs/msg/Image"), "/image", 1)
    one_cloud, one_image = make_cloud(points), make_image(1280, 720)
    for turn in range(round(seconds * rate)):
        world.move({("base", "tip"): (now(), 0, 0, 0, 0, 0, 1)})
        if turn % int(rate / 10) == 0:
            clouds.publish(one_cloud)
            images.publish(one_image)
        await asyncio.sleep(1 / rate)


@pytest.mark.parametrize(
    ("answers", "latest", "seconds"), [(True, 0.5, 5.0), (False, 1.0, 10.0)], ids=["acknowledging", "silent"]
)
@skipping
async def test_robot_keeps_moving_over_one_megabit(answers, latest, seconds):
    """The server knows less about a client that acknowledges nothing, such as another program."""
    async with open_world(RvizConfig.parse(FILE)) as world, slow_line(world.viewer.url, MEGABIT_IN_BYTES) as url:
        async with watching(url, answers=answers) as watcher:
            start_s = watcher.now()
            await publish_all(world, seconds)
        settled = [delay for time_s, delay in watcher.delays if time_s - start_s > 2.0]
        assert len(settled) > 10
        assert max(settled) < latest
        steps = [fields["step"] for fields in watcher.contents_of_kind("cloud_points")]
        frames = watcher.contents_of_kind("image_frame")
        assert steps[-1] > 10
        assert frames[-1]["encoding"] == "file"
        assert frames[-1]["width"] == 1280
        assert frames[-1]["quality"] > 0


@skipping
async def test_fast_connection_receives_full_data():
    async with open_world(RvizConfig.parse(FILE)) as world, watching(world.viewer.url) as watcher:
        await publish_all(world, 1.5)
        assert watcher.contents_of_kind("cloud_points")[-1]["step"] == 1
        assert watcher.contents_of_kind("cloud_points")[-1]["positions"].size == 300_000
        assert watcher.contents_of_kind("image_frame")[-1]["encoding"] == "rgb"


@skipping
async def test_single_cloud_is_completed_on_fast_connection():
    async with open_world(RvizConfig.parse(FILE)) as world, watching(world.viewer.url) as watcher:
        clouds = world.graph.create_node("senses").create_publisher(
            get_message("sensor_msgs/msg/PointCloud2"), "/cloud", 1
        )
        await eventually(lambda: watcher.sizes)
        clouds.publish(make_cloud(100_000))
        await eventually(
            lambda: (
                watcher.contents_of_kind("cloud_points") and watcher.contents_of_kind("cloud_points")[-1]["step"] == 1
            )
        )


@skipping
async def test_thinned_cloud_is_completed_when_page_is_idle():
    async with open_world(RvizConfig.parse(FILE)) as world, watching(world.viewer.url, busy=0.2) as watcher:
        clouds = world.graph.create_node("senses").create_publisher(
            get_message("sensor_msgs/msg/PointCloud2"), "/cloud", 1
        )
        await eventually(lambda: watcher.sizes)
        clouds.publish(make_cloud(20_000))
        await eventually(lambda: bool(watcher.contents_of_kind("cloud_points")))
        assert watcher.contents_of_kind("cloud_points")[-1]["step"] > 1
        watcher.busy = 0.0
        await eventually(lambda: watcher.contents_of_kind("cloud_points")[-1]["step"] == 1)
        assert watcher.contents_of_kind("cloud_points")[-1]["positions"].size == 60_000


@skipping
async def test_cloud_over_slow_connection_does_not_delay_transforms():
    async with (
        open_world(RvizConfig.parse(FILE)) as world,
        slow_line(world.viewer.url, 2 * MEGABIT_IN_BYTES) as url,
        watching(url) as watcher,
    ):
        clouds = world.graph.create_node("senses").create_publisher(
            get_message("sensor_msgs/msg/PointCloud2"), "/cloud", 1
        )
        await eventually(lambda: watcher.sizes > 0)
        clouds.publish(make_cloud(20_000))
        await eventually(lambda: watcher.contents_of_kind("cloud_points"))
        assert watcher.contents_of_kind("cloud_points")[-1]["step"] > 1
        x = 0.0
        while watcher.contents_of_kind("cloud_points")[-1]["step"] > 1:
            x += 1.0
            world.move({("base", "tip"): (x, 0, 0, 0, 0, 0, 1)})
            moved = x
            await eventually(lambda moved=moved: watcher.x == moved)
        assert watcher.contents_of_kind("cloud_points")[-1]["positions"].size == 60_000
        assert x > 5  # sending the last 320 kB alone takes 1.3 s


@skipping
async def test_four_pages_drop_only_stale_frames():
    """Transforms are published at 100 Hz. One page is slow, and the others do not wait for it."""
    async with open_world(RvizConfig.parse(FILE.replace("Rate: 50", "Rate: 100"))) as world:
        async with (
            slow_line(world.viewer.url, 25_000.0) as url,
            watching(world.viewer.url) as a,
            watching(world.viewer.url) as b,
            watching(world.viewer.url) as c,
            watching(url) as slow,
        ):
            await publish_all(world, 3.0, rate=100.0, points=10_000)
            x = 123.25
            world.move({("base", "tip"): (x, 0, 0, 0, 0, 0, 1)})
            await eventually(lambda: slow.x == x)
        for quick in (a, b, c):
            assert len(quick.delays) > 270  # of 300 frames
            assert np.percentile([delay for _, delay in quick.delays[:-1]], 95) < 0.2
        assert len(slow.delays) < len(a.delays)
        for client in (a, b, c, slow):
            assert client.x == x  # all pages receive the last pose


class ManualClock:
    """A clock that the test sets."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


def test_connection_meter_learns_from_acknowledgments():
    clock = ManualClock()
    line = ConnectionMeter(clock)
    line.sending(10)
    clock.now += 0.05
    line.record_acknowledged(1)
    assert line.rate is None
    for number in range(2, 12):
        line.sending(line.room)
        assert line.is_full
        clock.now += 0.05 + line.room / 1e6
        line.record_acknowledged(number)
    assert line.rate == pytest.approx(1e6, rel=0.1)
    assert line.room == pytest.approx(1e5, rel=0.1)


def test_small_messages_do_not_fill_connection():
    line = ConnectionMeter(ManualClock())
    line.sending(10)
    line.record_acknowledged(1)
    for _ in range(1000):
        line.sending(1000)
    assert not line.is_full


def test_connection_meter_survives_invalid_acknowledgments():
    line = ConnectionMeter(ManualClock())
    for count in (-5, 10**12, 0):
        line.record_acknowledged(count)
    line.sending(10_000)
    assert 0 < line.room < 10**6
    assert not line.is_full
