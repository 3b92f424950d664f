"""Whole robots.

The tests cover the verdict of urdfdom, the text of urdf_to_graphviz, and conversion to URDF.
"""

from __future__ import annotations

import pytest

from linkwright.descriptions import examine, load
from linkwright.diagnostics import has_errors
from linkwright.urdf import read, save, to_gv, tree_text
from linkwright.xmltree import parse
from tests.corpora import MODELS, Model

models = pytest.mark.parametrize("model", MODELS, ids=str)


@models
def test_verdict_matches_urdfdom(model: Model) -> None:
    reading = examine(model.expected)
    assert (reading.robot is not None) == model.accepted
    assert has_errors(reading.diagnostics) == bool(model.complaints)


@models
def test_links_joints_and_diagram_match_urdfdom(model: Model) -> None:
    if not model.data["links"]:
        assert examine(model.expected).diagnostics[0].code == "URDF106"
        return
    robot = load(model.expected)
    assert (len(robot.links), len(robot.joints)) == (model.data["links"], model.data["joints"])
    assert to_gv(robot) == model.diagram
    assert tree_text(robot).count("child(") == model.data["joints"] + 1


@models
def test_round_trip_keeps_robot(model: Model) -> None:
    robot = examine(model.expected).robot
    if robot is not None:
        assert read(parse(save(robot), "saved.urdf")).robot == robot
