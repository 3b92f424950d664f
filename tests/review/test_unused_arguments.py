"""Removed arguments of descriptions whose values reached nothing."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, MACRO
from tests.review.conftest import breaking, sentences, subject

SEGMENT = "arm_description/urdf/segment.xacro"
ROBOT = "arm_description/urdf/arm.urdf.xacro"
ARGUMENT = '  <xacro:arg name="vendor" default=""/>\n'
CALL = '<xacro:segment name="upper" parent="base_link"'


@pytest.mark.parametrize(
    ("body", "is_unused"),
    [
        ("", True),
        ("<link name='${name}_${brand}'/>", False),
        ("<xacro:cover brand='${brand}'/>", True),
        ("<xacro:cover brand='a'/><xacro:paint/>", False),
    ],
)
def test_argument_whose_value_reaches_nothing_is_removed_without_harm(package, compare, body, is_unused):
    macro = MACRO.replace("length:=0.5", "length:=0.5 brand:=''").replace("  </xacro:macro>", f"{body}</xacro:macro>")
    others = """<xacro:macro name="cover" params="brand"/>
      <xacro:macro name="paint" params=""><xacro:if value="${brand == 'x'}"><link name="x"/></xacro:if></xacro:macro>"""
    robot = ARM.replace("  <link", f"{ARGUMENT}  <link", 1)
    package.commit({SEGMENT: macro.replace("</robot>", f"{others}</robot>"),
                    ROBOT: robot.replace(CALL, f'{CALL} brand="$(arg vendor)"')})  # fmt: skip
    package.write({ROBOT: ARM})
    result = compare(package)
    removed = "unused argument 'vendor' removed" if is_unused else "argument 'vendor' removed"
    assert removed in sentences(subject(result, ROBOT))
    assert (removed in breaking(result)) is not is_unused


def test_argument_that_an_absent_file_may_use_is_not_called_unused(package, compare):
    include = '  <xacro:include filename="$(find vendor_tools)/urdf/tool.xacro"/>\n'
    robot = ARM.replace("  <link", f"{include}  <link", 1)
    package.commit({ROBOT: robot.replace("  <link", f"{ARGUMENT}  <link", 1)})
    package.write({ROBOT: robot})
    assert breaking(compare(package)) == ["argument 'vendor' removed"]


def test_no_warning_about_the_code_of_a_launch_file_reaches_the_user(repository, compare, recwarn):
    launch = """import os
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess
from launch.substitutions import LaunchConfiguration
from launch_ros.actions import Node


def generate_launch_description():
    pattern = r'arm' + '\\ .py'
    return LaunchDescription([
        DeclareLaunchArgument('model', default_value='a'),
        Node(package='arm', executable='driver', name=LaunchConfiguration('model')),
    ])
"""
    repository.commit({"arm/package.xml": "<package/>", "arm/launch/arm.launch.py": launch})
    repository.write({"arm/launch/arm.launch.py": launch.replace("LaunchConfiguration('model')", "'b'")})
    assert breaking(compare(repository))
    assert not [warning for warning in recwarn if issubclass(warning.category, SyntaxWarning)]
