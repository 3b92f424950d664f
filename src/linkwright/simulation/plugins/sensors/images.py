"""Image messages: encodings, noise and ``CameraInfo``.

Source: gazebo_ros_pkgs for ROS 2 (formats, camera_info), REP 118 (depth images).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from linkwright.sdf.cameras import Distortion
from linkwright.sdf.noise import Noise
from linkwright.sdf.optics import Optics

Pixels = np.ndarray[Any, np.dtype[Any]]

ENCODINGS = {
    "L8": "mono8", "L_INT8": "mono8", "L_UINT8": "mono8", "L16": "mono16", "L_INT16": "mono16", "L_UINT16": "mono16",
    "R8G8B8": "rgb8", "RGB_INT8": "rgb8", "RGB_UINT8": "rgb8", "B8G8R8": "bgr8", "BGR_INT8": "bgr8",
    "R16G16B16": "rgb16", "RGB_INT16": "rgb16", "RGB_UINT16": "rgb16",
    "BAYER_RGGB8": "bayer_rggb8", "BAYER_BGGR8": "bayer_bggr8", "BAYER_GBRG8": "bayer_gbrg8",
    "BAYER_GRBG8": "bayer_grbg8", "BAYER_RGGR8": "bayer_rggb8",
}  # fmt: skip
"""The ROS encodings, by the image formats of SDF."""
DEPTH_FORMATS = frozenset({"R_FLOAT16", "R_FLOAT32", "FLOAT32"})
"""The formats that depth cameras in files for gz declare.

