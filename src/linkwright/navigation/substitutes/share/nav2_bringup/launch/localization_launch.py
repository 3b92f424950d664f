# SPDX-License-Identifier: Apache-2.0
"""Launch the map server and localization.

The arguments are those of nav2_bringup's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable

from launch import LaunchDescription
from linkwright.navigation.substitutes.servers import ARGUMENTS, Server, make_server_actions

SERVERS = (
    Server("nav2_map_server", "map_server", "nav2_map_server::MapServer"),
    Server("nav2_amcl", "amcl", "nav2_amcl::AmclNode"),
)


def start(context):
    """Return the actions that start the servers.

    If the argument ``map`` is not empty, it overrides the map of the parameters.
    """
    file = context.launch_configurations["map"]
    return make_server_actions(
        context, "lifecycle_manager_localization", SERVERS, {"map_server": {"yaml_filename": file}} if file else {}
    )


def generate_launch_description():
    """Return a launch description with the arguments and the actions of `start`."""
    parameters = get_package_share_path("nav2_bringup") / "params" / "nav2_params.yaml"
    declared = {
        **ARGUMENTS,
        "map": ("", "The path of the map's YAML file"),
        "params_file": (str(parameters), "The path of the parameter file"),
    }
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in declared.items()
    ]
    buffered = SetEnvironmentVariable("RCUTILS_LOGGING_BUFFERED_STREAM", "1")
    return LaunchDescription([buffered, *arguments, OpaqueFunction(function=start)])
