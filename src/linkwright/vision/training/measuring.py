"""Run a detector on labelled images and evaluate it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from linkwright.vision.detector import Limits
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.registry import make_detector
from linkwright.vision.evaluation import MOST, Evaluation, GroundTruth, evaluate
from linkwright.vision.training.images import read_image
from linkwright.vision.training.reading import Labelled

LIMITS = Limits(threshold=0.01, iou=0.6, most=MOST)
"""The limits of evaluated detections: uncertain ones count too, because average precision rates their order."""


def measure(model: str | Path, names: Sequence[str], labelled: Sequence[Labelled]) -> Evaluation:
    """Evaluate a detector on images.

    Args:
        model: an ONNX file, or the name of a detector.
        names: the names of the classes in the labels.
        labelled: the images.

    Raises:
        LinkwrightError: the detector cannot be created; VISION305, an image is broken.
    """
    detector = make_detector(str(model), DetectorOptions())
    found, truth = [], []
    for labelled_image in labelled:
        image = read_image(labelled_image)
        scale = np.array(image.shape[1::-1] * 2, np.float32)
        truth.append(GroundTruth(labelled_image.boxes * scale, labelled_image.classes, labelled_image.ignored))
        found.append(detector.detect(image, LIMITS))
    return evaluate(names, truth, found)
