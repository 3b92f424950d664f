"""The size of textures."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO

MAX_TEXTURE_PIXELS = 2048
"""The maximum width and height of a texture, in pixels."""


@lru_cache(maxsize=16)
def limit_texture_size(png: bytes) -> bytes:
    """Return a PNG image scaled down to `MAX_TEXTURE_PIXELS`, or the image itself if it is not larger.

    MuJoCo decodes every texture each time it compiles the scene, so when a model is spawned, too. Images of markers
    with 8000 x 8000 pixels, which no camera resolves, would take seconds.
    """
    width, height = (int.from_bytes(png[start : start + 4], "big") for start in (16, 20))  # PNG begins with its size
    if max(width, height) <= MAX_TEXTURE_PIXELS:
        return png
    from PIL import Image  # Pillow is an optional extra, without which there are no textures.

    image: Image.Image = Image.open(BytesIO(png))
    has_transparency = image.mode in ("RGBA", "LA", "PA", "P")
    if image.mode not in ("L", "RGB", "RGBA"):
        image = image.convert("L" if image.mode == "1" else "RGBA" if has_transparency else "RGB")
    image.thumbnail((MAX_TEXTURE_PIXELS, MAX_TEXTURE_PIXELS))
    file = BytesIO()
    image.convert("RGBA" if has_transparency else "RGB").save(file, "PNG")
    return file.getvalue()
