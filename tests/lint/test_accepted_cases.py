"""Cases that rules ignore on purpose, compared with cases that they report."""

from __future__ import annotations

import pytest

from linkwright.lint.engine import examine, examine_package
from linkwright.lint.settings import Settings
from tests.lint.manifest import MANIFEST

PREFIX = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
BOX = '<visual><geometry><box size="{0} {0} {0}"/></geometry></visual>'


@pytest.fixture
def find_codes(tmp_path):
    """Return the codes of the findings about a robot's text, with other files in its folder."""

    def check(text, *selectors, name="r.urdf", **files):
        for file, content in files.items():
            (tmp_path / file.replace("_dot_", ".")).write_text(content)
        (tmp_path / name).write_text(text)
        findings = examine(tmp_path / name, settings=Settings(select=selectors)).diagnostics
        return [finding.code for finding in findings if finding.code.startswith(selectors)]

    return check


def robot_text(inside, attributes=""):
    return f'<robot name="r" {attributes}>{inside}</robot>'


def moving_link(name, inside, parent="base", axis="0 0 1"):
    joint = f'<joint name="j_{name}" type="continuous"><parent link="{parent}"/><child link="{name}"/>'
    return f'{joint}<axis xyz="{axis}"/></joint><link name="{name}">{inside}</link>'


def inertial_text(mass, moment, origin='<origin xyz="0 0 0"/>'):
    moments = f'ixx="{moment}" iyy="{moment}" izz="{moment}" ixy="0" ixz="0" iyz="0"'
    return f'<inertial>{origin}<mass value="{mass}"/><inertia {moments}/></inertial>'


@pytest.mark.parametrize(("inside", "codes"), [("", ["LW102"]), (inertial_text(1, 1), [])])
def test_model_with_inertials_needs_no_shapes(find_codes, inside, codes):
    assert find_codes(robot_text(f'<link name="base"/>{moving_link("a", inside)}'), "LW102") == codes


@pytest.mark.parametrize(
    ("axis", "codes"), [("1.2e-16 0 -1", []), ("1.2e-7 0 -1.0000002", []), ("0.0001 0 -1", ["LW224"])]
)
def test_axis_tilted_by_rounding_is_accepted(find_codes, axis, codes):
    assert find_codes(robot_text(f'<link name="base"/>{moving_link("a", "", axis=axis)}'), "LW224") == codes


@pytest.mark.parametrize(("mass", "codes"), [(0.1, []), (300, ["LW320"])])
def test_small_mass_on_small_frame_is_accepted(find_codes, mass, codes):
    shape = BOX.format(0.0063) + '<collision><geometry><box size="0.0063 0.0063 0.0063"/></geometry></collision>'
    assert (
        find_codes(robot_text(f'<link name="base"/>{moving_link("tool", shape + inertial_text(mass, 1e-6))}'), "LW320")
        == codes
    )


@pytest.mark.parametrize(("origin", "codes"), [("", ["LW323"]), ('<origin xyz="0 0 0"/>', ["LW322"])])
def test_center_of_mass_far_from_shapes_is_reported_once(find_codes, origin, codes):
    shape = '<visual><origin xyz="0 0 0.5"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    inside = shape + inertial_text(1, 0.002, origin)
    assert find_codes(robot_text(f'<link name="base"/>{moving_link("a", inside)}'), "LW322", "LW323") == codes


@pytest.mark.parametrize(("moment", "codes"), [("0.002", ["LW315"]), ("0.00{}", ["LW322"] * 3)])
def test_center_of_mass_is_not_reported_beside_copied_inertia(find_codes, moment, codes):
    shape = '<visual><origin xyz="0 0 0.{0}"/><geometry><box size="0.1 0.1 0.{0}"/></geometry></visual>'
    links = (moving_link(f"l{n}", shape.format(n) + inertial_text(1, moment.format(n))) for n in (4, 5, 6))
    assert find_codes(robot_text(f'<link name="base"/>{"".join(links)}'), "LW315", "LW322") == codes


@pytest.mark.parametrize(("root", "codes"), [("world", []), ("floor", ["LW325"])])
def test_inertia_of_link_fixed_to_world_is_accepted(find_codes, root, codes):
    stand = f'<link name="stand">{BOX.format(1)}{inertial_text(1000, 0.01)}</link>'
    joint = f'<joint name="j" type="fixed"><parent link="{root}"/><child link="stand"/></joint>'
    assert find_codes(robot_text(f'<link name="{root}"/>{stand}{joint}'), "LW325") == codes


