"""A pool of daemon threads."""

from __future__ import annotations

import threading
from collections.abc import Callable
from queue import SimpleQueue


class Workers:
    """Up to a number of threads, each started when it is needed. They do not keep the program from ending.

    Args:
        limit: how many at most.
        name: what the threads' names begin with.
        freed: called when a job has ended and its thread has time for the next.
    """

    def __init__(self, limit: int, name: str, freed: Callable[[], None]) -> None:
        self._limit = limit
        self._freed = freed
        self._name = name
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._threads: list[threading.Thread] = []
        self._lock = threading.Lock()
        self._unfinished = 0

    @property
    def has_room(self) -> bool:
        """Whether a job that is submitted now would begin at once."""
        return self._unfinished < self._limit

    def submit(self, job: Callable[[], None]) -> None:
        """Have a thread do something, which may not raise."""
        with self._lock:
            self._unfinished += 1
            if self._unfinished > len(self._threads) and len(self._threads) < self._limit:
                thread = threading.Thread(target=self._work, name=f"{self._name}-{len(self._threads)}", daemon=True)
                self._threads.append(thread)
                thread.start()
        self._jobs.put(job)

    def close(self, timeout_sec: float | None = None) -> bool:
        """Have the threads end after what they were given; wait for that.

        Args:
            timeout_sec: the longest wait, in seconds; no limit when None.

        Returns:
            Whether all have ended. A thread that calls this itself is not waited for.
        """
        with self._lock:
            threads, self._threads = self._threads, []
        for _ in threads:
            self._jobs.put(None)
        others = [thread for thread in threads if thread is not threading.current_thread()]
        for thread in others:
            thread.join(timeout_sec)
        return not any(thread.is_alive() for thread in others)

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            try:
                job()
            finally:
                with self._lock:
                    self._unfinished -= 1
                self._freed()
