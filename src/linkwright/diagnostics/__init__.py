"""Findings about a user's input: where, what, why, how to mend it; and how they are printed."""

from linkwright.diagnostics.diagnostic import Diagnostic, LinkwrightError, Note, Severity, has_errors
from linkwright.diagnostics.render import display_path, print_diagnostics, render, to_data, wants_colour
from linkwright.diagnostics.source import SourceText, Span
from linkwright.diagnostics.suggest import did_you_mean, missing_file_hint, nearest
from linkwright.diagnostics.translation import translated

__all__ = [
    "Diagnostic",
    "LinkwrightError",
    "Note",
    "Severity",
    "SourceText",
    "Span",
    "did_you_mean",
    "display_path",
    "has_errors",
    "missing_file_hint",
    "nearest",
    "print_diagnostics",
    "render",
    "to_data",
    "translated",
    "wants_colour",
]
