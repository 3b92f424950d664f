"""Translate SDF 1.0 to 1.2 to the elements of SDF 1.3 and later.

SDF 1.0 wrote values in attributes, ``<origin pose="1 2 0 0 0 0"/>`` and ``<box size="1 1 1"/>``, where later versions
have elements, ``<pose>1 2 0 0 0 0</pose>`` and ``<box><size>1 1 1</size></box>``. The rules of the current SDF
determine which attribute becomes which element; a few elements had other names. Source: ``1_0.convert`` of libsdformat.
"""

from __future__ import annotations

import re

from linkwright.schema import ElementRule
from linkwright.xmltree import Element
from linkwright.xmltree.nodes import Node, Text

_NEW_NAMES = {
    ("mesh", "filename"): "uri",
    ("heightmap", "filename"): "uri",
    ("image", "filename"): "uri",
    ("heightmap", "origin"): "pos",
    ("link", "damping"): "velocity_decay",
    ("physics", "update_rate"): "real_time_update_rate",
}
"""The new names of attributes and elements, by the tag of the parent element and the old name."""
_ORIGIN, _POSE = "origin", "pose"
_VALUE_ATTRIBUTES = ("pose", "rgba", "xyz", "angle", "enabled", "link", "name")
"""Attributes whose values became the text of their elements in SDF 1.3."""
_MATCH_OLD_VERSION = re.compile(r"1\.[012]").fullmatch


def is_old(root: Element) -> bool:
    """Return whether a document declares SDF 1.0 to 1.2."""
    return _MATCH_OLD_VERSION(root.attributes.get("version", "").strip()) is not None


def upgrade_element(element: Element, rule: ElementRule) -> Element:
    """Return a copy of an element translated to SDF 1.3.

    All elements keep their positions in the source.

    Args:
        element: an element of SDF 1.0 to 1.2, which is not changed.
        rule: the rule of the element in the current SDF.
    """
    new_element = Element(element.tag, dict(element.attributes), element.source, element.offset, element.origin)
    new_element.children = [
        _upgrade_child(child, rule) if isinstance(child, Element) else child for child in element.children
    ]
    existing_tags = {child.tag for child in new_element.elements()}
    for name, value in element.attributes.items():
        tag = _NEW_NAMES.get((rule.tag, name), name)
        if name not in rule.attribute_rules and tag in rule.child_rules and tag not in existing_tags:
            new_element.children.append(_make_value_element(element, rule.child_rules[tag], value))
    if rule.text is not None and not element.text().strip():
        value = next((element.attributes[name] for name in _VALUE_ATTRIBUTES if name in element.attributes), "")
        new_element.children.append(Text(value))
    return new_element


def _upgrade_child(child: Element, rule: ElementRule) -> Node:
    tag = _NEW_NAMES.get((rule.tag, child.tag), child.tag)
    if child.tag == _ORIGIN and _POSE in child.attributes:
        tag = _POSE
    child_rule = rule.child_rules.get(tag)
    if child_rule is None or tag == "plugin":
        return child
    new_element = upgrade_element(child, child_rule)
    new_element.tag = tag
    return new_element


def _make_value_element(element: Element, rule: ElementRule, value: str) -> Element:
    """Return the new element, described by `rule`, that replaces an attribute of `element`."""
    new_element = Element(rule.tag, None, element.source, element.offset, element.origin)
    if "name" in rule.child_rules:
        new_element.children.append(_make_value_element(element, rule.child_rules["name"], value))
    else:
        new_element.children.append(Text(value))
    return new_element
