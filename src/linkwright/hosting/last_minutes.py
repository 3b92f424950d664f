"""How much of the last minutes is kept; by itself, because the help of commands says it and imports nothing large."""

DEFAULT_HISTORY = 256_000_000
"""Bytes of the last minutes that a viewer keeps; the guide of the viewer says how long a time that is."""
