"""A guard against documents that grow without bound when their entities are expanded ("billion laughs")."""

from __future__ import annotations

import re

GROWTH_LIMIT = 1_000_000
"""How many characters the entities of one document may expand to, all together."""

_REFERENCE = r"&([^\s#;&<]+);"  # not compiled here: few files need it


class EntityGuard:
    """The internal entities that a document declares, and how long each one is when expanded."""

    def __init__(self) -> None:
        self._values: dict[str, str] = {}
        self._lengths: dict[str, int] = {}

    def __bool__(self) -> bool:
        return bool(self._values)

    def declare(self, name: str, value: str) -> None:
        """Remember an internal entity; of two with the same name the first applies, as in XML."""
        self._values.setdefault(name, value)

    def growth(self, text: str) -> int:
        """How many characters the references to declared entities in a text expand to, together."""
        return sum(self._length(name, ()) for name in re.findall(_REFERENCE, text))

    def _length(self, name: str, within: tuple[str, ...]) -> int:
        value = self._values.get(name)
        if value is None or name in within:  # predefined or undeclared; recursion is the parser's to report
            return 0
        known = self._lengths.get(name)
        if known is None:
            if len(within) > 100:
                return GROWTH_LIMIT + 1
            known = len(value) + sum(self._length(inner, (*within, name)) for inner in re.findall(_REFERENCE, value))
            known = self._lengths[name] = min(known, GROWTH_LIMIT + 1)
        return known
