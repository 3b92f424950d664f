"""The default size of the live history.

It is in a separate module because commands' help needs it and must load quickly.
"""

DEFAULT_HISTORY = 256_000_000
"""Bytes of live history that a viewer stores; the viewer's guide gives the corresponding time."""
