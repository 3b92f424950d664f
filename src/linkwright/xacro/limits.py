"""How far an expansion may go before it is stopped.

A description comes from a stranger as often as from a colleague: whatever it says, opening it must end, and soon.
"""

from __future__ import annotations

import sys
from _thread import allocate_lock  # what threading.Lock is, without the rest of it
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from linkwright.xmltree.collection import seldom_collected


@dataclass(frozen=True, slots=True)
class Limits:
    """Bounds of one expansion; the defaults are far above what any real robot needs.

    Attributes:
        depth: how many macro calls and includes may be active at once.
        nesting: how deep elements may nest, counting those of the macro calls around them.
        elements: how many elements may be produced; a macro call counts as ten, any other tag of the language as two.
        steps: how much all expressions may do, together: a turn of a comprehension or a call of a function counts as
            two, of a lambda as eight, and running through two items or 32 characters of a value as one.
        characters: how many characters all long texts and attributes that come out may have, together.
        seconds: how much time of the processor it may take.
    """

    depth: int = 200
    nesting: int = 1000
    elements: int = 500_000
    steps: int = 1_000_000
    characters: int = 50_000_000
    seconds: float = 20.0


_FRAMES_PER_LEVEL = 6
_lock = allocate_lock()
_active = 0
_before = 0


@contextmanager
def room_for(limits: Limits) -> Iterator[None]:
    """Raise Python's recursion limit so that our own limits are met first; put it back when nobody needs it."""
    global _active, _before  # noqa: PLW0603 - the recursion limit is one for the whole process
    with _lock:
        if _active == 0:
            _before = sys.getrecursionlimit()
        _active += 1
        wanted = _before + limits.nesting * _FRAMES_PER_LEVEL
        if wanted > sys.getrecursionlimit():
            sys.setrecursionlimit(wanted)
    try:
        with seldom_collected():
            yield
    finally:
        with _lock:
            _active -= 1
            if _active == 0:
                sys.setrecursionlimit(_before)
