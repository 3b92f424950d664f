"""Tell which launch files common packages have, which arguments these declare and which nodes they start."""

from __future__ import annotations

import re

from linkwright.review.launches.conditions import evaluate_condition
from linkwright.review.launches.outlines import CONDITION, NAMESPACE, NAMESPACE_OF_INCLUDED, Entry, LaunchOutline

_PACKAGE_FILE = re.compile(r"\$\(find(?:-pkg-share)? (?P<package>[\w.-]+)\)/(?:.*/)?(?P<file>[^/$]+)")
_ARGUMENTS = {
    "foxglove_bridge": """
        address asset_uri_allowlist best_effort_qos_topic_whitelist capabilities certfile client_topic_whitelist debug
        disable_load_message ignore_unresponsive_param_nodes include_hidden keyfile max_qos_depth min_qos_depth
        num_threads param_whitelist port publish_client_count send_buffer_limit service_whitelist tls topic_whitelist
        use_compression use_sim_time""",
    "gazebo_ros": """
        extra_gazebo_args factory force_system gdb gui gui_required help init initial_sim_time iters lockstep
        minimal_comms params_file pause physics play profile record record_encoding record_filter record_path
        record_period seed server server_required use_sim_time valgrind verbose version world""",
    "nav2_bringup": """
        autostart bt_xml_file cmd_vel_remap container_name default_bt_xml_filename default_nav_through_poses_bt_xml
        default_nav_to_pose_bt_xml graph keepout_mask lifecycle_nodes log_level map map_subscribe_transient_local
        namespace param_rewrites params params_file rviz_config rviz_config_file slam slam_params_file speed_mask
        stdout_linebuffered use_composition use_intra_process_comms use_keepout_zones use_lifecycle_mgr
        use_lifecycle_manager use_localization use_namespace use_remappings use_respawn use_rviz use_sim_time
        use_speed_zones""",
    "ros_gz_bridge": """
        bridge_name bridge_log_level bridge_params config_file container_name create_own_container
        expand_gz_topic_names extra_bridge_params log_level namespace override_timestamps_with_wall_time
        use_composition use_respawn""",
    "ros_gz_sim": """
        P R Y allow_renaming bridge_log_level bridge_name bridge_params config_file container_name create_own_container
        debug_env debugger entity_name expand_gz_topic_names extra_bridge_params file gz_args gz_version ign_args
        ign_version initial_sim_time log_level model_string name namespace on_exit_shutdown
        override_timestamps_with_wall_time pitch roll string topic use_composition use_respawn verbosity_level world
        world_sdf_file world_sdf_string x y yaw z""",
    "slam_toolbox": """
        autostart executable log_level namespace params_file slam_params_file use_lifecycle_manager use_namespace
        use_sim_time""",
    "teleop_twist_joy": "config_filepath joy_config joy_dev joy_vel publish_stamped_twist",
}
"""The arguments that the launch files of a package declare in any distribution, also by the files that they include."""
_FILES = {
    "gazebo_ros": """
        elevator_world.launch empty_world.launch empty_world.launch.py gazebo.launch.py gazebo_launch.py
        gzclient.launch.py gzserver.launch.py mud_world.launch plugin_world.launch range_world.launch
        rubble_world.launch shapes_world.launch spawn_entity_demo.launch.py spawn_urdf.launch.py
        two_actors_world.launch willowgarage_world.launch""",
    "ros_gz_sim": """
        gz_remove_model.launch.py gz_server.launch gz_server.launch.py gz_sim.launch.py gz_sim_composition.launch.py
        gz_spawn_model.launch gz_spawn_model.launch.py gzserver.launch gzserver.launch.py ign_gazebo.launch
        ign_gazebo.launch.py ign_gazebo_gui.launch.py ign_gazebo_server.launch.py ros_gz_sim.launch
        ros_gz_sim.launch.py ros_gz_spawn_model.launch ros_gz_spawn_model.launch.py""",
}
"""The launch files that a package has in any distribution."""
_LOCALIZATION = {
    "map_server": "nav2_map_server/map_server",
    "amcl": "nav2_amcl/amcl",
    "lifecycle_manager_localization": "nav2_lifecycle_manager/lifecycle_manager",
}
_NAVIGATION = {
    "controller_server": "nav2_controller/controller_server",
    "smoother_server": "nav2_smoother/smoother_server",
    "planner_server": "nav2_planner/planner_server",
    "recoveries_server": "nav2_recoveries/recoveries_server",
    "behavior_server": "nav2_behaviors/behavior_server",
    "bt_navigator": "nav2_bt_navigator/bt_navigator",
    "waypoint_follower": "nav2_waypoint_follower/waypoint_follower",
    "velocity_smoother": "nav2_velocity_smoother/velocity_smoother",
    "lifecycle_manager_navigation": "nav2_lifecycle_manager/lifecycle_manager",
}
_NODES = {
    "localization_launch.py": _LOCALIZATION,
    "navigation_launch.py": _NAVIGATION,
    "bringup_launch.py": _LOCALIZATION | _NAVIGATION,
}
"""The programs of the nodes, by name, that a launch file of Nav2 starts in each distribution that has the program."""
_NODES_PACKAGE = "nav2_bringup"
_NO_LOCALIZATION = (("slam", "true"), ("use_localization", "false"))
"""The arguments of a launch file of Nav2, with the values for which it does not start the nodes of localization."""
_SAME = {"ros_ign_gazebo": "ros_gz_sim", "ros_ign_bridge": "ros_gz_bridge"}
"""The former names of packages."""
_OTHER_FILES = re.compile(r"simulation|tb[34]|example|demo|cloned|unique")
"""The files of these packages that declare further arguments, such as those of a robot."""


