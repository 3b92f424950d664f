"""The surfaces of links, to tell whether the meshes themselves collide and not only their convex hulls."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry import surfaces
from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.inertia.mesh_library import MeshLibrary
from linkwright.planning.robot_model import RobotModel
from linkwright.urdf import Collision, Mesh, Robot

_CHUNK = 1 << 22
"""The maximum number of pairs of triangles that are compared at once."""


class LinkSurfaces:
    """The triangles of the collision shapes of links.

    Args:
        robot: the robot.
        meshes: its meshes, which have been read without errors.
    """

    def __init__(self, robot: Robot, meshes: MeshLibrary) -> None:
        self._robot = robot
        self._meshes = meshes
        self._triangles: dict[str, Array] = {}

    def touch(self, first: str, second: str, model: RobotModel) -> bool:
        """Return whether the surfaces of two links intersect in the current positions of a model."""
        return do_triangles_intersect(self._placed(first, model), self._placed(second, model))

    def _placed(self, link: str, model: RobotModel) -> Array:
        """Return the triangles of a link in the frame of the root link, shape (triangles, 3, 3)."""
        triangles = self._triangles.get(link)
        if triangles is None:
            parts = [self._convert(collision) for collision in self._robot.links[link].collisions]
            triangles = self._triangles[link] = np.concatenate(parts) if parts else np.zeros((0, 3, 3))
        body = model.body(link)
        rotation = model.data.xmat[body].reshape(3, 3)
        return np.asarray(triangles @ rotation.T + model.data.xpos[body])

    def _convert(self, collision: Collision) -> Array:
        """Return the triangles of a collision in the frame of its link, shape (triangles, 3, 3)."""
        shape = collision.geometry
        if isinstance(shape, Mesh):
            mesh = self._meshes.load(shape, collision.element)
            triangles = mesh.vertices[mesh.faces]
        else:
            if isinstance(shape, Box):
                surface = surfaces.box(shape.size)
            elif isinstance(shape, Sphere):
                surface = surfaces.sphere(shape.radius)
            elif isinstance(shape, Capsule):
                surface = surfaces.capsule(shape.radius, shape.length)
            else:
                assert isinstance(shape, Cylinder)
                surface = surfaces.cylinder(shape.radius, shape.length)
            triangles = surface.positions[surface.indices.reshape(-1, 3)]
        matrix = matrix_from_pose(row_from_pose(collision.origin))
        return np.asarray(triangles @ matrix[:3, :3].T + matrix[:3, 3])


def do_triangles_intersect(first: Array, second: Array) -> bool:
    """Return whether two sets of triangles intersect.

    Triangles that only touch, or are in one plane, do not intersect.

    Args:
        first: the corners of triangles, shape (triangles, 3, 3).
        second: the corners of other triangles, shape (triangles, 3, 3).
    """
    for _ in range(2):
        if not (len(first) and len(second)):
            return False
        first, second = _select_near(first, second), _select_near(second, first)
    return any(
        bool(np.any(_do_edges_pierce(first[ones], second[others]) | _do_edges_pierce(second[others], first[ones])))
        for ones, others in _near_pairs(first, second)
    )


def _select_near(triangles: Array, others: Array) -> Array:
    """Return the triangles whose bounding boxes overlap the bounding box of all other triangles."""
    lower, upper = others.min(axis=(0, 1)), others.max(axis=(0, 1))
    is_near = np.all((triangles.max(axis=1) >= lower) & (triangles.min(axis=1) <= upper), axis=1)
    return np.asarray(triangles[is_near])


def _near_pairs(first: Array, second: Array) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Yield the indexes of triangles whose bounding boxes overlap, chunk by chunk."""
    if not (len(first) and len(second)):
        return
    lower, upper = second.min(axis=1), second.max(axis=1)
    rows = max(1, _CHUNK // len(second))
    for start in range(0, len(first), rows):
        part = first[start : start + rows]
        part_lower, part_upper = part.min(axis=1), part.max(axis=1)
        overlaps = np.ones((len(part), len(second)), dtype=bool)
        for axis in range(3):
            overlaps &= part_upper[:, axis, np.newaxis] >= lower[:, axis]
            overlaps &= part_lower[:, axis, np.newaxis] <= upper[:, axis]
        ones, others = np.nonzero(overlaps)
        for offset in range(0, len(ones), _CHUNK // 16):
            chosen = slice(offset, offset + _CHUNK // 16)
            yield ones[chosen] + start, others[chosen]


def _do_edges_pierce(edged: Array, pierced: Array) -> NDArray[np.bool_]:
    """Return for each pair whether an edge of the first triangle crosses the second one (Möller and Trumbore)."""
    corner, side, other_side = pierced[:, 0], pierced[:, 1] - pierced[:, 0], pierced[:, 2] - pierced[:, 0]
    crosses = np.zeros(len(edged), dtype=bool)
    for index in range(3):
        start = edged[:, index]
        direction = edged[:, (index + 1) % 3] - start
        normal = np.cross(direction, other_side)
        determinant = np.einsum("ij,ij->i", side, normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            offset = start - corner
            u = np.einsum("ij,ij->i", offset, normal) / determinant
            perpendicular = np.cross(offset, side)
            v = np.einsum("ij,ij->i", direction, perpendicular) / determinant
            t = np.einsum("ij,ij->i", other_side, perpendicular) / determinant
            crosses |= (u > 0.0) & (v > 0.0) & (u + v < 1.0) & (t > 0.0) & (t < 1.0)
    return crosses
