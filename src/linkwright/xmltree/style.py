"""The style of formatted XML.

This is a module of its own because the settings contain a style, and every check reads them.
"""

from __future__ import annotations

from linkwright.loading.lean_dataclasses import NamedTuple


class Style(NamedTuple):
    """The style of formatted XML.

    Attributes:
        indent: the number of spaces for each level.
        width: the maximum length of a line that can be broken, in characters.
    """

    indent: int = 2
    width: int = 120
