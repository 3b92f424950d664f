"""The style of formatted XML.

This is a separate module, so that the settings, which every check reads, do not import the formatter.
"""

from __future__ import annotations

from linkwright.loading.lean_dataclasses import NamedTuple


class Style(NamedTuple):
    """The indentation and line width of formatted XML.

    Attributes:
        indent: the number of spaces for each level.
        width: the maximum length of a line in characters, if the line can be broken.
    """

    indent: int = 2
    width: int = 120
