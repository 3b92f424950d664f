# SPDX-License-Identifier: Apache-2.0
"""Launch mapping.

The arguments are those of nav2_bringup's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription, OpaqueFunction
from launch.launch_description_sources import PythonLaunchDescriptionSource
from nav2_common.launch import HasNodeParams

from launch import LaunchDescription
from linkwright.navigation.substitutes.servers import Server, make_server_actions

SERVERS = (Server("nav2_map_server", "map_saver_server", "nav2_map_server::MapSaver", "map_saver"),)
ARGUMENTS = {
    "namespace": ("", "Namespace of all nodes"),
    "use_sim_time": ("True", "Whether to use simulated time"),
    "autostart": ("True", "Whether the map saver is activated at the start"),
    "use_respawn": ("False", "Whether the map saver is restarted if it dies"),
    "log_level": ("info", "The log level"),
}


def start(context):
    """Return the actions that start the map saver and the mapping node.

    The mapping node gets the parameters of the file if the file contains any for it.
    """
    configurations = context.launch_configurations
    arguments = {"use_sim_time": configurations["use_sim_time"]}
    if HasNodeParams(configurations["params_file"], "slam_toolbox").perform(context) == "True":
        arguments["slam_params_file"] = configurations["params_file"]
    path = get_package_share_path("slam_toolbox") / "launch" / "online_sync_launch.py"
    mapping = IncludeLaunchDescription(PythonLaunchDescriptionSource(str(path)), launch_arguments=arguments.items())
    configurations["use_composition"] = "False"
    return [*make_server_actions(context, "lifecycle_manager_slam", SERVERS), mapping]


def generate_launch_description():
    """Return a launch description with the arguments and the actions of `start`."""
    parameters = get_package_share_path("nav2_bringup") / "params" / "nav2_params.yaml"
    declared = {**ARGUMENTS, "params_file": (str(parameters), "The path of the parameter file")}
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in declared.items()
    ]
    return LaunchDescription([*arguments, OpaqueFunction(function=start)])
