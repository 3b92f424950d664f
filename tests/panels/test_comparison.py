"""Two descriptions in one scene: the messages to pages, and the position of the old robot."""

from __future__ import annotations

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path

import numpy as np
import pytest

from linkwright.descriptions import examine
from linkwright.descriptions.pairs import make_file_pair, make_old_description_key
from linkwright.graph import SENSOR_DATA_QOS
from linkwright.messages import Header, JointState
from linkwright.page.protocol.comparison import ComparedDescriptions
from linkwright.panels.comparison.feature import add_old_robot, without_paths
from linkwright.rviz import RvizConfig
from tests.viewer.scene import Client, World, open_page, open_world
from tests.waiting import eventually

OLD = """\
<robot name="arm">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="lower"><inertial><mass value="1"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="upper"/>
  <link name="camera"/>
  <joint name="turn" type="continuous"><parent link="base"/><child link="lower"/><axis xyz="0 0 1"/></joint>
  <joint name="bend" type="revolute"><origin xyz="1 0 0"/><parent link="lower"/><child link="upper"/>
    <limit lower="0.5" upper="1" effort="1" velocity="1"/></joint>
  <joint name="mount" type="prismatic"><parent link="upper"/><child link="camera"/>
    <limit lower="0" upper="1" effort="1" velocity="1"/></joint>
  <gazebo reference="lower"><mu1>1</mu1></gazebo>
</robot>
"""
NEW = """\
<robot name="arm">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>
  <link name="lower"><inertial><mass value="2"/>
    <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  <link name="upper"/>
  <link name="lidar"/>
  <joint name="spin" type="continuous"><parent link="base"/><child link="lower"/><axis xyz="0 0 1"/></joint>
  <joint name="bend" type="prismatic"><origin xyz="1 0 0"/><parent link="lower"/><child link="upper"/>
    <limit lower="0.5" upper="1" effort="1" velocity="1"/></joint>
  <joint name="fix" type="fixed"><parent link="upper"/><child link="lidar"/></joint>
  <gazebo reference="lower"><mu1>2</mu1></gazebo>
</robot>
"""


class ComparisonViewer:
    """A viewer that compares two files."""

    def __init__(self, world: World, folder: Path, old: str, new: str) -> None:
        self.world = world
        self.pair = make_file_pair(self.write(folder, "old.urdf", old), self.write(folder, "new.urdf", new), {})
        node = world.graph.create_node("old_robot_state_publisher")
        self.publish_old = world.viewer.attach_comparison(self.pair, node)
        self.joint_states = world.graph.create_node("joints").create_publisher(
            JointState, "joint_states", SENSOR_DATA_QOS
        )
        self.show_old()
        self.show_new()

    @staticmethod
    def write(folder: Path, name: str, text: str) -> Path:
        path = folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def show_old(self) -> None:
        examination = examine(self.pair.old.path)
        self.publish_old(
            self.world.library.store(examination, make_old_description_key(examination), self.pair.old.finder)
        )

    def show_new(self) -> None:
        self.world.describe(self.world.library.store(examine(self.pair.new.path)))

    def move(self, **positions: float) -> None:
        stamp = self.world.graph.timebase.now_ns()
        message = JointState(header=Header(), name=list(positions), position=list(positions.values()))
        message.header.stamp = type(message.header.stamp).from_nanoseconds(stamp)
        self.joint_states.publish(message)

    def pose(self, frame: str) -> np.ndarray | None:
        """Return the pose of a frame in `base`: x y z qx qy qz qw."""
        names, poses = self.world.viewer.manager.make_opening_state()[1].names, None
        if frame in names:
            from linkwright.page.protocol.message import unpack_transforms

            frames = self.world.viewer.manager.make_opening_state()[2]
            poses = unpack_transforms(next(frame for frame in frames if isinstance(frame, bytes)))[1][
                names.index(frame)
            ]
        return poses


@asynccontextmanager
async def open_comparison(
    folder: Path, old: str = OLD, new: str = NEW
) -> AsyncIterator[tuple[ComparisonViewer, Client]]:
    config = RvizConfig.for_model("base")
    add_old_robot(config, "old.urdf")
    async with open_world(config) as world:
        comparison = ComparisonViewer(world, folder, old, new)
        async with open_page(world.viewer) as client:
            yield comparison, client


def difference_marks(message: dict, side: str) -> dict[str, str]:
    return message[side]["marks"]


async def test_page_receives_differences_with_links(tmp_path):
    async with open_comparison(tmp_path) as (comparison, client):
        message = await client.until("compared_descriptions")
        displays = [display.id for display in comparison.world.viewer.displays if display.CLASS.endswith("RobotModel")]
        assert [message["new"]["display"], message["old"]["display"]] == displays
        assert message["new"]["label"].endswith("new.urdf")
        assert difference_marks(message, "old") == {"camera": "removed"}
        assert difference_marks(message, "new") == {"lidar": "added", "lower": "changed", "upper": "changed"}
        assert message["joints"] == {"turn": "spin"}, "a joint of another type has no counterpart"
        items = {(item["subject"], item["name"], item["property"]): item for item in message["items"]}
        mass = items["link", "lower", "inertial mass"]
        assert (mass["old"], mass["new"], mass["unit"], mass["element"]) == ("1", "2", "kg", "lower")
        assert (mass["old_place"]["line"], mass["new_place"]["line"]) == (3, 3)
        assert mass["old_place"]["file"] == str(tmp_path / "old.urdf")
        assert mass["new_place"]["text"].endswith("new.urdf:3:45")
        removed_camera = items["link", "camera", ""]
        assert (
            removed_camera["kind"],
            removed_camera["element"],
            removed_camera["in_old"],
            removed_camera["new_place"],
        ) == ("removed", "camera", True, None)
        joint = items["joint", "mount", ""]
        assert (joint["element_kind"], joint["element"], joint["in_old"]) == ("joint", "mount", True)
        assert items["joint", "spin", "name"]["kind"] == "renamed"
        friction = next(item for item in message["items"] if item["subject"] == "extension")
        assert (friction["element_kind"], friction["element"], friction["in_old"]) == ("link", "lower", False)


