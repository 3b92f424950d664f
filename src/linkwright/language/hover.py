"""Explanations of texts, and the definitions of the name at a position in an XML file."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from linkwright.diagnostics import Phrase
from linkwright.language.cursor import CursorSyntax, cursor_at, name_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.grammar import PREFIX, XACRO


@dataclass(frozen=True, slots=True)
class Explanation:
    """An explanation of a range of a text.

    Attributes:
        text: the explanation, in Markdown.
        start: the offset of the range.
        end: the offset after the range.
    """

    text: str | Phrase
    start: int
    end: int


def definitions_at(text: str, offset: int, definitions: Sequence[NameDefinition]) -> list[NameDefinition]:
    """Return the definitions of the macro call, or of the name in a value, at an offset."""
    cursor = cursor_at(text, offset)
    if cursor.syntax in (CursorSyntax.TAG, CursorSyntax.CLOSING_TAG) and cursor.token is not None:
        tag = cursor.token.name
        if tag.startswith(PREFIX) and tag not in XACRO:
            macro_name = tag.removeprefix(PREFIX).rpartition(".")[2]
            return [
                definition
                for definition in definitions
                if definition.kind is NameKind.MACRO and definition.name == macro_name
            ]
        return []
    if cursor.syntax is not CursorSyntax.VALUE or cursor.token is None or cursor.attribute is None:
        return []
    if cursor.is_in_expression or cursor.substitution is not None:
        occurrence = name_at(text, offset)
        kind = NameKind.PROPERTY if cursor.is_in_expression else NameKind.ARGUMENT
        name = "" if occurrence is None else occurrence[0]
        names = (name, name.partition(".")[0])
        return [definition for definition in definitions if definition.kind is kind and definition.name in names]
    value = cursor.attribute.value
    tag = cursor.tags[-1]
    if cursor.attribute.name in ("link", "reference", "joint") or (tag == "material" and cursor.token.is_empty_element):
        kinds = (NameKind.LINK, NameKind.JOINT) if tag != "material" else (NameKind.MATERIAL,)
        return [definition for definition in definitions if definition.kind in kinds and definition.name == value]
    return []


def describe_definition(definition: NameDefinition) -> str:
    """Return a definition with its value or parameters, in Markdown."""
    detail = f" = `{definition.detail}`" if definition.detail and definition.kind is not NameKind.MACRO else ""
    parameters = f"\n\n`{definition.detail}`" if definition.kind is NameKind.MACRO and definition.detail else ""
    return f"**{definition.kind.value} {definition.name}**{detail}, {definition.file.name}{parameters}"
