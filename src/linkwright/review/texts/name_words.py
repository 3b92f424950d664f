"""Split names into words, in any notation."""

from __future__ import annotations

import re

_WORD = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")


def split_name(name: str) -> list[str]:
    """Return the words and numbers of a name in lower case, such as of ``setMaxSpeed2`` or ``set_max_speed_2``."""
    return [word.lower() for word in _WORD.findall(name)]
