"""Models of one simple shape: their recognition, elements and masses.

A wall is a box whose link is called ``wall``. A ramp is a wedge that rises along x, a ``<polyline>`` with three corners
in a link called ``ramp``. In this way, a plain SDF file preserves the kind of these shapes.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite, pi
from typing import Literal

import numpy as np

from linkwright.geometry.mass import MassProperties
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.geometry.single import Pose
from linkwright.geometry.solids import shape_properties
from linkwright.sdf.links import Collision, Visual
from linkwright.sdf.materials import Material
from linkwright.sdf.models import Model
from linkwright.sdf.poses import AT_ORIGIN, RawPose
from linkwright.sdf.scripts import find_gazebo_look, with_look
from linkwright.sdf.shapes import Polyline, Shape
from linkwright.sdf.values import Color, format_shortest
from linkwright.xmltree import Element, Text

ShapeKind = Literal["box", "cylinder", "sphere", "wall", "ramp"]

SIZE_COUNTS = {"box": 3, "cylinder": 2, "sphere": 1, "wall": 3, "ramp": 3}
"""The number of dimensions of each kind of shape: x, y, z; radius and length; or radius."""
LENGTH_DIGITS = 9
"""Decimals of a written length in meters, or angle in radians."""


@dataclass(frozen=True, slots=True)
class SimpleShape:
    """The kind, size and color of a model of one simple shape.

    Attributes:
        kind: the kind of shape; a wall is a box, and a ramp is a wedge.
        size: in meters: x, y, z of a box, wall or ramp; radius and length of a cylinder; the radius of a sphere.
        color: red, green, blue, alpha from 0 to 1; None if the model does not specify a color.
    """

    kind: ShapeKind
    size: tuple[float, ...]
    color: Color | None = None


def recognize_simple_shape(model: Model) -> SimpleShape | None:
    """Return the shape of a model that consists of one simple shape, or None for others.

    Such a model has one link, whose visuals and collisions all have this shape.
    """
    if len(model.links) != 1 or model.joints or model.models or model.includes:
        return None
    link = model.links[0]
    parts: list[Visual | Collision] = [*link.visuals, *link.collisions]
    if link.pose != AT_ORIGIN or not parts or any(part.geometry != parts[0].geometry for part in parts):
        return None
    shape = _find_dimensions(parts[0].geometry, link.name)
    if shape is None or any(not _is_at(part.pose, shape) for part in parts):
        return None
    kind, size = shape
    return SimpleShape(kind, size, _find_display_color(link.visuals[0].material) if link.visuals else None)


def _find_dimensions(geometry: Shape, link: str) -> tuple[ShapeKind, tuple[float, ...]] | None:
    if isinstance(geometry, Box):
        return "wall" if link == "wall" else "box", geometry.size
    if isinstance(geometry, Cylinder):
        return "cylinder", (geometry.radius, geometry.length)
    if isinstance(geometry, Sphere):
        return "sphere", (geometry.radius,)
    if isinstance(geometry, tuple) and len(geometry) == 1 and link == "ramp":
        (x, y), height = np.ptp(np.array(geometry[0].points or [(0.0, 0.0)]), axis=0).tolist(), geometry[0].height
        size = round(x, LENGTH_DIGITS), height, round(y, LENGTH_DIGITS)
        if _is_close(geometry[0].points, make_wedge(size).points):
            return "ramp", size
    return None


def _is_at(pose: RawPose, shape: tuple[ShapeKind, tuple[float, ...]]) -> bool:
    expected_pose = compute_ramp_pose(shape[1]) if shape[0] == "ramp" else AT_ORIGIN.pose
    return not pose.relative_to and _is_close((pose.pose.xyz, pose.pose.rpy), (expected_pose.xyz, expected_pose.rpy))


def _is_close(points: tuple[tuple[float, ...], ...], other_points: tuple[tuple[float, ...], ...]) -> bool:
    return len(points) == len(other_points) and all(
        abs(a - b) <= 1e-6
        for point, other_point in zip(points, other_points, strict=True)
        for a, b in zip(point, other_point, strict=True)
    )


def _find_display_color(material: Material | None) -> Color | None:
    if material is None:
        return None
    look = find_gazebo_look(material.script.name) if material.script else None
    if look is not None:
        material = with_look(material, look)
    return material.diffuse or material.ambient


def is_size(kind: str, size: tuple[float, ...]) -> bool:
    """Return whether dimensions in meters are valid for a kind of shape."""
    return len(size) == SIZE_COUNTS[kind] and all(isfinite(value) and 1e-6 <= value <= 1e6 for value in size)


def make_wedge(size: tuple[float, ...]) -> Polyline:
    """Return the ramp's triangular profile, extruded to the ramp's width.

    The x and y axes of the polyline are the x and z axes of the ramp.
    """
    x, y, z = size
    return Polyline(((-x / 2, -z / 2), (x / 2, -z / 2), (x / 2, z / 2)), y)


def compute_ramp_pose(size: tuple[float, ...]) -> Pose:
    """Return the pose of a ramp's polyline in its link.

    A rotation of 90 degrees about x turns the extrusion from z to the ramp's width.
    """
    return Pose((0.0, size[1] / 2, 0.0), (pi / 2, 0.0, 0.0))


def compute_solid_properties(kind: str, size: tuple[float, ...]) -> MassProperties:
    """Return the mass properties of a solid shape in the frame of its link.

    The density is 1 kg/m3.
    """
    if kind == "cylinder":
        return shape_properties(Cylinder(*size))
    if kind == "sphere":
        return shape_properties(Sphere(*size))
    x, y, z = size
    box = shape_properties(Box((x, y, z)))
    if kind != "ramp":
        return box
    mass = box.mass / 2
    xx, yy, zz, xz = x * x / 18, y * y / 12, z * z / 18, x * z / 36  # second moments of a triangular prism
    inertia = mass * np.array([[yy + zz, 0.0, -xz], [0.0, xx + zz, 0.0], [-xz, 0.0, xx + yy]])
    return MassProperties(mass, np.array([x / 6, 0.0, -z / 6]), inertia)


def format_tensor(properties: MassProperties) -> dict[str, str]:
    """Return the text of each child element of ``<inertia>``, by tag."""
    inertia = properties.inertia
    indices = {"ixx": (0, 0), "ixy": (0, 1), "ixz": (0, 2), "iyy": (1, 1), "iyz": (1, 2), "izz": (2, 2)}
    return {tag: format_number(float(inertia[index])) for tag, index in indices.items()}


def format_number(value: float) -> str:
    """Format a number with six significant digits, as used for masses and inertias."""
    return format_shortest(float(f"{value:.6g}"))


def format_length(value: float) -> str:
    """Format a length or angle, rounded to nine decimals."""
    return format_shortest(round(value, LENGTH_DIGITS))


def format_lengths(values: tuple[float, ...]) -> str:
    """Format lengths or angles, separated by spaces."""
    return " ".join(map(format_length, values))


def make_element(tag: str, *children: Element | str, **attributes: str) -> Element:
    """Return a new element with attributes, and with texts or elements as its children."""
    element = Element(tag, attributes)
    element.children.extend(Text(child) if isinstance(child, str) else child for child in children)
    return element


def make_inertial(kind: str, size: tuple[float, ...], mass: float) -> Element:
    """Return the ``<inertial>`` element of a solid shape with a mass in kg."""
    properties = compute_solid_properties(kind, size).with_mass(mass)
    children = [make_element("mass", format_number(mass))]
    if properties.center.any():
        children.append(make_element("pose", f"{format_lengths(tuple(properties.center.tolist()))} 0 0 0"))
    children.append(
        make_element(
            "inertia", *(make_element(tag, text) for tag, text in format_tensor(properties).items() if text != "0")
        )
    )
    return make_element("inertial", *children)


def make_geometry(kind: str, size: tuple[float, ...]) -> list[Element]:
    """Return the ``<geometry>`` element of a shape, preceded by any required ``<pose>``."""
    if kind == "ramp":
        outline = make_wedge(size)
        points = (make_element("point", format_lengths(point)) for point in outline.points)
        shape = make_element("polyline", *points, make_element("height", format_length(outline.height)))
        pose = compute_ramp_pose(size)
        text = f"{format_lengths(pose.xyz)} {' '.join(map(format_shortest, pose.rpy))}"
        return [make_element("pose", text), make_element("geometry", shape)]
    if kind == "cylinder":
        return [
            make_element(
                "geometry",
                make_element(
                    "cylinder",
                    make_element("radius", format_length(size[0])),
                    make_element("length", format_length(size[1])),
                ),
            )
        ]
    if kind == "sphere":
        return [make_element("geometry", make_element("sphere", make_element("radius", format_length(size[0]))))]
    return [make_element("geometry", make_element("box", make_element("size", format_lengths(size))))]
