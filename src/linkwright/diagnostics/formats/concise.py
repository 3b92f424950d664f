"""One line for each diagnostic, as editors and ``grep`` read them: ``FILE:LINE:COLUMN: CODE message``."""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic
from linkwright.diagnostics.render import display_path, printable


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """The diagnostics, a line each."""
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
