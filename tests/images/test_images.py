"""Images of messages as pages draw them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.images import BadImageError, DecodedImage, Range, RangeFinder, decode_image, has_range
from linkwright.messages import get_message
from tests.work import lines_run

Image = get_message("sensor_msgs/msg/Image")


def image(encoding: str, width: int, height: int, data: bytes, **fields):
    return Image(encoding=encoding, width=width, height=height, data=data, **{"step": 0, **fields})


def pixels(message, ranges: RangeFinder | None = None) -> list:
    return decode_image(message, ranges or RangeFinder()).pixels.tolist()


@pytest.mark.parametrize(
    ("encoding", "data", "expected"),
    [
        ("rgb8", [1, 2, 3], [1, 2, 3]),
        ("bgr8", [1, 2, 3], [3, 2, 1]),
        ("8UC3", [1, 2, 3], [3, 2, 1]),
        ("rgba8", [1, 2, 3, 4], [1, 2, 3, 4]),
        ("bgra8", [1, 2, 3, 4], [3, 2, 1, 4]),
        ("8UC4", [1, 2, 3, 4], [3, 2, 1, 4]),
        ("mono8", [7], 7),
        ("8UC1", [7], 7),
    ],
)
def test_eight_bit_images_keep_their_values(encoding, data, expected):
    assert pixels(image(encoding, 1, 1, bytes(data))) == [[expected]]


def test_row_padding_is_skipped():
    assert pixels(image("mono8", 2, 2, bytes([1, 2, 0, 0, 3, 4]), step=4)) == [[1, 2], [3, 4]]


def test_sixteen_bit_values_are_scaled_from_black_to_white():
    data = np.array([[100, 200, 300]], "<u2")
    for encoding in ("16UC1", "mono16"):
        assert pixels(image(encoding, 3, 1, data.tobytes())) == [[0, 127, 255]]
    assert pixels(image("16UC1", 3, 1, data.astype(">u2").tobytes(), is_bigendian=1)) == [[0, 127, 255]]
    assert pixels(image("16SC1", 2, 1, np.array([-5, 5], "<i2").tobytes())) == [[0, 255]]
    assert pixels(image("32FC1", 3, 1, np.array([-1.0, 0.0, 1.0], "<f4").tobytes())) == [[0, 127, 255]]


def test_non_finite_depths_do_not_affect_range():
    data = np.array([math.nan, 1.0, 2.0, math.inf], "<f4")
    assert pixels(image("32FC1", 4, 1, data.tobytes())) == [[0, 0, 255, 255]]
    assert pixels(image("32FC1", 1, 1, np.array([math.nan], "<f4").tobytes())) == [[0]]


def test_uniform_image_is_black():
    assert pixels(image("16UC1", 2, 1, np.array([9, 9], "<u2").tobytes())) == [[0, 0]]


def test_fixed_range_scales_values():
    ranges = RangeFinder()
    ranges.fixed = Range(0.0, 1000.0)
    data = np.array([0, 500, 2000], "<u2")
    assert pixels(image("16UC1", 3, 1, data.tobytes()), ranges) == [[0, 127, 255]]


def test_range_is_median_of_last_images():
    ranges = RangeFinder()
    ranges.window = 3
    largest = [ranges.update_range(np.array([0.0, value])).white for value in (10.0, 20.0, 1000.0, 20.0)]
    assert largest == [10.0, 20.0, 20.0, 20.0]
    ranges.window = 1
    assert ranges.update_range(np.array([0.0, 5.0])).white == 5.0


def test_only_images_above_eight_bits_have_range():
    assert [has_range(encoding) for encoding in ("mono16", "16UC1", "32FC1", "mono8", "rgb8", "")] == [
        True,
        True,
        True,
        False,
        False,
        False,
    ]


@pytest.mark.parametrize("pattern", ["rggb", "bggr", "gbrg", "grbg"])
def test_bayer_mosaics_decode_to_colors(pattern):
    value = {"r": 200, "g": 100, "b": 50}
    tile = np.array([value[color] for color in pattern], np.uint8).reshape(2, 2)
    mosaic = np.tile(tile, (3, 3))
    expected = [[[200, 100, 50]] * 6] * 6
    assert pixels(image(f"bayer_{pattern}8", 6, 6, mosaic.tobytes())) == expected
    mosaic_16_bit = (mosaic.astype("<u2") << 8).tobytes()
    assert pixels(image(f"bayer_{pattern}16", 6, 6, mosaic_16_bit)) == expected


def test_yuv_images_decode_to_rgb():
    # Black, white, and red in 8-bit video of BT.601
    gray = [[[0, 0, 0], [255, 255, 255]]]
    for encoding in ("yuv422", "uyvy"):
        assert pixels(image(encoding, 2, 1, bytes([128, 16, 128, 235]))) == gray
    for encoding in ("yuv422_yuy2", "yuyv"):
        assert pixels(image(encoding, 2, 1, bytes([16, 128, 235, 128]))) == gray
    assert pixels(image("yuyv", 2, 1, bytes([81, 90, 81, 240]))) == [[[255, 0, 0]] * 2]
    assert pixels(image("nv24", 2, 1, bytes([81, 81, 90, 240, 90, 240]))) == [[[255, 0, 0]] * 2]
    assert pixels(image("nv21", 2, 2, bytes([81, 81, 81, 81, 240, 90]))) == [[[255, 0, 0]] * 2] * 2


@pytest.mark.parametrize(("encoding", "width"), [("yuyv", 1), ("yuyv", 3), ("nv21", 3), ("nv24", 3)])
def test_odd_image_sizes_are_decoded(encoding, width):
    decode_rvl = decode_image(image(encoding, width, 3, bytes([128] * 60)), RangeFinder())
    assert (decode_rvl.width, decode_rvl.height) == (width, 3)


@pytest.mark.parametrize("encoding", ["rgb8", "16UC1", "32FC1", "bayer_rggb8", "yuyv", "nv21", "nv24"])
def test_too_few_bytes_are_rejected(encoding):
    with pytest.raises(BadImageError, match="too few for 4 x 4"):
        decode_image(image(encoding, 4, 4, b"123"), RangeFinder())


def test_unknown_encodings_are_rejected():
    with pytest.raises(BadImageError, match=r"Unsupported image encoding \[64FC1\]"):
        decode_image(image("64FC1", 1, 1, bytes(8)), RangeFinder())


def test_large_image_is_subsampled():
    decode_rvl = DecodedImage(np.arange(100, dtype=np.uint8).reshape(10, 10))
    assert decode_rvl.subsample(100) is decode_rvl
    thinned = decode_rvl.subsample(30)
    assert (thinned.width, thinned.height) == (5, 5)
    assert thinned.pixels[1].tolist() == [20, 22, 24, 26, 28]
    subsampled = DecodedImage(np.zeros((5, 5), np.uint8)).subsample(4)
    assert (subsampled.width, subsampled.height) == (2, 2)


@pytest.mark.parametrize("step", [2, 3, 16, 99])
def test_reduced_image_has_mean_of_each_block(step):
    pixels = np.full((40, 65, 3), 255, np.uint8)
    pixels[:2, :2, 1] = [[0, 10], [20, 30]]
    reduced = DecodedImage(pixels).reduce_by(step)
    step = min(step, 16)
    assert (reduced.height, reduced.width) == (40 // step, 65 // step)
    assert reduced.pixels[0, 0].tolist() == [255, pixels[:step, :step, 1].sum() // step**2, 255]
    assert (reduced.pixels[1:] == 255).all()


def test_reduction_larger_than_image_keeps_image():
    decode_rvl = DecodedImage(np.zeros((2, 9), np.uint8))
    assert decode_rvl.reduce_by(1) is decode_rvl
    assert decode_rvl.reduce_by(3) is decode_rvl


def test_gray_and_translucent_images_convert_to_rgb():
    assert DecodedImage(np.array([[7]], np.uint8)).rgb().tolist() == [[[7, 7, 7]]]
    assert DecodedImage(np.array([[[1, 2, 3, 4]]], np.uint8)).rgb().tolist() == [[[1, 2, 3]]]


def test_decoding_effort_is_independent_of_image_size():
    def work(width, height):
        message = image("bgr8", width, height, bytes(width * height * 3))
        return lines_run(lambda: decode_image(message, RangeFinder()))

    assert work(64, 48) == work(640, 480)
