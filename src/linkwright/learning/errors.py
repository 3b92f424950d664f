"""Errors in the files of a course."""

from __future__ import annotations

from pathlib import Path

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, Span, display_path, phrase


def file_error(code: str, path: Path, message: Phrase, *, line: int = 1, hint: Phrase | None = None) -> LinkwrightError:
    """Return an error at a line of a file."""
    return LinkwrightError(Diagnostic(code, message, Span(str(path), line, 1, line, 1), hint=hint))


def unreadable_file_error(path: Path, error: OSError | UnicodeDecodeError) -> LinkwrightError:
    """Return LEARN102, the error for a file that cannot be read."""
    reason = getattr(error, "strerror", None) or str(error)
    return LinkwrightError(
        Diagnostic("LEARN102", phrase("cannot read '{path}': {error}", path=display_path(path), error=reason))
    )
