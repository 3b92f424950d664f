"""Images that are stored as files: the transport `compressed`, and the files inside `compressedDepth`."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase
from linkwright.diagnostics.extras import install_hint
from linkwright.images.decoding import BadImageError

MOST_PIXELS = 1 << 24
"""No image with more pixels is unpacked here: a small file can claim any size."""

_PNG, _JPEG = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"
_PNG_END, _JPEG_END = b"IEND", b"\xff\xd9"
_TAIL = 256
"""Bytes that are looked at first for the end of a file."""


@dataclass(frozen=True, slots=True)
class RawImage:
    """An unpacked image, with the fields of a sensor_msgs/msg/Image.

    Attributes:
        header: the header of its message.
        width: the width in pixels.
        height: the height in pixels.
        encoding: the encoding of the pixels.
        data: the pixels, row by row, little-endian.
        step: the bytes per row.
        is_bigendian: 0.
    """

    header: Any
    width: int
    height: int
    encoding: str
    data: NDArray[np.uint8]
    step: int
    is_bigendian: int = 0

    @classmethod
    def of(cls, header: Any, encoding: str, values: NDArray[Any]) -> RawImage:
        """Return the image of an array of values, shape (height, width) or (height, width, channels)."""
        height, width = values.shape[:2]
        data = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).view(np.uint8).ravel()
        return cls(header, width, height, encoding, data, data.size // max(1, height))


def is_cut_off(data: NDArray[np.uint8]) -> bool:
    """Return whether a JPEG or PNG file lacks its end.

    Some cameras append meaningless bytes after the end.
    """
    start = data[: len(_PNG)].tobytes()
    end = _JPEG_END if start.startswith(_JPEG) else _PNG_END if start == _PNG else b""
    return end not in data[-_TAIL:].tobytes() and end not in data.tobytes()


def file_pixels(data: NDArray[np.uint8]) -> NDArray[Any]:
    """Return the pixels of a PNG or JPEG.

    The shape is (height, width) of uint8 or uint16, or (height, width, 3 or 4) of uint8.

    Raises:
        BadImageError: the data is neither, has too many pixels, or is broken.
    """
    try:
        from PIL import JpegImagePlugin, PngImagePlugin
    except ModuleNotFoundError:
        raise BadImageError(
            phrase("PNG and JPEG files cannot be decoded: {hint}", hint=install_hint("image"))
        ) from None
    start = data[:8].tobytes()
    if not start.startswith((_PNG, _JPEG)):
        raise BadImageError(phrase("The image is neither a PNG nor a JPEG"))
    reader = PngImagePlugin.PngImageFile if start == _PNG else JpegImagePlugin.JpegImageFile
    try:
        # Image.open is not used: it accepts more formats, and warns of sizes that are refused below.
        file = reader(BytesIO(data.tobytes()))
        width, height = file.size
        if width * height <= MOST_PIXELS:
            return _plain(file)
    except Exception as error:  # noqa: BLE001 - a file from a message may be broken in any way
        raise BadImageError(
            phrase(
                "The {kind} cannot be read: {error}",
                kind=file_kind(start),
                error=foreign(error or type(error).__name__),
            )
        ) from None
    raise BadImageError(
        phrase(
            "The {kind} has {width} x {height} pixels; at most {most} are supported",
            kind=file_kind(start),
            width=width,
            height=height,
            most=MOST_PIXELS,
        )
    )


def file_kind(start: bytes) -> str:
    """Return the format of a file, PNG or JPEG, from its first bytes."""
    return "PNG" if start.startswith(_PNG) else "JPEG"


def unpacked(message: Any) -> RawImage:
    """Return the image of a message of the transport `compressed`.

    The encoding is that of the file. For pixels with 16 bits (depths), the format of the message names the encoding; a
    JPEG contains only their upper 8 bits, as in compressed_image_transport.

    Args:
        message: sensor_msgs/msg/CompressedImage, whose format begins with the encoding of the raw image.

    Raises:
        BadImageError: see `file_pixels`.
    """
    pixels = file_pixels(np.frombuffer(message.data, np.uint8))
    encoding = encoding_of(message)
    if pixels.ndim == 3:
        return RawImage.of(message.header, {3: "rgb8", 4: "rgba8"}[pixels.shape[2]], pixels)
    if encoding not in ("16UC1", "mono16"):
        encoding = "mono16" if pixels.dtype == np.uint16 else "mono8"
    elif pixels.dtype == np.uint8:
        pixels = pixels.astype(np.uint16) << 8
    return RawImage.of(message.header, encoding, pixels)


def encoding_of(message: Any) -> str:
    """Return the encoding of the raw image of a sensor_msgs/msg/CompressedImage, according to its format."""
    encoding: str = message.format.partition(";")[0].strip()
    return encoding


def _plain(file: Any) -> NDArray[Any]:
    """Return the pixels of a file in one of the array types returned by `file_pixels`."""
    if file.mode in ("I;16", "L", "RGB", "RGBA"):
        return np.asarray(file)
    transparent = file.mode in ("LA", "PA") or "transparency" in file.info
    return np.asarray(file.convert("L" if file.mode == "1" else "RGBA" if transparent else "RGB"))
