"""Rules that compare the collision shapes of a link with its visuals."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

from linkwright.diagnostics import Diagnostic, Note, Phrase, Severity, Span, phrase
from linkwright.lint.extents import MAX_MARKER_SIZE
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.geometry import is_scenery
from linkwright.lint.rules.meshes import MeshInMillimeters
from linkwright.lint.subject import Subject
from linkwright.lint.walk import SURROUNDING_FRAMES
from linkwright.loading.lean_typing import TYPE_CHECKING
from linkwright.urdf import Collision, Link, Mesh, Visual
from linkwright.xmltree import Element

if TYPE_CHECKING:
    from linkwright.geometry.shapes import Bounds
    from linkwright.urdf.bodies import Bodies, Body


_MAX_GAP = 20.0
"""The maximum gap in m. LW405 reports shapes that are farther away."""


class MissingCollision(Rule):
    """A moving part that is visible but has no collision shape, unlike the other parts.

    ## Why

    In planners and simulators, everything passes through such a part. Links that fixed joints connect count as one
    part, so a camera on an arm does not need its own collision shape. The rule only applies if at least half of the
    moving parts have a collision shape. A part between two parts with collision shapes is not reported: the hip of a
    leg often has none, because it is always close to its neighbors.

    ## Example

    ```xml
    <link name="left_wheel">
      <visual>...</visual>
    </link>
    ```

    ## Use instead

    ```xml
    <link name="left_wheel">
      <visual>...</visual>
      <collision>
        <geometry><cylinder radius="0.06" length="0.025"/></geometry>
      </collision>
    </link>
    ```
    """

    code = "LW410"
    name = "collision-missing"
    severity = Severity.INFO

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        bodies = subject.bodies
        movable_bodies = [body for body in bodies.all if SURROUNDING_FRAMES.isdisjoint(body.links)]
        visible_bodies = [body for body in movable_bodies if any(link.visuals for link in bodies.members(body))]
        bodies_without_collision = [
            body for body in visible_bodies if not any(_has_collision(link.element) for link in bodies.members(body))
        ]
        if 2 * len(bodies_without_collision) > len(visible_bodies):
            return
        for body in bodies_without_collision:
            if body.joint is not None and _is_between(body, bodies, bodies_without_collision):
                continue
            link = next(link for link in bodies.members(body) if link.visuals)
            yield self.report(
                phrase("link '{name}' is visible but has no collision shape, unlike other links", name=link.name),
                link.element,
                "name",
                hint=phrase("add a <collision>, preferably with a simple shape around the visuals"),
            )


def _is_between(body: Body, bodies: Bodies, bodies_without_collision: list[Body]) -> bool:
    """Return whether a body's parent and one of its children have collision shapes."""
    parent = bodies.of(body.joint.parent) if body.joint is not None else None
    children = [other for other in bodies.all if other.joint is not None and other.joint.parent in body.links]
    return parent not in (None, *bodies_without_collision) and any(
        body not in bodies_without_collision for body in children
    )


class MissingVisual(Rule):
    """A link with a collision shape but no visual.

    ## Why

    A robot that hits objects with parts that RViz does not show is hard to understand. Safety zones have no visual on
    purpose. On other links, the visual was probably forgotten.

    ## Example

    ```xml
    <link name="bumper">
      <collision>...</collision>
    </link>
    ```

    ## Use instead

    Add a `<visual>` with the same geometry.
    """

    code = "LW411"
    name = "visual-missing"
    default = False

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link in subject.links:
            if link.collisions and not link.visuals and link.element and link.element.first("visual") is None:
                yield self.report(
                    phrase("link '{name}' has a collision shape and no visual", name=link.name),
                    link.element,
                    "name",
                    hint=phrase("add a <visual> with the same geometry, if it should be visible"),
                )


class CollisionAwayFromVisual(Rule):
    """Collision shapes that do not touch the box around the visuals.

    ## Why

    The robot then collides at a different position than where it is shown. Usually, only the visual or only the
    collision has the `<origin>`. A collision shape within the visuals of a child link is not reported: it represents a
    motor that is drawn there, as in the hips of many quadrupeds.

    ## Example

    ```xml
    <visual>
      <origin xyz="0 0 0.5"/>
      <geometry><box size="0.2 0.2 0.2"/></geometry>
    </visual>
    <collision>
      <geometry><box size="0.2 0.2 0.2"/></geometry>
    </collision>
    ```

    ## Use instead

    Write the same `<origin>` in the visual and the collision.
    """

    code = "LW412"
    name = "collision-apart"

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        for link, visual_box, collision_box in _iterate_comparable_links(subject):
            gap = visual_box.gap(collision_box)
            is_apart = _MAX_GAP > gap > max(0.25 * min(visual_box.diagonal, collision_box.diagonal), 1e-3)
            if is_apart and not _is_moved_to_a_child(subject, link, collision_box):
                yield self.report(
                    phrase(
                        "the collision shapes of link '{name}' are {gap:.3g} cm away from its visuals",
                        name=link.name,
                        gap=gap * 100,
                    ),
                    link.collisions[0].element,
                    notes=[Note(phrase("the first visual is here"), _find_span(link.visuals[0]))],
                    hint=_make_origin_hint(link, visual_box),
                )


