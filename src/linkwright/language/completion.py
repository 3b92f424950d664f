"""Completions, and functions that select and sort the names of a description for them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

from linkwright.diagnostics import Phrase
from linkwright.language.definitions import NameDefinition, NameKind


class ItemKind(Enum):
    """The kinds of completions, for the icons of editors."""

    ELEMENT = "element"
    ATTRIBUTE = "attribute"
    VALUE = "value"
    MACRO = "macro"
    PROPERTY = "property"
    FUNCTION = "function"
    NAME = "name"
    PACKAGE = "package"
    FILE = "file"
    FOLDER = "folder"


@dataclass(frozen=True, slots=True)
class Completion:
    """A completion.

    Attributes:
        label: the text to show and, without a snippet, to insert.
        kind: its kind.
        start: the offset from which the typed text is replaced, up to the cursor.
        detail: a few words beside the label.
        description: a text in Markdown.
        snippet: the text to insert, in snippet syntax, or empty to insert the label.
    """

    label: str
    kind: ItemKind
    start: int
    detail: str = ""
    description: str | Phrase = ""
    snippet: str = ""


def definitions_of_kind(names: Sequence[NameDefinition], kind: NameKind) -> list[NameDefinition]:
    """Return the first definition of each name of a kind."""
    first_definitions: dict[str, NameDefinition] = {}
    for name in names:
        if name.kind is kind:
            first_definitions.setdefault(name.name, name)
    return list(first_definitions.values())


def sorted_by_use(names: Iterable[NameDefinition], text: str) -> list[NameDefinition]:
    """Return definitions sorted by the frequency of their names in a text, in descending order."""
    return sorted(names, key=lambda name: -text.count(name.name))
