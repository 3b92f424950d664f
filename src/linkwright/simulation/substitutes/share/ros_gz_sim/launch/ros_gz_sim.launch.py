# SPDX-License-Identifier: Apache-2.0
"""Launch the simulation and a bridge.

The arguments are those of the ros_gz_sim file of this name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

from launch import LaunchDescription

FILES = {"ros_gz_sim": "gz_server.launch.py", "ros_gz_bridge": "ros_gz_bridge.launch.py"}


def generate_launch_description():
    """Return a launch description that includes the launch files of the server and the bridge."""
    paths = [get_package_share_path(package) / "launch" / name for package, name in FILES.items()]
    return LaunchDescription([IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path))) for path in paths])
