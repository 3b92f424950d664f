"""Parts that the default of an argument or a condition chooses, in macros that no robot shows."""

from __future__ import annotations

import pytest

from tests.repositories import ARM, PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "a/urdf/base.xacro"
ROBOT = "arm_description/urdf/arm.urdf.xacro"
BASE = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="wheel" default="track"/>
  <xacro:arg name="lidar" default="true"/>
  <xacro:property name="wheel" value="$(arg wheel)"/>
  <xacro:macro name="base" params="">
    <link name="base_link"/>
    <xacro:if value="${wheel == 'track'}"><link name="track_link"/></xacro:if>
    <xacro:unless value="${wheel == 'track'}"><link name="wheel_link"/></xacro:unless>
    <xacro:if value="$(arg lidar)"><link name="lidar_link"/></xacro:if>
    <xacro:lidar name="front" parent="base_link"/>
  </xacro:macro>
</robot>
"""
LACK = "robots of callers that do not pass '{}' lack these parts"


@pytest.mark.parametrize(
    ("old", "new", "sentence", "reason"),
    [
        ('default="track"', 'default="round"',
         "default of argument 'wheel' track -> round; link wheel_link instead of link track_link",
         LACK.format("wheel")),
        ('default="true"', 'default="false"',
         "default of argument 'lidar' true -> false; without link lidar_link", LACK.format("lidar")),
        ('default="true"', 'default="1"', "default of argument 'lidar' true -> 1", None),
        ('if value="${wheel == \'track\'}"', 'if value="${wheel == \'chain\'}"',
         "macro 'base': link track_link: condition if ${wheel == 'track'} -> if ${wheel == 'chain'}",
         "callers for which wheel is 'track' do not get the part"),
        ('    <xacro:lidar name="front" parent="base_link"/>\n', "",
         "macro 'base': lidar front parent=base_link removed",
         "programs that use the frames and topics of 'front' do not find them"),
    ],
)  # fmt: skip
def test_parts_that_callers_lose_are_named(repository, compare, old, new, sentence, reason):
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: BASE})
    repository.commit({PATH: BASE.replace(old, new, 1)})
    found = {
        str(change.sentence): None if change.reason is None else str(change.reason)
        for item in compare(repository, "HEAD~1..HEAD").subjects
        for change in item.changes
    }
    assert found.get(sentence, "not told") == reason


def test_default_that_adds_a_part_is_not_breaking(repository, compare):
    base = BASE.replace('default="true"', 'default="false"')
    repository.commit({"a/package.xml": PACKAGE_XML, PATH: base})
    repository.commit({PATH: BASE})
    result = compare(repository, "HEAD~1..HEAD")
    assert [str(change.sentence) for item in result.subjects for change in item.changes] == [
        "default of argument 'lidar' false -> true; with link lidar_link"
    ]
    assert not result.breaking_changes


def test_argument_that_no_longer_chooses_an_included_file_is_breaking(package, compare):
    """The robots of the repository do not show it, because the defaults are equal."""
    arguments = "".join(f'<xacro:arg name="{name}" default="arm_description"/>' for name in ("config", "model"))
    text = ARM.replace('  <xacro:arg name="tool"', f'  {arguments}\n  <xacro:arg name="tool"')
    text = text.replace("$(find arm_description)", "$(find ${place})")
    place = '  <xacro:property name="place" value="$(arg %s)"/>\n'
    include = '  <xacro:include filename="$(find ${place})/urdf/segment.xacro"/>\n'
    text = text.replace(include, "").replace("  <link", f"{place}{include}  <link", 1)
    package.commit({ROBOT: text % "config"})
    package.write({ROBOT: (text % "model").replace("place", "source")})
    ((_, change),) = compare(package).breaking_changes
    names = [f"$(find ${{{name}}})/urdf/segment.xacro" for name in ("place", "source")]
    assert str(change.sentence) == f"include filename: {names[0]} -> {names[1]}"
    assert str(change.reason) == "callers that pass 'config' get another file"


@pytest.mark.parametrize(
    ("default", "condition", "is_breaking"),
    [("none", "tool == 'camera'", True), ("none", "'camera' == tool", True), ("camera", "tool == 'camera'", False)],
)
def test_further_condition_that_a_default_does_not_fulfill_is_breaking(
    repository, compare, default, condition, is_breaking
):
    part = "<xacro:if value=\"${arm == 'long'}\">%s</xacro:if>"
    link = '<link name="cam"/><joint name="cam_joint" type="fixed"><parent link="base"/><child link="cam"/></joint>'
    text = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:arg name="arm" default="short"/>%s
      <xacro:property name="arm" value="$(arg arm)"/><link name="base"/>%s</robot>"""
    argument = f'<xacro:arg name="tool" default="{default}"/><xacro:property name="tool" value="$(arg tool)"/>'
    repository.commit({"a/package.xml": PACKAGE_XML, "a/urdf/r.urdf.xacro": text % ("", part % link)})
    new_part = part % f'<xacro:if value="${{{condition}}}">{link}</xacro:if>'
    repository.write({"a/urdf/r.urdf.xacro": text % (argument, new_part)})
    reasons = {str(change.reason) for _, change in compare(repository).breaking_changes}
    assert reasons == ({"robots of callers that do not pass 'tool' lack the part"} if is_breaking else set())


@pytest.mark.parametrize(("count", "condition"), [(2, " [if ${gpu}]"), (1, "")])
def test_a_property_with_several_definitions_is_named_with_its_conditions(repository, compare, count, condition):
    path = "lidar/urdf/lidar.xacro"
    definitions = (
        '<xacro:if value="${gpu}"><xacro:property name="kind" value="gpu_ray"/></xacro:if>',
        '<xacro:unless value="${gpu}"><xacro:property name="kind" value="ray"/></xacro:unless>',
    )
    text = f"""<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:macro name="lidar" params="gpu">
      {"".join(definitions[:count])}<gazebo><sensor name="s" type="${{kind}}"/></gazebo></xacro:macro></robot>"""
    repository.commit({path: text})
    repository.write({path: text.replace("gpu_ray", "gpu_lidar")})
    assert sentences(subject(compare(repository), path)) == [
        f"macro 'lidar': property kind value{condition}: gpu_ray -> gpu_lidar"
    ]


def test_an_include_with_other_conditions_is_named(repository, compare):
    path = "lidar/urdf/robot.urdf.xacro"
    include = '<xacro:include filename="head.xacro"/>'
    text = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r"><xacro:arg name="head" default="true"/>
      <link name="base"/>{}</robot>"""
    head = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="size" value="1"/></robot>'
    conditional = f'<xacro:if value="$(arg head)">{include}</xacro:if>'
    repository.commit({path: text.format(conditional), "lidar/urdf/head.xacro": head})
    repository.write({path: text.format(include)})
    lines = sentences(subject(compare(repository), path))
    assert "include head.xacro: condition if $(arg head) -> always" in lines
