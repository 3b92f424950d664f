"""A queue and a thread for a publisher that may block.

The rest of the bridge is not blocked.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from queue import Queue

from linkwright.graph.faults import InvalidHandleError
from linkwright.wire.guarded_calls import call_guarded


class Outlet:
    """A thread that publishes messages in order.

    A publisher with KEEP_ALL blocks for seconds if a subscriber has stopped reading. Meanwhile the
    rest of the bridge's traffic continues.

    Args:
        publish: publishes a message.
        on_failure: called with the error if publishing fails.
    """

    def __init__(self, publish: Callable[[bytes], object], on_failure: Callable[[Exception], object]) -> None:
        self._publish = publish
        self._failed = on_failure
        self._queue: Queue[bytes | None] = Queue()
        self._thread: threading.Thread | None = None

    def put(self, data: bytes) -> None:
        """Queue a message for publishing."""
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="linkwright-bridge-outlet", daemon=True)
            self._thread.start()
        self._queue.put(data)

    def has_more(self) -> bool:
        """Return whether messages are queued or being published."""
        return bool(self._queue.unfinished_tasks)

    def close(self) -> None:
        """End the thread after the queued messages.

        The messages are discarded if the publisher is destroyed.
        """
        self._queue.put(None)

    def _run(self) -> None:
        while (data := self._queue.get()) is not None:
            call_guarded(partial(self._publish_one, data), self._failed)
            self._queue.task_done()

    def _publish_one(self, data: bytes) -> None:
        with suppress(InvalidHandleError):  # the publisher was destroyed
            self._publish(data)
