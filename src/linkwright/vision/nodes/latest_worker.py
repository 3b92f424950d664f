"""A worker thread that processes only the latest item, so that no backlog builds up."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

T = TypeVar("T")

_CLOSE_TIMEOUT_S = 10.0


class LatestWorker(Generic[T]):
    """A thread that calls a function, always with the latest offered item.

    Args:
        prepare: called in the thread before the first item. It returns the function, or None to stop the thread, and
            may take seconds. Neither `prepare` nor the function may raise.
        name: the name of the thread.
    """

    def __init__(self, prepare: Callable[[], Callable[[T], None] | None], name: str) -> None:
        self._prepare = prepare
        self._changed = threading.Condition()
        self._pending: list[T] = []
        self._is_closed = False
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def offer(self, item: T) -> None:
        """Offer an item, replacing an item that is still waiting."""
        with self._changed:
            if not self._is_closed:
                self._pending[:] = [item]
                self._changed.notify()

    @property
    def has_pending_item(self) -> bool:
        """Whether an item is waiting."""
        return bool(self._pending)

    def close(self) -> None:
        """Stop the thread, and wait up to 10 s for a running call."""
        with self._changed:
            self._is_closed = True
            self._pending.clear()
            self._changed.notify()
        self._thread.join(_CLOSE_TIMEOUT_S)

    def _run(self) -> None:
        process = self._prepare()
        while process is not None:
            with self._changed:
                self._changed.wait_for(lambda: self._pending or self._is_closed)
                if self._is_closed:
                    return
                item = self._pending.pop()
            process(item)
