# SPDX-License-Identifier: Apache-2.0
"""Launch twist_mux.

The arguments are those of twist_mux's file of the same name. That file also starts a marker for RViz and a relay for
joysticks, which Linkwright does not have; ``config_joy`` is the file of the relay's parameters and has no effect.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description with the arguments and the node."""
    config = get_package_share_path("twist_mux") / "config"
    arguments = {
        "config_locks": (str(config / "twist_mux_locks.yaml"), "The path of the file with the locks"),
        "config_topics": (str(config / "twist_mux_topics.yaml"), "The path of the file with the topics"),
        "config_joy": ("", "The path of the file for the relay of joysticks, which is not started"),
        "cmd_vel_out": ("twist_mux/cmd_vel", "The topic of the velocities that twist_mux forwards"),
        "use_sim_time": ("False", "Whether to use simulated time"),
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=description)
                for name, (default, description) in arguments.items()
            ),
            Node(
                package="twist_mux",
                executable="twist_mux",
                output="screen",
                remappings=[("/cmd_vel_out", LaunchConfiguration("cmd_vel_out"))],
                parameters=[
                    {"use_sim_time": LaunchConfiguration("use_sim_time")},
                    LaunchConfiguration("config_locks"),
                    LaunchConfiguration("config_topics"),
                ],
            ),
        ]
    )
