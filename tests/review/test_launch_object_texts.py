"""Texts of Python launch files that contain a substitution as an object, and commands without a blank, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import Command, FindExecutable, LaunchConfiguration
from launch_ros.actions import Node


def describe(rate):
    return ["rate:=", rate]


def generate_launch_description():
    rate = LaunchConfiguration("rate")
    description = Command([FindExecutable(name="xacro"), " ", "arm.urdf", " rate:=", rate])
    return LaunchDescription([
        DeclareLaunchArgument("rate", default_value="10"),
        LogInfo(msg="start"),
        Node(package="arm", executable="driver", arguments=describe("1"), parameters=[{"description": description}]),
    ])
"""
PATH = "arm/launch/arm.launch.py"
OBJECT = "contains the object LaunchConfiguration('rate'), instead of its value"


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('" rate:=", rate', 'f" rate:={rate}"', f"`f' rate:={{rate}}'` {OBJECT}"),
        ('"1"', "f\"{LaunchConfiguration('rate')}\"", f"`f'{{LaunchConfiguration('rate')}}'` {OBJECT}"),
        ('msg="start"', 'msg=f"start {rate}"', None),
        ('["rate:=", rate]', '[f"rate:={rate}"]', None),  # the parameter of the function is a text
        (
            ' " ", "arm.urdf", ',
            ' "arm.urdf", ',
            (
                "`Command([FindExecutable(name='xacro'), 'arm.urdf', ' rate:=', rate])` "
                "has no blank after the program 'xacro'"
            ),
        ),
        (
            '[FindExecutable(name="xacro"), " ", "arm.urdf", " rate:=", rate]',
            '["xacro", rate]',
            "`Command(['xacro', rate])` has no blank after the program 'xacro'",
        ),
        ('[FindExecutable(name="xacro"), " ", ', '["xacro ", ', None),
        ('[FindExecutable(name="xacro"), " ", "arm', '[FindExecutable(name="xacro"), " arm', None),
    ],
)
def test_a_text_that_cannot_have_the_value_is_breaking(repository, compare, old, new, line):
    assert old in FILE
    repository.commit({PATH: FILE})
    repository.write({PATH: FILE.replace(old, new)})
    assert breaking(compare(repository)) == ([] if line is None else [line])


def test_an_object_in_a_text_is_no_use_of_the_argument(repository, compare):
    repository.commit({PATH: FILE})
    repository.write({PATH: FILE.replace('" rate:=", rate', 'f" rate:={rate}"')})
    lines = sentences(subject(compare(repository), PATH))
    assert not any("$(var rate) rate" in line or "depends on" in line for line in lines)
    assert any(line.endswith("-> $(command xacro arm.urdf rate:=LaunchConfiguration('rate'))") for line in lines)
