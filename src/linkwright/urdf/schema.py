"""URDF as data: the elements and attributes that urdfdom reads, with types and meanings.

The table also has defaults, units and checks. The reader, the writer, error hints, hover texts, documentation and
linting all use this table. Sources: urdfdom 3.0.1 for URDF 1.0, urdfdom 6.0.0 for 1.1 and 1.2.

The functions here are rules of urdfdom that the table cannot express. Each function receives a parsed value, reports
mistakes other than its syntax, and returns the value to use.
"""

from __future__ import annotations

from math import inf, sqrt

from linkwright.diagnostics import phrase
from linkwright.geometry.shapes import Box, Capsule, Cylinder, Sphere
from linkwright.geometry.single import IDENTITY_POSE, Pose, Quaternion, Vector3, rpy_from_quaternion
from linkwright.loading.lean_dataclasses import replace
from linkwright.loading.lean_typing import Any
from linkwright.schema.reading import UNREADABLE
from linkwright.schema.rules import AttributeRule, ElementRule, Version
from linkwright.urdf.model import (
    Calibration,
    Collision,
    Dynamics,
    Geometry,
    Inertial,
    Joint,
    Limit,
    Material,
    Mesh,
    Mimic,
    Robot,
    Safety,
)
from linkwright.urdf.report import Findings, describe_owner
from linkwright.urdf.values import (
    JOINT_TYPE,
    JOINT_TYPES_TEXT,
    NUMBER,
    QUATERNION,
    RGBA,
    TEXT,
    VECTOR3,
    VERSION,
    degrees_hint,
    looks_like_degrees,
    number,
    numbers,
)
from linkwright.xmltree import Element

_ROUNDING = 1e-15
_SIZE_ATTRIBUTES = ("size", "radius", "length")
_UNSIGNED_ATTRIBUTES = ("effort", "velocity", "acceleration", "deceleration", "jerk")


def pose_of(xyz: Vector3, rpy: Vector3, quaternion: Quaternion | None) -> Pose:
    """Return the pose of an ``<origin>``.

    A quaternion takes precedence over `rpy`. It is normalized, and a zero quaternion is the identity.
    """
    if quaternion is None:
        return Pose(xyz, rpy)
    norm = sqrt(sum(component * component for component in quaternion))
    if abs(norm - 1) < _ROUNDING:
        norm = 1.0  # keeps the exact values of a quaternion of unit length
    x, y, z, w = (part / norm for part in quaternion) if norm > 0 else (0.0, 0.0, 0.0, 1.0)
    return Pose(xyz, rpy_from_quaternion((x, y, z, w)), (x, y, z, w))


def check_origin(pose: Pose, element: Element, owner: Element, findings: Findings) -> Any:
    """Check that only one kind of rotation is given, and that angles are not in degrees."""
    if pose.quaternion is not None:
        if "rpy" not in element.attributes:
            return pose
        message = phrase("<origin> of {owner} has both 'rpy' and 'quat_xyzw'", owner=describe_owner(owner))
        findings.error("URDF170", message, element, "quat_xyzw", hint=phrase("keep one of them"))
        return UNREADABLE
    roll, pitch, yaw = pose.rpy
    if -10 < roll < 10 and -10 < pitch < 10 and -10 < yaw < 10:
        return pose
    if looks_like_degrees(roll, pitch, yaw) and "quat_xyzw" not in element.attributes:
        message = phrase(
            "'rpy' in <origin> of {owner} looks like degrees: '{rpy}'",
            owner=describe_owner(owner),
            rpy=element.attributes["rpy"],
        )
        findings.warning("URDF190", message, element, "rpy", hint=degrees_hint(roll, pitch, yaw))
    return pose


