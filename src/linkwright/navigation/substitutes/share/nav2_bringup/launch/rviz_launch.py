# SPDX-License-Identifier: Apache-2.0
"""Launch RViz with a view for navigation.

The arguments are those of nav2_bringup's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, OpaqueFunction, Shutdown
from launch_ros.actions import Node
from nav2_common.launch import ReplaceString

from launch import LaunchDescription
from linkwright.navigation.substitutes.servers import is_true

ARGUMENTS = {
    "namespace": ("navigation", "The replacement for <robot_namespace> in the configuration"),
    "use_namespace": ("false", "Whether RViz is in the namespace"),
    "use_sim_time": ("false", "Whether to use simulated time"),
}
NAMES = ("tf", "tf_static", "goal_pose", "clicked_point", "initialpose")


def start(context):
    """Return the actions that run RViz, and shut the launch down when RViz exits."""
    arguments = context.launch_configurations
    config, namespace, remappings = arguments["rviz_config"], "", []
    if is_true(context, "use_namespace"):
        namespace = arguments["namespace"]
        config = ReplaceString(config, {"<robot_namespace>": f"/{namespace.strip('/')}"}).perform(context)
        remappings = [(f"/{name}", name) for name in NAMES]
    return [
        Node(
            package="rviz2",
            executable="rviz2",
            namespace=namespace,
            arguments=["-d", config],
            parameters=[{"use_sim_time": is_true(context, "use_sim_time")}],
            remappings=remappings,
            output="screen",
            on_exit=[Shutdown(reason="rviz exited")],
        )
    ]


def generate_launch_description():
    """Return a launch description with the arguments and the actions of `start`."""
    view = get_package_share_path("nav2_bringup") / "rviz" / "nav2_default_view.rviz"
    declared = {**ARGUMENTS, "rviz_config": (str(view), "The path of the RViz configuration")}
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in declared.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
