"""The format with one line per diagnostic.

A line is ``FILE:LINE:COLUMN: SEVERITY[CODE] message (hint)``. Editors and ``grep`` expect lines that begin in this way.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic
from linkwright.diagnostics.render import display_path, make_printable


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return diagnostics as text, one per line."""
    return "".join(f"{_format_line(diagnostic)}\n" for diagnostic in diagnostics)


def _format_line(diagnostic: Diagnostic) -> str:
    span = diagnostic.span
    position = ""
    if span is not None:
        file = span.file if span.file.startswith("<") else display_path(span.file)
        position = f"{file}:{span.line}:{span.column}: "
    message = " ".join(diagnostic.message.split())
    hint = f" ({' '.join(diagnostic.hint.split())})" if diagnostic.hint else ""
    return make_printable(f"{position}{diagnostic.severity.value}[{diagnostic.code}] {message}{hint}")
