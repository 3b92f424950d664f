"""Worlds of more links than can be simulated are refused before they are read: reading would take minutes, and GB."""

from __future__ import annotations

from xml.parsers import expat

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.simulation.scene.compiling import MOST_LINKS, fewer_links

_SHORTEST = len('<link name="l"/>')
_AROUND = frozenset({"sdf", "gazebo", "world", "model"})
_COUNTED = frozenset({"link", "include"})
"""What there may be too many of, and what it stands in, but for states and plugins. What is included has a link."""


def refuse_crowd(data: bytes | str) -> None:
    """Refuse a world with too many links and includes as soon as one too many has begun.

    Args:
        data: its text; of one that is not well formed nothing is said here.

    Raises:
        LinkwrightError: SIM105 the first world in it has too many links.
    """
    if len(data) <= MOST_LINKS * _SHORTEST:
        return
    parser = expat.ParserCreate()
    counter = _Counter()
    parser.StartElementHandler, parser.EndElementHandler = counter.begin, counter.end
    parser.EntityDeclHandler = counter.stop
    try:
        parser.Parse(data, True)
    except (expat.ExpatError, _DoneError, LookupError, ValueError):
        return


class _DoneError(Exception):
    """There is nothing more to count."""


class _Counter:
    def __init__(self) -> None:
        self._inside = 0
        self._count = 0

    def begin(self, name: str, _attributes: dict[str, str]) -> None:
        if name in _COUNTED and not self._inside:
            self._count += 1
            if self._count > MOST_LINKS:
                message = phrase("a world of more than {most} links cannot be simulated", most=MOST_LINKS)
                raise LinkwrightError(Diagnostic("SIM105", message, hint=fewer_links()))
        self._inside += name not in _AROUND

    def end(self, name: str) -> None:
        self._inside -= name not in _AROUND
        if name == "world" and not self._inside:
            raise _DoneError

    def stop(self, *_declared: object) -> None:
        """An entity may stand for anything: the reader of XML knows how to deal with it."""
        raise _DoneError
