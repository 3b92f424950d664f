"""Diagnostics in the forms that people and programs read."""

from linkwright.diagnostics.formats.choice import FORMATS, format_diagnostics

__all__ = ["FORMATS", "format_diagnostics"]
