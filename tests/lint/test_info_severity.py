"""Findings that are information if the author may intend them, compared with warnings."""

from __future__ import annotations

import struct

import pytest

from linkwright.lint.engine import examine
from linkwright.lint.settings import Settings

BOX = '<geometry><box size="0.1 0.1 0.01"/></geometry>'
ARM = '<link name="arm"/><joint name="arm_joint" type="fixed"><parent link="base"/><child link="arm"/></joint>'
WHEEL = """<link name="{0}_wheel"/><joint name="{0}_wheel_joint" type="continuous">
<origin xyz="0 {1} 0"/><parent link="base"/><child link="{0}_wheel"/><axis xyz="0 {1} 0"/></joint>"""
WHEELS = WHEEL.format("left", 1) + WHEEL.format("right", -1)
DRIVEN = "<ros2_control>{}</ros2_control>".format(
    "".join(
        f'<joint name="{side}_wheel_joint"><command_interface name="velocity"/></joint>' for side in ("left", "right")
    )
)
STATE_INTERFACES_ONLY = DRIVEN.replace("command_interface", "state_interface")
PLUGIN_ELEMENT = """<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so">
<left_joint>left_wheel_joint</left_joint>
<right_joint>right_wheel_joint</right_joint></plugin></gazebo>"""


@pytest.fixture
def find_severity(tmp_path):
    """Return the severity of a rule's only finding about a robot.

    The robot has a link ``base`` and other elements.
    """

    def check(code, inside):
        (tmp_path / "r.urdf").write_text(f'<robot name="r"><link name="base"/>{inside}</robot>')
        findings = examine(tmp_path / "r.urdf", settings=Settings(select=(code,))).diagnostics
        (only_finding,) = [finding for finding in findings if finding.code == code]
        return only_finding.severity.name

    return check


def surface_text(name, inside="<mu1>1</mu1>"):
    return f'<gazebo reference="{name}">{inside}</gazebo>'


@pytest.mark.parametrize(
    ("gazebo", "severity"),
    [
        (surface_text("base") + surface_text("arm") + surface_text("camera"), "INFO"),
        (surface_text("base") + surface_text("arm") + surface_text("camera", ""), "INFO"),
        (surface_text("base") + surface_text("camera"), "WARNING"),
        (surface_text("base") + surface_text("arm") + surface_text("arm_lnk"), "WARNING"),
        (surface_text("base") + surface_text("arm") + surface_text("{name}_foot"), "WARNING"),
        (
            surface_text("base") + surface_text("arm") + surface_text("camera", '<sensor name="s" type="camera"/>'),
            "WARNING",
        ),
        (
            surface_text("base")
            + surface_text("arm")
            + surface_text("tool", "<preserveFixedJoint>true</preserveFixedJoint>"),
            "WARNING",
        ),
    ],
)
def test_gazebo_surface_of_unknown_link_is_an_info(find_severity, gazebo, severity):
    assert find_severity("LW120", ARM.replace("arm", "arm_link") + ARM + gazebo) == severity


def moving_link(mass):
    inertial = f'<inertial><mass value="{mass}"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    joint = '<joint name="j" type="continuous"><parent link="base"/><child link="part"/></joint>'
    return f'<link name="part"><visual>{BOX}</visual>{inertial}</link>{joint}'


@pytest.mark.parametrize(("mass", "severity"), [("3", "INFO"), ("3.2", "WARNING"), ("20", "WARNING")])
def test_round_mass_of_small_part_is_an_info(find_severity, mass, severity):
    assert find_severity("LW320", moving_link(mass)) == severity


@pytest.mark.parametrize(("mass", "severity"), [("20.5", "INFO"), ("205", "WARNING")])
def test_high_density_of_fixed_part_is_an_info(find_severity, mass, severity):
    assert find_severity("LW320", moving_link(mass).replace("continuous", "fixed")) == severity


@pytest.mark.parametrize(
    ("extra_text", "severity"),
    [("", "INFO"), (STATE_INTERFACES_ONLY, "INFO"), (DRIVEN, "WARNING"), (PLUGIN_ELEMENT, "WARNING")],
)
def test_opposing_wheels_are_warning_only_if_driven(find_severity, extra_text, severity):
    assert find_severity("LW643", WHEELS + extra_text) == severity


@pytest.mark.parametrize(("triangles", "severity"), [(40_000, "INFO"), (40_001, "WARNING")])
def test_collision_mesh_above_40000_triangles_is_a_warning(find_severity, tmp_path, triangles, severity):
    triangle = struct.pack("<12fH", *([0.0] * 3), 0, 0, 0, 1, 0, 0, 0, 1, 1, 0)
    (tmp_path / "a.stl").write_bytes(bytes(80) + struct.pack("<I", triangles) + triangle * triangles)
    mesh = '<link name="a"><collision><geometry><mesh filename="a.stl"/></geometry></collision></link>'
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="a"/></joint>'
    assert find_severity("LW435", mesh + joint) == severity


@pytest.mark.parametrize(
    ("name", "end", "severity"),
    [("imu", 0, "INFO"), ("ft_sensor", 0, "INFO"), ("imu", 1, "WARNING"), ("limuzin", 0, "WARNING")],
)
def test_locked_sensor_joint_is_an_info(find_severity, name, end, severity):
    joint = f'<joint name="{name}_joint" type="revolute"><parent link="base"/><child link="{name}_link"/>'
    limit = f'<axis xyz="0 0 1"/><limit lower="{end}" upper="{end}" effort="1" velocity="1"/></joint>'
    assert find_severity("LW202", f'<link name="{name}_link"/>{joint}{limit}') == severity


