"""The compared properties of links and joints, each with its location."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from math import sqrt

from linkwright.geometry.shapes import Box, Sphere
from linkwright.geometry.single import Pose, pose_quaternion
from linkwright.loading.lean_dataclasses import dataclass, field
from linkwright.urdf import Geometry, Inertial, Joint, Link, Mesh, Visual
from linkwright.urdf.model import Collision
from linkwright.xmltree import Element

LENGTH_TOLERANCE = 1e-6
"""The difference in meters up to which lengths are equal."""
ROTATION_TOLERANCE = 5e-6
"""The angle in radians up to which rotations, and directions of axes, are equal, such as 3.14159 and pi."""
RELATIVE_TOLERANCE = 1e-6
"""The difference up to which other numbers are equal, as a fraction of the larger magnitude."""

COLOR_TOLERANCE = 0.5 / 255
"""The difference up to which color channels from 0 to 1 are equal: half a step of images with 8 bits."""

MATERIAL = "material"
"""The name of the fact about the name of a material."""
_COLOR = "color rgba"

Normalize = Callable[[str], str]


@dataclass(frozen=True, slots=True)
class Fact:
    """A property of a link or joint.

    Attributes:
        words: the text of the property, such as a name or the kind of a shape; empty for numbers alone.
        numbers: the numbers of the property, in SI units.
        unit: the unit of the numbers.
        rotation: the quaternion (x, y, z, w) of the numbers, if they are roll, pitch and yaw.
        is_direction: whether the numbers are an axis, whose length does not matter.
        min_tolerance: the difference up to which small numbers are equal, too.
        element: the element with the property or, for a default, the nearest enclosing element.
        attribute: the name of the element's attribute with the property.
    """

    words: str
    numbers: tuple[float, ...]
    unit: str
    element: Element | None
    attribute: str
    rotation: tuple[float, ...] = ()
    is_direction: bool = False
    min_tolerance: float = 0.0

    def equals(self, other: Fact, normalize: Normalize, normalize_other: Normalize) -> bool:
        """Return whether a property is equal in two descriptions, within the tolerances.

        Args:
            other: the property of the other description.
            normalize: the function that makes texts of this description comparable.
            normalize_other: the function that makes texts of the other description comparable.
        """
        if normalize(self.words) != normalize_other(other.words) or len(self.numbers) != len(other.numbers):
            return False
        if self.rotation:
            return _compute_angle(self.rotation, other.rotation) <= ROTATION_TOLERANCE
        if self.is_direction:
            return _compute_distance(_unit_vector(self.numbers), _unit_vector(other.numbers)) <= ROTATION_TOLERANCE
        return all(map(self._is_close, self.numbers, other.numbers))

    def _is_close(self, value: float, other_value: float) -> bool:
        if value == other_value:
            return True
        min_tolerance = LENGTH_TOLERANCE if self.unit == "m" else self.min_tolerance
        return abs(value - other_value) <= max(min_tolerance, RELATIVE_TOLERANCE * max(abs(value), abs(other_value)))

    @property
    def text(self) -> str:
        """The text and the numbers of the property, without the unit."""
        return " ".join(filter(None, (self.words, *(f"{number:.9g}" for number in self.numbers))))


@dataclass(slots=True)
class Block:
    """Properties that are added or removed together, such as those in an ``<inertial>``.

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

    def equals(self, other: Block, normalize: Normalize, normalize_other: Normalize) -> bool:
        """Return whether all facts of two blocks are equal."""
        return self.facts.keys() == other.facts.keys() and all(
            fact.equals(other.facts[name], normalize, normalize_other) for name, fact in self.facts.items()
        )

    def has_color_of(self, other: Block) -> bool:
        """Return whether two visuals have colors, and the same one."""
        color, other_color = self.facts.get(_COLOR), other.facts.get(_COLOR)
        return color is not None and other_color is not None and color.equals(other_color, str, str)

    def number(self, name: str, value: float | None, unit: str, element: Element | None, attribute: str) -> None:
        """Add a property with one number, unless the number is None."""
        if value is not None:
            self.facts[name] = Fact("", (value,), unit, element, attribute)

    def words(self, name: str, value: str, element: Element | None, attribute: str) -> None:
        """Add a property with a text, unless the text is empty."""
        if value:
            self.facts[name] = Fact(value, (), "", element, attribute)

    def origin(self, pose: Pose, parent_element: Element | None) -> None:
        """Add the position and rotation of a frame relative to its parent frame."""
        element = nearest(parent_element, "origin")
        attribute = "rpy" if pose.quaternion is None else "quat_xyzw"
        self.facts["origin xyz"] = Fact("", pose.xyz, "m", element, "xyz")
        self.facts["origin rpy"] = Fact("", pose.rpy, "rad", element, attribute, pose_quaternion(pose))