def _make_origin_hint(link: Link, visual_box: Bounds) -> Phrase:
    """Return a hint for fixing a collision shape that is far from its visual.

    If both have the same ``<origin>``, the hint is about a mesh that is far from its own origin.
    """
    if link.visuals[0].origin.xyz != link.collisions[0].origin.xyz:
        return phrase("give visuals and collisions the same <origin>")
    center = " ".join(f"{coordinate:.3g}" for coordinate in visual_box.center)
    return phrase("the center of the visuals is at {center} in the link frame", center=center)


class CollisionSize(Rule):
    """Collision shapes many times larger or smaller than the visuals.

    ## Why

    The visual or the collision lacks a `scale`, or a digit of a size is missing. The robot stops meters before a wall,
    or runs half into it.

    ## Example

    ```xml
    <visual>
      <geometry><mesh filename="package://arm/meshes/base.stl" scale="0.001 0.001 0.001"/></geometry>
    </visual>
    <collision>
      <geometry><mesh filename="package://arm/meshes/base.stl"/></geometry>
    </collision>
    ```

    ## Use instead

    Write the same `scale` in the visual and the collision.
    """

    code = "LW413"
    name = "collision-size-differs"
    options = (Option("factor", 10.0, "the smallest factor between the sizes that is reported"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        factor = self.option(subject, "factor", float)
        for link, visual_box, collision_box in _iterate_comparable_links(subject):
            ratio = collision_box.diagonal / visual_box.diagonal
            if not 1 / factor <= ratio <= factor:
                yield self.report(
                    phrase(
                        "the collision shapes of link '{name}' are {times:.3g} times larger than its visuals",
                        name=link.name,
                        times=ratio,
                    )
                    if ratio > 1
                    else phrase(
                        "the collision shapes of link '{name}' are {times:.3g} times smaller than its visuals",
                        name=link.name,
                        times=1 / ratio,
                    ),
                    link.collisions[0].element,
                    notes=[Note(phrase("the first visual is here"), _find_span(link.visuals[0]))],
                    hint=phrase("check the sizes, and the 'scale' of meshes"),
                )


def _is_moved_to_a_child(subject: Subject, link: Link, collision_box: Bounds) -> bool:
    """Return whether a link's collision shapes were moved to the visuals of a child link."""
    if not all(any(shape.origin.xyz) for shape in link.collisions) or link.name not in subject.frames:
        return False
    child_names = {joint.child for joint in subject.joints if joint.parent == link.name}
    for child in (link for link in subject.links if link.name in child_names):
        visual_box = _compute_bounds(subject, child.visuals) if child.visuals else None
        if visual_box is not None:
            box_in_parent = visual_box.moved(subject.frames[child.name].seen_from(subject.frames[link.name]))
            if box_in_parent.gap(collision_box) == 0:
                return True
    return False


def _iterate_links_with_both_shapes(subject: Subject) -> Iterator[Link]:
    """Yield the links that have both visuals and collisions."""
    return (link for link in subject.links if link.visuals and link.collisions)


def _iterate_comparable_links(subject: Subject) -> Iterator[tuple[Link, Bounds, Bounds]]:
    """Yield each link with comparable shapes, and the boxes of its visuals and collisions.

    Links with tiny or unreadable shapes, or with meshes that are probably in millimeters, are left out.
    """
    largest = math.inf if is_scenery(subject) else MeshInMillimeters().option(subject, "largest", float)
    for link in _iterate_links_with_both_shapes(subject):
        visual_box, collision_box = _compute_bounds(subject, link.visuals), _compute_bounds(subject, link.collisions)
        if (
            visual_box is None
            or collision_box is None
            or min(visual_box.diagonal, collision_box.diagonal) < MAX_MARKER_SIZE
        ):
            continue
        shapes: tuple[Visual | Collision, ...] = (*link.visuals, *link.collisions)
        meshes = [shape for shape in shapes if isinstance(shape.geometry, Mesh)]
        mesh_boxes = [bounds for bounds in map(subject.extents.shape_bounds, meshes) if bounds is not None]
        if all(max(bounds.size) <= largest for bounds in mesh_boxes):
            yield link, visual_box, collision_box


def _compute_bounds(subject: Subject, shapes: Iterable[Visual | Collision]) -> Bounds | None:
    """Return the box around shapes in the link frame, or None if it is unknown."""
    from linkwright.geometry.shapes import union

    boxes = [subject.extents.shape_bounds(shape) for shape in shapes]
    known_boxes = [bounds for bounds in boxes if bounds is not None]
    return union(known_boxes) if len(known_boxes) == len(boxes) else None


def _has_collision(element: Element | None) -> bool:
    return element is not None and element.first("collision") is not None


def _find_span(shape: Visual) -> Span | None:
    return shape.element.span() if shape.element is not None else None
