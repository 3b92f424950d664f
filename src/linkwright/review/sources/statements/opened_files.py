"""Find the files that an added Python script reads and writes."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from linkwright.diagnostics import Phrase, Span, joined, joined_first, phrase
from linkwright.packages.readers.python_values import PythonFile, called_name
from linkwright.review.changes import MAX_NAMES
from linkwright.review.sources.python.wrappers import get_argument
from linkwright.review.sources.python_names import parse_source
from linkwright.review.sources.reading import try_read_source
from linkwright.review.texts.excerpts import shorten_middle

_METHODS = {"read_text": False, "read_bytes": False, "write_text": True, "write_bytes": True}
"""The methods of paths, and whether they write the file."""
_WRITING_MODES = frozenset("wax+")
_MAX_CHARACTERS = 80


def describe_opened_files(path: Path) -> tuple[Phrase, Span] | None:
    """Return the files that a Python source reads and writes, and where it opens the first one; None if there is none.

    Variables without a known value tell nothing and are left out.

    Args:
        path: the source.
    """
    source = try_read_source(path)
    try:
        python = None if source is None else parse_source(source)
    except (SyntaxError, ValueError, RecursionError):
        return None
    if python is None:
        return None
    found = sorted(_find_files(python), key=lambda item: (item[1].lineno, item[1].col_offset))
    found = [(is_written, node) for is_written, node in found if not isinstance(python.resolved(node), ast.Name)]
    groups = [
        list(dict.fromkeys(_format(python, node) for is_written, node in found if is_written == is_written_group))
        for is_written_group in (True, False)
    ]
    parts = [phrase("files written: {files}", files=joined_first(groups[0], MAX_NAMES))] if groups[0] else []
    parts += [phrase("files read: {files}", files=joined_first(groups[1], MAX_NAMES))] if groups[1] else []
    return (joined(parts, "; "), python.span(found[0][1])) if parts else None


def _find_files(python: PythonFile) -> Iterator[tuple[bool, ast.expr]]:
    """Yield the expressions for files that calls open, each with whether the file is written."""
    for call in (node for node in ast.walk(python.tree) if isinstance(node, ast.Call)):
        if called_name(call) == "open" and call.args:
            mode = python.text(get_argument(call, 1, "mode")) or ""
            yield not _WRITING_MODES.isdisjoint(mode), call.args[0]
        elif isinstance(call.func, ast.Attribute) and call.func.attr in _METHODS:
            yield _METHODS[call.func.attr], call.func.value


def _format(python: PythonFile, node: ast.expr) -> str:
    text = python.text(node)
    return (
        f"'{text}'" if text is not None else shorten_middle(f"`{ast.unparse(python.resolved(node))}`", _MAX_CHARACTERS)
    )
