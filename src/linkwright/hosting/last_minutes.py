"""The default size of the live history; a module of its own because commands' help needs it and must load quickly."""

DEFAULT_HISTORY = 256_000_000
"""Bytes of live history that a viewer stores; the viewer's guide gives the corresponding time."""
