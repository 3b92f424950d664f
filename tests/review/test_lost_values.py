"""Values of launch files that are lost only for callers that pass an argument, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import subject

FILE = """<launch>
  <arg name="robot" default=""/>
  <arg name="prefix" value="" if="$(eval robot == '')"/>
  <arg name="prefix" value="$(arg robot)/" unless="$(eval robot == '')"/>
  <node pkg="tf" type="static_transform_publisher" name="eye_frame"
        args="0 0 0 0 0 0 $(arg robot)/base $(arg robot)/eye 10"/>
  <node pkg="robot_state_publisher" type="robot_state_publisher" name="state">
    <param name="tf_prefix" value="$(arg robot)"/>
  </node>
  <node pkg="eye" type="eye" name="eye"><param name="frame" value="$(arg prefix)eye"/></node>
  <param name="tf_prefix" value="$(arg robot)"/>
</launch>
"""
PREFIX = """  <arg name="prefix" value="$(arg robot)/" unless="$(eval robot == '')"/>\n"""
NODE_PARAMETER = '<param name="tf_prefix" value="$(arg robot)"/>\n  </node>'
FRAMES = "for callers that pass 'robot', programs do not find the frames by their old names"


@pytest.mark.parametrize(
    ("old", "new", "reasons"),
    [
        ("$(arg robot)/base $(arg robot)/eye 10", "base eye 10", {FRAMES}),
        ("$(arg robot)/base $(arg robot)/eye 10", "base $(arg robot)/eye 10", set()),
        (NODE_PARAMETER, "</node>", {FRAMES}),
        ('  <param name="tf_prefix" value="$(arg robot)"/>\n</launch>', "</launch>", {FRAMES}),
        (PREFIX, "", {"the launch file uses 'prefix' and fails unless $(eval robot == '')"}),
        (PREFIX, PREFIX.replace('unless="$(eval', 'if="$(eval not'), set()),
    ],
)
def test_a_value_that_callers_lose(repository, compare, old, new, reasons):
    assert old in FILE
    repository.commit({"lamp/launch/lamp.launch": FILE})
    repository.write({"lamp/launch/lamp.launch": FILE.replace(old, new)})
    changes = subject(compare(repository), "lamp/launch/lamp.launch").changes
    assert {str(change.reason) for change in changes if change.reason is not None} == reasons


NAMESPACE_FILE = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node, PushRosNamespace


def generate_launch_description():
    namespace = LaunchConfiguration('namespace')
    return LaunchDescription([
        DeclareLaunchArgument('namespace', default_value=''),
        DeclareLaunchArgument('use_namespace', default_value='DEFAULT'),
        GroupAction([
            PushRosNamespace(condition=IfCondition(LaunchConfiguration('use_namespace')), namespace=namespace),
            Node(package='lamp', executable='lamp'),
        ]),
    ])
"""


@pytest.mark.parametrize(
    ("default", "reasons"),
    [
        ("false", ["callers that pass 'namespace' find the node, its topics and its services in a namespace"]),
        ("true", []),
    ],
)
def test_a_namespace_that_callers_had_to_switch_on(repository, compare, default, reasons):
    path = "lamp/launch/lamp.launch.py"
    old = NAMESPACE_FILE.replace("DEFAULT", default)
    repository.commit({path: old})
    repository.write({path: old.replace("condition=IfCondition(LaunchConfiguration('use_namespace')), ", "")})
    changes = subject(compare(repository), path).changes
    found = [str(change.reason) for change in changes if change.reason is not None and "node" in str(change.sentence)]
    assert found == reasons