def check_sizes(geometry: Geometry, shape: Element, owner: Element, findings: Findings) -> Any:
    """Check that every size is positive, as URDF 1.2 requires.

    Older versions accept any size.
    """
    if findings.version < (1, 2):
        return geometry
    is_valid = True
    for name in _SIZE_ATTRIBUTES:
        value = shape.attributes.get(name)
        if value is not None and shape.tag != "mesh" and min(numbers(value)) <= 0:
            is_valid = False
            message = phrase(
                "'{name}' in <{tag}> of {owner} is not above zero: '{value}'",
                name=name,
                tag=shape.tag,
                owner=describe_owner(owner),
                value=value,
            )
            findings.error("URDF123", message, shape, name, hint=phrase("give a size above zero, as URDF 1.2 requires"))
    return geometry if is_valid else UNREADABLE


def check_link_name(link_names: tuple[str], element: Element, owner: Element, findings: Findings) -> tuple[str]:
    """Check that the name of a joint's parent or child link is not empty."""
    if not link_names[0]:
        message = phrase("'link' in <{tag}> of {owner} is empty", tag=element.tag, owner=describe_owner(owner))
        findings.error("URDF124", message, element, "link", hint=phrase("give the name of a link"))
    return link_names


def check_dynamics(dynamics: Dynamics, element: Element, owner: Element, findings: Findings) -> Any:
    """Check that at least one of damping and friction is set."""
    if "damping" in element.attributes or "friction" in element.attributes:
        return dynamics
    message = phrase("<dynamics> of {owner} has neither 'damping' nor 'friction'", owner=describe_owner(owner))
    hint = phrase('add damping="..." or friction="...", or remove <dynamics>')
    findings.error("URDF120", message, element, hint=hint)
    return UNREADABLE


def check_limit(limit: Limit, element: Element, owner: Element, findings: Findings) -> Limit:
    """Check that bounds are ordered and magnitudes not negative, as URDF 1.2 requires.

    In the result, a missing deceleration is equal to the acceleration.
    """
    if findings.version < (1, 2):
        return limit
    attributes = element.attributes
    if limit.upper < limit.lower:
        message = phrase(
            "'upper' in <limit> of {owner} is below 'lower': '{upper}'",
            owner=describe_owner(owner),
            upper=attributes["upper"],
        )
        findings.error("URDF123", message, element, "upper", hint=phrase("exchange the two values"))
    for name in _UNSIGNED_ATTRIBUTES:
        if name in attributes and number(attributes[name]) < 0:
            message = phrase(
                "'{name}' in <limit> of {owner} is negative: '{value}'",
                name=name,
                owner=describe_owner(owner),
                value=attributes[name],
            )
            findings.error("URDF123", message, element, name, hint=phrase("give its magnitude, without a sign"))
    return limit if limit.deceleration is not None else replace(limit, deceleration=limit.acceleration)


NEWEST_VERSION: Version = (1, 2)


def _number_attribute(name: str, meaning: str, unit: str = "", **details: Any) -> AttributeRule:
    return AttributeRule(name, NUMBER, meaning, unit, **details)


_NAME = AttributeRule("name", TEXT, "its name, unique among its kind", required=True, default="")
_LABEL = AttributeRule("name", TEXT, "a name for users and tools", default="")

ORIGIN = ElementRule(
    "origin",
    "the pose of the frame in its parent frame; the identity when absent",
    (
        AttributeRule("xyz", VECTOR3, "translation", "m", default="0 0 0"),
        AttributeRule(
            "rpy",
            VECTOR3,
            "roll, pitch, yaw about the fixed axes x, y, z",
            "rad",
            default="0 0 0",
            get=lambda pose: pose.rpy if pose.quaternion is None else None,
        ),
        AttributeRule(
            "quat_xyzw", QUATERNION, "rotation as a quaternion, instead of rpy", since=(1, 1), field="quaternion"
        ),
    ),
    make=pose_of,
    default=IDENTITY_POSE,
    check=check_origin,
)

_RADIUS = _number_attribute("radius", "radius", "m", required=True)

