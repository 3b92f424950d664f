"""A queue and a thread for a publisher that may block, so that the rest of a bridge does not."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from queue import Queue

from linkwright.graph.faults import InvalidHandleError
from linkwright.wire.living_threads import guarded


class Outlet:
    """Publishes messages in order, in a thread of its own.

    A publisher that keeps everything waits for a listener that has stopped, for seconds; the rest of a bridge's traffic
    continues meanwhile.

    Args:
        publish: publishes a message.
        failed: called with the error when it cannot.
    """

    def __init__(self, publish: Callable[[bytes], object], failed: Callable[[Exception], object]) -> None:
        self._publish = publish
        self._failed = failed
        self._queue: Queue[bytes | None] = Queue()
        self._thread: threading.Thread | None = None

    def put(self, data: bytes) -> None:
        """Have a message published."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="linkwright-bridge-outlet", daemon=True)
            self._thread.start()
        self._queue.put(data)

    def has_more(self) -> bool:
        """Whether messages wait, or one is being published."""
        return bool(self._queue.unfinished_tasks)

    def close(self) -> None:
        """Publish no more; waiting messages are lost."""
        self._queue.put(None)

    def _run(self) -> None:
        while (data := self._queue.get()) is not None:
            guarded(partial(self._publish_one, data), self._failed)
            self._queue.task_done()

    def _publish_one(self, data: bytes) -> None:
        with suppress(InvalidHandleError):  # the publisher was taken away
            self._publish(data)
