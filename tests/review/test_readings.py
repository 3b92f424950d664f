"""Environment variables and arguments that a description newly reads."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "arm/urdf/arm.urdf.xacro"
ROBOT = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="height" default="{default}"/>
  <xacro:include filename="$(find absent_laser)/urdf/laser.xacro"/>
  <link name="base"/>
  <link name="arch"/>
  <joint name="foot" type="fixed"><parent link="base"/><child link="arch"/><origin xyz="{xyz}"/></joint>
  {part}
</robot>
"""
OFFSET = "environment variable 'ARM_OFFSET' (0 0 1) is read now"


@pytest.mark.parametrize(
    ("xyz", "default", "lines"),
    [
        ("$(optenv ARM_OFFSET 0 0 1)", "1", [OFFSET]),
        ("0 0 $(arg height)", "1", ["argument 'height' is used now"]),
        ("0 0 1", "$(optenv ARM_HEIGHT 1)", ["default of argument 'height' 1 -> $(optenv ARM_HEIGHT 1)"]),
    ],
)
def test_names_that_a_description_newly_reads_are_told(repository, compare, xyz, default, lines):
    repository.commit({PATH: ROBOT.format(default="1", xyz="0 0 1", part="")})
    repository.write({PATH: ROBOT.format(default=default, xyz=xyz, part="")})
    result = compare(repository)
    assert sentences(subject(result, PATH)) == lines
    assert breaking(result) == []


def test_names_that_were_read_before_or_are_in_another_line_are_not_told(repository, compare):
    other = "arm/urdf/other.urdf.xacro"
    reading = ROBOT.format(default="1", xyz="$(optenv ARM_OFFSET 0 0 1)", part="")
    part = '<xacro:if value="false"><laser topic="$(optenv ARM_LASER scan)"/></xacro:if>'
    repository.commit({PATH: ROBOT.format(default="1", xyz="0 0 $(arg height)", part=""), other: reading})
    repository.write({PATH: ROBOT.format(default="1", xyz="$(optenv ARM_OFFSET 0 0 1)", part=part)})
    lines = sentences(subject(compare(repository), PATH))
    assert lines
    assert [line for line in lines if "read now" in line] == []


def test_list_of_new_variables_is_complete(repository, compare):
    """Another line names ARM_LAMP, which the list repeats."""
    repository.commit({PATH: ROBOT.format(default="1", xyz="0 0 1", part="")})
    part = '<xacro:if value="$(optenv ARM_LAMP 0)"><lamp topic="$(env ARM_TOPIC)"/></xacro:if>'
    repository.write({PATH: ROBOT.format(default="1", xyz="$(optenv ARM_OFFSET 0 0 1)", part=part)})
    line = "environment variables 'ARM_OFFSET' (0 0 1), 'ARM_LAMP' (0), 'ARM_TOPIC' are read now"
    assert line in sentences(subject(compare(repository), PATH))


MACRO = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="arch" params="parent *origin">
    <link name="arch"/>
    <joint name="foot" type="fixed"><parent link="${{parent}}"/><child link="arch"/>{origin}</joint>
  </xacro:macro>
</robot>
"""
BLOCK = '<xacro:insert_block name="origin"/>'
FIXED = '<origin xyz="0 0 1"/>'


@pytest.mark.parametrize(
    ("old", "new", "change"),
    [
        (FIXED, BLOCK, "xyz=0 0 1 -> block 'origin' of the caller"),
        (BLOCK, FIXED, "block 'origin' of the caller -> xyz=0 0 1"),
    ],
)
def test_block_of_the_caller_that_replaces_an_element_is_one_change(repository, compare, old, new, change):
    repository.commit({PATH: MACRO.format(origin=old)})
    repository.write({PATH: MACRO.format(origin=new)})
    assert sentences(subject(compare(repository), PATH)) == [f"macro 'arch': joint foot origin: {change}"]


SWITCH = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="tower" default="{default}"/>
  <xacro:property name="has_tower" value="$(arg tower)"/>
  <link name="base"/>
  <xacro:if value="{condition}">
    <link name="tower"><visual><geometry><sphere radius="{radius}"/></geometry></visual></link>
    <joint name="neck" type="fixed"><parent link="base"/><child link="tower"/></joint>
  </xacro:if>
</robot>
"""


@pytest.mark.parametrize(
    ("default", "condition", "is_shown"),
    [
        ("0", "$(arg tower)", True),
        ("$(optenv ARM_TOWER 0)", "${has_tower or 0}", True),
        ("0", "${1 > 2}", False),  # the argument may be any number
    ],
)
def test_0_and_1_are_the_values_of_a_boolean_argument_in_a_condition(repository, compare, default, condition, is_shown):
    old = SWITCH.format(default=default, condition=condition, radius=1)
    repository.commit({PATH: old})
    repository.write({PATH: SWITCH.format(default=default, condition=condition, radius=2)})
    result = compare(repository)
    changes = [change for each in result.subjects for change in each.changes]
    assert ("tower:=1" in str([change.cases for change in changes])) is is_shown


def test_conditions_of_a_long_element_are_not_cut(repository, compare):
    call = f"""<xacro:if value="$(arg tower)"><xacro:camera topic="{"long_" * 20}name"/></xacro:if>"""
    old = MACRO.format(origin=FIXED)
    repository.commit({PATH: old})
    repository.write({PATH: old.replace("</xacro:macro>", f"{call}</xacro:macro>")})
    (line,) = sentences(subject(compare(repository), PATH))
    assert line.endswith("... [if $(arg tower)] added")
