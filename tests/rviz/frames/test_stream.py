"""The stream of transforms to pages: rates, pauses and fixed frames."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

import numpy as np

from linkwright.graph import STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph
from linkwright.messages import TFMessage, TransformBatch
from linkwright.rviz.frames.history import FrameHistory, PlacedFrame
from linkwright.rviz.frames.stream import FrameStream, TimeControl
from tests.skipping import LoopClock, skipping
from tests.viewer.scene import IDENTITY, unpack
from tests.waiting import eventually


class StreamRecorder:
    """A stream with a record of its output."""

    def __init__(self) -> None:
        self.graph = Graph(clock=LoopClock())
        node = self.graph.create_node("rig")
        self._tf = node.create_publisher(TFMessage, "/tf", TF_QOS)
        self._tf_static = node.create_publisher(TFMessage, "/tf_static", STATIC_TF_PUBLISHER_QOS)
        self.own_frames: frozenset[str] = frozenset()
        self.watched = True
        self.said: list = []
        viewer = self.graph.create_node("viewer")
        self.history = FrameHistory(viewer)
        self.stream = FrameStream(
            viewer,
            self,
            TimeControl(viewer.get_clock()),
            self.history,
            on_frames=self.said.append,
            own_frames=lambda: self.own_frames,
        )
        self.stream.fixed_frame = "base"
        self.stream.fade_time = 15.0
        self.stream.start()

    def __len__(self):
        return int(self.watched)

    def publish(self, table):
        self.said.append(table)

    def send_transforms(self, frame):
        self.said.append(unpack(frame))

    def send(self, poses, *, static=False, stamp_ns=None):
        batch = TransformBatch(
            tuple(parent for parent, _ in poses),
            tuple(child for _, child in poses),
            self.graph.timebase.now_ns() if stamp_ns is None else stamp_ns,
            np.array(list(poses.values()), dtype=np.float64),
        )
        (self._tf_static if static else self._tf).publish(TFMessage(batch=batch))

    def move(self, x: float, **options):
        self.send({("base", "tip"): (x, 0, 0, 0, 0, 0, 1)}, **options)

    async def settle(self):
        await self.graph.settle()
        await asyncio.sleep(0)
        await asyncio.sleep(0)

    def pose(self, name: str) -> list[float]:
        """Return the pose of a frame in the last transforms sent."""
        return self.sent()[-1].poses[self.stream.current_frames[0].names.index(name)].tolist()

    def ages(self, name: str) -> list[float]:
        """Return the ages of a frame in all transforms sent with the last table."""
        table = self.stream.current_frames[0]
        return [message.ages[table.names.index(name)] for message in self.sent() if message.revision == table.revision]

    def kinds(self) -> list[str]:
        kinds = [type(message).__name__ for message in self.said]
        self.said.clear()
        return kinds

    def sent(self) -> list:
        return [message for message in self.said if type(message).__name__ == "Transforms"]


@asynccontextmanager
async def run_stream() -> AsyncIterator[StreamRecorder]:
    world = StreamRecorder()
    try:
        yield world
    finally:
        world.stream.close()
        await world.graph.close()


def run_with_recorder(test):
    """Run a test with a rig, in time that is skipped."""

    @skipping
    async def run():
        async with run_stream() as recorder:
            await test(recorder)

    run.__name__ = test.__name__
    return run


@run_with_recorder
async def test_frame_table_precedes_transforms_and_frame_event(recorder):
    recorder.move(1.0)
    await recorder.settle()
    table, transforms, frames = recorder.said
    tip, base = table.names.index("tip"), table.names.index("base")
    assert (table.parents[tip], table.parents[base]) == (base, -1)
    assert transforms.revision == table.revision
    assert transforms.poses[tip].tolist() == [1, 0, 0, 0, 0, 0, 1]
    assert frames.names == tuple(table.names)
    assert frames.placed == {"tip", "base"}


@run_with_recorder
async def test_change_after_pause_is_sent_at_once(recorder):
    recorder.move(1.0)
    await asyncio.sleep(0.1)
    recorder.said.clear()
    recorder.move(2.0)
    await recorder.settle()
    assert recorder.kinds() == ["Transforms"]


@run_with_recorder
async def test_updates_are_limited_to_frame_rate_and_last_change_is_sent(recorder):
    for x in range(500):
        recorder.move(float(x))
        await asyncio.sleep(0.001)
    await asyncio.sleep(0.1)
    assert 15 <= len(recorder.sent()) <= 18  # half a second at 30 Hz, and the first at once
    assert recorder.pose("tip")[0] == x


@run_with_recorder
async def test_changes_at_frame_rate_are_sent_without_delay(recorder):
    recorder.move(-2.0)
    await recorder.settle()
    recorder.move(-1.0)
    await asyncio.sleep(0.6 / 30)
    at_once = []
    for number in range(36):
        recorder.said.clear()
        recorder.move(float(number))
        await asyncio.sleep(0.01)
        at_once.append(len(recorder.sent()) > 0)
        await asyncio.sleep(1 / 30 - 0.01)
    assert all(at_once[18:])


@run_with_recorder
async def test_fixed_frame_may_be_placed_by_display(recorder):
    recorder.stream.fixed_frame = "world"
    recorder.move(1.0)
    await recorder.settle()
    assert recorder.said[-1].placed == {"world"}
    recorder.history.set_placed_frame("display", PlacedFrame("world", "base", np.array([0.0, 2.0, *IDENTITY[2:]])))
    await asyncio.sleep(0.1)
    assert recorder.pose("tip") == [1, 2, 0, 0, 0, 0, 1]
    assert recorder.said[-1].placed == {"world", "base", "tip"}
    recorder.send({("base", "world"): IDENTITY})
    await asyncio.sleep(0.1)
    assert recorder.pose("tip") == [1, 0, 0, 0, 0, 0, 1]


@run_with_recorder
async def test_equal_transforms_are_not_sent_again(recorder):
    recorder.move(1.0)
    await recorder.settle()
    recorder.kinds()
    for _ in range(5):
        recorder.move(1.0)
        await asyncio.sleep(0.02)
    assert recorder.kinds() == []


@run_with_recorder
async def test_silent_frames_age(recorder):
    recorder.stream.fade_time = 0.6
    recorder.send({("base", "fix"): IDENTITY}, static=True)
    recorder.move(1.0)
    await asyncio.sleep(1.2)
    ages = recorder.ages("tip")
    assert ages[0] < 0.1
    assert ages == sorted(ages)
    assert ages[-1] > 0.6
    count = len(ages)
    await asyncio.sleep(0.6)
    assert len(recorder.ages("tip")) == count  # an expired frame is not sent again
    assert set(recorder.ages("fix")) == {0.0}  # static frames never age
    recorder.move(1.0)
    await recorder.settle()
    assert recorder.ages("tip")[-1] < 0.1  # the frame is received again, although it did not move


@run_with_recorder
async def test_ages_are_not_sent_without_fade_time(recorder):
    recorder.stream.fade_time = None
    recorder.move(1.0)
    await asyncio.sleep(0.6)
    assert len(recorder.sent()) == 1


@run_with_recorder
async def test_nothing_is_sent_without_pages(recorder):
    recorder.watched = False
    recorder.move(1.0)
    await recorder.settle()
    assert recorder.said == []
    recorder.stream.refresh()
    table, frame = recorder.stream.current_frames
    assert unpack(frame).revision == table.revision
    assert recorder.kinds() == ["FrameTable", "Transforms", "FrameView"]


@run_with_recorder
async def test_fixed_frame_change_sends_all_transforms(recorder):
    recorder.move(1.0)
    await recorder.settle()
    recorder.said.clear()
    recorder.stream.fixed_frame = "tip"
    recorder.stream.refresh()
    transforms, frames = recorder.said
    assert recorder.pose("base")[0] == -1.0
    assert transforms is recorder.sent()[-1]
    assert frames.fixed_frame == "tip"


@run_with_recorder
async def test_unknown_fixed_frame_gives_nan_poses(recorder):
    recorder.stream.fixed_frame = "map"
    recorder.move(1.0)
    await recorder.settle()
    _, transforms, frames = recorder.said
    assert np.isnan(transforms.poses).all()
    assert frames.placed == {"map"}
    assert frames.find_problem("tip") == "No transform from [tip] to [map]"


@run_with_recorder
async def test_frame_of_single_link_robot_is_sent_without_tf(recorder):
    recorder.own_frames = frozenset({"base"})
    recorder.stream.on_robot_changed(set())
    await recorder.settle()
    table, transforms, frames = recorder.said
    assert (table.names, table.parents) == (["base"], [-1])
    assert transforms.poses.tolist() == [list(IDENTITY)]
    assert frames.names == ()  # tf does not have this frame
    recorder.said.clear()
    recorder.move(1.0)
    await eventually(lambda: recorder.said)
    assert sorted(recorder.said[0].names) == ["base", "tip"]


@run_with_recorder
async def test_frames_of_removed_robot_are_removed(recorder):
    recorder.send({("base", "tip"): IDENTITY, ("base", "old"): IDENTITY})
    await recorder.settle()
    recorder.said.clear()
    recorder.stream.on_robot_changed({"old", "never there"})
    await eventually(lambda: len(recorder.said) == 3)
    table, transforms, frames = recorder.said
    assert sorted(table.names) == ["base", "tip"]
    assert len(transforms.poses) == 2
    assert "old" not in frames.names


@run_with_recorder
async def test_stamp_is_that_of_newest_transform(recorder):
    recorder.move(1.0, stamp_ns=2_500_000_000)
    recorder.send({("base", "b"): IDENTITY}, stamp_ns=1_000_000_000)
    await eventually(recorder.sent)
    assert recorder.sent()[-1].stamp == 2.5
