# SPDX-License-Identifier: Apache-2.0
"""Launch a bridge, and spawn a model.

The arguments are those of the ros_gz_sim file of this name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

from launch import LaunchDescription

FILES = {"ros_gz_bridge": "ros_gz_bridge.launch.py", "ros_gz_sim": "gz_spawn_model.launch.py"}


def generate_launch_description():
    """Return a launch description that includes the launch files of the bridge and the spawner."""
    paths = [get_package_share_path(package) / "launch" / name for package, name in FILES.items()]
    return LaunchDescription([IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path))) for path in paths])
