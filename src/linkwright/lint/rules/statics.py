"""Rules about static stability: wheels on the ground, and the center of mass above them.

The robot is at rest, with all joints at zero. Wheels and casters are recognized by their names, and their contacts with
the ground are computed from their cylinders and spheres. If a wheel or caster has only a mesh, nothing is reported.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from math import hypot, sqrt

from linkwright.diagnostics import Diagnostic, Note, Span, phrase
from linkwright.geometry.polygon import signed_double_area
from linkwright.geometry.shapes import Placement, placement, rotated
from linkwright.lint.option import Option
from linkwright.lint.rule import Rule
from linkwright.lint.rules.names_wheels import iterate_joints_above, iterate_wheels
from linkwright.lint.subject import Subject
from linkwright.loading.deferred import lazy_pattern
from linkwright.loading.lean_dataclasses import NamedTuple
from linkwright.urdf import Cylinder, Link, Robot, Sphere, Vector3

_CASTER = lazy_pattern(r"cast(?:e|o)r|ball_?wheel", re.IGNORECASE)
_MAX_LEVEL_SINE = 0.2
"""The sine of the tilt up to which a wheel's axis counts as level."""

Point = tuple[float, float]


class Contact(NamedTuple):
    """The contact of a wheel or caster with the ground.

    Attributes:
        link: the link of the wheel or caster.
        lowest_point: the lowest point of the link in the frame of the base, in m.
        is_wheel: whether the link is a wheel and not a caster.
    """

    link: Link
    lowest_point: Vector3
    is_wheel: bool


