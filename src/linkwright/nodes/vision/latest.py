"""Work in a thread of its own, on the latest of what comes: slow work never makes a queue."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

_SECONDS_FOR_THE_LAST = 10.0


class LatestWorker(Generic[T]):
    """Calls a function in a thread, with what was offered last when the call before it is done.

    Args:
        prepare: makes that function, in the thread, which may take seconds; None where nothing is to be done. Neither
            raises anything.
        name: of the thread.
    """

    def __init__(self, prepare: Callable[[], Callable[[T], None] | None], name: str) -> None:
        self._prepare = prepare
        self._changed = threading.Condition()
        self._waiting: list[T] = []
        self._ended = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def offer(self, item: T) -> None:
        """Have the function called with an item, unless another comes before it is its turn."""
        with self._changed:
            if not self._ended:
                self._waiting[:] = [item]
                self._changed.notify()

    @property
    def waits(self) -> bool:
        """Whether an item waits for its turn."""
        return bool(self._waiting)

    def close(self) -> None:
        """Call the function no more; a call that runs is waited for."""
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
