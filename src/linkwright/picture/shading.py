"""Shade surfaces: compute the color of samples from normals, materials and lights.

Colors are computed in linear RGB, which is defined as the square of the displayed value. The square approximates the
transfer function of sRGB, and is bit-identical on every machine.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import Vector3, add_vectors, scaled
from linkwright.picture.camera import Camera
from linkwright.picture.rasterizer import ScreenTriangles, VisibleTriangles
from linkwright.picture.scene_mesh import Mesh
from linkwright.picture.vectors import Floats, Indices, along, unit_vector, unit_vectors

_KEY_STRENGTH, _FILL_STRENGTH, _SKY_STRENGTH, _GROUND_STRENGTH, _SPECULAR_STRENGTH, _RIM_STRENGTH = (
    0.74,
    0.14,
    0.34,
    0.14,
    0.09,
    0.05,
)
"""The strengths of the lights."""
_WRAP = 0.35
"""The extent to which the strongest light reaches around a shape, so that no side is black."""
_BATCH_SAMPLES = 1 << 18


@dataclass(frozen=True, slots=True)
class Lights:
    """The directions to the lights. They move with the camera, so all views are lit alike.

    Attributes:
        key: the direction to the strongest light, from the upper left of the camera.
        fill: the direction to a weak light from the right.
        to_camera: the direction to the camera.
    """

    key: Vector3
    fill: Vector3
    to_camera: Vector3

    @classmethod
    def of(cls, camera: Camera) -> Lights:
        """Return the lights that belong to a camera."""

        def direction(right: float, up: float, toward: float, vertical: float) -> Vector3:
            parts = add_vectors(scaled(camera.right, right), scaled(camera.up, up))
            return unit_vector(add_vectors(add_vectors(parts, scaled(camera.toward, toward)), (0.0, 0.0, vertical)))

        return cls(direction(-0.62, 0.30, 0.45, 0.55), direction(0.8, 0.1, 0.5, 0.1), camera.toward)


@dataclass(frozen=True, slots=True)
class ShadedSamples:
    """The colors of samples.

    Attributes:
        colors: linear RGB, shape (n, 3).
        alpha: the opacity, shape (n,).
        normals: the unit normals that face the camera, shape (n, 3).
    """

    colors: Floats
    alpha: Floats
    normals: Floats


class Shader:
    """A shader that computes the colors of samples.

    Args:
        mesh: the triangles of the scene.
        screen: the same triangles on the grid of samples.
        lights: the lights of the scene.
    """

    def __init__(self, mesh: Mesh, screen: ScreenTriangles, lights: Lights) -> None:
        self._mesh = mesh
        self._screen = screen
        self._lights = lights
        colors = mesh.colors
        self._linear_colors = colors * colors
        self._alphas = mesh.alphas
        self._textures = mesh.textures
        self._vertex_colors = {
            index: surface.vertex_colors
            for index, (surface, body) in enumerate(zip(mesh.surfaces, mesh.bodies, strict=True))
            if surface.vertex_colors is not None and body.ghost is None
        }
        self._first_vertices = np.cumsum([0, *(len(surface.points) for surface in mesh.surfaces)])

    def shade(self, visible: VisibleTriangles) -> ShadedSamples:
        """Return the colors of the samples at which triangles are visible."""
        table, rows = self._make_table(visible.triangles)
        parts = [
            self._shade(visible.x[part], visible.y[part], visible.triangles[part], table, rows[part])
            for part in (slice(start, start + _BATCH_SAMPLES) for start in range(0, len(rows), _BATCH_SAMPLES))
        ]
        return ShadedSamples(
            np.concatenate([part.colors for part in parts]),
            np.concatenate([part.alpha for part in parts]),
            np.concatenate([part.normals for part in parts]),
        )

    def _make_table(self, triangles: Indices) -> tuple[Floats, Indices]:
        """Return the table of values of the visible triangles, and the table row of each sample.

        The columns are: the corner, the gradients of two barycentric coordinates, a normal and its two differences.
        """
        is_visible = np.zeros(len(self._mesh.faces), dtype=bool)
        is_visible[triangles] = True
        visible = np.flatnonzero(is_visible)
        row_of = np.zeros(len(is_visible), np.int64)
        row_of[visible] = np.arange(len(visible))
        x, y = self._screen.x[visible], self._screen.y[visible]
        x1, y1, x2, y2 = x[:, 1] - x[:, 0], y[:, 1] - y[:, 0], x[:, 2] - x[:, 0], y[:, 2] - y[:, 0]
        area = x1 * y2 - x2 * y1
        inverse = np.where(np.abs(area) > 1e-9, 1.0, 0.0) / np.where(np.abs(area) > 1e-9, area, 1.0)
        normals = self._mesh.normals[self._mesh.faces[visible]] * np.where(area > 0, -1.0, 1.0)[:, None, None]
        table = np.empty((len(visible), 15), np.float32)
        table[:, 0], table[:, 1] = x[:, 0], y[:, 0]
        table[:, 2], table[:, 3] = y2 * inverse, -x2 * inverse
        table[:, 4], table[:, 5] = -y1 * inverse, x1 * inverse
        table[:, 6:9] = normals[:, 0]
        table[:, 9:12] = normals[:, 1] - normals[:, 0]
        table[:, 12:15] = normals[:, 2] - normals[:, 0]
        return table, row_of[triangles]

    def _shade(self, x: Floats, y: Floats, triangles: Indices, table: Floats, rows: Indices) -> ShadedSamples:
        values = table[rows]
        x, y = x - values[:, 0], y - values[:, 1]
        second = np.clip(values[:, 2] * x + values[:, 3] * y, 0.0, 1.0)
        third = np.clip(values[:, 4] * x + values[:, 5] * y, 0.0, 1.0)
        normals = values[:, 6:9] + second[:, None] * values[:, 9:12] + third[:, None] * values[:, 12:15]
        normals = unit_vectors(normals)
        parts = self._mesh.parts[triangles]
        albedo = self._compute_albedo(triangles, parts, second, third)
        return ShadedSamples(self._apply_lights(albedo, normals), self._alphas[parts], normals)

    def _apply_lights(self, albedo: Floats, normals: Floats) -> Floats:
        lights = self._lights
        facing_camera = np.maximum(along(normals, lights.to_camera), 0.0)
        key = np.maximum((along(normals, lights.key) + _WRAP) / (1.0 + _WRAP), 0.0)
        key = (key + key * key) * 0.5  # smooths the border between light and shade
        fill = along(normals, lights.fill) * 0.5 + 0.5
        sky = (normals[:, 2] + 1.0) * 0.5
        diffuse = (
            _KEY_STRENGTH * key
            + _FILL_STRENGTH * fill * fill
            + (_GROUND_STRENGTH + (_SKY_STRENGTH - _GROUND_STRENGTH) * sky)
        )
        specular = np.maximum(along(normals, unit_vector(add_vectors(lights.key, lights.to_camera))), 0.0)
        for _ in range(5):
            specular = specular * specular
        away = 1.0 - facing_camera
        rim = away * away * away * sky
        specular_and_rim = _SPECULAR_STRENGTH * specular + _RIM_STRENGTH * rim
        lit: Floats = albedo * diffuse[:, None] + specular_and_rim[:, None]
        return lit

    def _compute_albedo(self, triangles: Indices, parts: Indices, second: Floats, third: Floats) -> Floats:
        """Return the material colors of samples in linear RGB."""
        albedo = self._linear_colors[parts]
        for index, texture in self._textures.items():
            selected = np.flatnonzero(parts == index)
            coordinates = self._mesh.surfaces[index].coordinates
            if len(selected) and coordinates is not None:
                u, v = self._interpolate(coordinates, index, triangles[selected], second[selected], third[selected]).T
                height, width = texture.shape[:2]
                columns = np.clip(np.floor((u - np.floor(u)) * width), 0, width - 1).astype(np.int64)
                rows = np.clip(np.floor((v - np.floor(v)) * height), 0, height - 1).astype(np.int64)
                texels = texture[rows, columns].astype(np.float32) * (1.0 / 255.0)
                albedo[selected] *= texels * texels
        for index, colors in self._vertex_colors.items():
            selected = np.flatnonzero(parts == index)
            if len(selected):
                mixed = self._interpolate(colors, index, triangles[selected], second[selected], third[selected])
                albedo[selected] *= (mixed * mixed).astype(np.float32)
        return albedo

    def _interpolate(
        self, values: NDArray[np.float64], part: int, triangles: Indices, second: Floats, third: Floats
    ) -> NDArray[np.float64]:
        """Return values of a surface's vertices, interpolated at samples."""
        corners = values[self._mesh.faces[triangles] - self._first_vertices[part]]
        first_values = corners[:, 0]
        mixed: NDArray[np.float64] = (
            first_values
            + second[:, None] * (corners[:, 1] - first_values)
            + third[:, None] * (corners[:, 2] - first_values)
        )
        return mixed
