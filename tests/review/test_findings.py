"""Findings that are new or fixed, and those that are neither."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from linkwright.diagnostics import Diagnostic, Span, phrase
from linkwright.review import open_versions
from linkwright.review.findings.unfixed import drop_unfixed_findings
from linkwright.review.texts.folders import finding_without_folders
from tests.repositories import ARM, MACRO, PACKAGE_XML
from tests.review.conftest import breaking

PATH = "arm_description/urdf/arm.urdf.xacro"
SEGMENT = "arm_description/urdf/segment.xacro"
UNUSED = MACRO.replace('params="name parent', 'params="name color parent')
"""A macro with a parameter that it does not use, which is a finding."""
WITH_UNUSED = ARM.replace("<xacro:segment ", '<xacro:segment color="red" ')
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([{nodes}])
"""


def launch_text(*packages: str) -> str:
    return LAUNCH.replace("{nodes}", ", ".join(f'Node(package="{name}", executable="run")' for name in packages))


def finding_codes(findings) -> list[str]:
    return [finding.code for finding in findings]


def test_new_and_fixed_findings_are_reported(package, compare):
    package.commit({SEGMENT: UNUSED, PATH: WITH_UNUSED})
    assert finding_codes(compare(package, "HEAD~1..HEAD").new_findings) == ["LW705"]
    package.commit({SEGMENT: MACRO, PATH: ARM})
    assert finding_codes(compare(package, "HEAD~1..HEAD").fixed_findings) == ["LW705"]


def test_removed_file_has_no_fixed_findings(package, compare):
    package.commit({SEGMENT: UNUSED, PATH: WITH_UNUSED})
    package.commit({SEGMENT: None, PATH: '<robot name="arm"><link name="base_link"/></robot>'})
    assert compare(package, "HEAD~1..HEAD").fixed_findings == []


def test_unreadable_robot_has_no_fixed_findings(package, compare):
    package.commit({SEGMENT: UNUSED, PATH: WITH_UNUSED})
    package.commit({PATH: WITH_UNUSED.replace("</robot>", "<</robot>")})
    result = compare(package, "HEAD~1..HEAD")
    assert breaking(result)
    assert result.fixed_findings == []
    assert [finding.code for finding in result.new_findings if not finding.code.startswith("XML")] == []


def test_readable_robot_has_no_new_findings(package, compare):
    package.commit({SEGMENT: UNUSED, PATH: WITH_UNUSED.replace("</robot>", "<</robot>")})
    package.commit({PATH: WITH_UNUSED})
    result = compare(package, "HEAD~1..HEAD")
    assert result.new_findings == []
    assert all(code.startswith("XML") for code in finding_codes(result.fixed_findings))


