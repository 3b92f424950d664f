"""Submaps as textures, which cartographer_node offers and the node of the occupancy grid paints.

A texture is a grid of pixels. A pixel has a brightness and an opacity: a pixel that is painted on gray shows white for
free space, black for walls, and gray where nothing is known. The rows of a texture go along -x and its columns along
-y of the slice pose. Source: Cartographer, SubmapQuery.
"""

from __future__ import annotations

import gzip
import zlib
from dataclasses import dataclass
from math import ceil, sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Transform, compose, rpy_from_quaternion
from linkwright.messages import get_message
from linkwright.navigation.grids.grid import FREE, OCCUPIED, UNKNOWN, Grid
from linkwright.navigation.slam.poses import FloatArray, transform_points

_BACKGROUND = 128.0
_FREE_BRIGHTNESS, _WALL_OPACITY = 127, 255
_MAX_PIXELS = 100_000_000
_PARALLEL_SINE = 1e-6
"""The sine of an angle below which axes count as parallel."""


@dataclass(frozen=True, slots=True, eq=False)
class Texture:
    """The pixels of a submap.

    Attributes:
        brightness: the brightness of the pixels, of shape (rows, columns).
        opacity: the opacity of the pixels, of shape (rows, columns).
        resolution: the side of a pixel in meters.
        slice_pose: the pose of the outer corner of pixel (0, 0) in the frame of the submap.
    """

    brightness: NDArray[np.uint8]
    opacity: NDArray[np.uint8]
    resolution: float
    slice_pose: Transform


def make_texture_message(grid: Grid) -> Any:
    """Convert a grid without rotation to a cartographer_ros_msgs/SubmapTexture in the frame of the grid."""
    cells = grid.cells[::-1, ::-1].T
    pixels = np.zeros((*cells.shape, 2), dtype=np.uint8)
    pixels[cells == FREE, 0] = _FREE_BRIGHTNESS
    pixels[cells == OCCUPIED, 1] = _WALL_OPACITY
    message = get_message("cartographer_ros_msgs/msg/SubmapTexture")()
    message.cells = np.frombuffer(gzip.compress(pixels.tobytes(), compresslevel=1, mtime=0), dtype=np.uint8)
    message.height, message.width = cells.shape
    message.resolution = grid.resolution
    position = message.slice_pose.position
    position.x = grid.x + grid.columns * grid.resolution
    position.y = grid.y + grid.rows * grid.resolution
    message.slice_pose.orientation.w = 1.0
    return message


def read_texture(message: Any) -> Texture | None:
    """Return the pixels of a cartographer_ros_msgs/SubmapTexture, or None if they do not fit its size."""
    count = message.width * message.height
    if not 0 < count <= _MAX_PIXELS or not message.resolution > 0.0:
        return None
    try:
        data = zlib.decompressobj(wbits=31).decompress(bytes(message.cells), 2 * count + 1)
    except zlib.error:
        return None
    if len(data) != 2 * count:
        return None
    pixels = np.frombuffer(data, dtype=np.uint8).reshape(message.height, message.width, 2)
    return Texture(pixels[..., 0], pixels[..., 1], float(message.resolution), transform_from_pose(message.slice_pose))


def transform_from_pose(pose: Any) -> Transform:
    """Return a geometry_msgs/Pose as a transform."""
    position, orientation = pose.position, pose.orientation
    return (position.x, position.y, position.z, orientation.x, orientation.y, orientation.z, orientation.w)


def paint(submaps: list[tuple[Transform, Texture]], resolution: float) -> Grid | None:
    """Paint submaps at their poses in the map, later ones over earlier ones.

    Returns:
        The smallest grid that contains all submaps, with occupancies in percent; None if no pixel is known.
    """
    layers = [_find_known_pixels(pose, texture, resolution) for pose, texture in submaps]
    layers = [layer for layer in layers if len(layer[0])]
    if not layers:
        return None
    cells = [np.floor(points / resolution).astype(np.int64) for points, _, _ in layers]
    low = np.min([layer.min(axis=0) for layer in cells], axis=0)
    high = np.max([layer.max(axis=0) for layer in cells], axis=0)
    columns, rows = high - low + 1
    if rows * columns > _MAX_PIXELS:
        return None
    color = np.full((rows, columns), _BACKGROUND)
    is_known = np.zeros((rows, columns), dtype=bool)
    for layer, (_, brightness, opacity) in zip(cells, layers, strict=True):
        index = (layer[:, 1] - low[1]) * columns + layer[:, 0] - low[0]
        order = np.argsort(opacity, kind="stable")  # Of several pixels in a cell, the wall is shown.
        top = np.full(rows * columns, -1, dtype=np.int64)
        top[index[order]] = order
        is_painted = top >= 0
        pixel, flat = top[is_painted], color.reshape(-1)
        flat[is_painted] = brightness[pixel] + flat[is_painted] * (1 - opacity[pixel] / 255)
        is_known.reshape(-1)[is_painted] = True
    percent = np.rint((1 - np.clip(color, 0, 255) / 255) * OCCUPIED).astype(np.int8)
    return Grid(
        cells=np.where(is_known, percent, np.int8(UNKNOWN)),
        resolution=resolution,
        x=float(low[0] * resolution),
        y=float(low[1] * resolution),
    )


def _find_known_pixels(
    pose: Transform, texture: Texture, resolution: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return points of the known pixels in the map, of shape (n, 2), with brightness and opacity.

    There are as many points in each pixel as are needed to reach each cell of a grid with the given resolution.
    """
    rows, columns = np.nonzero((texture.brightness > 0) | (texture.opacity > 0))
    corner = compose(pose, texture.slice_pose)
    planar = np.array((corner[0], corner[1], rpy_from_quaternion(corner[3:])[2]))
    diagonal = sqrt(2.0) if abs(np.sin(2 * planar[2])) > _PARALLEL_SINE else 1.0
    count = ceil(texture.resolution / resolution * diagonal - _PARALLEL_SINE)
    steps = (np.arange(count) + 0.5) / count
    within = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(1, -1, 2)
    offsets = -(np.stack((rows, columns), axis=-1)[:, None] + within) * texture.resolution
    points = transform_points(planar, offsets.reshape(-1, 2))
    brightness, opacity = (
        np.repeat(values[rows, columns].astype(np.float64), count**2)
        for values in (texture.brightness, texture.opacity)
    )
    return points, brightness, opacity
