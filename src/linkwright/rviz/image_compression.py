"""Scales and compresses images for slow connections, with Pillow."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from msgspec.structs import replace

from linkwright.page.protocol.images import ImageFrame

_STEPS = ((1, 85), (1, 70), (1, 50), (2, 70), (2, 50), (3, 50), (4, 50), (6, 45), (8, 40), (12, 35), (16, 30))
"""Scale divisors and WebP qualities. Each step gives about two thirds of the bytes of the previous step."""

_MAX_ATTEMPTS = 3
_MAX_PIXELS = 1 << 26
"""Limit for decoding a file, because the header of a small file can declare any size."""

_SPARE_FACTOR = 2.5
"""If the size limit is more than this multiple of the result, the next image gets a higher quality."""


class ImageCompressor:
    """A compressor of a display's images to WebP.

    The last suitable scale and quality for each size are stored, and are tried first for the next image.
    """

    def __init__(self) -> None:
        self._steps: dict[int, int] = {}

    def compress(self, frame: ImageFrame, max_size: int) -> ImageFrame:
        """Return the image as a WebP file of at most `max_size` bytes, if possible.

        An image that cannot be read is returned unchanged, because the page reports the error. A file that is already
        smaller than the result is also returned unchanged.
        """
        try:
            return self._compress(frame, max_size)
        except Exception:  # noqa: BLE001 - a file from a message may be broken in any way
            return frame

    def _compress(self, frame: ImageFrame, max_size: int) -> ImageFrame:
        image = _to_pillow_image(frame)
        width, height = frame.width or image.width, frame.height or image.height
        step = self._steps.get(max_size, 0)
        for _ in range(_MAX_ATTEMPTS):
            data, columns, rows = _encode_webp(image, *_STEPS[step])
            if len(data) <= max_size or step == len(_STEPS) - 1:
                break
            step = min(len(_STEPS) - 1, step + (1 if len(data) < 1.6 * max_size else 3))
        self._steps[max_size] = max(0, step - 1) if len(data) * _SPARE_FACTOR < max_size else step
        if frame.encoding == "file" and len(data) >= frame.data.nbytes:
            return frame
        pixels = np.frombuffer(data, np.uint8)
        quality = _STEPS[step][1]
        return replace(
            frame, width=width, height=height, columns=columns, rows=rows, encoding="file", data=pixels, quality=quality
        )


def _to_pillow_image(frame: ImageFrame) -> Any:
    from PIL import Image

    if frame.encoding == "file":
        file = Image.open(BytesIO(frame.data.tobytes()), formats=("JPEG", "PNG", "GIF", "BMP", "WEBP"))
        if file.width * file.height > _MAX_PIXELS:
            raise ValueError("too many pixels")
        return file.convert("L" if file.mode in ("1", "L", "I;16") else "RGB")
    channels = {"gray": (), "rgb": (3,), "rgba": (4,)}[frame.encoding]
    image = Image.fromarray(frame.data.reshape(frame.rows, frame.columns, *channels))
    return image.convert("RGB") if frame.encoding == "rgba" else image


def _encode_webp(image: Any, reduction: int, quality: int) -> tuple[bytes, int, int]:
    """Return a WebP file, and its width and height in pixels."""
    reduced = image.reduce(reduction) if reduction > 1 else image
    file = BytesIO()
    reduced.save(file, "WEBP", quality=quality, method=0)
    return file.getvalue(), reduced.width, reduced.height
