"""Formats of diagnostics, for people and for programs."""

from linkwright.diagnostics.formats.choice import FORMATS, format_diagnostics

__all__ = ["FORMATS", "format_diagnostics"]
