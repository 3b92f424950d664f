# SPDX-License-Identifier: Apache-2.0
"""Load mbot into an empty world and drive a square."""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return the simulation of mbot and the node that drives it; arguments of the simulation can be given here, too."""
    gazebo = get_package_share_path('my_robot_gazebo')
    control = get_package_share_path('my_robot_control')

    return LaunchDescription([
        DeclareLaunchArgument(
            'world',
            default_value=str(gazebo / 'worlds' / 'empty.world'),
            description='The world to load: path of a .world file',
        ),
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(gazebo / 'launch' / 'load_mbot_into_gazebo.launch.py')),
            launch_arguments={'world': LaunchConfiguration('world')}.items(),
        ),
        Node(
            package='my_robot_control',
            executable='drive_square',
            output='screen',
            parameters=[str(control / 'config' / 'control.yaml'), {'use_sim_time': True}],
        ),
    ])
