"""Calls of macros without the prefix xacro:, which xacro expanded until ROS Melodic."""

from __future__ import annotations

import pytest

from tests.review.conftest import breaking, sentences, subject

PATH = "legacy/urdf/arm.urdf.xacro"
MANIFEST = """<package format="2"><name>legacy</name><version>0.0.0</version><description>x</description>
<maintainer email="a@b.c">x</maintainer><license>MIT</license><buildtool_depend>{tool}</buildtool_depend></package>"""
ROBOT = """<?xml version="1.0"?>
<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  <!-- <part name="comment" upper="9"/> -->
  <property name="reach" value="0.5"/>
  <xacro:macro name="part" params="name upper">
    <link name="${name}"/>
    <joint name="${name}_joint" type="revolute">
      <parent link="base"/><child link="${name}"/><axis xyz="0 0 1"/><origin xyz="0 0 ${reach}"/>
      <limit lower="-1" upper="${upper}" effort="1" velocity="1"/>
    </joint>
  </xacro:macro>
  <link name="base"/>
  <part name="head" upper="${pi / 2}"/>
</robot>
"""


@pytest.fixture
def legacy(repository):
    repository.commit({"legacy/package.xml": MANIFEST.format(tool="catkin"), PATH: ROBOT})
    return repository


def test_calls_without_the_prefix_are_expanded(legacy, compare):
    legacy.write({PATH: ROBOT.replace("${pi / 2}", "1.0").replace('value="0.5"', 'value="0.6"')})
    result = compare(legacy)
    assert sentences(subject(result, PATH)) == [
        "joint 'head_joint': origin xyz 0 0 0.5 -> 0 0 0.6 m (moved by 0.1 m)",
        "joint 'head_joint': limit upper 1.57079633 -> 1 rad",
    ]
    assert breaking(result) == ["joint 'head_joint': limit upper 1.57079633 -> 1 rad"]


def test_packages_of_rosbuild_do_not_need_the_prefix(legacy, compare):
    manifest = '<package><description brief="legacy"/><license>BSD</license><depend package="xacro"/></package>'
    legacy.commit({"legacy/package.xml": None, "legacy/manifest.xml": manifest})
    legacy.write({PATH: ROBOT.replace("${pi / 2}", "2.0")})
    assert sentences(subject(compare(legacy), PATH)) == ["joint 'head_joint': limit upper 1.57079633 -> 2 rad"]


def test_added_prefix_is_the_only_change(legacy, compare):
    prefixed = ROBOT.replace("<property", "<xacro:property").replace('<part name="head', '<xacro:part name="head')
    legacy.write({PATH: prefixed})
    assert sentences(subject(compare(legacy), PATH)) == ["prefix 'xacro:' added to 'property', 'part'"]


def test_lost_prefix_is_breaking(legacy, compare):
    legacy.commit({PATH: ROBOT.replace('<part name="head', '<xacro:part name="head')})
    legacy.write({PATH: ROBOT})
    assert breaking(compare(legacy)) == ["prefix 'xacro:' removed from 'part'"]


def test_packages_of_ros_2_need_the_prefix(legacy, compare):
    legacy.commit({"legacy/package.xml": MANIFEST.format(tool="ament_cmake")})
    legacy.write({PATH: ROBOT.replace("${pi / 2}", "1.0")})
    assert not any("head_joint" in sentence for sentence in sentences(subject(compare(legacy), PATH)))


MACROS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:macro name="part" params="name"><link name="arm/${name}"/></xacro:macro>
  <xacro:macro name="other" params="name"><link name="other/${name}"/></xacro:macro>
</robot>
"""
TREE = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="arm">
  {include}<link name="base"/>
  <part name="head"/>
  <joint name="neck" type="fixed"><parent link="base"/><child link="arm/{child}"/></joint>
</robot>
"""
INCLUDE = '<xacro:include filename="macros.xacro"/>'


def test_checks_see_the_links_of_calls_without_the_prefix(legacy, compare):
    """Only a line of its own tells that the child link of the joint is missing."""
    legacy.commit({"legacy/urdf/macros.xacro": MACROS, PATH: TREE.format(include=INCLUDE, child="${absent}")})
    legacy.write({PATH: TREE.format(include=INCLUDE, child="head")})
    result = compare(legacy)
    assert sentences(subject(result, PATH))[0].startswith("can be read now")
    assert breaking(result) == []
    assert [finding for finding in result.new_findings if "does not exist" in str(finding.message)] == []


def test_new_call_without_the_prefix_is_no_finding(legacy, compare):
    legacy.commit({"legacy/urdf/macros.xacro": MACROS, PATH: TREE.format(include=INCLUDE, child="head")})
    legacy.write({PATH: TREE.format(include=INCLUDE, child="head").replace("</robot>", '<other name="a"/></robot>')})
    assert "LW720" not in [finding.code for finding in compare(legacy).new_findings]


@pytest.mark.parametrize(
    ("new", "expected"),
    [
        ('<link name="other/head"/>', None),
        ('<xacro:property name="space" value="other/"/><link name="${space}head"/>', None),
        ('<link name="${space}head"/>', "'head'"),
        ('<xacro:property name="space" value="hand/"/><link name="${space}head"/>', "'head'"),
    ],
)
def test_link_that_is_made_without_the_macro_is_not_lost(legacy, compare, new, expected):
    path = "legacy/urdf/head.xacro"
    text = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{}</robot>'
    legacy.commit({"legacy/urdf/macros.xacro": MACROS, path: text.format('<xacro:other name="head"/>')})
    legacy.write({path: text.format(new)})
    reasons = [str(change.reason) for change in subject(compare(legacy), path).changes if change.reason]
    assert [f"use the frames and topics of {expected}" in reason for reason in reasons] == [True] * bool(expected)
