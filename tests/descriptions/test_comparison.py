"""The comparison of two descriptions."""

from __future__ import annotations

from math import pi

import pytest

from linkwright.descriptions import examine
from linkwright.descriptions.comparison import Comparison, Side, as_text, compare, has_same_contents

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


def compare_texts(old: str, new: str) -> Comparison:
    robots = [examine(text).robot for text in (old, new)]
    assert robots[0] is not None
    assert robots[1] is not None
    return compare(Side(robots[0]), Side(robots[1]))


def differences_between(old: str, new: str) -> list[tuple[str, str, str, str, str | None, str | None]]:
    differences = compare_texts(old, new).differences
    return [
        (difference.subject, difference.name, difference.kind, difference.property, difference.old, difference.new)
        for difference in differences
    ]


def test_robot_equals_itself():
    assert differences_between(ROBOT, ROBOT) == []


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
def test_equivalent_notation_is_equal(written, instead):
    assert differences_between(ROBOT, ROBOT.replace(written, instead)) == []


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
    [difference] = differences_between(ROBOT, ROBOT.replace(written, instead))
    assert difference == expected


def test_block_in_only_one_robot_is_one_difference():
    robot_without_limit = ROBOT.replace('<limit lower="-1" upper="1" effort="10" velocity="2"/>', "").replace(
        "revolute", "continuous"
    )
    differences = {difference[3]: difference for difference in differences_between(ROBOT, robot_without_limit)}
    assert sorted(differences) == ["limit", "type"]
    assert differences["limit"][4:] == ("lower -1 rad, upper 1 rad, effort 10 N m, velocity 2 rad/s", None)


def test_inserted_visual_leaves_following_visuals_unchanged():
    new = ROBOT.replace(
        "<visual><geometry>",
        '<visual><geometry><cylinder radius="1" length="2"/></geometry></visual><visual><geometry>',
    )
    [difference] = differences_between(ROBOT, new)
    assert difference[:5] == ("link", "base", "changed", "visual 1", None)


def test_added_and_removed_links_and_joints_are_reported():
    new = ROBOT.replace('"hand"', '"gripper"').replace('"wrist" type="fixed"', '"flange" type="floating"')
    assert [difference[:3] for difference in differences_between(ROBOT, new)] == [
        ("link", "gripper", "added"),
        ("link", "hand", "removed"),
        ("joint", "flange", "added"),
        ("joint", "wrist", "removed"),
    ]


def test_renamed_links_and_joints_are_recognized():
    new = ROBOT
    for name in ("base", "arm", "hand", "shoulder", "wrist"):
        new = new.replace(f'"{name}"', f'"left_{name}"')
    comparison = compare_texts(ROBOT, new)
    assert {difference.kind for difference in comparison.differences if difference.subject != "extension"} == {
        "renamed"
    }
    assert comparison.links == {"base": "left_base", "arm": "left_arm", "hand": "left_hand"}
    assert comparison.joints == {"shoulder": "left_shoulder", "wrist": "left_wrist"}


def test_changed_link_with_new_name_is_not_a_rename():
    new = ROBOT.replace('"arm"', '"boom"').replace("a.stl", "b.stl")
    kinds = {
        (difference[1], difference[2]) for difference in differences_between(ROBOT, new) if difference[0] == "link"
    }
    assert kinds == {("boom", "added"), ("arm", "removed")}


def renamed_elements(old: str, new: str) -> dict[str, str]:
    """Return the new names of renamed links and joints, by old name."""
    return {
        str(difference.old): difference.name
        for difference in compare_texts(old, new).differences
        if difference.kind == "renamed"
    }


def link(name: str, shape: str = "", mass: float = 0.0) -> str:
    inertia = f'<inertia ixx="{mass}" iyy="{mass}" izz="{mass}" ixy="0" ixz="0" iyz="0"/>'
    inertial = f'<inertial><mass value="{mass}"/>{inertia}</inertial>'
    visual = f"<visual><geometry>{shape}</geometry></visual>" if shape else ""
    return f'<link name="{name}">{inertial if mass else ""}{visual}</link>'


def joint(parent: str, child: str, name: str = "", xyz: str = "0 0 0", kind: str = "fixed") -> str:
    axes = '<limit effort="1" velocity="1"/>' if kind == "prismatic" else ""
    return (
        f'<joint name="{name or child + "_joint"}" type="{kind}"><origin xyz="{xyz}"/><parent link="{parent}"/>'
        f'<child link="{child}"/>{axes}</joint>'
    )


def robot_text(*parts: str) -> str:
    return f'<robot name="r">{link("base")}{"".join(parts)}</robot>'


