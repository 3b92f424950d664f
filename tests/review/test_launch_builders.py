"""Objects that a launch file builds by a chain of calls, in a review."""

from __future__ import annotations

import pytest

from tests.review.conftest import sentences, subject

PATH = "arm_moveit/launch/arm.launch.py"
LAUNCH = """from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from moveit_configs_utils import MoveItConfigsBuilder


def generate_launch_description():
    mappings = {"ip": "10.0.0.2", "use_fake_hardware": "false"}
    configs = (
        MoveItConfigsBuilder("arm", package_name="arm_moveit")
        .robot_description(file_path="config/arm.urdf.xacro", mappings=mappings)
        .planning_pipelines(pipelines=["ompl"])
        .to_moveit_configs()
    )
    move_group = Node(package="moveit_ros_move_group", executable="move_group", parameters=[configs.to_dict()])
    rviz = Node(
        package="rviz2",
        executable="rviz2",
        parameters=[configs.robot_description, configs.robot_description_semantic],
    )
    return LaunchDescription([
        DeclareLaunchArgument("fake", default_value="true"),
        DeclareLaunchArgument("ip", default_value="10.0.0.2"),
        move_group,
        rviz,
    ])
"""
HARDWARE = "by default, a simulation is used instead of the hardware of the robot"


@pytest.mark.parametrize(
    ("old", "new", "expected", "reason"),
    [
        ('"10.0.0.2", "use', '"10.0.0.3", "use', "mappings ip 10.0.0.2 -> 10.0.0.3", None),
        (
            'mappings = {"ip": "10.0.0.2"',
            'mappings = {"ip": LaunchConfiguration("ip")',
            "mappings ip 10.0.0.2 -> $(var ip) (the same by default)",
            None,
        ),
        (
            'hardware": "false"',
            'hardware": LaunchConfiguration("fake")',
            "mappings use_fake_hardware false -> $(var fake) (true by default)",
            HARDWARE,
        ),
        (', "use_fake_hardware": "false"', "", "mappings use_fake_hardware false removed", None),
        ('"config/arm.urdf', '"config/arm2.urdf',
         "robot_description config/arm.urdf.xacro -> config/arm2.urdf.xacro", None),
        ('["ompl"]', '["ompl", "chomp"]', "planning_pipelines [ompl] -> [ompl, chomp]", None),
        ('("arm",', '("arm2",', "argument 1 arm -> arm2", None),
        ("        .to_moveit", "        .sensors_3d()\n        .to_moveit", "sensors_3d () added", None),
        ('="arm_moveit"', '="arm_config"', "package_name arm_moveit -> arm_config", None),
    ],
)  # fmt: skip
def test_a_change_to_a_built_object_is_one_line_for_all_its_users(repository, compare, old, new, expected, reason):
    assert LAUNCH.count(old) == 1
    repository.commit({PATH: LAUNCH})
    repository.write({PATH: LAUNCH.replace(old, new)})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.sentence) == f"'MoveItConfigsBuilder()': {expected}"
    assert (None if change.reason is None else str(change.reason)) == reason


def test_users_of_a_built_object_are_compared_without_it(repository, compare):
    repository.commit({PATH: LAUNCH})
    text = LAUNCH.replace('10.0.0.2", "use', '10.0.0.3", "use')
    repository.write({PATH: text.replace("configs.robot_description, ", "")})
    assert sorted(sentences(subject(compare(repository), PATH))) == [
        "'MoveItConfigsBuilder()': mappings ip 10.0.0.2 -> 10.0.0.3",
        (
            "node 'rviz2/rviz2': parameters [MoveItConfigsBuilder().robot_description, "
            "MoveItConfigsBuilder().robot_description_semantic] -> [MoveItConfigsBuilder().robot_description_semantic]"
        ),
    ]
