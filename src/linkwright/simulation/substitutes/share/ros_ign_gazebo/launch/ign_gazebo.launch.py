# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation as ``ign gazebo`` does.

The arguments are those of the ros_ign_gazebo file of this name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description that includes gz_sim.launch.py with the same arguments."""
    return LaunchDescription(
        [
            DeclareLaunchArgument("ign_args", default_value="", description="The command line of ign gazebo"),
            DeclareLaunchArgument("ign_version", default_value="", description="Not used"),
            IncludeLaunchDescription(
                PythonLaunchDescriptionSource(str(get_package_share_path("ros_gz_sim") / "launch" / "gz_sim.launch.py"))
            ),
        ]
    )
