"""The lines of a review about topics that costmaps read in parameter files."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import sentences, subject

PATH = "arm/config/nav.yaml"
NAV2 = """local_costmap:
  local_costmap:
    ros__parameters:
      plugins: [static_layer, obstacle_layer]
      static_layer:
        plugin: "nav2_costmap_2d::StaticLayer"
        map_topic: /map
      obstacle_layer:
        plugin: "nav2_costmap_2d::ObstacleLayer"
        observation_sources: scan depth
        scan:
          topic: /scan
          max_obstacle_height: 2.0
        depth:
          topic: /depth/points
          max_obstacle_height: 2.0
"""
ROS1 = "observation_sources: laser\nlaser: {data_type: LaserScan, topic: scan, marking: true}\n"
REASON = "the costmap no longer gets the messages of '{}'"


@pytest.mark.parametrize(
    ("text", "old", "new", "reasons"),
    [
        (NAV2, "topic: /scan", "topic: /lidar/scan", [REASON.format("scan")]),
        (NAV2, "topic: /scan", "topic: scan", [None]),
        (NAV2, "map_topic: /map", "map_topic: /slam/map", [REASON.format("map")]),
        (NAV2, "sources: scan depth", "sources: scan", [REASON.format("depth/points")]),
        (NAV2, "sources: scan depth", "sources: depth scan", [None]),
        (
            NAV2.replace("        depth:\n          topic: /depth/points\n          max_obstacle_height: 2.0\n", ""),
            "topic: /scan\n          max_obstacle_height: 2.0",
            "max_obstacle_height: 2.0",
            [REASON.format("scan")],
        ),
        (ROS1, "topic: scan", "topic: front/scan", [REASON.format("scan")]),
        (
            ROS1,
            ROS1,
            "obstacle_layer:\n  " + ROS1.replace("\n", "\n  ").replace("topic: scan", "topic: front/scan"),
            [None, REASON.format("scan"), None, None],
        ),
        ("obstacles_layer: {map_topic: /map/fixed}\n", "fixed", "full", [REASON.format("map/fixed")]),
        ("player: {map_topic: /map/fixed}\n", "fixed", "full", [None]),
        ("planner:\n  ros__parameters:\n    topic: /scan\n", "/scan", "/lidar", [None]),
    ],
)
def test_a_topic_that_a_costmap_no_longer_reads_is_breaking(repository, compare, text, old, new, reasons):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: text})
    repository.write({PATH: text.replace(old, new)})
    changes = subject(compare(repository), PATH).changes
    assert [None if change.reason is None else str(change.reason) for change in changes] == reasons


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("[static_layer, obstacle_layer]", "[obstacle_layer]", "the costmap lacks the layer 'static_layer'"),
        (
            "[static_layer, obstacle_layer]",
            "[voxel_layer]",
            "the costmap lacks the layers 'obstacle_layer', 'static_layer'",
        ),
        ("      plugins: [static_layer, obstacle_layer]\n", "", "the costmap lacks the layers"),
    ],
)
def test_a_costmap_that_loses_a_layer_is_told(repository, compare, old, new, reason):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: NAV2})
    repository.write({PATH: NAV2.replace(old, new)})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.reason).startswith(reason)


def test_a_server_that_loses_a_plugin_breaks_programs_that_name_it(repository, compare):
    text = "planner_server:\n  ros__parameters:\n    planner_plugins: [direct, careful]\n"
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: text})
    repository.write({PATH: text.replace("direct, ", "")})
    (change,) = subject(compare(repository), PATH).changes
    assert str(change.reason) == "programs that name the plugin 'direct' do not find it"


def test_a_renamed_source_with_the_same_topic_is_not_breaking(repository, compare):
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: ROS1})
    repository.write({PATH: ROS1.replace("laser", "front")})
    found = subject(compare(repository), PATH)
    assert sentences(found)
    assert all(change.reason is None for change in found.changes)


def test_a_dropped_source_whose_topic_another_one_reads_breaks_nobody(repository, compare):
    source = "        clear:\n          topic: /scan\n          clearing: true\n"
    text = NAV2.replace("scan depth", "scan clear depth").replace("        depth:", f"{source}        depth:")
    repository.commit({"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm"), PATH: text})
    repository.write({PATH: NAV2})
    assert compare(repository).breaking_changes == []


LOADING = """<launch>
  <group>
    <remap from="{}" to="/front/scan"/>
    <node pkg="move_base" type="move_base" name="move_base">
      <rosparam file="$(find arm)/{}" command="load" ns="local_costmap"/>
    </node>
  </group>
</launch>
"""


@pytest.mark.parametrize(("old", "new", "reason"), [("scan", "laser", None), ("scan", "scan", REASON.format("scan"))])
def test_a_costmap_that_reads_the_same_topic_by_another_remapping_loses_nothing(repository, compare, old, new, reason):
    path = PATH.removeprefix("arm/")
    manifest = {"arm/package.xml": PACKAGE_XML.replace("arm_description", "arm")}
    repository.commit({**manifest, PATH: ROS1, "arm/launch/a.launch": LOADING.format(old, path)})
    new_text = ROS1.replace("topic: scan", "topic: laser")
    repository.write({PATH: new_text, "arm/launch/a.launch": LOADING.format(new, path)})
    (change,) = subject(compare(repository), PATH).changes
    assert (None if change.reason is None else str(change.reason)) == reason


@pytest.mark.parametrize(
    ("launch", "reasons"),
    [("", {"None"}), ("substitutions = {'<depth_topic>': 'depth'}\n", {REASON.format("<depth_topic>")})],
)
def test_a_placeholder_that_no_launch_file_replaces_is_not_a_topic(repository, compare, launch, reasons):
    """The layer keeps other parameters, so that the lines about its source are its only ones."""
    text = NAV2.replace("scan depth", "depth").replace("/depth/points", "<depth_topic>")
    manifest = PACKAGE_XML.replace("arm_description", "arm")
    repository.commit({"arm/package.xml": manifest, "arm/launch/nav.launch.py": launch, PATH: text})
    source = text[text.index("        depth:\n") :]
    repository.write({PATH: text.replace("        observation_sources: depth\n", "").replace(source, "")})
    changes = subject(compare(repository), PATH).changes
    assert {str(change.reason) for change in changes} == reasons
