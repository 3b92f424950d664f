"""Why an element could not be read: every missing or malformed attribute of it, from the schema.

The reader tries the straight way first. Only when that fails does it come here, so that clear messages cost nothing on
the good path.
"""

from __future__ import annotations

from linkwright.diagnostics import did_you_mean, nearest
from linkwright.urdf.findings import Findings
from linkwright.urdf.schema import JOINT_TYPES, JOINT_TYPES_TEXT, AttributeRule, ElementRule, Kind
from linkwright.urdf.values import number, number_hint, numbers, vector_hint
from linkwright.xmltree import Element

_COUNTS = {Kind.VECTOR3: 3, Kind.QUATERNION: 4, Kind.RGBA: 4}
_JOINT_ALIASES = {
    "hinge": "revolute",
    "rotational": "revolute",
    "rotary": "revolute",
    "rotate": "revolute",
    "wheel": "continuous",
    "linear": "prismatic",
    "slider": "prismatic",
    "sliding": "prismatic",
    "translational": "prismatic",
    "static": "fixed",
    "rigid": "fixed",
    "weld": "fixed",
    "free": "floating",
    "ball": None,
    "spherical": None,
    "universal": None,
    "screw": None,
}
_SHAPE_ALIASES = {"cube": "box", "cuboid": "box", "ball": "sphere", "tube": "cylinder", "rod": "cylinder"}


def explain_attributes(element: Element, rule: ElementRule, owner: str, findings: Findings) -> None:
    """Report each attribute of an element that is required and missing, or whose value is malformed."""
    for attribute in rule.attributes:
        if findings.version < attribute.since:
            continue
        value = element.attributes.get(attribute.name)
        if value is not None:
            _explain_value(element, rule, attribute, value, owner, findings)
        elif attribute.is_required(findings.version):
            findings.error(
                "URDF120",
                f"<{rule.tag}> of {owner} has no '{attribute.name}'",
                element,
                hint=_missing_attribute_hint(element, rule, attribute),
            )


def explain_missing_child(element: Element, rule: ElementRule, tag: str, owner: str, findings: Findings) -> None:
    """Report that an element lacks a required child."""
    candidates = [child for child in element.elements() if rule.child(child.tag) is None]
    like = nearest(tag, [child.tag for child in candidates], limit=1)
    misspelt = next((child for child in candidates if child.tag in like), None)
    wanted = rule.child(tag)
    assert wanted is not None
    hint = f"add <{tag}{_usual_attributes(wanted)}/>: {wanted.meaning}"
    if misspelt is not None:
        hint = f"did you mean '{tag}' where it says '{misspelt.tag}'?"
    whose = owner if rule.tag in ("link", "joint") else f"<{rule.tag}> of {owner}"
    findings.error("URDF130", f"{whose} has no <{tag}>", misspelt or element, hint=hint)


def joint_type_hint(written: str) -> str:
    """How to mend an unknown joint type."""
    folded = written.strip().casefold()
    if folded in JOINT_TYPES:
        return f"write '{folded}'"
    if folded in _JOINT_ALIASES:
        meant = _JOINT_ALIASES[folded]
        return f"did you mean '{meant}'?" if meant else "URDF has no such joint: build it from revolute joints"
    return did_you_mean(written, JOINT_TYPES) or f"it is one of {JOINT_TYPES_TEXT}"


def shape_hint(written: str, shapes: tuple[ElementRule, ...]) -> str:
    """How to mend an unknown shape."""
    if written.startswith("xacro:"):
        return "xacro did not evaluate this: expand the file with xacro first"
    names = [shape.tag for shape in shapes]
    meant = _SHAPE_ALIASES.get(written.casefold())
    if meant:
        return f"did you mean '{meant}'?"
    return did_you_mean(written, names) or "it is one of " + ", ".join(names)


def _explain_value(
    element: Element, rule: ElementRule, attribute: AttributeRule, value: str, owner: str, findings: Findings
) -> None:
    where = f"'{attribute.name}' in <{rule.tag}> of {owner}"
    if attribute.kind is Kind.NUMBER:
        try:
            number(value)
        except ValueError:
            hint = number_hint(value)
            if rule.tag == "limit" and attribute.usual and "inf" in value.casefold():
                hint = "only finite numbers are read; a joint that turns without bounds is 'continuous'"
            findings.error("URDF121", f"{where} is not a number: '{value}'", element, attribute.name, hint=hint)
    elif attribute.kind in _COUNTS:
        count = _COUNTS[attribute.kind]
        try:
            found = numbers(value)
        except ValueError:
            findings.error(
                "URDF121",
                f"{where} is not {count} numbers: '{value}'",
                element,
                attribute.name,
                hint=vector_hint(value, count),
            )
            return
        if len(found) != count:
            findings.error(
                "URDF122",
                f"{where} has {_numbers(len(found))} where {count} are expected: '{value}'",
                element,
                attribute.name,
                hint=_count_hint(rule, attribute, found),
            )


def _count_hint(rule: ElementRule, attribute: AttributeRule, found: tuple[float, ...]) -> str:
    if rule.tag == "mesh" and len(found) == 1:
        return f"give a factor for each axis: '{' '.join([f'{found[0]:g}'] * 3)}'"
    return f"give {attribute.kind.value}, separated by spaces: {attribute.meaning}"


def _numbers(count: int) -> str:
    return "1 number" if count == 1 else f"{count} numbers"


def _missing_attribute_hint(element: Element, rule: ElementRule, attribute: AttributeRule) -> str:
    unknown = [name for name in element.attributes if rule.attribute(name) is None]
    like = nearest(attribute.name, unknown, limit=1)
    if like:
        return f"did you mean '{attribute.name}' where it says '{like[0]}'?"
    text = element.text().strip()
    if text and not unknown and attribute.kind in (Kind.TEXT, Kind.NUMBER):
        return f'write <{rule.tag} {attribute.name}="{text}"/>'
    if rule.tag == "sphere" and "diameter" in unknown:
        return "give the radius, half the diameter"
    unit = f" ({attribute.unit})" if attribute.unit else ""
    return f'add {attribute.name}="...": {attribute.meaning}{unit}'


def _usual_attributes(rule: ElementRule) -> str:
    return "".join(f' {attribute.name}="..."' for attribute in rule.attributes if attribute.required or attribute.usual)
