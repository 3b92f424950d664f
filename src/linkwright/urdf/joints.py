"""Reading joints.

A joint that cannot be read makes urdfdom refuse the whole model. All that is wrong with it is told.
"""

from __future__ import annotations

from dataclasses import replace

from linkwright.diagnostics import phrase
from linkwright.schema.reading import reader_of
from linkwright.urdf.explain import UrdfReport, owner_name
from linkwright.urdf.model import Joint, Limit
from linkwright.urdf.schema import AXIS, JOINT, LIMIT
from linkwright.urdf.values import degrees_hint, looks_like_degree_limits, looks_like_degrees
from linkwright.xmltree import Element

_BOUNDED = ("revolute", "prismatic")
_HAS_AXIS = ("revolute", "continuous", "prismatic", "planar")
_WITHOUT_AXIS = replace(JOINT, children=tuple(child for child in JOINT.children if child is not AXIS))


def read_joint(element: Element, findings: UrdfReport) -> Joint:
    """A joint; where something in it cannot be read, the findings say so and are marked as rejecting the model.

    Without the tag ``<axis>`` the axis is 1 0 0 and, oddly but as in urdfdom, 0 0 0 for a tag without 'xyz'.
    """
    before = findings.error_count
    rule = JOINT if element.attributes.get("type") in _HAS_AXIS else _WITHOUT_AXIS
    joint: Joint = reader_of(rule, findings.version).read(element, element, findings)
    if joint.type in _BOUNDED:
        _check_bounds(element, joint, findings)
    if findings.error_count > before:
        findings.rejected = True
    return joint


def _check_bounds(joint_element: Element, joint: Joint, findings: UrdfReport) -> None:
    element = joint_element.first("limit")
    if element is None:
        findings.missing_child(joint_element, JOINT, LIMIT, joint_element, joint.type)
    elif joint.limit is not None:
        if findings.version >= (1, 2):
            for name in ("lower", "upper"):
                if name not in element.attributes:
                    message = phrase(
                        "<limit> of {kind} {owner} has no '{name}'",
                        kind=joint.type,
                        owner=owner_name(joint_element),
                        name=name,
                    )
                    hint = phrase("URDF 1.2 wants both 'lower' and 'upper'")
                    findings.error("URDF120", message, element, hint=hint)
        if joint.type == "revolute":
            _check_angles(element, joint.limit, joint_element, findings)


def _check_angles(element: Element, limit: Limit, owner: Element, findings: UrdfReport) -> None:
    if not looks_like_degree_limits(limit.lower, limit.upper):
        return
    for name, value in (("lower", limit.lower), ("upper", limit.upper)):
        if looks_like_degrees(value):
            message = phrase(
                "'{name}' in <limit> of {owner} looks like degrees: '{value}'",
                name=name,
                owner=owner_name(owner),
                value=element.attributes[name],
            )
            findings.warning("URDF190", message, element, name, hint=degrees_hint(value))
