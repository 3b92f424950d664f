# SPDX-License-Identifier: Apache-2.0
"""Spawns a model in the world, with the arguments of the ros_gz_sim file of this name."""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "world": ("", "The world's name"),
    "file": ("", "The model: path of a file, or an address"),
    "model_string": ("", "The model as text"),
    "topic": ("", "The topic that the model is published on"),
    "entity_name": ("", "The model's name"),
    "allow_renaming": ("False", "Whether to choose another name if it is taken"),
    "x": ("0.0", "m"),
    "y": ("0.0", "m"),
    "z": ("0.0", "m"),
    "roll": ("0.0", "rad"),
    "pitch": ("0.0", "rad"),
    "yaw": ("0.0", "rad"),
}
PARAMETERS = {"model_string": "string", "entity_name": "name", "roll": "R", "pitch": "P", "yaw": "Y"}
"""The launch arguments whose node parameters have other names."""


def generate_launch_description():
    """Return a launch description that declares the arguments and spawns the model."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in ARGUMENTS.items()
    ]
    parameters = {PARAMETERS.get(name, name): LaunchConfiguration(name) for name in ARGUMENTS}
    create = Node(package="ros_gz_sim", executable="create", output="screen", parameters=[parameters])
    return LaunchDescription([*arguments, create])
