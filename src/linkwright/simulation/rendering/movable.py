"""Movable geoms: which geoms are at rest, and which moving geoms are visible in an image."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.sdf.optics import Optics
from linkwright.simulation.library import load_mujoco
from linkwright.simulation.rendering.triangles import Mesh
from linkwright.simulation.simulation import Simulation

_THIN = 1e-6
"""A tolerance in m: a point on the surface of a box counts as inside."""
_REST = 200_000_000
"""Simulated nanoseconds without any motion after which a geom counts as resting."""
_FEW = 8
"""The number of moving geoms up to which it pays to find the pixels that may show them."""
_BLUR = 1e-4
"""Slopes, and m: above the rounding error of directions of 32 bits."""


@dataclass(frozen=True, slots=True)
class View:
    """The pose and the optics of a camera.

    Attributes:
        optics: the projection of the camera.
        origin: the position of the camera in m, shape (3,).
        axes: right, down and forwards, as columns.
        rays: the rays of the pixels, scaled to length 1 along the optical axis, shape (n, 3), float32.
    """

    optics: Optics
    origin: Array
    axes: Array
    rays: Any


class MovableGeoms:
    """Movable geoms, identified by their indices in MuJoCo's model.

    Args:
        simulation: the simulation of the world.
        meshes: the triangles of the geoms.

    Attributes:
        resting: the geoms that have not moved for a while.
    """

    def __init__(self, simulation: Simulation, meshes: dict[int, Mesh]) -> None:
        count = len(meshes)
        self.resting: list[int] = []
        self._simulation = simulation
        self._geoms = np.array(list(meshes), dtype=np.int64)
        self._corners = np.array([_corners(points) for points, _ in meshes.values()]).reshape(count, 8, 3)
        kinds = simulation.model.geom_type[self._geoms]
        self._is_box: Any = kinds == load_mujoco().mjtGeom.mjGEOM_BOX
        self._poses: Any = np.full((count, 12), np.nan)
        self._since: Any = np.zeros(count, dtype=np.int64)
        self._rests: Any = np.zeros(count, dtype=bool)
        self._hollow: Any = np.zeros(count, dtype=bool)

    def settle(self, origin: Array) -> bool:
        """Update `resting` for a camera; return whether `resting` has changed.

        A box that contains a camera is never resting: this camera does not see the box, but other cameras do.
        """
        data, now = self._simulation.data, self._simulation.time
        poses = np.concatenate([data.geom_xpos[self._geoms], data.geom_xmat[self._geoms]], axis=1)
        moved = (poses != self._poses).any(axis=1) | (self._since > now)  # or time has restarted
        self._poses = poses
        self._since[moved] = now
        self._hollow |= self._contain_point(origin)
        rests = (now - self._since >= _REST) & ~self._hollow
        if (rests == self._rests).all():
            return False
        self._rests = rests
        self.resting = self._geoms[rests].tolist()
        return True

    def in_view(self, view: View) -> dict[int, Array]:
        """Return the moving geoms in an image, except boxes that contain the camera.

        Returns:
            For each geom, the corners of its bounding box: to the right, down and ahead in m, shape (8, 3).
        """
        data, chosen = self._simulation.data, np.flatnonzero(~(self._rests | self._contain_point(view.origin)))
        geoms = self._geoms[chosen]
        turned = np.einsum("gij,gcj->gci", data.geom_xmat[geoms].reshape(-1, 3, 3), self._corners[chosen])
        placed = (turned + (data.geom_xpos[geoms] - view.origin)[:, None, :]) @ view.axes
        right, down, ahead = np.moveaxis(placed, 2, 0)
        outside, blur = (ahead < 0).all(axis=1), _BLUR * (1.0 + np.abs(ahead))
        for along, (least, greatest) in ((right, view.optics.columns), (down, view.optics.rows)):
            outside |= (along - least * ahead < -blur).all(axis=1) | (along - greatest * ahead > blur).all(axis=1)
        return {int(geoms[each]): placed[each] for each in np.flatnonzero(~outside)}

    def _contain_point(self, origin: Array) -> Any:
        """Return whether each geom is a box that contains a point, shape (geoms,)."""
        model, data, geoms = self._simulation.model, self._simulation.data, self._geoms
        inside = np.einsum("ijk,ij->ik", data.geom_xmat[geoms].reshape(-1, 3, 3), data.geom_xpos[geoms] - origin)
        return (np.abs(inside) < model.geom_size[geoms] + _THIN).all(axis=1) & self._is_box


def pixels_towards(optics: Optics, boxes: list[Array]) -> Any:
    """Return the indices of the pixels in which bounding boxes may appear; None for all pixels.

    All pixels are returned if there are many boxes, or if a box is too close to the camera.

    Args:
        optics: the projection of the camera.
        boxes: the corners of the boxes, as `MovableGeoms.in_view` returns them.
    """
    if len(boxes) > _FEW or any(corners[:, 2].min() <= optics.near for corners in boxes):
        return None
    across, down = optics.slopes
    chosen = np.zeros(len(across), dtype=bool)
    for corners in boxes:
        columns, rows = (corners[:, axis] / corners[:, 2] for axis in (0, 1))
        chosen |= (
            (across >= columns.min() - _BLUR) & (across <= columns.max() + _BLUR)
            & (down >= rows.min() - _BLUR) & (down <= rows.max() + _BLUR)
        )  # fmt: skip
    return np.flatnonzero(chosen)


def _corners(points: Array) -> Array:
    """Return the corners of the axis-aligned bounding box of points, shape (8, 3)."""
    ends = np.stack([points.min(axis=0), points.max(axis=0)])
    corners: Array = np.array([[ends[x, 0], ends[y, 1], ends[z, 2]] for x in (0, 1) for y in (0, 1) for z in (0, 1)])
    return corners