@pytest.mark.parametrize(("extra_text", "severity"), [("", "WARNING"), (f"<visual>{BOX}</visual>", "INFO")])
def test_footprint_that_is_whole_body_is_an_info(find_severity, extra_text, severity):
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="base_footprint"/></joint>'
    link = f'<link name="base_footprint"><collision>{BOX.replace("0.01", "1")}</collision>{extra_text}</link>'
    assert find_severity("LW623", joint + link) == severity


@pytest.mark.parametrize(
    ("name", "text", "severity"),
    [
        ("a.world", '<sdf version="1.6"><!-- a -- b --><world name="w"/></sdf>', "INFO"),
        ("a.urdf", '<robot name="r"><!-- a -- b --><link name="l"/></robot>', "WARNING"),
    ],
)
def test_malformed_xml_comment_in_world_is_an_info(tmp_path, name, text, severity):
    (tmp_path / name).write_text(text)
    findings = examine(tmp_path / name, settings=Settings()).diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "XML206"] == [severity]


@pytest.mark.parametrize(("second", "severity"), [("0.8 0.8 0.8 1", "INFO"), ("0.7 0.7 0.9 1", "WARNING")])
def test_similar_color_of_same_material_is_an_info(find_severity, second, severity):
    gray = '<visual>{}<material name="grey"><color rgba="{}"/></material></visual>'
    visuals = "".join(gray.format(BOX, color) for color in ("0.7 0.7 0.7 1", second))
    assert find_severity("LW501", moving_link("3").replace("<inertial>", visuals + "<inertial>")) == severity


@pytest.mark.parametrize(("kind", "severity"), [("fixed", "INFO"), ("continuous", "WARNING")])
def test_missing_shapes_of_fixed_frames_are_an_info(find_severity, kind, severity):
    assert find_severity("LW102", ARM.replace("fixed", kind)) == severity


@pytest.mark.parametrize(("name", "severity"), [("叶片", "INFO"), ("left arm", "WARNING")])
def test_non_ascii_mesh_name_is_an_info_and_blank_is_a_warning(find_severity, name, severity):
    mesh = f'<visual><geometry><mesh filename="package://p/{name}.stl"/></geometry></visual>'
    assert find_severity("LW427", f'{ARM}<link name="b">{mesh}</link>') == severity


@pytest.mark.parametrize(
    ("names", "used_name", "severity"),
    [
        ("d4_depth_px d4_depth_py d4_depth_pz", 2, "INFO"),
        ("d4_depth_px d4_depth_py d4_depth_pz", 1, "WARNING"),
        ("d4_depth_px d4_depth_py d4_depth_pz d4_depth_qx d4_depth_qy", 2, "WARNING"),
        ("depth_px depth_py depth_pz", 2, "WARNING"),
        ("d4_wheel_radios d4_wheel_radius d4_wheel_width", 2, "WARNING"),
    ],
)
def test_unused_property_of_dimension_table_is_an_info(tmp_path, names, used_name, severity):
    first, *other_names = names.split()
    text = "".join(f'<xacro:property name="{name}" value="0.2"/>' for name in (first, *other_names))
    links = "".join(f'<link name="l_${{{name}}}_{name}"/>' for name in other_names[:used_name])
    prefix = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
    (tmp_path / "r.urdf.xacro").write_text(f'<robot name="r" {prefix}>{text}{links}</robot>')
    findings = examine(tmp_path / "r.urdf.xacro", settings=Settings(select=("LW701",))).diagnostics
    assert [finding.severity.name for finding in findings if f"'{first}'" in str(finding.message)] == [severity]


@pytest.mark.parametrize(("depends", "severity"), [("gazebo_ros", "INFO"), ("ros_gz_sim", "WARNING")])
def test_world_named_world_is_an_info_for_gazebo_classic(tmp_path, depends, severity):
    manifest = f"<package><name>p</name><exec_depend>{depends}</exec_depend></package>"
    (tmp_path / "package.xml").write_text(manifest)
    (tmp_path / "worlds").mkdir()
    (tmp_path / "worlds" / "w.world").write_text('<sdf version="1.6"><world name="world"/></sdf>')
    findings = examine(tmp_path / "worlds" / "w.world").diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "SDF111"] == [severity]


@pytest.mark.parametrize(("beside", "severity"), [('<mujoco model="r"/>', "INFO"), ("<launch/>", "WARNING")])
def test_relative_mesh_path_beside_mujoco_model_is_an_info(find_severity, tmp_path, beside, severity):
    (tmp_path / "package.xml").write_text("<package><name>p</name></package>")
    (tmp_path / "r.xml").write_text(f"<!-- made by hand -->\n{beside}")
    mesh = '<visual><geometry><mesh filename="assets/a.stl"/></geometry></visual>'
    assert find_severity("LW421", f'{ARM}<link name="b">{mesh}</link>') == severity


@pytest.mark.parametrize(
    ("extra_text", "shape", "severity"),
    [("", "", "INFO"), ("<gazebo/>", "", "WARNING"), ("", f"<visual>{BOX}</visual>", "WARNING")],
)
def test_missing_inertial_without_shape_and_simulator_is_an_info(find_severity, extra_text, shape, severity):
    robot = moving_link("3") + f'<link name="command">{shape}</link>'
    joint = '<joint name="k" type="continuous"><parent link="base"/><child link="command"/></joint>'
    assert find_severity("LW301", robot + joint + extra_text) == severity