def test_missing_mesh_is_new_in_a_robot_whose_sensor_package_is_missing(package, compare):
    sensor = '<xacro:include filename="$(find lidar_description)/lidar.xacro"/></robot>'
    mesh = "package://arm_description/meshes/base.obj"
    visual = f'<link name="base_link"><visual><geometry><mesh filename="{mesh}"/></geometry></visual></link>'
    text = ARM.replace('<link name="base_link"/>', visual).replace("</robot>", sensor)
    package.commit({PATH: text, "arm_description/meshes/base.obj": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"})
    package.commit({"arm_description/meshes/base.obj": None})
    assert finding_codes(compare(package, "HEAD~1..HEAD").new_findings) == ["LW424"]


def test_findings_of_unchanged_part_that_a_new_robot_includes_are_not_new(repository, compare):
    repository.commit({"arm_description/package.xml": PACKAGE_XML, SEGMENT: UNUSED})
    repository.commit({PATH: WITH_UNUSED})
    assert [code for code in finding_codes(compare(repository, "HEAD~1..HEAD").new_findings) if code == "LW705"] == []


PREFIXED = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:macro name="side" params="prefix">
    <joint name="${prefix}joint" type="revolute">
      <parent link="base"/><child link="${prefix}hand"/><limit lower="0" upper="1" effort="1" velocity="1"/>
    </joint>
    <link name="${prefix}hand"/>
  </xacro:macro>
</robot>
"""
CALLER = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <xacro:include filename="side.xacro"/><link name="base"/><xacro:side prefix="{}"/>
</robot>
"""


@pytest.mark.parametrize(("old", "is_new"), [("", False), ("big_", True)])
def test_a_finding_in_a_macro_is_not_new_if_another_robot_calls_it_with_a_prefix(repository, compare, old, is_new):
    folder = "arm_description/urdf"
    repository.commit({"arm_description/package.xml": PACKAGE_XML, f"{folder}/side.xacro": PREFIXED})
    repository.commit({f"{folder}/arm.urdf.xacro": CALLER.format(old)})
    changed = CALLER.format(old).replace('name="base"', 'name="base" type="a"')
    repository.write({f"{folder}/a.urdf.xacro": CALLER.format("left_"), f"{folder}/arm.urdf.xacro": changed})
    codes = finding_codes(compare(repository).new_findings)
    assert ("LW222" in codes) == is_new


def test_findings_of_package_that_only_gets_files_are_not_new(repository, compare):
    manifest = PACKAGE_XML.replace("An arm.", "TODO: Package description")
    repository.commit({"arm_description/package.xml": manifest, SEGMENT: MACRO})
    repository.commit({PATH: ARM})
    assert "LW808" not in finding_codes(compare(repository, "HEAD~1..HEAD").new_findings)


def test_only_new_names_of_a_list_are_reported(package, compare):
    package.commit({"arm_description/launch/a.launch.py": launch_text("alpha", "beta")})
    package.commit({"arm_description/launch/a.launch.py": launch_text("alpha", "beta", "gamma")})
    result = compare(package, "HEAD~1..HEAD")
    ((_, change),) = result.breaking_changes  # the line tells it, and no finding repeats it
    assert "package.xml does not name 'gamma'" in str(change.reason)
    assert "LW848" not in finding_codes([*result.new_findings, *result.fixed_findings])
    package.commit({"arm_description/launch/a.launch.py": launch_text("alpha", "gamma")})
    result = compare(package, "HEAD~1..HEAD")
    (finding,) = [finding for finding in result.fixed_findings if finding.code == "LW848"]
    assert str(finding.message).endswith("does not depend: 'beta'")
    assert "LW848" not in finding_codes(result.new_findings)


def test_finding_with_other_number_is_not_new(package, compare):
    text = MACRO.replace('upper="1.5"', 'upper="-2"')
    package.commit({SEGMENT: text})
    assert finding_codes(compare(package, "HEAD~1..HEAD").new_findings) != []
    package.commit({SEGMENT: text.replace('upper="-2"', 'upper="-3"')})
    result = compare(package, "HEAD~1..HEAD")
    assert (finding_codes(result.new_findings), finding_codes(result.fixed_findings)) == ([], [])


@pytest.mark.parametrize("has_other", [False, True])
def test_finding_about_a_renamed_joint_is_neither_new_nor_fixed(package, compare, has_other):
    macro = MACRO.replace("<axis", '<friction value="1"/><axis')
    package.commit({SEGMENT: macro})
    other = '<joint name="tip_joint" type="fixed"><friction/><parent link="hand"/><child link="tip"/></joint>'
    text = ARM.replace('name="lower"', 'name="hand"').replace('"lower"', '"hand"')
    package.commit({PATH: text.replace("</robot>", f'<link name="tip"/>{other}</robot>') if has_other else text})
    result = compare(package, "HEAD~1..HEAD")
    new = [finding for finding in result.new_findings if finding.code == "LW107"]
    assert ["'tip_joint'" in str(finding.message) for finding in new] == [True] * has_other
    assert "LW107" not in finding_codes(result.fixed_findings)


def test_finding_that_names_a_renamed_file_is_not_new(package, compare):
    text = ARM.replace('  <xacro:arg name="tool" default="none"/>\n', "")
    package.commit({PATH: text})
    package.commit({PATH: None, "arm_description/urdf/robot.urdf.xacro": text})
    result = compare(package, "HEAD~1..HEAD")
    assert (finding_codes(result.new_findings), finding_codes(result.fixed_findings)) == ([], [])


def test_launch_file_that_names_a_renamed_file_is_breaking(package, compare):
    include = """from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    path = PathJoinSubstitution([FindPackageShare("arm_description"), "launch", "arm_launch.py"])
    return LaunchDescription([IncludeLaunchDescription(path)])
"""
    markup = '<launch><include file="$(find-pkg-share arm_description)/launch/arm_launch.py"/></launch>'
    package.commit(
        {
            "arm_description/launch/arm_launch.py": launch_text("alpha"),
            "arm_description/launch/all.launch.py": include,
            "arm_description/launch/all.launch.xml": markup,
        }
    )
    package.commit(
        {"arm_description/launch/arm_launch.py": None, "arm_description/launch/arm.launch.py": launch_text("alpha")}
    )
    result = compare(package, "HEAD~1..HEAD")
    sentence = "names 'launch/arm_launch.py' of 'arm_description', which no longer exists"
    assert sorted(subject.path for subject, change in result.breaking_changes if str(change.sentence) == sentence) == [
        "arm_description/launch/all.launch.py",
        "arm_description/launch/all.launch.xml",
    ]


def test_finding_that_moves_to_another_file_is_neither_new_nor_fixed(package, compare):
    include = '<xacro:include filename="$(find arm_description)/urdf/parts.xacro"/>'
    with_parts = ARM.replace("</robot>", f"{include}</robot>")
    head, parts = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">', SEGMENT.replace("segment", "parts")
    unused = '<xacro:macro name="cap" params="color"><link name="cap"/></xacro:macro>'
    call = '<xacro:cap color="red"/>'
    attached = '<joint name="j" type="fixed"><parent link="base_link"/><child link="cap"/></joint>'
    text = with_parts.replace("</robot>", f"{call}{attached}</robot>")
    package.commit({PATH: text.replace(call, unused + call), parts: f"{head}</robot>"})
    package.commit({PATH: text, parts: f"{head}{unused}</robot>"})
    result = compare(package, "HEAD~1..HEAD")
    assert (finding_codes(result.new_findings), finding_codes(result.fixed_findings)) == ([], [])


def test_checks_that_stop_at_different_errors_find_nothing_new_in_unchanged_files(package, compare):
    macro_with_property = MACRO.replace("</robot>", '<property name="length" value="1"/></robot>')
    broken = ARM.replace("<xacro:include", 30 * '<link name="${lost_name}"/>' + "<xacro:include", 1)
    missing_include = '<xacro:include filename="$(find lost_description)/lost.xacro"/>'
    package.commit({PATH: broken, SEGMENT: macro_with_property})
    package.commit({PATH: ARM.replace("<xacro:include", f"{missing_include}<xacro:include", 1)})
    assert finding_codes(compare(package, "HEAD~1..HEAD").new_findings) == ["PKG101", "LW848"]


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("/home/ann/.cache/shares/1f/arm/meshes/arm.stl", "package://arm/meshes/arm.stl"),
        ("/tmp/version/files/arm/meshes/arm.stl", "arm/meshes/arm.stl"),
    ],
)
def test_folders_of_the_computer_are_left_out(path, expected):
    finding = Diagnostic("SDF162", phrase("there is no '{path}'", path=path))
    shares = {"arm": Path("/home/ann/.cache/shares/1f/arm")}
    finding = finding_without_folders(finding, Path("/tmp/version/files"), shares)
    assert str(finding.message) == f"there is no '{expected}'"


