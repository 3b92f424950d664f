"""Images with detections drawn into them."""

from __future__ import annotations

from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from linkwright.images.color_words import find_rgb
from linkwright.vision.detections import Detections
from linkwright.vision.detectors.library import load_opencv

_HUE_COUNT = 24
_TEXT_HEIGHT_FRACTION = 1 / 26
"""The height of capitals as a fraction of the image height, readable in a panel that is a few hundred pixels high."""
_MIN_TEXT_HEIGHT = 9
"""The minimum height of capitals in pixels."""


def choose_class_color(name: str) -> tuple[int, int, int]:
    """Return the color for a class name: red, green and blue, from 0 to 255.

    A name that contains a color word gets that color. For any other name, the color is computed from the name.
    """
    named_color = find_rgb(name)
    if named_color is not None:
        return named_color
    hue = crc32(name.encode()) % _HUE_COUNT / _HUE_COUNT * 6.0
    full, rising, falling = 1.0, hue % 1.0, 1.0 - hue % 1.0
    channels = (
        (full, rising, 0),
        (falling, full, 0),
        (0, full, rising),
        (0, falling, full),
        (rising, 0, full),
        (full, 0, falling),
    )[int(hue)]
    red, green, blue = (int(55 + 200 * channel) for channel in channels)
    return red, green, blue


def draw_detections(image: NDArray[np.uint8], detections: Detections) -> NDArray[np.uint8]:
    """Return a copy of the image with a box, a name and a score for each detection.

    Args:
        image: shape ``(height, width, 3)``, red, green, blue; it is not changed.
        detections: the detections of the image.
    """
    cv2 = load_opencv()
    canvas = np.array(image, order="C")
    line_width = max(1, round(image.shape[0] / 300))
    text_height = max(_MIN_TEXT_HEIGHT, round(_TEXT_HEIGHT_FRACTION * image.shape[0]))
    font_scale, stroke_width = (
        cv2.getFontScaleFromHeight(cv2.FONT_HERSHEY_SIMPLEX, text_height),
        max(1, round(text_height / 10)),
    )
    for index in reversed(range(len(detections))):  # draw the most certain detection last, so that it is not covered
        name = detections.name(index)
        color = choose_class_color(name)
        left, top, right, bottom = (int(edge) for edge in np.rint(detections.boxes[index]))
        if detections.corners is not None:
            cv2.polylines(canvas, [np.rint(detections.corners[index]).astype(np.int32)], True, color, line_width)
        else:
            cv2.rectangle(canvas, (left, top), (right, bottom), color, line_width)
        text = f"{name} {detections.scores[index]:.2f}"
        (width, height), descent = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, font_scale, stroke_width)
        text_bottom = max(height + descent, top - line_width)
        left = max(0, min(left, image.shape[1] - width))
        cv2.rectangle(canvas, (left, text_bottom - height - descent), (left + width, text_bottom), color, cv2.FILLED)
        text_color = (0, 0, 0) if sum(color) > 380 else (255, 255, 255)
        cv2.putText(
            canvas,
            text,
            (left, text_bottom - descent // 2),
            cv2.FONT_HERSHEY_SIMPLEX,
            font_scale,
            text_color,
            stroke_width,
            cv2.LINE_AA,
        )
    return canvas
