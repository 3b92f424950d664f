"""The points of a node of rtabmap's map, from its depth image or its laser scan.

Images are PNG or JPEG files, or 16-bit depths as RVL: the text ``DEPTHRVL``, the columns and rows, each a uint32, and
the stream. Depths of 32 bits are a PNG whose four channels are the bytes of a float. Other arrays are compressed with
zlib, and three int32 follow: rows, columns, and OpenCV's type.
"""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import phrase
from linkwright.geometry.arrays import rotate
from linkwright.images import BadImageError, RangeFinder, decode_image
from linkwright.images.compressed_depth import BadRvlError, decode_rvl
from linkwright.images.image_files import MAX_PIXELS, decode_file
from linkwright.rviz.clouds import BadCloudError, Points, points_from_cloud

_RVL_MARK = b"DEPTHRVL"
_RVL_SIZE = struct.Struct("<II")
_SHAPE = struct.Struct("<iii")
_FLOAT_DEPTH, _TYPE_BITS = 5, 3
"""OpenCV's code of float32, and the number of bits of this code; the number of channels less one follows."""

_SPATIAL_FORMATS = range(5, 12)
"""The formats of laser scans whose points have three coordinates; others have two."""
_FORMATS_WITH_INTENSITY = (2, 4, 6, 9, 11)
_FORMATS_WITH_COLOR = (7, 10)
_MILLIMETER = 0.001
_MAX_SCAN_BYTES = 1 << 28


@dataclass(frozen=True, slots=True)
class CloudLimits:
    """The part of a node's data that becomes points.

    Attributes:
        decimation: every n-th row and column of a depth image is used.
        min_depth: the minimum depth in meters.
        max_depth: the maximum depth in meters; 0 for no limit.
        voxel_size: at most one point is kept in each cube of this size, in meters; 0 to keep all.
        floor: the minimum height in the frame of the odometry, in meters; 0 for no limit.
        ceiling: the maximum height there; 0 for no limit.
    """

    decimation: int = 4
    min_depth: float = 0.0
    max_depth: float = 4.0
    voxel_size: float = 0.01
    floor: float = 0.0
    ceiling: float = 0.0


def read_depth_points(node: Any, limits: CloudLimits) -> Points | None:
    """Return the colored points of a node's depth image in the frame of the robot, or None if there is none.

    Args:
        node: rtabmap_msgs/msg/Node.
        limits: the points to keep.

    Raises:
        BadCloudError: the depth image does not fit the cameras.
        BadImageError: an image cannot be read.
    """
    data = node.data
    depths = _read_depths(data)
    cameras = list(zip(data.left_camera_info, data.local_transform, strict=False))
    if depths is None or not cameras:
        return None
    colors = _read_colors(data)
    width = depths.shape[1] // len(cameras)
    parts = []
    for number, (info, transform) in enumerate(cameras):
        columns = slice(number * width, (number + 1) * width)
        share = None
        if colors is not None:
            color_width = colors.shape[1] // len(cameras)
            share = colors[:, number * color_width : (number + 1) * color_width]
        points = _project(depths[:, columns], share, info, limits)
        parts.append(Points(_place(transform, points.positions), points.channels))
    merged = Points(
        np.concatenate([part.positions for part in parts]),
        {"rgb": np.concatenate([part.channels["rgb"] for part in parts])},
    )
    return _limit(merged, node.pose, limits)


def read_scan_points(node: Any, limits: CloudLimits) -> Points | None:
    """Return the points of a node's laser scan in the frame of the robot, or None if there is none.

    Args:
        node: rtabmap_msgs/msg/Node.
        limits: the points to keep.

    Raises:
        BadCloudError: the scan cannot be read.
    """
    data = node.data
    if len(data.laser_scan_compressed):
        points = _read_compressed_scan(bytes(data.laser_scan_compressed), data.laser_scan_format)
    elif len(data.laser_scan.data):
        points = points_from_cloud(data.laser_scan)
    else:
        return None
    distances = np.linalg.norm(points.positions, axis=1)
    is_kept = distances >= limits.min_depth
    if limits.max_depth > 0:
        is_kept &= distances <= limits.max_depth
    points = _select(points, is_kept)
    placed = Points(_place(data.laser_scan_local_transform, points.positions), points.channels)
    return _limit(placed, node.pose, limits)


