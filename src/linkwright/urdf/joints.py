"""Reading joints.

A joint that cannot be read makes urdfdom refuse the whole model. All that is wrong with it is told.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import inf
from typing import cast

from linkwright.urdf import schema
from linkwright.urdf.explain import explain_attributes, explain_missing_child, joint_type_hint
from linkwright.urdf.findings import Findings
from linkwright.urdf.links import first_children
from linkwright.urdf.model import (
    Calibration,
    Dynamics,
    Joint,
    JointType,
    Limit,
    Mimic,
    Pose,
    Safety,
    Vector3,
)
from linkwright.urdf.origins import read_origin
from linkwright.urdf.values import degrees_hint, looks_like_degrees, number, vector3
from linkwright.xmltree import Element

_BOUNDED = ("revolute", "prismatic")
_NO_AXIS = ("fixed", "floating")
_X: Vector3 = (1.0, 0.0, 0.0)
_IDENTITY = Pose()


def read_joint(element: Element, findings: Findings) -> Joint:
    """A joint; where something in it cannot be read, the findings say so and are marked as rejecting the model."""
    before = findings.error_count
    given = element.attributes
    first = first_children(element)
    name = given.get("name")
    owner = "a joint without a name" if name is None else f"joint '{name}'"
    if name is None:
        findings.error("URDF120", "a joint has no 'name'", element, hint='add name="..."')
    kind = _read_type(element, owner, findings)
    origin = read_origin(first.get("origin"), owner, findings) or _IDENTITY
    axis = _X if kind in _NO_AXIS else _read_axis(first.get("axis"), owner, findings)
    joint = Joint(
        name or "",
        kind,
        _read_end("parent", element, first, owner, findings),
        _read_end("child", element, first, owner, findings),
        origin,
        axis,
        _read_limit(element, first.get("limit"), kind, owner, findings),
        _read_mimic(first.get("mimic"), owner, findings),
        _read_safety(first.get("safety_controller"), owner, findings),
        _read_dynamics(first.get("dynamics"), owner, findings),
        _read_calibration(first.get("calibration"), owner, findings),
        element,
    )
    if findings.error_count > before:
        findings.rejected = True
    return joint


def _read_type(element: Element, owner: str, findings: Findings) -> JointType:
    """The joint's type; a wrong one is reported and stands for 'fixed', which asks nothing of the rest."""
    written = element.attributes.get("type")
    if written in schema.JOINT_TYPES:
        return cast(JointType, written)
    if written is None:
        findings.error("URDF120", f"{owner} has no 'type'", element, hint=f'add type="...": {schema.JOINT_TYPES_TEXT}')
    else:
        message = f"'{written}' is not a joint type, in {owner}"
        findings.error("URDF140", message, element, "type", hint=joint_type_hint(written))
    return "fixed"


def _read_end(tag: str, joint: Element, first: Mapping[str, Element], owner: str, findings: Findings) -> str:
    """The link that ``<parent>`` or ``<child>`` names; empty when it is missing, which is reported."""
    element = first.get(tag)
    if element is None:
        explain_missing_child(joint, schema.JOINT, tag, owner, findings)
        return ""
    name = element.attributes.get("link")
    if name is None:
        explain_attributes(element, schema.PARENT if tag == "parent" else schema.CHILD, owner, findings)
        return ""
    if not name:
        message = f"'link' in <{tag}> of {owner} is empty"
        findings.error("URDF124", message, element, "link", hint="give the name of a link")
    return name


def _read_axis(element: Element | None, owner: str, findings: Findings) -> Vector3:
    """The axis as written; 1 0 0 without the tag and, oddly but as in urdfdom, 0 0 0 for a tag without 'xyz'."""
    if element is None:
        return _X
    try:
        return vector3(element.attributes.get("xyz", "0 0 0"))
    except ValueError:
        explain_attributes(element, schema.AXIS, owner, findings)
        return _X


