"""Counts links without parsing a world completely.

For a huge world, parsing would take minutes and gigabytes.
"""

from __future__ import annotations

from contextlib import suppress
from xml.parsers import expat

_SHORTEST = len('<link name="l"/>')
_AROUND = frozenset({"sdf", "gazebo", "world", "model"})
_COUNTED = frozenset({"link", "include"})
"""Elements that count, and elements that contain them, except states and plugins. An included model has a link."""


def has_more_links(data: bytes | str, most: int) -> bool:
    """Return whether the first world in a text has more than `most` links and includes.

    Parsing stops as soon as the number is exceeded.

    Args:
        data: the text; errors in its syntax are not reported here.
        most: the maximum number.
    """
    if len(data) <= most * _SHORTEST:
        return False
    parser = expat.ParserCreate()
    counter = _Counter(most)
    parser.StartElementHandler, parser.EndElementHandler = counter.begin, counter.end
    parser.EntityDeclHandler = counter.stop
    with suppress(expat.ExpatError, _DoneError, LookupError, ValueError):
        parser.Parse(data, True)
    return counter.count > most


class _DoneError(Exception):
    """Raised to stop parsing when there is nothing more to count."""


class _Counter:
    def __init__(self, most: int) -> None:
        self.count = 0
        self._most = most
        self._inside = 0

    def begin(self, name: str, _attributes: dict[str, str]) -> None:
        if name in _COUNTED and not self._inside:
            self.count += 1
            if self.count > self._most:
                raise _DoneError
        self._inside += name not in _AROUND

    def end(self, name: str) -> None:
        self._inside -= name not in _AROUND
        if name == "world" and not self._inside:
            raise _DoneError

    def stop(self, *_declared: object) -> None:
        """Stop counting at an entity declaration, because an entity may contain any text."""
        raise _DoneError
