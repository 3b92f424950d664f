"""Scales and compresses images for slow connections, with Pillow."""

from __future__ import annotations

from io import BytesIO
from typing import Any

import numpy as np
from msgspec.structs import replace

from linkwright.page.protocol.images import ImageFrame

_STEPS = ((1, 85), (1, 70), (1, 50), (2, 70), (2, 50), (3, 50), (4, 50), (6, 45), (8, 40), (12, 35), (16, 30))
"""The scale factors and WebP qualities: each step has about two thirds of the bytes of the one before."""

_MOST_TRIES = 3
_MOST_PIXELS = 1 << 26
"""The most pixels of a file that is decoded for scaling; a small file can claim any size."""

_ROOMY = 2.5
"""With so much room left the next image may have a higher quality."""


class ImageCompressor:
    """Compresses a display's images to WebP.

    The last suitable scale and quality for each size are stored, and are tried first for the next image.
    """

    def __init__(self) -> None:
        self._steps: dict[int, int] = {}

    def compressed(self, frame: ImageFrame, size: int) -> ImageFrame:
        """Return the image as a WebP file of at most `size` bytes, or as small as a few attempts allow.

        An image that cannot be read is returned unchanged, because the page reports the error. A file that is already
        smaller than the result is also returned unchanged.
        """
        try:
            return self._compress(frame, size)
        except Exception:  # noqa: BLE001 - a file from a message may be broken in any way
            return frame

    def _compress(self, frame: ImageFrame, size: int) -> ImageFrame:
        image = _opened(frame)
        width, height = frame.width or image.width, frame.height or image.height
        step = self._steps.get(size, 0)
        for _ in range(_MOST_TRIES):
            data, columns, rows = _encoded(image, *_STEPS[step])
            if len(data) <= size or step == len(_STEPS) - 1:
                break
            step = min(len(_STEPS) - 1, step + (1 if len(data) < 1.6 * size else 3))
        self._steps[size] = max(0, step - 1) if len(data) * _ROOMY < size else step
        if frame.encoding == "file" and len(data) >= frame.data.nbytes:
            return frame
        pixels = np.frombuffer(data, np.uint8)
        quality = _STEPS[step][1]
        return replace(
            frame, width=width, height=height, columns=columns, rows=rows, encoding="file", data=pixels, quality=quality
        )


def _opened(frame: ImageFrame) -> Any:
    from PIL import Image

    if frame.encoding == "file":
        file = Image.open(BytesIO(frame.data.tobytes()), formats=("JPEG", "PNG", "GIF", "BMP", "WEBP"))
        if file.width * file.height > _MOST_PIXELS:
            raise ValueError("too many pixels")
        return file.convert("L" if file.mode in ("1", "L", "I;16") else "RGB")
    channels = {"grey": (), "rgb": (3,), "rgba": (4,)}[frame.encoding]
    image = Image.fromarray(frame.data.reshape(frame.rows, frame.columns, *channels))
    return image.convert("RGB") if frame.encoding == "rgba" else image


def _encoded(image: Any, reduction: int, quality: int) -> tuple[bytes, int, int]:
    """Return a WebP file, and its width and height in pixels."""
    small = image.reduce(reduction) if reduction > 1 else image
    file = BytesIO()
    small.save(file, "WEBP", quality=quality, method=0)
    return file.getvalue(), small.width, small.height
