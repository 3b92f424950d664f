"""Real robots, where they are at hand: urdfdom's verdict, urdf_to_graphviz's text, and back to URDF."""

from __future__ import annotations

import json

import pytest

from linkwright.diagnostics import has_errors
from linkwright.urdf import examine, load, read, save, to_gv, tree_text
from linkwright.xmltree import parse
from tests.places import REPOSITORY

CORPUS = REPOSITORY.parent / "shared" / "corpus"
MANIFEST = CORPUS / "manifest.json"
MODELS = json.loads(MANIFEST.read_text(encoding="utf-8"))["models"] if MANIFEST.exists() else []

pytestmark = pytest.mark.skipif(not MODELS, reason="the corpus of real robots is not here")


@pytest.fixture(params=MODELS, ids=lambda model: model["expected"].removeprefix("expected/"))
def model(request):
    return request.param


def text_of(model):
    return (CORPUS / model["expected"]).read_text(encoding="utf-8")


def test_verdict(model):
    reading = examine(text_of(model))
    urdfdom = model.get("urdfdom") or {"accepts": False, "errors": ["no links"]}
    assert (reading.robot is not None) == urdfdom["accepts"]
    assert has_errors(reading.diagnostics) == bool(urdfdom["errors"])


def test_links_joints_and_diagram(model):
    if not model["links"]:
        assert examine(text_of(model)).diagnostics[0].code == "URDF106"
        return
    robot = load(text_of(model))
    assert (len(robot.links), len(robot.joints)) == (model["links"], model["joints"])
    assert to_gv(robot) == (CORPUS / model["gv"]).read_text(encoding="utf-8")
    assert tree_text(robot).count("child(") == model["joints"] + 1


def test_round_trip(model):
    robot = examine(text_of(model)).robot
    if robot is not None:
        assert read(parse(save(robot), "saved.urdf")).robot == robot