MESH, OTHER_MESH, BOX = '<mesh filename="a.stl"/>', '<mesh filename="b.stl"/>', '<box size="1 2 3"/>'


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        pytest.param(
            (link("camera"), joint("base", "camera")),
            (link("camera_link"), joint("base", "camera_link", xyz="0 0 1")),
            {"camera": "camera_link", "camera_joint": "camera_link_joint"},
            id="frame whose name has the same words",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm")),
            (link("boom", MESH), joint("base", "boom", xyz="0 0 1")),
            {"arm": "boom", "arm_joint": "boom_joint"},
            id="same mesh below the same link",
        ),
        pytest.param(
            (link("mount"), joint("base", "mount"), link("arm", MESH), joint("mount", "arm")),
            (link("riser"), joint("base", "riser", xyz="0 0 1"), link("arm", MESH), joint("riser", "arm", "arm_joint")),
            {"mount": "riser", "mount_joint": "riser_joint"},
            id="same parent and same children",
        ),
        pytest.param(
            (link("arm", MESH, 1), joint("base", "arm", "shoulder")),
            (link("boom", MESH, 2), joint("base", "boom", "shoulder", "0 0 1")),
            {"arm": "boom"},
            id="same joint, and another mass",
        ),
        pytest.param(
            (link("pole"), joint("base", "pole"), link("arm", MESH, 2), joint("pole", "arm")),
            (link("pole"), joint("base", "pole"), link("boom", MESH, 2), joint("base", "boom")),
            {"arm": "boom", "arm_joint": "boom_joint"},
            id="same mesh and inertial below another link",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm"), link("tip"), joint("arm", "tip")),
            (link("boom", MESH), joint("base", "boom", xyz="0 0 1"), link("tip_frame"),
             joint("boom", "tip_frame", xyz="1 0 0")),
            {"arm": "boom", "arm_joint": "boom_joint", "tip": "tip_frame", "tip_joint": "tip_frame_joint"},
            id="a chain, from its start on",
        ),
        pytest.param(
            (link("left_wheel", MESH), joint("base", "left_wheel"),
             link("right_wheel", MESH), joint("base", "right_wheel")),
            (link("wheel_left", MESH), joint("base", "wheel_left", xyz="0 1 0"),
             link("wheel_right", MESH), joint("base", "wheel_right", xyz="0 -1 0")),
            {"left_wheel": "wheel_left", "right_wheel": "wheel_right", "left_wheel_joint": "wheel_left_joint",
             "right_wheel_joint": "wheel_right_joint"},
            id="equal parts with words for their sides",
        ),
    ],
)  # fmt: skip
def test_renamed_parts_that_moved_are_recognized(old, new, expected):
    assert renamed_elements(robot_text(*old), robot_text(*new)) == expected


@pytest.mark.parametrize(
    ("old", "new"),
    [
        pytest.param(
            (link("imu"), joint("base", "imu")),
            (link("gps"), joint("base", "gps", xyz="0 0 1")),
            id="frames of other words",
        ),
        pytest.param(
            (link("world"), joint("world", "base")),
            (link("foot"), joint("foot", "base")),
            id="the world",
        ),
        pytest.param(
            (link("foot"), joint("foot", "pole"), link("pole"), joint("pole", "base")),
            (link("mast"), joint("mast", "tower", xyz="1 0 0"), link("tower"), joint("tower", "base", xyz="0 0 1")),
            id="a root without the same children",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm")),
            (link("boom", OTHER_MESH), joint("base", "boom", xyz="0 0 1")),
            id="another mesh",
        ),
        pytest.param(
            (link("a_box", BOX, 1), joint("base", "a_box")),
            (link("crate", BOX, 1), joint("base", "crate", xyz="0 0 1")),
            id="a plain shape",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm")),
            (link("boom", MESH), joint("base", "boom", kind="floating")),
            id="another type of joint",
        ),
        pytest.param(
            (link("camera_left", MESH, 1), joint("base", "camera_left")),
            (link("camera_right", MESH, 1), joint("base", "camera_right", xyz="0 0 1")),
            id="the other side",
        ),
        pytest.param(
            (link("leg1", MESH, 1), joint("base", "leg1")),
            (link("leg2", MESH, 1), joint("base", "leg2", xyz="0 0 1")),
            id="another number",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm")),
            (link("boom", MESH), joint("base", "boom", xyz="0 0 1"),
             link("jib", MESH), joint("base", "jib", xyz="0 1 0")),
            id="two new candidates",
        ),
        pytest.param(
            (link("arm", MESH), joint("base", "arm"), link("leg", MESH), joint("base", "leg")),
            (link("boom", MESH), joint("base", "boom", xyz="0 0 1")),
            id="two old candidates",
        ),
    ],
)  # fmt: skip
def test_other_parts_in_the_place_of_removed_ones_are_not_renamed(old, new):
    assert renamed_elements(robot_text(*old), robot_text(*new)) == {}


