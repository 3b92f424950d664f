"""The initial configuration for a recording."""

from __future__ import annotations

from pathlib import Path

import pytest

from linkwright.bag import STORAGES, BagReader, BagWriter
from linkwright.descriptions import DescriptionLibrary
from linkwright.graph import DEFAULT_QOS, DESCRIPTION_QOS, SENSOR_DATA_QOS
from linkwright.messages import String, TFMessage, get_message, serialize
from linkwright.viewer.recorded_robot import read_robot
from linkwright.viewer.recording_config import create_recording_config
from tests.recordings import needs_rosbags

pytestmark = needs_rosbags

START_NS = 1_700_000_000_000_000_000
LaserScan = get_message("sensor_msgs/msg/LaserScan")
TransformStamped = get_message("geometry_msgs/msg/TransformStamped")


def make_transform(parent: str, child: str) -> bytes:
    message = TransformStamped(child_frame_id=child)
    message.header.frame_id = parent
    return serialize(TFMessage(transforms=[message]))


@pytest.mark.parametrize("described", [True, False])
def test_transforms_are_displayed_without_robot(tmp_path: Path, described: bool) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        writer.add_topic("/scan", "sensor_msgs/msg/LaserScan", [SENSOR_DATA_QOS])
        writer.write("/tf", START_NS, make_transform("odom", "base_link"))
        writer.write("/scan", START_NS + 1, serialize(LaserScan()))
        if described:
            writer.add_topic("/robot_description", "std_msgs/msg/String", [DESCRIPTION_QOS])
            writer.write("/robot_description", START_NS, serialize(String(data="<robot name='r'/>")))
    with BagReader(tmp_path / "bag") as bag:
        config = create_recording_config(bag)
    shown = {display.cls.rpartition("/")[2]: display.checked for display in config.displays}
    robot = {"RobotModel": True} if described else {}
    assert shown == {"Grid": True, **robot, "TF": not described, "LaserScan": True}
    assert config.options.text("Fixed Frame") == "odom"
    (scan,) = [display for display in config.displays if display.cls.endswith("LaserScan")]
    assert scan.section.text("Topic", "Reliability Policy") == "Best Effort"


def test_recorded_simulation_opens_with_its_world(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        for name, message in (
            ("/tf", make_transform("odom", "base_link")),
            ("/world_poses", make_transform("world", "mbot::base_link")),
        ):
            writer.add_topic(name, "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
            writer.write(name, START_NS, message)
        for name in ("/scan", "/world_rays", "/world_rays/others"):
            writer.add_topic(name, "sensor_msgs/msg/LaserScan", [SENSOR_DATA_QOS])
            writer.write(name, START_NS, serialize(LaserScan()))
        for name in ("/robot_description", "/world_description"):
            writer.add_topic(name, "std_msgs/msg/String", [DESCRIPTION_QOS])
            writer.write(name, START_NS, serialize(String(data="")))
    with BagReader(tmp_path / "bag") as bag:
        config = create_recording_config(bag)
    shown = {display.name: display.checked for display in config.displays}
    assert shown == {"Grid": True, "RobotModel": False, "TF": False, "World": True, "scan": True}
    assert config.options.text("Fixed Frame") == "world"
    assert config.views.current.values["Target Frame"] == "<Fixed Frame>", "the camera does not follow the robot"


def test_scan_without_transforms_uses_its_own_fixed_frame(tmp_path: Path) -> None:
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/scan", "sensor_msgs/msg/LaserScan", [SENSOR_DATA_QOS])
        scan = LaserScan()
        scan.header.frame_id = "laser_frame"
        writer.write("/scan", START_NS, serialize(scan))
    with BagReader(tmp_path / "bag") as bag:
        assert create_recording_config(bag).options.text("Fixed Frame") == "laser_frame"


@pytest.mark.parametrize("storage", STORAGES)
def test_fixed_frame_is_found_in_late_transforms(tmp_path: Path, storage: str) -> None:
    """The robot's frames appear after five seconds, and the map's frame appears even later."""
    second = 1_000_000_000
    with BagWriter(tmp_path / "bag", storage) as writer:
        for name in ("/tf", "/tf_static"):
            writer.add_topic(name, "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        writer.write("/tf_static", START_NS, make_transform("base_link", "laser"))
        for tenth in range(50, 400):
            writer.write("/tf", START_NS + tenth * second // 10, make_transform("odom", "base_link"))
            if tenth > 150:
                writer.write("/tf", START_NS + tenth * second // 10, make_transform("map", "odom"))
    with BagReader(tmp_path / "bag") as bag:
        assert create_recording_config(bag).options.text("Fixed Frame") == "map"


def test_first_namespaced_robot_with_description_is_shown(tmp_path: Path) -> None:
    """The first robot with a description is shown.

    The robots' frames have the same names, so the other robots' data is shown at wrong poses.
    """
    with BagWriter(tmp_path / "bag") as writer:
        for number in range(3):
            writer.add_topic(f"/robot{number}/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
            writer.add_topic(f"/robot{number}/scan", "sensor_msgs/msg/LaserScan", [SENSOR_DATA_QOS])
            writer.write(f"/robot{number}/tf", START_NS, make_transform("odom", "base_link"))
            writer.write(f"/robot{number}/scan", START_NS, serialize(LaserScan()))
            if number:
                writer.add_topic(f"/robot{number}/robot_description", "std_msgs/msg/String", [DESCRIPTION_QOS])
                writer.write(f"/robot{number}/robot_description", START_NS, serialize(String(data="<robot name='r'/>")))
    with BagReader(tmp_path / "bag") as bag:
        config = create_recording_config(bag)
    assert config.options.text("Fixed Frame") == "odom"
    assert {display.name: display.checked for display in config.displays} == {
        "Grid": True,
        "RobotModel": True,
        "TF": False,
        "robot0/scan": False,
        "robot1/scan": True,
        "robot2/scan": False,
    }
    (robot,) = [display for display in config.displays if display.name == "RobotModel"]
    assert robot.section.text("Description Topic", "Value") == "/robot1/robot_description"


@pytest.mark.parametrize("place", ["odom", "world"])
def test_view_follows_moving_robot_and_fits_unmoving_robot(tmp_path: Path, place: str) -> None:
    text = (
        "<robot name='r'><link name='base'><visual><geometry><sphere radius='0.1'/></geometry></visual></link></robot>"
    )
    with BagWriter(tmp_path / "bag") as writer:
        writer.add_topic("/tf", "tf2_msgs/msg/TFMessage", [DEFAULT_QOS])
        writer.write("/tf", START_NS, make_transform(place, "base"))
        writer.add_topic("/robot_description", "std_msgs/msg/String", [DESCRIPTION_QOS])
        writer.write("/robot_description", START_NS, serialize(String(data=text)))
    with BagReader(tmp_path / "bag") as bag:
        config = create_recording_config(bag, read_robot(bag, DescriptionLibrary()))
    drives = place == "odom"
    view = config.views.current.values
    assert (view["Target Frame"], view["Distance"]) == (("base", 5.0) if drives else ("<Fixed Frame>", 3.0))
    assert config.shows_whole_robot is not drives
    assert bool(config.take_sizes(0.2)) is not drives
