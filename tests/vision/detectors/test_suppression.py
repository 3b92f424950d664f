"""Non-maximum suppression against a slow one."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from linkwright.vision.detectors.suppression import non_maximum_suppression


def suppress_slowly(boxes, scores, classes, iou, max_count):
    selected = []
    for index in sorted(range(len(scores)), key=lambda index: -scores[index]):
        left, top, right, bottom = boxes[index]
        for other in selected:
            width = min(right, boxes[other][2]) - max(left, boxes[other][0])
            height = min(bottom, boxes[other][3]) - max(top, boxes[other][1])
            common = max(0, width) * max(0, height)
            sizes = [(box[2] - box[0]) * (box[3] - box[1]) for box in (boxes[index], boxes[other])]
            union = sum(sizes) - common
            if classes[other] == classes[index] and union > 0 and common > iou * union:
                break
        else:
            selected.append(index)
    return selected[:max_count]


corner = st.integers(0, 12)
box = st.tuples(st.tuples(corner, corner, corner, corner), st.integers(1, 8), st.integers(0, 2))


@given(st.lists(box, max_size=25), st.sampled_from([0.0, 0.25, 0.5, 1.0]), st.integers(1, 30))
def test_suppression_matches_slow_reference(rows, iou, max_detections):
    boxes = np.array([row[0] for row in rows], np.float32).reshape(-1, 4)
    scores = np.array([row[1] / 8 for row in rows], np.float32)
    classes = np.array([row[2] for row in rows], np.int32)
    expected = suppress_slowly(boxes.tolist(), scores.tolist(), classes.tolist(), iou, max_detections)
    assert non_maximum_suppression(boxes, scores, classes, iou, max_detections).tolist() == expected
