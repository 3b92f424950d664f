"""A worker thread that processes only the latest item, so that slow work never builds up a queue."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

_SECONDS_FOR_THE_LAST = 10.0


class LatestWorker(Generic[T]):
    """Calls a function in a thread with the item that was offered last.

    Args:
        prepare: called in the thread, may take seconds; returns the function, or None if there is nothing to do.
            Neither `prepare` nor the function may raise.
        name: the name of the thread.
    """

    def __init__(self, prepare: Callable[[], Callable[[T], None] | None], name: str) -> None:
        self._prepare = prepare
        self._changed = threading.Condition()
        self._waiting: list[T] = []
        self._ended = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def offer(self, item: T) -> None:
        """Offer an item, which replaces an item that is still waiting."""
        with self._changed:
            if not self._ended:
                self._waiting[:] = [item]
                self._changed.notify()

    @property
    def waits(self) -> bool:
        """Whether an item is waiting."""
        return bool(self._waiting)

    def close(self) -> None:
        """Stop the thread, and wait up to 10 s for a running call."""
        with self._changed:
            self._ended = True
            self._waiting.clear()
            self._changed.notify()
        self._thread.join(_SECONDS_FOR_THE_LAST)

    def _run(self) -> None:
        work = self._prepare()
        while work is not None:
            with self._changed:
                self._changed.wait_for(lambda: self._waiting or self._ended)
                if self._ended:
                    return
                item = self._waiting.pop()
            work(item)
