"""Files that must be completed before the process ends, such as recordings.

Code that ends a process without waiting for the event loop, which may hang, calls `finish_all` first.
"""

from __future__ import annotations

from typing import Protocol
from weakref import WeakValueDictionary


class Unfinished(Protocol):
    """The interface of a writer whose file must be completed, if necessary by another thread."""

    def finish(self) -> object:
        """Complete the file, and ignore later writes.

        This method may be called from any thread, even while the writer's own thread is busy.
        """


_unfinished: WeakValueDictionary[int, Unfinished] = WeakValueDictionary()


def register_unfinished(what: Unfinished) -> None:
    """Register a writer whose file must be completed before the process ends."""
    _unfinished[id(what)] = what


def unregister_finished(what: Unfinished) -> None:
    """Unregister a writer whose file is complete."""
    _unfinished.pop(id(what), None)


def finish_all() -> None:
    """Complete the files of all registered writers."""
    for reference in _unfinished.valuerefs():
        what = reference()
        if what is not None:
            what.finish()
