"""Removed parts of a robot that an added boolean argument brings back, in a review."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "arm_description/urdf/arm.urdf.xacro"
VISUAL = '<visual><geometry><box size="{} 1 1"/></geometry></visual>'
HEAD = """<link name="head"/>
  <joint name="neck" type="fixed"><parent link="base"/><child link="head"/></joint>"""
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  {argument}
  <link name="base">
    <visual><geometry><sphere radius="1"/></geometry></visual>
    {visual}
  </link>
  {head}
</robot>
"""
ARGUMENT = '<xacro:arg name="tower" default="false"/>'
IF = '<xacro:if value="$(arg tower)">{}</xacro:if>'
OLD = ROBOT.format(argument="", visual=VISUAL.format(1), head=HEAD)
SWITCH = "; now only with tower:=true"


@pytest.fixture
def review_robot(repository, compare):
    def run(visual: str, head: str, argument: str = ARGUMENT) -> list[str]:
        repository.commit({"arm_description/package.xml": PACKAGE_XML, PATH: OLD})
        repository.write({PATH: ROBOT.format(argument=argument, visual=visual, head=head)})
        return [line for line in sentences(subject(compare(repository), PATH)) if "removed" in line]

    return run


def test_removed_parts_that_an_added_argument_brings_back_name_it(review_robot):
    lines = review_robot(IF.format(VISUAL.format(1)), IF.format(HEAD))
    assert lines == [
        f"link 'base': visual 2 removed: origin xyz 0 0 0 m, origin rpy 0 0 0 rad, geometry box 1 1 1 m{SWITCH}",
        f"link 'head' removed{SWITCH}",
        f"joint 'neck' removed{SWITCH}",
    ]


@pytest.mark.parametrize(
    ("visual", "argument"),
    [
        (IF.format(VISUAL.format(3)), ARGUMENT),  # another part
        ("", ARGUMENT),
    ],
)
def test_removed_part_that_no_added_argument_brings_back_is_removed(review_robot, visual, argument):
    (line,) = review_robot(visual, HEAD, argument)
    assert line.startswith("link 'base': visual 2 removed")
    assert "only with" not in line


@pytest.mark.parametrize(("value", "note"), [("tall", "; now only with tower:=tall"), ("short", "")])
def test_removed_part_that_another_value_of_an_added_argument_brings_back_names_it(review_robot, value, note):
    argument = '<xacro:arg name="tower" default="none"/><xacro:property name="kind" value="$(arg tower)"/>'
    compared = f"<xacro:if value=\"${{kind == '{value}'}}\">{VISUAL.format(1 if value == 'tall' else 3)}</xacro:if>"
    (line,) = review_robot(compared, HEAD, argument)
    assert (
        line == f"link 'base': visual 2 removed: origin xyz 0 0 0 m, origin rpy 0 0 0 rad, geometry box 1 1 1 m{note}"
    )


PLUGIN = '<gazebo><plugin name="drive" filename="libdrive.so">{}</plugin></gazebo>'


@pytest.mark.parametrize(("value", "end"), [("false", "; with odometry:=false, it is false"), ("true", "")])
def test_value_that_an_added_argument_brings_back_is_named_if_it_is_another_one(repository, compare, value, end):
    lines = OLD.replace("</robot>", PLUGIN.format("<publish>true</publish>") + "</robot>")
    element = f'<xacro:unless value="$(arg odometry)"><publish>{value}</publish></xacro:unless>'
    argument = '<xacro:arg name="odometry" default="true"/>'
    new = ROBOT.format(argument=argument, visual=VISUAL.format(1), head=HEAD + PLUGIN.format(element))
    repository.commit({"arm_description/package.xml": PACKAGE_XML, PATH: lines})
    repository.write({PATH: new})
    (line,) = [line for line in sentences(subject(compare(repository), PATH)) if "publish" in line]
    assert line == "extension 'gazebo': plugin drive publish removed: true" + (end or "; now only with odometry:=false")


@pytest.mark.parametrize("call", ['<xacro:lamps real="$(arg real)"/>', "<xacro:lamps/>"])
def test_part_that_moves_behind_a_macro_with_an_argument_of_both_versions_names_the_argument(repository, compare, call):
    argument = '<xacro:arg name="real" default="false"/><xacro:property name="is_real" value="$(arg real)"/>'
    sensor = '<gazebo reference="base"><sensor name="eye" type="camera"><topic>eye</topic></sensor></gazebo>'
    old = OLD.replace("</robot>", argument + sensor + "</robot>")
    content = f'<xacro:if value="${{real}}">{sensor}</xacro:if>'
    macro = f'<xacro:macro name="lamps" params="real:=false">{content}</xacro:macro>'
    repository.commit({"arm_description/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: OLD.replace("</robot>", argument + macro + call + "</robot>")})
    lines = sentences(subject(compare(repository), PATH))
    (line,) = [line for line in lines if line.startswith("extension 'gazebo base' removed")]
    assert line.endswith("; now only with real:=true") == ("$(arg real)" in call)


def test_added_macro_of_a_file_of_both_versions_has_its_parameters_and_contents(repository, compare):
    part = "arm_description/urdf/lamps.xacro"
    text = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    macro = '<xacro:macro name="lamps" params="real:=false"><link name="lamp"/></xacro:macro>'
    repository.commit({"arm_description/package.xml": PACKAGE_XML, part: text.format("")})
    repository.write({part: text.format(macro)})
    lines = sentences(subject(compare(repository), part))
    assert lines == ["macro 'lamps' added: parameters real:=false; makes link lamp"]


def test_part_of_hardware_that_the_other_value_lacks_does_not_name_the_argument(repository, compare):
    control = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="sim" default="true"/>
  <link name="base"/><link name="head"/>
  <joint name="neck" type="continuous"><parent link="base"/><child link="head"/></joint>
  <xacro:if value="$(arg sim)">
    <ros2_control name="Simulated" type="system">
      <hardware><plugin>mock_components/GenericSystem</plugin></hardware>
      <joint name="neck"><command_interface name="position"/><state_interface name="position"/>{velocity}</joint>
    </ros2_control>
  </xacro:if>
</robot>
"""
    old = control.format(velocity='<state_interface name="velocity"/>')
    repository.commit({"arm_description/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: control.format(velocity="")})
    (line,) = [line for line in sentences(subject(compare(repository), PATH)) if "removed" in line]
    assert "state_interface velocity removed" in line
    assert "only with" not in line
