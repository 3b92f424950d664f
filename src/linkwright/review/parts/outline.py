"""Read the arguments, properties, macros and elements of an unexpanded description."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from linkwright.descriptions.comparison import GAZEBO, joined_block
from linkwright.diagnostics import LinkwrightError
from linkwright.lint.inclusions import Inclusion, inclusions_in
from linkwright.xacro.cache import read_document
from linkwright.xacro.faults import Fault
from linkwright.xacro.macros import Parameter, parse_parameters
from linkwright.xmltree import Document, Element, Overlay

ARG, INCLUDE, MACRO, PROPERTY = "xacro:arg", "xacro:include", "xacro:macro", "xacro:property"
_CONDITIONS = {"xacro:if": "if", "xacro:unless": "unless"}
_SHAPES = frozenset({"visual", "collision"})
_CONDITION_TAGS = {word: tag for tag, word in _CONDITIONS.items()}
_XACRO = "xacro:"
STATEMENTS = frozenset(
    f"{_XACRO}{name}"
    for name in ("arg", "attribute", "call", "element", "if", "include", "insert_block", "macro", "property", "unless")
)
"""The tags of xacro that call no macro of the description."""


@dataclass(frozen=True)
class Item:
    """An element with the conditions around it.

    Attributes:
        key: the tag and the name, which identify the element among its siblings.
        element: the XML element.
        conditions: the conditions, such as ``if ${x}``, the outermost first.
    """

    key: str
    element: Element
    conditions: tuple[str, ...]


@dataclass(frozen=True)
class MacroOutline:
    """An unexpanded macro.

    Attributes:
        name: the name of the macro.
        element: the element that defines it.
    """

    name: str
    element: Element

    @cached_property
    def parameters(self) -> Mapping[str, Parameter]:
        """The parameters by name; none if their list is malformed."""
        try:
            return {parameter.name: parameter for parameter in parse_parameters(self.element.attributes["params"])}
        except (Fault, KeyError):
            return {}


@dataclass(frozen=True)
class Outline:
    """An unexpanded description.

    Attributes:
        root: the root element.
        macros: the macros by name.
        arguments: the ``<xacro:arg>`` by name.
        inclusions: the included files.
    """

    root: Element
    macros: Mapping[str, MacroOutline] = field(default_factory=dict)
    arguments: Mapping[str, Element] = field(default_factory=dict)
    inclusions: tuple[Inclusion, ...] = ()

    @property
    def is_description(self) -> bool:
        """Whether it is a robot, a part of a robot, or another document with macros or arguments."""
        return self.root.tag == "robot" or bool(self.macros) or bool(self.arguments)


def read_outline(file: Path, overlay: Overlay | None = None) -> Outline:
    """Return the outline of a file.

    Args:
        file: the file.
        overlay: texts that replace the contents of files.

    Raises:
        LinkwrightError: the file cannot be read.
    """
    document: Document = read_document(str(file), overlay)
    macros: dict[str, MacroOutline] = {}
    arguments: dict[str, Element] = {}
    for element in document.root.walk():
        name = element.attributes.get("name", "")
        if element.tag == MACRO and name:
            macros[name.removeprefix(_XACRO)] = MacroOutline(name.removeprefix(_XACRO), element)
        elif element.tag == ARG and name:
            arguments[name] = element
    text = "" if document.source is None else document.source.text
    return Outline(document.root, macros, arguments, tuple(inclusions_in(text)))


def try_read_outline(file: Path, overlay: Overlay | None = None) -> Outline | None:
    """Return the outline of a file, or None if it cannot be read."""
    try:
        return read_outline(file, overlay) if file.is_file() else None
    except LinkwrightError:
        return None


def iterate_items(element: Element, conditions: tuple[str, ...] = ()) -> Iterator[Item]:
    """Yield the elements inside an element and its conditions, without macros and arguments."""
    for child in element.elements():
        if child.tag in (ARG, MACRO):
            continue
        if child.tag not in _CONDITIONS:
            for element, inner_conditions in _split_by_conditions(child):
                yield Item(_make_item_key(child), element, (*conditions, *inner_conditions))
        else:
            yield from iterate_items(child, (*conditions, _format_condition(child)))


def _split_by_conditions(element: Element) -> Iterator[tuple[Element, tuple[str, ...]]]:
    """Yield an element, or one for each condition if all contents of a visual or collision depend on conditions.

    The condition then means the same around the element as inside it.
    """
    children = list(element.elements())
    if element.tag not in _SHAPES or not children or any(child.tag not in _CONDITIONS for child in children):
        yield element, ()
        return
    for condition in dict.fromkeys(map(_format_condition, children)):
        part = Element(element.tag, dict(element.attributes), element.source, element.offset, element.origin)
        part.children = [
            inner for child in children if _format_condition(child) == condition for inner in child.children
        ]
        yield part, (condition,)


def _format_condition(element: Element) -> str:
    return f"{_CONDITIONS[element.tag]} {element.attributes.get('value', '')}"


def join_items(items: Sequence[Item], conditions: tuple[str, ...] | None) -> Item:
    """Return several ``<gazebo>`` elements of a link as one.

    Args:
        items: the elements to join.
        conditions: the common conditions of all elements; None if they differ, to keep them around the children.
    """
    first = items[0]
    if conditions is not None:
        return Item(first.key, joined_block([item.element for item in items]), conditions)
    return Item(first.key, joined_block([_move_conditions_inside(item) for item in items]), ())


def _move_conditions_inside(item: Item) -> Element:
    """Return a copy of an element with its conditions around its children."""
    original = item.element
    result = Element(original.tag, dict(original.attributes), original.source, original.offset, original.origin)
    inner = result
    for condition in item.conditions:
        word, _, value = condition.partition(" ")
        child = Element(_CONDITION_TAGS[word], {"value": value}, original.source, original.offset)
        inner.children.append(child)
        inner = child
    inner.children += original.children
    return result


def _make_item_key(element: Element) -> str:
    """Return the tag and name of an element.

    A nameless ``<gazebo>`` gets the name of its plugin or sensor.
    """
    name = element.attributes.get("name") or element.attributes.get("reference")
    if element.tag == GAZEBO and name is None:
        inner = element.first("plugin") or element.first("sensor")
        name = None if inner is None else inner.attributes.get("name")
        return "gazebo" if inner is None else f"gazebo {inner.tag} {name}"
    return f"{element.tag.removeprefix(_XACRO)} {name}" if name else element.tag.removeprefix(_XACRO)


def uses_name(element: Element, name: str) -> bool:
    """Return whether an expression in the attributes or the text of an element uses a name."""
    pattern = re.compile(rf"\$\{{[^}}]*\b{re.escape(name)}\b")
    return any(pattern.search(value) for value in element.attributes.values()) or bool(pattern.search(element.text()))
