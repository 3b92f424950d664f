# SPDX-License-Identifier: Apache-2.0
"""mbot follows a thing that its camera sees: thing:=ball, or another class that the detector knows."""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    """Return what detect.launch.py starts, and the node that drives; its arguments can be given here, too."""
    vision = get_package_share_path('my_robot_vision')

    return LaunchDescription([
        DeclareLaunchArgument('thing', default_value='ball', description='The class of what it follows'),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(str(vision / 'launch' / 'detect.launch.py'))),
        Node(
            package='my_robot_vision',
            executable='follow_object',
            output='screen',
            parameters=[{'thing': LaunchConfiguration('thing'), 'use_sim_time': True}],
        ),
    ])
