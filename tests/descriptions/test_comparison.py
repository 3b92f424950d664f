"""The comparison of two descriptions."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.descriptions import examine
from linkwright.descriptions.comparison import Comparison, Side, as_text, compare

ROBOT = """\
<robot name="r">
  <link name="base">
    <inertial><mass value="2"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual><geometry><box size="1 1 1"/></geometry></visual>
    <visual><origin xyz="0 0 1"/><geometry><sphere radius="0.5"/></geometry></visual>
  </link>
  <link name="arm"><collision><geometry><mesh filename="a.stl"/></geometry></collision></link>
  <link name="hand"/>
  <joint name="shoulder" type="revolute">
    <origin xyz="0 0 0.5" rpy="0 0 0.1"/><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="10" velocity="2"/>
  </joint>
  <joint name="wrist" type="fixed"><parent link="arm"/><child link="hand"/></joint>
  <gazebo reference="arm"><mu1>0.5</mu1></gazebo>
</robot>
"""


def compared(old: str, new: str) -> Comparison:
    robots = [examine(text).robot for text in (old, new)]
    assert robots[0] is not None
    assert robots[1] is not None
    return compare(Side(robots[0]), Side(robots[1]))


def found(old: str, new: str) -> list[tuple[str, str, str, str, str | None, str | None]]:
    differences = compared(old, new).differences
    return [
        (difference.subject, difference.name, difference.kind, difference.property, difference.old, difference.new)
        for difference in differences
    ]


def test_robot_equals_itself():
    assert found(ROBOT, ROBOT) == []


@pytest.mark.parametrize(
    ("written", "instead"),
    [
        ('xyz="0 0 0.5"', 'xyz="0.0  0 5e-1"'),
        ('xyz="0 0 0.5"', 'xyz="0 0 0.5000005"'),
        ('rpy="0 0 0.1"', f'rpy="{pi} {pi} {pi + 0.1}"'),
        ('<axis xyz="0 0 1"/>', '<axis xyz="0 0 2"/>'),
        ("<mu1>0.5</mu1>", "<!-- slippery --><mu1> 0.5 </mu1>"),
        ('<mass value="2"/>', '<mass value="2.0000001"/>'),
    ],
)
def test_equivalent_notation_is_no_difference(written, instead):
    assert found(ROBOT, ROBOT.replace(written, instead)) == []


@pytest.mark.parametrize(
    ("written", "instead", "expected"),
    [
        ('<mass value="2"/>', '<mass value="2.5"/>', ("link", "base", "changed", "inertial mass", "2", "2.5")),
        ('ixx="1"', 'ixx="1.1"', ("link", "base", "changed", "inertial inertia ixx", "1", "1.1")),
        (
            'xyz="0 0 0.5"',
            'xyz="0 0 0.51"',
            ("joint", "shoulder", "changed", "origin xyz", "0 0 0.5", "0 0 0.51"),
        ),
        (
            'rpy="0 0 0.1"',
            'rpy="0 0 0.2"',
            ("joint", "shoulder", "changed", "origin rpy", "0 0 0.1", "0 0 0.2"),
        ),
        ('upper="1"', 'upper="1.5"', ("joint", "shoulder", "changed", "limit upper", "1", "1.5")),
        (
            'radius="0.5"',
            'radius="0.6"',
            ("link", "base", "changed", "visual 2 geometry", "sphere radius 0.5", "sphere radius 0.6"),
        ),
        ("a.stl", "b.stl", ("link", "arm", "changed", "collision geometry", "mesh a.stl", "mesh b.stl")),
        ("<mu1>0.5</mu1>", "<mu1>0.6</mu1>", ("extension", "gazebo arm", "changed", "mu1", "0.5", "0.6")),
        (
            "<mu1>0.5</mu1>",
            '<mu1>0.5</mu1><mu2 a="1"/>',
            ("extension", "gazebo arm", "changed", "mu2", None, "a=1"),
        ),
        ('name="r"', 'name="s"', ("robot", "s", "changed", "name", "r", "s")),
        ('type="fixed"', 'type="floating"', ("joint", "wrist", "changed", "type", "fixed", "floating")),
    ],
)
def test_change_is_reported_with_old_and_new_value(written, instead, expected):
    [difference] = found(ROBOT, ROBOT.replace(written, instead))
    assert difference == expected


def test_block_in_only_one_robot_is_one_difference():
    without = ROBOT.replace('<limit lower="-1" upper="1" effort="10" velocity="2"/>', "").replace(
        "revolute", "continuous"
    )
    differences = {each[3]: each for each in found(ROBOT, without)}
    assert sorted(differences) == ["limit", "type"]
    assert differences["limit"][4:] == ("lower -1 rad, upper 1 rad, effort 10 N m, velocity 2 rad/s", None)


def test_inserted_visual_leaves_following_visuals_unchanged():
    new = ROBOT.replace(
        "<visual><geometry>",
        '<visual><geometry><cylinder radius="1" length="2"/></geometry></visual><visual><geometry>',
    )
    [difference] = found(ROBOT, new)
    assert difference[:5] == ("link", "base", "changed", "visual 1", None)


def test_added_and_removed_links_and_joints_are_reported():
    new = ROBOT.replace('"hand"', '"gripper"').replace('"wrist" type="fixed"', '"flange" type="floating"')
    assert [each[:3] for each in found(ROBOT, new)] == [
        ("link", "gripper", "added"),
        ("link", "hand", "removed"),
        ("joint", "flange", "added"),
        ("joint", "wrist", "removed"),
    ]


def test_renamed_links_and_joints_are_recognized():
    new = ROBOT
    for name in ("base", "arm", "hand", "shoulder", "wrist"):
        new = new.replace(f'"{name}"', f'"left_{name}"')
    comparison = compared(ROBOT, new)
    assert {difference.kind for difference in comparison.differences if difference.subject != "extension"} == {
        "renamed"
    }
    assert comparison.links == {"base": "left_base", "arm": "left_arm", "hand": "left_hand"}
    assert comparison.joints == {"shoulder": "left_shoulder", "wrist": "left_wrist"}


def test_changed_link_with_new_name_is_not_a_rename():
    new = ROBOT.replace('"arm"', '"boom"').replace("a.stl", "b.stl")
    kinds = {(each[1], each[2]) for each in found(ROBOT, new) if each[0] == "link"}
    assert kinds == {("boom", "added"), ("arm", "removed")}


def test_locations_are_attributes_in_both_files():
    new = ROBOT.replace('  <link name="hand"/>\n', '\n  <link name="hand"/>\n').replace('upper="1"', 'upper="2"')
    [difference] = compared(ROBOT, new).differences
    assert difference.old_place is not None
    assert difference.new_place is not None
    assert (difference.old_place.span.line, difference.old_place.span.column) == (11, 49)
    assert (difference.new_place.span.line, difference.new_place.span.column) == (12, 49)


def test_locations_include_macro_calls():
    xacro = """\
<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="body" params="name mass">
    <link name="${name}"><inertial><mass value="${mass}"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
  </xacro:macro>
  <xacro:body name="a" mass="1"/>
</robot>
"""
    comparison = compared(xacro, xacro.replace('mass="1"', 'mass="2"'))
    text = as_text(comparison, lambda file: file.strip("<>"))
    assert text == (
        "link 'a': inertial mass 1 -> 2 kg\n"
        "  robot_description:3:49 called at robot_description:6:3 -> "
        "robot_description:3:49 called at robot_description:6:3\n"
        "1 difference\n"
    )
