"""The language as data: every element and attribute that urdfdom reads, with kind, default, unit and meaning.

The reader explains its errors from this table; linting, hover texts and documentation read the same one. A test holds
the table and the reader together. Source: urdfdom 3.0.1 for URDF 1.0, urdfdom 6.0.0 for 1.1 and 1.2.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

Version = tuple[int, int]

JOINT_TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
JOINT_TYPES_TEXT = ", ".join(JOINT_TYPES)
NEWEST_VERSION: Version = (1, 2)


class Kind(Enum):
    """What an attribute's value must be."""

    TEXT = "text"
    NUMBER = "number"
    VECTOR3 = "3 numbers"
    QUATERNION = "4 numbers"
    RGBA = "4 numbers from 0 to 1"
    JOINT_TYPE = "joint type"
    VERSION = "version"


@dataclass(frozen=True, slots=True)
class AttributeRule:
    """One attribute.

    Attributes:
        name: as written in the file.
        kind: what its value must be.
        meaning: one phrase for hints, hover texts and documentation.
        unit: SI unit, or an empty string.
        required: whether urdfdom refuses the element without it.
        default: the value that stands for an absent one, as text; empty when there is none.
        since: the URDF version that brought it; older files ignore it.
        until: the URDF version that made a required attribute optional, or None.
        usual: whether one writes it although it is not required.
    """

    name: str
    kind: Kind
    meaning: str
    unit: str = ""
    required: bool = False
    default: str = ""
    since: Version = (1, 0)
    until: Version | None = None
    usual: bool = False

    def is_required(self, version: Version) -> bool:
        """Whether a file of this version must give it."""
        return self.required and (self.until is None or version < self.until)


@dataclass(frozen=True, slots=True)
class ElementRule:
    """One element in its place: what it may carry and contain.

    Attributes:
        tag: the element's name.
        meaning: one phrase for hover texts and documentation.
        attributes: in the order documentation lists them.
        children: the elements inside that are read.
        required: whether urdfdom refuses the parent without it.
        many: whether all of them count; otherwise only the first is read.
        since: the URDF version that brought it.
    """

    tag: str
    meaning: str
    attributes: tuple[AttributeRule, ...] = ()
    children: tuple[ElementRule, ...] = ()
    required: bool = False
    many: bool = False
    since: Version = (1, 0)

    def attribute(self, name: str) -> AttributeRule | None:
        """The rule of one attribute, or None."""
        return next((rule for rule in self.attributes if rule.name == name), None)

    def child(self, tag: str) -> ElementRule | None:
        """The rule of one child element, or None."""
        return next((rule for rule in self.children if rule.tag == tag), None)


def _number(
    name: str,
    meaning: str,
    unit: str = "",
    *,
    required: bool = False,
    default: str = "",
    since: Version = (1, 0),
    until: Version | None = None,
    usual: bool = False,
) -> AttributeRule:
    return AttributeRule(name, Kind.NUMBER, meaning, unit, required, default, since, until, usual)


_NAME = AttributeRule("name", Kind.TEXT, "its name, unique among its kind", required=True)
_LABEL = AttributeRule("name", Kind.TEXT, "a name for people and tools")

ORIGIN = ElementRule(
    "origin",
    "where the frame stands in its parent frame; the identity when absent",
    (
        AttributeRule("xyz", Kind.VECTOR3, "translation", "m", default="0 0 0"),
        AttributeRule("rpy", Kind.VECTOR3, "roll, pitch, yaw about the fixed axes x, y, z", "rad", default="0 0 0"),
        AttributeRule("quat_xyzw", Kind.QUATERNION, "rotation as a quaternion, instead of rpy", since=(1, 1)),
    ),
)

_RADIUS = _number("radius", "radius", "m", required=True)

SHAPES = (
    ElementRule(
        "box",
        "a box centred at the origin",
        (AttributeRule("size", Kind.VECTOR3, "edge lengths along x, y, z", "m", required=True),),
    ),
    ElementRule(
        "cylinder",
        "a cylinder along z, centred at the origin",
        (_RADIUS, _number("length", "length along z", "m", required=True)),
    ),
    ElementRule("sphere", "a sphere centred at the origin", (_RADIUS,)),
    ElementRule(
        "capsule",
        "a cylinder along z with a half sphere at each end, centred at the origin",
        (_RADIUS, _number("length", "length of the cylindrical part", "m", required=True)),
        since=(1, 1),
    ),
    ElementRule(
        "mesh",
        "a mesh file",
        (
            AttributeRule("filename", Kind.TEXT, "package://PACKAGE/PATH, file://PATH or a plain path", required=True),
            AttributeRule("scale", Kind.VECTOR3, "factors along x, y, z", default="1 1 1"),
        ),
    ),
)

GEOMETRY = ElementRule("geometry", "the shape; the first element in it counts", children=SHAPES, required=True)

