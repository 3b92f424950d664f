"""Average precision in small, countable cases.

Docs/vision-training.md explains the comparison with pycocotools.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkwright.vision.detections import Detections
from linkwright.vision.evaluation import GroundTruth, evaluate, find_best_f1_threshold, intersection_over_union

NAMES = ("ball", "box")
BOX = (10.0, 10.0, 30.0, 30.0)
OTHER_BOX = (50.0, 50.0, 80.0, 80.0)


def make_objects(*rows, ignored=()):
    """Return rows of class, left, top, right, bottom, and the indices of ignored ones."""
    table = np.array(rows, np.float32).reshape(-1, 5)
    hidden = np.array([place in ignored for place in range(len(table))], bool)
    return GroundTruth(table[:, 1:], table[:, 0].astype(np.int32), hidden)


def make_detections(*rows, names=NAMES):
    """Return rows of class, score, left, top, right, bottom."""
    table = np.array(rows, np.float32).reshape(-1, 6)
    return Detections(table[:, 2:], table[:, 1], table[:, 0].astype(np.int32), names)


def test_intersection_over_union_of_boxes():
    box = np.array([[0, 0, 10, 10]], np.float32)
    other_boxes = np.array([[0, 0, 10, 10], [5, 0, 15, 10], [20, 20, 30, 30], [0, 0, 5, 5]], np.float32)
    assert intersection_over_union(box, other_boxes)[0] == pytest.approx([1, 1 / 3, 0, 0.25])


def test_perfect_detections_have_map_1():
    figures = evaluate(
        NAMES, [make_objects((0, *BOX), (1, *OTHER_BOX))], [make_detections((0, 0.9, *BOX), (1, 0.8, *OTHER_BOX))]
    )
    assert (figures.map50, figures.map) == (pytest.approx(1), pytest.approx(1))
    assert figures.confusion.tolist() == [[1, 0, 0], [0, 1, 0], [0, 0, 0]]


def test_half_of_objects_found_limits_average_precision():
    figures = evaluate(NAMES, [make_objects((0, *BOX), (0, *OTHER_BOX))], [make_detections((0, 0.9, *BOX))])
    assert figures.classes[0].ap50 == pytest.approx(51 / 101)
    assert figures.classes[1].ap50 is None
    assert figures.map50 == pytest.approx(51 / 101)
    assert figures.classes[0].recall == 0.5


def test_false_positive_costs_only_above_score_of_true_positive():
    truth = [make_objects((0, *BOX))]
    assert evaluate(NAMES, truth, [make_detections((0, 0.9, *BOX), (0, 0.8, *OTHER_BOX))]).map50 == pytest.approx(1)
    assert evaluate(NAMES, truth, [make_detections((0, 0.8, *BOX), (0, 0.9, *OTHER_BOX))]).map50 == pytest.approx(0.5)


def test_duplicate_detection_is_a_false_positive():
    truth = [make_objects((0, *BOX)), make_objects((0, *BOX))]
    figures = evaluate(NAMES, truth, [make_detections((0, 0.9, *BOX), (0, 0.8, *BOX)), make_detections((0, 0.7, *BOX))])
    assert figures.map50 == pytest.approx((51 + 50 * 2 / 3) / 101)


def test_inexact_box_counts_up_to_its_overlap():
    shifted = (10.0, 10.0, 30.0, 25.0)  # three quarters of the box
    figures = evaluate(NAMES, [make_objects((0, *BOX))], [make_detections((0, 0.9, *shifted))])
    assert figures.map50 == pytest.approx(1)
    assert figures.map == pytest.approx(0.6)  # correct at the thresholds 0.50 to 0.75, which are six of ten


def test_detection_of_ignored_object_is_not_counted():
    truth = [make_objects((0, *BOX), (0, *OTHER_BOX), ignored={1})]
    figures = evaluate(NAMES, truth, [make_detections((0, 0.9, *OTHER_BOX), (0, 0.8, *BOX))])
    assert figures.map50 == pytest.approx(1)
    assert figures.classes[0].objects == 1
    assert figures.confusion.tolist() == [[1, 0, 0], [0, 0, 0], [0, 0, 0]]


def test_classes_are_matched_by_name():
    other_order = make_detections((1, 0.9, *BOX), (0, 0.9, *OTHER_BOX), (2, 0.9, *BOX), names=("box", "ball", "cat"))
    assert evaluate(NAMES, [make_objects((0, *BOX), (1, *OTHER_BOX))], [other_order]).map50 == pytest.approx(1)


def test_confusion_matrix_counts_mistaken_and_missed_classes():
    truth = [make_objects((0, *BOX), (1, *OTHER_BOX))]
    figures = evaluate(NAMES, truth, [make_detections((1, 0.9, *BOX), (0, 0.3, *OTHER_BOX), (1, 0.6, 0, 60, 9, 69))])
    assert figures.confusion.tolist() == [[0, 1, 0], [0, 0, 1], [0, 1, 0]]
    assert figures.classes[1].precision == 0


def test_recall_is_reported_by_size():
    truth = [make_objects((0, 0, 0, 8, 8), (0, 20, 20, 80, 40))]
    figures = evaluate(NAMES, truth, [make_detections((0, 0.9, 20, 20, 80, 40))])
    assert figures.recall_by_size == (
        ("under 16 pixels", 1, 0.0),
        ("16 to 32 pixels", 0, 0.0),
        ("32 to 96 pixels", 1, 1.0),
        ("over 96 pixels", 0, 0.0),
    )


def test_best_f1_threshold_is_score_of_last_useful_detection():
    truth = [make_objects((0, *BOX), (1, *OTHER_BOX), (1, 200, 200, 240, 240), ignored={2})]
    rows = [(0, 0.9, *BOX), (1, 0.6, *OTHER_BOX), (0, 0.4, 90, 90, 99, 99), (1, 0.7, 200, 200, 240, 240)]
    assert find_best_f1_threshold(NAMES, truth, [make_detections(*rows)]) == pytest.approx(0.6)
    assert find_best_f1_threshold(NAMES, truth, [make_detections(*rows[2:])]) == 0.5
    assert find_best_f1_threshold(NAMES, truth, [make_detections()]) == 0.5


@given(st.lists(st.tuples(st.integers(0, 1), st.integers(0, 60), st.integers(0, 60)), max_size=6), st.randoms())
def test_evaluation_does_not_depend_on_order_of_detections(places, rng):
    rows = [(kind, 0.3 + 0.1 * number, x, y, x + 20, y + 20) for number, (kind, x, y) in enumerate(places)]
    truth = [make_objects((0, 5, 5, 25, 25), (1, 40, 40, 60, 60))]
    mixed = rows[:]
    rng.shuffle(mixed)
    first, second = evaluate(NAMES, truth, [make_detections(*rows)]), evaluate(NAMES, truth, [make_detections(*mixed)])
    assert (first.map50, first.map) == (second.map50, second.map)
    assert 0 <= first.map <= first.map50 <= 1
