"""Running Python's garbage collector less often while a tree is built.

Reading and expanding make many small objects at once. Nearly all of them stay, and none form reference cycles that are
garbage. The collector searches them again and again all the same, which costs up to a tenth of the time; now and then
it searches every object of the program.
"""

from __future__ import annotations

import gc
from _thread import allocate_lock  # threading.Lock without the rest of threading

_SELDOM = 50_000
"""After how many new objects the collector looks all the same."""
_lock = allocate_lock()
_active = 0
_before = (0, 0, 0)


class seldom_collected:  # noqa: N801 - it is called in a ``with`` statement, as a function is
    """Let the garbage collector run less often inside a ``with`` block; new objects then count as old."""

    def __enter__(self) -> None:
        global _active, _before  # noqa: PLW0603 - there is one collector for the whole process
        with _lock:
            if _active == 0:
                _before = gc.get_threshold()
                if 0 < _before[0] < _SELDOM:
                    gc.set_threshold(_SELDOM, *_before[1:])
            _active += 1

    def __exit__(self, *_: object) -> None:
        global _active  # noqa: PLW0603 - see above
        with _lock:
            _active -= 1
            if _active == 0:
                if gc.get_freeze_count() == 0:  # new objects become old without a collection
                    gc.freeze()
                    gc.unfreeze()
                gc.set_threshold(*_before)
