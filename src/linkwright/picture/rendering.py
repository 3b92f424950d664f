"""Render a scene to the pixels of an image."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from linkwright.picture.axes import draw_axes
from linkwright.picture.camera import VIEWS, Camera, View
from linkwright.picture.cast_shadows import CastShadows
from linkwright.picture.clipping import project_mesh
from linkwright.picture.edges import compute_edge_strength
from linkwright.picture.ground import (
    GroundGrid,
    compute_ground_points,
    compute_shadow_map,
    is_from_above,
    is_ground_visible,
)
from linkwright.picture.labels import draw_labels
from linkwright.picture.occlusion import compute_ambient_light, compute_occlusion_reach
from linkwright.picture.outlines import draw_outlines, find_window
from linkwright.picture.rasterizer import MAX_TRIANGLES, NOTHING, DepthBuffer, ScreenTriangles, VisibleTriangles
from linkwright.picture.scene import Scene, camera_for
from linkwright.picture.shading import Lights, Shader
from linkwright.picture.vectors import Floats, Indices, along

Image = NDArray[np.uint8]

_SAMPLES_PER_PIXEL, _SAMPLES_PER_PIXEL_OF_LARGE = 3, 2
"""The samples per pixel along a row, in images of normal and of large size."""
_FILTERS = {2: (1, 3, 3, 1), 3: (1, 2, 3, 2, 1)}
"""By samples per pixel: the weights of a pixel's samples along a row, with one sample of each neighbor."""
_LARGE_IMAGE_PIXELS = 2_500_000
_BAND_SAMPLES = 6_000_000
"""The approximate number of samples to render at once."""
_LINE_REACH = 8
"""The number of pixels around a pixel that affect its lines."""
_PEELED_LAYERS = 3
"""The maximum number of transparent surfaces drawn behind each other."""
_GHOST_ALPHA = 0.38
"""The opacity of a ghost, from 0 to 1."""
_EDGE_LIGHT = 0.012
_BACKGROUND_TOP, _BACKGROUND_BOTTOM = (0.98, 0.984, 0.988), (0.87, 0.89, 0.914)
"""The colors of the background at the top and at the bottom."""


@dataclass(frozen=True, slots=True)
class Style:
    """The parts of an image other than the bodies.

    Attributes:
        transparent: whether the background is transparent.
        grid: whether to draw a grid on the ground.
        labels: whose names to draw: those of links, of joints, or None for no names.
    """

    transparent: bool = False
    grid: bool = False
    labels: Literal["links", "joints"] | None = None


def render(
    scene: Scene,
    view: View = VIEWS["iso"],
    size: tuple[int, int] = (800, 600),
    style: Style = Style(),
    camera: Camera | None = None,
) -> Image:
    """Render the image of a scene.

    Args:
        scene: the bodies.
        view: the direction from which the scene is seen.
        size: the width and height in pixels.
        style: the parts of the image besides the bodies.
        camera: a camera, instead of the one that fits the scene into the image (see `camera_for`).

    Returns:
        Red, green, blue and alpha, not multiplied by it, shape (height, width, 4).
    """
    return _Renderer(scene, camera or camera_for(view, size, scene), style).render()


