"""Changed static transforms in launch files, by the transforms that they publish."""

from __future__ import annotations

import pytest

from linkwright.review.launches.static_transforms import compare_transforms
from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences

ROS2 = "tf2_ros/static_transform_publisher"
ROS1 = "tf/static_transform_publisher"
POSITIONS = "[1.0, 0, 0.2, 0.1, 0, 0, base, gps]"
OPTIONS = "[--x, 1, --z, 0.2, --yaw, 0.1, --frame-id, base, --child-frame-id, gps]"
SAME = "the same transform in another notation"


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        (POSITIONS, OPTIONS, SAME),
        (POSITIONS, OPTIONS.replace("0.2", "0.3"), "z 0.2 -> 0.3"),
        (POSITIONS, OPTIONS.replace("gps]", "gnss]"), "child frame 'gps' -> 'gnss'"),
        (POSITIONS, OPTIONS.replace("base", "map"), "parent frame 'base' -> 'map'"),
        (POSITIONS, OPTIONS.replace("--yaw, 0.1", "--qz, 0.04998, --qw, 0.99875"), SAME),
        (POSITIONS, OPTIONS.replace("--yaw, 0.1", "--qz, 1, --qw, 0"), "rpy 0 0 0.1 -> 0 0 3.14159 (rotated by 174°)"),
        (POSITIONS, POSITIONS.replace("0.1", "0.2"), "yaw 0.1 -> 0.2 (rotated by 5.73°)"),
        (POSITIONS, POSITIONS.replace("1.0", "1"), SAME),
        (POSITIONS, OPTIONS.replace("x, 1", "x, $(var x)"), "x 1.0 -> $(var x)"),
        ("1 0 0.2 $(arg yaw) 0 0 base $(arg prefix)gps", "1 0 0.2 $(arg yaw) 0 0 base $(arg prefix)gps2",
         "child frame '$(arg prefix)gps' -> '$(arg prefix)gps2'"),
        ("0 0 0 3.14159265 0 0 a b", "0 0 0 0 3.14159265 3.14159265 a b", SAME),
        ("0 0 0 0 0 0 1 a b", "--frame-id a --child-frame-id b", SAME),
        ("0 0 0 0 0 0 a b", "0 0 0 0 0 0 a b --ros-args --log-level warn",
         "other arguments '' -> --ros-args --log-level warn"),
        (POSITIONS, "[0, 0, 0, base, gps]", None),
        (POSITIONS, "[--x, 1, --unknown, 2, --frame-id, base, --child-frame-id, gps]", None),
        ("0 0 0 $(arg yaw) 0 0 a b", "0 0 0 0 0 0 1 a b", None),
        ("0 0 0 0 0 0 1 a b", "0 0 0 0 0 0 0 a b", "qw 1 -> 0"),
        (POSITIONS, None, None),
    ],
)  # fmt: skip
def test_transforms_are_compared_by_their_values(old, new, expected):
    change = compare_transforms(ROS2, ROS2, old, new)
    assert (None if change is None else str(change)) == expected


def test_the_period_of_ros1_is_not_a_part_of_the_transform():
    assert str(compare_transforms(ROS1, ROS1, "0 0 1 0 0 0 a b 100", "0 0 1 0 0 0 a b 50")) == (
        "other arguments 100 -> 50"
    )
    assert str(compare_transforms(ROS1, ROS1, "0 0 1 0 0 0 a b 100", "0 0 2 0 0 0 1 a b 100")) == "z 1 -> 2"


def test_arguments_of_other_programs_are_no_transform():
    assert compare_transforms("a/b", "a/b", POSITIONS, OPTIONS) is None


NODE = """        Node(package="tf2_ros", executable="static_transform_publisher",
             arguments=[{arguments}]),
"""
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node

