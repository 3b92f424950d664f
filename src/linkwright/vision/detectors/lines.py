"""The detector ``line``: a line on the floor to follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.colours import mask_of
from linkwright.vision.detectors.devices import without_network
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import most_certain
from linkwright.vision.detectors.settings import hsv_range, number

_DARK = (0, 0, 0, 179, 255, 80)
_NAMES = ("line",)


class LineDetector(Detector):
    """Detects the largest patch of a colour in the lower part of the image.

    The middle of its box is where the line is: ``(x - width / 2) / (width / 2)`` is how far a robot is off, from -1 to
    1 and positive where the line is to the right. The score is the share of rows of that part that have the line.

    Settings:
        ``colour``
            of the line, six numbers, see `hsv_range`; dark unless it is given.
        ``part``
            how much of the image is looked at, from below; 0.25 unless it is given.
        ``least_area``
            of the line, in pixels; 150 unless it is given.

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 a setting is wrong.
    """

    def __init__(self, options: DetectorOptions) -> None:
        load_opencv()
        self._notes = without_network(options)
        self._colour = hsv_range("colour", options.settings.get("colour", _DARK))
        self._part = number(options.settings, "part", 0.25, 0.01, 1.0)
        self._least_area = number(options.settings, "least_area", 150.0, 1.0, 1e9)

    @property
    def names(self) -> tuple[str, ...]:
        """One name: ``line``."""
        return _NAMES

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that it needs no GPU, if it was given one."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Find the line."""
        cv2 = load_opencv()
        height = image.shape[0]
        rows = round(height * self._part)
        if not image.size or rows < 1:
            return Detections.none(_NAMES)
        part = np.ascontiguousarray(image[height - rows :])
        mask = mask_of(cv2.cvtColor(part, cv2.COLOR_RGB2HSV), self._colour)
        count, labels, statistics, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
        if count < 2:
            return Detections.none(_NAMES)
        largest = 1 + int(statistics[1:, cv2.CC_STAT_AREA].argmax())
        left, top, width, tall, area = statistics[largest].tolist()
        if area < self._least_area:
            return Detections.none(_NAMES)
        seen = float((labels == largest).any(axis=1).mean())
        above = height - rows + top
        return most_certain([[left, above, left + width, above + tall]], [seen], [0], _NAMES, limits)
