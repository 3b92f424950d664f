"""Changes in a review of launch files that bridge topics of Gazebo, read variables or fix values."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/launch/arm.launch.py"
LAUNCH = """import os
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=["/clock@a/msg/B[gz.B"]),
        {}
    ])
"""
BRIDGE = """Node(package="ros_gz_bridge", executable="parameter_bridge", arguments=["{}@a/msg/B{}gz.B"],
             remappings=[("/gz/imu", "/imu")])"""


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        (BRIDGE.format("/gz/imu", "["), "", "programs that use the name '/imu' do not find it"),
        (BRIDGE.format("/gz/imu", "["), BRIDGE.format("/imu", "["), None),
        (BRIDGE.format("/gz/imu", "["), 'Node(package="arm", executable="imu", remappings=[("a", "imu")])', None),
        (BRIDGE.format("/tf", "["), "", "the transforms of the simulator are no longer on '/tf'"),
        (BRIDGE.format("/clock", "["), "", None),
    ],
)
def test_a_removed_bridge_is_breaking_if_nothing_else_has_its_topic(repository, compare, old, new, reason):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: LAUNCH.replace("{}", old)})
    repository.write({PATH: LAUNCH.replace("{}", new)})
    changes = subject(compare(repository), PATH).changes
    assert [str(change.reason) for change in changes if change.reason is not None] == ([reason] if reason else [])


@pytest.mark.parametrize(
    ("old", "new", "other", "reason"),
    [
        ('"/scan@a/msg/B[gz.B", "/imu@a/msg/B@gz.B"', '"/scan@a/msg/B[gz.B"', "", "'/imu'"),
        ('"/scan@a/msg/B[gz.B", "/cmd@a/msg/B]gz.B"', '"/scan@a/msg/B[gz.B"', "", None),
        ('"/scan@a/msg/B[gz.B"', '"/scan@a/msg/B[ignition.B"', "", None),
        ('"/scan@a/msg/B[gz.B"', "*os.listdir()", "", None),
        ('"/scan@a/msg/B[gz.B"', "", 'Node(package="arm", executable="scan", remappings=[("a", "scan")])', None),
    ],
)
def test_a_topic_that_a_bridge_loses_from_its_arguments(repository, compare, old, new, other, reason):
    bridge = 'Node(package="ros_gz_bridge", executable="parameter_bridge", name="b", arguments=[{}]),'
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: LAUNCH.replace("{}", bridge.format(old) + other)})
    repository.write({PATH: LAUNCH.replace("{}", bridge.format(new) + other)})
    changes = subject(compare(repository), PATH).changes
    reasons = [str(change.reason) for change in changes if change.reason is not None]
    assert [text for text in reasons if reason is None or reason not in text] == []
    assert len(reasons) == (reason is not None)


def test_a_variable_that_only_other_programs_still_read_is_ignored_by_the_launch_file(repository, compare):
    reading = 'Node(package="arm", executable="arm", name=os.environ["ARM_NAME"])'
    program = "import os\nprint(os.environ['ARM_NAME'])\n"
    repository.commit({"arm/package.xml": PACKAGE_XML, "arm/arm/keys.py": program, PATH: LAUNCH.replace("{}", reading)})
    repository.write({PATH: LAUNCH.replace("{}", reading.replace('os.environ["ARM_NAME"]', '"arm"'))})
    changes = subject(compare(repository), PATH).changes
    (reason,) = [str(each.reason) for each in changes if str(each.sentence).endswith("arm/arm/keys.py uses it")]
    assert reason == "the launch file ignores the value of 'ARM_NAME'"


FIXED = """<launch>
<arg name="sim" default="true"/>
<arg name="x" {}="1.0" {}/>
<arg name="y" {}="2.0"/>
<node pkg="arm" type="arm" name="arm" args="$(arg x) $(arg y)"/>
</launch>
"""


@pytest.mark.parametrize(
    ("kinds", "names"),
    [
        (("value", "", "value"), "'x', 'y'"),
        (("value", 'if="$(arg sim)"', "default"), "'x'"),
        (("value", 'unless="$(arg sim)"', "default"), None),
        (("default", "", "default"), None),
    ],
)
def test_an_argument_with_a_fixed_value_refuses_the_values_of_callers(repository, compare, kinds, names):
    path = "arm/launch/arm.launch"
    repository.commit({"arm/package.xml": PACKAGE_XML, path: FIXED.format("default", "", "default")})
    repository.write({path: FIXED.format(*kinds), "arm/README.md": "x"})
    result = compare(repository)
    found = [text for each in result.subjects if each.path == path for text in sentences(each)]
    text = f"arguments with a fixed value now, instead of a default: {names}"
    assert breaking(result) == ([text] if names else [])
    assert not any("1.0" in sentence for sentence in found)


def test_a_default_instead_of_a_fixed_value_is_one_line(repository, compare):
    path, told = "arm/launch/arm.launch", "a default now instead of a fixed value, so that callers can set it"
    fixed = FIXED.format("value", "", "value")
    repository.commit({"arm/package.xml": PACKAGE_XML, path: fixed})
    repository.write({path: FIXED.format("default", "", "default")})
    assert sentences(subject(compare(repository), path)) == [f"argument 'x', argument 'y': {told}"]
    repository.write({path: FIXED.format("default", "", "value").replace("1.0", "2.0", 1)})
    found = sentences(subject(compare(repository), path))
    assert f"argument 'x': {told}" in found
    assert "argument 'x': default 1.0 -> 2.0" in found
    assert breaking(compare(repository)) == []


def test_an_unknown_file_does_not_declare_an_argument_with_a_default_in_the_file(repository, compare):
    new = """IncludeLaunchDescription("$(find-pkg-share other)/a.launch.py"),
        Node(package="arm", executable="arm", condition=IfCondition(LaunchConfiguration("dock"))),"""
    start = "def generate_launch_description():\n"
    default = f'{start}    dock = LaunchConfiguration("dock", default="false")\n'
    for text, is_breaking in ((LAUNCH, False), (LAUNCH.replace(start, default), True)):
        repository.commit({"arm/package.xml": PACKAGE_XML, PATH: LAUNCH.replace("{}", "")})
        repository.write({PATH: text.replace("{}", new)})
        found = breaking(compare(repository))
        assert ("node 'arm/arm' uses argument 'dock', which is not declared" in found) is is_breaking
