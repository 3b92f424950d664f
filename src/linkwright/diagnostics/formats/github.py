"""Workflow commands of GitHub Actions.

GitHub shows each diagnostic next to its line in the pull request.
"""

from __future__ import annotations

from collections.abc import Iterable

from linkwright.diagnostics.diagnostic import Diagnostic, Severity
from linkwright.diagnostics.render import display_path

_COMMANDS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "notice"}


def to_text(diagnostics: Iterable[Diagnostic]) -> str:
    """Format diagnostics as workflow commands, one for each."""
    return "".join(f"{_command(diagnostic)}\n" for diagnostic in diagnostics)


def _command(diagnostic: Diagnostic) -> str:
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
    written = ",".join(f"{name}={_property(value)}" for name, value in properties.items())
    text: str = diagnostic.message
    for note in diagnostic.notes:
        place = f" ({display_path(note.span.file)}:{note.span.line}:{note.span.column})" if note.span else ""
        text += f"\nnote: {note.message}{place}"
    if diagnostic.hint:
        text += f"\nhint: {diagnostic.hint}"
    return f"::{_COMMANDS[diagnostic.severity]} {written}::{_data(text)}"


def _data(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _data(text).replace(":", "%3A").replace(",", "%2C")
