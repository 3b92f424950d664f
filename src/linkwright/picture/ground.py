"""The ground below a scene: a soft shadow, and a grid."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.picture.bodies import Color
from linkwright.picture.camera import Camera
from linkwright.picture.edges import sum_over_boxes
from linkwright.picture.rasterizer import ScreenTriangles, rasterize
from linkwright.picture.scene_mesh import Mesh
from linkwright.picture.vectors import Floats

_CELLS_PER_SIDE = 320
"""The number of cells along the longer side of the shadow map."""
_LAYER_HEIGHTS = (0.015, 0.05, 0.12, 0.25, 0.5, 1e9)
"""The upper limits of the shadow's layers, relative to the size of the scene. Shadows of higher layers are softer."""
_SOFTNESS = 0.30
"""The radius of the blur, relative to the height above the ground."""
_MIN_SOFTNESS = 0.012
_DARKNESS = 0.50
_LINE_COUNT = 8
"""The approximate number of grid cells along the longer side of the scene."""
_LINE_WIDTH_PIXELS, _AXIS_WIDTH_PIXELS = 0.9, 1.8
"""The widths of lines in pixels."""
_LINE_STRENGTH, _AXIS_STRENGTH = 0.30, 0.65
_GRID_COLOR: Color = (0.30, 0.34, 0.40)
_AXIS_COLORS: tuple[Color, Color] = ((0.80, 0.20, 0.18), (0.22, 0.60, 0.22))
"""The colors of the lines along x and along y through the origin."""
_MIN_ELEVATION_SINE = 0.06
"""The minimum sine of the camera's elevation at which the ground is drawn."""
_MIN_SINE_FROM_ABOVE = 0.985
"""The minimum sine of the camera's elevation at which it counts as above the scene."""


@dataclass(frozen=True, eq=False, slots=True)
class ShadowMap:
    """A map of the shadow on the ground, divided into cells.

    Attributes:
        height: z of the ground.
        origin: x and y of the first cell.
        cell: the edge of a cell in m.
        darkness: the darkness of each cell, 0 to 1, shape (along y, along x).
    """

    height: float
    origin: tuple[float, float]
    cell: float
    darkness: Floats

    def darkness_at(self, points: Array) -> Floats:
        """Return the darkness at points of the ground, shape (n, 3), interpolated between cells."""
        rows, columns = self.darkness.shape
        x = np.nan_to_num((points[:, 0] - self.origin[0]) / self.cell - 0.5, nan=-1e6, posinf=-1e6, neginf=-1e6)
        y = np.nan_to_num((points[:, 1] - self.origin[1]) / self.cell - 0.5, nan=-1e6, posinf=-1e6, neginf=-1e6)
        is_inside = (x >= 0) & (y >= 0) & (x < columns - 1) & (y < rows - 1)
        x, y = np.where(is_inside, x, 0.0), np.where(is_inside, y, 0.0)
        column, row = np.floor(x).astype(np.int64), np.floor(y).astype(np.int64)
        across, along = (x - column).astype(np.float32), (y - row).astype(np.float32)
        upper = self.darkness[row, column] * (1.0 - across) + self.darkness[row, column + 1] * across
        lower = self.darkness[row + 1, column] * (1.0 - across) + self.darkness[row + 1, column + 1] * across
        darkness: Floats = np.where(is_inside, upper * (1.0 - along) + lower * along, np.float32(0.0))
        return darkness


def compute_shadow_map(mesh: Mesh, key: Vector3) -> ShadowMap | None:
    """Return the shadow map of a scene on the plane below it, or None if there is no shadow.

    Args:
        mesh: the triangles of the scene.
        key: the direction to the light.
    """
    solid = mesh.solid
    if not len(solid) or key[2] <= 0.1:
        return None
    is_used = np.zeros(len(mesh.points), dtype=bool)
    is_used[mesh.faces[solid].reshape(-1)] = True
    low, high = mesh.points[is_used].min(axis=0), mesh.points[is_used].max(axis=0)
    ground = float(low[2])
    height = np.maximum(mesh.points[:, 2] - ground, 0.0)
    x = mesh.points[:, 0] - height * (key[0] / key[2])
    y = mesh.points[:, 1] - height * (key[1] / key[2])
    size = max(float(extent) for extent in high - low) or 1e-6
    margin = 2.2 * (_MIN_SOFTNESS + _SOFTNESS * float(high[2] - low[2]) / size) * size
    left, right = float(x[is_used].min()) - margin, float(x[is_used].max()) + margin
    back, front = float(y[is_used].min()) - margin, float(y[is_used].max()) + margin
    cell = max(right - left, front - back) / _CELLS_PER_SIDE
    columns, rows = int((right - left) / cell) + 2, int((front - back) / cell) + 2
    triangles = ScreenTriangles.from_faces((x - left) / cell, (y - back) / cell, height / size, mesh.faces)
    layers = np.zeros((len(_LAYER_HEIGHTS), rows * columns), dtype=bool)
    for part in rasterize(triangles, solid, columns, 0, rows):
        layers[np.searchsorted(_LAYER_HEIGHTS, part.nearness), part.samples] = True
    light = np.ones((rows, columns), np.float32)
    lower_limit = 0.0
    for limit, layer in zip(_LAYER_HEIGHTS, layers.reshape(-1, rows, columns), strict=True):
        middle = (lower_limit + min(limit, 1.0)) / 2
        reach = max(1, round((_MIN_SOFTNESS + _SOFTNESS * middle) * size / cell))
        light *= np.float32(1.0) - _blur(layer, reach)
        lower_limit = limit
    return ShadowMap(ground, (left, back), cell, (np.float32(1.0) - light) * np.float32(_DARKNESS))


