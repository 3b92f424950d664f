"""The robot of a recording without transforms.

Its pose follows the joint states at any time.
"""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from linkwright.bag import BagReader, BagWriter, Playback
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DEFAULT_QOS, DESCRIPTION_QOS, STATIC_TF_PUBLISHER_QOS, TF_QOS, Graph
from linkwright.messages import JointState, String, TFMessage, TransformBatch, serialize
from linkwright.viewer.recorded_robot import RecordingWithTransforms, publish_recording, read_robot

START_S = 1_700_000_000
SECOND_NS = 1_000_000_000
ARM = """
<robot name="arm">
  <link name="base"/> <link name="camera"/> <link name="upper"/> <link name="lower"/> <link name="finger"/>
  <joint name="mount" type="fixed"><parent link="base"/><child link="camera"/></joint>
  <joint name="lift" type="prismatic">
    <parent link="base"/><child link="upper"/><axis xyz="0 0 1"/><limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
  <joint name="reach" type="prismatic">
    <parent link="upper"/><child link="lower"/><axis xyz="1 0 0"/><limit lower="2" upper="4" effort="1" velocity="1"/>
  </joint>
  <joint name="grip" type="prismatic">
    <parent link="lower"/><child link="finger"/><mimic joint="reach" multiplier="2"/>
    <limit lower="0" upper="9" effort="1" velocity="1"/>
  </joint>
</robot>
"""


def record_arm(path: Path, lift_positions: Sequence[float], transforms: bool = False) -> Path:
    """Record an arm, and a joint state each second that contains only one joint."""
    with BagWriter(path) as writer:
        writer.add_topic("/robot_description", "std_msgs/msg/String", [DESCRIPTION_QOS])
        writer.write("/robot_description", START_S * SECOND_NS, serialize(String(data=ARM)))
        if transforms:
            writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
            writer.write("/tf", START_S * SECOND_NS, serialize(TFMessage(transforms=[])))
        if lift_positions:
            writer.add_topic("/joint_states", "sensor_msgs/msg/JointState", [DEFAULT_QOS])
        for second, lift in enumerate(lift_positions):
            states = JointState(name=["lift", "unknown"], position=[lift, 1.0])
            states.header.stamp.sec = START_S + second
            writer.write("/joint_states", (START_S + second) * SECOND_NS, serialize(states))
    return path


class ShownRecording:
    """A published recording, and the last positions of the links.

    Positions are x, y, z in the parent link, in meters.
    """

    def __init__(self, bag: BagReader) -> None:
        self.graph = Graph()
        player, listener = self.graph.create_node("player"), self.graph.create_node("listener")
        self.output = publish_recording(bag, player, read_robot(bag, DescriptionLibrary()))
        self.failures: list[Exception] = []
        self.playback = Playback(player.handle, bag, self.output, self.failures.append)
        self.places: dict[str, list[float]] = {}
        listener.create_subscription(TFMessage, "/tf", self._heard, TF_QOS)
        listener.create_subscription(TFMessage, "/tf_static", self._heard, STATIC_TF_PUBLISHER_QOS)
        self.playback.update_subscribed_topics()

    def _heard(self, message: TFMessage) -> None:
        self.places.update(zip(message.batch.children, message.batch.poses[:, :3].tolist(), strict=True))

    async def at(self, second: int) -> dict[str, list[float]]:
        """Return the positions of the links at a time."""
        self.places.clear()
        self.playback.seek((START_S + second) * SECOND_NS)
        for _ in range(4):  # a seek takes a few turns of the loop
            await asyncio.sleep(0)
        await self.graph.settle()
        assert self.failures == []
        return self.places

    async def close(self) -> None:
        self.playback.close()
        await self.graph.close()


async def test_link_poses_follow_recorded_joint_states(tmp_path: Path) -> None:
    """Joints without messages are at zero, or at the center of limits that exclude zero.

    Mimic joints follow.
    """
    with BagReader(record_arm(tmp_path / "bag", [0.5, 1.0, 7.0])) as bag:
        shown = ShownRecording(bag)
        for second, lift in ((2, 7.0), (0, 0.5), (1, 1.0)):
            assert await shown.at(second) == {
                "camera": [0, 0, 0],
                "upper": [0, 0, lift],
                "lower": [3, 0, 0],
                "finger": [6, 0, 0],
            }
        await shown.close()


async def test_joints_without_recorded_states_are_at_zero(tmp_path: Path) -> None:
    with BagReader(record_arm(tmp_path / "bag", [])) as bag:
        shown = ShownRecording(bag)
        places = await shown.at(0)
        assert (places["upper"], places["camera"]) == ([0, 0, 0], [0, 0, 0])
        await shown.close()


@pytest.mark.parametrize("transforms", [False, True])
async def test_recorded_transforms_take_precedence(tmp_path: Path, transforms: bool) -> None:
    with BagReader(record_arm(tmp_path / "bag", [0.5], transforms)) as bag:
        shown = ShownRecording(bag)
        assert isinstance(shown.output, RecordingWithTransforms) is not transforms
        assert bool(await shown.at(0)) is not transforms
        await shown.close()


async def test_namespaced_transforms_are_used(tmp_path: Path) -> None:
    """At any time, the transforms of the last second before it and static transforms are used."""
    names = ("one", "two", "laser")
    with BagWriter(tmp_path / "bag") as writer:
        for name in ("/robot1/tf", "/robot1/tf_static"):
            writer.add_topic(name, "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        for second, name in enumerate(names):
            topic = "/robot1/tf_static" if name == "laser" else "/robot1/tf"
            pose = np.array([[second, 0, 0, 0, 0, 0, 1.0]])
            batch = TransformBatch(("base",), (name,), (START_S + second) * SECOND_NS, pose)
            writer.write(topic, (START_S + second) * SECOND_NS, serialize(TFMessage(batch=batch)))
    with BagReader(tmp_path / "bag") as bag:
        shown = ShownRecording(bag)
        assert await shown.at(2) == {"one": [0, 0, 0], "two": [1, 0, 0], "laser": [2, 0, 0]}
        assert await shown.at(0) == {"one": [0, 0, 0]}
        await shown.close()