@pytest.mark.parametrize(("ignored", "codes"), [("*.obj", ["LW424"]), ("meshes/", []), ("*.stl\n!wheel.stl", [])])
def test_missing_mesh_that_git_ignores_is_accepted(find_codes, ignored, codes):
    manifest = "<package format='3'><name>p</name></package>"
    mesh = '<visual><geometry><mesh filename="package://p/meshes/body.stl"/></geometry></visual>'
    files = {"package_dot_xml": manifest, "_dot_gitignore": ignored}
    assert find_codes(robot_text(f'<link name="base">{mesh}</link>'), "LW424", **files) == codes


_HARDWARE = "<hardware><plugin>p/P</plugin></hardware>"


@pytest.mark.parametrize(
    ("inside", "codes"),
    [
        (f'<xacro:if value="false">{_HARDWARE}</xacro:if>', []),
        ('<hardware><xacro:if value="false"><plugin>p/P</plugin></xacro:if></hardware>', []),
        ("<hardware/>", ["LW124"]),
        ("", ["LW124"]),
    ],
)
def test_conditional_hardware_plugin_is_accepted(find_codes, inside, codes):
    control = f'<ros2_control name="c" type="system">{inside}</ros2_control>'
    assert find_codes(robot_text(f'<link name="base"/>{control}', PREFIX), "LW124", name="r.urdf.xacro") == codes


_TRANSMISSION = f'<link name="base"/>{moving_link("a", "")}<transmission name="t"><joint name="j_a"/></transmission>'
_PACKAGE = "<package format='3'><name>arm</name><version>0.1.0</version></package>"


@pytest.mark.parametrize(
    ("control", "codes"), [("", ["LW127"]), (f'<ros2_control name="c" type="system">{_HARDWARE}</ros2_control>', [])]
)
def test_transmissions_beside_ros2_control_are_accepted(find_codes, control, codes):
    assert find_codes(robot_text(_TRANSMISSION + control), "LW127", package_dot_xml=_PACKAGE) == codes


def test_transmissions_outside_package_are_accepted(find_codes):
    assert find_codes(robot_text(_TRANSMISSION), "LW127") == []


@pytest.mark.parametrize(("files", "severity"), [({}, "info"), ({"package.xml": _PACKAGE}, "warning")])
def test_relative_mesh_path_is_a_warning_in_package(tmp_path, files, severity):
    path = tmp_path / "r.urdf"
    path.write_text(robot_text('<link name="a"><visual><geometry><mesh filename="a.stl"/></geometry></visual></link>'))
    for name, text in files.items():
        (tmp_path / name).write_text(text)
    findings = examine(path, settings=Settings(select=("LW421",))).diagnostics
    assert [finding.severity.value for finding in findings if finding.code == "LW421"] == [severity]


@pytest.mark.parametrize(
    ("included", "codes"), [("", []), ('<xacro:macro name="laser"><link name="laser"/></xacro:macro>', ["LW704"])]
)
def test_include_of_empty_file_is_accepted(find_codes, included, codes):
    text = robot_text('<xacro:include filename="more.xacro"/><link name="base"/>', PREFIX)
    files = {"more_dot_xacro": f"<robot {PREFIX}>{included}</robot>"}
    assert find_codes(text, "LW704", name="r.urdf.xacro", **files) == codes


@pytest.mark.parametrize(("name", "codes"), [("map", ["LW624"]), ("$(arg parent)", [])])
def test_fixed_frame_from_argument_is_accepted(find_codes, name, codes):
    text = robot_text(f'<xacro:arg name="parent" default="map"/><link name="{name}"/>', PREFIX)
    assert find_codes(text, "LW624", name="r.urdf.xacro") == codes


_WHEEL = '<xacro:macro name="wheel" params="name prefix"><link name="${name}"/></xacro:macro>'
_ARM = '<xacro:macro name="arm" params="prefix"><link name="${prefix}arm"/></xacro:macro>'