def find_fixed(repository, code: str, path: str, message: str, added: Sequence[Diagnostic] = ()) -> list[str]:
    """Return the codes of the fixed findings of the last commit, if the old version has one finding more."""
    versions = open_versions(repository.root, "HEAD~1..HEAD")
    try:
        fixed = [Diagnostic(code, message, Span(path, 1, 1, 1, 1))]
        return finding_codes(drop_unfixed_findings(versions, fixed, added, {}))
    finally:
        versions.close()


@pytest.mark.parametrize(("other", "is_fixed"), [(PATH, False), (SEGMENT, True)])
def test_finding_about_a_mesh_that_is_missing_now_is_not_fixed(package, other, is_fixed):
    package.commit({PATH: ARM + "<!-- -->"})
    missing = Diagnostic("LW424", "the mesh file is missing", Span(other, 1, 1, 1, 1))
    assert bool(find_fixed(package, "LW435", PATH, "the mesh has 21 482 triangles", [missing])) == is_fixed


TESTED = PACKAGE_XML.replace("<exec_depend>", "<test_depend>drivers</test_depend><exec_depend>")
TEST, TEST_TEXT = "arm_description/test/all.launch.py", launch_text("drivers")


@pytest.mark.parametrize(
    ("files", "is_fixed"),
    [
        ({"drivers/package.xml": PACKAGE_XML}, False),
        ({"arm_description/package.xml": PACKAGE_XML.replace("xacro", "drivers")}, True),
        ({"arm_description/package.xml": TESTED}, False),
        ({"arm_description/package.xml": TESTED, "arm_description/launch/all.launch.py": "", TEST: TEST_TEXT}, True),
        ({"arm_description/launch/all.launch.py": launch_text("arm_description")}, True),
    ],
)
def test_package_of_launch_files_is_declared_only_by_their_manifest(package, files, is_fixed):
    package.commit({"arm_description/launch/all.launch.py": launch_text("drivers")})
    package.commit(files)
    message = "launch files use a package on which package.xml does not depend: 'drivers'"
    assert bool(find_fixed(package, "LW848", "arm_description/package.xml", message)) == is_fixed


