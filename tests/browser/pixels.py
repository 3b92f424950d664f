"""Colors on the screen, read from screenshots."""

from __future__ import annotations

import io
import math
from typing import Any

from PIL import Image

Color = tuple[int, int, int]


def colors_at(page: Any, *places: tuple[float, float]) -> list[Color]:
    """The colors of the page at some places, pixels from its upper left corner, at one moment."""
    xs, ys = ([math.floor(place[axis]) for place in places] for axis in (0, 1))
    x, y = min(xs), min(ys)
    clip = {"x": x, "y": y, "width": max(xs) - x + 1, "height": max(ys) - y + 1}
    with Image.open(io.BytesIO(page.screenshot(clip=clip))) as image:
        colors = image.convert("RGB")
    return [colors.getpixel((column - x, row - y)) for column, row in zip(xs, ys, strict=True)]
