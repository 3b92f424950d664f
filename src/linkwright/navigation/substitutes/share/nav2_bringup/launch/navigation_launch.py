# SPDX-License-Identifier: Apache-2.0
"""Launch path planning and following.

The arguments are those of nav2_bringup's file of the same name.
"""

from ament_index_python.packages import get_package_share_path
from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable
from nav2_common.launch import HasNodeParams

from launch import LaunchDescription
from linkwright.navigation.substitutes.servers import ARGUMENTS, Server, make_server_actions

COMMANDED = ("cmd_vel", "cmd_vel_nav")
MONITOR = Server("nav2_collision_monitor", "collision_monitor", "nav2_collision_monitor::CollisionMonitor")


def servers(*, is_monitored):
    """Return the servers, with remappings that pass velocities through the smoother.

    Velocities also pass through the collision monitor, if one is used.
    """
    smoothed = () if is_monitored else (("cmd_vel_smoothed", "cmd_vel"),)
    return [
        Server("nav2_controller", "controller_server", "nav2_controller::ControllerServer", remappings=(COMMANDED,)),
        Server("nav2_smoother", "smoother_server", "nav2_smoother::SmootherServer"),
        Server("nav2_planner", "planner_server", "nav2_planner::PlannerServer"),
        Server("nav2_behaviors", "behavior_server", "behavior_server::BehaviorServer", remappings=(COMMANDED,)),
        Server("nav2_bt_navigator", "bt_navigator", "nav2_bt_navigator::BtNavigator"),
        Server("nav2_waypoint_follower", "waypoint_follower", "nav2_waypoint_follower::WaypointFollower"),
        Server(
            "nav2_velocity_smoother",
            "velocity_smoother",
            "nav2_velocity_smoother::VelocitySmoother",
            remappings=(COMMANDED, *smoothed),
        ),
        *([MONITOR] if is_monitored else []),
    ]


def start(context):
    """Return the actions that start the servers.

    A collision monitor is included if the parameters contain one.
    """
    has_parameters = HasNodeParams(context.launch_configurations["params_file"], "collision_monitor")
    is_monitored = MONITOR.is_available and has_parameters.perform(context) == "True"
    return make_server_actions(context, "lifecycle_manager_navigation", servers(is_monitored=is_monitored))


def generate_launch_description():
    """Return a launch description with the arguments and the actions of `start`."""
    parameters = get_package_share_path("nav2_bringup") / "params" / "nav2_params.yaml"
    declared = {
        **ARGUMENTS,
        "params_file": (str(parameters), "The path of the parameter file"),
        "graph": ("", "Not used"),
    }
    arguments = [
        DeclareLaunchArgument(name, default_value=default, description=description)
        for name, (default, description) in declared.items()
    ]
    buffered = SetEnvironmentVariable("RCUTILS_LOGGING_BUFFERED_STREAM", "1")
    return LaunchDescription([buffered, *arguments, OpaqueFunction(function=start)])
