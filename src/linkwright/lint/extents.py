"""The bounding boxes of shapes, and the mass properties of bodies."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import prod

from linkwright.geometry.shapes import (
    IDENTITY,
    MAX_COORDINATE,
    Bounds,
    Placement,
    placement,
    shape_bounds,
    shape_volume,
    union,
)
from linkwright.lint.meshes import MeshFacts
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import Collision, Inertial, Link, Mesh, Visual
from linkwright.urdf.bodies import WORLD, Bodies, Body

if TYPE_CHECKING:
    from linkwright.geometry.mass import MassProperties

MAX_MARKER_SIZE = 0.01
"""The size in m below which a body is a marker, so its shapes are not used."""

_NEGLIGIBLE_FRACTION = 0.01
"""The fraction of a body's mass below which the mass of one of its links is a negligible placeholder."""

MAX_PLACEHOLDER_MASS = 1e-5
"""The mass in kg below which a value is a placeholder, because simulators and exporters require a mass."""

_MAX_LINK_FRAMES = 200
"""The maximum number of links of a body that is measured for each link. A larger body is measured only once."""

_ORIGIN = Placement(IDENTITY, (0.0, 0.0, 0.0))


class Extents:
    """The sizes of the shapes of a description, each measured once."""

    def __init__(self, links: Sequence[Link], bodies: Bodies, meshes: MeshFacts) -> None:
        self._links = links
        self._bodies = bodies
        self._meshes = meshes
        self._shape_boxes: dict[int, Bounds | None] = {}
        self._body_boxes: dict[tuple[Body, str], Bounds | None] = {}

    @cached_property
    def links_with_relevant_mass(self) -> list[tuple[Link, Inertial]]:
        """The links with shapes and a non-negligible mass, each with its ``<inertial>``."""
        if not any(link.inertial for link in self._links):
            return []
        return [
            (link, inertial)
            for link in self._links
            if (inertial := link.inertial) is not None
            and (link.visuals or link.collisions)
            and (body := self._bodies.of(link.name)) is not None
            and inertial.is_computable
            and inertial.mass >= max(MAX_PLACEHOLDER_MASS, _NEGLIGIBLE_FRACTION * self._bodies.mass(body))
            and WORLD not in body.links
        ]

    @cached_property
    def measurable_links(self) -> list[tuple[Link, Inertial, Bounds]]:
        """The links whose body can rotate and be measured, with ``<inertial>`` and bounding box.

        The links are among `links_with_relevant_mass`. The box of the body is in the link's frame. Links are left out
        if their body cannot be measured, or if the body is so small that it is a marker.
        """
        rotating_links = (item for item in self.links_with_relevant_mass if self._bodies.turns(item[0].name))
        boxes = ((link, inertial, self.body_bounds(link)) for link, inertial in rotating_links)
        return [
            (link, inertial, box) for link, inertial, box in boxes if box is not None and box.diagonal > MAX_MARKER_SIZE
        ]

    def mass_properties(self, body: Body) -> MassProperties:
        """Return the combined mass properties of a body in the frame of its first link."""
        import numpy as np

        from linkwright.geometry.mass import MassProperties, combine

        link_properties = []
        for link, frame in zip(self._bodies.members(body), body.frames.values(), strict=True):
            inertial = link.inertial
            if inertial is not None and inertial.mass > 0 and inertial.is_computable:
                properties = inertial.properties
                rotation = np.array(frame.rotation)
                center = rotation @ properties.center + np.array(_clamp_position(frame).position)
                link_properties.append(
                    MassProperties(properties.mass, center, rotation @ properties.inertia @ rotation.T)
                )
        return combine(link_properties)

    def shape_bounds(self, shape: Visual | Collision) -> Bounds | None:
        """Return the box around a shape in its link's frame.

        The result is None if the shape's mesh cannot be read, or if the shape is too large or too far away.
        """
        key = id(shape)
        if key not in self._shape_boxes:
            self._shape_boxes[key] = self._measure(shape)
        return self._shape_boxes[key]

    def link_bounds(self, link: Link) -> Bounds | None:
        """Return the bounding box of a link's shapes in its frame, or None if it is unknown."""
        return self._union_of_bounds([*link.visuals, *link.collisions])

    def separate_bounds(self, link: Link) -> list[Bounds]:
        """Return the boxes around a link's collision shapes and around its visuals, if they exist.

        A stray vertex in a visual's mesh makes only one of the boxes too large.
        """
        shape_groups: tuple[Sequence[Visual | Collision], ...] = (link.collisions, link.visuals)
        boxes = [self._union_of_bounds(shapes) for shapes in shape_groups if shapes]
        return [box for box in boxes if box is not None]

    def _union_of_bounds(self, shapes: Sequence[Visual | Collision]) -> Bounds | None:
        boxes = [self.shape_bounds(shape) for shape in shapes]
        known_boxes = [bounds for bounds in boxes if bounds is not None]
        return union(known_boxes) if len(known_boxes) == len(boxes) else None

    def body_bounds(self, link: Link) -> Bounds | None:
        """Return the box around a link's body in the link's frame, or None if it is unknown.

        For a body of very many links, one box is computed in the frame of the body's first link. The result is then the
        box around this box, which may be larger than necessary.
        """
        body = self._bodies.of(link.name)
        if body is None or len(body.frames) == 1:
            return None if body is None else self.link_bounds(link)
        key = (body, link.name if len(body.frames) <= _MAX_LINK_FRAMES else body.links[0])
        if key not in self._body_boxes:
            self._body_boxes[key] = self._bounds_in_frame(body, _clamp_position(body.frames[key[1]]))
        box = self._body_boxes[key]
        if box is None or key[1] == link.name:
            return box
        return box.moved(_ORIGIN.seen_from(_clamp_position(body.frames[link.name])))

    def _bounds_in_frame(self, body: Body, frame: Placement) -> Bounds | None:
        """Return the box around a body in a frame that is given relative to the body's first link.

        The result is None if a shape cannot be measured.
        """
        boxes = []
        for member, member_frame in zip(self._bodies.members(body), body.frames.values(), strict=True):
            if not (member.visuals or member.collisions):
                continue
            bounds = self.link_bounds(member)
            if bounds is None:
                return None
            boxes.append(bounds.moved(_clamp_position(member_frame).seen_from(frame)))
        return union(boxes)

    def volume(self, link: Link) -> float | None:
        """Return the volume in m3 of a link's visuals or collision shapes, whichever is larger.

        The volume of a mesh is the volume of its bounding box. The result is None if a
        shape cannot be measured.
        """
        totals = []
        for shapes in (link.visuals, link.collisions):
            total = 0.0
            for shape in shapes:
                bounds = self.shape_bounds(shape)
                if bounds is None:
                    return None
                if isinstance(shape.geometry, Mesh):
                    total += prod(bounds.size)
                else:
                    total += shape_volume(shape.geometry)
            totals.append(total)
        return max(totals)

    def _measure(self, shape: Visual | Collision) -> Bounds | None:
        geometry = shape.geometry
        if max(map(abs, shape.origin.xyz)) > MAX_COORDINATE:
            return None
        if isinstance(geometry, Mesh):
            mesh = self._meshes.load_outline(shape)
            if mesh is None:
                return None
            box = mesh.bounds
        else:
            box = shape_bounds(geometry)
            if max(box.high) > MAX_COORDINATE:
                return None
        return box.moved(placement(shape.origin))


def _clamp_position(frame: Placement) -> Placement:
    """Return a placement with each coordinate clamped to `MAX_COORDINATE`, to avoid overflow."""
    x, y, z = (min(max(coordinate, -MAX_COORDINATE), MAX_COORDINATE) for coordinate in frame.position)
    return Placement(frame.rotation, (x, y, z))
