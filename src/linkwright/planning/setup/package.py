"""The files of a MoveIt configuration package, as MoveIt's Setup Assistant lays them out."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from xml.sax.saxutils import escape, quoteattr

from linkwright.packages.creation.request import Maintainer
from linkwright.planning.setup import configuration
from linkwright.planning.setup.collision_pairs import CollisionPairs
from linkwright.planning.setup.groups import RobotGroups
from linkwright.planning.setup.named_states import States
from linkwright.planning.setup.rviz_configuration import rviz_configuration
from linkwright.planning.setup.srdf import VirtualJointSettings, write_srdf
from linkwright.planning.setup.yaml_text import quote_yaml
from linkwright.urdf import Robot

LAUNCH_FILES = (
    "demo",
    "move_group",
    "moveit_rviz",
    "rsp",
    "setup_assistant",
    "spawn_controllers",
    "static_virtual_joint_tfs",
    "warehouse_db",
)
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
_LAUNCH_FILE = """\
from moveit_configs_utils import MoveItConfigsBuilder
from moveit_configs_utils.launches import generate_{launch}_launch


def generate_launch_description():
    moveit_config = MoveItConfigsBuilder({robot!r}, package_name={package!r}).to_moveit_configs()
    return generate_{launch}_launch(moveit_config)
"""
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
_URDF = """\
<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name={robot}>
{arguments}
    <!-- The robot description -->
    <xacro:include filename={description}/>
{control}</robot>
"""
_CONTROL_CALL = """
    <!-- The interfaces of ros2_control, with simulated hardware -->
    <xacro:include filename="{name}.ros2_control.xacro"/>
    <xacro:{macro}_ros2_control name="FakeSystem" initial_positions_file="$(arg initial_positions_file)"/>
"""
_CONTROL = """\
<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
    <xacro:macro name="{macro}_ros2_control" params="name initial_positions_file">
        <xacro:property name="initial_positions"
                        value="${{xacro.load_yaml(initial_positions_file)['initial_positions']}}"/>

        <ros2_control name="${{name}}" type="system">
            <hardware>
                <!-- Simulated hardware, which moves at once. Replace it by the plugin of the real hardware. -->
                <plugin>mock_components/GenericSystem</plugin>
            </hardware>
{joints}
        </ros2_control>
    </xacro:macro>
</robot>
"""
_CONTROL_JOINT = """\
            <joint name={attribute}>
                <command_interface name="position"/>
                <state_interface name="position">
                    <param name="initial_value">${{initial_positions[{name!r}]}}</param>
                </state_interface>
                <state_interface name="velocity"/>
            </joint>"""
_MIMIC_JOINT = """\
            <joint name={attribute}>
{parameters}                <state_interface name="position"/>
                <state_interface name="velocity"/>
            </joint>"""
_MIMIC_PARAMETERS = """\
                <param name="mimic">{leader}</param>
                <param name="multiplier">{multiplier}</param>
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


@dataclass(frozen=True, slots=True)
class DescriptionSource:
    """The file of the robot description.

    Attributes:
        package: the package that contains the file; empty if the configuration package gets a copy.
        path: the path of the file in the package.
        arguments: the values of its xacro arguments.
        text: the expanded description, for the copy.
    """

    package: str
    path: str
    arguments: Mapping[str, str]
    text: str


@dataclass(frozen=True, slots=True)
class PackageSettings:
    """The contents of a configuration package.

    Attributes:
        name: the name of the package.
        robot: the robot.
        source: the file of its description.
        groups: its groups.
        states: their named states.
        pairs: the pairs of links whose collisions are not checked.
        virtual_joint: the joint to the frame in which the robot is placed, or None.
        start_positions: the positions at which the demo starts, by joint.
        simulated_joints: the joints that get interfaces of ros2_control with simulated hardware.
        maintainer: the maintainer of the package.
        license: the text for ``<license>``.
        distribution: the distribution of ROS 2, ``humble`` or ``jazzy``, whose format planning pipelines have.
    """

    name: str
    robot: Robot
    source: DescriptionSource
    groups: RobotGroups
    states: States
    pairs: CollisionPairs
    virtual_joint: VirtualJointSettings | None
    start_positions: Mapping[str, float]
    simulated_joints: tuple[str, ...]
    maintainer: Maintainer
    license: str
    distribution: str

    @property
    def file_name(self) -> str:
        """The name of the robot in names of files."""
        return file_name(self.robot.name)


def file_name(robot_name: str) -> str:
    """Return the name of a robot with characters that are usual in names of files."""
    return re.sub(r"[^A-Za-z0-9_.-]+", "_", robot_name).strip("_.") or "robot"


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
        f"config/{name}.urdf.xacro": _urdf(settings),
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
        files[f"config/{name}.ros2_control.xacro"] = _control(settings)
    if not settings.source.package:
        files[f"config/{name}.urdf"] = settings.source.text
    for launch in LAUNCH_FILES:
        if launch != "static_virtual_joint_tfs" or settings.virtual_joint is not None:
            files[f"launch/{launch}.launch.py"] = _LAUNCH_FILE.format(
                launch=launch, robot=name, package=settings.name
            ).replace("'", '"')
    return dict(sorted(files.items()))


def _manifest(settings: PackageSettings) -> str:
    dependencies = {*_DEPENDENCIES}
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


def _urdf(settings: PackageSettings) -> str:
    source, name = settings.source, settings.file_name
    defaults = dict(source.arguments) if source.package else {}
    control = ""
    if settings.simulated_joints:
        defaults = {"initial_positions_file": "initial_positions.yaml", **defaults}
        control = _CONTROL_CALL.format(name=name, macro=_macro_name(name))
    arguments = [
        f"    <xacro:arg name={quoteattr(key)} default={quoteattr(value)}/>\n" for key, value in defaults.items()
    ]
    return _URDF.format(
        robot=quoteattr(settings.robot.name),
        arguments="".join(arguments),
        description=quoteattr(f"$(find {source.package})/{source.path}" if source.package else f"{name}.urdf"),
        control=control,
    )


def _control(settings: PackageSettings) -> str:
    joints = [_CONTROL_JOINT.format(attribute=quoteattr(name), name=name) for name in settings.simulated_joints]
    is_humble = settings.distribution == "humble"
    for joint in settings.robot.joints.values():
        mimic = joint.mimic
        if mimic is None or mimic.joint not in settings.simulated_joints or (is_humble and mimic.offset):
            continue  # Humble's simulated hardware knows no offset.
        parameters = _MIMIC_PARAMETERS.format(leader=escape(mimic.joint), multiplier=mimic.multiplier)
        joints.append(_MIMIC_JOINT.format(attribute=quoteattr(joint.name), parameters=parameters if is_humble else ""))
    return _CONTROL.format(macro=_macro_name(settings.file_name), joints="\n".join(joints))


def _macro_name(name: str) -> str:
    return re.sub(r"\W", "_", name)
