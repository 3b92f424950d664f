"""The colour of an object in an image, as a word."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.images.color_words import RGB_BY_COLOR_WORD
from linkwright.vision.places.camera import Floats

COLOURS = tuple(RGB_BY_COLOR_WORD)
"""The English words for colours."""

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
_GREY_SATURATION, _GREY_CHROMA = 0.22, 0.10
_BLACK_VALUE, _WHITE_VALUE = 0.16, 0.72
_BROWN_VALUE = 0.55
_MIN_COLOUR_SHARE = 0.35
"""The minimum fraction of pixels in the middle of a box that must have the colour of the object."""
_SAMPLED_SHARE = 0.7
_MAX_SAMPLES = 24
"""The maximum number of pixels used along a side. Larger boxes are subsampled."""


def object_color(image: NDArray[np.uint8], box: NDArray[np.floating]) -> str | None:
    """Return the colour of the object in a box, one of `COLOURS`.

    The colour is the most frequent one among the pixels of an ellipse in the middle of the box. Bright colours take
    precedence over white, grey and black, because glints and shadows add these to every image.

    Args:
        image: shape ``(height, width, 3)``, RGB.
        box: left, top, right, bottom, pixels.

    Returns:
        The colour; None if the box is outside the image or no colour is frequent enough.
    """
    height, width = image.shape[:2]
    centre = np.array([box[0] + box[2], box[1] + box[3]], np.float64) / 2
    half_size = np.array([box[2] - box[0], box[3] - box[1]], np.float64) / 2 * _SAMPLED_SHARE
    steps = np.linspace(-1, 1, _MAX_SAMPLES)
    columns = np.floor(centre[0] + half_size[0] * steps).astype(int)
    rows = np.floor(centre[1] + half_size[1] * steps).astype(int)
    is_inside = (np.square(steps)[:, None] + np.square(steps)[None, :]) <= 1.0
    is_inside &= ((rows >= 0) & (rows < height))[:, None] & ((columns >= 0) & (columns < width))[None, :]
    if not is_inside.any():
        return None
    sampled = image[rows.clip(0, height - 1)[:, None], columns.clip(0, width - 1)[None, :]][is_inside]
    names = classify_colours(sampled)
    counts = np.bincount(names, minlength=len(COLOURS)) / len(names)
    bright_counts = counts.copy()
    bright_counts[[COLOURS.index(name) for name in ("white", "grey", "black")]] = 0
    best = int(np.argmax(bright_counts))
    if bright_counts[best] >= _MIN_COLOUR_SHARE:
        return COLOURS[best]
    best = int(np.argmax(counts))
    return COLOURS[best] if counts[best] >= _MIN_COLOUR_SHARE else None


def classify_colours(pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Return the index in `COLOURS` of each pixel's colour.

    The shape is ``(n,)`` for RGB pixels of shape ``(n, 3)``.
    """
    values = np.ascontiguousarray(pixels.T) / 255.0  # one contiguous row per channel halves the time of the comparisons
    maxima, minima = values.max(axis=0), values.min(axis=0)
    chroma = maxima - minima
    saturation = chroma / np.maximum(maxima, 1e-9)
    is_grey = (saturation < _GREY_SATURATION) | (chroma < _GREY_CHROMA)
    indices = np.full(len(pixels), COLOURS.index("grey"), np.intp)
    indices[is_grey & (maxima >= _WHITE_VALUE)] = COLOURS.index("white")
    has_hue = np.flatnonzero(~is_grey & (maxima >= _BLACK_VALUE))  # few pixels of most images need a hue
    indices[has_hue] = _classify_hues(values[:, has_hue], maxima[has_hue], chroma[has_hue], saturation[has_hue])
    indices[(is_grey & (maxima < 0.3)) | (maxima < _BLACK_VALUE)] = COLOURS.index("black")
    return indices


def _classify_hues(values: Floats, maxima: Floats, chroma: Floats, saturation: Floats) -> NDArray[np.intp]:
    """Return the indices in `COLOURS` for pixels that are not grey, white or black."""
    hue = _hue_degrees(values, maxima, chroma)
    indices = np.full(len(hue), COLOURS.index("red"), np.intp)
    for limit, name in reversed(_HUE_LIMITS):
        indices[hue < limit] = COLOURS.index(name)
    indices[(hue >= _PINK_HUES[0]) & (hue < _PINK_HUES[1])] = COLOURS.index("pink")
    indices[hue >= _PINK_HUES[1]] = COLOURS.index("red")
    is_pale_red = (indices == COLOURS.index("red")) & (saturation < 0.55) & (maxima > 0.7)
    indices[is_pale_red] = COLOURS.index("pink")
    indices[(indices == COLOURS.index("orange")) & (maxima < _BROWN_VALUE)] = COLOURS.index("brown")
    return indices


def _hue_degrees(values: Floats, maxima: Floats, chroma: Floats) -> Floats:
    """Return the hues in degrees, where red and grey have 0."""
    red, green, blue = values
    divisor = np.maximum(chroma, 1e-9)
    sixths = np.where(
        maxima == red,
        ((green - blue) / divisor) % 6,
        np.where(maxima == green, (blue - red) / divisor + 2, (red - green) / divisor + 4),
    )
    return np.where(chroma > 0, sixths * 60, 0.0)
