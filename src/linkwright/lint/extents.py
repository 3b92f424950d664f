"""The space that shapes take, and the mass properties of bodies."""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import Array, matrix_from_pose, row_from_pose
from linkwright.geometry.bounds import Bounds, union
from linkwright.geometry.mass import FARTHEST, MassProperties, combine
from linkwright.geometry.placement import Placement
from linkwright.geometry.solids import half_extents, shape_properties
from linkwright.inertia.inertial import from_inertial, is_computable
from linkwright.lint.meshes import MeshFacts
from linkwright.urdf import Collision, Link, Mesh, Visual
from linkwright.urdf.bodies import Bodies, Body

_MANY = 200
"""Links of a body from which on it is not measured anew for each of them."""


class Extents:
    """How large the shapes of a description are, each measured once."""

    def __init__(self, bodies: Bodies, meshes: MeshFacts) -> None:
        self._bodies = bodies
        self._meshes = meshes
        self._measured: dict[int, Bounds | None] = {}
        self._of_bodies: dict[Body, Bounds | None] = {}

    def mass_properties(self, body: Body) -> MassProperties:
        """What the ``<inertial>`` of a body's links come to, in the frame of its first link."""
        parts = []
        for link, frame in zip(self._bodies.members(body), body.frames.values(), strict=True):
            inertial, matrix = link.inertial, frame_matrix(frame)
            if inertial is not None and inertial.mass > 0 and is_computable(inertial):
                own = from_inertial(inertial)
                rotation = matrix[:3, :3]
                center = rotation @ own.center + matrix[:3, 3]
                parts.append(MassProperties(own.mass, center, rotation @ own.inertia @ rotation.T))
        return combine(parts)

    def shape_bounds(self, shape: Visual | Collision) -> Bounds | None:
        """The box around a shape in its link's frame; None where its mesh cannot be read."""
        key = id(shape)
        if key not in self._measured:
            self._measured[key] = self._measure(shape)
        return self._measured[key]

    def link_bounds(self, link: Link) -> Bounds | None:
        """The box around all shapes of a link in its frame; None without shapes, or when one cannot be measured."""
        shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
        found = [self.shape_bounds(shape) for shape in shapes]
        known = [bounds for bounds in found if bounds is not None]
        return union(known) if len(known) == len(found) else None

    def body_bounds(self, link: Link) -> Bounds | None:
        """The box around the whole body of a link in that link's frame; None when a shape cannot be measured.

        Of a body of very many links the box is put around all of them once, and the one in a link's frame around that.
        """
        body = self._bodies.of(link.name)
        if body is None:
            return None
        back = np.asarray(np.linalg.inv(frame_matrix(body.frames[link.name])), dtype=np.float64)
        if len(body.frames) <= _MANY:
            return self._bounds_from(body, back)
        if body not in self._of_bodies:
            self._of_bodies[body] = self._bounds_from(body, np.eye(4))
        around = self._of_bodies[body]
        return None if around is None else around.moved(back)

    def _bounds_from(self, body: Body, back: Array) -> Bounds | None:
        """The box around a body, along the axes that a matrix turns those of its first link to."""
        boxes = []
        for member, frame in zip(self._bodies.members(body), body.frames.values(), strict=True):
            if not (member.visuals or member.collisions):
                continue
            bounds = self.link_bounds(member)
            if bounds is None:
                return None
            boxes.append(bounds.moved(back @ frame_matrix(frame)))
        return union(boxes)

    def volume(self, link: Link) -> float | None:
        """Volume of the box around each shape of a link, in m3, summed for the larger of its shape kinds.

        Simple shapes count with their own volume. None when a mesh cannot be measured.
        """
        totals = []
        for shapes in (link.visuals, link.collisions):
            total = 0.0
            for shape in shapes:
                bounds = self.shape_bounds(shape)
                if bounds is None:
                    return None
                if isinstance(shape.geometry, Mesh):
                    total += float(np.prod(bounds.size))
                else:
                    total += shape_properties(shape.geometry).mass
            totals.append(total)
        return max(totals)

    def _measure(self, shape: Visual | Collision) -> Bounds | None:
        geometry = shape.geometry
        if max(map(abs, shape.origin.xyz)) > FARTHEST:
            return None
        if isinstance(geometry, Mesh):
            mesh = self._meshes.triangles(shape)
            if mesh is None:
                return None
            low, high = mesh.bounds
            box = Bounds(low, high)
        else:
            half = half_extents(geometry)
            if half.max() > FARTHEST:
                return None
            box = Bounds(-half, half)
        return box.moved(matrix_from_pose(row_from_pose(shape.origin)))


def frame_matrix(frame: Placement) -> Array:
    """A frame as a homogeneous matrix, shape (4, 4); places beyond all bounds are moved to their edge."""
    matrix = np.eye(4)
    matrix[:3, :3] = frame.rotation
    matrix[:3, 3] = np.clip(frame.position, -FARTHEST, FARTHEST)
    return matrix
