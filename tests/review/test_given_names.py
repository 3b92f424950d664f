"""Topics and frames that a parameter file gives to a node, as the source of the node tells."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/config/arm.yaml"
CPP = """#include <rclcpp/rclcpp.hpp>
Arm::Arm() : Node("{node}") {{
  {code}
  out_ = create_publisher<Bool>("done", 1);
}}
"""
PUBLISHER = 'auto t = declare_parameter<std::string>("output", "scan"); p_ = create_publisher<Bool>(t, 1);'
SUBSCRIPTION = 'auto t = declare_parameter<std::string>("output", "scan"); s_ = create_subscription<Bool>(t, 1, f);'
FRAME = 'frame_ = declare_parameter<std::string>("output", "scan"); m.header.frame_id = frame_;'
YAML = "arm:\n  ros__parameters:\n    {}: left\n    other: {}\n"
NOT_FOUND = "programs that use the name 'left' do not find it"
NO_FRAME = "programs that look for the frame 'left' in the messages do not find it"


def review(repository, compare, code: str, yaml: str, new_yaml: str, source: str = "arm/src/arm.cpp", node="arm"):
    manifests = {f"{name}/package.xml": PACKAGE_XML.replace("arm_description", name) for name in ("arm", "lamp")}
    repository.commit({**manifests, source: CPP.format(code=code, node=node), PATH: yaml})
    repository.write({PATH: new_yaml})
    return [str(change.reason) for change in subject(compare(repository), PATH).changes if change.reason]


@pytest.mark.parametrize(
    ("code", "parameter", "reasons"),
    [
        (PUBLISHER, "output", [NOT_FOUND]),
        (FRAME, "output", [NO_FRAME]),
        (SUBSCRIPTION, "output", []),
        (PUBLISHER, "outputs", []),
    ],
)
def test_another_name_for_what_the_source_of_the_node_offers_is_breaking(repository, compare, code, parameter, reasons):
    yaml = YAML.format(parameter, "up")
    assert review(repository, compare, code, yaml, yaml.replace("left", "right")) == reasons


@pytest.mark.parametrize("new", ["/left", "left_{side}"])
def test_same_name_or_a_placeholder_is_not_breaking(repository, compare, new):
    yaml = YAML.format("output", "up")
    assert review(repository, compare, PUBLISHER, yaml, yaml.replace("left", new)) == []


def test_name_that_another_parameter_of_the_file_has_now_is_not_lost(repository, compare):
    yaml = YAML.format("output", "up")
    new = yaml.replace("left", "right").replace("up", "left")
    assert review(repository, compare, PUBLISHER, yaml, new) == []


@pytest.mark.parametrize(("node", "reasons"), [("arm", [NOT_FOUND]), ("lamp", [])])
def test_source_of_another_package_counts_if_it_has_the_node(repository, compare, node, reasons):
    yaml = YAML.format("output", "up")
    new = yaml.replace("left", "right")
    assert review(repository, compare, PUBLISHER, yaml, new, "lamp/src/lamp.cpp", node) == reasons


SWITCH = "the data that 'publish_planning_scene' enables is no longer published"
LAUNCH = """<launch>
  <arg name="publish" default="{}"/>
  <node pkg="moveit_ros_move_group" type="move_group" name="move_group">
    <param name="planning_scene_monitor/publish_planning_scene" value="$(arg publish)"/>
  </node>
</launch>
"""


@pytest.mark.parametrize(("old", "new", "is_breaking"), [("true", "false", True), ("false", "true", False)])
def test_switched_off_topic_of_move_group_is_breaking(repository, compare, old, new, is_breaking):
    path = "arm/launch/arm.launch"
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), path: LAUNCH.format(old)}
    yaml = "move_group:\n  ros__parameters:\n    publish_planning_scene: {}\n"
    repository.commit({**files, PATH: yaml.format(old)})
    repository.write({path: LAUNCH.format(new), PATH: yaml.format(new)})
    result = compare(repository)
    changed = [each for path in (path, PATH) for each in subject(result, path).changes]
    assert [None if each.reason is None else str(each.reason) for each in changed] == [
        SWITCH if is_breaking else None
    ] * 2
    assert sentences(subject(result, path)) == [f"argument 'publish': default {old} -> {new}"]
    assert bool(breaking(result)) is is_breaking


@pytest.mark.parametrize(
    ("value", "more", "is_breaking"),
    [
        ("true", "", True),
        ("false", "", False),
        ("true", '<param name="publish_planning_scene" value="true"/>', False),
        ("true", '<rosparam command="load" file="$(find arm)/config/arm.yaml"/>', False),
    ],
)
def test_removed_switch_of_a_topic_of_move_group(repository, compare, value, more, is_breaking):
    path = "arm/launch/arm.launch"
    launch = LAUNCH.format(value)
    switch = '<param name="planning_scene_monitor/publish_planning_scene" value="$(arg publish)"/>'
    assert switch in launch
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), path: launch})
    repository.write({path: launch.replace(switch, more)})
    reasons = [None if each.reason is None else str(each.reason) for each in subject(compare(repository), path).changes]
    assert (SWITCH in reasons) is is_breaking


TF_LAUNCH = """<launch>
  <node pkg="base" type="base" name="base"><param name="publish_tf" value="{}"/></node>
  {}
</launch>
"""
FILTER = '<node pkg="tf2_ros" type="filter" name="filter"/>'


@pytest.mark.parametrize(("other", "reasons"), [("", ["the node no longer publishes its transform"]), (FILTER, [])])
def test_switched_off_transform_is_breaking_unless_an_added_node_may_publish_it(repository, compare, other, reasons):
    path = "arm/launch/arm.launch"
    files = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**files, path: TF_LAUNCH.format("true", "")})
    repository.write({path: TF_LAUNCH.format("false", other)})
    assert [str(each.reason) for each in subject(compare(repository), path).changes if each.reason] == reasons


def test_parameter_that_two_sources_of_the_package_use_for_different_things_is_not_breaking(repository, compare):
    yaml = "/**:\n  ros__parameters:\n    output: left\n"
    other = {"arm/src/other.cpp": CPP.format(code=SUBSCRIPTION, node="other")}
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, **other, "arm/src/arm.cpp": CPP.format(code=PUBLISHER, node="arm"), PATH: yaml})
    repository.write({PATH: yaml.replace("left", "right")})
    assert breaking(compare(repository)) == []
