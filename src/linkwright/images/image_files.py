"""Images stored as files: the transport ``compressed``, and PNG in ``compressedDepth``."""

from __future__ import annotations

from dataclasses import dataclass
from io import BytesIO
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import foreign, phrase
from linkwright.diagnostics.extras import install_hint
from linkwright.images.decoding import BadImageError

MAX_PIXELS = 1 << 24
"""The maximum number of pixels of an image to decode: a small file can claim any size."""

_PNG_START, _JPEG_START = b"\x89PNG\r\n\x1a\n", b"\xff\xd8\xff"
_PNG_END, _JPEG_END = b"IEND", b"\xff\xd9"
_TAIL_BYTES = 256
"""The number of bytes at the end of a file in which its end marker is searched first."""


@dataclass(frozen=True, slots=True)
class RawImage:
    """A decoded image, with the fields of a sensor_msgs/msg/Image.

    Attributes:
        header: the header of its message.
        width: the width in pixels.
        height: the height in pixels.
        encoding: the encoding of the pixels.
        data: the pixels, row by row from the top, little-endian.
        step: the bytes per row.
        is_bigendian: always 0.
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
        """Return the image of an array, shape (height, width) or (height, width, channels)."""
        height, width = values.shape[:2]
        data = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).view(np.uint8).ravel()
        return cls(header, width, height, encoding, data, data.size // max(1, height))


def is_cut_off(data: NDArray[np.uint8]) -> bool:
    """Return whether a JPEG or PNG file lacks its end marker.

    Some cameras append meaningless bytes after the marker.
    """
    first_bytes = data[: len(_PNG_START)].tobytes()
    end_marker = _JPEG_END if first_bytes.startswith(_JPEG_START) else _PNG_END if first_bytes == _PNG_START else b""
    return end_marker not in data[-_TAIL_BYTES:].tobytes() and end_marker not in data.tobytes()


def decode_file(data: NDArray[np.uint8]) -> NDArray[Any]:
    """Return the pixels of a PNG or JPEG file.

    The shape is (height, width) with uint8 or uint16, or (height, width, 3 or 4) with uint8.

    Raises:
        BadImageError: the data is neither a PNG nor a JPEG, has too many pixels, or is damaged; or Pillow is missing.
    """
    try:
        from PIL import JpegImagePlugin, PngImagePlugin
    except ModuleNotFoundError:
        raise BadImageError(
            phrase("PNG and JPEG files cannot be decoded: {hint}", hint=install_hint("image"))
        ) from None
    first_bytes = data[:8].tobytes()
    if not first_bytes.startswith((_PNG_START, _JPEG_START)):
        raise BadImageError(phrase("The image is neither a PNG nor a JPEG"))
    reader = PngImagePlugin.PngImageFile if first_bytes == _PNG_START else JpegImagePlugin.JpegImageFile
    try:
        # Image.open is not used: it accepts more formats, and warns of sizes that are rejected below.
        file = reader(BytesIO(data.tobytes()))
        width, height = file.size
        if width * height <= MAX_PIXELS:
            return _to_array(file)
    except Exception as error:  # noqa: BLE001 - a file from a message may be broken in any way
        raise BadImageError(
            phrase(
                "The {kind} cannot be read: {error}",
                kind=find_file_format(first_bytes),
                error=foreign(error or type(error).__name__),
            )
        ) from None
    raise BadImageError(
        phrase(
            "The {kind} has {width} x {height} pixels; at most {maximum} are supported",
            kind=find_file_format(first_bytes),
            width=width,
            height=height,
            maximum=MAX_PIXELS,
        )
    )


def find_file_format(start: bytes) -> str:
    """Return the format of a PNG or JPEG file from its first bytes."""
    return "PNG" if start.startswith(_PNG_START) else "JPEG"


def decode_compressed(message: Any) -> RawImage:
    """Return the decoded image of a message of the transport ``compressed``.

    The encoding follows from the file. For 16-bit pixels (depths), the format of the message names the encoding. A JPEG
    contains only their upper 8 bits, as in compressed_image_transport.

    Args:
        message: sensor_msgs/msg/CompressedImage, whose format begins with the encoding of the raw image.

    Raises:
        BadImageError: see `decode_file`.
    """
    pixels = decode_file(np.frombuffer(message.data, np.uint8))
    encoding = encoding_of(message)
    if pixels.ndim == 3:
        return RawImage.of(message.header, {3: "rgb8", 4: "rgba8"}[pixels.shape[2]], pixels)
    if encoding not in ("16UC1", "mono16"):
        encoding = "mono16" if pixels.dtype == np.uint16 else "mono8"
    elif pixels.dtype == np.uint8:
        pixels = pixels.astype(np.uint16) << 8
    return RawImage.of(message.header, encoding, pixels)


def encoding_of(message: Any) -> str:
    """Return the raw image's encoding, as named by the format of a CompressedImage."""
    encoding: str = message.format.partition(";")[0].strip()
    return encoding


def _to_array(file: Any) -> NDArray[Any]:
    """Return a file's pixels, converted to one of the array types that `decode_file` returns."""
    if file.mode in ("I;16", "L", "RGB", "RGBA"):
        return np.asarray(file)
    has_alpha = file.mode in ("LA", "PA") or "transparency" in file.info
    return np.asarray(file.convert("L" if file.mode == "1" else "RGBA" if has_alpha else "RGB"))
