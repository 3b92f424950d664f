# SPDX-License-Identifier: Apache-2.0
"""Load mbot with a camera into a world of Gazebo Classic, and show its pictures in RViz."""

from ament_index_python.packages import get_package_share_path
from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource


def generate_launch_description():
    """Return the launch of mbot with a camera; its other arguments can be given here, too."""
    package = get_package_share_path('my_robot_gazebo')

    return LaunchDescription([
        IncludeLaunchDescription(
            PythonLaunchDescriptionSource(str(package / 'launch' / 'load_mbot_into_gazebo.launch.py')),
            launch_arguments={
                'camera': 'true',
                'rvizconfig': str(package / 'rviz' / 'mbot_camera.rviz'),
            }.items(),
        ),
    ])