def generate_launch_description():
    return LaunchDescription([
{nodes}    ])
"""


def make_launch(template, transforms):
    """Return a launch file that publishes transforms, given by child frame and x."""
    nodes = (NODE.format(child=child, arguments=template.format(x=x, child=child)) for child, x in transforms.items())
    return LAUNCH.format(nodes="".join(nodes))


OLD = "'{x}', '0', '0', '0', '0', '0', 'base', '{child}'"
NEW = "'--x', '{x}', '--yaw', '0', '--frame-id', 'base', '--child-frame-id', '{child}'"


def test_transforms_in_another_notation_are_one_line_and_other_values_stand_out(repository, compare):
    repository.commit(
        {"arm/package.xml": PACKAGE_XML, "arm/launch/a.launch.py": make_launch(OLD, {"a": 1, "b": 2, "c": 3})}
    )
    repository.write({"arm/launch/a.launch.py": make_launch(NEW, {"a": 1, "b": 2.5, "c": 3})})
    result = compare(repository)
    program = "node 'tf2_ros/static_transform_publisher' of"
    assert [line for found in result.subjects for line in sentences(found)] == [
        f"{program} 'a', {program} 'c': the same transform in another notation",
        f"{program} 'b': x 2 -> 2.5",
    ]
    assert breaking(result) == []


def test_another_child_frame_is_still_breaking(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/a.launch.py": make_launch(OLD, {"a": 1})})
    repository.write({"arm/launch/a.launch.py": make_launch(NEW, {"a2": 1})})
    assert breaking(compare(repository)) == [
        "node 'tf2_ros/static_transform_publisher' of 'a2': child frame 'a' -> 'a2'"
    ]


LOGGING = ", '--ros-args', '--log-level', 'warn'"


def test_arguments_of_ros_behind_the_transform_are_no_frame(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/launch/a.launch.py": make_launch(OLD + LOGGING, {"a": 1})})
    repository.write({"arm/launch/a.launch.py": make_launch(NEW + LOGGING, {"a": 1})})
    result = compare(repository)
    assert [line for found in result.subjects for line in sentences(found)] == [
        "node 'tf2_ros/static_transform_publisher' of 'a': the same transform in another notation"
    ]
    assert breaking(result) == []


def test_the_period_of_ros_1_is_not_the_frame_of_the_publisher_of_tf2_that_replaces_it(repository, compare):
    arguments = "0 0 {} 0 0 0 map odom{}"
    node = f'<node pkg="{{}}" type="static_transform_publisher" name="map_tf" args="{arguments}"/>'
    text = f"<launch>{node}</launch>"
    repository.commit({"arm/launch/arm.launch": text.format("tf", 0, " 100")})
    replaced = f"node '{ROS1}' of 'odom' replaced by node '{ROS2}' of 'odom'"
    for z, changes in ((0, [f"node '{ROS2}' of 'odom': {SAME}"]), (1, [f"node '{ROS2}' of 'odom': z 0 -> 1"])):
        repository.write({"arm/launch/arm.launch": text.format("tf2_ros", z, "")})
        result = compare(repository)
        assert breaking(result) == []
        found = [sentence for subject in result.subjects for sentence in sentences(subject)]
        assert sorted(found) == sorted([replaced, *changes])


@pytest.mark.parametrize(
    "arguments", ["0 0 0 0 0 0 base $(var side)_laser", "--frame-id base --child-frame-id $(var side)_laser"]
)
def test_frame_with_a_variable_is_named_in_full(repository, compare, arguments):
    path = "arm/launch/a.launch.xml"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: "<launch/>"})
    node = f'<node pkg="tf2_ros" exec="static_transform_publisher" args="{arguments}"/>'
    repository.write({path: f'<launch><arg name="side" default="left"/>{node}</launch>'})
    lines = [line for found in compare(repository).subjects for line in sentences(found)]
    assert f"node 'tf2_ros/static_transform_publisher' of '$(var side)_laser' added: arguments {arguments}" in lines