MATERIAL = ElementRule(
    "material",
    "a colour, a texture, or the name of a material defined elsewhere",
    (AttributeRule("name", Kind.TEXT, "the name others refer to it by", required=True),),
    (
        ElementRule(
            "color",
            "the colour",
            (AttributeRule("rgba", Kind.RGBA, "red, green, blue, alpha", default="0 0 0 1"),),
        ),
        ElementRule("texture", "an image", (AttributeRule("filename", Kind.TEXT, "its URI"),)),
    ),
)

MASS = ElementRule("mass", "the mass", (_number("value", "the mass", "kg", required=True),), required=True)

INERTIA = ElementRule(
    "inertia",
    "the inertia tensor about the centre of mass, in the axes of the inertial frame",
    tuple(
        _number(name, f"the {name[1:]} component", "kg m2", required=True)
        for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    ),
    required=True,
)

INERTIAL = ElementRule("inertial", "mass properties; none when absent", children=(ORIGIN, MASS, INERTIA))
VISUAL = ElementRule("visual", "a shape to draw", (_LABEL,), (ORIGIN, GEOMETRY, MATERIAL), many=True)
COLLISION = ElementRule("collision", "a shape for contacts", (_LABEL,), (ORIGIN, GEOMETRY), many=True)
LINK = ElementRule("link", "a rigid body", (_NAME,), (INERTIAL, VISUAL, COLLISION), many=True)

AXIS = ElementRule(
    "axis",
    "the direction of motion in the joint frame, the normal for a planar joint; 1 0 0 when absent",
    (AttributeRule("xyz", Kind.VECTOR3, "the direction", default="0 0 0"),),
)

LIMIT = ElementRule(
    "limit",
    "the bounds of motion; revolute and prismatic joints need them",
    (
        _number("lower", "lowest position", "rad or m", default="0", usual=True),
        _number("upper", "highest position", "rad or m", default="0", usual=True),
        _number("effort", "greatest torque or force", "N m or N", required=True, until=(1, 2)),
        _number("velocity", "greatest speed", "rad/s or m/s", required=True, until=(1, 2)),
        _number("acceleration", "greatest acceleration", "rad/s2 or m/s2", since=(1, 2)),
        _number("deceleration", "greatest deceleration; the acceleration when absent", "rad/s2 or m/s2", since=(1, 2)),
        _number("jerk", "greatest jerk", "rad/s3 or m/s3", since=(1, 2)),
    ),
)

SAFETY = ElementRule(
    "safety_controller",
    "gains and soft limits of a safety controller",
    (
        _number("k_velocity", "effort per velocity error", "N m s/rad or N s/m", required=True),
        _number("k_position", "velocity per position error", "1/s", default="0"),
        _number("soft_lower_limit", "where it starts to act, below", "rad or m", default="0"),
        _number("soft_upper_limit", "where it starts to act, above", "rad or m", default="0"),
    ),
)

CALIBRATION = ElementRule(
    "calibration",
    "reference positions",
    (
        _number("rising", "where the reference signal rises", "rad or m"),
        _number("falling", "where the reference signal falls", "rad or m"),
    ),
)

MIMIC = ElementRule(
    "mimic",
    "follow another joint: multiplier * its position + offset",
    (
        AttributeRule("joint", Kind.TEXT, "the joint to follow", required=True),
        _number("multiplier", "factor on its position", default="1"),
        _number("offset", "added to it", "rad or m", default="0"),
    ),
)

DYNAMICS = ElementRule(
    "dynamics",
    "damping, friction, or both",
    (
        _number("damping", "viscous damping", "N m s/rad or N s/m", default="0"),
        _number("friction", "static friction", "N m or N", default="0"),
    ),
)

PARENT = ElementRule(
    "parent",
    "the link it hangs from",
    (AttributeRule("link", Kind.TEXT, "the link's name", required=True),),
    required=True,
)

CHILD = ElementRule(
    "child",
    "the link it moves",
    (AttributeRule("link", Kind.TEXT, "the link's name", required=True),),
    required=True,
)

JOINT = ElementRule(
    "joint",
    "a connection of two links",
    (_NAME, AttributeRule("type", Kind.JOINT_TYPE, JOINT_TYPES_TEXT, required=True)),
    (ORIGIN, PARENT, CHILD, AXIS, LIMIT, SAFETY, CALIBRATION, MIMIC, DYNAMICS),
    many=True,
)

ROBOT = ElementRule(
    "robot",
    "a robot description",
    (
        AttributeRule("name", Kind.TEXT, "the robot's name", required=True),
        AttributeRule("version", Kind.VERSION, "the URDF version, 1.0 to 1.2", default="1.0"),
    ),
    (ElementRule("material", MATERIAL.meaning, MATERIAL.attributes, MATERIAL.children, many=True), LINK, JOINT),
)
