"""Lines about a plugin in a parameter file: its parameters follow it."""

from __future__ import annotations

import pytest

from tests.repositories import PACKAGE_XML
from tests.review.conftest import breaking, sentences, subject

PATH = "arm/config/navigation.yaml"
OLD = """planner_server:
  ros__parameters:
    rate: 20
    Grid:
      plugin: nav2_smac_planner/SmacPlannerHybrid
      tolerance: 0.5
      smoother:
        iterations: 1000
        weight: 0.3
"""
NEW = """planner_server:
  ros__parameters:
    rate: 20
    Grid:
      plugin: nav2_smac_planner::SmacPlannerLattice
      tolerance: 1
      corners: 8
      costs:
        length: 1.0
        traversal: 2.0
"""
PART = "planner_server.ros__parameters.Grid"


def review_text(repository, compare, old: str, new: str):
    repository.commit({"arm/package.xml": PACKAGE_XML, PATH: old})
    repository.write({PATH: new})
    return compare(repository)


def test_parameters_of_a_replaced_plugin_are_in_its_line_and_break_nothing(repository, compare):
    result = review_text(repository, compare, OLD, NEW)
    assert not breaking(result)
    assert sentences(subject(result, PATH)) == [
        (
            f"{PART}.plugin nav2_smac_planner/SmacPlannerHybrid -> nav2_smac_planner::SmacPlannerLattice; "
            "parameters added: corners 8, costs.length 1.0, costs.traversal 2.0; removed: smoother"
        ),
        f"{PART}.tolerance 0.5 -> 1",
    ]


@pytest.mark.parametrize("name", ["nav2_smac_planner/SmacPlannerHybrid", "nav2_smac_planner::SmacPlannerHybrid"])
def test_parameters_of_the_same_plugin_are_missed(repository, compare, name):
    new = NEW.replace("nav2_smac_planner::SmacPlannerLattice", name)
    result = review_text(repository, compare, OLD, new)
    assert f"{PART}.smoother removed: iterations 1000, weight 0.3" in breaking(result)


def test_the_name_of_a_plugin_stays_breaking(repository, compare):
    """The observation source belongs to the layer, but its topic is one that other programs publish."""
    layer = """local_costmap:
  ros__parameters:
    layer:
      plugin: nav2_costmap_2d::ObstacleLayer
      observation_sources: scan
      scan: {topic: /scan, data_type: LaserScan}
"""
    new = layer.replace("ObstacleLayer", "VoxelLayer").replace("/scan", "/points")
    result = review_text(repository, compare, layer, new)
    assert breaking(result) == ["local_costmap.ros__parameters.layer.scan.topic /scan -> /points"]


BEHAVIORS = """behavior_server:
  ros__parameters:
    behavior_plugins: [spin, wait]
    spin: {plugin: nav2/Spin, speed: 1.0}
    wait: {plugin: nav2/Wait, time: 2.0}
    backup: {plugin: nav2/BackUp, speed: 0.1}
"""
WAIT = "    wait: {plugin: nav2/Wait, time: 2.0}\n"
LISTED = "behavior_server.ros__parameters.behavior_plugins [spin, wait] -> [spin]"
UNLISTED = "behavior_server.ros__parameters.wait removed: plugin nav2/Wait, time 2.0"


@pytest.mark.parametrize(
    ("old", "new", "lines"),
    [
        ("    backup: {plugin: nav2/BackUp, speed: 0.1}\n", "", []),  # no list names it
        (WAIT, "", [UNLISTED]),
        ("[spin, wait]", "[spin]", [LISTED]),
    ],
)
def test_only_a_plugin_that_its_node_loads_is_missed(repository, compare, old, new, lines):
    assert old in BEHAVIORS
    assert breaking(review_text(repository, compare, BEHAVIORS, BEHAVIORS.replace(old, new))) == lines


def test_a_plugin_that_leaves_its_list_is_one_breaking_line(repository, compare):
    new = BEHAVIORS.replace("[spin, wait]", "[spin]").replace(WAIT, "")
    result = review_text(repository, compare, BEHAVIORS, new)
    assert breaking(result) == [LISTED]
    assert UNLISTED in sentences(subject(result, PATH))
