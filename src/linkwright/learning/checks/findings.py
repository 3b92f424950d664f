"""Findings about the learner's files as one line of text, with the location and the hint."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Span, phrase


def describe_finding(finding: Diagnostic, file: str | None = None) -> Phrase:
    """Return a finding as one line.

    The line has the file, the position, the message, the code, and the hint if there is one.

    Args:
        finding: the finding about a file of the learner.
        file: the file to name if the finding has no place.
    """
    text = phrase("{message} [{code}]", message=finding.message, code=finding.code)
    if finding.span is not None:
        text = _at_location(finding.span, text)
    elif file is not None:
        text = phrase("{file}: {message}", file=file, message=text)
    return add_hint(text, finding.hint)


def describe_error(error: LinkwrightError, file: str | None = None) -> Phrase:
    """Return the first finding of an error as one line; see `describe_finding`."""
    return describe_finding(error.diagnostics[0], file)


def add_hint(message: Phrase, hint: Phrase | None) -> Phrase:
    """Return a message followed by a hint, or the message alone if there is no hint."""
    return message if hint is None else phrase("{message}; {hint}", message=message, hint=hint)


def _at_location(span: Span, text: Phrase) -> Phrase:
    name = Path(span.file).name
    if _is_line(span):
        return phrase("{file}, line {line}: {text}", file=name, line=span.line, text=text)
    return phrase(
        "{file}, line {line}, column {column}: {message}", file=name, line=span.line, column=span.column, message=text
    )


def _is_line(span: Span) -> bool:
    """Return whether a span locates a line without a column."""
    return span.column == 1 and (span.line, span.column) == (span.end_line, span.end_column)