def find_known_arguments(path: str) -> frozenset[str] | None:
    """Return the arguments that an included launch file may declare, or None if the file is unknown.

    Args:
        path: the file, such as ``$(find-pkg-share ros_gz_sim)/launch/gz_sim.launch.py``.
    """
    match = _PACKAGE_FILE.fullmatch(path)
    package = "" if match is None else _SAME.get(match["package"], match["package"])
    if match is None or package not in _ARGUMENTS or _OTHER_FILES.search(match["file"]):
        return None
    return frozenset(_ARGUMENTS[package].split())


def find_known_files(package: str) -> frozenset[str] | None:
    """Return the names of the launch files of a common package, or None if they are unknown."""
    files = _FILES.get(_SAME.get(package, package))
    return None if files is None else frozenset(files.split())


def find_starting_include(node: Entry, old: LaunchOutline, new: LaunchOutline) -> Entry | None:
    """Return the action that includes a file of a common package which starts a node by the same name; None if none is.

    Args:
        node: a node of the old version.
        old: the outline with the node.
        new: the outline with the included file.
    """
    name = node.settings.get("name") or node.name.rpartition("/")[2]
    for entry in new.entries if node.kind == "node" else ():
        match = _PACKAGE_FILE.fullmatch(entry.name) if entry.kind == "include" else None
        if match is None or match["package"] != _NODES_PACKAGE or _NODES.get(match["file"], {}).get(name) != node.name:
            continue
        values = {setting: new.resolve(value) for setting, value in entry.settings.items()}
        has_localization = not any(values.get(key, "").lower() == value for key, value in _NO_LOCALIZATION)
        is_left = name in _LOCALIZATION and not has_localization
        namespaces = values.get("namespace", ""), values.get(NAMESPACE_OF_INCLUDED, "")
        is_same = "/".join(filter(None, namespaces)) == old.resolve(node.settings.get(NAMESPACE, ""))
        if is_same and not is_left and evaluate_condition(values.get(CONDITION, "")) is not False:
            return entry
    return None
