"""The heights of a heightmap, from the gray values of an image."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from warnings import catch_warnings, simplefilter

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, missing_extra, phrase
from linkwright.geometry.arrays import Array
from linkwright.images.elevation import read_elevation

_MAX_SIDE = 1025
"""The maximum number of heights along a side. Of a larger image, only every n-th row and column is used."""


@dataclass(frozen=True, slots=True)
class Heights:
    """Heights from 0 to 1. See `read_heights` for the scale.

    The first row has the minimum y, so the image's rows are in reverse order.
    """

    values: Array


def read_heights(path: Path) -> Heights:
    """Read the heights of an image: 0 for black, 1 for white.

    In an image of floating-point numbers, such as an elevation model, 0 is the lowest point and 1 the highest.

    Raises:
        LinkwrightError: SIM113, the image cannot be read; SIM114 Pillow is not installed.
    """
    try:
        from PIL import Image, UnidentifiedImageError
    except ModuleNotFoundError as error:
        raise missing_extra("SIM114", error) from None
    try:
        with catch_warnings():
            simplefilter("ignore")  # such as DecompressionBombWarning; errors are reported below
            with Image.open(path) as image:
                mode = image.mode
                gray = image if mode in ("L", "I", "F", "I;16", "I;16B") else image.convert("L")
                values = np.asarray(gray, dtype=np.float64)
    except (OSError, UnidentifiedImageError, ValueError, Image.DecompressionBombError) as error:
        try:
            mode, values = "F", read_elevation(path)
        except (OSError, ValueError):
            message = phrase("cannot read the image '{path}': {reason}", path=display_path(path), reason=str(error))
            raise LinkwrightError(Diagnostic("SIM113", message)) from None
    stride = -(-max(values.shape) // _MAX_SIDE)
    values = values[::-stride, ::stride]
    if mode == "F":
        minimum, maximum = float(np.nanmin(values)), float(np.nanmax(values))
        return Heights(np.nan_to_num((values - minimum) / (maximum - minimum if maximum > minimum else 1.0)))
    return Heights(values / (65535.0 if mode.startswith("I") else 255.0))
