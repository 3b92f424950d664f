"""Findings of Linkwright as messages of checks: one sentence with the place and what to do."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, phrase


def describe_finding(finding: Diagnostic) -> Phrase:
    """Return a finding as one sentence with its file, its line, and its hint."""
    described = phrase("{message} [{code}]", message=finding.message, code=finding.code)
    if finding.span is not None:
        described = phrase(
            "{file}, line {line}: {message} [{code}]",
            file=Path(finding.span.file).name,
            line=finding.span.line,
            message=finding.message,
            code=finding.code,
        )
    return add_hint(described, finding.hint)


def describe_error(error: LinkwrightError) -> Phrase:
    """Return the first finding of an error as one sentence; see `describe_finding`."""
    return describe_finding(error.diagnostics[0])


def add_hint(message: Phrase, hint: Phrase | None) -> Phrase:
    """Return a message with a hint behind it, or the message alone if there is no hint."""
    return message if hint is None else phrase("{message}; {hint}", message=message, hint=hint)
