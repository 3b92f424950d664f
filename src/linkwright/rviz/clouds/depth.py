"""Points from a depth image, optionally colored by an image of the same size."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.images import DecodedImage
from linkwright.rviz.clouds.points import BadCloudError, Points

_SHADOW_DISTANCE = 0.01
"""A point covers the point behind it if the difference of their depths is larger than this, in meters."""


@dataclass(frozen=True, slots=True)
class DepthCamera:
    """The pinhole camera of a depth image.

    Attributes:
        columns: x / z of the rays of each column, float32, shape (width,).
        rows: y / z of the rays of each row, float32, shape (height,).
        pixel_width: the width of a pixel at a distance of one meter, in meters.
    """

    columns: NDArray[np.float32]
    rows: NDArray[np.float32]
    pixel_width: float

    @classmethod
    def of(cls, info: Any, width: int, height: int) -> DepthCamera:
        """Return the camera of a sensor_msgs/msg/CameraInfo, for images of the given size.

        Raises:
            BadCloudError: the image size differs from the camera's, or the camera has no focal length.
        """
        binning_x, binning_y = max(1, info.binning_x), max(1, info.binning_y)
        roi_width, roi_height = info.roi.width or info.width, info.roi.height or info.height
        expected = (roi_width // binning_x, roi_height // binning_y)
        if expected != (width, height):
            raise BadCloudError(
                phrase(
                    "Error updating depth cloud: Depth image size and camera info don't match: {width} x {height} vs "
                    "{columns} x {rows}(binning: {binning_x} x {binning_y}, ROI size: {roi_width} x {roi_height})",
                    width=width,
                    height=height,
                    columns=expected[0],
                    rows=expected[1],
                    binning_x=binning_x,
                    binning_y=binning_y,
                    roi_width=roi_width,
                    roi_height=roi_height,
                )
            )
        projection = np.asarray(info.p, np.float64)
        if not np.isfinite(projection).all() or projection[0] == 0.0 or projection[5] == 0.0:
            raise BadCloudError(
                phrase("Error updating depth cloud: the projection matrix of the CameraInfo has no focal length")
            )
        columns = (np.arange(width) - (projection[2] - info.roi.x_offset) / binning_x) / (projection[0] / binning_x)
        rows = (np.arange(height) - (projection[6] - info.roi.y_offset) / binning_y) / (projection[5] / binning_y)
        focal = float(info.k[0]) or float(projection[0])
        return cls(columns.astype(np.float32), rows.astype(np.float32), binning_x / focal)


class DepthCloudBuilder:
    """A converter of depth images to points.

    With occlusion compensation, points that a nearer object covers stay in the cloud for a while.
    """

    def __init__(self) -> None:
        self._covered: _CoveredPoints | None = None

    def reset(self) -> None:
        """Discard the covered points, because the camera moved or restarted."""
        self._covered = None

    def points(
        self,
        depth: Any,
        camera: DepthCamera,
        color: DecodedImage | None,
        *,
        covered_timeout_s: float | None = None,
        now: float = 0.0,
    ) -> Points:
        """Return the points of a depth image, in the camera's optical frame.

        Args:
            depth: sensor_msgs/msg/Image, 16UC1 or mono16 in millimeters or 32FC1 in meters.
            camera: a camera of the image's size.
            color: an image of the same size; None for white points.
            covered_timeout_s: seconds for which covered points remain visible, at half brightness; None to discard
                them immediately.
            now: the current time, in seconds.

        Raises:
            BadCloudError: the image's encoding is not supported, its data is too short, or its size differs from the
                color image's.
        """
        meters, valid = _read_depths(depth)
        if color is not None and (color.width, color.height) != (depth.width, depth.height):
            raise BadCloudError(
                phrase(
                    "Error updating depth cloud: Depth image resolution ({width}x{height}) does not match "
                    "color image resolution ({columns}x{rows})",
                    width=depth.width,
                    height=depth.height,
                    columns=color.width,
                    rows=color.height,
                )
            )
        colors = np.full(meters.shape, 0x00FFFFFF, np.uint32) if color is None else _pack_colors(color)
        if covered_timeout_s is None:
            self._covered = None
            return _points_from_depths(meters, colors, valid, camera)
        return self._add_covered_points(meters, colors, valid, camera, now, covered_timeout_s)

    def _add_covered_points(
        self,
        meters: NDArray[np.float32],
        colors: NDArray[np.uint32],
        valid: NDArray[np.bool_],
        camera: DepthCamera,
        now: float,
        timeout: float,
    ) -> Points:
        covered = self._covered
        if covered is None or covered.meters.shape != meters.shape:
            covered = self._covered = _CoveredPoints(
                np.zeros_like(meters), np.zeros_like(colors), np.zeros(meters.shape)
            )
        covered.meters[covered.seen_times < now - timeout] = 0.0
        is_covering = valid & (meters < covered.meters - _SHADOW_DISTANCE)
        is_shown = (covered.meters != 0.0) & (is_covering | ~valid)
        covered_points = _points_from_depths(covered.meters, covered.colors, is_shown, camera)
        visible_points = _points_from_depths(meters, colors, valid, camera)
        is_visible = valid & ~is_covering
        covered.meters[is_visible] = meters[is_visible]
        covered.colors[is_visible] = colors[is_visible] >> 1 & 0x7F7F7F
        covered.seen_times[is_visible] = now
        return Points(
            np.concatenate([visible_points.positions, covered_points.positions]),
            {"rgb": np.concatenate([visible_points.channels["rgb"], covered_points.channels["rgb"]])},
        )


@dataclass(slots=True)
class _CoveredPoints:
    meters: NDArray[np.float32]
    colors: NDArray[np.uint32]
    seen_times: NDArray[np.float64]


def _read_depths(image: Any) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
    """Return the depths in meters and a mask of the valid depths.

    Both have the shape (height, width).
    """
    type_codes = {"32FC1": "f4", "16UC1": "u2", "mono16": "u2"}
    type_code = type_codes.get(image.encoding)
    if type_code is None:
        raise BadCloudError(
            phrase("Error updating depth cloud: Depth image has invalid format (only 16 bit and float are supported)!")
        )
    type_code = (">" if image.is_bigendian else "<") + type_code
    data = np.frombuffer(image.data, np.uint8)
    row = image.width * int(type_code[2])
    step = image.step or row
    if step < row or data.size < step * max(0, image.height - 1) + row * (image.height > 0):
        raise BadCloudError(
            phrase(
                "Error updating depth cloud: the depth image has {size} bytes, which is too few for {width} x "
                "{height} pixels",
                size=data.size,
                width=image.width,
                height=image.height,
            )
        )
    raw: NDArray[Any] = np.ndarray((image.height, image.width), type_code, data.data, 0, (step, int(type_code[2])))
    meters = raw.astype(np.float32)
    if type_code[1] == "f":
        return meters, np.isfinite(meters)
    valid = meters != 0.0
    meters *= np.float32(0.001)
    return meters, valid


def _pack_colors(image: DecodedImage) -> NDArray[np.uint32]:
    """Return the image's colors packed like an ``rgb`` channel."""
    rgb = image.rgb().astype(np.uint32)
    packed: NDArray[np.uint32] = np.bitwise_or(rgb[..., 0] << 16 | rgb[..., 1] << 8, rgb[..., 2], dtype=np.uint32)
    return packed


def _points_from_depths(
    meters: NDArray[np.float32], colors: NDArray[np.uint32], mask: NDArray[np.bool_], camera: DepthCamera
) -> Points:
    is_complete = bool(mask.all())
    depths = meters.ravel() if is_complete else meters[mask]
    positions = np.empty((len(depths), 3), np.float32)
    with np.errstate(all="ignore"):
        coordinates = (meters * camera.columns, meters * camera.rows[:, np.newaxis])
    for axis, coordinate in enumerate(coordinates):
        positions[:, axis] = coordinate.ravel() if is_complete else coordinate[mask]
    positions[:, 2] = depths
    return Points(positions, {"rgb": colors.ravel() if is_complete else colors[mask]})
