"""The detector ``line``, which finds a line on the floor to follow."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.colors import make_color_mask
from linkwright.vision.detectors.devices import refuse_network_options
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import select_detections
from linkwright.vision.detectors.settings import parse_hsv_range, read_number

_DARK_RANGE = (0, 0, 0, 179, 255, 80)
_NAMES = ("line",)


class LineDetector(Detector):
    """A detector of a line: the largest patch of a color in the lower part of the image.

    The line is at the center x of its box: ``(x - width / 2) / (width / 2)`` is its offset from the image's middle,
    from -1 to 1, and positive if the line is to the right. The score is the fraction of searched rows with the line.

    Settings:
        ``color``
            the color of the line as six numbers, see `parse_hsv_range`; dark by default.
        ``part``
            the fraction of the image that is searched, from the bottom; 0.25 by default.
        ``least_area``
            the minimum area of the line, in pixels; 150 by default.

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 a setting is wrong.
    """

    def __init__(self, options: DetectorOptions) -> None:
        load_opencv()
        self._notes = refuse_network_options(options)
        self._color = parse_hsv_range("color", options.settings.get("color", _DARK_RANGE))
        self._searched_share = read_number(options.settings, "part", 0.25, 0.01, 1.0)
        self._min_area = read_number(options.settings, "least_area", 150.0, 1.0, 1e9)

    @property
    def names(self) -> tuple[str, ...]:
        """The only name: ``line``."""
        return _NAMES

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Return the line as one detection, or no detection if it is too small."""
        cv2 = load_opencv()
        height = image.shape[0]
        rows = round(height * self._searched_share)
        if not image.size or rows < 1:
            return Detections.empty(_NAMES)
        searched_region = np.ascontiguousarray(image[height - rows :])
        mask = make_color_mask(cv2.cvtColor(searched_region, cv2.COLOR_RGB2HSV), self._color)
        count, labels, statistics, _ = cv2.connectedComponentsWithStats(mask, connectivity=8)
        if count < 2:
            return Detections.empty(_NAMES)
        largest = 1 + int(statistics[1:, cv2.CC_STAT_AREA].argmax())
        left, top, width, line_height, area = statistics[largest].tolist()
        if area < self._min_area:
            return Detections.empty(_NAMES)
        row_share = float((labels == largest).any(axis=1).mean())
        image_top = height - rows + top
        return select_detections(
            [[left, image_top, left + width, image_top + line_height]], [row_share], [0], _NAMES, limits
        )