async def test_old_robot_follows_joints_of_new_robot(tmp_path):
    async with open_comparison(tmp_path) as (comparison, client):
        await client.until("compared_descriptions")
        await eventually(lambda: comparison.pose("old/camera") is not None)
        assert comparison.pose("old/lower") == pytest.approx([0, 0, 0, 0, 0, 0, 1], abs=1e-6)
        middle_position = 0.75 / 2  # the middle of limits that exclude zero, as in joint_state_publisher
        assert comparison.pose("old/upper")[:3] == pytest.approx([1, 0, 0], abs=1e-6)
        assert comparison.pose("old/upper")[3:] == pytest.approx(
            [np.sin(middle_position), 0, 0, np.cos(middle_position)], abs=1e-6
        )
        comparison.move(spin=np.pi, bend=0.9)
        turned = [-1, 0, 0]
        await eventually(lambda: np.allclose(comparison.pose("old/upper")[:3], turned, atol=1e-6))
        assert comparison.pose("old/lower")[3:] == pytest.approx([0, 0, 1, 0], abs=1e-6)
        assert np.linalg.norm(comparison.pose("old/upper")[:3]) == pytest.approx(1.0), "the old joint is revolute"


async def test_new_root_moves_old_robot(tmp_path):
    robot_with_foot = NEW.replace('<link name="lidar"/>', '<link name="foot"/>').replace(
        '<joint name="fix" type="fixed"><parent link="upper"/><child link="lidar"/></joint>',
        '<joint name="fix" type="fixed"><origin xyz="0 0 3"/><parent link="foot"/><child link="base"/></joint>',
    )
    async with open_comparison(tmp_path, robot_with_foot, NEW) as (comparison, client):
        message = await client.until("compared_descriptions")
        assert difference_marks(message, "old") == {"foot": "removed"}
        await eventually(lambda: comparison.pose("old/foot") is not None)
        assert comparison.pose("old/base")[:3] == pytest.approx([0, 0, 0], abs=1e-6)
        assert comparison.pose("old/foot")[:3] == pytest.approx([0, 0, -3], abs=1e-6)


async def test_edited_description_is_compared_again(tmp_path):
    async with open_comparison(tmp_path) as (comparison, client):
        count = len((await client.until("compared_descriptions"))["items"])
        comparison.write(tmp_path, "new.urdf", NEW.replace('mass value="2"', 'mass value="1"'))
        comparison.show_new()
        fewer = await client.until("compared_descriptions")
        assert len(fewer["items"]) == count - 1
        assert "lower" in difference_marks(fewer, "new"), "the name of its joint differs"
        comparison.write(tmp_path, "old.urdf", comparison.pair.new.path.read_text(encoding="utf-8"))
        comparison.show_old()
        message = await client.until("compared_descriptions")
        assert (message["items"], difference_marks(message, "new"), difference_marks(message, "old")) == ([], {}, {})


async def test_source_text_of_both_descriptions_can_be_requested(tmp_path):
    async with open_comparison(tmp_path, NEW, NEW) as (comparison, client):
        message = await client.until("compared_descriptions")
        assert message["items"] == []
        for side, name in (("old", "old.urdf"), ("new", "new.urdf")):
            file = str(tmp_path / name)
            await client.send("request_description_text", display=message[side]["display"], file=file)
            assert (await client.until("description_text", file=file))["text"] == NEW
        assert comparison.world.library.packages(comparison.world.display("RobotModel").text) is None


async def test_removed_old_display_is_reported_as_empty(tmp_path):
    async with open_comparison(tmp_path) as (comparison, client):
        message = await client.until("compared_descriptions")
        await client.send("remove_displays", displays=[message["old"]["display"]])
        assert (await client.until("compared_descriptions"))["old"]["display"] == ""
        assert comparison.world.viewer.manager.display(message["old"]["display"]) is None


async def test_exported_comparison_contains_no_paths(tmp_path):
    async with open_comparison(tmp_path) as (comparison, client):
        await client.until("compared_descriptions")
        manager = comparison.world.viewer.manager
        result = next(
            message
            for message in comparison.world.viewer.configuration_messages(manager)
            if isinstance(message, ComparedDescriptions)
        )
        result_without_paths = without_paths(result)
        assert (result_without_paths.old.label, result_without_paths.new.label) == ("old.urdf", "new.urdf")
        places = [
            place
            for item in result_without_paths.items
            for place in (item.old_place, item.new_place)
            if place is not None
        ]
        assert {place.file for place in places} == {""}
        assert {place.text.partition(":")[0] for place in places} == {"old.urdf", "new.urdf"}
