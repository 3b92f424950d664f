"""The space that shapes take, and the mass properties of bodies."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from linkwright.inertia import MassProperties, combine, from_inertial, shape_properties
from linkwright.inertia.properties import FARTHEST, Array, is_computable, pose_rotation
from linkwright.inertia.shapes import half_extents
from linkwright.lint.bodies import Body
from linkwright.lint.frames import Placement
from linkwright.urdf import Collision, Link, Mesh, Pose, Visual

if TYPE_CHECKING:
    from linkwright.lint.subject import Subject


@dataclass(frozen=True, slots=True, eq=False)
class Bounds:
    """A box along the axes of some frame: its lowest and highest corner in m, each of shape (3,)."""

    low: Array
    high: Array

    @property
    def size(self) -> Array:
        """The edges in m; shape (3,)."""
        edges: Array = self.high - self.low
        return edges

    @property
    def center(self) -> Array:
        """The middle in m; shape (3,)."""
        middle: Array = (self.low + self.high) / 2.0
        return middle

    @property
    def diagonal(self) -> float:
        """The distance of opposite corners in m."""
        return float(np.linalg.norm(self.size))

    def gap(self, other: Bounds) -> float:
        """How far two boxes are apart, in m; 0 where they touch."""
        apart = np.maximum(0.0, np.maximum(self.low - other.high, other.low - self.high))
        return float(np.linalg.norm(apart))

    def moved(self, matrix: Array) -> Bounds:
        """The box around this one in a parent frame; `matrix` is the frame in it, homogeneous, shape (4, 4)."""
        corners = np.array(list(product(*zip(self.low, self.high, strict=True))))
        return around(corners @ matrix[:3, :3].T + matrix[:3, 3])


def around(points: Array) -> Bounds:
    """The box around points; shape (points, 3)."""
    return Bounds(points.min(axis=0), points.max(axis=0))


def union(boxes: Iterable[Bounds]) -> Bounds | None:
    """The box around several; None without any."""
    listed = list(boxes)
    return around(np.array([corner for box in listed for corner in (box.low, box.high)])) if listed else None


class Extents:
    """How large the shapes of a description are, each measured once."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._measured: dict[int, Bounds | None] = {}

    def mass_properties(self, body: Body) -> MassProperties:
        """What the ``<inertial>`` of a body's links come to, in the frame of its first link."""
        parts = []
        for link, frame in zip(self._subject.bodies.members(body), body.frames.values(), strict=True):
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
        """The box around the whole body of a link in that link's frame; None when a shape cannot be measured."""
        body = self._subject.bodies.of(link.name)
        if body is None:
            return None
        back = np.linalg.inv(frame_matrix(body.frames[link.name]))
        boxes = []
        for member, frame in zip(self._subject.bodies.members(body), body.frames.values(), strict=True):
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
            mesh = self._subject.meshes.triangles(shape)
            if mesh is None:
                return None
            low, high = mesh.bounds
            box = Bounds(low, high)
        else:
            half = half_extents(geometry)
            if half.max() > FARTHEST:
                return None
            box = Bounds(-half, half)
        return box.moved(pose_matrix(shape.origin))


def pose_matrix(pose: Pose) -> Array:
    """A pose as a homogeneous matrix, shape (4, 4); places beyond all bounds are moved to their edge."""
    matrix = np.eye(4)
    matrix[:3, :3] = pose_rotation(pose)
    matrix[:3, 3] = np.clip(pose.xyz, -FARTHEST, FARTHEST)
    return matrix


def frame_matrix(frame: Placement) -> Array:
    """A frame as a homogeneous matrix, shape (4, 4); places beyond all bounds are moved to their edge."""
    matrix = np.eye(4)
    matrix[:3, :3] = frame.rotation
    matrix[:3, 3] = np.clip(frame.position, -FARTHEST, FARTHEST)
    return matrix
