"""Movable geoms: detection of geoms at rest, and of moving geoms in an image."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.optics import Optics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.triangles import Mesh
from linkwright.simulation.simulation import Simulation

_SURFACE_TOLERANCE = 1e-6
"""The tolerance in m with which a point on the surface of a box counts as inside."""
_REST_NS = 200_000_000
"""The simulated time in ns without motion after which a geom counts as resting."""
_MAX_BOXES = 8
"""The maximum number of moving geoms for which it is faster to search for the pixels that may show them."""
_ROUNDING_MARGIN = 1e-4
"""A margin for slopes and for lengths in m, which is greater than the rounding error of float32 directions."""


@dataclass(frozen=True, slots=True)
class CameraView:
    """The pose and the optics of a camera.

    Attributes:
        optics: the projection of the camera.
        origin: the position of the camera in m, shape (3,).
        axes: the image axes in the world as columns: right, down, forwards; shape (3, 3).
        rays: the rays of the pixels, scaled to length 1 along the optical axis, shape (n, 3), float32.
    """

    optics: Optics
    origin: Array
    axes: Array
    rays: Any


class MovableGeoms:
    """The movable geoms of a simulation, identified by their indices in MuJoCo's model.

    Args:
        simulation: the simulation of the world.
        meshes: the triangles of the geoms, by geom index.

    Attributes:
        resting: the indices of the geoms that have not moved for 0.2 simulated seconds.
    """

    def __init__(self, simulation: Simulation, meshes: dict[int, Mesh]) -> None:
        count = len(meshes)
        self.resting: list[int] = []
        self._simulation = simulation
        self._geoms = np.array(list(meshes), dtype=np.int64)
        self._corners = np.array([_compute_box_corners(points) for points, _ in meshes.values()]).reshape(count, 8, 3)
        geom_types = simulation.model.geom_type[self._geoms]
        self._is_box: Any = geom_types == load_mujoco().mjtGeom.mjGEOM_BOX
        self._poses: Any = np.full((count, 12), np.nan)
        self._last_motion: Any = np.zeros(count, dtype=np.int64)
        self._is_resting: Any = np.zeros(count, dtype=bool)
        self._has_contained_camera: Any = np.zeros(count, dtype=bool)

    def update_resting(self, origin: Array) -> bool:
        """Update `resting`, and return whether it has changed.

        Call this before each image is rendered, with the camera's position.

        A box that contained a camera never rests, because it is invisible to that camera but not to others.
        """
        data, now = self._simulation.data, self._simulation.time
        poses = np.concatenate([data.geom_xpos[self._geoms], data.geom_xmat[self._geoms]], axis=1)
        has_moved = (poses != self._poses).any(axis=1) | (self._last_motion > now)  # or the time was reset
        self._poses = poses
        self._last_motion[has_moved] = now
        self._has_contained_camera |= self._find_boxes_around(origin)
        is_resting = (now - self._last_motion >= _REST_NS) & ~self._has_contained_camera
        if (is_resting == self._is_resting).all():
            return False
        self._is_resting = is_resting
        self.resting = self._geoms[is_resting].tolist()
        return True

    def find_visible_geoms(self, view: CameraView) -> dict[int, Array]:
        """Return the moving geoms that may appear in an image.

        Boxes that contain the camera are left out.

        Returns:
            By geom index, the corners of the geom's bounding box in the axes of the image in m, shape (8, 3).
        """
        data, candidates = (
            self._simulation.data,
            np.flatnonzero(~(self._is_resting | self._find_boxes_around(view.origin))),
        )
        geoms = self._geoms[candidates]
        rotated = np.einsum("gij,gcj->gci", data.geom_xmat[geoms].reshape(-1, 3, 3), self._corners[candidates])
        view_corners = (rotated + (data.geom_xpos[geoms] - view.origin)[:, None, :]) @ view.axes
        right, down, ahead = np.moveaxis(view_corners, 2, 0)
        is_outside, margin = (ahead < 0).all(axis=1), _ROUNDING_MARGIN * (1.0 + np.abs(ahead))
        for coordinates, (min_slope, max_slope) in ((right, view.optics.columns), (down, view.optics.rows)):
            is_outside |= (coordinates - min_slope * ahead < -margin).all(axis=1) | (
                coordinates - max_slope * ahead > margin
            ).all(axis=1)
        return {int(geoms[index]): view_corners[index] for index in np.flatnonzero(~is_outside)}

    def _find_boxes_around(self, origin: Array) -> Any:
        """Return whether each geom is a box that contains a point, shape (geoms,)."""
        model, data, geoms = self._simulation.model, self._simulation.data, self._geoms
        local_points = np.einsum("ijk,ij->ik", data.geom_xmat[geoms].reshape(-1, 3, 3), data.geom_xpos[geoms] - origin)
        return (np.abs(local_points) < model.geom_size[geoms] + _SURFACE_TOLERANCE).all(axis=1) & self._is_box


def find_covered_pixels(optics: Optics, boxes: list[Array]) -> Any:
    """Return the indices of the pixels in which bounding boxes may appear, or None for all.

    The result is None if there are many boxes, or if a box is too close to the camera.

    Args:
        optics: the projection of the camera.
        boxes: the corners of each box, as `MovableGeoms.visible_geoms` returns them.
    """
    if len(boxes) > _MAX_BOXES or any(corners[:, 2].min() <= optics.near for corners in boxes):
        return None
    across, down = optics.slopes
    is_covered = np.zeros(len(across), dtype=bool)
    for corners in boxes:
        columns, rows = (corners[:, axis] / corners[:, 2] for axis in (0, 1))
        is_covered |= (
            (across >= columns.min() - _ROUNDING_MARGIN) & (across <= columns.max() + _ROUNDING_MARGIN)
            & (down >= rows.min() - _ROUNDING_MARGIN) & (down <= rows.max() + _ROUNDING_MARGIN)
        )  # fmt: skip
    return np.flatnonzero(is_covered)


def _compute_box_corners(points: Array) -> Array:
    """Return the corners of the axis-aligned bounding box of points, shape (8, 3)."""
    bounds = np.stack([points.min(axis=0), points.max(axis=0)])
    corners: Array = np.array(
        [[bounds[x, 0], bounds[y, 1], bounds[z, 2]] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    )
    return corners
