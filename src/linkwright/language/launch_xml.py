"""Language features for launch files in XML."""

from __future__ import annotations

from collections.abc import Iterator

from linkwright.language.completion import Completion
from linkwright.language.cursor import CursorSyntax, cursor_at
from linkwright.language.format import Document, Format, Symbol, SymbolKind, Target
from linkwright.language.grammar import is_launch_file
from linkwright.language.hover import Explanation
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
from linkwright.language.outline import Outline, OutlineElement
from linkwright.language.xml_completion import complete
from linkwright.language.xml_hover import explain_at
from linkwright.xmltree.tokens import Kind, Token, tokens


def _attribute_values(token: Token) -> dict[str, str]:
    return {attribute.name: attribute.value or "" for attribute in token.attributes()}


def _value_at(text: str, offset: int) -> LaunchValue | None:
    """Return the value of an attribute at an offset, or None if there is none."""
    cursor = cursor_at(text, offset)
    if cursor.syntax is not CursorSyntax.VALUE or cursor.attribute is None or cursor.token is None:
        return None
    token = cursor.token
    parent = _find_parent(text, token)
    siblings = [] if parent is None else parent.children
    key = "from" if token.name == "remap" else "name"
    others = (_attribute_values(child.tag).get(key, "") for child in siblings if child.tag.start != token.start)
    return LaunchValue(
        cursor.tags,
        cursor.attribute.name,
        cursor.attribute.value or "",
        cursor.attribute.value_start,
        offset,
        _attribute_values(token),
        {} if parent is None else _attribute_values(parent.tag),
        frozenset(others),
    )


def _find_parent(text: str, token: Token) -> OutlineElement | None:
    """Return the element that contains a start tag, or None if there is none."""
    ancestors = [
        element for element in Outline.of(text).elements_around(token.start) if element.tag.start < token.start
    ]
    return next((element for element in reversed(ancestors) if element.end > token.start), None)


def _complete(document: Document, offset: int) -> Iterator[Completion]:
    value = _value_at(document.text, offset)
    if value is not None:
        yield from complete_value(LaunchText(document), value)
    else:
        yield from complete(document, offset)


def _explain(document: Document, offset: int) -> Explanation | None:
    value = _value_at(document.text, offset)
    explanation = None if value is None else explain_value(LaunchText(document), value)
    return explanation or explain_at(document, offset)


def _define(document: Document, offset: int) -> Iterator[Target]:
    value = _value_at(document.text, offset)
    if value is not None:
        yield from define_value(LaunchText(document), value)


def _links(document: Document) -> Iterator[FileReference]:
    launch = LaunchText(document)
    for token in tokens(document.text):
        for attribute in token.attributes() if token.kind is Kind.START else ():
            yield from links_in(launch, attribute.name, attribute.value or "", attribute.value_start)


# --- symbols --------------------------------------------------------------------------------------------------

_KINDS = {
    "launch": SymbolKind.GROUP,
    "group": SymbolKind.GROUP,
    "include": SymbolKind.FILE,
    "arg": SymbolKind.ARGUMENT,
    "bool_arg": SymbolKind.ARGUMENT,
    "let": SymbolKind.ARGUMENT,
    "param": SymbolKind.FIELD,
    "remap": SymbolKind.KEY,
    "executable": SymbolKind.FUNCTION,
    **dict.fromkeys(("node", "lifecycle_node", "composable_node", "node_container"), SymbolKind.NODE),
}
_MAX_DEPTH = 50
"""The maximum depth of symbols."""
_IDENTIFYING_ATTRIBUTES = ("name", "exec", "plugin", "file", "from", "namespace", "target", "cmd")


def _list_symbols(document: Document) -> Iterator[Symbol]:
    return (_make_symbol(element, 0) for element in Outline.of(document.text).elements)


def _make_symbol(element: OutlineElement, depth: int) -> Symbol:
    attributes = _attribute_values(element.tag)
    identifier = next((attributes[name] for name in _IDENTIFYING_ATTRIBUTES if attributes.get(name)), "")
    kind = _KINDS.get(element.tag.name, SymbolKind.OBJECT)
    children = tuple(_make_symbol(child, depth + 1) for child in element.children) if depth < _MAX_DEPTH else ()
    name = f"{element.tag.name} {identifier}".strip()
    return Symbol(name, kind, element.tag.start, element.end, children, attributes.get("pkg", ""))


LAUNCH_XML = Format(is_launch_file, _complete, _explain, _define, _links, _list_symbols, prepare=substitution_names)
"""The format of launch files in XML."""
