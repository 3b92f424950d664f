"""The reader.

The tests cover defaults, urdfdom's rules for links, materials, axes and versions, and other elements.
"""

from __future__ import annotations

from math import inf, pi

import pytest

from linkwright.diagnostics import Severity
from linkwright.geometry.single import pose_quaternion
from linkwright.urdf import Box, Capsule, Limit, Mimic, Pose, read
from linkwright.xmltree import Document, Element, parse
from tests.imports import loaded_by, rooms_of
from tests.urdf.robots import chain_of_links, robot_text

BOX = '<geometry><box size="1 2 3"/></geometry>'


def read_text(*parts, version=None):
    return read(parse(robot_text(*parts, version=version), "robot.urdf"))


def read_robot_of(*parts, version=None):
    result = read_text(*parts, version=version)
    assert result.robot is not None, result.diagnostics
    return result.robot


def joint_text(inside="", kind="revolute", version=None):
    return read_robot_of(chain_of_links(f"{kind}:{inside}"), version=version).joints["j0"]


def diagnostic_codes(result):
    return [diagnostic.code for diagnostic in result.diagnostics]


def visual_text(inside, version=None):
    return read_text(f'<link name="a"><visual>{inside}</visual></link>', version=version)


class TestDefaults:
    def test_link_has_no_parts_by_default(self):
        link = read_robot_of('<link name="a"/>').links["a"]
        assert (link.inertial, link.visuals, link.collisions) == (None, (), ())

    def test_joint_is_read(self):
        read_joint = joint_text(kind="continuous")
        assert read_joint.origin == Pose()
        assert read_joint.axis == (1, 0, 0)
        assert read_joint.limit is read_joint.mimic is read_joint.safety is read_joint.dynamics is None

    def test_axis_tag_without_xyz_is_zero(self):
        assert joint_text("<axis/>", "continuous").axis == (0, 0, 0)

    def test_axis_is_not_normalized(self):
        assert joint_text('<axis xyz="0 0 2"/>', "continuous").axis == (0, 0, 2)

    @pytest.mark.parametrize("kind", ["fixed", "floating"])
    def test_axis_of_fixed_and_floating_joints_is_ignored(self, kind):
        assert joint_text('<axis xyz="nonsense"/>', kind).axis == (1, 0, 0)

    def test_limit_defaults_to_zero_bounds(self):
        assert joint_text('<limit effort="1" velocity="2"/>').limit == Limit(0, 0, 1, 2)

    def test_limit_of_fixed_joint_is_read(self):
        assert joint_text('<limit effort="1" velocity="2"/>', "fixed").limit == Limit(0, 0, 1, 2)

    def test_mimic_has_default_multiplier_and_offset(self):
        assert joint_text('<mimic joint="x"/>', "continuous").mimic == Mimic("x", 1, 0)

    def test_origin_without_xyz_has_zero_position(self):
        assert joint_text('<origin rpy="0 0 1"/>').origin == Pose((0, 0, 0), (0, 0, 1))


class TestLenience:
    """Text that urdfdom reads without complaint."""

    @pytest.mark.parametrize(
        "inside",
        [
            '<limit lower="1" upper="-1" effort="-1" velocity="0"/>',
            '<axis xyz="0 0 0"/>',
            '<mimic joint=""/>',
            '<limit effort="1" velocity="1" extra="x"/><unknown/>',
            '<limit effort="1" velocity="1"/><limit effort="x"/>',
        ],
    )
    def test_joint_is_read(self, inside):
        assert not any(
            d.severity is Severity.ERROR for d in read_text(chain_of_links(f"revolute:{inside}")).diagnostics
        )

    @pytest.mark.parametrize(
        "shape",
        [
            '<sphere radius="-1"/>',
            '<box size="0 0 0"/>',
            '<mesh filename=""/>',
            '<mesh filename="x.stl" scale="0 -1 1"/>',
            '<sphere radius="1"/><cube/>',
        ],
    )
    def test_unusual_shapes_are_accepted(self, shape):
        result = visual_text(f"<geometry>{shape}</geometry>")
        assert not result.diagnostics
        assert len(result.robot.links["a"].visuals) == 1

    def test_empty_robot_name_is_accepted(self):
        assert read(parse('<robot name=""><link name="a"/></robot>', "x")).robot.name == ""

    def test_single_link_may_be_unnamed(self):
        result = read_text('<link><visual name="lost"/></link>')
        assert result.robot.root == ""
        assert result.robot.links[""].visuals == ()

    def test_two_unnamed_materials_are_rejected(self):
        assert read_text('<material/><material/><link name="a"/>').robot is None

    def test_negative_mass_is_accepted(self):
        inertia = '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>'
        link = read_robot_of(f'<link name="a"><inertial><mass value="-1"/>{inertia}</inertial></link>').links["a"]
        assert link.inertial.mass == -1


