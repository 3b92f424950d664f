# SPDX-License-Identifier: Apache-2.0
"""Remove a model from the world, with the arguments of the ros_gz_sim file of this name."""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {"world": "The world's name", "entity_name": "The model's name"}


def generate_launch_description():
    """Return a launch description that declares the arguments and removes the model."""
    arguments = [
        DeclareLaunchArgument(name, default_value="", description=description)
        for name, description in ARGUMENTS.items()
    ]
    parameters = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    remove = Node(package="ros_gz_sim", executable="remove", output="screen", parameters=[parameters])
    return LaunchDescription([*arguments, remove])
