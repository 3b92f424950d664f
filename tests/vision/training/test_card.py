"""The card of a trained network: facts, metrics and failures."""

from __future__ import annotations

import hashlib
import json

import numpy as np
import pytest

from linkwright.vision.detections import Detections
from linkwright.vision.evaluation import GroundTruth, evaluate
from linkwright.vision.training.card import (
    EvaluationReport,
    collect_dataset_facts,
    describe_origin,
    format_confusion_table,
    make_card,
)

BOXES = np.array([[0, 0, 8, 8], [20, 20, 60, 60]], np.float32)


def make_figures(classes):
    truth = GroundTruth(BOXES, np.array([0, 1], np.int32), np.zeros(2, bool))
    places = [place for place, kind in enumerate(classes) if kind is not None]
    kinds = np.array([classes[place] for place in places], np.int32)
    return evaluate(
        ("ball", "box"),
        [truth],
        [Detections(BOXES[places], np.full(len(places), 0.9, np.float32), kinds, ("ball", "box"))],
    )


def test_card_has_facts_metrics_and_failures():
    text = make_card("detector", {"command": "`a | b`"}, [EvaluationReport("Rooms", make_figures([None, 0]))])
    assert text.startswith("# detector\n")
    assert "| command | `a \\| b` |" in text
    assert "| ball | 1 | 0.000 | 0.000 | 0.000 | 0.000 |" in text
    assert "- Rooms: of objects under 16 pixels it misses 100%." in text
    assert "- Rooms: it takes 100% of box for ball." in text


def test_card_of_perfect_network_has_no_failures():
    text = make_card("detector", {}, [EvaluationReport("Rooms", make_figures([0, 1]))])
    assert "| all | 2 | 1.000 | 1.000 | | |" in text
    assert text.endswith("## Where it fails\n\nNothing stands out in these images.\n")


def test_confusion_table_has_row_per_label_and_column_per_detection():
    assert format_confusion_table(make_figures([None, 0])) == [
        "| label \\ detection | ball | box | nothing |",
        "| --- | ---: | ---: | ---: |",
        "| ball |  |  | 1 |",
        "| box | 1 |  |  |",
        "| nothing |  |  |  |",
    ]


def world_checksum(world):
    return hashlib.sha256(world.encode()).hexdigest()


def write_card(folder, *worlds, card_options=()):
    """Write the notes that `linkwright dataset` writes about the images of one or more runs."""
    folder.mkdir(exist_ok=True)
    listed = [
        {"name": f"rooms/{world}.world", "file": f"{world}.world", "sha256": world_checksum(world)} for world in worlds
    ]
    runs = [{"seed": 3, "most": 10}, *card_options]
    entries = [{"worlds": listed, "added": ["mbot.urdf"], "options": options} for options in runs]
    (folder / "dataset.json").write_text(json.dumps({"made": entries}))
    return folder


def test_card_names_evaluation_worlds_also_used_for_training(tmp_path):
    training_folder = write_card(tmp_path / "lesson", "playground", "house")
    assert describe_origin(write_card(tmp_path / "unseen", "maze", "line_track"), training_folder) == (
        "Worlds: line_track, maze. Options: seed 3, most 10. It was trained on none of them."
    )
    description = describe_origin(write_card(tmp_path / "seen", "maze", "house"), training_folder)
    assert description.endswith(" It was trained on other images of house.")
    text = make_card("detector", {}, [EvaluationReport("Rooms", make_figures([0, 1]), description)])
    assert f"## Rooms\n\n{description}\n\n1 images." in text
    assert describe_origin(tmp_path, training_folder) == ""
    assert describe_origin(write_card(tmp_path / "unseen", "maze"), tmp_path).endswith(" Options: seed 3, most 10.")


def test_card_describes_generation_of_dataset(tmp_path):
    write_card(tmp_path, "playground", card_options=[{"seed": 3, "most": 10}, {"seed": 4, "most": 10}])
    assert collect_dataset_facts(tmp_path) == {
        "worlds": f"playground (sha256 {world_checksum('playground')[:12]})",
        "options of linkwright dataset": "seed 3, most 10; seed 4, most 10",
        "robots and models put in": "mbot.urdf",
    }


@pytest.mark.parametrize("content", [None, "", "{}", '{"made": [1]}', '{"made": [{"worlds": [{}]}]}'])
def test_foreign_dataset_has_no_facts(tmp_path, content):
    if content is not None:
        (tmp_path / "dataset.json").write_text(content)
    assert collect_dataset_facts(tmp_path) == {}