class TestTruncation:
    """After a bad part of a link, later parts are lost.

    The order is inertial, visuals, collisions.
    """

    GOOD_VISUAL, GOOD_COLLISION = f"<visual>{BOX}</visual>", f"<collision>{BOX}</collision>"
    INERTIAL = '<inertial><mass value="{}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>'

    def parts(self, inside):
        link = read_robot_of(f'<link name="a">{inside}</link>').links["a"]
        return link.inertial is not None, len(link.visuals), len(link.collisions)

    def test_valid_link_keeps_all_parts(self):
        assert self.parts(self.GOOD_COLLISION + self.GOOD_VISUAL + self.INERTIAL.format(1)) == (True, 1, 1)

    def test_malformed_inertial_drops_visuals_and_collisions(self):
        assert self.parts(self.GOOD_COLLISION + self.GOOD_VISUAL + self.INERTIAL.format("x")) == (False, 0, 0)

    def test_malformed_visual_drops_later_visuals_and_collisions(self):
        inside = self.GOOD_COLLISION + self.GOOD_VISUAL + "<visual/>" + self.GOOD_VISUAL + self.INERTIAL.format(1)
        assert self.parts(inside) == (True, 1, 0)

    def test_malformed_collision_drops_later_collisions(self):
        inside = self.GOOD_COLLISION + "<collision/>" + self.GOOD_COLLISION + self.GOOD_VISUAL + self.INERTIAL.format(1)
        assert self.parts(inside) == (True, 1, 1)


class TestMaterials:
    RED, GREEN = (1, 0, 0, 1), (0, 1, 0, 1)

    @staticmethod
    def material(name, rgba=None):
        color = f'<color rgba="{" ".join(map(str, rgba))}"/>' if rgba else ""
        return f'<material name="{name}">{color}</material>'

    def link(self, name, material):
        return f'<link name="{name}"><visual>{BOX}{material}</visual></link>'

    @staticmethod
    def color(read_robot, link):
        material = read_robot.links[link].visuals[0].material
        return material and material.rgba

    def two_links(self, *parts):
        return read_robot_of(*parts, '<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>')

    def test_global_material_may_follow_its_use(self):
        read_robot = read_robot_of(self.link("a", self.material("m")), self.material("m", self.RED))
        assert self.color(read_robot, "a") == self.RED

    def test_global_material_overrides_color_of_visual(self):
        read_robot = read_robot_of(self.material("m", self.RED), self.link("a", self.material("m", self.GREEN)))
        assert self.color(read_robot, "a") == self.RED

    def test_first_link_that_defines_material_wins(self):
        read_robot = self.two_links(
            self.link("a", self.material("m", self.RED)), self.link("b", self.material("m", self.GREEN))
        )
        assert self.color(read_robot, "b") == self.RED
        assert list(read_robot.materials) == ["m"]

    def test_later_link_may_use_material_of_earlier_link(self):
        read_robot = self.two_links(self.link("a", self.material("m", self.RED)), self.link("b", self.material("m")))
        assert self.color(read_robot, "b") == self.RED

    def test_earlier_link_cannot_use_material_of_later_link(self):
        read_robot = self.two_links(self.link("a", self.material("m")), self.link("b", self.material("m", self.RED)))
        assert self.color(read_robot, "a") is None
        assert read_robot.links["a"].visuals[0].material_name == "m"

    def test_unnamed_material_belongs_to_its_visual(self):
        read_robot = self.two_links(self.link("a", self.material("", self.RED)), self.link("b", self.material("")))
        assert self.color(read_robot, "a") == self.RED
        assert self.color(read_robot, "b") is None
        assert read_robot.materials == {}

    def test_texture_defines_material(self):
        textured = '<material name="m"><texture filename="wood.png"/></material>'
        assert read_robot_of(self.link("a", textured)).links["a"].visuals[0].material.texture == "wood.png"

    def test_dropped_visual_defines_no_material(self):
        lost = f'<link name="a"><visual><geometry/>{self.material("m", self.RED)}</visual></link>'
        assert read_robot_of(lost).materials == {}


