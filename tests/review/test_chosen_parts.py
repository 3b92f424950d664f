"""Parts that the default of an argument or a condition chooses, in macros that no robot shows."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML

PATH = "a/urdf/base.xacro"
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
