"""Stands in for ``moveit_configs_utils.launches``, with what it imports itself: launch files take it from there."""

from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

from launch import LaunchDescription
from linkwright.launch.moveit import (
    DeclareBooleanLaunchArg,
    add_debuggable_node,
    generate_demo_launch,
    generate_move_group_launch,
    generate_moveit_rviz_launch,
    generate_rsp_launch,
    generate_setup_assistant_launch,
    generate_spawn_controllers_launch,
    generate_static_virtual_joint_tfs_launch,
    generate_warehouse_db_launch,
)

__all__ = [
    "DeclareBooleanLaunchArg",
    "DeclareLaunchArgument",
    "IfCondition",
    "IncludeLaunchDescription",
    "LaunchConfiguration",
    "LaunchDescription",
    "Node",
    "ParameterValue",
    "PythonLaunchDescriptionSource",
    "add_debuggable_node",
    "generate_demo_launch",
    "generate_move_group_launch",
    "generate_moveit_rviz_launch",
    "generate_rsp_launch",
    "generate_setup_assistant_launch",
    "generate_spawn_controllers_launch",
    "generate_static_virtual_joint_tfs_launch",
    "generate_warehouse_db_launch",
]
