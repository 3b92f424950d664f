"""Count the links of a world without building its model.

For a huge world, parsing would take minutes and gigabytes.
"""

from __future__ import annotations

from contextlib import suppress
from xml.parsers import expat

_MIN_LINK_LENGTH = len('<link name="l"/>')
_CONTAINER_TAGS = frozenset({"sdf", "gazebo", "world", "model"})
_COUNTED_TAGS = frozenset({"link", "include"})
"""Elements to count, if they are only inside container elements. An include counts as one link."""


def has_more_links(data: bytes | str, limit: int) -> bool:
    """Return whether the first world of a file has more than `limit` links and includes.

    Parsing stops as soon as the number is exceeded.

    Args:
        data: the content of the file; syntax errors are not reported here.
        limit: the maximum number of links and includes.
    """
    if len(data) <= limit * _MIN_LINK_LENGTH:
        return False
    parser = expat.ParserCreate()
    counter = _Counter(limit)
    parser.StartElementHandler, parser.EndElementHandler = counter.begin, counter.end
    parser.EntityDeclHandler = counter.stop
    with suppress(expat.ExpatError, _CountingDoneError, LookupError, ValueError):
        parser.Parse(data, True)
    return counter.count > limit


class _CountingDoneError(Exception):
    """Raised to stop parsing when there is nothing more to count."""


class _Counter:
    def __init__(self, limit: int) -> None:
        self.count = 0
        self._limit = limit
        self._skipped_depth = 0

    def begin(self, name: str, _attributes: dict[str, str]) -> None:
        if name in _COUNTED_TAGS and not self._skipped_depth:
            self.count += 1
            if self.count > self._limit:
                raise _CountingDoneError
        self._skipped_depth += name not in _CONTAINER_TAGS

    def end(self, name: str) -> None:
        self._skipped_depth -= name not in _CONTAINER_TAGS
        if name == "world" and not self._skipped_depth:
            raise _CountingDoneError

    def stop(self, *_arguments: object) -> None:
        """Stop counting at an entity declaration, because an entity may contain any text."""
        raise _CountingDoneError
