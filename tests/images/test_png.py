"""PNG files and animations, read back by a decoder written for this test."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import pytest

from linkwright.images.png import apng, png


def chunks(data: bytes) -> list[tuple[bytes, bytes]]:
    assert data.startswith(b"\x89PNG\r\n\x1a\n")
    found, place = [], 8
    while place < len(data):
        (length,) = struct.unpack_from(">I", data, place)
        kind, content = data[place + 4 : place + 8], data[place + 8 : place + 8 + length]
        assert struct.unpack_from(">I", data, place + 8 + length)[0] == zlib.crc32(kind + content)
        found.append((kind, content))
        place += 12 + length
    return found


def unpacked(content: bytes, shape: tuple[int, ...]) -> np.ndarray:
    rows = np.frombuffer(zlib.decompress(content), np.uint8).reshape(shape[0], -1)
    assert (rows[:, 0] == 2).all()  # the filter "up"
    return np.cumsum(rows[:, 1:], axis=0, dtype=np.uint8).reshape(shape)


@pytest.mark.parametrize("channels", [1, 3, 4])
def test_png_keeps_all_pixels(channels: int) -> None:
    pixels = np.random.default_rng(1).integers(0, 256, (7, 5, channels), np.uint8)
    header, content, end = chunks(png(pixels))
    assert struct.unpack(">IIBB", header[1][:10]) == (5, 7, 8, {1: 0, 3: 2, 4: 6}[channels])
    assert (unpacked(content[1], pixels.shape) == pixels).all()
    assert end == (b"IEND", b"")


def test_apng_keeps_order_of_frames() -> None:
    frames = list(np.random.default_rng(2).integers(0, 256, (3, 4, 6, 4), np.uint8))
    found = chunks(apng(frames, 0.25))
    assert [kind for kind, _ in found] == [
        b"IHDR",
        b"acTL",
        b"fcTL",
        b"IDAT",
        b"fcTL",
        b"fdAT",
        b"fcTL",
        b"fdAT",
        b"IEND",
    ]
    assert struct.unpack(">II", found[1][1]) == (3, 0)  # three frames, repeated endlessly
    controls = [content for kind, content in found if kind == b"fcTL"]
    assert [struct.unpack_from(">HH", content, 20) for content in controls] == [(250, 1000)] * 3
    numbered = [content for kind, content in found if kind in (b"fcTL", b"fdAT")]
    assert [struct.unpack_from(">I", content)[0] for content in numbered] == list(range(5))
    data = [found[3][1], *(content[4:] for kind, content in found if kind == b"fdAT")]
    for content, frame in zip(data, frames, strict=True):
        assert (unpacked(content, frame.shape) == frame).all()


@pytest.mark.extra("image")
def test_pillow_reads_written_png_and_apng() -> None:
    from io import BytesIO

    from PIL import Image

    pixels = np.random.default_rng(3).integers(0, 256, (2, 9, 8, 4), np.uint8)
    assert (np.asarray(Image.open(BytesIO(png(pixels[0])))) == pixels[0]).all()
    animation = Image.open(BytesIO(apng(list(pixels), 0.1)))
    assert animation.n_frames == 2
    animation.seek(1)
    assert (np.asarray(animation) == pixels[1]).all()
