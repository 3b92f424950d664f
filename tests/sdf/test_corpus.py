"""Real worlds, if available: their contents and poses, compared with known facts."""

from __future__ import annotations

import json
import os
from collections import Counter
from pathlib import Path

import pytest

from linkwright.descriptions import examine_world
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import Pose
from linkwright.packages import PackageFinder
from linkwright.sdf import shapes
from linkwright.sdf.frames import Frames, placed_links, transform_of
from linkwright.sdf.saved import with_saved_state

WORLDS = Path(__file__).parents[3] / "shared" / "worlds"
MANIFEST = WORLDS / "manifest.json"
ITEMS = json.loads(MANIFEST.read_text(encoding="utf-8"))["items"] if MANIFEST.is_file() else []
FILES = [
    pytest.param(item, id=f"{item['source']}/{item['name']}")
    for item in ITEMS
    if item["kind"] == "world" and item["entry"].endswith((".world", ".sdf"))
]
NAMES = {
    Box: "box",
    Capsule: "capsule",
    Cylinder: "cylinder",
    Sphere: "sphere",
    shapes.Cone: "cone",
    shapes.Ellipsoid: "ellipsoid",
    shapes.Heightmap: "heightmap",
    shapes.Mesh: "mesh",
    shapes.Plane: "plane",
    tuple: "polyline",
}

pytestmark = pytest.mark.skipif(not ITEMS, reason="the collection of worlds is missing")


def examine_item(item):
    path = WORLDS / item["entry"]
    folders = dict.fromkeys(str(WORLDS / path) for path in item["model_paths"])
    finder = PackageFinder(start=path.parent, environment={})
    return examine_world(
        path, packages=finder, environment={"GAZEBO_MODEL_PATH": os.pathsep.join(folders), "HOME": "/nowhere"}
    )


def _is_own_model(facts) -> bool:
    """Return whether a model of Fuel was replaced by one of Linkwright with another name."""
    return facts.get("include", "").lower().endswith(("/ground plane", "/sun"))


@pytest.mark.parametrize("item", FILES)
def test_corpus_world_contents_match_known_facts(item):
    facts = item["facts"]
    reading = examine_item(item)
    assert reading.sdf is not None
    world = reading.sdf.worlds[0]
    links = list(placed_links(world))
    collisions = Counter(
        NAMES[type(collision.geometry)] for placed_link in links for collision in placed_link.link.collisions
    )
    visuals = Counter(NAMES[type(visual.geometry)] for placed_link in links for visual in placed_link.link.visuals)
    assert len(links) == facts["links"]
    assert (dict(collisions), dict(visuals)) == (facts["collisions"], facts["visuals"])
    assert Counter(light.type for light in world.lights) == Counter(facts["lights"])
    assert len(world.actors) == facts["actors"]
    assert len(world.includes) <= facts["unresolved_includes"]


@pytest.mark.parametrize("item", FILES)
def test_corpus_model_poses_match_known_facts(item):
    reading = examine_item(item)
    assert reading.sdf is not None
    world = with_saved_state(reading.sdf.worlds[0])
    frames = Frames(world)
    facts_by_name = {
        model["name"]: model for model in item["facts"]["top_level_models"] if not model.get("pose_attributes")
    }
    for model in world.models:
        if model.name in facts_by_name:
            pose = facts_by_name[model.name]["pose"]
            expected = transform_of(Pose(tuple(pose[:3]), tuple(pose[3:])))
            place = frames.pose(model.name)
            sign = 1.0 if sum(a * b for a, b in zip(place[3:], expected[3:], strict=True)) > 0 else -1.0
            assert place[:3] == pytest.approx(expected[:3], abs=1e-9)
            assert [sign * angle for angle in place[3:]] == pytest.approx(expected[3:], abs=1e-9)
    names = {model.name for model in (*world.models, *world.lights)}
    omitted_uris = {include.uri for include in world.includes}
    assert {
        name
        for name, model in facts_by_name.items()
        if model.get("include") not in omitted_uris and not _is_own_model(model)
    } <= names


@pytest.mark.parametrize("item", FILES)
def test_corpus_world_accepted_by_simulators_has_no_errors(item):
    assert [diagnostic for diagnostic in examine_item(item).diagnostics if diagnostic.severity.value == "error"] == []
