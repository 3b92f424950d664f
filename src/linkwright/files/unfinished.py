"""Files being written, such as recordings, that must be finished before the process ends.

Code that ends a process without waiting for its event loop, which may hang, calls `finish_all` first.
"""

from __future__ import annotations

from typing import Protocol
from weakref import WeakValueDictionary


class Unfinished(Protocol):
    """The interface of a writer whose file must be finished, if necessary by another thread."""

    def finish(self) -> object:
        """Write the end of the file, and nothing afterwards.

        This may be called from any thread, even if the writer's own thread is busy.
        """


_unfinished: WeakValueDictionary[int, Unfinished] = WeakValueDictionary()


def register_unfinished(what: Unfinished) -> None:
    """Register a writer, so that its file is finished before the process ends."""
    _unfinished[id(what)] = what


def unregister_finished(what: Unfinished) -> None:
    """Unregister a writer whose file is finished."""
    _unfinished.pop(id(what), None)


def finish_all() -> None:
    """Finish the files of all registered writers."""
    for reference in _unfinished.valuerefs():
        what = reference()
        if what is not None:
            what.finish()
