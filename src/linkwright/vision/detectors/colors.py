"""The detector ``colors``, which finds patches of one color by hue, saturation and value."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Phrase
from linkwright.vision.detections import Detections
from linkwright.vision.detector import Detector, Limits
from linkwright.vision.detectors.devices import refuse_network_options
from linkwright.vision.detectors.library import load_opencv
from linkwright.vision.detectors.options import DetectorOptions
from linkwright.vision.detectors.selection import select_detections
from linkwright.vision.detectors.settings import parse_hsv_range, read_number, setting_error

COLORS: Mapping[str, tuple[int, ...]] = {
    "red": (172, 110, 60, 6, 255, 255),
    "orange": (8, 130, 80, 20, 255, 255),
    "yellow": (22, 110, 80, 35, 255, 255),
    "green": (40, 80, 50, 85, 255, 255),
    "blue": (95, 110, 50, 130, 255, 255),
    "purple": (132, 80, 50, 165, 255, 255),
}
"""The default colors: minimum hue, saturation and value, then the maximum of each, as in `parse_hsv_range`."""


class ColorDetector(Detector):
    """A detector of patches of a color.

    The score is the fraction of the box that the color fills, such as 0.79 for a ball.

    Settings:
        ``colors``
            a mapping from names to six numbers; see `parse_hsv_range`. If the minimum hue exceeds the maximum, as for
            red, the range wraps around through 0. The default is `COLORS`.
        ``least_area``
            the minimum area of a patch, in pixels; 150 by default.

    Raises:
        LinkwrightError: VISION101 OpenCV is missing, VISION109 a setting is wrong.
    """

    def __init__(self, options: DetectorOptions) -> None:
        load_opencv()
        self._notes = refuse_network_options(options)
        color_settings = options.settings.get("colors", COLORS)
        if not isinstance(color_settings, Mapping) or not color_settings:
            raise setting_error("colors", color_settings)
        self._ranges = {str(name): parse_hsv_range(f"colors.{name}", value) for name, value in color_settings.items()}
        self._min_area = read_number(options.settings, "least_area", 150.0, 1.0, 1e9)

    @property
    def names(self) -> tuple[str, ...]:
        """The names of the colors."""
        return tuple(self._ranges)

    @property
    def notes(self) -> tuple[Phrase, ...]:
        """A remark that the detector does not need a GPU, if one was requested."""
        return self._notes

    def detect(self, image: NDArray[np.uint8], limits: Limits) -> Detections:
        """Find patches of the colors."""
        cv2 = load_opencv()
        boxes: list[tuple[int, int, int, int]] = []
        scores: list[float] = []
        classes: list[int] = []
        hsv = cv2.cvtColor(image, cv2.COLOR_RGB2HSV) if image.size else image
        for index, bounds in enumerate(self._ranges.values() if image.size else ()):
            mask = make_color_mask(hsv, bounds)
            x, y, columns, rows = cv2.boundingRect(mask)  # most colors are absent or in a small part of the image
            if columns * rows < self._min_area:
                continue
            region = mask[y : y + rows, x : x + columns]
            count, _, statistics, _ = cv2.connectedComponentsWithStats(region, connectivity=8)
            for left, top, width, height, area in statistics[1:count].tolist():
                if area >= self._min_area:
                    boxes.append((x + left, y + top, x + left + width, y + top + height))
                    scores.append(area / (width * height))
                    classes.append(index)
        return select_detections(boxes, scores, classes, self.names, limits)


def make_color_mask(hsv: NDArray[np.uint8], bounds: tuple[int, ...]) -> NDArray[np.uint8]:
    """Return the mask of a color: 255 where the image has it, else 0.

    Spots narrower than three pixels are removed from the mask.

    Args:
        hsv: the image in OpenCV's HSV, shape ``(height, width, 3)``.
        bounds: the range of the color; see `parse_hsv_range`.
    """
    cv2 = load_opencv()
    minimum, maximum = np.array(bounds[:3], np.uint8), np.array(bounds[3:], np.uint8)
    if bounds[0] <= bounds[3]:
        mask = cv2.inRange(hsv, minimum, maximum)
    else:
        mask = cv2.inRange(hsv, minimum, np.array([179, *bounds[4:]], np.uint8))
        mask |= cv2.inRange(hsv, np.array([0, *bounds[1:3]], np.uint8), maximum)
    cleaned: NDArray[np.uint8] = cv2.morphologyEx(mask, cv2.MORPH_OPEN, np.ones((3, 3), np.uint8))
    return cleaned
