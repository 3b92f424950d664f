"""Locks for lockstep threads, which let other threads run while a thread waits for a lock."""

from __future__ import annotations

from _thread import allocate_lock
from collections import deque
from typing import Any

from linkwright.testing.programs.threads import LockstepThread, current_thread


class CooperativeLock:
    """A replacement of ``threading.Lock`` that lets other lockstep threads run during a wait.

    Any thread may release it, including the thread of the graph.
    """

    def __init__(self) -> None:
        self._is_locked = False
        self._waiting: deque[LockstepThread] = deque()

    def acquire(self, blocking: bool = True, timeout: float = -1) -> bool:
        """Acquire the lock, waiting if necessary, and return whether that succeeded.

        Raises:
            RuntimeError: a thread outside lockstep would have to wait.
        """
        if not self._is_locked:
            self._is_locked = True
            return True
        if not blocking or timeout == 0:
            return False
        thread = current_thread()
        if thread is None:
            raise RuntimeError("a thread outside lockstep would wait for a lock that a program holds")
        deadline_ns = None if timeout < 0 else thread.time_after(timeout)
        self._waiting.append(thread)
        try:
            while self.locked():
                if deadline_ns is not None and thread.clock.steady_ns() >= deadline_ns:
                    return False
                thread.wait(deadline_ns)
            self._is_locked = True
            return True
        finally:
            self._waiting.remove(thread)
            self._wake_next()

    def release(self) -> None:
        """Release the lock.

        Raises:
            RuntimeError: the lock is not acquired.
        """
        if not self._is_locked:
            raise RuntimeError("release unlocked lock")
        self._is_locked = False
        self._wake_next()

    def locked(self) -> bool:
        """Return whether the lock is acquired."""
        return self._is_locked

    def _wake_next(self) -> None:
        if self._waiting and not self._is_locked:
            self._waiting[0].wake()

    def _at_fork_reinit(self) -> None:
        self.__init__()  # type: ignore[misc]  # as the interpreter's own lock does

    def __enter__(self) -> bool:
        return self.acquire()

    def __exit__(self, *_: object) -> None:
        self.release()


class ThreadAwareLock:
    """The replacement of ``threading.Lock``.

    It creates the kind of lock that the calling thread needs.
    """

    def __new__(cls) -> Any:
        """Return a cooperative lock for a lockstep thread, or else an ordinary lock."""
        return CooperativeLock() if current_thread() is not None else allocate_lock()
