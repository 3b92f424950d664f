"""The files of a MoveIt configuration package, as MoveIt's Setup Assistant lays them out."""

from __future__ import annotations

import re
from xml.sax.saxutils import escape, quoteattr

from linkwright.planning.setup import configuration
from linkwright.planning.setup.launch_files import gazebo_packages, launch_files
from linkwright.planning.setup.rviz_configuration import rviz_configuration
from linkwright.planning.setup.settings import PackageSettings
from linkwright.planning.setup.srdf import write_srdf
from linkwright.planning.setup.xacro_files import control_file, description_file
from linkwright.planning.setup.yaml_text import quote_yaml

_DEPENDENCIES = (
    "controller_manager",
    "joint_state_broadcaster",
    "joint_trajectory_controller",
    "moveit_configs_utils",
    "moveit_kinematics",
    "moveit_planners",
    "moveit_ros_move_group",
    "moveit_ros_visualization",
    "moveit_setup_assistant",
    "moveit_simple_controller_manager",
    "robot_state_publisher",
    "rviz2",
    "tf2_ros",
    "xacro",
)
_CMAKE_LISTS = """\
cmake_minimum_required(VERSION 3.22)
project({package})

find_package(ament_cmake REQUIRED)

ament_package()

install(DIRECTORY config DESTINATION share/${{PROJECT_NAME}})
install(DIRECTORY launch DESTINATION share/${{PROJECT_NAME}} PATTERN "setup_assistant.launch.py" EXCLUDE)
install(FILES .setup_assistant DESTINATION share/${{PROJECT_NAME}})
"""
_MANIFEST = """\
<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>{package}</name>
  <version>0.0.0</version>
  <description>Configuration and launch files of MoveIt for {robot}</description>
  <maintainer email={email}>{maintainer}</maintainer>
  <license>{license}</license>

  <buildtool_depend>ament_cmake</buildtool_depend>

{dependencies}

  <export>
    <build_type>ament_cmake</build_type>
  </export>
</package>
"""
_SETUP_ASSISTANT = """\
moveit_setup_assistant_config:
  urdf:
    package: {package}
    relative_path: {path}
{arguments}  srdf:
    relative_path: config/{name}.srdf
  package_settings:
    author_name: {author}
    author_email: {email}
    generated_timestamp: 0
"""


def package_files(settings: PackageSettings) -> dict[str, str]:
    """Return the texts of all files of a package, by path in the package."""
    name, groups = settings.file_name, settings.groups
    files = {
        "package.xml": _manifest(settings),
        "CMakeLists.txt": _CMAKE_LISTS.format(package=settings.name),
        ".setup_assistant": _setup_assistant(settings),
        f"config/{name}.srdf": write_srdf(
            settings.robot, groups, settings.states, settings.pairs, settings.virtual_joint
        ),
        f"config/{name}.urdf.xacro": description_file(settings),
        "config/initial_positions.yaml": configuration.initial_positions(settings.start_positions),
        "config/joint_limits.yaml": configuration.limits(settings.robot, groups),
        "config/kinematics.yaml": configuration.kinematics(groups),
        "config/moveit_controllers.yaml": configuration.moveit_controllers(groups),
        "config/ros2_controllers.yaml": configuration.ros2_controllers(groups),
        "config/pilz_cartesian_limits.yaml": configuration.CARTESIAN_LIMITS,
        "config/moveit.rviz": rviz_configuration(settings.robot, groups),
    }
    files.update(configuration.planning_pipelines(groups, settings.distribution))
    if settings.simulated_joints:
        files[f"config/{name}.ros2_control.xacro"] = control_file(settings)
    if not settings.source.package:
        files[f"config/{name}.urdf"] = settings.source.text
    for launch, text in launch_files(settings).items():
        files[f"launch/{launch}.launch.py"] = text
    return dict(sorted(files.items()))


def _manifest(settings: PackageSettings) -> str:
    dependencies = {*_DEPENDENCIES, *gazebo_packages(settings.gazebo)}
    if any(group.is_end_effector for group in settings.groups.groups):
        dependencies.add("gripper_controllers")
    if settings.source.package:
        dependencies.add(settings.source.package)
    return _MANIFEST.format(
        package=settings.name,
        robot=escape(settings.robot.name),
        email=quoteattr(settings.maintainer.email),
        maintainer=escape(settings.maintainer.name),
        license=escape(settings.license),
        dependencies="\n".join(f"  <exec_depend>{name}</exec_depend>" for name in sorted(dependencies)),
    )


def _setup_assistant(settings: PackageSettings) -> str:
    source, name = settings.source, settings.file_name
    words = [f"{key}:={value}" for key, value in source.arguments.items() if not re.search(r"\s", value)]
    return _SETUP_ASSISTANT.format(
        package=source.package or settings.name,
        path=quote_yaml(source.path if source.package else f"config/{name}.urdf"),
        arguments=f"    xacro_args: {quote_yaml(' '.join(words))}\n" if words and source.package else "",
        name=name,
        author=quote_yaml(settings.maintainer.name),
        email=quote_yaml(settings.maintainer.email),
    )