@pytest.mark.parametrize(("extra_text", "codes"), [("", ["LW705"]), (_ARM + '<xacro:arm prefix="l_"/>', [])])
def test_unused_parameter_shared_with_other_macros_is_accepted(find_codes, extra_text, codes):
    text = robot_text(f'{_WHEEL}<xacro:wheel name="w" prefix=""/>{extra_text}', PREFIX)
    assert find_codes(text, "LW705", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(
    ("unused", "hint"),
    [("image_px", "use it with ${...}, or remove it"), ("imge_pz", "rename it to 'image_pz', which is used")],
)
def test_sibling_name_is_not_suggested_for_unused_property(tmp_path, unused, hint):
    properties = "".join(f'<xacro:property name="{name}" value="1"/>' for name in (unused, "image_pz"))
    (tmp_path / "r.urdf.xacro").write_text(robot_text(properties + '<link name="l${image_pz}"/>', PREFIX))
    (finding,) = examine(tmp_path / "r.urdf.xacro", settings=Settings(select=("LW701",))).diagnostics
    assert str(finding.hint).startswith(hint)


@pytest.mark.parametrize(("frame", "codes"), [("link", []), ("base_lnk", ["LW849"])])
def test_fixed_frame_of_another_robot_is_accepted(tmp_path, frame, codes):
    (tmp_path / "package.xml").write_text("<package format='3'><name>p</name></package>")
    (tmp_path / "r.urdf").write_text(robot_text('<link name="base_link"/><link name="link3"/>'))
    (tmp_path / "r.rviz").write_text(f"Visualization Manager:\n  Global Options:\n    Fixed Frame: {frame}\n")
    findings = examine_package(tmp_path, Settings(select=("LW849",))).diagnostics
    assert [finding.code for finding in findings] == codes


@pytest.mark.parametrize(("shape", "codes"), [("", []), ("c", ["LW410"])])
def test_link_between_colliding_links_needs_no_collision(find_codes, shape, codes):
    body = BOX.format(0.2) + '<collision><geometry><box size="0.2 0.2 0.2"/></geometry></collision>'
    leg = moving_link("hip", BOX.format(0.1)) + (
        moving_link("thigh", body, "hip") if not shape else moving_link("thigh", body)
    )
    assert find_codes(robot_text(f'<link name="base">{body}</link>{leg}'), "LW410") == codes


def test_visual_with_zero_size_is_an_info(tmp_path):
    flat_visual = '<visual><geometry><box size="0.1 0 0.1"/></geometry></visual>'
    (tmp_path / "r.urdf").write_text(robot_text(f'<link name="a">{BOX.format(0)}{flat_visual}</link>'))
    findings = examine(tmp_path / "r.urdf", settings=Settings(select=("LW401",))).diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "LW401"] == ["INFO", "WARNING"]


def test_dont_collapse_attribute_of_isaac_gym_is_recognized(find_codes):
    joint = (
        '<joint name="j" type="fixed" dont_collapse="true" origin="0 0 0"><parent link="a"/><child link="b"/></joint>'
    )
    assert find_codes(robot_text(f'<link name="a"/><link name="b"/>{joint}'), "LW108") == ["LW108"]


@pytest.mark.parametrize(("kind", "codes"), [("fixed", ["LW230"]), ("$(arg kind)", [])])
def test_mimic_on_joint_with_type_from_argument_is_accepted(find_codes, kind, codes):
    joint = f'<joint name="r" type="{kind}"><parent link="a"/><child link="c"/><mimic joint="j_b"/></joint>'
    text = f'<xacro:arg name="kind" default="fixed"/><link name="a"/>{moving_link("b", "", "a")}<link name="c"/>{joint}'
    assert find_codes(robot_text(text, PREFIX), "LW230", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(("size", "codes"), [(0.2, []), (8, ["LW321"])])
def test_density_follows_collision_beside_large_visual(find_codes, size, codes):
    shape = BOX.format(8) + f'<collision><geometry><box size="{size} {size} {size}"/></geometry></collision>'
    assert (
        find_codes(robot_text(f'<link name="base"/>{moving_link("a", shape + inertial_text(1, 0.0067))}'), "LW321")
        == codes
    )


@pytest.mark.parametrize(("upper", "codes"), [("0", ["LW202"]), ("1", ["LW205", "LW206", "LW222"])])
def test_joint_without_range_is_reported_once(find_codes, upper, codes):
    joint = '<joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
    joint += f'<limit lower="0" upper="{upper}" effort="0" velocity="0"/></joint><gazebo/>'
    assert sorted(find_codes(robot_text(f'<link name="a"/><link name="b"/>{joint}'), "LW2")) == codes


@pytest.mark.parametrize(("tag", "codes"), [("insert_block", ["LW720"]), ("visual", ["LW705"])])
def test_parameter_of_tag_without_prefix_is_not_reported_as_unused(find_codes, tag, codes):
    inside = f'<xacro:macro name="m" params="*origin"><link name="l"/><{tag} name="origin"/></xacro:macro>'
    call = '<xacro:m><origin xyz="0 0 1"/></xacro:m>'
    assert find_codes(robot_text(inside + call, PREFIX), "LW705", "LW720", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(("extra_text", "severity"), [("", "WARNING"), ("<exec_depend>far</exec_depend>", "INFO")])
def test_mesh_of_declared_missing_package_is_an_info(tmp_path, extra_text, severity):
    mesh = '<link name="l"><visual><geometry><mesh filename="package://far/a.stl"/></geometry></visual></link>'
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=extra_text))
    (tmp_path / "r.urdf").write_text(robot_text(mesh))
    findings = examine(tmp_path / "r.urdf", settings=Settings(select=("LW423",))).diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "LW423"] == [severity]