def test_renamed_joint_between_the_same_links_is_recognized():
    new = ROBOT.replace('"wrist"', '"flange"').replace(
        '<parent link="arm"/>', '<origin xyz="1 0 0"/><parent link="arm"/>'
    )
    assert [difference[:4] for difference in differences_between(ROBOT, new)] == [
        ("joint", "flange", "renamed", "name"),
        ("joint", "flange", "changed", "origin xyz"),
    ]


def test_renamed_joint_that_attaches_the_same_link_to_another_parent_is_recognized():
    old = robot_text(link("pole"), joint("base", "pole"), link("imu"), joint("base", "imu", "imu_joint"))
    new = robot_text(link("pole"), joint("base", "pole"), link("imu"), joint("pole", "imu", "imu_mount", "0 0 1"))
    assert [difference[:4] for difference in differences_between(old, new)] == [
        ("joint", "imu_mount", "renamed", "name"),
        ("joint", "imu_mount", "changed", "parent"),
        ("joint", "imu_mount", "changed", "origin xyz"),
    ]


@pytest.mark.parametrize(("new_name", "is_renamed"), [("car/back_left_wheel", True), ("wagon/back_left_wheel", False)])
def test_moved_link_with_the_new_prefix_of_all_others_is_renamed(new_name, is_renamed):
    def make_robot(prefix: str, wheel: str, mount: str, xyz: str) -> str:
        names = ("laser", "front_left_wheel", "back_right_wheel")
        links = [link(prefix + name) for name in names]
        joints = [joint("base", prefix + name, name=f"base_to_{name}") for name in names]
        return robot_text(*links, *joints, link(wheel), joint("base", wheel, name=mount, xyz=xyz))

    old = make_robot("", "back_left_wheel", "mount", "1 0 0")
    new = make_robot("car/", new_name, "$holder", "2 0 0")
    assert ("back_left_wheel" in renamed_elements(old, new)) is is_renamed


def test_many_equal_parts_are_not_renamed():
    def many(prefix: str) -> str:
        return robot_text(
            *(
                link(f"{prefix}{number}", MESH) + joint("base", f"{prefix}{number}", xyz=f"0 {len(prefix)} {number}")
                for number in range(400)
            )
        )

    assert renamed_elements(many("a_"), many("wheel_b_")) == {}


def test_locations_are_attributes_in_both_files():
    new = ROBOT.replace('  <link name="hand"/>\n', '\n  <link name="hand"/>\n').replace('upper="1"', 'upper="2"')
    [difference] = compare_texts(ROBOT, new).differences
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
    comparison = compare_texts(xacro, xacro.replace('mass="1"', 'mass="2"'))
    text = as_text(comparison, lambda file: file.strip("<>"))
    assert text == (
        "link 'a': inertial mass 1 -> 2 kg\n"
        "  robot_description:3:49 called at robot_description:6:3 -> "
        "robot_description:3:49 called at robot_description:6:3\n"
        "1 difference\n"
    )


@pytest.mark.parametrize(
    ("color", "expected"),
    [
        ("0.2 0.2 0.2 1", []),
        (
            "0.2 0.2 0.9 1",
            [("visual 1 color rgba", "0.2 0.2 0.2 1", "0.2 0.2 0.9 1"), ("visual 1 material", "grey", None)],
        ),
    ],
)
def test_a_material_that_loses_its_name_and_keeps_its_color_looks_the_same(color, expected):
    text = '<material name="{}"><color rgba="{}"/></material></visual>\n    <visual><origin'
    old, new = (
        ROBOT.replace("</visual>\n    <visual><origin", text.format(*values))
        for values in (("grey", "0.2 0.2 0.2 1"), ("", color))
    )
    found = [difference[3:] for difference in differences_between(old, new)]
    assert sorted(found) == expected


@pytest.mark.parametrize(
    ("name", "text", "is_same"),
    [
        ("a.dae", "<a>\n  <p>1 2\n</p></a>\n", True),
        ("a.dae", "<a><p>12</p></a>", False),
        ("a.dae", "<a><p>1 2</p></a><b/>", False),
        ("a.obj", "<a>\n<p>1 2</p></a>", False),
    ],
)
def test_the_formatting_of_collada_files_is_no_content(tmp_path, name, text, is_same):
    files = tmp_path / name, tmp_path / f"new_{name}"
    files[0].write_text("<a><p>1 2</p></a>")
    files[1].write_text(text)
    assert has_same_contents(*files) == is_same
