"""Rules about static stability: wheels on the ground, and the centre of mass above them.

The robot is at rest, with all joints at zero. Wheels and casters are recognised by their names, and their contacts with
the ground are computed from their cylinders and spheres. If a wheel or caster has only a mesh, nothing is reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from math import hypot, sqrt

from linkwright.diagnostics import Diagnostic, Note, Span, phrase
from linkwright.geometry.polygon import turn
from linkwright.geometry.shapes import Placement, placement, rotated
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.names_wheels import joints_above, wheels
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.urdf import Cylinder, Link, Robot, Sphere, Vector3

_CASTER = lazy_pattern(r"cast(?:e|o)r|ball_?wheel", re.IGNORECASE)
_LEVEL = 0.2
"""The sine up to which a wheel's axis counts as level."""

Point = tuple[float, float]


class Contact(NamedTuple):
    """The contact of a wheel or caster with the ground.

    Attributes:
        link: the link of the wheel or caster.
        place: the lowest point of the link in the frame of the base, in m.
        is_wheel: whether the link is a wheel and not a caster.
    """

    link: Link
    place: Vector3
    is_wheel: bool


def contacts(subject: Subject) -> list[Contact] | None:
    """Return a robot's contacts with the ground, or None if they are not known.

    They are not known without a robot, or if a wheel or caster cannot be measured.
    """
    robot, frames = subject.robot, subject.frames
    if robot is None:
        return None
    base = frames.get("base_link", frames[robot.root])
    driven = {wheel.link.name for wheel in wheels(subject)}
    found = []
    for name, link in robot.links.items():
        is_wheel = name in driven
        if name not in frames or not (is_wheel or (_CASTER.search(name) and (link.visuals or link.collisions))):
            continue
        lowest = None
        for shape in link.collisions or link.visuals:
            place = placement(shape.origin).inside(frames[name]).seen_from(base)
            x, y, z = place.position
            depth = _depth(shape.geometry, place.rotation[2][2])
            if depth is not None and (lowest is None or z - depth < lowest[2]):
                lowest = (x, y, z - depth)
        if lowest is None:
            return None
        found.append(Contact(link, lowest, is_wheel))
    return found


