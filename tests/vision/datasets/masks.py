"""Masks of the labels of datasets."""

from __future__ import annotations

import numpy as np


def color_mask(counts, height, width):
    """Decode COCO's run lengths: shape (height, width)."""
    values = np.arange(len(counts)) % 2 == 1
    return np.repeat(values, counts).reshape((height, width), order="F")