def _blur(mask: NDArray[np.bool_], reach: int) -> Floats:
    """Return a mask after two box blurs, with values from 0 to 1."""
    area = 2 * reach + 1
    sums = sum_over_boxes(sum_over_boxes(mask.astype(np.int64), reach), reach)
    return (sums.astype(np.float64) / float(area**4)).astype(np.float32)


def is_ground_visible(camera: Camera) -> bool:
    """Return whether the camera looks at the ground from above."""
    return camera.toward[2] >= _MIN_ELEVATION_SINE


def is_from_above(camera: Camera) -> bool:
    """Return whether the camera looks straight down.

    The shadow of a tall body on the ground would then be larger than the body, and look like a part of it.
    """
    return camera.toward[2] >= _MIN_SINE_FROM_ABOVE


@dataclass(frozen=True, slots=True)
class GroundGrid:
    """A grid on the ground around a scene, with lines at multiples of its spacing.

    Attributes:
        height: z of the ground in m.
        spacing: the distance between lines in m.
        center: x and y of the middle in m.
        radius: the distance from the middle at which the grid ends, in m.
    """

    height: float
    spacing: float
    center: tuple[float, float]
    radius: float

    @classmethod
    def around(cls, points: Array) -> GroundGrid:
        """Return the grid for a scene that contains these points, shape (n, 3)."""
        low, high = points.min(axis=0).tolist(), points.max(axis=0).tolist()
        extent = max(high[0] - low[0], high[1] - low[1], (high[2] - low[2]) / 2, 1e-3)
        spacing = 1e-6
        while spacing * 10 < extent / _LINE_COUNT:
            spacing *= 10
        spacing *= next(factor for factor in (1, 2, 5, 10) if spacing * factor >= extent / _LINE_COUNT)
        return cls(low[2], spacing, ((low[0] + high[0]) / 2, (low[1] + high[1]) / 2), extent * 1.6)

    def draw(self, light: Floats, alpha: Floats, camera: Camera, first_row: int) -> None:
        """Draw the grid into rows of an image.

        Args:
            light: the light of the pixels multiplied by their opacity, shape (rows, width, 3), which is changed.
            alpha: the opacity of the pixels, shape (rows, width), which is changed.
            camera: the camera of the image.
            first_row: the row of the image that is the first one.
        """
        last_row = first_row + len(alpha)
        points = compute_ground_points(camera, self.height, first_row, last_row)
        right = compute_ground_points(camera, self.height, first_row, last_row, (1.0, 0.0))
        down = compute_ground_points(camera, self.height, first_row, last_row, (0.0, 1.0))
        steps = np.abs(right - points) + np.abs(down - points)  # the size of a pixel on the ground
        x, y = points[:, 0] - self.center[0], points[:, 1] - self.center[1]
        fading = np.clip(2.0 - 2.0 * np.sqrt(x * x + y * y) / self.radius, 0.0, 1.0)
        for axis, color in ((1, _AXIS_COLORS[0]), (0, _AXIS_COLORS[1])):
            multiples = np.rint(points[:, axis] / self.spacing)
            distance = np.abs(points[:, axis] - multiples * self.spacing) / steps[:, axis]
            is_axis = multiples == 0
            width = np.where(is_axis, _AXIS_WIDTH_PIXELS, _LINE_WIDTH_PIXELS)
            strength = np.where(is_axis, _AXIS_STRENGTH, _LINE_STRENGTH)
            dense = np.clip(0.25 * self.spacing / steps[:, axis], 0.0, 1.0)
            cover = np.clip(width / 2 + 0.5 - distance, 0.0, 1.0) * strength * fading * dense
            cover = np.nan_to_num(cover, nan=0.0).astype(np.float32).reshape(alpha.shape)
            paint = np.where(is_axis[:, None], np.array(color), np.array(_GRID_COLOR)).astype(np.float32)
            paint = (paint * paint).reshape(light.shape)
            light[:] = light * (1.0 - cover)[:, :, None] + paint * cover[:, :, None]
            alpha[:] = alpha * (1.0 - cover) + cover


def compute_ground_points(
    camera: Camera, height: float, first_row: int, last_row: int, offset: tuple[float, float] = (0.0, 0.0)
) -> Array:
    """Return the point of the ground at each pixel of some rows, shape (pixels, 3).

    Above the horizon, the point is not a number. `offset` moves all pixels to the right and downward.
    """
    width = camera.size[0]
    x = np.tile(np.arange(width) + (0.5 + offset[0]), last_row - first_row)
    y = np.repeat(np.arange(first_row, last_row) + (0.5 + offset[1]), width)
    return camera.points_on_plane(height, x, y)
