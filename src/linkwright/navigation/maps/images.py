"""Read and write map images.

Only formats other than PGM, such as PNG and BMP, need Pillow.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import (
    Diagnostic,
    LinkwrightError,
    Phrase,
    display_path,
    foreign,
    missing_extra,
    missing_file_hint,
    phrase,
)
from linkwright.files.input_files import read_file

MAX_PIXELS = 1 << 28
"""The maximum number of pixels of a map that is read, because the header of a small file can declare any size."""
_MAX_FILE_BYTES = 1 << 30
_PGM_HEADER = re.compile(rb"P([25])" + rb"(?:\s|#[^\n]*\n)+(\d{1,9})" * 3 + rb"\s")


@dataclass(frozen=True, slots=True)
class MapImage:
    """The pixels of an image from the top row down, with values from 0 to 1.

    Attributes:
        shade: the brightness, the mean of the color channels, of shape (rows, columns).
        opacity: the opacity, 1 for opaque pixels, of the same shape; None if the image has no transparency.
    """

    shade: NDArray[np.float64]
    opacity: NDArray[np.float64] | None = None


def read_image(path: Path) -> MapImage:
    """Read an image file.

    Raises:
        LinkwrightError: NAV203, the file does not exist, is not an image, or is broken; NAV204, the file is not PGM,
            and Pillow, which reads other formats, is not installed.
    """
    try:
        data = read_file(path, _MAX_FILE_BYTES)
    except FileNotFoundError:
        message = phrase("the map image '{path}' does not exist", path=display_path(path))
        raise LinkwrightError(Diagnostic("NAV203", message, hint=missing_file_hint(path))) from None
    except OSError as error:
        raise _unreadable_error(path, foreign(error.strerror or error)) from None
    header = _PGM_HEADER.match(data)
    return _parse_pgm(path, data, header) if header else _read_with_pillow(path, data)


def encode_pgm(pixels: NDArray[np.uint8]) -> bytes:
    """Encode gray pixels of shape (rows, columns) as a binary PGM, in the form used by nav2."""
    rows, columns = pixels.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + np.ascontiguousarray(pixels).tobytes()


def encode_with_pillow(pixels: NDArray[np.uint8], kind: str) -> bytes:
    """Encode pixels as an image file in one of Pillow's formats.

    Args:
        pixels: the pixels, of shape (rows, columns) for gray, or (rows, columns, 2) for gray and opacity.
        kind: the name of the format, such as ``png``.

    Raises:
        LinkwrightError: NAV204, Pillow is not installed.
        ValueError: Pillow cannot write the format, or cannot write these pixels in it.
    """
    image = _import_pillow().fromarray(pixels) if pixels.ndim == 2 else _make_gray_image_with_opacity(pixels)
    file = BytesIO()
    try:
        image.save(file, format=kind)
    except (KeyError, OSError) as error:
        raise ValueError(str(error)) from None
    return file.getvalue()


def _make_gray_image_with_opacity(pixels: NDArray[np.uint8]) -> Any:
    gray = pixels[..., 0]
    return _import_pillow().fromarray(np.stack((gray, gray, gray, pixels[..., 1]), axis=-1))


def _parse_pgm(path: Path, data: bytes, header: re.Match[bytes]) -> MapImage:
    columns, rows, max_value = (int(group) for group in header.groups()[1:])
    if not 0 < rows * columns <= MAX_PIXELS or not 0 < max_value < 1 << 16:
        raise _unreadable_error(
            path,
            phrase(
                "the size or the maximum value in its header is not valid: {size}",
                size=f"{columns} x {rows}, {max_value}",
            ),
        )
    pixel_bytes = data[header.end() :]
    if header[1] == b"2":
        try:
            values = np.array(pixel_bytes.split()[: rows * columns], np.float64)
        except ValueError:
            raise _unreadable_error(path, phrase("its pixels are not numbers")) from None
    else:
        values = np.frombuffer(
            pixel_bytes, ">u2" if max_value > 255 else np.uint8, -1 if max_value < 256 else len(pixel_bytes) // 2
        )
    if values.size < rows * columns:
        reason = phrase("it has only {count} of {size} pixels", count=values.size, size=rows * columns)
        raise _unreadable_error(path, reason)
    return MapImage(np.minimum(values[: rows * columns].reshape(rows, columns) / max_value, 1.0))


def _read_with_pillow(path: Path, data: bytes) -> MapImage:
    pillow = _import_pillow()
    try:
        with pillow.open(BytesIO(data)) as file:
            if file.width * file.height > MAX_PIXELS:
                raise _unreadable_error(path, phrase("it has more than {maximum} pixels", maximum=MAX_PIXELS))
            has_16_bits = file.mode.startswith("I")
            has_opacity = file.mode in ("LA", "PA", "RGBA", "La", "RGBa") or "transparency" in file.info
            values = np.asarray(file if has_16_bits else file.convert("RGBA" if has_opacity else "RGB"), np.float64)
    except (OSError, ValueError, SyntaxError, pillow.DecompressionBombError) as error:
        raise _unreadable_error(path, foreign(str(error).replace(repr(BytesIO), "it"))) from None
    if has_16_bits:
        return MapImage(values / 65535.0)
    values = values / 255.0
    return MapImage(values[..., :3].mean(axis=-1), values[..., 3] if has_opacity else None)


def _import_pillow() -> Any:
    try:
        from PIL import Image  # Import Pillow only when it is needed, because it is an optional extra.
    except ModuleNotFoundError as error:
        raise missing_extra("NAV204", error) from None
    return Image


def _unreadable_error(path: Path, reason: Phrase) -> LinkwrightError:
    message = phrase("the map image '{path}' cannot be read: {reason}", path=display_path(path), reason=reason)
    return LinkwrightError(Diagnostic("NAV203", message))
