"""Explanations of a place in an XML file: elements, attributes, macros, properties and packages."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from linkwright.diagnostics import Phrase
from linkwright.language.cursor import Spot, cursor_at, name_at
from linkwright.language.definitions import NameDefinition, NameKind
from linkwright.language.grammar import PREFIX, XACRO, root_of, rule_at
from linkwright.language.occurrences import Occurrence
from linkwright.language.parameters import macro_parameters
from linkwright.language.renaming import occurrence_at
from linkwright.schema import describe_attribute, describe_element


@dataclass(frozen=True, slots=True)
class Explanation:
    """An explanation of a range of a text.

    Attributes:
        text: the explanation, in Markdown.
        start: the offset of the range.
        end: the offset behind it.
    """

    text: str | Phrase
    start: int
    end: int


def explain_at(text: str, offset: int, file: Path, names: Sequence[NameDefinition]) -> Explanation | None:
    """Explain what is at an offset; None if there is nothing to say."""
    cursor = cursor_at(text, offset)
    use = occurrence_at(text, file, offset)
    if use is not None and use.kind is NameKind.PARAMETER:
        described = list(_described_parameter(use, names))
        return Explanation("\n\n".join(described), use.start, use.end) if described else None
    found = definitions_at(text, offset, names)
    if found:
        name = name_at(text, offset)
        start, end = (name[1], name[1] + len(name[0])) if name else (offset, offset)
        return Explanation("\n\n".join(map(_described, found)), start, end)
    root = root_of(file)
    if root is None or cursor.token is None:
        return None
    if cursor.spot is Spot.TAG:
        tags = (*cursor.tags, cursor.token.name)
        rule = XACRO.get(cursor.token.name) or rule_at(root, tags)
        start = cursor.token.name_start
        return None if rule is None else Explanation(describe_element(rule), start, start + len(cursor.token.name))
    if cursor.attribute is not None:
        rule = XACRO.get(cursor.tags[-1]) or rule_at(root, cursor.tags)
        attribute = None if rule is None else rule.attribute_rules.get(cursor.attribute.name)
        if attribute is not None:
            return Explanation(describe_attribute(attribute), cursor.attribute.start, cursor.attribute.end)
    return None


def definitions_at(text: str, offset: int, names: Sequence[NameDefinition]) -> list[NameDefinition]:
    """Return the definitions of the name at an offset: of a macro call, or of a name in a value."""
    cursor = cursor_at(text, offset)
    if cursor.spot in (Spot.TAG, Spot.CLOSING_TAG) and cursor.token is not None:
        tag = cursor.token.name
        if tag.startswith(PREFIX) and tag not in XACRO:
            wanted = tag.removeprefix(PREFIX).rpartition(".")[2]
            return [name for name in names if name.kind is NameKind.MACRO and name.name == wanted]
        return []
    if cursor.spot is not Spot.VALUE or cursor.token is None or cursor.attribute is None:
        return []
    if cursor.in_expression or cursor.substitution is not None:
        word = name_at(text, offset)
        kind = NameKind.PROPERTY if cursor.in_expression else NameKind.ARGUMENT
        wanted = "" if word is None else word[0]
        return [name for name in names if name.kind is kind and name.name in (wanted, wanted.partition(".")[0])]
    value = cursor.attribute.value
    tag = cursor.tags[-1]
    if cursor.attribute.name in ("link", "reference", "joint") or (tag == "material" and cursor.token.is_empty_element):
        kinds = (NameKind.LINK, NameKind.JOINT) if tag != "material" else (NameKind.MATERIAL,)
        return [name for name in names if name.kind in kinds and name.name == value]
    return []


def _described_parameter(use: Occurrence, names: Sequence[NameDefinition]) -> Iterator[str]:
    for macro in names:
        if macro.kind is NameKind.MACRO and macro.name.removeprefix(PREFIX) == use.owner:
            for parameter in macro_parameters(macro):
                if parameter.name.lstrip("*") == use.name:
                    default = "" if parameter.default is None else f" = `{parameter.default}`"
                    yield f"**parameter {use.name}**{default}, macro {use.owner}, {macro.file.name}"


def _described(name: NameDefinition) -> str:
    detail = f" = `{name.detail}`" if name.detail and name.kind is not NameKind.MACRO else ""
    parameters = f"\n\n`{name.detail}`" if name.kind is NameKind.MACRO and name.detail else ""
    return f"**{name.kind.value} {name.name}**{detail}, {name.file.name}{parameters}"
