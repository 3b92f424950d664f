"""Extract points from clouds and laser scans: coordinates and other fields.

Scans are projected in the same way as by laser_geometry.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import rotate, slerp
from linkwright.page.protocol.points import CloudPoints

# The keys are the `datatype` constants of sensor_msgs/msg/PointField.
_TYPE_CODES = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 8: "f8"}
_AXES = ("x", "y", "z")


class BadCloudError(ValueError):
    """Raised if a message cannot be shown as points.

    The text of the error appears in the status row ``Message``.
    """


@dataclass(frozen=True, slots=True)
class Points:
    """Points with finite positions, and their other fields.

    Attributes:
        positions: float32 array, shape (N, 3), meters in the frame of the message.
        channels: the values of the other fields by name, in the order of the message; each of shape (N,).
    """

    positions: NDArray[np.float32]
    channels: Mapping[str, NDArray[Any]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.positions)

    def values(self, name: str) -> NDArray[Any] | None:
        """Return a channel or the coordinate ``x``, ``y`` or ``z``.

        Return None if there is no such channel.
        """
        if name in _AXES:
            column: NDArray[Any] = self.positions[:, _AXES.index(name)]
            return column
        return self.channels.get(name)


def points_from_cloud(message: Any) -> Points:
    """Return the points of a PointCloud2 whose coordinates are finite.

    As in RViz, only the first of several fields with the same name is used, and only the first value of a field with
    several values. Fields of unknown types are ignored.

    Raises:
        BadCloudError: the size of the data does not match the number of points, a field extends beyond the point, or
            the coordinates are not float32.
    """
    count = message.width * message.height
    step = message.point_step
    data = np.frombuffer(message.data, dtype=np.uint8)
    if data.size != count * step:
        raise BadCloudError(
            phrase(
                "Data size ({size} bytes) does not match width ({width}) times height ({height}) "
                "times point_step ({step}).  Dropping message.",
                size=data.size,
                width=message.width,
                height=message.height,
                step=step,
            )
        )
    fields = _parse_fields(message.fields, step)
    if any(fields.get(axis, ("", 0))[0] != "f4" for axis in _AXES):
        raise BadCloudError(phrase("No position transformer available for cloud"))
    if count == 0:
        return Points(
            np.empty((0, 3), np.float32), {name: np.empty(0, field_code) for name, (field_code, _) in fields.items()}
        )
    byte_order = ">" if message.is_bigendian else "<"
    positions = _copy_coordinates(data, [fields[axis][1] for axis in _AXES], byte_order, step, count)
    valid = None
    with np.errstate(all="ignore"):
        if not np.isfinite(positions.sum(dtype=np.float64)):
            valid = np.isfinite(positions).all(axis=1)
            positions = positions[valid]
    channels: dict[str, NDArray[Any]] = {}
    for name, (type_code, offset) in fields.items():
        if name not in _AXES:
            column = _view_column(data, offset, byte_order + type_code, step, count)
            channels[name] = column if valid is None else column[valid]
    return Points(positions, channels)


def points_from_legacy_cloud(message: Any) -> Points:
    """Return the points of a sensor_msgs/msg/PointCloud whose coordinates are finite.

    Raises:
        BadCloudError: a channel does not have one value for each point.
    """
    positions = np.array([(point.x, point.y, point.z) for point in message.points], dtype=np.float32).reshape(-1, 3)
    channels: dict[str, NDArray[Any]] = {}
    for channel in message.channels:
        values = np.asarray(channel.values, dtype=np.float32)
        if len(values) != len(positions):
            raise BadCloudError(
                phrase(
                    "Channel '{name}' has {values} values for {positions} points.  Dropping message.",
                    name=channel.name,
                    values=len(values),
                    positions=len(positions),
                )
            )
        channels.setdefault(channel.name, values)
    valid = np.isfinite(positions).all(axis=1)
    return Points(positions[valid], {name: values[valid] for name, values in channels.items()})


def _parse_fields(fields: Any, step: int) -> dict[str, tuple[str, int]]:
    """Return the NumPy type (such as ``f4``) and the byte offset of each field, by name."""
    formats: dict[str, tuple[str, int]] = {}
    for point_field in fields:
        type_code = _TYPE_CODES.get(point_field.datatype)
        if type_code is None or point_field.name in formats:
            continue
        if point_field.offset + int(type_code[1]) > step:
            raise BadCloudError(
                phrase(
                    "Field '{name}' ends at byte {end}, but a point has only {step} bytes",
                    name=point_field.name,
                    end=point_field.offset + int(type_code[1]),
                    step=step,
                )
            )
        formats[point_field.name] = (type_code, point_field.offset)
    return formats


def _copy_coordinates(
    data: NDArray[np.uint8], offsets: list[int], byte_order: str, step: int, count: int
) -> NDArray[np.float32]:
    """Return a copy of the coordinates, shape (N, 3), so that the message can be freed."""
    first_offset = offsets[0]
    if offsets == [first_offset, first_offset + 4, first_offset + 8]:
        view: NDArray[Any] = np.ndarray((count, 3), byte_order + "f4", data.data, first_offset, (step, 4))
        return view.astype(np.float32)
    columns = [_view_column(data, offset, byte_order + "f4", step, count) for offset in offsets]
    return np.stack(columns, axis=1).astype(np.float32, copy=False)


def _view_column(data: NDArray[np.uint8], offset: int, kind: str, step: int, count: int) -> NDArray[Any]:
    column: NDArray[Any] = np.ndarray((count,), kind, data.data, offset, (step,))
    return column


def decimate(cloud: CloudPoints, max_bytes: int) -> CloudPoints:
    """Return every k-th point of a cloud, to limit the size of the arrays.

    The arrays have at most about `max_bytes` bytes. At least one point is returned.
    """
    total_bytes = cloud.positions.nbytes + cloud.colors.nbytes
    step = -(-total_bytes // max(1, max_bytes))
    if step <= 1:
        return cloud
    return replace(cloud, positions=cloud.positions[::step], colors=cloud.colors[::step], step=step)


class ScanProjector:
    """A projector of laser scans to points.

    The ray directions are cached, because successive scans usually have the same shape.
    """

    def __init__(self) -> None:
        self._shape: tuple[float, float, int] = (0.0, 0.0, 0)
        self._directions: NDArray[np.float32] = np.empty((0, 2), np.float32)

    def points(self, scan: Any) -> Points:
        """Return the points at which rays hit an object, in the frame of the scanner.

        A ray is used if its range is at least `range_min` and less than `range_max`. The range of a ray without an echo
        is infinite or NaN, so such a ray is ignored. The channels are ``range`` and ``index``, and
        ``intensity`` if the scan has one value for each ray.
        """
        ranges = np.frombuffer(scan.ranges, np.float32)
        with np.errstate(invalid="ignore"):
            hits = np.flatnonzero((ranges >= scan.range_min) & (ranges < scan.range_max))
        distances = ranges[hits]
        positions = np.zeros((len(hits), 3), np.float32)
        directions = self._compute_ray_directions(scan.angle_min, scan.angle_increment, len(ranges))
        np.multiply(directions[hits], distances[:, np.newaxis], out=positions[:, :2])
        channels: dict[str, NDArray[Any]] = {}
        intensities = np.frombuffer(scan.intensities, np.float32)
        if len(intensities) == len(ranges):
            channels["intensity"] = intensities[hits]
        channels["range"] = distances
        channels["index"] = hits.astype(np.int32)
        is_finite = np.isfinite(positions.sum())
        if is_finite:
            return Points(positions, channels)
        valid = np.isfinite(positions).all(axis=1)
        return Points(positions[valid], {name: values[valid] for name, values in channels.items()})

    def _compute_ray_directions(self, first: float, step: float, count: int) -> NDArray[np.float32]:
        """Return the cosine and the sine of each ray's angle, shape (`count`, 2)."""
        shape = (first, step, count)
        if shape != self._shape:
            with np.errstate(all="ignore"):
                angles = first + step * np.arange(count, dtype=np.float64)
                self._directions = np.stack([np.cos(angles), np.sin(angles)], axis=1).astype(np.float32)
            self._shape = shape
        return self._directions


def deskew(
    points: Points, fractions: NDArray[Any], first_pose: NDArray[np.float64], last_pose: NDArray[np.float64]
) -> Points:
    """Transform points of a moving sensor, each with the sensor's pose at its measurement.

    The result is in the frame in which the first and last poses are given.

    Args:
        points: points in the moving frame.
        fractions: the fraction of the motion, from 0 to 1, after which each point was measured; shape (N,).
        first_pose: the pose at the beginning, x y z qx qy qz qw.
        last_pose: the pose at the end.
    """
    rotated = rotate(slerp(first_pose[3:], last_pose[3:], fractions), points.positions)
    positions = rotated + first_pose[:3] + fractions[:, np.newaxis] * (last_pose[:3] - first_pose[:3])
    return Points(positions.astype(np.float32), points.channels)