@pytest.mark.parametrize(
    ("name", "new", "is_fixed"),
    [
        ("all.launch", "$(eval find(arg('model') + '_description'))", False),
        ("all.launch", "$(eval find('other_' + arg('model')))", True),
        ("all.launch.xml", "$(find-pkg-share $(var model)_description)/urdf/arm.xacro", False),
    ],
)
def test_package_whose_name_an_argument_completes_is_still_used(package, name, new, is_fixed):
    path = f"arm_description/launch/{name}"
    arguments = "".join(f'<arg name="{name}" default="{{}}"/>' for name in ("model", "tool", "path"))
    text = f"<launch>{arguments}</launch>".format("grip", "$(find tool)", "{}")
    package.commit({path: text.format("grip_description")})
    package.commit({path: text.format(new)})
    message = "launch files use a package on which package.xml does not depend: 'grip_description'"
    assert bool(find_fixed(package, "LW848", "arm_description/package.xml", message)) == is_fixed


@pytest.mark.parametrize(("name", "is_new"), [("gripper_bringup", True), ("warehouse_ros_mongo", False)])
def test_generated_launch_file_of_moveit_that_newly_uses_a_package_of_the_repository(package, compare, name, is_new):
    """MoveIt generates launch files that start packages for every possible use."""
    path, text = "arm_moveit/launch/demo.launch", '<launch><include file="$(find {})/launch/all.launch"/></launch>'
    manifests = {
        f"{each}/package.xml": PACKAGE_XML.replace("arm_description", each)
        for each in ("arm_moveit", "gripper_bringup")
    }
    package.commit({**manifests, "arm_moveit/.setup_assistant": "", path: text.format("arm_moveit")})
    package.commit({path: text.format(name)})
    assert ("LW848" in finding_codes(compare(package, "HEAD~1..HEAD").new_findings)) is is_new


SETUP = """from setuptools import setup

setup(
    name="arm",
    packages=["arm"],
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arm"]),
        ("share/arm", ["package.xml"]),
    ],
    entry_points={"console_scripts": ["driver = arm.driver:run"]},
)
"""
PYTHON_PACKAGE = {
    "arm/package.xml": PACKAGE_XML.replace("arm_description", "arm").replace("ament_cmake", "ament_python"),
    "arm/resource/arm": "",
    "arm/arm/__init__.py": "",
    "arm/arm/driver.py": "def main():\n    pass\n",
    "arm/launch/arm.launch.py": LAUNCH.replace("{nodes}", 'Node(package="arm", executable="driver")'),
}