class WheelsNotLevel(Rule):
    """Wheels or casters that do not reach the ground below the others.

    ## Why

    A driven wheel in the air turns without moving the robot. A robot that rests on two wheels and a corner of its body
    drives in circles. The lowest points of all wheels and casters should be in one plane. Wheels on a joint that can
    lift them, such as a rocker of a rover, adapt to the ground and are not reported.

    ## Example

    A left wheel of 6 cm radius at `xyz="0 0.2 -0.05"` and a right one at `xyz="0 -0.2 -0.03"`.

    ## Use instead

    Use the same height for both wheels, and a caster whose lowest point is level with the lowest points of the wheels.
    """

    code = "LW390"
    name = "wheels-not-level"
    options = (Option("tolerance", 0.01, "how far above the ground a wheel may be, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        found = subject.once(contacts)
        if found is None or sum(contact.is_wheel for contact in found) < 2:
            return
        tolerance = self.option(subject, "tolerance", float)
        driven = [contact for contact in found if contact.is_wheel]
        ground = min(contact.place[2] for contact in driven)
        lowest = min(driven, key=lambda item: item.place[2]).link
        springing = _lifted_wheels(subject)
        for contact in found:
            gap = contact.place[2] - ground
            if abs(gap) > tolerance and springing.isdisjoint((contact.link.name, lowest.name)):
                where = phrase("above") if gap > 0 else phrase("below")
                yield self.report(
                    phrase(
                        "'{name}' ends {gap:.3g} mm {where} the ground that '{lowest_name}' touches",
                        name=contact.link.name,
                        gap=abs(gap) * 1000,
                        where=where,
                        lowest_name=lowest.name,
                    ),
                    contact.link.element,
                    "name",
                    notes=[Note(phrase("'{name}' is defined here", name=lowest.name), _place(lowest))],
                    hint=phrase("check the heights of their joints, and the radii"),
                )


def _lifted_wheels(subject: Subject) -> set[str]:
    """Return the names of the wheels and casters that a joint above them can lift.

    Steering joints, which rotate about z, do not count.
    """
    robot, frames = subject.robot, subject.frames
    found: set[str] = set()
    if robot is None:
        return found
    for joint in robot.joints.values():
        for above in joints_above(robot, joint):
            if above.type == "fixed" or above.child not in frames:
                continue
            level = hypot(*rotated(frames[above.child].rotation, above.axis)[:2])
            if (level > _LEVEL) is (above.type != "prismatic"):
                found.add(joint.child)
    return found


class CenterBeyondWheels(Rule):
    """A centre of mass that is not above the area between the wheels and casters.

    ## Why

    The robot tips over as soon as the simulation starts. Only robots with three or more contacts are checked, because a
    robot with two wheels may be designed to balance.

    ## Example

    Two wheels at x = 0, a caster at x = 0.2, and a battery of 10 kg at x = -0.3.

    ## Use instead

    Add a caster on the side of the mass.
    """

    code = "LW391"
    name = "center-of-mass-beyond-wheels"
    options = (Option("margin", 0.01, "how far outside it may be, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        robot = subject.robot
        found = subject.once(contacts)
        if robot is None or found is None or len(found) < 3:
            return
        corners = _hull([contact.place[:2] for contact in found])
        center = _center_of_mass(robot, subject.frames)
        if len(corners) < 3 or center is None:
            return
        distance = _distance_outside(center, corners)
        if distance > self.option(subject, "margin", float):
            holder = max(
                (link for link in robot.links.values() if link.inertial is not None),
                key=lambda link: link.inertial.mass if link.inertial is not None else 0.0,
            )
            yield self.report(
                phrase(
                    "the centre of mass of the robot is {distance:.3g} cm beyond its wheels, so it tips over",
                    distance=distance * 100,
                ),
                holder.element,
                "name",
                notes=[
                    Note(
                        phrase(
                            "it is at x = {center:.3g} m, y = {other_center:.3g} m",
                            center=center[0],
                            other_center=center[1],
                        )
                    ),
                    Note(phrase("'{name}' is the heaviest link", name=holder.name)),
                ],
                hint=phrase("check the origins of the heavy links' <inertial>, and where the casters are"),
            )


def _depth(shape: object, upward: float) -> float | None:
    """Return how far a wheel's shape extends below its centre in m, or None for other shapes.

    `upward` is the upward component of the shape's z axis.
    """
    if isinstance(shape, Sphere):
        return shape.radius
    if isinstance(shape, Cylinder) and abs(upward) < _LEVEL:
        return shape.radius * sqrt(1 - upward * upward) + shape.length / 2 * abs(upward)
    return None


def _center_of_mass(robot: Robot, frames: Mapping[str, Placement]) -> Point | None:
    """Return x and y of a robot's centre of mass in the base frame in m; None if it is massless."""
    base = frames.get("base_link", frames[robot.root])
    total = x = y = 0.0
    for name, link in robot.links.items():
        if link.inertial is not None and link.inertial.mass > 0 and name in frames:
            place = frames[name].seen_from(base).point(link.inertial.origin.xyz)
            total += link.inertial.mass
            x += link.inertial.mass * place[0]
            y += link.inertial.mass * place[1]
    return (x / total, y / total) if total > 0 else None


def _hull(points: Sequence[Point]) -> list[Point]:
    """Return the corners of the convex hull in counter-clockwise order.

    There are fewer than three corners if all points are on a line. The algorithm is Andrew's monotone chain.
    """
    ordered = sorted(set(points))

    def half(sequence: Iterable[Point]) -> list[Point]:
        chain: list[Point] = []
        for point in sequence:
            while len(chain) > 1 and turn(chain[-2], chain[-1], point) <= 1e-9:
                chain.pop()
            chain.append(point)
        return chain[:-1]

    return half(ordered) + half(reversed(ordered))


def _distance_outside(point: Point, corners: Sequence[Point]) -> float:
    """Return the distance of a point from a convex polygon, or 0 if the point is inside.

    The distance is measured from the line through the edge that the point exceeds most. The corners are
    counter-clockwise.
    """
    farthest = 0.0
    for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        edge = hypot(end[0] - start[0], end[1] - start[1])
        if edge > 0:
            farthest = max(farthest, -turn(start, end, point) / edge)
    return farthest


def _place(link: Link) -> Span | None:
    return link.element.span() if link.element is not None else None
