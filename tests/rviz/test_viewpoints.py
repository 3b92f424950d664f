"""The initial viewpoint of a page for a world."""

from __future__ import annotations

import math

import pytest

from linkwright.rviz.viewpoints import find_camera, find_robots
from linkwright.sdf.reader import read
from linkwright.sdf.text import parse_as_gazebo

JOINT = "<joint name='{0}' type='revolute'><parent>a</parent><child>{0}</child><axis><xyz>0 0 1</xyz></axis></joint>"
TURNING = "<link name='a'/><link name='b'/><link name='c'/>" + JOINT.format("b")


def read_world(inside: str):
    document, _ = parse_as_gazebo(f"<sdf version='1.6'><world name='w'>{inside}</world></sdf>", "w")
    sdf = read(document).sdf
    assert sdf is not None
    return sdf.worlds[0]


@pytest.mark.parametrize(
    "gui",
    [
        "<camera name='user'><pose frame=''>1 2 3 0 0 1.5708</pose></camera>",
        "<plugin filename='MinimalScene' name='3D View'><camera_pose>1 2 3 0 0 1.5708</camera_pose></plugin>",
    ],
)
def test_gui_camera_pose_is_read_like_gazebo(gui):
    half = math.sqrt(0.5)
    assert find_camera(read_world(f"<gui>{gui}</gui>")) == pytest.approx([1, 2, 3, 0, 0, half, half], abs=1e-5)


@pytest.mark.parametrize("pose", ["", "1 2 3", "1 2 3 0 0 x", "1 2 3 0 0 inf"])
def test_invalid_camera_pose_is_none(pose):
    assert find_camera(read_world(f"<gui><camera name='user'><pose>{pose}</pose></camera></gui>")) is None
    assert find_camera(read_world("")) is None


@pytest.mark.parametrize(
    ("inside", "is_robot"),
    [
        ("<link name='a'/>", False),
        (TURNING, False),  # a door, for instance
        (TURNING + JOINT.format("c"), True),
        ("<link name='a'/><plugin name='p' filename='libdrive.so'/>", True),
        ("<link name='a'><sensor name='s' type='imu'/></link>", True),
        ("<static>true</static><link name='a'><sensor name='s' type='imu'/></link>", False),
        ("<model name='n'><link name='a'/><plugin name='p' filename='libdrive.so'/></model>", True),
    ],
)
def test_robots_of_world_are_movable_models_with_plugins_sensors_or_joints(inside, is_robot):
    assert find_robots(read_world(f"<model name='m'>{inside}</model>")) == (["m"] if is_robot else [])
