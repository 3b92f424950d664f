"""Packages that are available without being declared.

Such packages are part of every ROS installation, or dependencies of declared packages.
"""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import LinkwrightError
from linkwright.packages import PackageFinder
from linkwright.packages.manifest import MANIFEST
from linkwright.packages.readers.package_xml import Manifest
from linkwright.xmltree import parse_file

_ALWAYS_INSTALLED = frozenset(
    {
        *(
            "ament_index_python",
            "ament_index_cpp",
            "launch",
            "launch_ros",
            "launch_xml",
            "launch_yaml",
            "launch_testing",
        ),
        *(
            "launch_testing_ros",
            "rclpy",
            "rclcpp",
            "rclcpp_action",
            "rclcpp_components",
            "rclcpp_lifecycle",
            "ros2launch",
        ),
        *("lifecycle_msgs", "rcl_interfaces", "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "rosbag2"),
        *("robot_state_publisher", "tf2", "tf2_ros", "tf2_py", "tf2_msgs", "kdl_parser", "urdf", "rosbag2_transport"),
    }
)
"""Packages of the variant `ros_base` (REP 2001), which every installation is assumed to contain."""
_CORE_PACKAGES = frozenset(
    {
        *("action_msgs", "actionlib_msgs", "builtin_interfaces", "class_loader", "composition_interfaces"),
        *("diagnostic_msgs", "message_filters", "pluginlib", "rcpputils", "rcutils", "rosgraph_msgs", "shape_msgs"),
        *("std_srvs", "stereo_msgs", "trajectory_msgs", "unique_identifier_msgs", "visualization_msgs"),
    }
)
"""More packages that the base packages bring."""
_CORE_PREFIXES = (
    *("ament_", "rcl_", "rclcpp_", "rmw_", "rosidl_"),
    *("launch_pytest", "launch_ros", "launch_testing", "launch_xml", "launch_yaml"),
)
_CORE_PACKAGES_OF_ROS1 = frozenset(
    {
        *("actionlib", "bond", "catkin", "cpp_common", "dynamic_reconfigure", "genmsg", "gencpp", "genpy", "geneus"),
        *("genlisp", "gennodejs", "message_generation", "message_runtime", "mk", "nodelet", "rosbag", "rosbuild"),
        *("rosconsole", "roscpp", "roscpp_serialization", "roscpp_traits", "rosgraph", "roslaunch", "roslib", "rosmsg"),
        *("rosnode", "rosparam", "rospy", "rosservice", "rostest", "rostime", "rostopic", "rosunit", "topic_tools"),
        *("xmlrpcpp", "std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "cmake_modules"),
    }
)
"""Packages of the variant `ros_base` of ROS 1 (REP 150)."""
_METAPACKAGE_PREFIXES = (
    ("navigation2", "nav2_"),
    ("nav2_bringup", "nav2_"),
    ("navigation2", "opennav_docking"),
    ("nav2_bringup", "opennav_docking"),
    ("moveit", "moveit_"),
    ("ros_gz", "ros_gz_"),
    ("gazebo_ros_pkgs", "gazebo_"),
    ("joint_state_publisher_gui", "joint_state_publisher"),
    ("ros2_controllers", "controller_manager"),
    ("ros2_control", "controller_"),
    ("ros2_control", "hardware_interface"),
    ("controller_interface", "hardware_interface"),
    *((name, "rviz") for name in ("moveit_ros_visualization", "rviz_visual_tools", "viz", "rviz_plugin_tutorials")),
    *((name, "gazebo_ros") for name in ("gazebo_ros_control", "gazebo_plugins", "hector_gazebo_plugins", "gazebo_dev")),
    *((name, "controller_manager") for name in ("ros_control", "gazebo_ros_control", "combined_robot_hw")),
    *((name, "tf") for name in ("robot_state_publisher", "rviz", "laser_geometry", "costmap_2d", "move_base", "amcl")),
    *((name, "tf") for name in ("interactive_markers", "robot_localization", "gmapping", "gazebo_plugins")),
    *(("move_base", name) for name in ("base_local_planner", "navfn", "clear_costmap_recovery", "rotate_recovery")),
    *(("navigation", name) for name in ("base_local_planner", "navfn", "clear_costmap_recovery", "rotate_recovery")),
    *(("navigation", name) for name in ("global_planner", "dwa_local_planner", "carrot_planner", "costmap_2d")),
    *((name, "moveit_") for name in ("moveit_plugins", "moveit_full")),
    *(("navigation", name) for name in ("move_base", "amcl", "map_server", "fake_localization", "robot_pose_ekf")),
    ("slam_gmapping", "gmapping"),
    ("moveit_ros_planning_interface", "moveit_ros_"),
    ("robot_model", "joint_state_publisher"),
    ("image_pipeline", "image_"),
    ("image_pipeline", "stereo_image_proc"),
    ("teleop_twist_joy", "joy"),
    ("diagnostics", "diagnostic_"),
    ("rosbridge_suite", "rosbridge_"),
    ("rosserial", "rosserial_"),
    ("rtabmap", "rtabmap_"),
    ("phidgets_drivers", "phidgets_"),
    *(("velodyne", f"velodyne_{name}") for name in ("driver", "laserscan", "msgs", "pointcloud")),
    *(("turtlebot3", f"turtlebot3_{name}") for name in ("bringup", "cartographer", "description", "example", "msgs")),
    *(("turtlebot3", f"turtlebot3_{name}") for name in ("navigation", "node", "slam", "teleop")),
    *(
        (metapackage, name)
        for metapackage in ("ros_controllers", "ros2_controllers")
        for name in (
            *("ackermann_steering_controller", "diff_drive_controller", "effort_controllers"),
            *("forward_command_controller", "gripper_action_controller", "gripper_controllers", "imu_sensor_"),
            *("force_torque_sensor_", "joint_state_", "joint_trajectory_controller", "position_controllers"),
            *("tricycle_", "velocity_controllers"),
        )
    ),
    *(("ros_control", name) for name in ("controller_interface", "hardware_interface", "transmission_interface")),
    *(("navigation", name) for name in ("base_local_planner", "costmap_2d", "dwa_local_planner", "global_planner")),
    *(("navigation", name) for name in ("nav_core", "navfn", "voxel_grid")),
    *(("joystick_drivers", name) for name in ("joy", "spacenav", "wiimote")),
    *(("laser_pipeline", name) for name in ("laser_assembler", "laser_filters", "laser_geometry")),
    *(("imu_tools", name) for name in ("imu_complementary_filter", "imu_filter_madgwick", "rviz_imu_plugin")),
    *(("perception_pcl", name) for name in ("pcl_conversions", "pcl_ros")),
    *(("vision_opencv", name) for name in ("cv_bridge", "image_geometry")),
    ("ros_ign", "ros_ign_"),
    ("rtabmap_ros", "rtabmap_"),
    ("geometry2", "tf2"),
    ("warehouse_ros_mongo", "warehouse_ros"),
    ("uuv_simulator", "uuv_"),
    ("image_transport_plugins", "compressed_"),
    ("rqt_common_plugins", "rqt_"),
    ("rqt", "rqt_gui"),
)
"""Packages, each with the name prefix of the packages that it brings as dependencies."""
_MAX_FILES = 200


def is_always_installed(package: str) -> bool:
    """Return whether every installation of ROS 2 contains a package."""
    return package in _ALWAYS_INSTALLED


def is_in_every_workspace(package: str, *, is_ros1: bool) -> bool:
    """Return whether every installation in which packages are built contains a package.

    Args:
        package: the name of the package.
        is_ros1: whether catkin builds the package that uses it.
    """
    if package in _CORE_PACKAGES or (is_ros1 and package in _CORE_PACKAGES_OF_ROS1):
        return True
    return is_always_installed(package) or package.startswith(_CORE_PREFIXES)


def is_covered(name: str, manifest: Manifest, finder: PackageFinder) -> bool:
    """Return whether a package is there although the manifest does not name it, or if it names it otherwise.

    Args:
        name: the name of the package.
        manifest: the manifest of the package that uses it.
        finder: the finder of packages.
    """
    return (
        manifest.declares(name)
        or manifest.declares(f"{name}_vendor")
        or is_in_every_workspace(name, is_ros1=manifest.is_ros1)
        or depends_indirectly_on(manifest, name, finder)
    )


def depends_indirectly_on(manifest: Manifest, package: str, finder: PackageFinder) -> bool:
    """Return whether a declared dependency of a manifest depends on a package.

    Only packages that are installed here can be read.

    Args:
        manifest: the manifest of the package that is checked.
        package: the name of the other package.
        finder: the finder of packages.
    """
    return any(
        name == package
        or any(name == metapackage and package.startswith(prefix) for metapackage, prefix in _METAPACKAGE_PREFIXES)
        for name in _transitive_dependencies(manifest, finder)
    )


def list_companion_prefixes(package: str) -> tuple[str, ...]:
    """Return the name prefixes of the packages that a metapackage brings together with a package."""
    bringing = {metapackage for metapackage, prefix in _METAPACKAGE_PREFIXES if package.startswith(prefix)}
    return tuple(dict.fromkeys(prefix for metapackage, prefix in _METAPACKAGE_PREFIXES if metapackage in bringing))


def would_form_cycle(manifest: Manifest, package: str, finder: PackageFinder) -> bool:
    """Return whether depending on another package would form a cycle, which colcon refuses.

    This is the case if the other package depends on the manifest's package.

    Args:
        manifest: the manifest of the package that uses the other package.
        package: the name of the other package.
        finder: the finder of packages.
    """
    other_manifest = _find_manifest(package, finder)
    return other_manifest is not None and any(
        name == manifest.name for name in _transitive_dependencies(other_manifest, finder)
    )


def _transitive_dependencies(manifest: Manifest, finder: PackageFinder) -> Iterator[str]:
    """Yield the names of a manifest's direct and indirect dependencies.

    Dependencies of a package that is not found are left out.
    """
    pending_manifests, visited_names = [manifest], {manifest.name}
    while pending_manifests and len(visited_names) < _MAX_FILES:
        for dependency in pending_manifests.pop().dependencies:
            if dependency.tag in ("test_depend", "doc_depend") or dependency.name in visited_names:
                continue
            visited_names.add(dependency.name)
            yield dependency.name
            dependency_manifest = _find_manifest(dependency.name, finder)
            if dependency_manifest is not None:
                pending_manifests.append(dependency_manifest)


def _find_manifest(package: str, finder: PackageFinder) -> Manifest | None:
    folder = finder.find(package)
    try:
        return None if folder is None else Manifest(parse_file(folder / MANIFEST))
    except LinkwrightError:
        return None
