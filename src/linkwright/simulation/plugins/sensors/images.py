"""Image messages: encodings, noise and ``CameraInfo``.

Source: gazebo_ros_pkgs for ROS 2 (formats, camera_info), REP 118 for depths.
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
"""The formats of SDF, and their names in ROS."""
DEPTH_FORMATS = frozenset({"R_FLOAT16", "R_FLOAT32", "FLOAT32"})
"""The formats of depth cameras in files for gz; they do not specify colours."""
DEFAULT_ENCODING = "bgr8"
"""For formats that are unknown."""
_GREY = np.array([0.299, 0.587, 0.114], np.float32)
_PLACES = 1 << 16
"""Random numbers are drawn once, so many more than an image needs; each image starts at another offset."""


class PixelNoise:
    """Noise on the colours of images.

    Args:
        noise: the noise on each colour value, in the range from 0 to 1.
        generator: the source of random numbers.
    """

    def __init__(self, noise: Noise, generator: np.random.Generator) -> None:
        self._noise = noise
        self._generator = generator
        self._more: Pixels = np.empty(0, np.uint8)  # separate arrays for positive and negative noise of each colour
        self._less: Pixels = np.empty(0, np.uint8)

    def apply(self, colour: Pixels) -> Pixels:
        """Return an image with noise added."""
        noise = self._noise
        if noise.type == "none" or not (noise.stddev > 0 or noise.mean):
            return colour
        if len(self._more) < colour.size + _PLACES:
            drawn = self._generator.normal(noise.mean * 255, noise.stddev * 255, colour.size + _PLACES)
            drawn = np.clip(np.round(drawn), -255, 255)
            self._more, self._less = (np.maximum(array, 0).astype(np.uint8) for array in (drawn, -drawn))
        start = int(self._generator.integers(_PLACES))
        more, less = (array[start : start + colour.size].reshape(colour.shape) for array in (self._more, self._less))
        noisy: Pixels = np.maximum(colour, less)  # clipping bytes takes a sixth of the time of clipping integers
        noisy -= less
        np.invert(noisy, out=noisy)  # clip the sum at white by inverting the image
        np.maximum(noisy, more, out=noisy)
        noisy -= more
        return np.invert(noisy, out=noisy)


def fill_image(message: Any, colour: Pixels, encoding: str) -> None:
    """Fill an Image from RGB colours, shape (height, width, 3), in an encoding of `ENCODINGS`."""
    pixels = colour
    if encoding.startswith("mono"):
        pixels = np.round(colour @ _GREY).astype(np.uint8)
    elif encoding.startswith("bgr"):
        pixels = np.empty_like(colour)
        for channel in range(3):  # an eighth of the time of reversing all channels at once
            pixels[:, :, channel] = colour[:, :, 2 - channel]
    elif encoding.startswith("bayer"):
        pixels = _bayer_mosaic(colour, encoding.removeprefix("bayer_")[:4])
    if encoding.endswith("16"):
        pixels = pixels.astype("<u2") * 257
    _fill(message, pixels, encoding)


def fill_depth(message: Any, depth: Pixels, nearest: float, farthest: float) -> None:
    """Fill an Image with depths in m, shape (height, width).

    Depths up to the minimum become -inf, and depths from the maximum become inf.
    """
    _fill(message, clip_depth(depth, nearest, farthest), "32FC1")


def clip_depth(depth: Pixels, nearest: float, farthest: float) -> Pixels:
    """Return depths with -inf up to the minimum and inf from the maximum."""
    result: Pixels = np.array(depth, dtype=np.float32)
    np.copyto(result, np.inf, where=depth >= farthest)
    np.copyto(result, -np.inf, where=depth <= nearest)
    return result


def _fill(message: Any, pixels: Pixels, encoding: str) -> None:
    data = np.ascontiguousarray(pixels)
    message.height, message.width = data.shape[:2]
    message.encoding = encoding
    message.is_bigendian = 0
    message.step = data.nbytes // data.shape[0]
    message.data = data.reshape(-1).view(np.uint8)


def _bayer_mosaic(colour: Pixels, order: str) -> Pixels:
    """Return a Bayer mosaic: one colour per pixel, in the given order within two by two pixels."""
    mosaic = np.empty(colour.shape[:2], np.uint8)
    for place, letter in enumerate(order):
        row, column = divmod(place, 2)
        mosaic[row::2, column::2] = colour[row::2, column::2, "rgb".index(letter)]
    return mosaic


def fill_camera_info(
    message: Any,
    optics: Optics,
    lens: Distortion | None,
    *,
    center: tuple[float, float] | None = None,
    focal: float = 0.0,
    baseline: float = 0.0,
) -> None:
    """Fill a CameraInfo with the projection and the distortion of a camera.

    Args:
        message: the message.
        optics: the projection of the camera.
        lens: the distortion of the lens; None for a camera without distortion.
        center: the published principal point, in pixels; None for the camera's own.
        focal: the published focal length in pixels; 0 for the camera's own.
        baseline: the distance from the left camera of a stereo pair to this one, in m.
    """
    lens = lens or Distortion()
    cx, cy = center if center is not None else (optics.cx, optics.cy)
    fx, fy = (focal, focal) if focal > 0 else (optics.fx, optics.fy)
    message.height, message.width = optics.height, optics.width
    message.distortion_model = "plumb_bob"
    message.d = [lens.k1, lens.k2, lens.p1, lens.p2, lens.k3]
    message.k = np.array([fx, 0, cx, 0, fy, cy, 0, 0, 1], dtype=np.float64)
    message.r = np.eye(3).ravel()
    message.p = np.array([fx, 0, cx, -fx * baseline, 0, fy, cy, 0, 0, 0, 1, 0], dtype=np.float64)
