"""Evaluate a detector on labeled images."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from linkwright.vision.detector import Limits
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector
from linkwright.vision.evaluation import MAX_DETECTIONS, Evaluation, GroundTruth, evaluate
from linkwright.vision.training.images import read_image
from linkwright.vision.training.yolo_dataset import LabeledFile

EVALUATION_LIMITS = Limits(threshold=0.01, iou=0.6, max_detections=MAX_DETECTIONS)
"""The limits of evaluated detections. The threshold is low, because average precision includes uncertain detections."""


def evaluate_detector(model: str | Path, names: Sequence[str], images: Sequence[LabeledFile]) -> Evaluation:
    """Evaluate a detector on labeled images.

    Args:
        model: an ONNX file, or the name of a detector.
        names: the names of the classes in the labels.
        images: the labeled images.

    Raises:
        LinkwrightError: the detector cannot be created; VISION305, an image is broken.
    """
    detector = make_detector(str(model), DetectorOptions())
    detections, ground_truth = [], []
    for labeled_image in images:
        pixels = read_image(labeled_image)
        scale = np.array(pixels.shape[1::-1] * 2, np.float32)
        ground_truth.append(GroundTruth(labeled_image.boxes * scale, labeled_image.classes, labeled_image.ignored))
        detections.append(detector.detect(pixels, EVALUATION_LIMITS))
    return evaluate(names, ground_truth, detections)