@pytest.mark.parametrize(
    ("value", "codes"),
    [("3.14159265", []), ("${pi/2}", []), ("1.5708", []), ("0.0174533", []), ("57.29578", []), ("3.2", ["LW701"])],
)
def test_unused_mathematical_constant_is_accepted(find_codes, value, codes):
    text = robot_text(f'<xacro:property name="constant" value="{value}"/><link name="a"/>', PREFIX)
    assert find_codes(text, "LW701", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(("default", "codes"), [("^|false", []), ("^", []), ("false", ["LW705"])])
def test_unused_parameter_with_outer_default_is_accepted(find_codes, default, codes):
    macro = f'<xacro:macro name="m" params="use_sim:={default}"><link name="m"/></xacro:macro>'
    outer_default = '<xacro:property name="use_sim" value="1"/><joint name="${use_sim}"/>'
    text = robot_text(f'{outer_default}<link name="base"/>{macro}<xacro:m/>', PREFIX)
    assert find_codes(text, "LW705", name="r.urdf.xacro") == codes


def test_bare_call_beside_namespaced_call_is_accepted(find_codes):
    chosen = (
        '<xacro:property name="a" value="${xacro.load_yaml(f)}"/><xacro:property name="b" value="${load_yaml(f)}"/>'
    )
    macro_text = f'<xacro:macro name="m" params="f">{chosen}<link name="${{a}}${{b}}"/></xacro:macro>'
    assert find_codes(robot_text(f'<link name="base"/>{macro_text}', PREFIX), "LW714", name="r.urdf.xacro") == []
    without_namespaced_call = macro_text.replace("xacro.load_yaml", "xacro.abs_filename")
    assert find_codes(
        robot_text(f'<link name="base"/>{without_namespaced_call}', PREFIX), "LW714", name="r.urdf.xacro"
    ) == ["LW714"]


@pytest.mark.parametrize(("needs", "codes"), [("q", ["LW724"]), ("p", []), ("helper", [])])
def test_circular_dependency_is_not_requested(tmp_path, needs, codes):
    depend = "<exec_depend>{}</exec_depend>"
    for name, extra_text in (("p", ""), ("q", depend.format(needs)), ("helper", depend.format("p"))):
        (tmp_path / name).mkdir()
        manifest = MANIFEST.format(more=extra_text).replace("<name>p<", f"<name>{name}<")
        (tmp_path / name / "package.xml").write_text(manifest)
    (tmp_path / "q/wheel.xacro").write_text("<robot/>")
    include = '<xacro:include filename="$(find q)/wheel.xacro"/>'
    (tmp_path / "p/r.urdf.xacro").write_text(robot_text(f'{include}<link name="a"/>', PREFIX))
    (tmp_path / "p/launch").mkdir()
    (tmp_path / "p/launch/a.launch.py").write_text("def generate_launch_description():\n    Node(package='q')\n")
    packages = {name: tmp_path / name for name in ("p", "q", "helper")}
    settings = Settings(select=("LW724", "LW848"))
    findings = examine(tmp_path / "p/r.urdf.xacro", packages=packages, settings=settings).diagnostics
    assert [finding.code for finding in findings] == [*codes, *(["LW848"] if codes else [])]


@pytest.mark.parametrize(
    ("inside", "codes"),
    [
        ("<max_contacts>4</max_contacts>", ["LW107"]),
        ("<weight>3</weight>", ["LW107"]),
        ("<arm_origin/>", ["LW107"]),
        ("<acme_controller gain='1'/>", []),
        ("<visual axis='0 0 1'><geometry><sphere radius='1'/></geometry></visual>", ["LW108"]),
        ("<visual acme_layer='2'><geometry><sphere radius='1'/></geometry></visual>", []),
    ],
)
def test_vendor_elements_and_attributes_are_accepted(find_codes, inside, codes):
    assert find_codes(robot_text(f'<link name="base">{inside}</link>'), "LW107", "LW108") == codes


@pytest.mark.parametrize(
    ("lower", "upper", "codes"),
    [(-0.01, 0.088, []), (-0.01, 0.1, ["LW240", "LW240"]), (-0.01, 0.09, ["LW240"]), (-0.05, 0.088, ["LW240"])],
)
def test_small_soft_limit_overrun_of_gripper_is_accepted(find_codes, lower, upper, codes):
    soft = f'soft_lower_limit="{lower}" soft_upper_limit="{upper}"'
    limits = f'<limit lower="0" upper="0.09" effort="1" velocity="1"/><safety_controller k_velocity="1" {soft}/>'
    joint = f'<joint name="j" type="prismatic"><parent link="base"/><child link="a"/>{limits}</joint>'
    assert find_codes(robot_text(f'<link name="base"/><link name="a"/>{joint}'), "LW240") == codes


@pytest.mark.parametrize(
    ("origin", "hint"),
    [
        ("0 0 0.1", "the center of the visuals is at 1.05 2 3.15 in the link frame"),
        ("0 0 0", "give visuals and collisions the same"),
    ],
)
def test_collision_apart_hint_names_center_of_offset_mesh(tmp_path, origin, hint):
    corners = "".join(f"vertex {corner}\n" for corner in ("1 2 3", "1.1 2 3", "1 2 3.1"))
    (tmp_path / "a.stl").write_text(f"solid a\nfacet normal 0 1 0\nouter loop\n{corners}endloop\nendfacet\nendsolid\n")
    visual = '<visual><origin xyz="0 0 0.1"/><geometry><mesh filename="a.stl"/></geometry></visual>'
    collision = f'<collision><origin xyz="{origin}"/><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    (tmp_path / "r.urdf").write_text(robot_text(f'<link name="a">{visual}{collision}</link>'))
    (finding,) = examine(tmp_path / "r.urdf", settings=Settings(select=("LW412",))).diagnostics
    assert str(finding.hint).startswith(hint)


@pytest.mark.parametrize(("size", "codes"), [(60, ["LW433"]), (40, ["LW412", "LW413"])])
def test_mesh_in_millimeters_is_reported_once(find_codes, size, codes):
    facet = f"facet normal 0 0 1\nouter loop\nvertex 5 0 0\nvertex {5 + size} 0 0\nvertex 5 {size} 0\nendloop\nendfacet"
    visual = '<visual><geometry><mesh filename="a.stl"/></geometry></visual>'
    collision = '<collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>'
    text = robot_text(f'<link name="a">{visual}{collision}</link>')
    finding_codes = find_codes(text, "LW412", "LW413", "LW433", a_dot_stl=f"solid a\n{facet}\nendsolid a\n")
    assert sorted(finding_codes) == codes


@pytest.mark.parametrize(("far_shape", "codes"), [(25, ["LW405"]), (2.5, ["LW412"])])
def test_far_shape_is_reported_once(find_codes, far_shape, codes):
    visual = f'<visual><origin xyz="{far_shape} 0 0"/><geometry><box size="1 1 1"/></geometry></visual>'
    collision = '<collision><geometry><box size="1 1 1"/></geometry></collision>'
    assert find_codes(robot_text(f'<link name="a">{visual}{collision}</link>'), "LW405", "LW412") == codes


@pytest.mark.parametrize(
    ("part", "codes"),
    [('<ros2_control name="c" type="system"/>', ["LINT302"]), ('<gazebo reference="a"/>', ["URDF106"])],
)
def test_separate_ros2_control_file_is_not_missing_links(find_codes, part, codes):
    assert find_codes(robot_text(part, PREFIX), "LINT302", "URDF106", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(
    ("address", "hint"),
    [
        ("file:///opt/ros/humble/share/arm/meshes/base.stl", "write 'package://arm/meshes/base.stl'"),
        ("/opt/ros/humble/lib/base.stl", "write 'package://PACKAGE/PATH'"),
    ],
)
def test_mesh_path_in_ros_installation_is_reported_once(tmp_path, address, hint):
    path = tmp_path / "r.urdf"
    mesh = f'<visual><geometry><mesh filename="{address}"/></geometry></visual>'
    path.write_text(robot_text(f'<link name="a">{mesh}</link>'))
    (finding,) = examine(path, settings=Settings(select=("LW422", "LW424"))).diagnostics
    assert (finding.code, str(finding.hint)) == ("LW422", hint)


@pytest.mark.parametrize("large_shape", ["a", "b"])
def test_disconnected_parts_are_reported_once(find_codes, large_shape):
    text = robot_text(f'<link name="a"/><link name="b"/>{moving_link("c", "", parent=large_shape)}')
    assert find_codes(text, "LW103", "URDF152") == ["URDF152"]


@pytest.mark.parametrize(
    ("cmake", "severity"),
    [
        ("xacro_add_files(urdf/arm.urdf.xacro TARGET t INSTALL DESTINATION urdf)", "INFO"),
        ("configure_file(urdf/arm.urdf.in urdf/arm.urdf)", "INFO"),
        ("add_custom_command(OUTPUT urdf/arm.urdf COMMAND make_arm)", "INFO"),
        ("xacro_add_files(urdf/base.urdf.xacro TARGET t)", "ERROR"),
    ],
)
def test_missing_include_that_build_generates_is_an_info(tmp_path, cmake, severity):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "CMakeLists.txt").write_text(f"project(p)\n{cmake}\n")
    (tmp_path / "urdf").mkdir()
    include = '<xacro:include filename="$(find p)/urdf/arm.urdf"/>'
    (tmp_path / "r.urdf.xacro").write_text(robot_text(f'<link name="a"/>{include}', PREFIX))
    findings = examine(tmp_path / "r.urdf.xacro", packages={"p": tmp_path}).diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "XML101"] == [severity]


