"""Translates SDF 1.0 to 1.2 to the elements of SDF 1.3 and later.

SDF 1.0 wrote values in attributes, ``<origin pose="1 2 0 0 0 0"/>`` and ``<box size="1 1 1"/>``, where later versions
have elements, ``<pose>1 2 0 0 0 0</pose>`` and ``<box><size>1 1 1</size></box>``. The table of the language determines
which value belongs to which element; a few elements had other names. Source: ``1_0.convert`` of libsdformat.
"""

from __future__ import annotations

import re

from linkwright.schema import ElementRule
from linkwright.xmltree import Element
from linkwright.xmltree.nodes import Node, Text

_RENAMED = {
    ("mesh", "filename"): "uri",
    ("heightmap", "filename"): "uri",
    ("image", "filename"): "uri",
    ("heightmap", "origin"): "pos",
    ("link", "damping"): "velocity_decay",
    ("physics", "update_rate"): "real_time_update_rate",
}
"""New names of attributes and elements, by the element around them and their old name."""
_ORIGIN, _POSE = "origin", "pose"
_VALUES = ("pose", "rgba", "xyz", "angle", "enabled", "link", "name")
"""The attributes that had the value of an element."""
_OLD = re.compile(r"1\.[012]").fullmatch


def is_old(root: Element) -> bool:
    """Return whether a document declares SDF 1.0 to 1.2."""
    return _OLD(root.attributes.get("version", "").strip()) is not None


def upgraded(element: Element, rule: ElementRule) -> Element:
    """Return an element translated to SDF 1.3, whose parts keep their positions in the source.

    Args:
        element: an element of SDF 1.0 to 1.2, which is not changed.
        rule: the rule of the element in the current SDF.
    """
    new = Element(element.tag, dict(element.attributes), element.source, element.offset, element.origin)
    new.children = [_child(child, rule) if isinstance(child, Element) else child for child in element.children]
    present = {child.tag for child in new.elements()}
    for name, value in element.attributes.items():
        tag = _RENAMED.get((rule.tag, name), name)
        if name not in rule.attribute_rules and tag in rule.child_rules and tag not in present:
            new.children.append(_value_element(element, rule.child_rules[tag], value))
    if rule.text is not None and not element.text().strip():
        value = next((element.attributes[name] for name in _VALUES if name in element.attributes), "")
        new.children.append(Text(value))
    return new


def _child(child: Element, rule: ElementRule) -> Node:
    tag = _RENAMED.get((rule.tag, child.tag), child.tag)
    if child.tag == _ORIGIN and _POSE in child.attributes:
        tag = _POSE
    child_rule = rule.child_rules.get(tag)
    if child_rule is None or tag == "plugin":
        return child
    new = upgraded(child, child_rule)
    new.tag = tag
    return new


def _value_element(element: Element, rule: ElementRule, value: str) -> Element:
    """Return the element that replaces an attribute of `element`; `rule` is the new element's rule."""
    new = Element(rule.tag, None, element.source, element.offset, element.origin)
    if "name" in rule.child_rules:
        new.children.append(_value_element(element, rule.child_rules["name"], value))
    else:
        new.children.append(Text(value))
    return new
