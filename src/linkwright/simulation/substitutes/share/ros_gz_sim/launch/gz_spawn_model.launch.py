# SPDX-License-Identifier: Apache-2.0
"""Spawn a model in the world, with the arguments of the ros_gz_sim file of this name."""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "world": ("", "The world's name"),
    "file": ("", "The path or address of the model file"),
    "model_string": ("", "The text of the model"),
    "topic": ("", "The topic on which the model is published"),
    "entity_name": ("", "The model's name"),
    "allow_renaming": ("False", "Whether to choose another name if it is taken"),
    "x": ("0.0", "The x coordinate of the model, in m"),
    "y": ("0.0", "The y coordinate of the model, in m"),
    "z": ("0.0", "The z coordinate of the model, in m"),
    "roll": ("0.0", "The roll angle of the model, in rad"),
    "pitch": ("0.0", "The pitch angle of the model, in rad"),
    "yaw": ("0.0", "The yaw angle of the model, in rad"),
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
