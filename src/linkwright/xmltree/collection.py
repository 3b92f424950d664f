"""Running Python's garbage collector less often while a tree is built.

Reading and expanding make many small objects at once. Nearly all of them stay, and none form reference cycles that are
garbage. The collector searches them again and again all the same, which costs up to a tenth of the time; now and then
it searches every object of the program.
"""

from __future__ import annotations

import gc
from _thread import allocate_lock  # what threading.Lock is, without the rest of it
from collections.abc import Iterator
from contextlib import contextmanager

_SELDOM = 50_000
"""After how many new objects the collector looks all the same."""
_lock = allocate_lock()
_active = 0
_before = (0, 0, 0)


@contextmanager
def seldom_collected() -> Iterator[None]:
    """Let the garbage collector run less often inside a ``with`` block; what is new then counts as old."""
    global _active, _before  # noqa: PLW0603 - there is one collector for the whole process
    with _lock:
        if _active == 0:
            _before = gc.get_threshold()
            if 0 < _before[0] < _SELDOM:
                gc.set_threshold(_SELDOM, *_before[1:])
        _active += 1
    try:
        yield
    finally:
        with _lock:
            _active -= 1
            if _active == 0:
                if gc.get_freeze_count() == 0:  # all that is new grows old without being looked at
                    gc.freeze()
                    gc.unfreeze()
                gc.set_threshold(*_before)