@pytest.mark.parametrize(("name", "severity"), [("urdf/arm.xacro", "WARNING"), ("urdf/leg.xacro", "ERROR")])
def test_include_relative_to_package_folder_is_a_warning(tmp_path, name, severity):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "urdf").mkdir()
    (tmp_path / "urdf/arm.xacro").write_text("<robot/>")
    text = robot_text(f'<link name="a"/><xacro:include filename="{name}"/>', PREFIX)
    (tmp_path / "urdf/r.urdf.xacro").write_text(text)
    (finding,) = (
        diagnostic for diagnostic in examine(tmp_path / "urdf/r.urdf.xacro").diagnostics if diagnostic.code == "XML101"
    )
    assert finding.severity.name == severity
    assert ("write 'arm.xacro'" in (finding.hint or "")) is (severity == "WARNING")


def test_includes_relative_to_package_folder_are_one_finding_per_file(
    tmp_path,
):
    (tmp_path / "package.xml").write_text(MANIFEST.format(more=""))
    (tmp_path / "urdf").mkdir()
    for name in ("arm", "leg", "head"):
        (tmp_path / f"urdf/{name}.xacro").write_text("<robot/>")
    includes = "".join(f'<xacro:include filename="urdf/{name}.xacro"/>' for name in ("arm", "leg", "head", "tail"))
    (tmp_path / "urdf/r.urdf.xacro").write_text(robot_text(f'<link name="a"/>{includes}', PREFIX))
    findings = [
        diagnostic for diagnostic in examine(tmp_path / "urdf/r.urdf.xacro").diagnostics if diagnostic.code == "XML101"
    ]
    assert [(finding.severity.name, str(finding.message).partition("(")[2]) for finding in findings] == [
        ("WARNING", "and 2 more)"),
        ("ERROR", ""),
    ]


