"""The style of formatted XML; a module of its own, because every check reads the settings that contain it."""

from __future__ import annotations

from linkwright.loading.lean_dataclasses import NamedTuple


class Style(NamedTuple):
    """The options of a format.

    Attributes:
        indent: the number of spaces for each level.
        width: the longest line, in characters, where a line can be broken.
    """

    indent: int = 2
    width: int = 120
