"""The size of textures."""

from __future__ import annotations

from io import BytesIO

import pytest
from PIL import Image

from linkwright.simulation.scene.textures import MAX_TEXTURE_PIXELS, limit_texture_size


def make_png(mode: str, size: tuple[int, int]) -> bytes:
    """Return an image whose left half is black and whose right half is white."""
    image = Image.new("L", size, 0)
    image.paste(255, (size[0] // 2, 0, *size))
    file = BytesIO()
    image.convert(mode).save(file, "PNG")
    return file.getvalue()


@pytest.mark.parametrize("mode", ["1", "L", "P", "RGB", "RGBA"])
def test_large_texture_is_scaled_down(mode: str) -> None:
    image = Image.open(BytesIO(limit_texture_size(make_png(mode, (2 * MAX_TEXTURE_PIXELS, MAX_TEXTURE_PIXELS)))))
    assert image.size == (MAX_TEXTURE_PIXELS, MAX_TEXTURE_PIXELS // 2)
    assert image.mode in ("RGB", "RGBA")
    colors = [image.convert("RGB").getpixel((x, 9)) for x in (5, MAX_TEXTURE_PIXELS - 5)]
    assert colors == [(0, 0, 0), (255, 255, 255)]


def test_texture_of_maximum_size_does_not_change() -> None:
    png = make_png("RGB", (MAX_TEXTURE_PIXELS, 8))
    assert limit_texture_size(png) is png
