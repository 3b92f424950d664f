"""Files that are being written and need an end, such as recordings: they are finished before the process ends.

Code that ends a process without waiting for its event loop, which may hang, calls `finish_all` first.
"""

from __future__ import annotations

from typing import Protocol
from weakref import WeakValueDictionary


class Unfinished(Protocol):
    """Something whose end is written by another thread than its own, if need be."""

    def finish(self) -> object:
        """Write the end, and nothing afterwards; called from any thread, even if its own one is busy."""


_unfinished: WeakValueDictionary[int, Unfinished] = WeakValueDictionary()


def begun(what: Unfinished) -> None:
    """Have something finished before the process is ended."""
    _unfinished[id(what)] = what


def finished(what: Unfinished) -> None:
    """Its end is written."""
    _unfinished.pop(id(what), None)


def finish_all() -> None:
    """Finish whatever has begun."""
    for reference in _unfinished.valuerefs():
        what = reference()
        if what is not None:
            what.finish()
