"""The heights of a heightmap, from the grey values of an image."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from warnings import catch_warnings, simplefilter

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, missing_extra, phrase
from linkwright.geometry.arrays import Array
from linkwright.images.elevation import read_elevation

_MOST = 1025
"""The greatest number of heights along a side; of more every second, third and so on is kept."""


@dataclass(frozen=True, slots=True)
class Heights:
    """Heights relative to the maximum that the image can represent.

    The first row has the minimum y.
    """

    values: Array


def read_heights(path: Path) -> Heights:
    """Read the heights of an image: 0 for black and 1 for white.

    In an elevation model, 0 is the lowest point.

    Raises:
        LinkwrightError: SIM113 the image cannot be read; SIM114 Pillow is not installed.
    """
    try:
        from PIL import Image, UnidentifiedImageError
    except ModuleNotFoundError as error:
        raise missing_extra("SIM114", error) from None
    try:
        with catch_warnings():
            simplefilter("ignore")  # Errors are reported here.
            with Image.open(path) as image:
                kind = image.mode
                shown = image if kind in ("L", "I", "F", "I;16", "I;16B") else image.convert("L")
                values = np.asarray(shown, dtype=np.float64)
    except (OSError, UnidentifiedImageError, ValueError, Image.DecompressionBombError) as error:
        try:
            kind, values = "F", read_elevation(path)
        except (OSError, ValueError):
            message = phrase("cannot read the image '{path}': {why}", path=display_path(path), why=str(error))
            raise LinkwrightError(Diagnostic("SIM113", message)) from None
    stride = -(-max(values.shape) // _MOST)
    values = values[::-stride, ::stride]
    if kind == "F":
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        return Heights(np.nan_to_num((values - low) / (high - low if high > low else 1.0)))
    return Heights(values / (65535.0 if kind.startswith("I") else 255.0))