class TestVersions:
    @pytest.mark.parametrize("version", ["1.0", "1.1", "1.2", " 1.0", "+1.0", "01.00"])
    def test_supported_versions_are_accepted(self, version):
        assert read_text('<link name="a"/>', version=version).robot is not None

    @pytest.mark.parametrize(
        "version", ["", "1", "1.", ".1", "1.0.0", "1.3", "0.9", "2.0", "-1.0", "1.-1", "1.0 ", "a.b"]
    )
    def test_malformed_and_unsupported_versions_are_rejected(self, version):
        assert read_text('<link name="a"/>').robot is not None
        text = f'<robot name="r" version="{version}"><link name="a"/></robot>'
        assert diagnostic_codes(read(parse(text, "x"))) == ["URDF104"]

    def test_capsule_requires_version_1_1(self):
        capsule = '<geometry><capsule radius="1" length="2"/></geometry>'
        assert visual_text(capsule, "1.1").robot.links["a"].visuals[0].geometry == Capsule(1, 2)
        assert visual_text(capsule, "1.0").robot.links["a"].visuals == ()

    def test_sizes_must_be_positive_since_1_2(self):
        sphere = '<geometry><sphere radius="-1"/></geometry>'
        assert len(visual_text(sphere, "1.1").robot.links["a"].visuals) == 1
        assert visual_text(sphere, "1.2").robot.links["a"].visuals == ()

    def test_quaternion_origin_is_read_since_1_1(self):
        turned = joint_text('<origin xyz="1 2 3" quat_xyzw="0 0 2 2"/>', "fixed", "1.1").origin
        assert turned.xyz == (1, 2, 3)
        assert pose_quaternion(turned) == pytest.approx((0, 0, 0.5**0.5, 0.5**0.5))
        assert turned.rpy == pytest.approx((0, 0, pi / 2))

    def test_zero_quaternion_is_identity(self):
        assert pose_quaternion(joint_text('<origin quat_xyzw="0 0 0 0"/>', "fixed", "1.1").origin) == (0, 0, 0, 1)

    def test_quaternion_with_three_numbers_is_rejected(self):
        result = read_text(chain_of_links('fixed:<origin quat_xyzw="0 0 1"/>'), version="1.1")
        assert (result.robot, diagnostic_codes(result)) == (None, ["URDF122"])

    def test_limits_default_to_infinity_since_1_2(self):
        assert joint_text("<limit/>", "continuous", "1.2").limit == Limit(-inf, inf, inf, inf)

    def test_deceleration_defaults_to_acceleration(self):
        limit = joint_text('<limit lower="0" upper="1" acceleration="5"/>', version="1.2").limit
        assert (limit.acceleration, limit.deceleration, limit.jerk) == (5, 5, None)

    def test_limit_attributes_of_1_2_are_ignored_before(self):
        result = read_text(chain_of_links('revolute:<limit effort="1" velocity="1" jerk="nonsense"/>'))
        assert diagnostic_codes(result) == ["URDF171"]
        assert result.robot.joints["j0"].limit == Limit(0, 0, 1, 1)

    @pytest.mark.parametrize("name", ["effort", "velocity", "acceleration", "deceleration", "jerk"])
    def test_negative_limits_are_rejected_since_1_2(self, name):
        assert (
            read_text(chain_of_links(f'revolute:<limit lower="0" upper="1" {name}="-1"/>'), version="1.2").robot is None
        )


class TestExtensionElements:
    def test_extension_elements_are_kept_in_order(self):
        result = read_robot_of('<gazebo reference="a"/>', '<link name="a"/>', "<transmission/>", "<ros2_control/>")
        assert [element.tag for element in result.extensions] == ["gazebo", "transmission", "ros2_control"]

    def test_links_and_joints_keep_file_order(self):
        ends = '<parent link="z"/><child link="{}"/>'
        result = read_robot_of(
            '<link name="z"/><link name="b"/><link name="a"/>',
            f'<joint name="y" type="fixed">{ends.format("b")}</joint>',
            f'<joint name="x" type="fixed">{ends.format("a")}</joint>',
        )
        assert list(result.links) == ["z", "b", "a"]
        assert list(result.joints) == ["y", "x"]
        assert result.root == "z"

    def test_robot_parts_refer_to_their_elements(self):
        result = read_robot_of(f'<link name="a"><visual>{BOX}</visual></link>')
        assert result.links["a"].visuals[0].element.tag == "visual"
        assert result.links["a"].visuals[0].geometry == Box((1, 2, 3))

    def test_finding_of_generated_element_has_no_span(self):
        result = read(Document(Element("robot", {"name": "r"})))
        assert diagnostic_codes(result) == ["URDF106"]
        assert result.diagnostics[0].span is None

    def test_findings_are_in_text_order(self):
        result = read_text('\n<link name="a"/>', '\n<link name="a"/>', '\n<material name="m"/>', '\n<link name="b"/>')
        lines = [diagnostic.span.line for diagnostic in result.diagnostics]
        assert lines == sorted(lines)
        assert len(lines) == 3

    def test_file_with_only_macros_has_hint_to_call_one(self):
        text = (
            '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">'
            '<xacro:macro name="arm" params="side"/></robot>'
        )
        document = parse(text, "arm.xacro")
        document.root.children.clear()
        assert "call one there, <xacro:arm .../>" in read(document).diagnostics[0].hint

    def test_deep_chain_is_read(self):
        count = 3000
        links = "".join(f'<link name="l{n}"/>' for n in range(count))
        joints = "".join(
            f'<joint name="j{n}" type="fixed"><parent link="l{n - 1}"/><child link="l{n}"/></joint>'
            for n in range(1, count)
        )
        assert len(read_robot_of(links, joints).joints) == count - 1


def test_reader_imports_only_required_modules():
    loaded = loaded_by("from linkwright.urdf import read")
    slow = {"contextlib", "dataclasses", "inspect", "pathlib", "typing", "warnings", "xml.parsers"}
    assert not slow & loaded
    assert rooms_of(loaded) == {"diagnostics", "files", "geometry", "loading", "schema", "urdf", "xmltree"}
    assert not {f"linkwright.urdf.{seldom}" for seldom in ("gv", "listing", "writer")} & loaded
