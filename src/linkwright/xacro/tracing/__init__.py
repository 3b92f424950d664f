"""Traced expansions, which yield arguments, provenance of elements, and the property log."""
