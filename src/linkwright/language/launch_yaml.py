"""Language features for launch files in YAML.

The keys are the elements of the XML format.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

from linkwright.language.completion import Completion, ItemKind
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.grammar import rule_at
from linkwright.language.hover import Explanation
from linkwright.language.launch_schema import LAUNCH
from linkwright.language.launch_text import substitution_names
from linkwright.language.launch_values import (
    LaunchText,
    LaunchValue,
    complete_value,
    define_value,
    explain_value,
    links_in,
)
from linkwright.language.links import FileReference
from linkwright.language.yaml_outline import YamlCursor, YamlEntry, YamlOutline, YamlPosition
from linkwright.schema import describe_attribute, describe_element

_CHILDREN = "children"
"""The key of the actions in a timer or a loop."""
_IDENTIFYING_ATTRIBUTES = ("name", "exec", "plugin", "file", "from", "namespace", "target", "cmd")
_MAX_DEPTH = 20


def is_yaml_launch_file(path: Path) -> bool:
    """Return whether a file is a launch file in YAML, by its name."""
    stem = path.name.removesuffix(".yaml").removesuffix(".yml")
    return stem != path.name and (stem == "launch" or stem.endswith((".launch", "_launch")))


def _element_tags(entry: YamlEntry) -> tuple[str, ...]:
    return tuple(key for key in entry.path if key != _CHILDREN)


def _attribute_values(entry: YamlEntry | None) -> Mapping[str, str]:
    return {} if entry is None else {child.key: child.scalar for child in entry.children if child.key and child.value}


def _element_around(entry: YamlEntry) -> YamlEntry | None:
    """Return the element around the element of an entry, or None for the outermost."""
    ancestor = entry.parent
    while ancestor is not None and (not ancestor.key or ancestor.key in (_CHILDREN, entry.key)):
        ancestor = ancestor.parent
    return ancestor


def _find_value(cursor: YamlCursor) -> LaunchValue | None:
    """Return the value at a cursor, or None outside values."""
    entry = cursor.parent_entry
    element = entry.parent
    if cursor.position is not YamlPosition.VALUE or not entry.key or element is None or _is_new_item(cursor):
        return None
    tags = _element_tags(entry)
    if len(tags) < 2:
        return None
    text = entry.scalar if entry.scalar.startswith(cursor.typed) and not cursor.is_in_list else cursor.typed
    owner = element.parent if element.is_item and element.parent is not None else element
    siblings = owner.children if element.is_item else []
    key = "from" if tags[-2] == "remap" else "name"
    names = (name.scalar for item in siblings if item is not element and (name := item.child(key)) is not None)
    parent = _attribute_values(_element_around(owner))
    return LaunchValue(
        tags[:-1], tags[-1], text, cursor.start, cursor.offset, _attribute_values(element), parent, frozenset(names)
    )


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    cursor = YamlOutline(document.text).cursor(offset)
    value = _find_value(cursor)
    if value is not None:
        yield from complete_value(LaunchText(document), value)
    elif cursor.position is YamlPosition.KEY or _is_new_item(cursor):
        yield from _offer_keys(cursor)


def _is_new_item(cursor: YamlCursor) -> bool:
    """Return whether the cursor is at the first key of a new item in a list of elements."""
    return (
        cursor.position is YamlPosition.VALUE
        and cursor.is_in_list
        and rule_at(LAUNCH, _element_tags(cursor.parent_entry)) is not None
    )


def _offer_keys(cursor: YamlCursor) -> Iterator[Completion]:
    parent = cursor.parent_entry
    tags = _element_tags(parent)
    if not tags:
        yield Completion(LAUNCH.tag, ItemKind.ELEMENT, cursor.start, "", describe_element(LAUNCH))
        return
    rule = rule_at(LAUNCH, tags)
    if rule is None:
        return
    present = {child.key for child in parent.children if child is not cursor.entry}
    owner = parent.parent if parent.is_item and parent.parent is not None else parent
    is_action_list = owner.key in _ACTION_LISTS and (parent.is_item or _is_new_item(cursor))
    for attribute in () if is_action_list or not parent.parent else rule.attributes:
        if attribute.name not in present:
            snippet = "" if cursor.entry is not None else f'{attribute.name}: "$1"$0'
            described = describe_attribute(attribute)
            yield Completion(attribute.name, ItemKind.ATTRIBUTE, cursor.start, attribute.type.name, described, snippet)
    for child in rule.child_rules.values():
        if child.tag not in present and child.tag != rule.tag:
            snippet = "" if cursor.entry is not None else f"{child.tag}:$0"
            yield Completion(child.tag, ItemKind.ELEMENT, cursor.start, "", describe_element(child), snippet)


_ACTION_LISTS = frozenset({LAUNCH.tag, "group", _CHILDREN})
"""Keys whose items are actions."""


def _explain(document: Document, offset: int) -> Explanation | None:
    cursor = YamlOutline(document.text).cursor(offset)
    value = _find_value(cursor)
    if value is not None:
        return explain_value(LaunchText(document), value)
    entry = cursor.entry
    if cursor.position is not YamlPosition.KEY or entry is None:
        return None
    tags = _element_tags(entry)
    rule, parent = rule_at(LAUNCH, tags), rule_at(LAUNCH, tags[:-1])
    end = entry.start + len(entry.key)
    attribute = None if parent is None or entry.children else parent.attribute_rules.get(entry.key)
    if attribute is not None:
        return Explanation(describe_attribute(attribute), entry.start, end)
    return None if rule is None else Explanation(describe_element(rule), entry.start, end)


def _define(document: Document, offset: int) -> Iterator[Target]:
    value = _find_value(YamlOutline(document.text).cursor(offset))
    if value is not None:
        yield from define_value(LaunchText(document), value)


def _links(document: Document) -> Iterator[FileReference]:
    launch = LaunchText(document)
    for entry in YamlOutline(document.text).root.all():
        if entry.key and entry.value and not entry.value.startswith(("[", "{")):
            start = entry.value_start + (1 if entry.value[:1] in ("'", '"') else 0)
            yield from links_in(launch, entry.key, entry.scalar, start)


def _symbols(document: Document) -> Iterator[Symbol]:
    yield from _action_symbols(YamlOutline(document.text).root, 0)


def _action_symbols(entry: YamlEntry, depth: int) -> Iterator[Symbol]:
    for child in entry.children if depth < _MAX_DEPTH else ():
        if child.is_item:
            yield from _action_symbols(child, depth + 1)
        elif child.children:
            attributes = _attribute_values(child)
            identifier = next((attributes[name] for name in _IDENTIFYING_ATTRIBUTES if attributes.get(name)), "")
            kind = (
                SymbolKind.NODE
                if "exec" in attributes or "plugin" in attributes
                else _KINDS.get(child.key, SymbolKind.OBJECT)
            )
            inner = tuple(_action_symbols(child, depth + 1))
            yield Symbol(
                f"{child.key} {identifier}".strip(), kind, child.start, child.end, inner, attributes.get("pkg", "")
            )


_KINDS = {
    "launch": SymbolKind.GROUP,
    "group": SymbolKind.GROUP,
    "include": SymbolKind.FILE,
    "arg": SymbolKind.ARGUMENT,
    "let": SymbolKind.ARGUMENT,
    "executable": SymbolKind.FUNCTION,
}

LAUNCH_YAML = Format(is_yaml_launch_file, _complete, _explain, _define, _links, _symbols, prepare=substitution_names)
"""The format of launch files in YAML."""
