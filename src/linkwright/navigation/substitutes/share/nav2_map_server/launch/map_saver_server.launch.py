# SPDX-License-Identifier: Apache-2.0
"""Launch the map saver server and its lifecycle manager, as nav2_map_server does."""

from launch_ros.actions import Node

from launch import LaunchDescription


def generate_launch_description():
    """Return a launch description with the map saver and its manager."""
    return LaunchDescription(
        [
            Node(
                package="nav2_map_server",
                executable="map_saver_server",
                output="screen",
                parameters=[
                    {"save_map_timeout": 2.0, "free_thresh_default": 0.25, "occupied_thresh_default": 0.65},
                ],
            ),
            Node(
                package="nav2_lifecycle_manager",
                executable="lifecycle_manager",
                name="lifecycle_manager",
                output="screen",
                parameters=[{"use_sim_time": True, "autostart": True, "node_names": ["map_saver"]}],
            ),
        ]
    )
