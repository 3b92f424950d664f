"""Images in the formats of image_transport's plugins, encoded by the tests."""

from __future__ import annotations

import struct
import zlib
from io import BytesIO

import numpy as np
from PIL import Image as Pictures

from linkwright.messages import get_message

CompressedImage = get_message("sensor_msgs/msg/CompressedImage")


def png_chunk(kind: bytes, data: bytes) -> bytes:
    """Return a chunk of a PNG."""
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def make_png(values: np.ndarray, *, says: tuple[int, int] | None = None) -> bytes:
    """Return a gray PNG with 8 or 16 bits, optionally with a false width and height."""
    height, width = values.shape
    rows = values.astype(values.dtype.newbyteorder(">"))
    data = b"".join(b"\0" + row.tobytes() for row in rows)
    header = struct.pack(">IIBBBBB", *(says or (width, height)), 8 * values.itemsize, 0, 0, 0, 0)
    parts = png_chunk(b"IHDR", header), png_chunk(b"IDAT", zlib.compress(data)), png_chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(parts)


def make_jpeg(color: tuple[int, int, int] | int, width: int, height: int) -> bytes:
    """Return a JPEG with one color or gray value."""
    file = BytesIO()
    Pictures.new("L" if isinstance(color, int) else "RGB", (width, height), color).save(file, "JPEG", quality=95)
    return file.getvalue()


def encode_rvl(values: np.ndarray) -> bytes:
    """Return an RVL stream of numbers, with four bits each and eight in a word."""
    groups: list[int] = []

    def put(number: int) -> None:
        while number > 7:
            groups.append(8 | number & 7)
            number >>= 3
        groups.append(number)

    left, before = [int(value) for value in values.ravel()], 0
    while left:
        zeros = next((index for index, value in enumerate(left) if value), len(left))
        nonzeros = next((index for index, value in enumerate(left[zeros:]) if not value), len(left) - zeros)
        put(zeros)
        put(nonzeros)
        for value in left[zeros : zeros + nonzeros]:
            step, before = value - before, value
            put(2 * step if step >= 0 else -2 * step - 1)
        left = left[zeros + nonzeros :]
    groups += [0] * (-len(groups) % 8)
    words = [
        sum(group << (28 - 4 * index) for index, group in enumerate(groups[i : i + 8]))
        for i in range(0, len(groups), 8)
    ]
    return struct.pack(f"<{len(words)}I", *words)


def encode_sized_rvl(values: np.ndarray, *, says: tuple[int, int] | None = None) -> bytes:
    """Return an RVL stream after its columns and rows."""
    height, width = values.shape
    return struct.pack("<II", *(says or (width, height))) + encode_rvl(values)


def depth_header(first: float = 0.0, second: float = 0.0) -> bytes:
    """Return the header of the depths in `compressedDepth`."""
    return struct.pack("<iff", 0, first, second)


def make_depth_message(values, packing: str = "png", frame: str = "base"):
    """Return a `compressedDepth` message of depths.

    They are integer millimeters (uint16), or up to 10 meters (float).
    """
    values = np.asarray(values)
    scale = depth_header()
    encoding = "16UC1"
    if values.dtype.kind == "f":
        encoding, first = "32FC1", 100.0 * 101.0
        second = 1.0 - first / 10.0
        scale = depth_header(first, second)
        is_in_range = values < 10.0
        values = np.where(is_in_range, first / np.where(is_in_range, values, 1.0) + second, 0.0)
    pixels = values.astype(np.uint16)
    data = make_png(pixels) if packing == "png" else encode_sized_rvl(pixels)
    return make_compressed_image(f"{encoding}; compressedDepth {packing}", scale + data, frame)


def make_compressed_image(form: str, data: bytes, frame: str = "base"):
    """Return a sensor_msgs/msg/CompressedImage."""
    message = CompressedImage(format=form, data=data)
    message.header.frame_id = frame
    return message