def _read_limit(
    joint: Element, element: Element | None, kind: JointType, owner: str, findings: Findings
) -> Limit | None:
    if element is None:
        if kind in _BOUNDED:
            explain_missing_child(joint, schema.JOINT, "limit", f"{kind} {owner}", findings)
        return None
    given = element.attributes
    get = given.get
    try:
        if findings.version >= (1, 2):
            limit = _limit_of_version_1_2(given)
        else:
            limit = Limit(
                number(get("lower", "0")),
                number(get("upper", "0")),
                number(given["effort"]),
                number(given["velocity"]),
            )
    except (KeyError, ValueError):
        explain_attributes(element, schema.LIMIT, owner, findings)
        return None
    if findings.version >= (1, 2):
        _check_limit_of_version_1_2(element, limit, kind, owner, findings)
    elif "acceleration" in given or "deceleration" in given or "jerk" in given:
        for name in ("acceleration", "deceleration", "jerk"):
            if name in given:
                message = f"'{name}' in <limit> of {owner} is ignored: it needs URDF 1.2"
                findings.warning("URDF171", message, element, name, hint='write <robot version="1.2" ...>')
    if kind == "revolute" and looks_like_degrees(limit.lower, limit.upper):
        for name, value in (("lower", limit.lower), ("upper", limit.upper)):
            if looks_like_degrees(value):
                message = f"'{name}' in <limit> of {owner} looks like degrees: '{given[name]}'"
                findings.warning("URDF190", message, element, name, hint=degrees_hint(value))
    return limit


def _limit_of_version_1_2(given: Mapping[str, str]) -> Limit:
    """Limits as URDF 1.2 reads them: what is absent is unlimited, and braking is as strong as accelerating."""

    def optional(name: str) -> float | None:
        return number(given[name]) if name in given else None

    acceleration = optional("acceleration")
    deceleration = optional("deceleration")
    return Limit(
        number(given["lower"]) if "lower" in given else -inf,
        number(given["upper"]) if "upper" in given else inf,
        number(given["effort"]) if "effort" in given else inf,
        number(given["velocity"]) if "velocity" in given else inf,
        acceleration,
        acceleration if deceleration is None else deceleration,
        optional("jerk"),
    )


def _check_limit_of_version_1_2(
    element: Element, limit: Limit, kind: JointType, owner: str, findings: Findings
) -> None:
    given = element.attributes
    for name in ("lower", "upper"):
        if kind in _BOUNDED and name not in given:
            message = f"<limit> of {kind} {owner} has no '{name}'"
            findings.error("URDF120", message, element, hint="URDF 1.2 wants both 'lower' and 'upper'")
    if limit.upper < limit.lower:
        message = f"'upper' in <limit> of {owner} is below 'lower': '{given['upper']}'"
        findings.error("URDF123", message, element, "upper", hint="exchange them")
    for name in ("effort", "velocity", "acceleration", "deceleration", "jerk"):
        if name in given and number(given[name]) < 0:
            message = f"'{name}' in <limit> of {owner} is negative: '{given[name]}'"
            findings.error("URDF123", message, element, name, hint="give its size, without a sign")


def _read_mimic(element: Element | None, owner: str, findings: Findings) -> Mimic | None:
    if element is None:
        return None
    get = element.attributes.get
    try:
        return Mimic(element.attributes["joint"], number(get("multiplier", "1")), number(get("offset", "0")))
    except (KeyError, ValueError):
        explain_attributes(element, schema.MIMIC, owner, findings)
        return None


def _read_safety(element: Element | None, owner: str, findings: Findings) -> Safety | None:
    if element is None:
        return None
    get = element.attributes.get
    try:
        return Safety(
            number(element.attributes["k_velocity"]),
            number(get("k_position", "0")),
            number(get("soft_lower_limit", "0")),
            number(get("soft_upper_limit", "0")),
        )
    except (KeyError, ValueError):
        explain_attributes(element, schema.SAFETY, owner, findings)
        return None


def _read_dynamics(element: Element | None, owner: str, findings: Findings) -> Dynamics | None:
    if element is None:
        return None
    given = element.attributes
    if "damping" not in given and "friction" not in given:
        hint = 'add damping="..." or friction="...", or remove <dynamics>'
        findings.error("URDF120", f"<dynamics> of {owner} has neither 'damping' nor 'friction'", element, hint=hint)
        return None
    try:
        return Dynamics(number(given.get("damping", "0")), number(given.get("friction", "0")))
    except ValueError:
        explain_attributes(element, schema.DYNAMICS, owner, findings)
        return None


def _read_calibration(element: Element | None, owner: str, findings: Findings) -> Calibration | None:
    if element is None:
        return None
    rising, falling = element.attributes.get("rising"), element.attributes.get("falling")
    try:
        return Calibration(None if rising is None else number(rising), None if falling is None else number(falling))
    except ValueError:
        explain_attributes(element, schema.CALIBRATION, owner, findings)
        return None
