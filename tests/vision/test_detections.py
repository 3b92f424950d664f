"""Detections, and their fields."""

from __future__ import annotations

import numpy as np

from linkwright.vision.detections import Detections


def test_detections_have_names():
    detections = Detections(
        np.array([[0, 0, 2, 2], [1, 1, 3, 3]], np.float32),
        np.array([0.9, 0.8], np.float32),
        np.array([1, 0], np.int32),
        ("ball", "box"),
    )
    assert [detections.name(index) for index in range(len(detections))] == ["box", "ball"]


def test_empty_detections_have_length_zero():
    assert len(Detections.empty(("ball",))) == 0