SHAPES = (
    ElementRule(
        "box",
        "a box centered at the origin",
        (AttributeRule("size", VECTOR3, "edge lengths along x, y, z", "m", required=True),),
        make=Box,
    ),
    ElementRule(
        "cylinder",
        "a cylinder along z, centered at the origin",
        (_RADIUS, _number_attribute("length", "length along z", "m", required=True)),
        make=Cylinder,
    ),
    ElementRule("sphere", "a sphere centered at the origin", (_RADIUS,), make=Sphere),
    ElementRule(
        "capsule",
        "a cylinder along z with a half sphere at each end, centered at the origin",
        (_RADIUS, _number_attribute("length", "length of the cylindrical part", "m", required=True)),
        since=(1, 1),
        make=Capsule,
    ),
    ElementRule(
        "mesh",
        "a mesh file",
        (
            AttributeRule("filename", TEXT, "package://PACKAGE/PATH, file://PATH or a plain path", required=True),
            AttributeRule("scale", VECTOR3, "factors along x, y, z", default="1 1 1"),
        ),
        make=Mesh,
    ),
)

GEOMETRY = ElementRule(
    "geometry",
    "the shape; only the first element in it is read",
    children=SHAPES,
    required=True,
    choice=True,
    check=check_sizes,
)

MATERIAL = ElementRule(
    "material",
    "a color, a texture, or the name of a material defined elsewhere",
    (AttributeRule("name", TEXT, "the name by which others refer to it", required=True),),
    (
        ElementRule("color", "the color", (AttributeRule("rgba", RGBA, "red, green, blue, alpha"),), default=(None,)),
        ElementRule(
            "texture", "an image", (AttributeRule("filename", TEXT, "its URI", field="texture"),), default=(None,)
        ),
    ),
    make=Material,
    passes_element=True,
    is_owner=True,
)

INERTIAL = ElementRule(
    "inertial",
    "mass properties; none when absent",
    children=(
        ORIGIN,
        ElementRule(
            "mass",
            "the mass",
            (_number_attribute("value", "the mass", "kg", required=True, field="mass"),),
            required=True,
        ),
        ElementRule(
            "inertia",
            "the inertia tensor about the center of mass, in the axes of the inertial frame",
            tuple(
                _number_attribute(name, f"the {name[1:]} component", "kg m2", required=True)
                for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
            ),
            required=True,
        ),
    ),
    make=Inertial,
    passes_element=True,
)

_LABEL = AttributeRule("name", TEXT, "a name for users and tools", default="")

VISUAL = ElementRule(
    "visual",
    "a shape to draw",
    (_LABEL,),
    (
        ORIGIN,
        GEOMETRY,
        replace(
            MATERIAL,
            get=lambda visual: Material(visual.material_name) if visual.material_name else visual.material,
        ),
    ),
    is_repeated=True,
    make=dict,  # the link creates the visual after it has found the named material
    passes_element=True,
    field="visuals",
)
COLLISION = ElementRule(
    "collision",
    "a shape for contacts",
    (_LABEL,),
    (ORIGIN, GEOMETRY),
    is_repeated=True,
    make=Collision,
    passes_element=True,
    field="collisions",
)

_NAME = AttributeRule("name", TEXT, "its name, unique among its kind", required=True, default="")

LINK = ElementRule(
    "link",
    "a rigid body",
    (_NAME,),
    (INERTIAL, VISUAL, COLLISION),
    is_repeated=True,
    make=dict,  # urdfdom drops the parts after an unreadable one
    keeps_element=True,
    passes_element=True,
    get=lambda robot: robot.links.values(),
)

AXIS = ElementRule(
    "axis",
    "the direction of motion in the joint frame, the normal for a planar joint; 1 0 0 when absent",
    (
        AttributeRule(
            "xyz",
            VECTOR3,
            "the direction of the axis, a vector of length 1",
            default="0 0 0",
            usually_written=True,
            field="axis",
            get=lambda joint: None if joint.type in ("fixed", "floating") else joint.axis,
        ),
    ),
    default=((1.0, 0.0, 0.0),),
)

_URDF_1_2: Version = (1, 2)
_NO_BOUND = {"later_default": (_URDF_1_2, inf)}

