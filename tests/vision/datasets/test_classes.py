"""The classes of objects in a world."""

from __future__ import annotations

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.vision.datasets.classes import ClassRules, derive_class, find_objects, make_default_rules, read_classes
from tests.simulation.worlds import load_simulation
from tests.vision.datasets.places import write_yard


@pytest.mark.parametrize(
    ("name", "expected"),
    [("ball", "ball"), ("red_ball", "ball"), ("ball_2", "ball"), ("Blue-Ball (3)", "ball"), ("box12", "box"),
     ("traffic_cone_clone_1", "traffic_cone"), ("red", "red"), ("7", "7"), ("stop_sign", "stop_sign")],
)  # fmt: skip
def test_default_class_omits_numbers_and_colors(name, expected):
    assert derive_class(name) == expected


def test_walls_and_ground_are_not_objects(tmp_path):
    simulation = load_simulation(write_yard(tmp_path))
    rules = make_default_rules([simulation])
    assert list(rules.patterns) == ["ball", "crate", "drums"]
    objects = find_objects(simulation, rules)
    assert [(scene_object.name, scene_object.label) for scene_object in objects] == [
        ("red_ball", 0),
        ("ball_2", 0),
        ("crate", 1),
        ("drums", 2),
    ]


def test_touching_visuals_are_one_object(tmp_path):
    simulation = load_simulation(write_yard(tmp_path))
    objects = find_objects(simulation, ClassRules({"drum": ("drums::*",), "ball": ("*ball*",)}))
    assert [(scene_object.name, scene_object.label, len(scene_object.geoms)) for scene_object in objects] == [
        ("red_ball", 1, 1),
        ("ball_2", 1, 1),
        ("drums::link::blue", 0, 2),
        ("drums::link::green", 0, 1),
    ]


def test_classes_of_file_keep_order(tmp_path):
    path = tmp_path / "classes.yaml"
    path.write_text('mbot:\nball: [football, "*_ball"]\ncone: traffic_cone\n')
    rules = read_classes(path)
    assert list(rules.patterns) == ["mbot", "ball", "cone"]
    assert [rules.find_class_number(name) for name in ("mbot", "red_ball", "traffic_cone", "ball")] == [0, 1, 2, None]


@pytest.mark.parametrize(
    ("text", "line"),
    [("", 1), ("- ball\n", 1), ("ball: []\n", 1), ("ball: {a: b}\n", 1), ("ball:\nball:\n", 2), ("a: [b\n", 2),
     ("? [a]\n: b\n", 1), ("a:\n  - [b]\n", 2)],
)  # fmt: skip
def test_malformed_classes_file_is_reported_with_location(tmp_path, text, line):
    path = tmp_path / "classes.yaml"
    path.write_text(text)
    with pytest.raises(LinkwrightError) as caught:
        read_classes(path)
    (finding,) = caught.value.diagnostics
    assert finding.code == "VISION201"
    assert (finding.span.line if finding.span else None) == line


def test_missing_classes_file_is_reported(tmp_path):
    with pytest.raises(LinkwrightError, match="does not exist"):
        read_classes(tmp_path / "none.yaml")
