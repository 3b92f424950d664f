"""Convert objects to elements, by the rules for reading; XX elements are read."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from linkwright.loading.lean_typing import Any
from linkwright.schema.rules import AttributeRule, ElementRule
from linkwright.xmltree import Element, Text

Completion = Callable[[Element, ElementRule, Any], None]
"""A function that adds content without a rule to the element of an object."""


def write_element(rule: ElementRule, instance: Any, complete: Completion | None = None) -> Element:
    """Return an object as an element.

    The reader returns an equal object from it. Default values are omitted, except values that are usually written.

    Args:
        rule: the rule of the element.
        instance: the object, with a field for each attribute and child.
        complete: a function that is called for each object with its own element, with the element, its rule and the
            object.
    """
    if rule.choice:
        child_rule = next(child for child in rule.children if type(instance) is child.make)
        element = Element(rule.tag)
        element.children.append(write_element(child_rule, instance, complete))
        return element
    texts = {attribute.name: text for attribute in rule.attributes if (text := _text(attribute, instance)) is not None}
    element = Element(rule.tag, texts)
    if rule.text is not None and (inner_text := _text(rule.text, instance)) is not None:
        element.children.append(Text(inner_text))
    for child in rule.children:
        element.children += _child_elements(child, instance, complete)
    if rule.is_recursive:
        element.children += (write_element(rule, item, complete) for item in rule.value_in(instance))
    if complete is not None and not rule.is_inline:
        complete(element, rule, instance)
    return element


def _child_elements(rule: ElementRule, instance: Any, complete: Completion | None) -> Iterator[Element]:
    if rule.is_inline:
        element = write_element(rule, instance)
        if element.attributes or element.children or rule.required:
            yield element
        return
    value = rule.value_in(instance)
    for item in value if rule.is_repeated else (value,):
        if item is not None and (item != rule.default or (rule.passes_element and item is not rule.default)):
            yield write_element(rule, item, complete)


def _text(attribute: AttributeRule, instance: Any) -> str | None:
    value = attribute.value_in(instance)
    if value is None:
        return None
    is_optional = attribute.default is not None and not (attribute.required or attribute.usually_written)
    if is_optional and value == attribute.absent_value((1, 0)):
        return None
    return attribute.type.write(value)
