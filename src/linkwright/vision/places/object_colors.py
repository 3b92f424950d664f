"""The color of an object in an image, as a word."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.images.color_words import RGB_BY_COLOR_WORD
from linkwright.vision.places.camera import Floats

COLORS = tuple(RGB_BY_COLOR_WORD)
"""The English words for colors."""

_HUE_LIMITS = (
    (16, "red"),
    (42, "orange"),
    (70, "yellow"),
    (165, "green"),
    (195, "cyan"),
    (262, "blue"),
    (292, "purple"),
)
"""The upper limits of hues in degrees. Above the last limit are pink and red."""
_PINK_HUES = (292, 340)
_GRAY_SATURATION, _GRAY_CHROMA = 0.22, 0.10
_BLACK_VALUE, _WHITE_VALUE = 0.16, 0.72
_BROWN_VALUE = 0.55
_MIN_COLOR_FRACTION = 0.35
"""The minimum fraction of pixels in the middle of a box that must have the color of the object."""
_SAMPLED_FRACTION = 0.7
"""The central fraction of a box's width and height whose pixels are sampled."""
_MAX_SAMPLES = 24
"""The maximum number of pixels used along a side. Larger boxes are subsampled."""


def find_object_color(image: NDArray[np.uint8], box: NDArray[np.floating]) -> str | None:
    """Return the color of the object in a box, one of `COLORS`.

    The color is the most frequent one among the pixels of an ellipse in the middle of the box. Bright colors take
    precedence over white, gray and black, because glints and shadows add these to every image.

    Args:
        image: shape ``(height, width, 3)``, RGB.
        box: left, top, right, bottom, pixels.

    Returns:
        The color; None if the box is outside the image or no color is frequent enough.
    """
    height, width = image.shape[:2]
    center = np.array([box[0] + box[2], box[1] + box[3]], np.float64) / 2
    half_size = np.array([box[2] - box[0], box[3] - box[1]], np.float64) / 2 * _SAMPLED_FRACTION
    steps = np.linspace(-1, 1, _MAX_SAMPLES)
    columns = np.floor(center[0] + half_size[0] * steps).astype(int)
    rows = np.floor(center[1] + half_size[1] * steps).astype(int)
    is_inside = (np.square(steps)[:, None] + np.square(steps)[None, :]) <= 1.0
    is_inside &= ((rows >= 0) & (rows < height))[:, None] & ((columns >= 0) & (columns < width))[None, :]
    if not is_inside.any():
        return None
    sampled = image[rows.clip(0, height - 1)[:, None], columns.clip(0, width - 1)[None, :]][is_inside]
    names = classify_colors(sampled)
    counts = np.bincount(names, minlength=len(COLORS)) / len(names)
    bright_counts = counts.copy()
    bright_counts[[COLORS.index(name) for name in ("white", "grey", "black")]] = 0
    best = int(np.argmax(bright_counts))
    if bright_counts[best] >= _MIN_COLOR_FRACTION:
        return COLORS[best]
    best = int(np.argmax(counts))
    return COLORS[best] if counts[best] >= _MIN_COLOR_FRACTION else None


def classify_colors(pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Return the index in `COLORS` of each pixel's color.

    The shape is ``(n,)`` for RGB pixels of shape ``(n, 3)``.
    """
    values = np.ascontiguousarray(pixels.T) / 255.0  # one contiguous row per channel halves the time of the comparisons
    maxima, minima = values.max(axis=0), values.min(axis=0)
    chroma = maxima - minima
    saturation = chroma / np.maximum(maxima, 1e-9)
    is_gray = (saturation < _GRAY_SATURATION) | (chroma < _GRAY_CHROMA)
    indices = np.full(len(pixels), COLORS.index("grey"), np.intp)
    indices[is_gray & (maxima >= _WHITE_VALUE)] = COLORS.index("white")
    has_hue = np.flatnonzero(~is_gray & (maxima >= _BLACK_VALUE))  # few pixels of most images need a hue
    indices[has_hue] = _classify_hues(values[:, has_hue], maxima[has_hue], chroma[has_hue], saturation[has_hue])
    indices[(is_gray & (maxima < 0.3)) | (maxima < _BLACK_VALUE)] = COLORS.index("black")
    return indices


def _classify_hues(values: Floats, maxima: Floats, chroma: Floats, saturation: Floats) -> NDArray[np.intp]:
    """Return the indices in `COLORS` for pixels that are not gray, white or black."""
    hue = _compute_hues_degrees(values, maxima, chroma)
    indices = np.full(len(hue), COLORS.index("red"), np.intp)
    for limit, name in reversed(_HUE_LIMITS):
        indices[hue < limit] = COLORS.index(name)
    indices[(hue >= _PINK_HUES[0]) & (hue < _PINK_HUES[1])] = COLORS.index("pink")
    indices[hue >= _PINK_HUES[1]] = COLORS.index("red")
    is_pale_red = (indices == COLORS.index("red")) & (saturation < 0.55) & (maxima > 0.7)
    indices[is_pale_red] = COLORS.index("pink")
    indices[(indices == COLORS.index("orange")) & (maxima < _BROWN_VALUE)] = COLORS.index("brown")
    return indices


def _compute_hues_degrees(values: Floats, maxima: Floats, chroma: Floats) -> Floats:
    """Return the hues in degrees, where red and gray have 0."""
    red, green, blue = values
    divisor = np.maximum(chroma, 1e-9)
    sixths = np.where(
        maxima == red,
        ((green - blue) / divisor) % 6,
        np.where(maxima == green, (blue - red) / divisor + 2, (red - green) / divisor + 4),
    )
    return np.where(chroma > 0, sixths * 60, 0.0)
