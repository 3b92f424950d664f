# SPDX-License-Identifier: Apache-2.0
"""Launch localization or mapping, and navigation.

The arguments are those of nav2_bringup's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch_ros.actions import Node, PushRosNamespace

from launch import LaunchDescription
from linkwright.navigation.substitutes.servers import ARGUMENTS, configure_parameters, is_true

HERE = get_package_share_path("nav2_bringup")
DECLARED = {
    **ARGUMENTS,
    "use_namespace": ("false", "Whether all nodes are in the namespace"),
    "use_composition": ("True", "Whether the servers are composed in a container"),
    "slam": ("False", "Whether to build a map instead of localizing in one"),
    "map": ("", "The path of the map's YAML file"),
    "use_localization": ("True", "Whether to run localization, or mapping if slam is true"),
    "params_file": (str(HERE / "params" / "nav2_params.yaml"), "The path of the parameter file"),
    "graph": ("", "Not used"),
    "keepout_mask": ("", "Not used"),
    "speed_mask": ("", "Not used"),
    "use_keepout_zones": ("False", "Not used"),
    "use_speed_zones": ("False", "Not used"),
}


def include_action(context, file, *names):
    """Return the action that includes a launch file with the named configurations."""
    arguments = context.launch_configurations
    source = PythonLaunchDescriptionSource(str(HERE / "launch" / file))
    return IncludeLaunchDescription(source, launch_arguments=[(name, arguments[name]) for name in names])


def start(context):
    """Return the actions that start the container, if one is used, and include the launch files."""
    level = context.launch_configurations["log_level"]
    container = Node(
        package="rclcpp_components",
        executable="component_container_isolated",
        name=context.launch_configurations["container_name"],
        parameters=[configure_parameters(context), {"autostart": is_true(context, "autostart")}],
        arguments=["--ros-args", "--log-level", level],
        remappings=[("/tf", "tf"), ("/tf_static", "tf_static")],
        output="screen",
    )
    shared_names = ("namespace", "use_sim_time", "autostart", "params_file", "use_respawn")
    composition_names = (*shared_names, "use_composition", "container_name")
    localization = []
    if is_true(context, "use_localization"):
        mapping = include_action(context, "slam_launch.py", *shared_names)
        localization = [
            mapping
            if is_true(context, "slam")
            else include_action(context, "localization_launch.py", "map", *composition_names)
        ]
    return [
        GroupAction(
            [
                PushRosNamespace(context.launch_configurations["namespace"]),
                *([container] if is_true(context, "use_composition") else []),
                *localization,
                include_action(context, "navigation_launch.py", *composition_names),
            ]
        )
    ]


def generate_launch_description():
    """Return a launch description with the arguments and the actions of `start`."""
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in DECLARED.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
