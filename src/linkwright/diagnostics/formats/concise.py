"""One line for each diagnostic: ``FILE:LINE:COLUMN: CODE message``.

Editors and ``grep`` expect this format.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic
from linkwright.diagnostics.render import display_path, printable


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Format diagnostics, one per line."""
    return "".join(f"{_line(diagnostic)}\n" for diagnostic in diagnostics)


def _line(diagnostic: Diagnostic) -> str:
    span = diagnostic.span
    place = ""
    if span is not None:
        file = span.file if span.file.startswith("<") else display_path(span.file)
        place = f"{file}:{span.line}:{span.column}: "
    message = " ".join(diagnostic.message.split())
    hint = f" ({' '.join(diagnostic.hint.split())})" if diagnostic.hint else ""
    return printable(f"{place}{diagnostic.severity.value}[{diagnostic.code}] {message}{hint}")
