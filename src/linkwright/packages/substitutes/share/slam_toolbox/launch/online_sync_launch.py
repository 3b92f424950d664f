# SPDX-License-Identifier: Apache-2.0
"""A map made of all scans, with the arguments of slam_toolbox's file of this name."""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "use_sim_time": ("true", "Whether time is that of the simulation"),
    "autostart": ("true", "Whether it is activated at once"),
    "use_lifecycle_manager": ("false", "Whether a lifecycle manager activates it"),
}


def generate_launch_description():
    """Return the arguments and the node."""
    file = get_package_share_path("slam_toolbox") / "config" / "mapper_params_online_sync.yaml"
    declared = {**ARGUMENTS, "slam_params_file": (str(file), "Parameters: path")}
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in declared.items()
            ),
            Node(
                package="slam_toolbox",
                executable="sync_slam_toolbox_node",
                name="slam_toolbox",
                output="screen",
                parameters=[
                    LaunchConfiguration("slam_params_file"),
                    {
                        "use_sim_time": LaunchConfiguration("use_sim_time"),
                        "use_lifecycle_manager": LaunchConfiguration("use_lifecycle_manager"),
                        "autostart_node": AndSubstitution(
                            LaunchConfiguration("autostart"),
                            NotSubstitution(LaunchConfiguration("use_lifecycle_manager")),
                        ),
                    },
                ],
            ),
        ]
    )
