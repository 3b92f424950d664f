"""Writing objects as elements, by the rules that they are read by."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from linkwright.schema.rules import AttributeRule, ElementRule
from linkwright.xmltree import Element, Text


def write_element(rule: ElementRule, instance: Any) -> Element:
    """The element of an object, which reads back as an equal one.

    What is as by default is left out, unless one usually writes it.

    Args:
        rule: what the element is like.
        instance: the object, with a field for each attribute and child.
    """
    if rule.choice:
        chosen = next(child for child in rule.children if type(instance) is child.make)
        element = Element(rule.tag)
        element.children.append(write_element(chosen, instance))
        return element
    texts = {attribute.name: text for attribute in rule.attributes if (text := _text(attribute, instance)) is not None}
    element = Element(rule.tag, texts)
    if rule.text is not None and (inside := _text(rule.text, instance)) is not None:
        element.children.append(Text(inside))
    for child in rule.children:
        element.children += _inner(child, instance)
    return element


def _inner(rule: ElementRule, instance: Any) -> Iterator[Element]:
    if rule.is_inline:
        element = write_element(rule, instance)
        if element.attributes or element.children or rule.required:
            yield element
        return
    inner = rule.value_in(instance)
    for each in inner if rule.many else (inner,):
        if each != rule.default:
            yield write_element(rule, each)


def _text(attribute: AttributeRule, instance: Any) -> str | None:
    value = attribute.value_in(instance)
    if value is None:
        return None
    optional = attribute.default is not None and not (attribute.required or attribute.usual)
    if optional and value == attribute.absent_value((1, 0)):
        return None
    return attribute.type.write(value)
