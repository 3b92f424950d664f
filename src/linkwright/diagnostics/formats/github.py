"""Diagnostics as workflow commands of GitHub Actions.

GitHub shows each diagnostic next to its line in the pull request.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic, Severity
from linkwright.diagnostics.render import display_path

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Return diagnostics as text, one workflow command per line."""
    return "".join(f"{_format_command(diagnostic)}\n" for diagnostic in diagnostics)


def _format_command(diagnostic: Diagnostic) -> str:
    properties = {}
    span = diagnostic.span
    if span is not None and not span.file.startswith("<"):
        properties["file"] = display_path(span.file)
        properties["line"] = str(span.line)
        properties["endLine"] = str(span.end_line)
        if span.end_line == span.line:  # GitHub rejects columns in an annotation of several lines
            properties["col"] = str(span.column)
            properties["endColumn"] = str(max(span.column, span.end_column - 1))
    properties["title"] = diagnostic.code
    property_text = ",".join(f"{name}={_escape_property(value)}" for name, value in properties.items())
    text: str = diagnostic.message
    for note in diagnostic.notes:
        position = f" ({display_path(note.span.file)}:{note.span.line}:{note.span.column})" if note.span else ""
        text += f"\nnote: {note.message}{position}"
    if diagnostic.hint:
        text += f"\nhint: {diagnostic.hint}"
    return f"::{_COMMANDS[diagnostic.severity]} {property_text}::{_escape_data(text)}"


def _escape_data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _escape_property(text: str) -> str:
    return _escape_data(text).replace(":", "%3A").replace(",", "%2C")