class _Renderer:
    def __init__(self, scene: Scene, camera: Camera, style: Style) -> None:
        self._mesh = mesh = scene.mesh
        self._camera = camera
        self._style = style
        self._width, self._height = camera.size
        self._per_pixel = (
            _SAMPLES_PER_PIXEL if self._width * self._height <= _LARGE_IMAGE_PIXELS else _SAMPLES_PER_PIXEL_OF_LARGE
        )
        self._projected = projected = project_mesh(camera, mesh.points, mesh.faces)
        x, y, nearness = projected.x, projected.y, projected.nearness
        self._screen = ScreenTriangles.from_faces(x * self._per_pixel, y * self._per_pixel, nearness, mesh.faces)
        self._range = (float(nearness.max()), float(nearness.min())) if len(nearness) else (1.0, 0.0)
        lights = Lights.of(camera)
        self._shader = Shader(mesh, self._screen, lights)
        self._cast = CastShadows(mesh, lights.key) if len(mesh.solid) else None
        is_on_ground = is_ground_visible(camera)
        self._shadow = None if not is_on_ground or is_from_above(camera) else compute_shadow_map(mesh, lights.key)
        self._grid = GroundGrid.around(scene.points) if style.grid and is_on_ground else None
        self._anchors = {None: (), "links": scene.labels.links, "joints": scene.labels.joints}[style.labels]
        self._axes = scene.axes
        numbers = {id(body): index for index, body in enumerate(dict.fromkeys(mesh.bodies))}
        self._body_numbers = np.array([numbers[id(body)] for body in mesh.bodies], np.int32)

    def render(self) -> Image:
        rows = max(1, _BAND_SAMPLES // (self._width * self._per_pixel**2))
        bands = [self._render_band(first, min(first + rows, self._height)) for first in range(0, self._height, rows)]
        light, alpha = (np.concatenate(arrays) for arrays in zip(*bands, strict=True))
        draw_axes(light, alpha, self._axes, self._camera)
        draw_labels(light, alpha, self._anchors, self._camera)
        return _quantize(light, alpha)

    def _render_band(self, first: int, last: int) -> tuple[Floats, Floats]:
        """Return the light of some rows of pixels, multiplied by the opacity, and the opacity."""
        overlap = _LINE_REACH + compute_occlusion_reach(self._camera)
        upper, lower = max(0, first - overlap), min(self._height, last + overlap)
        light, alpha = self._render_bodies(upper, lower)
        requested_rows = slice(first - upper, last - upper)
        light, alpha = light[requested_rows], alpha[requested_rows]
        light_below, alpha_below = self._render_ground(first, last)
        transparency = 1.0 - alpha
        return light + light_below * transparency[:, :, None], alpha + alpha_below * transparency

    # --- bodies ------------------------------------------------------------------------------------------------

    def _render_bodies(self, upper: int, lower: int) -> tuple[Floats, Floats]:
        """Return the light of the bodies multiplied by their opacity, and the opacity.

        The shapes are (rows, width, 3) and (rows, width).
        """
        mesh, scale = self._mesh, self._per_pixel
        width = self._width * scale
        opaque = DepthBuffer(width, upper * scale, lower * scale, *self._range)
        opaque.add(self._screen, self._projected.select(mesh.opaque))
        rows = (lower - upper) * scale
        light = np.zeros((rows, width, 3), np.float32)
        alpha = np.zeros((rows, width), np.float32)
        self._blend(light, alpha, opaque, is_first=True)
        transparent = self._projected.select(mesh.transparent)
        if len(transparent):
            for layer in reversed(self._peel(transparent, opaque)):
                self._blend(light, alpha, layer)
        ghosts = self._projected.select(mesh.ghosts)
        if len(ghosts):
            layer = opaque.make_empty_copy()
            layer.add(self._screen, ghosts, in_front_of=opaque)
            self._blend(light, alpha, layer, opacity=_GHOST_ALPHA)
        for color, triangles in mesh.outlined_triangles().items():
            layer = opaque.make_empty_copy()
            layer.add(self._screen, self._projected.select(triangles))
            mask = layer.keys != NOTHING
            bodies = np.full(len(mask), -1, np.int32)
            bodies[mask] = self._body_numbers[mesh.parts[layer.keys[mask] & (MAX_TRIANGLES - 1)]]
            is_visible = mask & (layer.keys <= opaque.keys)
            draw_outlines(light, alpha, bodies.reshape(alpha.shape), is_visible.reshape(alpha.shape), color, scale)
        return _filter_samples(light, alpha, scale)

    def _peel(self, transparent: Indices, opaque: DepthBuffer) -> list[DepthBuffer]:
        """Return the transparent surfaces in front of the opaque ones, the nearest first."""
        layers: list[DepthBuffer] = []
        for _ in range(_PEELED_LAYERS):
            layer = opaque.make_empty_copy()
            layer.add(self._screen, transparent, behind=layers[-1] if layers else None, in_front_of=opaque)
            if layer.is_empty:
                break
            layers.append(layer)
        return layers

    def _blend(
        self,
        light: Floats,
        alpha: Floats,
        buffer: DepthBuffer,
        *,
        opacity: float | None = None,
        is_first: bool = False,
    ) -> None:
        """Draw the visible triangles of a buffer over the current light and opacity of samples.

        Args:
            light: the light of samples multiplied by their opacity, which is changed.
            alpha: the opacity of samples, which is changed.
            buffer: the triangles.
            opacity: the opacity; None for that of the materials.
            is_first: whether nothing was drawn yet; corners and shadows are those of the first surface.
        """
        visible = buffer.visible_triangles(self._per_pixel)
        if visible is None:
            return
        shaded = self._shader.shade(visible)
        lines = self._compute_lines(visible, shaded.normals)
        alphas = shaded.alpha if opacity is None else np.full(len(lines), opacity, np.float32)
        alphas = alphas + (1.0 - alphas) * lines
        colors = shaded.colors
        if is_first:
            colors *= self._compute_ambient(visible, shaded.normals)[:, None]
        colors *= ((1.0 - lines) * alphas)[:, None]
        colors += (lines * alphas * _EDGE_LIGHT)[:, None]
        light, alpha = light[visible.window], alpha[visible.window]
        if not is_first:
            transparency = 1.0 - alphas
            colors += light[visible.mask] * transparency[:, None]
            alphas = alphas + alpha[visible.mask] * transparency
        light[visible.mask] = colors
        alpha[visible.mask] = alphas

    def _compute_ambient(self, visible: VisibleTriangles, normals: Floats) -> Floats:
        """Return the fraction of ambient light at samples, computed at the center of each pixel."""
        scale, camera = self._per_pixel, self._camera
        middles = (slice(scale // 2, None, scale), slice(scale // 2, None, scale))
        is_seen = visible.mask[middles]
        nearness = np.zeros(visible.mask.shape, np.float32)
        nearness[visible.mask] = self._range[0] - visible.distances * (self._range[0] - self._range[1])
        depth = nearness[middles]
        if camera.distance:
            depth = (camera.distance - camera.distance / np.where(is_seen, depth, 1.0)).astype(np.float32)
        turned = np.zeros((3, *is_seen.shape), np.float32)
        at_middle = np.zeros(visible.mask.shape, dtype=bool)
        at_middle[middles] = True
        of_middles = normals[at_middle[visible.mask]]
        for axis, direction in enumerate((camera.right, camera.up, camera.toward)):
            turned[axis][is_seen] = along(of_middles, direction)
        ambient = compute_ambient_light(depth, turned, is_seen, camera)
        if self._cast is not None:
            x, y = (values[at_middle[visible.mask]].astype(np.float64) / scale for values in (visible.x, visible.y))
            points = camera.points_at(x, y, depth[is_seen].astype(np.float64))
            ambient[is_seen] *= self._cast.compute_light(points, of_middles)
        spread: Floats = np.repeat(np.repeat(ambient, scale, axis=0), scale, axis=1)[visible.mask]
        return spread

    def _compute_lines(self, visible: VisibleTriangles, normals: Floats) -> Floats:
        """Return the darkness of lines at samples."""
        bodies = np.full(visible.mask.shape, -1, np.int32)
        bodies[visible.mask] = self._body_numbers[self._mesh.parts[visible.triangles]]
        distances = np.full(visible.mask.shape, 2.0, np.float32)
        distances[visible.mask] = visible.distances
        normal_grid = np.zeros((3, *visible.mask.shape), np.float32)
        for axis in range(3):
            normal_grid[axis][visible.mask] = normals[:, axis]
        lines: Floats = compute_edge_strength(distances, normal_grid, bodies, self._per_pixel)[visible.mask]
        return lines

    # --- ground ------------------------------------------------------------------------------------------------

    def _render_ground(self, first: int, last: int) -> tuple[Floats, Floats]:
        """Return the light of ground and background in some rows, and its opacity.

        The light is multiplied by the opacity.
        """
        shape = (last - first, self._width)
        light: Floats
        alpha: Floats
        if self._style.transparent:
            light, alpha = np.zeros((*shape, 3), np.float32), np.zeros(shape, np.float32)
        else:
            position = ((np.arange(first, last) + 0.5) / self._height)[:, None]
            colors = np.array(_BACKGROUND_TOP) + (np.array(_BACKGROUND_BOTTOM) - np.array(_BACKGROUND_TOP)) * position
            light = np.repeat((colors * colors)[:, None, :], self._width, axis=1).astype(np.float32)
            alpha = np.ones(shape, np.float32)
        if self._grid is not None:
            self._grid.draw(light, alpha, self._camera, first)
        if self._shadow is not None:
            points = compute_ground_points(self._camera, self._shadow.height, first, last)
            darkness = self._shadow.darkness_at(points).reshape(shape)
            light *= (1.0 - darkness)[:, :, None]
            alpha += (1.0 - alpha) * darkness
        return light, alpha


def _filter_samples(light: Floats, alpha: Floats, per_pixel: int) -> tuple[Floats, Floats]:
    """Return the light and opacity of pixels as weighted averages of samples.

    The averages of neighboring pixels overlap.

    Args:
        light: the light of samples multiplied by their opacity, shape (rows, columns, 3).
        alpha: the opacity of samples, shape (rows, columns).
        per_pixel: the samples per pixel along a row; `rows` and `columns` are multiples of it.
    """
    rows, columns = (length // per_pixel for length in alpha.shape)
    pixels = np.zeros((4, rows, columns), np.float32)
    window = find_window(alpha > 0.0, per_pixel)
    if window is not None:
        samples, covered = zip(*(_round_out(part, per_pixel) for part in window), strict=True)
        for pixel, plane in zip(pixels, (*np.moveaxis(light, 2, 0), alpha), strict=True):
            pixel[covered] = _filter_rows(_filter_rows(plane[samples].T, per_pixel).T, per_pixel)
    return np.ascontiguousarray(np.moveaxis(pixels[:3], 0, 2)), pixels[3]


def _round_out(samples: slice, per_pixel: int) -> tuple[slice, slice]:
    """Return the range of all samples of the pixels that have samples in a range, and the range of these pixels."""
    first, last = samples.start // per_pixel, -(-samples.stop // per_pixel)
    return slice(first * per_pixel, last * per_pixel), slice(first, last)


def _filter_rows(samples: Floats, per_pixel: int) -> Floats:
    """Return weighted averages along the first axis, one per pixel."""
    weights = _FILTERS[per_pixel]
    total = np.zeros_like(samples[::per_pixel])
    product = np.empty_like(total)
    for place, weight in enumerate(weights):
        factor = np.float32(weight / sum(weights))
        offset = place - 1
        if offset < 0:
            of_previous_pixels = samples[per_pixel + offset :: per_pixel][: len(total) - 1]
            total[1:] += np.multiply(of_previous_pixels, factor, out=product[1:])
            total[0] += samples[0] * factor
        elif offset < per_pixel:
            total += np.multiply(samples[offset::per_pixel], factor, out=product)
        else:
            total[:-1] += np.multiply(samples[offset::per_pixel], factor, out=product[:-1])
            total[-1] += samples[-1] * factor
    return total


def _quantize(light: Floats, alpha: Floats) -> Image:
    """Convert light multiplied by opacity to 8-bit pixels."""
    image = np.empty((*alpha.shape, 4), np.uint8)
    light = light / np.maximum(alpha, np.float32(1e-6))[:, :, None]
    image[:, :, :3] = np.rint(np.sqrt(np.clip(light, 0.0, 1.0)) * 255.0)
    image[:, :, 3] = np.rint(np.clip(alpha, 0.0, 1.0) * 255.0)
    return image
