"""The lines of a review about models that leave a world, and about the plugins that a world loses."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

WORLD = "arm_gazebo/worlds/pool.world"
LAUNCH = "arm_gazebo/launch/pool.launch"
START = """<launch>
  <arg name="box" default="true"/>
  <arg name="world" default="$(find arm_gazebo)/worlds/pool.world"/>
  {}
</launch>"""
SPAWN = """<node if="$(arg box)" name="spawn" pkg="gazebo_ros" type="spawn_model"
  args="-sdf -file a.sdf -model {} -x 1 -z {}"/>"""
BOX = '<model name="box"><pose>1 0 2 0 0 0</pose><link name="body"/></model>'
STATE = '<state world_name="w"><model name="box"><pose>1 0 2 0 0 0</pose></model></state>'
PYTHON = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    world = "$(find-pkg-share arm_gazebo)/worlds/pool.world"
    return LaunchDescription([
        Node(package="{}", executable="{}", arguments=["{}", "box", "-x", "1", "-z", "2"]),
    ])
"""


def make_world(contents: str) -> str:
    return f'<sdf version="1.6"><world name="w">{contents}</world></sdf>'


def test_a_model_that_the_launch_file_of_the_world_spawns_has_moved(package, compare):
    package.commit({WORLD: make_world(BOX + STATE), LAUNCH: START.format("")})
    package.write({WORLD: make_world('<state world_name="w"/>'), LAUNCH: START.format(SPAWN.format("box", 3))})
    result = compare(package)
    assert breaking(result) == []
    moved = f"world w model box moved to {LAUNCH} (if $(arg box)); pose: 1 0 2 0 0 0 -> 1 0 3 0 0 0 (moved by 1 m)"
    assert sentences(subject(result, WORLD)) == [moved]


@pytest.mark.parametrize(
    "program", [("ros_gz_sim", "create", "-name"), ("gazebo_ros", "spawn_entity.py", "-entity")], ids=" ".join
)
def test_a_model_at_the_same_pose_has_only_moved(package, compare, program):
    package.commit({WORLD: make_world(BOX)})
    package.write({WORLD: make_world(""), "arm_gazebo/launch/pool.launch.py": PYTHON.format(*program)})
    assert sentences(subject(compare(package), WORLD)) == [
        "world w model box moved to arm_gazebo/launch/pool.launch.py"
    ]


@pytest.mark.parametrize("other", [SPAWN.format("sphere", 1), ""])
def test_a_model_that_no_launch_file_or_only_one_of_two_spawns_is_missing(package, compare, other):
    package.commit(
        {WORLD: make_world(BOX + STATE), LAUNCH: START.format(""), "arm_gazebo/launch/a.launch": "<launch/>"}
    )
    spawning = START.format(SPAWN.format("box", 3)) if not other else "<launch/>"
    package.write({WORLD: make_world(""), LAUNCH: START.format(other), "arm_gazebo/launch/a.launch": spawning})
    assert [line.partition(":")[0] for line in breaking(compare(package))] == ["world w model box removed"]


@pytest.mark.parametrize(
    ("contents", "is_breaking"),
    [("<namespace>dock</namespace>", True), ("<namespace>/</namespace>", False), ("", False)],
)
def test_a_removed_plugin_with_a_namespace_is_breaking(package, compare, contents, is_breaking):
    plugin = f'<plugin name="dock" filename="libContainPlugin.so"><entity>arm</entity>{contents}</plugin>'
    package.commit({WORLD: make_world(BOX + plugin)})
    package.write({WORLD: make_world(BOX)})
    [change] = subject(compare(package), WORLD).changes
    assert (change.reason is not None) == is_breaking
    assert change.location.is_old
    if is_breaking:
        assert (
            str(change.reason) == "programs do not find the topics and services of the plugin in the namespace 'dock'"
        )
