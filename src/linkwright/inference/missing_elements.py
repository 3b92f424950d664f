"""The inference of the collisions and masses that links need for simulation.

Links that move as one body are considered together: a link without a mass may be fixed to a link that has one. If some
links have collisions, only wheels, casters and the chassis are assumed to lack them by mistake.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import numpy as np

from linkwright.diagnostics import Diagnostic, Phrase, Severity, joined, phrase, term
from linkwright.geometry.mass import MassProperties
from linkwright.geometry.shapes import rotated, transposed
from linkwright.geometry.single import Vector3, add_vectors, length, rotation_from_z, rpy_from_quaternion, scaled
from linkwright.inertia import DEFAULT_DENSITY, MeshLibrary, estimate
from linkwright.inertia.blocks import inertial_parts
from linkwright.inertia.verdict import format_digits
from linkwright.inference.gazebo import format_number
from linkwright.inference.results import InferredFact, Wheel
from linkwright.inference.shapes import Shape, load_vertices
from linkwright.inference.undercarriage import Survey
from linkwright.urdf import Box, Capsule, Cylinder, Inertial, Link, Mesh, Sphere
from linkwright.xmltree import Element

HOLLOW_DENSITY = 300.0
"""The density in kg/m3 of a mobile robot's links except its wheels, as of a box with air, boards and batteries.