def find_contacts(subject: Subject) -> list[Contact] | None:
    """Return a robot's contacts with the ground, or None if they are not known.

    The contacts are not known if there is no robot, or if a wheel or caster cannot be measured.
    """
    robot, frames = subject.robot, subject.frames
    if robot is None:
        return None
    base = frames.get("base_link", frames[robot.root])
    wheel_names = {wheel.link.name for wheel in iterate_wheels(subject)}
    all_contacts = []
    for name, link in robot.links.items():
        is_wheel = name in wheel_names
        if name not in frames or not (is_wheel or (_CASTER.search(name) and (link.visuals or link.collisions))):
            continue
        lowest_point = None
        for shape in link.collisions or link.visuals:
            pose = placement(shape.origin).inside(frames[name]).seen_from(base)
            x, y, z = pose.position
            depth = _measure_depth(shape.geometry, pose.rotation[2][2])
            if depth is not None and (lowest_point is None or z - depth < lowest_point[2]):
                lowest_point = (x, y, z - depth)
        if lowest_point is None:
            return None
        all_contacts.append(Contact(link, lowest_point, is_wheel))
    return all_contacts


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
    options = (Option("tolerance", 0.01, "largest distance of a wheel from the ground, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        all_contacts = subject.once(find_contacts)
        if all_contacts is None or sum(contact.is_wheel for contact in all_contacts) < 2:
            return
        tolerance = self.option(subject, "tolerance", float)
        wheel_contacts = [contact for contact in all_contacts if contact.is_wheel]
        ground = min(contact.lowest_point[2] for contact in wheel_contacts)
        lowest_wheel = min(wheel_contacts, key=lambda item: item.lowest_point[2]).link
        lifted_wheels = _find_lifted_wheels(subject)
        for contact in all_contacts:
            gap = contact.lowest_point[2] - ground
            if abs(gap) > tolerance and lifted_wheels.isdisjoint((contact.link.name, lowest_wheel.name)):
                direction = phrase("above") if gap > 0 else phrase("below")
                yield self.report(
                    phrase(
                        "the lowest point of '{name}' is {distance:.3g} mm {side} the ground that "
                        "'{lowest_name}' touches",
                        name=contact.link.name,
                        distance=abs(gap) * 1000,
                        side=direction,
                        lowest_name=lowest_wheel.name,
                    ),
                    contact.link.element,
                    "name",
                    notes=[Note(phrase("'{name}' is defined here", name=lowest_wheel.name), _find_span(lowest_wheel))],
                    hint=phrase("check the heights of their joints, and the radii of the wheels"),
                )


def _find_lifted_wheels(subject: Subject) -> set[str]:
    """Return the names of the wheels and casters that a joint above them can lift.

    Steering joints, which rotate about z, are ignored.
    """
    robot, frames = subject.robot, subject.frames
    names: set[str] = set()
    if robot is None:
        return names
    for joint in robot.joints.values():
        for upper_joint in iterate_joints_above(robot, joint):
            if upper_joint.type == "fixed" or upper_joint.child not in frames:
                continue
            horizontal = hypot(*rotated(frames[upper_joint.child].rotation, upper_joint.axis)[:2])
            if (horizontal > _MAX_LEVEL_SINE) is (upper_joint.type != "prismatic"):
                names.add(joint.child)
    return names


class CenterBeyondWheels(Rule):
    """A center of mass that is not above the area between the wheels and casters.

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
    options = (Option("margin", 0.01, "largest distance outside the area between the wheels, in m"),)

    def check(self, subject: Subject) -> Iterable[Diagnostic]:
        robot = subject.robot
        all_contacts = subject.once(find_contacts)
        if robot is None or all_contacts is None or len(all_contacts) < 3:
            return
        corners = _compute_convex_hull([contact.lowest_point[:2] for contact in all_contacts])
        center = _compute_center_of_mass(robot, subject.frames)
        if len(corners) < 3 or center is None:
            return
        distance = _compute_distance_outside(center, corners)
        if distance > self.option(subject, "margin", float):
            heaviest_link = max(
                (link for link in robot.links.values() if link.inertial is not None),
                key=lambda link: link.inertial.mass if link.inertial is not None else 0.0,
            )
            yield self.report(
                phrase(
                    "the center of mass of the robot is {distance:.3g} cm beyond its wheels, so the robot tips over",
                    distance=distance * 100,
                ),
                heaviest_link.element,
                "name",
                notes=[
                    Note(
                        phrase(
                            "it is at x = {x:.3g} m, y = {y:.3g} m",
                            x=center[0],
                            y=center[1],
                        )
                    ),
                    Note(phrase("'{name}' is the heaviest link", name=heaviest_link.name)),
                ],
                hint=phrase("check the <inertial> origins of the heavy links, and the positions of the casters"),
            )


def _measure_depth(shape: object, upward: float) -> float | None:
    """Return the extent of a wheel's shape below its center in m, or None for other shapes.

    `upward` is the upward component of the shape's z axis.
    """
    if isinstance(shape, Sphere):
        return shape.radius
    if isinstance(shape, Cylinder) and abs(upward) < _MAX_LEVEL_SINE:
        return shape.radius * sqrt(1 - upward * upward) + shape.length / 2 * abs(upward)
    return None


def _compute_center_of_mass(robot: Robot, frames: Mapping[str, Placement]) -> Point | None:
    """Return x and y in m of a robot's center of mass in the base frame, or None if massless."""
    base = frames.get("base_link", frames[robot.root])
    total = x = y = 0.0
    for name, link in robot.links.items():
        if link.inertial is not None and link.inertial.mass > 0 and name in frames:
            position = frames[name].seen_from(base).point(link.inertial.origin.xyz)
            total += link.inertial.mass
            x += link.inertial.mass * position[0]
            y += link.inertial.mass * position[1]
    return (x / total, y / total) if total > 0 else None


def _compute_convex_hull(points: Sequence[Point]) -> list[Point]:
    """Return the corners of the convex hull in counter-clockwise order.

    There are fewer than three corners if all points are on a line. The algorithm is Andrew's monotone chain.
    """
    sorted_points = sorted(set(points))

    def half_hull(sequence: Iterable[Point]) -> list[Point]:
        chain: list[Point] = []
        for point in sequence:
            while len(chain) > 1 and signed_double_area(chain[-2], chain[-1], point) <= 1e-9:
                chain.pop()
            chain.append(point)
        return chain[:-1]

    return half_hull(sorted_points) + half_hull(reversed(sorted_points))


def _compute_distance_outside(point: Point, corners: Sequence[Point]) -> float:
    """Return the distance of a point from a convex polygon, or 0 if the point is inside.

    The distance is measured from the line through the edge that the point exceeds most. The corners are
    counter-clockwise.
    """
    max_distance = 0.0
    for start, end in zip(corners, [*corners[1:], corners[0]], strict=True):
        edge_length = hypot(end[0] - start[0], end[1] - start[1])
        if edge_length > 0:
            max_distance = max(max_distance, -signed_double_area(start, end, point) / edge_length)
    return max_distance


def _find_span(link: Link) -> Span | None:
    return link.element.span() if link.element is not None else None
