"""Identities of objects on synthetic trajectories."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.vision.detections import Detections
from linkwright.vision.places.tracker import Tracker, TrackerSettings

NAMES = ("ball", "crate")
PERIOD_S = 1 / 30


def make_detections(*objects):
    """Return detections of (center x, center y, size, score, class)."""
    if not objects:
        return Detections.empty(NAMES)
    boxes = [[x - size / 2, y - size / 2, x + size / 2, y + size / 2] for x, y, size, *_ in objects]
    scores = [entry[3] if len(entry) > 3 else 0.9 for entry in objects]
    classes = [entry[4] if len(entry) > 4 else 0 for entry in objects]
    return Detections(np.array(boxes, np.float32), np.array(scores, np.float32), np.array(classes, np.int32), NAMES)


def test_moving_object_keeps_id_from_second_detection():
    tracker = Tracker()
    ids = [tracker.update(make_detections((100 + 4 * step, 200, 40)), step * PERIOD_S)[0] for step in range(60)]
    assert ids[0] == 0
    assert set(ids[1:]) == {1}


@pytest.mark.parametrize("seed", range(5))
def test_crossing_objects_keep_ids(seed):
    rng = np.random.default_rng(seed)
    tracker = Tracker()
    ids_by_object = {"right": set(), "left": set()}
    for step in range(120):
        noise = rng.normal(0, 1, 4)
        right = (100 + 3 * step + noise[0], 200 + noise[1], 40)
        left = (460 - 3 * step + noise[2], 212 + noise[3], 40)
        is_occluded = abs(right[0] - left[0]) < 20  # the nearer object covers the other
        ids = tracker.update(make_detections(right) if is_occluded else make_detections(right, left), step * PERIOD_S)
        if step > 2 and not is_occluded:
            ids_by_object["right"].add(ids[0])
            ids_by_object["left"].add(ids[1])
    assert ids_by_object == {"right": {min(ids_by_object["right"])}, "left": {min(ids_by_object["left"])}}
    assert ids_by_object["right"] != ids_by_object["left"]


def test_briefly_missing_object_keeps_id_and_long_missing_gets_new():
    tracker = Tracker()
    ids = []
    for step in range(200):
        is_hidden = 30 <= step < 50 or 90 <= step < 150
        result = tracker.update(
            make_detections() if is_hidden else make_detections((100 + step, 200, 40)), step * PERIOD_S
        )
        ids += result
    assert [key for key in dict.fromkeys(ids) if key] == [1, 2], "IDs are not reused"
    assert ids[28:32] == [1, 1, 1, 1]


def test_low_score_detection_keeps_track_and_starts_none():
    tracker = Tracker(TrackerSettings(high_threshold=0.5, low_threshold=0.1, new_track_score=0.6))
    for step in range(5):
        tracker.update(make_detections((100, 100, 40)), step * PERIOD_S)
    weak = [
        tracker.update(make_detections((100, 100, 40, 0.2), (300, 300, 40, 0.2)), step * PERIOD_S)
        for step in range(5, 60)
    ]
    assert all(ids == [1, 0] for ids in weak)
    assert tracker.update(make_detections((100, 100, 40, 0.05)), 2.0) == [0]


def test_single_detection_gets_no_id_and_classes_are_separate():
    tracker = Tracker()
    assert tracker.update(make_detections((100, 100, 40)), 0.0) == [0]
    assert tracker.update(make_detections((100, 100, 40, 0.9, 1)), PERIOD_S) == [0]
    assert tracker.update(make_detections((100, 100, 40, 0.9, 1)), 2 * PERIOD_S) == [1]


def test_time_jump_back_restarts_tracks_with_new_ids():
    tracker = Tracker()
    for step in range(3):
        tracker.update(make_detections((100, 100, 40)), 10 + step * PERIOD_S)
    assert tracker.update(make_detections((100, 100, 40)), 0.0) == [0]
    assert tracker.update(make_detections((100, 100, 40)), PERIOD_S) == [2]


def test_low_frame_rate_keeps_ids():
    tracker = Tracker()
    ids = [tracker.update(make_detections((100 + 10 * step, 200, 60)), step * 0.2)[0] for step in range(20)]
    assert set(ids[1:]) == {1}


def test_thirty_crossing_objects_keep_ids():
    rng = np.random.default_rng(7)
    start, speed = rng.uniform(0, 2000, (30, 2)), rng.uniform(-60, 60, (30, 2))
    tracker, switches, before = Tracker(), 0, None
    for step in range(90):
        positions = start + speed * step * PERIOD_S + rng.normal(0, 0.5, (30, 2))
        ids = np.array(tracker.update(make_detections(*[(x, y, 40) for x, y in positions]), step * PERIOD_S))
        if before is not None and step > 2:
            switches += int((ids != before).sum())
        before = ids
    assert switches == 0