# --- images --------------------------------------------------------------------------------------------------------


def _read_depths(data: Any) -> NDArray[np.float32] | None:
    """Return the depths in meters, shape (height, width), or None if there is no depth image."""
    if len(data.right_compressed):
        content = np.frombuffer(data.right_compressed, np.uint8)
        image = _decode_rvl_file(content) if content[:8].tobytes() == _RVL_MARK else decode_file(content)
        if image.ndim == 3 and image.shape[2] == 4:
            return np.ascontiguousarray(image[..., [2, 1, 0, 3]]).view("<f4")[..., 0]
        return image.astype(np.float32) * np.float32(_MILLIMETER) if image.dtype == np.uint16 else None
    right = data.right
    if right.encoding not in ("16UC1", "mono16", "32FC1"):
        return None
    code = ">" if right.is_bigendian else "<"
    code += "f4" if right.encoding == "32FC1" else "u2"
    step = right.step or right.width * int(code[2])
    if step < right.width * int(code[2]) or len(right.data) < step * right.height:
        raise BadCloudError(phrase("The depth image of a node is too short for its size"))
    raw: NDArray[Any] = np.ndarray((right.height, right.width), code, bytes(right.data), 0, (step, int(code[2])))
    meters = raw.astype(np.float32)
    return meters if code[1] == "f" else meters * np.float32(_MILLIMETER)


def _decode_rvl_file(content: NDArray[np.uint8]) -> NDArray[np.uint16]:
    start = len(_RVL_MARK)
    if content.size < start + _RVL_SIZE.size:
        raise BadImageError(phrase("The RVL depth image is too short to contain its size"))
    columns, rows = _RVL_SIZE.unpack_from(content.tobytes(), start)
    if not 0 < columns * rows <= MAX_PIXELS:
        raise BadImageError(phrase("The RVL depth image has an invalid size"))
    try:
        return decode_rvl(content[start + _RVL_SIZE.size :], columns * rows).reshape(rows, columns)
    except BadRvlError as error:
        raise BadImageError(error.args[0]) from None


def _read_colors(data: Any) -> NDArray[np.uint8] | None:
    """Return the colors, shape (height, width, 3), or None if there are none."""
    if len(data.left_compressed):
        pixels = decode_file(np.frombuffer(data.left_compressed, np.uint8))
        if pixels.dtype != np.uint8:
            return None
        return np.repeat(pixels[..., np.newaxis], 3, axis=2) if pixels.ndim == 2 else pixels[..., :3]
    return decode_image(data.left, RangeFinder()).rgb() if len(data.left.data) else None