def nearest(element: Element | None, *tags: str) -> Element | None:
    """Return the descendant at the end of a path of tags, or the last existing one on the path.

    Without an element, the result is None.
    """
    for tag in tags:
        child = None if element is None else element.first(tag)
        if child is None:
            break
        element = child
    return element


def link_blocks(link: Link) -> list[Block]:
    """Return the properties of a link, except the properties of its shapes."""
    return [] if link.inertial is None else [_make_inertial_block(link.inertial)]


def visual_blocks(link: Link) -> list[Block]:
    """Return the properties of each ``<visual>`` of a link."""
    return [_make_visual_block(visual) for visual in link.visuals]


def collision_blocks(link: Link) -> list[Block]:
    """Return the properties of each ``<collision>`` of a link."""
    return [_make_shape_block("collision", collision) for collision in link.collisions]


def joint_blocks(joint: Joint) -> list[Block]:
    """Return the properties of a joint, one block for each element with properties."""
    element = joint.element
    own_block = Block("", element)
    own_block.words("type", joint.type, element, "type")
    own_block.words("parent", joint.parent, nearest(element, "parent"), "link")
    own_block.words("child", joint.child, nearest(element, "child"), "link")
    own_block.origin(joint.origin, element)
    if joint.type not in ("fixed", "floating"):
        own_block.facts["axis"] = Fact("", joint.axis, "", nearest(element, "axis"), "xyz", is_direction=True)
    unit = "m" if joint.type == "prismatic" else "rad"
    force = "N" if joint.type == "prismatic" else "N m"
    units = {"lower": unit, "upper": unit, "effort": force, "velocity": f"{unit}/s"}
    units |= {"acceleration": f"{unit}/s2", "deceleration": f"{unit}/s2", "jerk": f"{unit}/s3"}
    units |= {"multiplier": "", "offset": unit, "soft_lower_limit": unit, "soft_upper_limit": unit}
    units |= {"k_position": "", "k_velocity": "", "rising": unit, "falling": unit}
    units |= {"damping": f"{force} s/{unit}", "friction": force}
    blocks = [own_block]
    for tag, value in (
        ("limit", joint.limit),
        ("mimic", joint.mimic),
        ("safety_controller", joint.safety),
        ("dynamics", joint.dynamics),
        ("calibration", joint.calibration),
    ):
        if value is None:
            continue
        child = nearest(element, tag)
        block = Block(tag, child)
        if joint.mimic is not None and tag == "mimic":
            block.words("joint", joint.mimic.joint, child, "joint")
        for name in units:
            is_unlimited = joint.type == "continuous" and name in ("lower", "upper")
            if is_unlimited and (child is None or name not in child.attributes):
                continue  # without the attribute, the position has no limit, and not the limit 0
            block.number(name, getattr(value, name, None), units[name], child, name)
        blocks.append(block)
    return blocks


