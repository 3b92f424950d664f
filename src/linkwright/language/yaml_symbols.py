"""The symbols of a YAML text, and other functions shared by YAML formats."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from linkwright.language.completion import Completion
from linkwright.language.format import Document, Symbol, SymbolKind
from linkwright.language.yaml_outline import YamlEntry, YamlOutline

_MAX_DEPTH = 30
_MAX_SYMBOLS = 20_000
_IDENTIFYING_KEYS = ("Name", "name", "Class", "type", "plugin")
"""The keys whose value names an item of a list, in order of precedence."""


def yaml_symbols(document: Document) -> list[Symbol]:
    """Return the keys and the list items with children of a YAML text as symbols."""
    outline = YamlOutline(document.text)
    count = sum(1 for _ in outline.root.all())
    depth = _MAX_DEPTH if count <= _MAX_SYMBOLS else 1
    return [*_symbols(outline.root.children, depth)]


def _symbols(entries: Iterable[YamlEntry], depth: int) -> Iterator[Symbol]:
    if depth == 0:
        return
    for index, entry in enumerate(entries):
        children = tuple(_symbols(entry.children, depth - 1))
        if entry.is_item:
            if not children:
                continue
            name = next(
                (child.scalar for key in _IDENTIFYING_KEYS if (child := entry.child(key)) and child.scalar), str(index)
            )
            yield Symbol(name, SymbolKind.OBJECT, entry.start, entry.end, children)
            continue
        kind = SymbolKind.GROUP if children else SymbolKind.KEY
        is_node = entry.child("ros__parameters") is not None
        detail = " ".join(entry.value.split())[:60]
        yield Symbol(
            entry.key,
            SymbolKind.NODE if is_node else kind,
            entry.start,
            entry.end,
            children,
            "" if children else detail,
        )


def sort_by_match(items: Iterable[Completion], typed: str) -> list[Completion]:
    """Remove duplicate completions, and sort the others by their match with the typed text.

    Labels that begin with the text come first, then labels that contain it, then the others.
    """
    unique: dict[str, Completion] = {}
    for item in items:
        unique.setdefault(item.label, item)
    low = typed.lower()

    def rank(item: Completion) -> int:
        label = item.label.lower()
        return (
            0 if label.startswith(low) or label.partition("/")[2].startswith(low or "\0") else 1 if low in label else 2
        )

    return sorted(unique.values(), key=rank)


def snippet_text(text: str) -> str:
    """Escape the special characters of snippets in a text."""
    return text.replace("\\", "\\\\").replace("$", "\\$").replace("}", "\\}")


def has_colon(text: str, offset: int) -> bool:
    """Return whether a colon follows an offset in its line, outside a comment."""
    end = text.find("\n", offset)
    rest_of_line = text[offset : end if end >= 0 else len(text)]
    return ":" in rest_of_line.partition("#")[0]
