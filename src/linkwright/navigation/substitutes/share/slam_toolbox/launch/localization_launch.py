# SPDX-License-Identifier: Apache-2.0
"""Launch localization on a saved map.

The arguments are those of slam_toolbox's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description with the argument for the parameter file, and the node."""
    share = get_package_share_path("slam_toolbox")
    parameters = share / "config" / "mapper_params_localization.yaml"
    return LaunchDescription(
        [
            DeclareLaunchArgument("slam_params_file", default_value=str(parameters), description="The parameter file"),
            IncludeLaunchDescription(
                str(share / "launch" / "toolbox.launch.py"),
                launch_arguments={"executable": "localization_slam_toolbox_node"}.items(),
            ),
        ]
    )