def _make_inertial_block(inertial: Inertial) -> Block:
    block = Block("inertial", inertial.element)
    block.number("mass", inertial.mass, "kg", nearest(inertial.element, "mass"), "value")
    block.origin(inertial.origin, inertial.element)
    tensor = nearest(inertial.element, "inertia")
    for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"):
        block.number(f"inertia {name}", getattr(inertial, name), "kg m2", tensor, name)
    return block


def _make_visual_block(visual: Visual) -> Block:
    block = _make_shape_block("visual", visual)
    element, material = nearest(visual.element, "material"), visual.material
    block.words(MATERIAL, visual.material_name, element, "name")
    if material is not None and material.rgba is not None:
        child = nearest(material.element, "color")
        block.facts[_COLOR] = Fact("", material.rgba, "", child or element, "rgba", min_tolerance=COLOR_TOLERANCE)
    if material is not None and material.texture:
        child = nearest(material.element, "texture")
        block.words("texture", material.texture, child or element, "filename")
    return block


def _make_shape_block(tag: str, shape: Visual | Collision) -> Block:
    block = Block(tag, shape.element, label=shape.name)
    block.origin(shape.origin, shape.element)
    block.facts["geometry"] = _make_geometry_fact(shape.geometry, shape.element)
    return block


def _make_geometry_fact(geometry: Geometry, shape_element: Element | None) -> Fact:
    kind = type(geometry).__name__.lower()
    element = nearest(shape_element, "geometry", kind)
    if isinstance(geometry, Mesh):
        scale = () if geometry.scale == (1.0, 1.0, 1.0) else geometry.scale
        return Fact(" ".join([kind, geometry.filename, *(["scale"] if scale else [])]), scale, "", element, "filename")
    if isinstance(geometry, Box):
        return Fact(kind, geometry.size, "m", element, "size")
    if isinstance(geometry, Sphere):
        return Fact(f"{kind} radius", (geometry.radius,), "m", element, "radius")
    return Fact(f"{kind} radius, length", (geometry.radius, geometry.length), "m", element, "radius")


def match_blocks(
    old: Sequence[Block], new: Sequence[Block], is_same: Callable[[Block, Block], bool]
) -> list[tuple[int | None, int | None]]:
    """Match visuals or collisions by equality, then by name, then by order.

    Returns:
        Pairs of an index in `old` and an index in `new`. An entry without a match is paired with None.
    """
    old_indexes, new_indexes = list(range(len(old))), list(range(len(new)))
    pairs: list[tuple[int | None, int | None]] = []

    def pair(matches: Callable[[int, int], bool]) -> None:
        for old_index in tuple(old_indexes):
            new_index = next((candidate for candidate in new_indexes if matches(old_index, candidate)), None)
            if new_index is not None:
                old_indexes.remove(old_index)
                new_indexes.remove(new_index)
                pairs.append((old_index, new_index))

    pair(lambda before, after: is_same(old[before], new[after]))
    pair(lambda before, after: old[before].label != "" and old[before].label == new[after].label)
    pair(lambda _old_index, _new_index: True)
    return [
        *sorted(pairs, key=lambda item: item[1] or 0),
        *((index, None) for index in old_indexes),
        *((None, value) for value in new_indexes),
    ]


def _compute_angle(rotation: Sequence[float], other_rotation: Sequence[float]) -> float:
    """Return the angle between two rotations in radians, accurate even for small angles."""
    return 2.0 * min(
        _compute_distance(rotation, other_rotation),
        _compute_distance(rotation, [-component for component in other_rotation]),
    )


def _unit_vector(vector: Sequence[float]) -> tuple[float, ...]:
    length = sqrt(sum(value * value for value in vector))
    return tuple(value / length for value in vector) if length > 0.0 else tuple(vector)


def _compute_distance(vector: Iterable[float], other_vector: Iterable[float]) -> float:
    return sqrt(sum((a - b) ** 2 for a, b in zip(vector, other_vector, strict=True)))
