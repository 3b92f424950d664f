"""Findings in the notation of ``mistakes.md``."""

from __future__ import annotations

from linkwright.diagnostics import Diagnostic
from linkwright.urdf import read
from linkwright.urdf.plaintext import parse_as_urdfdom


def describe_findings(text: str) -> str:
    """Return the reader's findings about a URDF text, with one line for each fact."""
    reading = read(parse_as_urdfdom(text, "robot.urdf")[0])
    lines = [line for diagnostic in reading.diagnostics for line in finding_lines(diagnostic)]
    return "\n".join([*lines, "robot: none" if reading.robot is None else "robot: kept"])


def finding_lines(diagnostic: Diagnostic) -> list[str]:
    """Return one finding, with one line for each fact."""
    span, source = diagnostic.span, diagnostic.source
    assert span is not None
    assert source is not None
    start, end = source.offset(span.line, span.column), source.offset(span.end_line, span.end_column)
    marked = source.text[start:end].replace("\n", "\\n")
    lines = [f"{diagnostic.severity.value} {diagnostic.code} {span.line}:{span.column} [{marked}]"]
    lines.append(f"  {diagnostic.message}".replace("\n", "\\n"))
    for note in diagnostic.notes:
        place = f" ({note.span.line}:{note.span.column})" if note.span else ""
        lines.append(f"  note: {note.message}{place}")
    if diagnostic.hint:
        lines.append(f"  hint: {diagnostic.hint}")
    return lines
