"""The compared properties of links and joints, each with its location."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import sqrt

from linkwright.geometry.shapes import Box, Sphere
from linkwright.geometry.single import Pose, quaternion_of
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.urdf import Geometry, Inertial, Joint, Link, Mesh, Visual
from linkwright.urdf.model import Collision
from linkwright.xmltree import Element

LENGTH_TOLERANCE = 1e-6
"""Metres; lengths that differ by no more are the same."""
ROTATION_TOLERANCE = 1e-6
"""Radians; rotations, and directions of axes, with no more between them are the same."""
RELATIVE_TOLERANCE = 1e-6
"""All other numbers are the same when they differ by no more than this part of the greater one."""

Normalize = Callable[[str], str]


@dataclass(frozen=True, slots=True)
class Fact:
    """A property of a link or joint.

    Attributes:
        words: the text of the property, such as a name or the kind of a shape; empty for numbers alone.
        numbers: the numbers of the property, in SI units.
        unit: the unit of the numbers.
        rotation: the quaternion (x, y, z, w) of the numbers, if they are roll, pitch and yaw.
        direction: whether the numbers are an axis, whose length does not matter.
        element: the element with the property or, for a default, the nearest enclosing element.
        attribute: the name of the element's attribute with the property.
    """

    words: str
    numbers: tuple[float, ...]
    unit: str
    element: Element | None
    attribute: str
    rotation: tuple[float, ...] = ()
    direction: bool = False

    def equals(self, other: Fact, here: Normalize, there: Normalize) -> bool:
        """Return whether a property is equal in two descriptions, within the tolerances.

        Args:
            other: the property of the other description.
            here: the function that makes texts of this description comparable.
            there: the function that makes texts of the other description comparable.
        """
        if here(self.words) != there(other.words) or len(self.numbers) != len(other.numbers):
            return False
        if self.rotation:
            return _angle(self.rotation, other.rotation) <= ROTATION_TOLERANCE
        if self.direction:
            return _distance(_unit(self.numbers), _unit(other.numbers)) <= ROTATION_TOLERANCE
        return all(map(self._near, self.numbers, other.numbers))

    def _near(self, ours: float, theirs: float) -> bool:
        if ours == theirs:
            return True
        least = LENGTH_TOLERANCE if self.unit == "m" else 0.0
        return abs(ours - theirs) <= max(least, RELATIVE_TOLERANCE * max(abs(ours), abs(theirs)))

    @property
    def text(self) -> str:
        """The text and the numbers of the property, without the unit."""
        return " ".join(filter(None, (self.words, *(f"{number:.9g}" for number in self.numbers))))


@dataclass(slots=True)
class Block:
    """Properties that are added or removed together, such as those of an ``<inertial>``.

    Attributes:
        name: the tag; empty for the properties that every joint has.
        element: the element that contains the properties.
        facts: the facts, by the name of the property.
        label: the name of the block in the description.
    """

    name: str
    element: Element | None
    facts: dict[str, Fact] = field(default_factory=dict)
    label: str = ""

    @property
    def text(self) -> str:
        """All facts in one line, with their units."""
        return ", ".join(" ".join(filter(None, (name, fact.text, fact.unit))) for name, fact in self.facts.items())

    def equals(self, other: Block, here: Normalize, there: Normalize) -> bool:
        """Return whether all facts of two blocks are equal."""
        return self.facts.keys() == other.facts.keys() and all(
            fact.equals(other.facts[name], here, there) for name, fact in self.facts.items()
        )

    def number(self, name: str, value: float | None, unit: str, element: Element | None, attribute: str) -> None:
        """Add a property with one number; None is ignored."""
        if value is not None:
            self.facts[name] = Fact("", (value,), unit, element, attribute)

    def words(self, name: str, value: str, element: Element | None, attribute: str) -> None:
        """Add a property with a text; an empty text is ignored."""
        if value:
            self.facts[name] = Fact(value, (), "", element, attribute)

    def origin(self, pose: Pose, around: Element | None) -> None:
        """Add the position and rotation of a frame relative to its parent frame."""
        element = nearest(around, "origin")
        attribute = "rpy" if pose.quaternion is None else "quat_xyzw"
        self.facts["origin xyz"] = Fact("", pose.xyz, "m", element, "xyz")
        self.facts["origin rpy"] = Fact("", pose.rpy, "rad", element, attribute, quaternion_of(pose))


def nearest(element: Element | None, *tags: str) -> Element | None:
    """Return the descendant at the end of a path of tags, or the last one that exists."""
    for tag in tags:
        inner = None if element is None else element.first(tag)
        if inner is None:
            break
        element = inner
    return element


def blocks_of_link(link: Link) -> list[Block]:
    """Return the properties of a link, except those of its shapes."""
    return [] if link.inertial is None else [_inertial(link.inertial)]


def visuals_of(link: Link) -> list[Block]:
    """Return the properties of each ``<visual>`` of a link."""
    return [_visual(visual) for visual in link.visuals]


def collisions_of(link: Link) -> list[Block]:
    """Return the properties of each ``<collision>`` of a link."""
    return [_shape("collision", collision) for collision in link.collisions]


def blocks_of_joint(joint: Joint) -> list[Block]:
    """Return the properties of a joint, one block for each element with properties."""
    element = joint.element
    own = Block("", element)
    own.words("type", joint.type, element, "type")
    own.words("parent", joint.parent, nearest(element, "parent"), "link")
    own.words("child", joint.child, nearest(element, "child"), "link")
    own.origin(joint.origin, element)
    if joint.type not in ("fixed", "floating"):
        own.facts["axis"] = Fact("", joint.axis, "", nearest(element, "axis"), "xyz", direction=True)
    unit = "m" if joint.type == "prismatic" else "rad"
    force = "N" if joint.type == "prismatic" else "N m"
    per = {"lower": unit, "upper": unit, "effort": force, "velocity": f"{unit}/s"}
    per |= {"acceleration": f"{unit}/s2", "deceleration": f"{unit}/s2", "jerk": f"{unit}/s3"}
    per |= {"multiplier": "", "offset": unit, "soft_lower_limit": unit, "soft_upper_limit": unit}
    per |= {"k_position": "", "k_velocity": "", "rising": unit, "falling": unit}
    per |= {"damping": f"{force} s/{unit}", "friction": force}
    found = [own]
    for tag, part in (
        ("limit", joint.limit),
        ("mimic", joint.mimic),
        ("safety_controller", joint.safety),
        ("dynamics", joint.dynamics),
        ("calibration", joint.calibration),
    ):
        if part is None:
            continue
        inner = nearest(element, tag)
        block = Block(tag, inner)
        if joint.mimic is not None and tag == "mimic":
            block.words("joint", joint.mimic.joint, inner, "joint")
        for name in per:
            block.number(name, getattr(part, name, None), per[name], inner, name)
        found.append(block)
    return found


def _inertial(inertial: Inertial) -> Block:
    block = Block("inertial", inertial.element)
    block.number("mass", inertial.mass, "kg", nearest(inertial.element, "mass"), "value")
    block.origin(inertial.origin, inertial.element)
    tensor = nearest(inertial.element, "inertia")
    for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        block.number(f"inertia {name}", getattr(inertial, name), "kg m2", tensor, name)
    return block


def _visual(visual: Visual) -> Block:
    block = _shape("visual", visual)
    element, material = nearest(visual.element, "material"), visual.material
    block.words("material", visual.material_name, element, "name")
    if material is not None and material.rgba is not None:
        where = nearest(material.element, "color")
        block.facts["color rgba"] = Fact("", material.rgba, "", where or element, "rgba")
    if material is not None and material.texture:
        where = nearest(material.element, "texture")
        block.words("texture", material.texture, where or element, "filename")
    return block


def _shape(tag: str, shape: Visual | Collision) -> Block:
    block = Block(tag, shape.element, label=shape.name)
    block.origin(shape.origin, shape.element)
    block.facts["geometry"] = _geometry(shape.geometry, shape.element)
    return block


def _geometry(geometry: Geometry, around: Element | None) -> Fact:
    kind = type(geometry).__name__.lower()
    element = nearest(around, "geometry", kind)
    if isinstance(geometry, Mesh):
        scale = () if geometry.scale == (1.0, 1.0, 1.0) else geometry.scale
        return Fact(" ".join([kind, geometry.filename, *(["scale"] if scale else [])]), scale, "", element, "filename")
    if isinstance(geometry, Box):
        return Fact(kind, geometry.size, "m", element, "size")
    if isinstance(geometry, Sphere):
        return Fact(f"{kind} radius", (geometry.radius,), "m", element, "radius")
    return Fact(f"{kind} radius, length", (geometry.radius, geometry.length), "m", element, "radius")


def pairs_of(
    old: Sequence[Block], new: Sequence[Block], same: Callable[[Block, Block], bool]
) -> list[tuple[int | None, int | None]]:
    """Match visuals or collisions: first equal ones, then by name, then by order.

    Returns:
        Pairs of an index in `old` and an index in `new`. An entry without a match is paired with None.
    """
    left, right = list(range(len(old))), list(range(len(new)))
    found: list[tuple[int | None, int | None]] = []

    def pair(matches: Callable[[int, int], bool]) -> None:
        for before in tuple(left):
            after = next((value for value in right if matches(before, value)), None)
            if after is not None:
                left.remove(before)
                right.remove(after)
                found.append((before, after))

    pair(lambda before, after: same(old[before], new[after]))
    pair(lambda before, after: old[before].label != "" and old[before].label == new[after].label)
    pair(lambda _before, _after: True)
    return [
        *sorted(found, key=lambda item: item[1] or 0),
        *((value, None) for value in left),
        *((None, value) for value in right),
    ]


def _angle(ours: Sequence[float], theirs: Sequence[float]) -> float:
    """Return the angle between two rotations in radians, accurate even if it is small."""
    return 2.0 * min(_distance(ours, theirs), _distance(ours, [-their for their in theirs]))


def _unit(vector: Sequence[float]) -> tuple[float, ...]:
    length = sqrt(sum(value * value for value in vector))
    return tuple(value / length for value in vector) if length > 0.0 else tuple(vector)


def _distance(ours: Iterable[float], theirs: Iterable[float]) -> float:
    return sqrt(sum((a - b) ** 2 for a, b in zip(ours, theirs, strict=True)))
