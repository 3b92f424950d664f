"""Draw detections into images."""

from __future__ import annotations

from zlib import crc32

import numpy as np
from numpy.typing import NDArray

from linkwright.images.colour_words import paint_of
from linkwright.vision.detections import Detections
from linkwright.vision.detectors.library import load_opencv

_HUES = 24
_TEXT_SHARE = 1 / 26
"""The height of capitals as a part of the image's: a panel of the page shows images a few hundred pixels high."""
_LEAST_TEXT = 9
"""Pixels."""


def colour_of(name: str) -> tuple[int, int, int]:
    """Return the red, green and blue of a class: the colour in its name, or a constant one for each name."""
    paint = paint_of(name)
    if paint is not None:
        return paint
    hue = crc32(name.encode()) % _HUES / _HUES * 6.0
    rising = hue % 1.0
    high, up, down = 1.0, rising, 1.0 - rising
    parts = ((high, up, 0), (down, high, 0), (0, high, up), (0, down, high), (up, 0, high), (high, 0, down))[int(hue)]
    red, green, blue = (int(55 + 200 * part) for part in parts)
    return red, green, blue


def drawn(image: NDArray[np.uint8], found: Detections) -> NDArray[np.uint8]:
    """Return a copy of the image with a box, a name and a score for each detection.

    Args:
        image: shape ``(height, width, 3)``, red, green, blue; it is not changed.
        found: the detections.
    """
    cv2 = load_opencv()
    canvas = np.array(image, order="C")
    thick = max(1, round(image.shape[0] / 300))
    tall = max(_LEAST_TEXT, round(_TEXT_SHARE * image.shape[0]))
    scale, stroke = cv2.getFontScaleFromHeight(cv2.FONT_HERSHEY_SIMPLEX, tall), max(1, round(tall / 10))
    for index in reversed(range(len(found))):  # draw the most certain last, so that no other covers it
        name = found.name(index)
        colour = colour_of(name)
        left, top, right, bottom = (int(edge) for edge in np.rint(found.boxes[index]))
        if found.corners is not None:
            cv2.polylines(canvas, [np.rint(found.corners[index]).astype(np.int32)], True, colour, thick)
        else:
            cv2.rectangle(canvas, (left, top), (right, bottom), colour, thick)
        text = f"{name} {found.scores[index]:.2f}"
        (width, height), below = cv2.getTextSize(text, cv2.FONT_HERSHEY_SIMPLEX, scale, stroke)
        line = max(height + below, top - thick)
        left = max(0, min(left, image.shape[1] - width))
        cv2.rectangle(canvas, (left, line - height - below), (left + width, line), colour, cv2.FILLED)
        dark = (0, 0, 0) if sum(colour) > 380 else (255, 255, 255)
        cv2.putText(canvas, text, (left, line - below // 2), cv2.FONT_HERSHEY_SIMPLEX, scale, dark, stroke, cv2.LINE_AA)
    return canvas
