# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation and its window.

The arguments are those of the gazebo_ros file of this name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import LaunchConfiguration

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description that includes the server and the substitute for the window."""
    folder = get_package_share_path("gazebo_ros") / "launch"
    return LaunchDescription(
        [
            DeclareLaunchArgument("gui", default_value="true", description="Whether to open a window"),
            DeclareLaunchArgument("server", default_value="true", description="Whether to start a server"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(folder / "gzserver.launch.py")),
                condition=IfCondition(LaunchConfiguration("server")),
            ),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(folder / "gzclient.launch.py")),
                condition=IfCondition(LaunchConfiguration("gui")),
            ),
        ]
    )
