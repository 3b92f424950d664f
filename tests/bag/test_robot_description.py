"""The description with which a recording was made, and its comparison with a file."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.bag import BagReader, BagWriter, Recorder, TopicSelection
from linkwright.bag.robot_description import find_recorded_description, find_recorded_hash, hash_description
from linkwright.cli import main
from linkwright.graph import DEFAULT_QOS, DESCRIPTION_QOS, Graph, JumpClock
from linkwright.messages import String

ROBOT = """<robot name="arm">
  <link name="base_link"/>
  <link name="camera"/>
  <joint name="camera_joint" type="fixed">
    <parent link="base_link"/>
    <child link="camera"/>
    <origin xyz="0 0 0.1"/>
  </joint>
</robot>
"""


@pytest.fixture
def record(tmp_path):
    """Record a robot's description and another topic, and return the folder of the recording."""

    async def run(*topics: str, description: str | None = ROBOT) -> Path:
        clock = JumpClock(1_700_000_000_000_000_000)
        graph = Graph(clock=clock)
        node = graph.create_node("robot")
        chatter = node.create_publisher(String, "chatter", DEFAULT_QOS)
        if description is not None:
            node.create_publisher(String, "robot_description", DESCRIPTION_QOS).publish(String(data=description))
        folder = tmp_path / "recording"
        recorder = Recorder(graph.create_node("recorder"), TopicSelection(names=list(topics)), BagWriter(folder))
        await clock.advance(1)
        chatter.publish(String(data="hello"))
        await clock.advance(1)
        recorder.close()
        await graph.close()
        return folder

    return run


async def test_recorded_description_and_hash_are_returned(record):
    with BagReader(await record("/chatter", "/robot_description")) as bag:
        assert find_recorded_description(bag) == ROBOT
        assert find_recorded_hash(bag) == hash_description(ROBOT)


async def test_description_hash_is_recorded_without_description_topic(record):
    folder = await record("/chatter")
    with BagReader(folder) as bag:
        assert [topic.name for topic in bag.topics] == ["/chatter"]
        assert find_recorded_description(bag) is None
        assert find_recorded_hash(bag) == hash_description(ROBOT)
    assert "robot_description_sha256" in (folder / "metadata.yaml").read_text()


async def test_recording_without_robot_has_no_description(record, capsys):
    folder = await record("/chatter", description=None)
    with BagReader(folder) as bag:
        assert find_recorded_hash(bag) is None
    assert main(["bag", "description", str(folder)]) == 2
    assert "error[BAG118]" in capsys.readouterr().err


async def test_bag_description_prints_description(record, capsys):
    folder = await record("/chatter", "/robot_description")
    assert main(["bag", "description", str(folder)]) == 0
    assert capsys.readouterr().out == ROBOT


async def test_bag_description_compares_with_file(record, tmp_path, capsys):
    folder = await record("/chatter", "/robot_description")
    file = tmp_path / "robot.urdf.xacro"
    file.write_text(
        ROBOT.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"').replace("0.1", "$(arg height)")
        .replace('<link name="base_link"/>', '<xacro:arg name="height" default="0.1"/><link name="base_link"/>')
    )  # fmt: skip
    assert main(["bag", "description", str(folder), str(file)]) == 0
    assert capsys.readouterr().out == "no differences\n"
    assert main(["bag", "description", str(folder), str(file), "height:=0.2"]) == 1
    output = capsys.readouterr().out
    assert "joint 'camera_joint': origin xyz 0 0 0.1 -> 0 0 0.2 m" in output
    assert f"{folder}:7:" in output


async def test_bag_description_compares_hashes_without_text(record, tmp_path, capsys):
    folder = await record("/chatter")
    file = tmp_path / "robot.urdf"
    file.write_text(ROBOT)
    assert main(["bag", "description", str(folder), str(file)]) == 0
    file.write_text(ROBOT.replace("0.1", "0.2"))
    assert main(["bag", "description", str(folder), str(file)]) == 1
    assert "the description differs from the recorded one" in capsys.readouterr().out


async def test_bag_description_rejects_missing_files_and_extra_arguments(record, tmp_path, capsys):
    folder = await record("/chatter", "/robot_description")
    for words in ([str(tmp_path / "nothing")], [str(folder), str(tmp_path / "no.urdf")], [str(folder), "a", "b"]):
        assert main(["bag", "description", *words]) == 2
        assert "Traceback" not in capsys.readouterr().err
