"""Formats in which people and programs read diagnostics."""

from linkwright.diagnostics.formats.choice import FORMATS, format_diagnostics

__all__ = ["FORMATS", "format_diagnostics"]
