"""Inference of the collisions and masses that links lack to be simulated.

Links that move as one body are considered as one: a link without a mass may get it from a link that is fixed to it. If
the author gave collisions to some links, only wheels, casters and the chassis are assumed to lack them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from linkwright.diagnostics import Diagnostic, Phrase, Severity, joined, phrase, term
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.shapes import rotated, transposed
from linkwright.geometry.single import Vector3, added, length, rotation_from_z, rpy_from_quaternion, scaled
from linkwright.inertia import DEFAULT_DENSITY, MeshLibrary, estimate
from linkwright.inertia.blocks import inertial_parts
from linkwright.inertia.inertial import has_mass
from linkwright.inertia.verdict import grouped
from linkwright.inference.gazebo import number
from linkwright.inference.model import Finding, Wheel
from linkwright.inference.shapes import Shape, vertices
from linkwright.inference.undercarriage import Survey
from linkwright.urdf import Box, Capsule, Cylinder, Inertial, Link, Mesh, Sphere
from linkwright.xmltree import Element

HOLLOW_DENSITY = 300.0
"""kg/m3 of the links of a mobile robot but its wheels: a box with air, boards and batteries. That of the robots that
tutorials use is between 200 and 700."""

_LIGHTEST = 0.01
_HEAVIEST = 1000.0
"""Masses in kg between which an inferred one is kept."""

_FRAME = MassProperties(0.01, np.zeros(3), np.eye(3) * 1e-5)
"""The mass properties of a moving body that has only frames: those of a ball of 10 g and 5 cm radius."""

_LARGE_MESH = 20_000
"""A mesh with more corners is replaced by the box around it."""


def missing_collisions(survey: Survey, wheels: Mapping[str, Wheel], casters: Iterable[str]) -> Iterator[Finding]:
    """Yield the collisions that links get from their visuals.

    Args:
        survey: the robot.
        wheels: the wheels that touch the ground, by link.
        casters: the links that only slide or roll along.
    """
    robot = survey.robot
    some = any(link.collisions for link in robot.links.values())
    root = survey.bodies.of(robot.root)
    rolling = {*wheels, *casters}
    for body in survey.bodies.all:
        members = survey.bodies.members(body)
        if any(link.collisions for link in members):
            continue
        if some and body is not root and not rolling.intersection(body.links):
            continue
        wheel = wheels.get(body.links[0])
        for link in members:
            if link.visuals:
                yield from _collisions(survey, link, wheel)


def _collisions(survey: Survey, link: Link, wheel: Wheel | None) -> Iterator[Finding]:
    element = link.element
    if element is None:
        return
    made: list[Element] = []
    words: list[Phrase] = []
    for visual in link.visuals:
        found = _collision(visual, link, wheel, survey)
        if found is None:
            assert isinstance(visual.geometry, Mesh), "other shapes can be measured"
            name = visual.geometry.filename.rpartition("/")[2]
            message = phrase(
                "link '{link}' gets no <collision>: its mesh '{name}' cannot be read", link=link.name, name=name
            )
            yield Finding(_finding("DRIVE105", message, element, Severity.WARNING))
            continue
        made.append(found[0])
        words.append(found[1])
    if made:
        message = phrase("link '{link}' has no <collision>: it gets {what}", link=link.name, what=joined(words))
        yield Finding(_finding("DRIVE101", message, element), element, tuple(made))


def _collision(visual: Shape, link: Link, wheel: Wheel | None, survey: Survey) -> tuple[Element, Phrase] | None:
    """Return a collision for a visual, and its description; None for a mesh that cannot be read."""
    geometry = visual.geometry
    if not isinstance(geometry, Mesh):
        what = term(type(geometry).__name__.lower())
        return _element(visual.origin.xyz, visual.origin.rpy, _shape(geometry)), phrase(
            "the {what} of its visual", what=what
        )
    corners = vertices(visual, survey.meshes)
    if corners is None:
        return None
    name = geometry.filename.rpartition("/")[2]
    if wheel is not None and wheel.link == link.name and wheel.width is not None:
        axis, center = _in_link(survey, wheel)
        rpy = rpy_from_quaternion(rotation_from_z(axis))
        cylinder = Cylinder(wheel.radius, wheel.width)
        words = phrase(
            "a cylinder of radius {radius:.4g} m and length {width:.4g} m that fits its mesh '{name}'",
            radius=wheel.radius,
            width=wheel.width,
            name=name,
        )
        return _element(center, rpy, _shape(cylinder)), words
    if len(corners) > _LARGE_MESH:
        low, high = corners.min(axis=0), corners.max(axis=0)
        x, y, z = (float(part) for part in high - low)
        middle = tuple(float(part) for part in (low + high) / 2.0)
        box = _shape(Box((x, y, z)))
        return _element((middle[0], middle[1], middle[2]), (0.0, 0.0, 0.0), box), phrase(
            "the box around its mesh '{name}'", name=name
        )
    shape = Element("mesh", {"filename": geometry.filename})
    if geometry.scale != (1.0, 1.0, 1.0):
        shape.attributes["scale"] = _numbers(geometry.scale)
    return _element(visual.origin.xyz, visual.origin.rpy, shape), phrase("the mesh '{name}' of its visual", name=name)


def missing_masses(survey: Survey, wheels: Iterable[str], *, fixed_base: bool) -> Iterator[Finding]:
    """Yield the ``<inertial>`` of links whose body has no mass.

    Args:
        survey: the robot.
        wheels: the links of wheels and casters, which are solid; so are all links of a robot with a fixed base.
        fixed_base: whether the root does not move, so that it needs no mass.
    """
    solid = set(wheels)
    root = survey.bodies.of(survey.robot.root)
    for body in survey.bodies.all:
        if body is root and fixed_base:
            continue
        members = survey.bodies.members(body)
        if survey.bodies.mass(body) > 0:
            for link in members:
                yield from _missing_tensor(link, survey.meshes)
            continue
        dense = fixed_base or body.links[0] in solid
        densities = {link.name: DEFAULT_DENSITY if dense or link.name in solid else HOLLOW_DENSITY for link in members}
        yield from _masses(members, densities, survey.meshes)


def _masses(members: list[Link], densities: Mapping[str, float], meshes: MeshLibrary) -> Iterator[Finding]:
    found = False
    for link in members:
        density = densities[link.name]
        properties = estimate(link, meshes, density=density).properties
        if properties is None or link.element is None:
            continue
        found = True
        kept = min(max(properties.mass, _LIGHTEST), _HEAVIEST)
        bounded = properties.with_mass(kept)
        message = phrase(
            "link '{link}' has no mass: it gets {mass:.3g} kg, the mass of its shapes at {density} kg/m3",
            link=link.name,
            mass=bounded.mass,
            density=grouped(density * kept / properties.mass),
        )
        yield _inertial("DRIVE102", message, link, bounded)
    if not found and members[0].element is not None:
        name = members[0].name
        message = phrase("no part that moves with link '{link}' has a shape or a mass: it gets 10 g", link=name)
        yield _inertial("DRIVE103", message, members[0], _FRAME)


def _missing_tensor(link: Link, meshes: MeshLibrary) -> Iterator[Finding]:
    """Yield the ``<inertial>`` of a link that has a mass, but only zero moments."""
    inertial = link.inertial
    if inertial is None or not has_mass(inertial) or any(_moments(inertial)) or link.element is None:
        return
    properties = estimate(link, meshes, mass=inertial.mass).properties
    if properties is not None:
        message = phrase(
            "the moments of inertia of link '{link}' are zero: it gets those of its shapes with {mass:.3g} kg",
            link=link.name,
            mass=inertial.mass,
        )
        yield _inertial("DRIVE104", message, link, properties)


def _moments(inertial: Inertial) -> tuple[float, ...]:
    return (inertial.ixx, inertial.ixy, inertial.ixz, inertial.iyy, inertial.iyz, inertial.izz)


def _inertial(code: str, message: Phrase, link: Link, properties: MassProperties) -> Finding:
    element = Element("inertial")
    element.children += [Element(tag, dict(attributes)) for tag, attributes in inertial_parts(properties)]
    assert link.element is not None, "it was looked for"
    return Finding(_finding(code, message, link.element), link.element, (element,), properties)


def _in_link(survey: Survey, wheel: Wheel) -> tuple[Vector3, Vector3]:
    """Return the axis and the centre of a wheel in the frame of its link."""
    frame = survey.frame(wheel.link)
    back = transposed(frame.rotation)
    offset = added(wheel.center, scaled(frame.position, -1.0))
    return rotated(back, wheel.axis), rotated(back, offset)


def _shape(geometry: Box | Cylinder | Capsule | Sphere) -> Element:
    tag = type(geometry).__name__.lower()
    if isinstance(geometry, Box):
        return Element(tag, {"size": _numbers(geometry.size)})
    attributes = {"radius": number(geometry.radius)}
    if not isinstance(geometry, Sphere):
        attributes["length"] = number(geometry.length)
    return Element(tag, attributes)


def _element(xyz: Vector3, rpy: Vector3, shape: Element) -> Element:
    element = Element("collision")
    if length(xyz) or length(rpy):
        element.children.append(Element("origin", {"xyz": _numbers(xyz), "rpy": _numbers(rpy)}))
    geometry = Element("geometry")
    geometry.children.append(shape)
    element.children.append(geometry)
    return element


def _numbers(values: Iterable[float]) -> str:
    return " ".join(number(round(value, 9) + 0.0) for value in values)


def _finding(code: str, message: Phrase, element: Element, severity: Severity = Severity.INFO) -> Diagnostic:
    return Diagnostic(code, message, element.span(), severity, source=element.source)
