"""Traced expansions: arguments, provenance of elements, and the property log."""
