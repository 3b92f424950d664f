"""The launch files of a MoveIt configuration package."""

from __future__ import annotations

import json

from linkwright.planning.setup.gazebo import GazeboSettings
from linkwright.planning.setup.settings import PackageSettings
from linkwright.planning.setup.xacro_files import GAZEBO, HARDWARE_ARGUMENT

_ASSISTANT_FILES = (
    "demo",
    "move_group",
    "moveit_rviz",
    "rsp",
    "setup_assistant",
    "spawn_controllers",
    "static_virtual_joint_tfs",
    "warehouse_db",
)
"""The launch files that MoveIt's Setup Assistant writes."""

_LAUNCH_FILE = """\
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_{launch}_launch


def generate_launch_description():
    moveit_config = MoveItConfigsBuilder({robot}, package_name={package}).to_moveit_configs()
    return generate_{launch}_launch(moveit_config)
"""
_GAZEBO_FILE = '''\
"""Start the robot in Gazebo with its controllers, move_group and RViz."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node, SetParameter
from launch_ros.substitutions import FindPackageShare
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import (
    generate_move_group_launch,
    generate_moveit_rviz_launch,
    generate_rsp_launch,
    generate_spawn_controllers_launch,
)


def generate_launch_description():
    moveit_config = (
        MoveItConfigsBuilder({robot}, package_name={package})
        .robot_description(mappings={mappings})
        .to_moveit_configs()
    )
{simulator}
    return LaunchDescription(
        [
            *arguments,
            SetParameter("use_sim_time", True),
            simulator,
            *nodes,
            generate_rsp_launch(moveit_config),
            generate_spawn_controllers_launch(moveit_config),
            generate_move_group_launch(moveit_config),
            GroupAction(
                [generate_moveit_rviz_launch(moveit_config)],
                condition=IfCondition(LaunchConfiguration("use_rviz")),
            ),
        ]
    )
'''
_GZ = """\
    arguments = [
        DeclareLaunchArgument("world", default_value="empty.sdf", description="The world, an SDF file"),
        DeclareLaunchArgument("gz_options", default_value="", description="More options of gz sim, -s for no window"),
        DeclareLaunchArgument("use_rviz", default_value="true", description="Whether to start RViz"),
    ]
    simulator = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("ros_gz_sim"), "launch", "gz_sim.launch.py"])
        ),
        launch_arguments={{
            "gz_args": ["-r ", LaunchConfiguration("gz_options"), " ", LaunchConfiguration("world")],
            "on_exit_shutdown": "true",
        }}.items(),
    )
    nodes = [
        # Put the robot into the world.
        Node(
            package="ros_gz_sim",
            executable="create",
            arguments=["-topic", "robot_description", "-name", {robot}],
            output="screen",
        ),
        # Publish the time of the simulation.
        Node(
            package="ros_gz_bridge",
            executable="parameter_bridge",
            arguments=["/clock@rosgraph_msgs/msg/Clock[gz.msgs.Clock"],
            output="screen",
        ),
    ]
"""
_CLASSIC = """\
    arguments = [
        DeclareLaunchArgument("world", default_value="", description="The world, an SDF file"),
        DeclareLaunchArgument("gui", default_value="true", description="Whether to open the window of Gazebo"),
        DeclareLaunchArgument("use_rviz", default_value="true", description="Whether to start RViz"),
    ]
    simulator = IncludeLaunchDescription(
        PythonLaunchDescriptionSource(
            PathJoinSubstitution([FindPackageShare("gazebo_ros"), "launch", "gazebo.launch.py"])
        ),
        launch_arguments={{
            "world": LaunchConfiguration("world"),
            "gui": LaunchConfiguration("gui"),
        }}.items(),
    )
    nodes = [
        # Put the robot into the world.
        Node(
            package="gazebo_ros",
            executable="spawn_entity.py",
            arguments=["-topic", "robot_description", "-entity", {robot}],
            output="screen",
        ),
    ]
"""


def launch_files(settings: PackageSettings) -> dict[str, str]:
    """Return the texts of the launch files by name, without ``.launch.py``."""
    robot, package = json.dumps(settings.file_name), json.dumps(settings.name)
    files = {
        launch: _LAUNCH_FILE.format(launch=launch, robot=robot, package=package)
        for launch in _ASSISTANT_FILES
        if launch != "static_virtual_joint_tfs" or settings.virtual_joint is not None
    }
    simulator = _CLASSIC if settings.gazebo.simulator.is_classic else _GZ
    files["demo_gazebo"] = _GAZEBO_FILE.format(
        robot=robot,
        package=package,
        mappings=json.dumps({HARDWARE_ARGUMENT: GAZEBO}),
        simulator=simulator.format(robot=robot),
    )
    return files


def gazebo_packages(gazebo: GazeboSettings) -> tuple[str, ...]:
    """Return the packages that the launch file for Gazebo needs."""
    rest = ("gazebo_ros",) if gazebo.simulator.is_classic else ("ros_gz_bridge", "ros_gz_sim")
    return (gazebo.simulator.package, *rest)
