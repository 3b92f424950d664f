"""Normalize texts of unexpanded descriptions, so that they can be compared."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from linkwright.review.parts.arithmetic import evaluate_number
from linkwright.review.parts.outline import ARG, MACRO, PROPERTY, Item
from linkwright.xmltree import Element

CALL = "xacro:"
"""The prefix of the tags of calls of macros."""
_EXPRESSION = re.compile(r"\$\{([^{}]*)\}")
_WORD = re.compile(r"[A-Za-z_]\w*")
_LITERAL = re.compile(r"[^${}]*")


class ComparedContent(NamedTuple):
    """The contents of an element without white space, comments and nested macros."""

    tag: str
    attributes: frozenset[tuple[str, str]]
    text: str
    children: tuple[ComparedContent, ...]


@dataclass(frozen=True)
class NameSubstitution:
    """A substitution of names and values in texts.

    Attributes:
        literals: the values of properties without expressions, by name.
        renamed: the new names of parameters and properties, by old name.
        macros: the new names of macros, by old name.
        passed: the values that all calls of a macro pass for a removed parameter, by its name.
    """

    literals: Mapping[str, str] = field(default_factory=dict)
    renamed: Mapping[str, str] = field(default_factory=dict)
    macros: Mapping[str, str] = field(default_factory=dict)
    passed: Mapping[str, str] = field(default_factory=dict)

    def rename_tag(self, tag: str) -> str:
        """Return the tag of an element, with the new name of a macro that it calls."""
        name = tag.removeprefix(CALL)
        return tag if name == tag else CALL + self.macros.get(name, name)

    def rename_key(self, item: Item) -> str:
        """Return the tag and name that identify an element, with new names."""
        tag = item.element.tag
        old, new = tag.removeprefix(CALL), self.rename_tag(tag).removeprefix(CALL)
        is_call = old != new and item.key.split(" ")[0] == old
        return self.rename_names(new + item.key.removeprefix(old) if is_call else item.key)

    def rename_names(self, text: str) -> str:
        """Return a text with the new names of parameters and properties, and single spaces."""
        text = " ".join(text.split())
        if self.passed:
            text = _EXPRESSION.sub(lambda match: self.passed.get(match[1].strip(), match[0]), text)
        if not self.renamed or "$" not in text:
            return text
        return _EXPRESSION.sub(lambda match: _WORD.sub(lambda word: self.renamed.get(word[0], word[0]), match[0]), text)

    def resolve_values(self, text: str) -> str:
        """Return a text with evaluated expressions and normalized numbers."""
        text = _EXPRESSION.sub(self._resolve_expression, " ".join(text.split()))
        return " ".join(map(_normalize_number, text.split()))

    def _resolve_expression(self, match: re.Match[str]) -> str:
        content = match[1].strip()
        value = self.literals.get(content, content)
        if content in self.literals or _is_number(content):
            return value
        return evaluate_number(content, self.literals) or match[0]

    def normalize_element(self, element: Element) -> ComparedContent:
        """Return comparable contents, without white space, comments and nested macros."""
        attributes = frozenset(
            (name, self.resolve_values(self.rename_names(value))) for name, value in element.attributes.items()
        )
        children = tuple(self.normalize_element(child) for child in element.elements() if child.tag not in (ARG, MACRO))
        text = self.resolve_values(self.rename_names(element.text()))
        return ComparedContent(self.rename_tag(element.tag), attributes, text, children)


def read_literals(root: Element) -> dict[str, str]:
    """Return the literal property values of a file by name."""
    values: dict[str, str | None] = {}
    for name, element in iterate_properties(root):
        value = element.attributes.get("value")
        is_literal = value is not None and _LITERAL.fullmatch(value) is not None and "default" not in element.attributes
        values[name] = value if is_literal and name not in values else None
    return {name: value for name, value in values.items() if value is not None}


def iterate_properties(root: Element) -> Iterator[tuple[str, Element]]:
    """Yield the names and elements of the properties of a file, including those in macros."""
    for element in root.walk():
        if element.tag == PROPERTY and "name" in element.attributes:
            yield element.attributes["name"], element


def _normalize_number(word: str) -> str:
    return f"{float(word):.12g}" if _is_number(word) else word


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