def test_setup_with_a_syntax_error_hides_neither_new_nor_fixed_findings(repository, compare):
    """The wrong function of the entry point is as old as the error."""
    repository.commit({**PYTHON_PACKAGE, "arm/setup.py": f"b{SETUP}"})
    repository.commit({"arm/setup.py": SETUP})
    repaired = compare(repository, "HEAD~1..HEAD")
    assert (finding_codes(repaired.new_findings), finding_codes(repaired.fixed_findings)) == ([], ["LW820"])
    repository.commit({"arm/setup.py": f"b{SETUP}"})
    broken = compare(repository, "HEAD~1..HEAD")
    assert (finding_codes(broken.new_findings), finding_codes(broken.fixed_findings)) == (["LW820"], [])
    repository.commit({"arm/setup.py": SETUP})
    repository.commit({"arm/setup.py": SETUP.replace("driver:run", "driver:start")})
    assert finding_codes(compare(repository, "HEAD~1..HEAD").new_findings) == ["LW827"]


@pytest.mark.parametrize("folder", [".", "arm_description"])
def test_finding_about_a_mesh_by_its_path_is_neither_new_nor_fixed(package, compare, monkeypatch, folder):
    """The working tree and the other version are different folders, and the review runs in one of them."""
    mesh = '<visual><geometry><mesh filename="file://$(find arm_description)/meshes/arm.stl"/></geometry></visual>'
    text = ARM.replace('<link name="base_link"/>', f'<link name="base_link">{mesh}</link>')
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:{}\nsize 12345\n"
    package.commit({PATH: text, "arm_description/meshes/arm.stl": pointer.format("7e" * 32)})
    monkeypatch.chdir(package.root / folder)
    package.write({PATH: text.replace("0.2", "0.3")})
    result = compare(package)
    assert [found.path for found in result.subjects] == [PATH]
    assert (finding_codes(result.new_findings), finding_codes(result.fixed_findings)) == ([], [])


def test_finding_in_an_unchanged_file_is_not_new_if_its_xacro_file_gets_another_name(package, compare):
    header = "<!-- | This document was autogenerated by xacro from arm.urdf.xacro | -->"
    link = '<link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual></link>'
    joint = '<joint name="turn" type="continuous"><parent link="base"/><child link="tip"/></joint><link name="tip"/>'
    generated = f'<?xml version="1.0"?>\n{header}\n<robot name="arm">{link}{joint}</robot>\n'
    package.commit({"arm_description/robots/arm.urdf": generated})
    package.write({"arm_description/urdf/robot.urdf.xacro": ARM, PATH: None})
    assert finding_codes(compare(package).new_findings) == []


@pytest.mark.parametrize(("declared", "codes"), [(True, []), (False, ["PKG101", "LW848"])])
def test_declared_package_that_this_computer_lacks_is_no_finding(package, compare, declared, codes):
    depend = "<exec_depend>sensor_of_others</exec_depend>" if declared else ""
    package.commit({"arm_description/package.xml": PACKAGE_XML.replace("</package>", f"{depend}</package>")})
    include = '<xacro:include filename="$(find sensor_of_others)/urdf/sensor.xacro"/>'
    package.write({PATH: ARM.replace("<link name=", f"{include}<link name=", 1)})
    assert finding_codes(compare(package).new_findings) == codes


@pytest.mark.parametrize("has_own_value", [True, False])
def test_property_that_only_a_removed_robot_with_its_own_hid_is_no_new_finding(package, compare, has_own_value):
    """The other robot never included this one."""
    definition = '<xacro:property name="reach" value="0.8"/>'
    use = '<link name="${reach}"/>'
    other = ARM.replace('<link name="base_link"/>', f'<link name="base_link"/>{definition * has_own_value}{use}')
    path = "arm_description/urdf/crane.urdf.xacro"
    package.commit({PATH: ARM.replace('<link name="base_link"/>', f'<link name="base_link"/>{definition}')})
    package.commit({path: other})
    package.commit({path: None, SEGMENT: MACRO.replace("</robot>", "<!-- arms --></robot>")})
    codes = finding_codes(compare(package, "HEAD~1..HEAD").new_findings)
    assert codes == ([] if has_own_value else ["LW701"])
