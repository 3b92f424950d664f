"""Name the members of a class that only one version declares."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from linkwright.diagnostics import Phrase, joined_first, phrase

_MAX_MEMBERS = 12
_TEMPLATE = re.compile(r"<[^<>]*>")
_NO_MEMBERS = re.compile(r"(?:class|struct|enum|union|using|typedef|friend|public|private|protected|namespace|#)\b|@")
"""The beginnings of statements that declare no members, and of the head of the class itself."""
_OPERATOR = re.compile(r"\boperator\b|=\s*delete\b")
_NAME = re.compile(r"(?P<name>~?\s*[A-Za-z_]\w*)\s*(?:\Z|[=({;\[]|:(?!:))")


def format_changed_class(name: str, old: Sequence[str], new: Sequence[str]) -> Phrase | str:
    """Return the name of a class with the members that only one version declares.

    Args:
        name: the name of the class.
        old: the statements of the class in the old version, outside of its functions.
        new: those in the new version.
    """
    before, after = _list_members(old), _list_members(new)
    added = joined_first([item for item in after if item not in before], _MAX_MEMBERS)
    removed = joined_first([item for item in before if item not in after], _MAX_MEMBERS)
    has_added, has_removed = not after.keys() <= before.keys(), not before.keys() <= after.keys()
    if has_added and has_removed:
        return phrase("'{name}' (added: {added}; removed: {removed})", name=name, added=added, removed=removed)
    if has_added:
        return phrase("'{name}' (added: {added})", name=name, added=added)
    if has_removed:
        return phrase("'{name}' (removed: {removed})", name=name, removed=removed)
    return f"'{name}'"


def _list_members(statements: Iterable[str]) -> dict[str, None]:
    """Return the names that statements declare, in their order."""
    names: dict[str, None] = {}
    statements = list(statements)
    if any(text.lstrip().startswith("enum ") for text in statements[:1]):
        return names
    for text in statements:
        while (inner := _TEMPLATE.sub("", text)) != text:
            text = inner
        is_other = _NO_MEMBERS.match(text.strip()) or _OPERATOR.search(text)
        for declarator in () if is_other else _split_declarators(text):
            match = _NAME.search(declarator.strip())
            if match is not None:
                names["".join(match["name"].split())] = None
    return names


def _split_declarators(text: str) -> list[str]:
    """Return the declarators of a statement without templates, the first with its type: ``int a`` and ``b``."""
    masked, depth = "", 0
    for character in text:
        depth += (character in "([{") - (character in ")]}")
        masked += "\0" if character == "," and depth == 0 else character
    return masked.split("\0")
