"""Images of a scene from all sides, as the frames of an animation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.exact_angles import regular_polygon
from linkwright.geometry.single import Vector3, add_vectors, dot
from linkwright.picture.camera import Camera, View, compute_camera_axes, fit_camera
from linkwright.picture.rendering import Image, Style, render
from linkwright.picture.scene import Scene
from linkwright.process.processors import usable_processors

FRAMES_PER_SECOND = 12
_SIDES = 36
_SLICES = 64
_MAX_THREADS = 4


def render_turntable(
    scene: Scene, view: View, size: tuple[int, int], style: Style, count: int, report: Callable[[int], None]
) -> list[Image]:
    """Render the images of one full turn around a scene.

    Args:
        scene: the bodies.
        view: the view of the first image.
        size: the width and height in pixels.
        style: the parts of the images besides the bodies.
        count: the number of images.
        report: called with the number of finished images after each.
    """
    cameras = list(iterate_turning_cameras(view, size, scene.points, count))
    images = []
    with ThreadPoolExecutor(max_workers=min(usable_processors(), _MAX_THREADS)) as pool:
        scene.mesh  # noqa: B018 - computed once, before the threads need it
        try:
            for image in pool.map(lambda camera: render(scene, view, size, style, camera), cameras):
                images.append(image)
                report(len(images))
        except BaseException:  # After Ctrl-C, for example, do not wait for images that have not begun.
            pool.shutdown(wait=False, cancel_futures=True)
            raise
    return images


def iterate_turning_cameras(view: View, size: tuple[int, int], points: Array, count: int) -> Iterator[Camera]:
    """Yield cameras on a circle around points (n, 3), all at the same distance from the axis."""
    low, high = points.min(axis=0), points.max(axis=0)
    pivot: Vector3 = (float(low[0] + high[0]) / 2, float(low[1] + high[1]) / 2, float(low[2] + high[2]) / 2)
    first = fit_camera(view, size, [_sweep(points, pivot)])
    axes = (first.right, first.up, first.toward)
    offset = [middle - dot(pivot, axis) for middle, axis in zip(first.center, axes, strict=True)]
    for index in range(count):
        right, up, toward = compute_camera_axes(replace(view, azimuth=view.azimuth + 360.0 * index / count))
        center = add_vectors((dot(pivot, right), dot(pivot, up), dot(pivot, toward)), (offset[0], offset[1], offset[2]))
        yield replace(first, right=right, up=up, toward=toward, center=center)


def _sweep(points: Array, pivot: Vector3) -> Array:
    """Return points around the volume that points sweep when they turn about a vertical axis."""
    x, y, z = points[:, 0] - pivot[0], points[:, 1] - pivot[1], points[:, 2]
    radii = np.sqrt(x * x + y * y)
    low, high = float(z.min()), float(z.max())
    height = max(high - low, 1e-9)
    slices = np.minimum(((z - low) * (_SLICES / height)).astype(np.int64), _SLICES - 1)
    largest = np.full(_SLICES, -1.0)
    np.maximum.at(largest, slices, radii)
    rings = []
    for number in np.flatnonzero(largest >= 0).tolist():
        for edge in (low + height * number / _SLICES, low + height * (number + 1) / _SLICES):
            ring = [
                (pivot[0] + largest[number] * c, pivot[1] + largest[number] * s, edge)
                for c, s in regular_polygon(_SIDES)
            ]
            rings.append(np.array(ring))
    return np.concatenate(rings)
