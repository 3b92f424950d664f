"""The comparison of the images of maps: size, and the cells that changed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.navigation.maps.images import read_image
from linkwright.review.changes import Figure
from linkwright.review.file_pair import FilePair


def compare_maps(pair: FilePair) -> None:
    """Compare two versions of the image of a map, cell by cell."""
    images = pair.read(_shade)
    if images is None:
        return
    old, new = images
    if old.shape != new.shape:
        old_text, new_text = (f"{image.shape[1]} x {image.shape[0]}" for image in images)
        pair.figures.append(Figure(phrase("size of the map"), old_text, new_text, "cells"))
        return
    rows, columns = np.nonzero(old != new)
    if not len(rows):
        pair.add(phrase("contents changed, with the same cells"), None)
        return
    text = phrase(
        "{share:.2g} % of the cells changed, in columns {left} to {right} and rows {top} to {bottom} of the image",
        share=100.0 * len(rows) / old.size,
        left=int(columns.min()),
        right=int(columns.max()),
        top=int(rows.min()),
        bottom=int(rows.max()),
    )
    pair.add(text, None)


def _shade(file: Path) -> NDArray[np.float64]:
    """Return the brightness of the cells, shape (rows, columns)."""
    return read_image(file).shade