The robots that tutorials use have 200 to 700 kg/m3.
"""

_MIN_MASS_KG = 0.01
_MAX_MASS_KG = 1000.0
"""The minimum and maximum of an inferred mass, in kg."""

_SHAPELESS_BODY = MassProperties(0.01, np.zeros(3), np.eye(3) * 1e-5)
"""The mass properties of a moving body without shapes: a ball of 10 g with a radius of 5 cm."""

_MAX_MESH_VERTICES = 20_000
"""The maximum number of vertices of a mesh for a collision. A larger mesh is replaced by the box around it."""


def infer_collisions(survey: Survey, wheels: Mapping[str, Wheel], casters: Iterable[str]) -> Iterator[InferredFact]:
    """Yield findings with the collisions that links get from their visuals.

    Args:
        survey: the facts about the robot.
        wheels: the wheels that touch the ground, by the name of their link.
        casters: the links that slide, or roll without a drive.
    """
    robot = survey.robot
    has_collisions = any(link.collisions for link in robot.links.values())
    root = survey.bodies.of(robot.root)
    rolling_links = {*wheels, *casters}
    for body in survey.bodies.all:
        members = survey.bodies.members(body)
        if any(link.collisions for link in members):
            continue
        if has_collisions and body is not root and not rolling_links.intersection(body.links):
            continue
        wheel = wheels.get(body.links[0])
        for link in members:
            if link.visuals:
                yield from _infer_link_collisions(survey, link, wheel)


def _infer_link_collisions(survey: Survey, link: Link, wheel: Wheel | None) -> Iterator[InferredFact]:
    element = link.element
    if element is None:
        return
    collisions: list[Element] = []
    descriptions: list[Phrase] = []
    for visual in link.visuals:
        collision = _visual_to_collision(visual, link, wheel, survey)
        if collision is None:
            assert isinstance(visual.geometry, Mesh), "other shapes can be measured"
            name = visual.geometry.filename.rpartition("/")[2]
            message = phrase(
                "link '{link}' gets no <collision>: its mesh '{name}' cannot be read", link=link.name, name=name
            )
            yield InferredFact(_create_diagnostic("DRIVE105", message, element, Severity.WARNING))
            continue
        collisions.append(collision[0])
        descriptions.append(collision[1])
    if collisions:
        message = phrase(
            "link '{link}' has no <collision>: it gets {shape}", link=link.name, shape=joined(descriptions)
        )
        yield InferredFact(_create_diagnostic("DRIVE101", message, element), element, tuple(collisions))


def _visual_to_collision(
    visual: Shape, link: Link, wheel: Wheel | None, survey: Survey
) -> tuple[Element, Phrase] | None:
    """Return a collision for a visual and its description, or None if its mesh is unreadable."""
    geometry = visual.geometry
    if not isinstance(geometry, Mesh):
        shape_name = term(type(geometry).__name__.lower())
        return _create_collision_element(visual.origin.xyz, visual.origin.rpy, _create_shape_element(geometry)), phrase(
            "the {shape} of its visual", shape=shape_name
        )
    corners = load_vertices(visual, survey.meshes)
    if corners is None:
        return None
    name = geometry.filename.rpartition("/")[2]
    if wheel is not None and wheel.link == link.name and wheel.width is not None:
        axis, center = _to_link_frame(survey, wheel)
        rpy = rpy_from_quaternion(rotation_from_z(axis))
        cylinder = Cylinder(wheel.radius, wheel.width)
        description = phrase(
            "a cylinder of radius {radius:.4g} m and length {width:.4g} m that fits its mesh '{name}'",
            radius=wheel.radius,
            width=wheel.width,
            name=name,
        )
        return _create_collision_element(center, rpy, _create_shape_element(cylinder)), description
    if len(corners) > _MAX_MESH_VERTICES:
        minimum, maximum = corners.min(axis=0), corners.max(axis=0)
        x, y, z = (float(size) for size in maximum - minimum)
        middle = tuple(float(coordinate) for coordinate in (minimum + maximum) / 2.0)
        box = _create_shape_element(Box((x, y, z)))
        return _create_collision_element((middle[0], middle[1], middle[2]), (0.0, 0.0, 0.0), box), phrase(
            "the box around its mesh '{name}'", name=name
        )
    shape = Element("mesh", {"filename": geometry.filename})
    if geometry.scale != (1.0, 1.0, 1.0):
        shape.attributes["scale"] = _format_numbers(geometry.scale)
    return _create_collision_element(visual.origin.xyz, visual.origin.rpy, shape), phrase(
        "the mesh '{name}' of its visual", name=name
    )


def infer_masses(survey: Survey, wheels: Iterable[str], *, fixed_base: bool) -> Iterator[InferredFact]:
    """Yield findings with the ``<inertial>`` of links that lack a mass or moments of inertia.

    Args:
        survey: the facts about the robot.
        wheels: the links of wheels and casters. They get a solid's density, as do all links of a robot with a fixed
            base.
        fixed_base: whether the root does not move, so that its body needs no mass.
    """
    solid_links = set(wheels)
    root = survey.bodies.of(survey.robot.root)
    for body in survey.bodies.all:
        if body is root and fixed_base:
            continue
        members = survey.bodies.members(body)
        if survey.bodies.mass(body) > 0:
            for link in members:
                yield from _infer_tensor(link, survey.meshes)
            continue
        is_solid = fixed_base or body.links[0] in solid_links
        densities = {
            link.name: DEFAULT_DENSITY if is_solid or link.name in solid_links else HOLLOW_DENSITY for link in members
        }
        yield from _infer_body_mass(members, densities, survey.meshes)


def _infer_body_mass(
    members: list[Link], densities: Mapping[str, float], meshes: MeshLibrary
) -> Iterator[InferredFact]:
    has_mass_source = False
    for link in members:
        density = densities[link.name]
        properties = estimate(link, meshes, density=density).properties
        if properties is None or link.element is None:
            continue
        has_mass_source = True
        limited_mass = min(max(properties.mass, _MIN_MASS_KG), _MAX_MASS_KG)
        limited = properties.with_mass(limited_mass)
        message = phrase(
            "link '{link}' has no mass: it gets {mass:.3g} kg, the mass of its shapes at {density} kg/m3",
            link=link.name,
            mass=limited.mass,
            density=format_digits(density * limited_mass / properties.mass),
        )
        yield _create_inertial_finding("DRIVE102", message, link, limited)
    if not has_mass_source and members[0].element is not None:
        name = members[0].name
        message = phrase(
            "no link rigidly attached to link '{link}' has a shape or a mass: the link is given a mass of 10 g",
            link=name,
        )
        yield _create_inertial_finding("DRIVE103", message, members[0], _SHAPELESS_BODY)


def _infer_tensor(link: Link, meshes: MeshLibrary) -> Iterator[InferredFact]:
    """Yield a finding with the ``<inertial>`` of a link with mass and zero moments of inertia."""
    inertial = link.inertial
    if inertial is None or not inertial.has_mass or any(_list_moments(inertial)) or link.element is None:
        return
    properties = estimate(link, meshes, mass=inertial.mass).properties
    if properties is not None:
        message = phrase(
            "the moments of inertia of link '{link}' are zero: the link gets the moments of its "
            "shapes with {mass:.3g} kg",
            link=link.name,
            mass=inertial.mass,
        )
        yield _create_inertial_finding("DRIVE104", message, link, properties)


def _list_moments(inertial: Inertial) -> tuple[float, ...]:
    return (inertial.ixx, inertial.ixy, inertial.ixz, inertial.iyy, inertial.iyz, inertial.izz)


def _create_inertial_finding(code: str, message: Phrase, link: Link, properties: MassProperties) -> InferredFact:
    element = Element("inertial")
    element.children += [Element(tag, dict(attributes)) for tag, attributes in inertial_parts(properties)]
    assert link.element is not None, "it was looked for"
    return InferredFact(_create_diagnostic(code, message, link.element), link.element, (element,), properties)


def _to_link_frame(survey: Survey, wheel: Wheel) -> tuple[Vector3, Vector3]:
    """Return the axis and the center of a wheel in its link's frame."""
    frame = survey.get_frame(wheel.link)
    inverse_rotation = transposed(frame.rotation)
    offset = add_vectors(wheel.center, scaled(frame.position, -1.0))
    return rotated(inverse_rotation, wheel.axis), rotated(inverse_rotation, offset)


def _create_shape_element(geometry: Box | Cylinder | Capsule | Sphere) -> Element:
    tag = type(geometry).__name__.lower()
    if isinstance(geometry, Box):
        return Element(tag, {"size": _format_numbers(geometry.size)})
    attributes = {"radius": format_number(geometry.radius)}
    if not isinstance(geometry, Sphere):
        attributes["length"] = format_number(geometry.length)
    return Element(tag, attributes)


def _create_collision_element(xyz: Vector3, rpy: Vector3, shape: Element) -> Element:
    element = Element("collision")
    if length(xyz) or length(rpy):
        element.children.append(Element("origin", {"xyz": _format_numbers(xyz), "rpy": _format_numbers(rpy)}))
    geometry = Element("geometry")
    geometry.children.append(shape)
    element.children.append(geometry)
    return element


def _format_numbers(values: Iterable[float]) -> str:
    return " ".join(format_number(round(value, 9) + 0.0) for value in values)


def _create_diagnostic(code: str, message: Phrase, element: Element, severity: Severity = Severity.INFO) -> Diagnostic:
    return Diagnostic(code, message, element.span(), severity, source=element.source)
