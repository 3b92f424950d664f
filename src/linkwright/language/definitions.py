"""Names that texts define: macros, properties, arguments, links, joints and materials."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from pathlib import Path

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


_TAGS = {
    "xacro:macro": NameKind.MACRO,
    "xacro:property": NameKind.PROPERTY,
    "xacro:arg": NameKind.ARGUMENT,
    "link": NameKind.LINK,
    "joint": NameKind.JOINT,
    "material": NameKind.MATERIAL,
}
_DETAILS = {NameKind.MACRO: "params", NameKind.PROPERTY: "value", NameKind.ARGUMENT: "default", NameKind.JOINT: "type"}


@dataclass(frozen=True, slots=True)
class NameDefinition:
    """A definition of a name.

    Attributes:
        kind: the kind of the name.
        name: the name as written, which may contain expressions.
        file: the file.
        start: the offset of the name in the text of the file.
        detail: the parameters of a macro, the value of a property, the default of an argument, the type of a joint.
    """

    kind: NameKind
    name: str
    file: Path
    start: int
    detail: str


def definitions_in(text: str, file: Path) -> Iterator[NameDefinition]:
    """Yield the definitions in a text, which may be incomplete.

    A ``<material name="..."/>`` without content is a use and not a definition.
    """
    for token in tokens(text):
        kind = _TAGS.get(token.name) if token.kind is Kind.START else None
        if kind is None or (kind is NameKind.MATERIAL and token.is_whole):
            continue
        given: dict[str, TokenAttribute] = {attribute.name: attribute for attribute in token.attributes()}
        name = given.get("name")
        if name is not None and name.value:
            detail = given.get(_DETAILS.get(kind, ""))
            yield NameDefinition(kind, name.value, file, name.value_start, (detail.value or "") if detail else "")
