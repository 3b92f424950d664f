"""The default size of the live history.

The constant has its own module because the help of commands needs it and must be displayed quickly.
"""

DEFAULT_HISTORY = 256_000_000
"""Bytes of live history that a viewer stores; the viewer's guide gives the corresponding time."""
