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
