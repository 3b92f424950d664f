"""The xacro files of a configuration package: the description, and the interfaces of ros2_control."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from xml.sax.saxutils import escape, quoteattr

from linkwright.planning.setup.settings import PackageSettings
from linkwright.planning.setup.srdf import WORLD

HARDWARE_ARGUMENT = "ros2_control_hardware_type"
"""The xacro argument that selects the hardware, as in MoveIt's resources."""

MOCK, GAZEBO = "mock_components", "gazebo"
"""Its values."""

_URDF = """\
<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name={robot}>
{arguments}
    <!-- The robot description -->
    <xacro:include filename={description}/>
{control}{gazebo}</robot>
"""
_CONTROL_CALL = """
    <!-- The interfaces of ros2_control, with simulated hardware -->
    <xacro:include filename="{name}.ros2_control.xacro"/>
    <xacro:{macro}_ros2_control name="FakeSystem" initial_positions_file="$(arg initial_positions_file)"
        hardware_type="$(arg {argument})"/>
"""
_GAZEBO_ARGUMENTS = """\
    <xacro:if value="${{'$(arg {argument})' == '{value}'}}">
{arguments}    </xacro:if>
"""
_GAZEBO = """
    <xacro:if value="${{'$(arg {argument})' == '{value}'}}">
{parts}
    </xacro:if>
"""
_GAZEBO_PLUGIN = """\
        <!-- The controllers in Gazebo -->
        <gazebo>
            <plugin filename="{library}" name="{plugin}">
                <parameters>$(find {package})/config/ros2_controllers.yaml</parameters>
            </plugin>
        </gazebo>"""
_FIXED_BASE = """\
        <!-- Without this joint, the robot would fall over. -->
        <link name="{world}"/>
        <joint name={joint} type="fixed">
            <parent link="{world}"/>
            <child link={link}/>
        </joint>"""
_CONTROL = """\
<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
    <xacro:macro name="{macro}_ros2_control" params="name initial_positions_file hardware_type:={mock}">
        <xacro:property name="initial_positions"
                        value="${{xacro.load_yaml(initial_positions_file)['initial_positions']}}"/>

        <ros2_control name="${{name}}" type="system">
            <hardware>
                <!-- Simulated hardware, which moves at once. Replace it by the plugin of the real hardware. -->
                <xacro:if value="${{hardware_type == '{mock}'}}">
                    <plugin>mock_components/GenericSystem</plugin>
                </xacro:if>
                <xacro:if value="${{hardware_type == '{gazebo}'}}">
                    <plugin>{hardware}</plugin>
                </xacro:if>
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


def description_file(settings: PackageSettings) -> str:
    """Return the description of a package, which includes that of the robot."""
    source, name = settings.source, settings.file_name
    control, gazebo = "", "\n\n".join(_gazebo_parts(settings))
    if gazebo:
        gazebo = _GAZEBO.format(argument=HARDWARE_ARGUMENT, value=GAZEBO, parts=gazebo)
    if settings.simulated_joints:
        control = _CONTROL_CALL.format(name=name, macro=_macro_name(name), argument=HARDWARE_ARGUMENT)
    return _URDF.format(
        robot=quoteattr(settings.robot.name),
        arguments=_arguments(settings),
        description=quoteattr(f"$(find {source.package})/{source.path}" if source.package else f"{name}.urdf"),
        control=control,
        gazebo=gazebo,
    )


def _arguments(settings: PackageSettings) -> str:
    """Return the xacro arguments with their default values. The first default of an argument counts."""
    own = {"initial_positions_file": "initial_positions.yaml"} if settings.simulated_joints else {}
    text = _argument_lines({**own, HARDWARE_ARGUMENT: MOCK}, 4)
    if settings.gazebo.arguments:
        arguments = _argument_lines(settings.gazebo.arguments, 8)
        text += _GAZEBO_ARGUMENTS.format(argument=HARDWARE_ARGUMENT, value=GAZEBO, arguments=arguments)
    return text + (_argument_lines(settings.source.arguments, 4) if settings.source.package else "")


def _argument_lines(defaults: Mapping[str, str], indent: int) -> str:
    return "".join(
        f"{' ' * indent}<xacro:arg name={quoteattr(name)} default={quoteattr(default)}/>\n"
        for name, default in defaults.items()
    )


def _gazebo_parts(settings: PackageSettings) -> Iterator[str]:
    """Yield what the robot needs in Gazebo, and its description does not have."""
    gazebo = settings.gazebo
    if not gazebo.has_plugin:
        library = gazebo.simulator.library
        yield _GAZEBO_PLUGIN.format(
            library=f"lib{library}.so" if gazebo.simulator.is_classic else library,
            plugin=gazebo.simulator.plugin,
            package=settings.name,
        )
    if gazebo.fixed_link:
        yield _FIXED_BASE.format(world=WORLD, joint=quoteattr(_joint_name(settings)), link=quoteattr(gazebo.fixed_link))


def _joint_name(settings: PackageSettings) -> str:
    """Return a name for the joint between the world and the robot that the robot does not have."""
    name = f"{WORLD}_joint"
    while name in settings.robot.joints:
        name = f"{name}_"
    return name


def control_file(settings: PackageSettings) -> str:
    """Return the interfaces of ros2_control for the joints that have none in the description of the robot."""
    joints = [_CONTROL_JOINT.format(attribute=quoteattr(name), name=name) for name in settings.simulated_joints]
    is_humble = settings.distribution == "humble"
    for joint in settings.robot.joints.values():
        mimic = joint.mimic
        if mimic is None or mimic.joint not in settings.simulated_joints or (is_humble and mimic.offset):
            continue  # Humble's simulated hardware knows no offset.
        parameters = _MIMIC_PARAMETERS.format(leader=escape(mimic.joint), multiplier=mimic.multiplier)
        joints.append(_MIMIC_JOINT.format(attribute=quoteattr(joint.name), parameters=parameters if is_humble else ""))
    return _CONTROL.format(
        macro=_macro_name(settings.file_name),
        mock=MOCK,
        gazebo=GAZEBO,
        hardware=settings.gazebo.simulator.hardware_plugin,
        joints="\n".join(joints),
    )


def _macro_name(name: str) -> str:
    return re.sub(r"\W", "_", name)
