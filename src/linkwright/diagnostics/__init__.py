"""Findings about a user's input, with a message, a location, notes and a hint."""

from linkwright.diagnostics.diagnostic import (
    Diagnostic,
    LinkwrightError,
    Note,
    Severity,
    SourceText,
    Span,
    has_errors,
    join_messages,
)
from linkwright.diagnostics.extras import install_hint, missing_extra, package_hint
from linkwright.diagnostics.phrase import (
    Phrase,
    counted,
    foreign,
    joined,
    joined_first,
    phrase,
    quoted,
    quoted_names,
    term,
    title_of_page,
)
from linkwright.diagnostics.render import (
    display_path,
    print_diagnostics,
    render,
    shows_absolute_paths,
    to_data,
    wants_color,
)
from linkwright.diagnostics.suggest import (
    as_typed,
    did_you_mean,
    is_misspelled,
    missing_file_hint,
    nearest,
    words_of,
)
from linkwright.diagnostics.translation import translated

__all__ = [
    "Diagnostic",
    "LinkwrightError",
    "Note",
    "Phrase",
    "Severity",
    "SourceText",
    "Span",
    "as_typed",
    "counted",
    "did_you_mean",
    "display_path",
    "foreign",
    "has_errors",
    "install_hint",
    "is_misspelled",
    "join_messages",
    "joined",
    "joined_first",
    "missing_extra",
    "missing_file_hint",
    "nearest",
    "package_hint",
    "phrase",
    "print_diagnostics",
    "quoted",
    "quoted_names",
    "render",
    "shows_absolute_paths",
    "term",
    "title_of_page",
    "to_data",
    "translated",
    "wants_color",
    "words_of",
]