def _project(depths: NDArray[np.float32], colors: NDArray[np.uint8] | None, info: Any, limits: CloudLimits) -> Points:
    """Return the points of a camera in its optical frame."""
    height, width = depths.shape
    # A depth image may be smaller than the color image, whose size the camera has.
    scale = width / (info.width or width)
    matrix = np.asarray(info.p, np.float64)
    focal_x, focal_y, center_x, center_y = matrix[[0, 5, 2, 6]]
    if not focal_x > 0:
        focal_x, focal_y, center_x, center_y = np.asarray(info.k, np.float64)[[0, 4, 2, 5]]
    if not (np.isfinite((focal_x, focal_y, center_x, center_y)).all() and focal_x > 0 and focal_y > 0):
        raise BadCloudError(phrase("The camera of a node has no focal length"))
    rows, columns = np.mgrid[0 : height : limits.decimation, 0 : width : limits.decimation]
    z = depths[rows, columns]
    with np.errstate(invalid="ignore"):
        is_kept = np.isfinite(z) & (z > 0) & (z >= limits.min_depth)
        if limits.max_depth > 0:
            is_kept &= z <= limits.max_depth
    rows, columns, z = rows[is_kept], columns[is_kept], z[is_kept]
    x = (columns - center_x * scale) * z / (focal_x * scale)
    y = (rows - center_y * scale) * z / (focal_y * scale)
    rgb = np.full(len(z), 0xFFFFFF, np.uint32)
    if colors is not None and colors.size:
        pixels = colors[rows * colors.shape[0] // height, columns * colors.shape[1] // width].astype(np.uint32)
        rgb = pixels[:, 0] << 16 | pixels[:, 1] << 8 | pixels[:, 2]
    return Points(np.stack([x, y, z], axis=1).astype(np.float32), {"rgb": rgb})


# --- scans ---------------------------------------------------------------------------------------------------------


def _read_compressed_scan(content: bytes, scan_format: int) -> Points:
    """Return the points of a scan in the frame of the scanner."""
    rows, columns, kind = _SHAPE.unpack(content[-_SHAPE.size :]) if len(content) > _SHAPE.size else (0, 0, 0)
    channel_count = (kind >> _TYPE_BITS) + 1
    size = rows * columns * channel_count * 4
    is_spatial = scan_format in _SPATIAL_FORMATS
    coordinate_count = 3 if is_spatial else 2
    if kind & 7 != _FLOAT_DEPTH or not 0 < size <= _MAX_SCAN_BYTES or channel_count < coordinate_count:
        raise BadCloudError(phrase("The laser scan of a node has an unknown format"))
    try:
        unpacked = zlib.decompressobj().decompress(content[: -_SHAPE.size], size)
    except zlib.error:
        unpacked = b""
    if len(unpacked) != size:
        raise BadCloudError(phrase("The laser scan of a node is damaged"))
    values = np.frombuffer(unpacked, "<f4").reshape(-1, channel_count)
    positions = np.zeros((len(values), 3), np.float32)
    positions[:, :coordinate_count] = values[:, :coordinate_count]
    channels: dict[str, NDArray[Any]] = {}
    if channel_count > coordinate_count and scan_format in _FORMATS_WITH_INTENSITY:
        channels["intensity"] = values[:, coordinate_count]
    elif channel_count > coordinate_count and scan_format in _FORMATS_WITH_COLOR:
        channels["rgb"] = np.ascontiguousarray(values[:, coordinate_count]).view(np.uint32)
    is_finite: NDArray[np.bool_] = np.asarray(np.isfinite(positions).all(axis=1))
    return _select(Points(positions, channels), is_finite)


# --- points --------------------------------------------------------------------------------------------------------


def _place(transform: Any, positions: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return positions transformed by a geometry_msgs/msg/Transform."""
    translation, rotation = transform.translation, transform.rotation
    quaternion = (rotation.x, rotation.y, rotation.z, rotation.w)
    offset = np.array((translation.x, translation.y, translation.z))
    moved: NDArray[np.float32] = (rotate(quaternion, positions) + offset).astype(np.float32)
    return moved


def _limit(points: Points, pose: Any, limits: CloudLimits) -> Points:
    """Return the points between floor and ceiling, at most one in each voxel."""
    if limits.floor or limits.ceiling:
        orientation = pose.orientation
        quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
        heights = rotate(quaternion, points.positions)[:, 2] + pose.position.z
        is_kept = np.ones(len(points), np.bool_)
        if limits.floor:
            is_kept &= heights >= limits.floor
        if limits.ceiling and (not limits.floor or limits.ceiling > limits.floor):
            is_kept &= heights <= limits.ceiling
        points = _select(points, is_kept)
    if limits.voxel_size > 0 and len(points):
        cells = np.floor(points.positions / limits.voxel_size).astype(np.int64)
        cells -= cells.min(axis=0)
        sizes = cells.max(axis=0) + 1
        _, first = np.unique((cells[:, 0] * sizes[1] + cells[:, 1]) * sizes[2] + cells[:, 2], return_index=True)
        points = _select(points, np.sort(first))
    return points


def _select(points: Points, chosen: NDArray[Any]) -> Points:
    """Return the points of a mask, or with some indices."""
    return Points(points.positions[chosen], {name: values[chosen] for name, values in points.channels.items()})
