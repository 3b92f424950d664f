"""Determine the colour of an object in an image, as a word."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from linkwright.images.colour_words import PAINTS
from linkwright.vision.places.camera import Floats

COLOURS = tuple(PAINTS)
"""The words, in English."""

_HUES = ((16, "red"), (42, "orange"), (70, "yellow"), (165, "green"), (195, "cyan"), (262, "blue"), (292, "purple"))
"""Up to which hue, in degrees, a colour is called so; then pink, and red again."""
_PINK_HUES = (292, 340)
_GREY_SATURATION, _GREY_CHROMA = 0.22, 0.10
_BLACK, _WHITE = 0.16, 0.72
_DARK_ORANGE = 0.55
_LEAST_SHARE = 0.35
"""The least part of the middle of a box that has a colour, so that the object is called so."""
_MIDDLE = 0.7
_MOST_PIXELS = 24
"""The most pixels used along a side; larger boxes are subsampled."""


def colour_of(image: NDArray[np.uint8], box: NDArray[np.floating]) -> str | None:
    """Return the colour of the object in a box, one of `COLOURS`.

    The colour is the most frequent one among the pixels of an ellipse in the middle of the box. Bright colours
    win over white, grey and black, which glints and shadows add to every image.

    Args:
        image: shape ``(height, width, 3)``, RGB.
        box: left, top, right, bottom, pixels.

    Returns:
        None if the box is outside the image or has many colours.
    """
    height, width = image.shape[:2]
    middle = np.array([box[0] + box[2], box[1] + box[3]], np.float64) / 2
    half = np.array([box[2] - box[0], box[3] - box[1]], np.float64) / 2 * _MIDDLE
    steps = np.linspace(-1, 1, _MOST_PIXELS)
    columns = np.floor(middle[0] + half[0] * steps).astype(int)
    rows = np.floor(middle[1] + half[1] * steps).astype(int)
    inside = (np.square(steps)[:, None] + np.square(steps)[None, :]) <= 1.0
    inside &= ((rows >= 0) & (rows < height))[:, None] & ((columns >= 0) & (columns < width))[None, :]
    if not inside.any():
        return None
    sampled = image[rows.clip(0, height - 1)[:, None], columns.clip(0, width - 1)[None, :]][inside]
    names = named_colours(sampled)
    counts = np.bincount(names, minlength=len(COLOURS)) / len(names)
    bright = counts.copy()
    bright[[COLOURS.index(name) for name in ("white", "grey", "black")]] = 0
    best = int(np.argmax(bright))
    if bright[best] >= _LEAST_SHARE:
        return COLOURS[best]
    best = int(np.argmax(counts))
    return COLOURS[best] if counts[best] >= _LEAST_SHARE else None


def named_colours(pixels: NDArray[np.uint8]) -> NDArray[np.intp]:
    """Return the index in `COLOURS` of each RGB pixel; shape ``(n, 3)`` in, ``(n,)`` out."""
    values = np.ascontiguousarray(pixels.T) / 255.0  # one contiguous row per channel halves the time of the comparisons
    most, least = values.max(axis=0), values.min(axis=0)
    chroma = most - least
    saturation = chroma / np.maximum(most, 1e-9)
    grey = (saturation < _GREY_SATURATION) | (chroma < _GREY_CHROMA)
    found = np.full(len(pixels), COLOURS.index("grey"), np.intp)
    found[grey & (most >= _WHITE)] = COLOURS.index("white")
    coloured = np.flatnonzero(~grey & (most >= _BLACK))  # few pixels of most images need a hue
    found[coloured] = _named_hues(values[:, coloured], most[coloured], chroma[coloured], saturation[coloured])
    found[(grey & (most < 0.3)) | (most < _BLACK)] = COLOURS.index("black")
    return found


def _named_hues(values: Floats, most: Floats, chroma: Floats, saturation: Floats) -> NDArray[np.intp]:
    """Return the indices in `COLOURS` of pixels that are neither grey, white nor black."""
    hue = _hue(values, most, chroma)
    found = np.full(len(hue), COLOURS.index("red"), np.intp)
    for limit, name in reversed(_HUES):
        found[hue < limit] = COLOURS.index(name)
    found[(hue >= _PINK_HUES[0]) & (hue < _PINK_HUES[1])] = COLOURS.index("pink")
    found[hue >= _PINK_HUES[1]] = COLOURS.index("red")
    pale_red = (found == COLOURS.index("red")) & (saturation < 0.55) & (most > 0.7)
    found[pale_red] = COLOURS.index("pink")
    found[(found == COLOURS.index("orange")) & (most < _DARK_ORANGE)] = COLOURS.index("brown")
    return found


def _hue(values: Floats, most: Floats, chroma: Floats) -> Floats:
    """Return the hue in degrees, 0 for red and for grey."""
    red, green, blue = values
    safe = np.maximum(chroma, 1e-9)
    sixths = np.where(
        most == red,
        ((green - blue) / safe) % 6,
        np.where(most == green, (blue - red) / safe + 2, (red - green) / safe + 4),
    )
    return np.where(chroma > 0, sixths * 60, 0.0)