They do not determine the encoding of colors.
"""
DEFAULT_ENCODING = "bgr8"
"""The encoding of images whose format is not in `ENCODINGS`."""
_GRAY_WEIGHTS = np.array([0.299, 0.587, 0.114], np.float32)
_SURPLUS_NUMBERS = 1 << 16
"""The number of surplus random numbers, which are drawn once. The noise of each image starts at a random offset."""


class PixelNoise:
    """Noise on the colors of images.

    Args:
        noise: the noise on each color value, for colors from 0 to 1.
        generator: the random number generator.
    """

    def __init__(self, noise: Noise, generator: np.random.Generator) -> None:
        self._noise = noise
        self._generator = generator
        self._positive_noise: Pixels = np.empty(0, np.uint8)  # bytes are unsigned
        self._negative_noise: Pixels = np.empty(0, np.uint8)
        self._brightest: Pixels = np.empty(0, np.uint8)
        """The brightest color that positive noise does not clip at white."""

    def apply(self, color: Pixels) -> Pixels:
        """Return RGB colors with noise, or the colors themselves if there is no noise.

        The colors are bytes of shape (height, width, 3).
        """
        noise = self._noise
        if noise.type == "none" or not (noise.stddev > 0 or noise.mean):
            return color
        if len(self._positive_noise) < color.size + _SURPLUS_NUMBERS:
            noise_values = self._generator.normal(noise.mean * 255, noise.stddev * 255, color.size + _SURPLUS_NUMBERS)
            noise_values = np.clip(np.round(noise_values), -255, 255)
            self._positive_noise, self._negative_noise = (
                np.maximum(array, 0).astype(np.uint8) for array in (noise_values, -noise_values)
            )
            self._brightest = np.invert(self._positive_noise)
        start = int(self._generator.integers(_SURPLUS_NUMBERS))
        positive, negative, brightest = (
            array[start : start + color.size].reshape(color.shape)
            for array in (self._positive_noise, self._negative_noise, self._brightest)
        )
        noisy: Pixels = np.maximum(color, negative)  # clipping bytes takes a sixth of the time of clipping integers
        noisy -= negative
        np.minimum(noisy, brightest, out=noisy)
        noisy += positive
        return noisy


def fill_image(message: Any, color: Pixels, encoding: str) -> None:
    """Fill an Image with RGB colors, shape (height, width, 3), in an encoding of `ENCODINGS`."""
    pixels = color
    if encoding.startswith("mono"):
        pixels = np.round(color @ _GRAY_WEIGHTS).astype(np.uint8)
    elif encoding.startswith("bgr"):
        pixels = np.empty_like(color)
        for channel in range(3):  # takes an eighth of the time of reversing all channels at once
            pixels[:, :, channel] = color[:, :, 2 - channel]
    elif encoding.startswith("bayer"):
        pixels = _create_bayer_mosaic(color, encoding.removeprefix("bayer_")[:4])
    if encoding.endswith("16"):
        pixels = pixels.astype("<u2") * 257
    _fill_pixels(message, pixels, encoding)


def fill_depth(message: Any, depth: Pixels, nearest: float, farthest: float) -> None:
    """Fill an Image with depths in m, shape (height, width).

    Depths of at most `nearest` become -inf, and depths of at least `farthest` become inf.
    """
    _fill_pixels(message, clip_depth(depth, nearest, farthest), "32FC1")


def fill_raw_depth(message: Any, depth: Pixels) -> None:
    """Fill an Image with depths in whole millimeters of 16 bits, shape (height, width)."""
    _fill_pixels(message, depth, "16UC1")


def fill_gray(message: Any, pixels: Pixels) -> None:
    """Fill an Image with gray values of 8 or 16 bits, shape (height, width)."""
    _fill_pixels(message, pixels, "mono8" if pixels.itemsize == 1 else "mono16")


def clip_depth(depth: Pixels, nearest: float, farthest: float) -> Pixels:
    """Return depths in m, with -inf up to `nearest` and inf from `farthest` on."""
    result: Pixels = np.array(depth, dtype=np.float32)
    np.copyto(result, np.inf, where=depth >= farthest)
    np.copyto(result, -np.inf, where=depth <= nearest)
    return result


def _fill_pixels(message: Any, pixels: Pixels, encoding: str) -> None:
    data = np.ascontiguousarray(pixels)
    message.height, message.width = data.shape[:2]
    message.encoding = encoding
    message.is_bigendian = 0
    message.step = data.nbytes // data.shape[0]
    message.data = data.reshape(-1).view(np.uint8)


def _create_bayer_mosaic(color: Pixels, order: str) -> Pixels:
    """Return a Bayer mosaic with one color per pixel.

    `order` names the colors of each square of 2 x 2 pixels.
    """
    mosaic = np.empty(color.shape[:2], np.uint8)
    for index, letter in enumerate(order):
        row, column = divmod(index, 2)
        mosaic[row::2, column::2] = color[row::2, column::2, "rgb".index(letter)]
    return mosaic


def fill_camera_info(
    message: Any,
    optics: Optics,
    lens: Distortion | None,
    *,
    center: tuple[float, float] | None = None,
    focal_length: float = 0.0,
    baseline: float = 0.0,
) -> None:
    """Fill a CameraInfo with the projection and the distortion of a camera.

    Args:
        message: the CameraInfo.
        optics: the projection of the camera.
        lens: the distortion of the lens; None for a camera without distortion.
        center: the principal point to publish, in pixels; None to use `optics`.
        focal_length: the focal length to publish, in pixels; 0 to use `optics`.
        baseline: the distance from the left camera of a stereo pair to this one, in m.
    """
    lens = lens or Distortion()
    cx, cy = center if center is not None else (optics.cx, optics.cy)
    fx, fy = (focal_length, focal_length) if focal_length > 0 else (optics.fx, optics.fy)
    message.height, message.width = optics.height, optics.width
    message.distortion_model = "plumb_bob"
    message.d = [lens.k1, lens.k2, lens.p1, lens.p2, lens.k3]
    message.k = np.array([fx, 0, cx, 0, fy, cy, 0, 0, 1], dtype=np.float64)
    message.r = np.eye(3).ravel()
    message.p = np.array([fx, 0, cx, -fx * baseline, 0, fy, cy, 0, 0, 0, 1, 0], dtype=np.float64)
