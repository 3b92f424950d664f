"""The network ``things``, which detects the objects in Linkwright's worlds.

``things.md`` is its model card.
"""

from __future__ import annotations

from pathlib import Path

from linkwright.vision.detector import Detector
from linkwright.vision.detectors.network import NetworkDetector
from linkwright.vision.detectors.options import DetectorOptions

FILE = Path(__file__).with_name("things.onnx")


def make_things(options: DetectorOptions) -> Detector:
    """Return the detector ``things``.

    Raises:
        LinkwrightError: VISION101 onnxruntime or OpenCV is missing.
    """
    return NetworkDetector(FILE, options)