@pytest.mark.parametrize("declaring", ["p", "beside"])
def test_mesh_package_declared_by_sibling_package_is_an_info(tmp_path, declaring):
    for name in ("p", "beside"):
        (tmp_path / name).mkdir()
        extra_text = "<exec_depend>arm_description</exec_depend>" if name == declaring else ""
        (tmp_path / name / "package.xml").write_text(MANIFEST.format(more=extra_text))
    mesh = '<visual><geometry><mesh filename="package://{}/a.stl"/></geometry></visual>'
    links = (f'<link name="{name}">{mesh.format(name)}</link>' for name in ("arm_description", "far_description"))
    (tmp_path / "p/r.urdf").write_text(robot_text("".join(links)))
    findings = examine(tmp_path / "p/r.urdf").diagnostics
    assert [finding.severity.name for finding in findings if finding.code == "LW423"] == ["INFO", "WARNING"]


def test_material_is_not_reported_beside_missing_include(find_codes):
    colored = '<visual><geometry><box size="1 1 1"/></geometry><material name="dark"/></visual>'
    include = '<xacro:include filename="$(find far_description)/colors.xacro"/>'
    link = f'<link name="a">{colored}</link>'
    assert find_codes(robot_text(link), "URDF160") == ["URDF160"]
    assert find_codes(robot_text(include + link, PREFIX), "URDF160") == []


