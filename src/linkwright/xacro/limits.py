"""How far an expansion may go before it is stopped.

A description comes from a stranger as often as from a colleague: whatever it says, opening it must end, and soon.
"""

from __future__ import annotations

import gc
import sys
from _thread import allocate_lock  # what threading.Lock is, without the rest of it
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass


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
_SELDOM = 50_000
"""After how many new objects the garbage collector looks for circles; trees have none that it could collect."""
_lock = allocate_lock()
_active = 0
_recursion_before = 0
_collection_before = (0, 0, 0)


@contextmanager
def room_for(limits: Limits) -> Iterator[None]:
    """Prepare Python for an expansion, and put things back when nobody needs them.

    The recursion limit is raised so that our own limits are met first, and the garbage collector runs less often: on
    the many small objects of a tree it would spend a tenth of the time for nothing.
    """
    global _active, _recursion_before, _collection_before  # noqa: PLW0603 - there is one of them for the whole process
    with _lock:
        if _active == 0:
            _recursion_before, _collection_before = sys.getrecursionlimit(), gc.get_threshold()
            if 0 < _collection_before[0] < _SELDOM:
                gc.set_threshold(_SELDOM, *_collection_before[1:])
        _active += 1
        wanted = _recursion_before + limits.nesting * _FRAMES_PER_LEVEL
        if wanted > sys.getrecursionlimit():
            sys.setrecursionlimit(wanted)
    try:
        yield
    finally:
        with _lock:
            _active -= 1
            if _active == 0:
                sys.setrecursionlimit(_recursion_before)
                if gc.get_freeze_count() == 0:  # all that is new grows old without being looked at
                    gc.freeze()
                    gc.unfreeze()
                gc.set_threshold(*_collection_before)
