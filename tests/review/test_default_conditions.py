"""Parts of macros behind conditions on parameters that have a default."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences

PATH = "arm/urdf/gripper.xacro"
MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="gripper" params="name{parameters}">
    <ros2_control name="${{name}}" type="system"><hardware>{hardware}</hardware></ros2_control>{other}
  </xacro:macro>
</robot>
"""
PLUGIN = "<plugin>{}</plugin>"
IF, UNLESS = '<xacro:if value="{}">{}</xacro:if>', '<xacro:unless value="{}">{}</xacro:unless>'
FAKE, REAL = PLUGIN.format("mock/System"), PLUGIN.format("gripper/System")
CONDITION = "macro 'gripper': ros2_control ${name} hardware plugin: condition always -> if ${fake}"
REMOVED = "macro 'gripper': ros2_control ${name} hardware plugin gripper/System removed"


def _compare(repository, compare, old, new):
    macros = [MACRO.format(**{"parameters": "", "hardware": REAL, "other": ""} | values) for values in (old, new)]
    repository.commit({PATH: macros[0]})
    repository.write({PATH: macros[1]})
    return compare(repository)


@pytest.mark.parametrize(
    ("parameters", "hardware", "expected"),
    [
        (" fake:=false", IF.format("${fake}", FAKE), CONDITION),
        (" fake:=false isaac:=0", IF.format("${fake}", FAKE) + IF.format("${isaac}", PLUGIN.format("isaac")), REMOVED),
        (" fake:=false", UNLESS.format("${fake}", FAKE), None),
        (" fake:=true", IF.format("${fake}", FAKE), None),
        (" fake", IF.format("${fake}", FAKE), "parameter fake without a default added"),
        (" fake:=false", IF.format("${fake}", FAKE) + '<xacro:plugins fake="${fake}"/>', None),
        ("", "", REMOVED),
    ],
)
def test_hardware_without_a_plugin_by_default_is_breaking(repository, compare, parameters, hardware, expected):
    result = _compare(repository, compare, {}, {"parameters": parameters, "hardware": hardware})
    lines = breaking(result)
    assert len(lines) == (expected is not None)
    assert all(expected in line for line in lines)


@pytest.mark.parametrize(
    ("parameters", "other", "is_breaking"),
    [
        (" lamp:=false", IF.format("${lamp}", '<link name="${name}_lamp"/>'), True),
        (" lamp:=none", IF.format("${lamp == 'red'}", '<link name="${name}_lamp"/>'), True),
        (" lamp:=true", IF.format("${lamp}", '<link name="${name}_lamp"/>'), False),
        (" lamp:=red", IF.format("${lamp == 'red' or lamp == 'blue'}", '<link name="${name}_lamp"/>'), False),
        (" lamp:=''", IF.format("${lamp == ''}", '<link name="${name}_lamp"/>'), False),
    ],
)
def test_part_behind_a_parameter_that_is_false_by_default_is_lost(repository, compare, parameters, other, is_breaking):
    new = {"parameters": parameters, "other": other}
    result = _compare(repository, compare, {"other": '<link name="${name}_lamp"/>'}, new)
    assert ["link ${name}_lamp: condition always -> if" in line for line in breaking(result)] == [True] * is_breaking


@pytest.mark.parametrize(
    ("old", "parameters", "param", "is_breaking"),
    [
        ("", " fake:=false", IF.format("${fake}", '<param name="rate">${rate}</param>'), False),
        (" fake:=false", " fake:=false", IF.format("${fake}", '<param name="rate">${rate}</param>'), True),
        ("", " fake:=true", IF.format("${fake}", '<param name="rate">${rate}</param>'), True),
        ("", " fake:=false", '<param name="rate">${rate}</param>', True),
    ],
)
def test_undefined_name_behind_a_new_condition_breaks_no_old_call(
    repository, compare, old, parameters, param, is_breaking
):
    result = _compare(repository, compare, {"parameters": old}, {"parameters": parameters, "hardware": REAL + param})
    (line,) = [line for item in result.subjects for line in sentences(item) if "which nothing defines" in line]
    assert line.startswith("macro 'gripper': uses 'rate', which nothing defines")
    assert (line in breaking(result)) is is_breaking


@pytest.mark.parametrize("default", ["false", "true"])
def test_a_program_with_a_window_that_no_longer_starts_by_default_is_told(review_changes, default):
    text = f"""<launch>
      <arg name="gui" default="true"/><arg name="rviz" default="{default}"/>
      <node pkg="rviz2" exec="rviz2" if="$(var gui)"/>
      <node pkg="arm" exec="arm" args="$(var gui)"/>
    </launch>"""
    changes, found_breaking = review_changes("arm.launch.xml", text, 'if="$(var gui)"', 'if="$(var rviz)"')
    end = "; by default, it no longer starts" if default == "false" else ""
    assert changes[0] == f"node 'rviz2/rviz2': condition if $(var gui) -> if $(var rviz){end}"
    assert found_breaking == []


@pytest.mark.parametrize(("default", "is_breaking"), [("", True), ("10.0.0.2", False)])
def test_a_node_that_starts_only_with_an_argument_that_is_empty_by_default(review_changes, default, is_breaking):
    text = f"""from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, NotEqualsSubstitution
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("ip", default_value="{default}"),
        Node(package="arm", executable="arm"),
    ])
"""
    condition = 'executable="arm", condition=IfCondition(NotEqualsSubstitution(LaunchConfiguration("ip"), ""))'
    _, found_breaking = review_changes("arm.launch.py", text, 'executable="arm"', condition)
    assert found_breaking == ["node 'arm/arm': condition if $(var ip) != '' added"] * is_breaking


@pytest.mark.parametrize(
    ("default", "other", "is_told"),
    [("false", "", True), ("true", "", False), ("false", '<node pkg="arm" exec="arm" unless="$(var queue)"/>', False)],
)
def test_a_further_condition_that_is_false_by_default_stops_a_node_of_another_choice(
    review_changes, default, other, is_told
):
    text = f"""<launch>
      <arg name="kind" default="plain"/><arg name="queue" default="{default}"/>
      <group if="$(eval &quot;'$(var kind)' == 'long'&quot;)"><node pkg="arm" exec="arm"/></group>
    </launch>"""
    node = '<node pkg="arm" exec="arm"/>'
    new = node.replace("/>", ' if="$(var queue)"/>') + other
    _, found_breaking = review_changes("arm.launch.xml", text, node, new)
    assert any("condition" in line for line in found_breaking) is is_told
