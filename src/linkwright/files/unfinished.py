"""Files that must be completed before the process ends, such as recordings.

Code that ends the process without waiting for the event loop, which may hang, first calls `finish_all`.
"""

from __future__ import annotations

from typing import Protocol
from weakref import WeakValueDictionary


class Unfinished(Protocol):
    """The interface of a writer whose file must be completed, possibly by another thread."""

    def finish(self) -> object:
        """Complete the file, and ignore later writes.

        This method may be called from any thread, even while the writer's own thread is busy.
        """


_writers: WeakValueDictionary[int, Unfinished] = WeakValueDictionary()


def register_unfinished(writer: Unfinished) -> None:
    """Register a writer whose file must be completed before the process ends."""
    _writers[id(writer)] = writer


def unregister_finished(writer: Unfinished) -> None:
    """Unregister a writer whose file is complete."""
    _writers.pop(id(writer), None)


def finish_all() -> None:
    """Complete the files of all registered writers."""
    for reference in _writers.valuerefs():
        writer = reference()
        if writer is not None:
            writer.finish()
