"""Links that fixed joints make one rigid body, and the space that their shapes take.

Simulators merge such links, so what a link lacks another of its body may have, and mass lies anywhere in the body.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from linkwright.inertia import MassProperties, combine, from_inertial, shape_properties
from linkwright.inertia.properties import Array, pose_rotation
from linkwright.inertia.shapes import half_extents
from linkwright.urdf import Collision, Joint, Link, Mesh, Pose, Visual

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


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """Links that move as one.

    Attributes:
        joint: the joint that moves it; None for the body of the robot's root.
        frames: link -> its frame in the frame of the body's first link, homogeneous matrices of shape (4, 4).
    """

    joint: Joint | None
    frames: dict[str, Array]

    @property
    def links(self) -> tuple[str, ...]:
        """The names of its links, the one that the joint moves first."""
        return tuple(self.frames)


class Bodies:
    """The bodies of a description and what their shapes tell; empty when there is no robot."""

    def __init__(self, subject: Subject) -> None:
        self._subject = subject
        self._extents: dict[int, Bounds | None] = {}

    @cached_property
    def all(self) -> tuple[Body, ...]:
        """The bodies, that of the root first."""
        return tuple(dict.fromkeys(self._by_link.values()))

    def of(self, link: str) -> Body | None:
        """The body of a link."""
        return self._by_link.get(link)

    def link(self, name: str) -> Link:
        """A link by its name."""
        robot = self._subject.robot
        assert robot is not None, "there are bodies only where there is a robot"
        return robot.links[name]

    def members(self, body: Body) -> list[Link]:
        """The links of a body."""
        return [self.link(name) for name in body.links]

    def mass(self, body: Body) -> float:
        """The positive masses of a body's links together, in kg."""
        inertials = [link.inertial for link in self.members(body)]
        return sum(inertial.mass for inertial in inertials if inertial is not None and inertial.mass > 0)

    def mass_properties(self, body: Body) -> MassProperties:
        """What the ``<inertial>`` of a body's links come to, in the frame of its first link."""
        parts = []
        for name, matrix in body.frames.items():
            inertial = self.link(name).inertial
            if inertial is not None and inertial.mass > 0:
                own = from_inertial(inertial)
                rotation = matrix[:3, :3]
                center = rotation @ own.center + matrix[:3, 3]
                parts.append(MassProperties(own.mass, center, rotation @ own.inertia @ rotation.T))
        return combine(parts)

    def shape_bounds(self, shape: Visual | Collision) -> Bounds | None:
        """The box around a shape in its link's frame; None where its mesh cannot be read."""
        key = id(shape)
        if key not in self._extents:
            self._extents[key] = self._measure(shape)
        return self._extents[key]

    def link_bounds(self, link: Link) -> Bounds | None:
        """The box around all shapes of a link in its frame; None without shapes, or when one cannot be measured."""
        shapes: list[Visual | Collision] = [*link.visuals, *link.collisions]
        found = [self.shape_bounds(shape) for shape in shapes]
        known = [bounds for bounds in found if bounds is not None]
        return union(known) if len(known) == len(found) else None

    def body_bounds(self, link: Link) -> Bounds | None:
        """The box around the whole body of a link in that link's frame; None when a shape cannot be measured."""
        body = self.of(link.name)
        if body is None:
            return None
        back = np.linalg.inv(body.frames[link.name])
        boxes = []
        for name, matrix in body.frames.items():
            member = self.link(name)
            if not (member.visuals or member.collisions):
                continue
            bounds = self.link_bounds(member)
            if bounds is None:
                return None
            boxes.append(bounds.moved(back @ matrix))
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

    @cached_property
    def _by_link(self) -> dict[str, Body]:
        robot = self._subject.robot
        if robot is None:
            return {}
        below: dict[str, list[Joint]] = {}
        for joint in robot.joints.values():
            below.setdefault(joint.parent, []).append(joint)
        bodies: dict[str, Body] = {robot.root: Body(None, {robot.root: np.eye(4)})}
        waiting = [robot.root]
        while waiting:
            name = waiting.pop(0)
            body = bodies[name]
            for joint in below.get(name, ()):
                if joint.child in bodies or joint.child not in robot.links:
                    continue
                if joint.type == "fixed":
                    body.frames[joint.child] = body.frames[name] @ pose_matrix(joint.origin)
                    bodies[joint.child] = body
                else:
                    bodies[joint.child] = Body(joint, {joint.child: np.eye(4)})
                waiting.append(joint.child)
        return bodies

    def _measure(self, shape: Visual | Collision) -> Bounds | None:
        geometry = shape.geometry
        if isinstance(geometry, Mesh):
            mesh = self._subject.meshes.triangles(shape)
            if mesh is None:
                return None
            low, high = mesh.bounds
            box = Bounds(low, high)
        else:
            half = half_extents(geometry)
            box = Bounds(-half, half)
        return box.moved(pose_matrix(shape.origin))


def pose_matrix(pose: Pose) -> Array:
    """A pose as a homogeneous matrix, shape (4, 4)."""
    matrix = np.eye(4)
    matrix[:3, :3] = pose_rotation(pose)
    matrix[:3, 3] = pose.xyz
    return matrix
