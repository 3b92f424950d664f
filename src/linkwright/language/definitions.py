"""Names that texts define: macros, properties, arguments, links, joints and materials."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from linkwright.loading.deferred import lazy_pattern
from linkwright.xmltree.tokens import Kind, TokenAttribute, tokens


class NameKind(Enum):
    """The kinds of names."""

    MACRO = "macro"
    PROPERTY = "property"
    ARGUMENT = "argument"
    PARAMETER = "parameter"
    LINK = "link"
    JOINT = "joint"
    MATERIAL = "material"


_MACRO = "xacro:macro"
_KINDS_BY_TAG = {
    _MACRO: NameKind.MACRO,
    "xacro:property": NameKind.PROPERTY,
    "xacro:arg": NameKind.ARGUMENT,
    "link": NameKind.LINK,
    "joint": NameKind.JOINT,
    "material": NameKind.MATERIAL,
}
_COLOR = lazy_pattern(r"""(?:(?!</?material).){0,1000}?<color\b[^>]*?\brgba\s*=\s*["']([^"']*)["']""", re.DOTALL)
_DETAIL_ATTRIBUTES = {
    NameKind.MACRO: "params",
    NameKind.PROPERTY: "value",
    NameKind.ARGUMENT: "default",
    NameKind.JOINT: "type",
}


@dataclass(frozen=True, slots=True)
class NameDefinition:
    """A definition of a name.

    Attributes:
        kind: the kind of the name.
        name: the name as written, which may contain expressions.
        file: the file that contains the definition.
        start: the offset of the name in the text of the file.
        detail: the parameters of a macro, the value of a property, the default of an argument, the type of a
            joint, or the ``rgba`` of a material.
        owner: the macro whose content defines the name, or empty outside macros and for properties of a wider scope.
    """

    kind: NameKind
    name: str
    file: Path
    start: int
    detail: str
    owner: str = ""


def definitions_in(text: str, file: Path) -> Iterator[NameDefinition]:
    """Yield the definitions in a text, which may be incomplete.

    A ``<material name="..."/>`` without content is a use, not a definition.
    """
    macros: list[str] = []
    for token in tokens(text):
        if token.name == _MACRO and token.kind is Kind.END and macros:
            macros.pop()
        kind = _KINDS_BY_TAG.get(token.name) if token.kind is Kind.START else None
        if kind is None:
            continue
        attributes: dict[str, TokenAttribute] = {attribute.name: attribute for attribute in token.attributes()}
        name = attributes.get("name")
        if name is not None and name.value and not (kind is NameKind.MATERIAL and token.is_empty_element):
            detail, scope = attributes.get(_DETAIL_ATTRIBUTES.get(kind, "")), attributes.get("scope")
            owner = "" if not macros or (scope is not None and scope.value) else macros[-1]
            detail_text = (detail.value or "") if detail else ""
            if kind is NameKind.MATERIAL:
                color = _COLOR.match(text, token.end)
                detail_text = color[1] if color else ""
            yield NameDefinition(kind, name.value, file, name.value_start, detail_text, owner)
        if kind is NameKind.MACRO and not token.is_empty_element:
            macros.append("" if name is None else name.value or "")
