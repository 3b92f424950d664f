"""The rectification of images: pixels of an ideal camera, and where the lens of the real camera shows them.

Source: image_geometry (binning and region of interest), OpenCV (distortion models ``plumb_bob``,
``rational_polynomial`` and ``equidistant``, and ``initUndistortRectifyMap``).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.perception.nodes.image_arrays import LINEAR, Sampling

Array = NDArray[np.float64]
_FISHEYE = ("equidistant", "fisheye")
_MIN_RADIUS = 1e-8
_COEFFICIENT_COUNT = 12


def create_rectification(info: Any, interpolation: int = LINEAR) -> Sampling:
    """Return the sampling that rectifies the images of a camera.

    Args:
        info: the ``sensor_msgs/msg/CameraInfo``.
        interpolation: `NEAREST` or `LINEAR`.
    """
    camera, projection = np.array(info.k).reshape(3, 3).copy(), np.array(info.p).reshape(3, 4)[:, :3].copy()
    roi, binning = info.roi, (max(info.binning_x, 1), max(info.binning_y, 1))
    width, height = roi.width or info.width, roi.height or info.height
    for matrix in (camera, projection):
        matrix[0, 2] -= roi.x_offset
        matrix[1, 2] -= roi.y_offset
        matrix[0] /= binning[0]
        matrix[1] /= binning[1]
    given_rotation = np.array(info.r).reshape(3, 3)
    rotation: Array = given_rotation if given_rotation.any() else np.eye(3)
    columns, rows = np.meshgrid(np.arange(width // binning[0]), np.arange(height // binning[1]))
    pixels = np.stack([columns, rows, np.ones_like(columns)], axis=-1)
    rays = pixels @ np.linalg.inv(projection @ rotation).T
    x, y = distort(info.distortion_model, np.array(info.d), rays[..., 0] / rays[..., 2], rays[..., 1] / rays[..., 2])
    return Sampling(
        (camera[0, 0] * x + camera[0, 1] * y + camera[0, 2]).astype(np.float32),
        (camera[1, 1] * y + camera[1, 2]).astype(np.float32),
        interpolation,
    )


def distort(model: str, coefficients: Array, x: Array, y: Array) -> tuple[Array, Array]:
    """Return where a lens shows points of the plane at distance 1.

    Args:
        model: the distortion model of the camera.
        coefficients: its coefficients; missing ones are 0.
        x: the first coordinates of the points.
        y: the second coordinates of the points.
    """
    k = np.zeros(_COEFFICIENT_COUNT)
    k[: min(len(coefficients), _COEFFICIENT_COUNT)] = coefficients[:_COEFFICIENT_COUNT]
    square = x**2 + y**2
    if model in _FISHEYE:
        radius = np.sqrt(square)
        angle = np.arctan(radius)
        bent = angle * (1.0 + k[0] * angle**2 + k[1] * angle**4 + k[2] * angle**6 + k[3] * angle**8)
        scale = np.where(radius > _MIN_RADIUS, bent / np.maximum(radius, _MIN_RADIUS), 1.0)
        return x * scale, y * scale
    k1, k2, p1, p2, k3, k4, k5, k6, s1, s2, s3, s4 = k.tolist()
    radial = 1.0 + square * (k1 + square * (k2 + square * k3))
    radial = radial / (1.0 + square * (k4 + square * (k5 + square * k6)))
    return (
        x * radial + 2.0 * p1 * x * y + p2 * (square + 2.0 * x**2) + s1 * square + s2 * square**2,
        y * radial + p1 * (square + 2.0 * y**2) + 2.0 * p2 * x * y + s3 * square + s4 * square**2,
    )