LIMIT = ElementRule(
    "limit",
    "the bounds of motion; revolute and prismatic joints need them",
    (
        _number_attribute(
            "lower", "minimum position", "rad or m", default="0", usually_written=True, later_default=(_URDF_1_2, -inf)
        ),
        _number_attribute("upper", "maximum position", "rad or m", default="0", usually_written=True, **_NO_BOUND),
        _number_attribute("effort", "maximum torque or force", "N m or N", required=True, until=_URDF_1_2, **_NO_BOUND),
        _number_attribute("velocity", "maximum speed", "rad/s or m/s", required=True, until=_URDF_1_2, **_NO_BOUND),
        _number_attribute("acceleration", "maximum acceleration", "rad/s2 or m/s2", since=_URDF_1_2),
        _number_attribute(
            "deceleration", "maximum deceleration; the acceleration when absent", "rad/s2 or m/s2", since=_URDF_1_2
        ),
        _number_attribute("jerk", "maximum jerk", "rad/s3 or m/s3", since=_URDF_1_2),
    ),
    make=Limit,
    check=check_limit,
)

MIMIC = ElementRule(
    "mimic",
    "follow another joint: multiplier * its position + offset",
    (
        AttributeRule("joint", TEXT, "the joint to follow", required=True),
        _number_attribute("multiplier", "a factor on the position of that joint", default="1", usually_written=True),
        _number_attribute("offset", "a value added to the result", "rad or m", default="0", usually_written=True),
    ),
    make=Mimic,
)

SAFETY = ElementRule(
    "safety_controller",
    "gains and soft limits of a safety controller",
    (
        _number_attribute("k_velocity", "effort per velocity error", "N m s/rad or N s/m", required=True),
        _number_attribute("k_position", "velocity per position error", "1/s", default="0", usually_written=True),
        _number_attribute(
            "soft_lower_limit",
            "the lower position at which it starts to act",
            "rad or m",
            default="0",
            usually_written=True,
        ),
        _number_attribute(
            "soft_upper_limit",
            "the upper position at which it starts to act",
            "rad or m",
            default="0",
            usually_written=True,
        ),
    ),
    make=Safety,
    field="safety",
)

DYNAMICS = ElementRule(
    "dynamics",
    "damping, friction, or both",
    (
        _number_attribute("damping", "viscous damping", "N m s/rad or N s/m", default="0", usually_written=True),
        _number_attribute("friction", "static friction", "N m or N", default="0", usually_written=True),
    ),
    make=Dynamics,
    check=check_dynamics,
)

CALIBRATION = ElementRule(
    "calibration",
    "reference positions",
    (
        _number_attribute("rising", "the position at which the reference signal rises", "rad or m"),
        _number_attribute("falling", "the position at which the reference signal falls", "rad or m"),
    ),
    make=Calibration,
)

PARENT = ElementRule(
    "parent",
    "the parent link",
    (AttributeRule("link", TEXT, "the link's name", required=True, field="parent"),),
    required=True,
    default=("",),
    check=check_link_name,
)

CHILD = ElementRule(
    "child",
    "the child link",
    (AttributeRule("link", TEXT, "the link's name", required=True, field="child"),),
    required=True,
    default=("",),
    check=check_link_name,
)

JOINT = ElementRule(
    "joint",
    "a connection between two links",
    (_NAME, AttributeRule("type", JOINT_TYPE, JOINT_TYPES_TEXT, required=True, default="fixed")),
    (ORIGIN, PARENT, CHILD, AXIS, LIMIT, MIMIC, SAFETY, DYNAMICS, CALIBRATION),
    is_repeated=True,
    make=Joint,
    keeps_element=True,
    passes_element=True,
    get=lambda robot: robot.joints.values(),
)

ROBOT = ElementRule(
    "robot",
    "a robot description",
    (
        AttributeRule("name", TEXT, "the robot's name", required=True),
        AttributeRule("version", VERSION, "the URDF version, 1.0 to 1.2", default="1.0"),
    ),
    (replace(MATERIAL, is_repeated=True, get=lambda robot: robot.materials.values()), LINK, JOINT),
    make=Robot,
)
