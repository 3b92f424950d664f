"""The default size of the viewer's history.

The constant has its own module because the help of commands needs it, and must appear quickly.
"""

DEFAULT_HISTORY = 256_000_000
"""The maximum number of bytes of messages that a viewer stores.

The guide of the viewer states the time that they cover.
"""
