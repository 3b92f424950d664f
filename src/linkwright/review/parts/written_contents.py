"""Summarize added macros, and added descriptions that cannot be expanded, by the elements that are written in them."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.diagnostics import Phrase, joined, joined_first, phrase
from linkwright.diagnostics.phrase import as_phrase
from linkwright.review.changes import MAX_NAMES
from linkwright.review.parts.interface import format_parameter
from linkwright.review.parts.outline import INCLUDE, PROPERTY, Item, MacroOutline, Outline, iterate_items
from linkwright.review.plugins import format_plugins
from linkwright.xmltree import Element

_MAX_CONTENTS = 20
"""The maximum number of elements of an added macro or file in a line."""
_MAX_PLUGIN_VALUES = 6
"""The maximum number of values of each sensor and plugin in a line."""


def format_written_contents(outline: Outline) -> Phrase | None:
    """Return the arguments, included files and elements of a file outside of its macros; None if there are none."""
    items = [*format_arguments(outline), *_summarize_elements(outline.root)]
    return joined_first(items, _MAX_CONTENTS) if items else None


def summarize_macro(macro: MacroOutline) -> Phrase | None:
    """Return the parameters of a macro, and the included files and the elements in it; None if it has none."""
    items = _summarize_elements(macro.element)
    elements = joined_first(items, _MAX_CONTENTS) if items else None
    if not macro.parameters:
        return elements
    names = joined_first([format_parameter(parameter) for parameter in macro.parameters.values()], MAX_NAMES)
    parameters = phrase("parameters {names}", names=names)
    return parameters if elements is None else phrase("{parts}; makes {items}", parts=parameters, items=elements)


def format_arguments(outline: Outline) -> Iterator[Phrase]:
    """Yield the arguments of a description with their defaults."""
    for name, element in outline.arguments.items():
        default = element.attributes.get("default")
        if default is None:
            yield phrase("argument '{name}'", name=name)
        else:
            yield phrase("argument '{name}' (default {value})", name=name, value=default or "''")


def _summarize_elements(element: Element) -> list[Phrase]:
    """Return the elements in a macro or description, each once. Included files have their names."""
    items: list[Phrase] = []
    for child in iterate_items(element):
        if child.element.tag == INCLUDE:
            items.append(phrase("includes {name}", name=child.element.attributes.get("filename", "")))
        elif child.element.tag != PROPERTY:
            items.append(_summarize_item(child))
    return list({str(item): item for item in items}.values())


def _summarize_item(item: Item) -> Phrase:
    """Return an element of a macro; one for Gazebo with its sensors and plugins."""
    contents = format_plugins(item.element, _MAX_PLUGIN_VALUES) if item.element.tag == "gazebo" else []
    return phrase("{entry} ({items})", entry=item.key, items=joined(contents)) if contents else as_phrase(item.key)
