"""Write the lines about added links, with the joints that attach them, and about other added joints."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence

from linkwright.descriptions.comparison import Difference
from linkwright.diagnostics import Phrase, joined, phrase, term
from linkwright.urdf import Box, Geometry, Joint, Link, Mesh, Robot, Sphere, Visual

_MAX_LINKS = 4
"""The maximum number of added links that each have a line of their own."""

_TYPES_WITHOUT_AXIS = ("fixed", "floating")
_DEFAULT_AXIS = (1.0, 0.0, 0.0)


class AddedLinks:
    """The added links and joints of a robot.

    Args:
        differences: the differences of the robots.
        new: the robot of the new version.
    """

    def __init__(self, differences: Sequence[Difference], new: Robot) -> None:
        added = {(difference.subject, difference.name) for difference in differences if difference.kind == "added"}
        links = [name for subject, name in added if subject == "link"]
        self._links = {} if len(links) > _MAX_LINKS else {name: new.links[name] for name in links if name in new.links}
        self._joints = {
            joint.child: joint
            for joint in new.joints.values()
            if joint.child in self._links and ("joint", joint.name) in added
        }
        self._joints_of_old_links = {
            joint.name: joint
            for joint in new.joints.values()
            if ("joint", joint.name) in added and ("link", joint.child) not in added
        }

    def is_in_line_of_link(self, difference: Difference) -> bool:
        """Return whether the line about an added link already names an added joint."""
        is_joint = (difference.subject, difference.kind) == ("joint", "added")
        return is_joint and any(joint.name == difference.name for joint in self._joints.values())

    def sentence(self, difference: Difference) -> Phrase | None:
        """Return the line about an added link or joint with its contents; None for other differences."""
        if difference.subject == "joint" and difference.kind == "added":
            joint = self._joints_of_old_links.get(difference.name)
            return None if joint is None else _format_joint_of_old_link(joint)
        link = self._links.get(difference.name)
        if link is None or (difference.subject, difference.kind) != ("link", "added"):
            return None
        parts = [*self._format_joint(link.name), *_format_link(link)]
        text = phrase("{subject} '{name}' added", subject=term("link"), name=link.name)
        return phrase("{change}: {contents}", change=text, contents=joined(parts)) if parts else text

    def _format_joint(self, name: str) -> Iterator[Phrase]:
        joint = self._joints.get(name)
        if joint is not None:
            yield phrase(
                "{type} joint '{joint}' at '{parent}', xyz {xyz} m",
                type=joint.type,
                joint=joint.name,
                parent=joint.parent,
                xyz=_format_position(joint),
            )
            yield from _format_directions(joint)


def _format_joint_of_old_link(joint: Joint) -> Phrase:
    """Return the line about an added joint that attaches a link of both versions."""
    text = phrase("{subject} '{name}' added", subject=term("joint"), name=joint.name)
    contents = phrase(
        "{type}, link '{child}' at '{parent}', xyz {xyz} m",
        type=joint.type,
        child=joint.child,
        parent=joint.parent,
        xyz=_format_position(joint),
    )
    return phrase("{change}: {contents}", change=text, contents=joined([contents, *_format_directions(joint)]))


def _format_position(joint: Joint) -> str:
    return " ".join(f"{number:.6g}" for number in joint.origin.xyz)


def _format_directions(joint: Joint) -> Iterator[Phrase]:
    """Yield the rotation of a joint, and its axis if it is not the default one."""
    if any(joint.origin.rpy):
        angles = " ".join(f"{_to_degrees(angle):g}" for angle in joint.origin.rpy)
        yield phrase("rpy {angles}°", angles=angles)
    if joint.type not in _TYPES_WITHOUT_AXIS and joint.axis != _DEFAULT_AXIS:
        yield phrase("axis {axis}", axis=" ".join(f"{number:.6g}" for number in joint.axis))


def _format_link(link: Link) -> Iterator[Phrase]:
    """Yield the shapes and the mass of a link."""
    for shape, count in Counter(map(_format_visual, link.visuals)).items():
        yield _add_count(phrase("visual {shape}", shape=shape), count)
    for shape, count in Counter(_format_shape(collision.geometry) for collision in link.collisions).items():
        yield _add_count(phrase("collision {shape}", shape=shape), count)
    if link.inertial is not None and link.inertial.has_mass:
        yield phrase("mass {mass:.4g} kg", mass=link.inertial.properties.mass)
        if not link.inertial.properties.inertia.any():
            yield phrase("inertia zero")


def _to_degrees(angle: float) -> float:
    """Return an angle in degrees, rounded to an integer if it was written with a rounded pi."""
    return round(math.degrees(angle), 2) + 0.0


def _add_count(part: Phrase, count: int) -> Phrase:
    return part if count == 1 else phrase("{part} ({count} times)", part=part, count=count)


def _format_visual(visual: Visual) -> str:
    """Return the shape of a visual, with its material and the color of it."""
    material = visual.material
    color = "" if material is None or material.rgba is None else " ".join(f"{value:g}" for value in material.rgba)
    words = [_format_shape(visual.geometry), "material" if visual.material_name else "", visual.material_name, color]
    return " ".join(filter(None, words))


def _format_shape(geometry: Geometry) -> str:
    if isinstance(geometry, Mesh):
        return f"mesh {geometry.filename}"
    if isinstance(geometry, Box):
        sizes: tuple[float, ...] = geometry.size
    elif isinstance(geometry, Sphere):
        sizes = (geometry.radius,)
    else:
        sizes = geometry.radius, geometry.length
    return " ".join([type(geometry).__name__.lower(), *(f"{size:.6g}" for size in sizes)])
