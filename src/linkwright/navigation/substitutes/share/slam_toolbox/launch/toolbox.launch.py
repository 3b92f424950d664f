# SPDX-License-Identifier: Apache-2.0
"""Launch the slam_toolbox node that the including launch file names.

The parameters come from the file in the argument ``slam_params_file``.
"""

from launch.actions import DeclareLaunchArgument
from launch.substitutions import AndSubstitution, LaunchConfiguration, NotSubstitution
from launch_ros.actions import Node

from launch import LaunchDescription

ARGUMENTS = {
    "use_sim_time": ("true", "Whether to use simulated time"),
    "autostart": ("true", "Whether the node activates itself at the start"),
    "use_lifecycle_manager": ("false", "Whether a lifecycle manager activates the node"),
}


def generate_launch_description():
    """Return a launch description with the arguments and the node."""
    managed = LaunchConfiguration("use_lifecycle_manager")
    return LaunchDescription(
        [
            DeclareLaunchArgument("executable", description="The slam_toolbox node to start"),
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in ARGUMENTS.items()
            ),
            Node(
                package="slam_toolbox",
                executable=LaunchConfiguration("executable"),
                name="slam_toolbox",
                output="screen",
                parameters=[
                    LaunchConfiguration("slam_params_file"),
                    {
                        "use_sim_time": LaunchConfiguration("use_sim_time"),
                        "use_lifecycle_manager": managed,
                        "autostart_node": AndSubstitution(LaunchConfiguration("autostart"), NotSubstitution(managed)),
                    },
                ],
            ),
        ]
    )