@pytest.mark.parametrize(("extra_text", "codes"), [("", ["LW102"]), ('<ros2_control name="c" type="system"/>', [])])
def test_robot_with_ros2_control_needs_no_shapes(find_codes, extra_text, codes):
    assert find_codes(robot_text(f'<link name="base"/>{moving_link("a", "")}{extra_text}'), "LW102") == codes


@pytest.mark.parametrize(("xyz", "codes"), [("0 0 0", []), ("0 0 1", ["LW105"])])
def test_misplaced_zero_origin_is_accepted(find_codes, xyz, codes):
    assert find_codes(robot_text(f'<link name="base"><origin xyz="{xyz}" rpy="0 0 0"/></link>'), "LW105") == codes


def test_misplaced_material_hint_names_visual(tmp_path):
    (tmp_path / "r.urdf").write_text(robot_text('<link name="base"><material name="red"/></link>'))
    (finding,) = examine(tmp_path / "r.urdf", settings=Settings(select=("LW105",))).diagnostics
    assert finding.hint == "put it directly in <visual>"


@pytest.mark.parametrize(
    ("text", "codes"),
    [
        (f'<link name="rock">{BOX.format(1)}{inertial_text(0, 0)}</link>', []),
        (f'<link name="rock">{BOX.format(1)}{inertial_text(0, 1)}</link>', ["LW302"]),
        (f'<link name="base"/>{moving_link("rock", BOX.format(1) + inertial_text(0, 0))}', ["LW302"]),
    ],
)
def test_zero_mass_of_single_link_is_accepted(find_codes, text, codes):
    assert find_codes(robot_text(text), "LW302") == codes


@pytest.mark.parametrize(("second", "count"), [(1.0, 1), (2.0, 2)])
def test_equal_too_large_inertias_are_reported_once(find_codes, second, count):
    fingers = moving_link("a", BOX.format(0.01) + inertial_text(0.01, 1.0)) + moving_link(
        "b", BOX.format(0.02) + inertial_text(0.01, second)
    )
    assert find_codes(robot_text(f'<link name="base">{BOX.format(1)}</link>{fingers}'), "LW324") == ["LW324"] * count


@pytest.mark.parametrize(("call", "codes"), [("<!-- <xacro:m/> -->", []), ("<!-- <xacro:n/> -->", ["LW704"])])
def test_include_with_commented_out_call_is_accepted(find_codes, call, codes):
    part = f'<robot {PREFIX}><xacro:macro name="m"><link name="m"/></xacro:macro></robot>'
    text = robot_text(f'<link name="base"/><xacro:include filename="part.xacro"/>{call}', PREFIX)
    assert find_codes(text, "LW704", name="r.urdf.xacro", part_dot_xacro=part) == codes


@pytest.mark.parametrize(("body", "codes"), [("", []), ('<link name="m"/>', ["LW705"])])
def test_unused_parameter_of_empty_macro_is_accepted(find_codes, body, codes):
    macro = f'<xacro:macro name="m" params="sim">{body}</xacro:macro><xacro:m sim="1"/>'
    assert find_codes(robot_text(f'<link name="base"/>{macro}', PREFIX), "LW705", name="r.urdf.xacro") == codes


@pytest.mark.parametrize(
    ("name", "hint"), [("robot_description", False), ("my_robot_descripton", True)], ids=["another", "misspelled"]
)
def test_shipped_package_is_suggested_only_for_misspelled_name(tmp_path, name, hint):
    mesh = f'<link name="l"><visual><geometry><mesh filename="package://{name}/a.stl"/></geometry></visual></link>'
    (tmp_path / "r.urdf").write_text(robot_text(mesh))
    (finding,) = (diagnostic for diagnostic in examine(tmp_path / "r.urdf").diagnostics if diagnostic.code == "LW423")
    assert ("my_robot_description" in (finding.hint or "")) is hint


@pytest.mark.parametrize(("izz", "codes"), [(1, ["LW324"]), (3, ["LW314"])])
def test_impossible_inertia_is_not_reported_as_too_large(find_codes, izz, codes):
    part = moving_link("a", BOX.format(0.1) + inertial_text(0.1, 1).replace('izz="1"', f'izz="{izz}"'))
    assert find_codes(robot_text(f'<link name="base"/>{part}'), "LW314", "LW324") == codes


