"""Colors on the screen, from screenshots."""

from __future__ import annotations

import io
import math
from typing import Any

from PIL import Image

Color = tuple[int, int, int]


def colors_at(page: Any, *pixels: tuple[float, float]) -> list[Color]:
    """Return the page's colors at some pixels, all from one screenshot."""
    xs, ys = ([math.floor(pixel[axis]) for pixel in pixels] for axis in (0, 1))
    x, y = min(xs), min(ys)
    clip = {"x": x, "y": y, "width": max(xs) - x + 1, "height": max(ys) - y + 1}
    with Image.open(io.BytesIO(page.screenshot(clip=clip))) as image:
        colors = image.convert("RGB")
    return [colors.getpixel((column - x, row - y)) for column, row in zip(xs, ys, strict=True)]
