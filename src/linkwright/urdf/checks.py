"""Rules of urdfdom that the table of elements cannot express.

Each function gets a value that was read, reports its mistakes beyond its form, and returns the value to use.
"""

from __future__ import annotations

from math import sqrt

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, Quaternion, rpy_from_quaternion
from linkwright.geometry.vectors import Vector3
from linkwright.loading.lean_dataclasses import replace
from linkwright.loading.lean_typing import Any
from linkwright.schema.report import UNREADABLE
from linkwright.urdf.model import Dynamics, Geometry, Limit
from linkwright.urdf.report import Findings, owner_name
from linkwright.urdf.values import degrees_hint, looks_like_degrees, number, numbers
from linkwright.xmltree import Element

_ROUNDING = 1e-15
_SIZES = ("size", "radius", "length")
_UNSIGNED = ("effort", "velocity", "acceleration", "deceleration", "jerk")


def pose_of(xyz: Vector3, rpy: Vector3, quaternion: Quaternion | None) -> Pose:
    """Return the pose of an ``<origin>``; a quaternion is normalised, and one of zeros is the identity."""
    if quaternion is None:
        return Pose(xyz, rpy)
    norm = sqrt(sum(part * part for part in quaternion))
    if abs(norm - 1) < _ROUNDING:
        norm = 1.0  # what is written for a quaternion of unit length is read as the same one
    x, y, z, w = (part / norm for part in quaternion) if norm > 0 else (0.0, 0.0, 0.0, 1.0)
    return Pose(xyz, rpy_from_quaternion((x, y, z, w)), (x, y, z, w))


def check_origin(pose: Pose, element: Element, owner: Element, findings: Findings) -> Any:
    """Check that there is one kind of rotation, and that angles are not in degrees."""
    if pose.quaternion is not None:
        if "rpy" not in element.attributes:
            return pose
        message = phrase("<origin> of {owner} has both 'rpy' and 'quat_xyzw'", owner=owner_name(owner))
        findings.error("URDF170", message, element, "quat_xyzw", hint=phrase("keep one of them"))
        return UNREADABLE
    roll, pitch, yaw = pose.rpy
    if -10 < roll < 10 and -10 < pitch < 10 and -10 < yaw < 10:
        return pose
    if looks_like_degrees(roll, pitch, yaw) and "quat_xyzw" not in element.attributes:
        message = phrase(
            "'rpy' in <origin> of {owner} looks like degrees: '{rpy}'",
            owner=owner_name(owner),
            rpy=element.attributes["rpy"],
        )
        findings.warning("URDF190", message, element, "rpy", hint=degrees_hint(roll, pitch, yaw))
    return pose


def check_sizes(geometry: Geometry, shape: Element, owner: Element, findings: Findings) -> Any:
    """Check that every size is above zero, as URDF 1.2 requires; older versions accept anything."""
    if findings.version < (1, 2):
        return geometry
    good = True
    for name in _SIZES:
        value = shape.attributes.get(name)
        if value is not None and shape.tag != "mesh" and min(numbers(value)) <= 0:
            good = False
            message = phrase(
                "'{name}' in <{tag}> of {owner} is not above zero: '{value}'",
                name=name,
                tag=shape.tag,
                owner=owner_name(owner),
                value=value,
            )
            findings.error("URDF123", message, shape, name, hint=phrase("URDF 1.2 requires sizes above zero"))
    return geometry if good else UNREADABLE


def check_end(ends: tuple[str], element: Element, owner: Element, findings: Findings) -> tuple[str]:
    """Check that the name of a joint's parent or child link is not empty."""
    if not ends[0]:
        message = phrase("'link' in <{tag}> of {owner} is empty", tag=element.tag, owner=owner_name(owner))
        findings.error("URDF124", message, element, "link", hint=phrase("give the name of a link"))
    return ends


def check_dynamics(dynamics: Dynamics, element: Element, owner: Element, findings: Findings) -> Any:
    """Check that one of the two attributes is set."""
    if "damping" in element.attributes or "friction" in element.attributes:
        return dynamics
    message = phrase("<dynamics> of {owner} has neither 'damping' nor 'friction'", owner=owner_name(owner))
    hint = phrase('add damping="..." or friction="...", or remove <dynamics>')
    findings.error("URDF120", message, element, hint=hint)
    return UNREADABLE


def check_limit(limit: Limit, element: Element, owner: Element, findings: Findings) -> Limit:
    """Check ordered bounds and positive sizes, as URDF 1.2 requires; deceleration defaults to acceleration."""
    if findings.version < (1, 2):
        return limit
    given = element.attributes
    if limit.upper < limit.lower:
        message = phrase(
            "'upper' in <limit> of {owner} is below 'lower': '{upper}'", owner=owner_name(owner), upper=given["upper"]
        )
        findings.error("URDF123", message, element, "upper", hint=phrase("exchange them"))
    for name in _UNSIGNED:
        if name in given and number(given[name]) < 0:
            message = phrase(
                "'{name}' in <limit> of {owner} is negative: '{given}'",
                name=name,
                owner=owner_name(owner),
                given=given[name],
            )
            findings.error("URDF123", message, element, name, hint=phrase("give its size, without a sign"))
    return limit if limit.deceleration is not None else replace(limit, deceleration=limit.acceleration)