@pytest.mark.parametrize(
    ("root", "kind", "codes"),
    [
        ("world", "prismatic", []),
        ("world", "continuous", ["LW324"]),
        ("base", "prismatic", ["LW324"]),
    ],
)
def test_inertia_of_link_that_slides_on_world_is_accepted(find_codes, root, kind, codes):
    part = moving_link("cart", BOX.format(0.1) + inertial_text(0.1, 1), parent=root).replace("continuous", kind)
    part = part.replace("</joint>", '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>')
    assert find_codes(robot_text(f'<link name="{root}"/>{part}'), "LW322", "LW324") == codes


@pytest.mark.parametrize(
    ("lower", "upper", "count"),
    [("-100", "100", 0), ("-1000.0", "1e3", 0), ("0", "100", 1), ("-120", "120", 2), ("-100", "1000", 2)],
)
def test_symmetric_round_limits_of_prismatic_joint_are_accepted(find_codes, lower, upper, count):
    slide = moving_link("cart", "").replace("continuous", "prismatic")
    limit = f'<limit lower="{lower}" upper="{upper}" effort="1" velocity="1"/></joint>'
    assert (
        find_codes(robot_text(f'<link name="base"/>{slide.replace("</joint>", limit)}'), "LW213") == ["LW213"] * count
    )


ROVER_LINKS = """<link name="rocker"><visual><geometry><box size="0.4 0.02 0.02"/></geometry></visual></link>
<joint name="left_hip" type="revolute"><parent link="base"/><child link="{rocker}"/><axis xyz="{axis}"/>
<origin xyz="0 0.2 0"/><limit lower="-0.3" upper="0.3" effort="1" velocity="1"/></joint>"""
WHEEL_LINK = """<link name="{0}_wheel"><visual><origin rpy="1.5707963 0 0"/>
<geometry><cylinder radius="0.1" length="0.05"/></geometry></visual></link>
<joint name="{0}_wheel" type="continuous"><parent link="{1}"/><child link="{0}_wheel"/>
<origin xyz="{2} 0 {3}"/><axis xyz="0 1 0"/></joint>"""


@pytest.mark.parametrize(("axis", "codes"), [("0 1 0", []), ("0 0 1", ["LW390"])])
def test_wheels_on_rocker_need_not_be_level(find_codes, axis, codes):
    wheels = WHEEL_LINK.format("front", "rocker", 0.2, 0) + WHEEL_LINK.format("rear", "base", -0.2, 0.05)
    rocker = ROVER_LINKS.format(rocker="rocker", axis=axis)
    assert find_codes(robot_text(f'<link name="base"/>{rocker}{wheels}'), "LW390") == codes


@pytest.mark.parametrize(("intermediate", "codes"), [(False, ["LW641"]), (True, [])])
def test_link_that_carries_wheel_is_not_a_wheel(find_codes, intermediate, codes):
    carrier = ROVER_LINKS.replace('name="rocker"', 'name="left_wheel_connector"').format(
        rocker="left_wheel_connector", axis="0 1 0"
    )
    ends = '<parent link="left_wheel_connector"/><child link="leg"/>'
    leg = f'<link name="leg"/><joint name="leg" type="fixed">{ends}</joint>'
    wheel = WHEEL_LINK.format("front", "leg" if intermediate else "base", 0.2, 0)
    assert find_codes(robot_text(f'<link name="base"/>{carrier}{leg}{wheel}'), "LW641") == codes


@pytest.mark.parametrize(("parent", "codes"), [("world", []), ("base", ["LW226"])])
def test_far_origin_of_joint_from_world_is_accepted(find_codes, parent, codes):
    joint = f'<joint name="j" type="fixed"><origin xyz="33 17 2"/><parent link="{parent}"/><child link="a"/></joint>'
    assert find_codes(robot_text(f'<link name="{parent}"/><link name="a"/>{joint}'), "LW226") == codes


def test_duplicate_joint_name_hides_second_parent_finding(find_codes):
    joint = '<joint name="{}" type="fixed"><parent link="base"/><child link="a"/></joint>'
    links = '<link name="base"/><link name="a"/>'
    assert find_codes(robot_text(links + joint.format("j") + joint.format("j")), "URDF1") == ["URDF110"]
    assert find_codes(robot_text(links + joint.format("j") + joint.format("k")), "URDF1") == ["URDF151"]
