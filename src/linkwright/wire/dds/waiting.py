"""Threads that wait for Cyclone and call the attached handlers."""

from __future__ import annotations

import ctypes as c
import threading
import time
from collections.abc import Callable

from linkwright.wire.dds.cyclone import INFINITY_NS, check_call, load
from linkwright.wire.guarded_calls import call_guarded

Handler = Callable[[], bool]
"""Handles pending work, and returns whether more is left.

The other handlers run before the handler is called again.
"""

_MAX_TRIGGERED = 64


class WaitingThread(threading.Thread):
    """A thread that calls the handlers of entities when there is work for them.

    Args:
        name: the name of the thread.
        owner: the participant.
        report: called with the error when a handler fails; the thread continues.
        idle: called after the handlers, and after each call of `wake`; returns the seconds after which it must be
            called again, or None if it need not be.
    """

    def __init__(
        self,
        name: str,
        owner: int,
        report: Callable[[Exception], None],
        idle: Callable[[], float | None] | None = None,
    ) -> None:
        super().__init__(name=name, daemon=True)
        self._dds = load()
        self._waitset = check_call(self._dds.dds_create_waitset(owner), "creating a waitset")
        self._guard = check_call(self._dds.dds_create_guardcondition(owner), "creating a guard condition")
        check_call(self._dds.dds_waitset_attach(self._waitset, self._guard, 0), "attaching the guard condition")
        self._handlers: dict[int, Handler] = {}
        self._report = report
        self._idle = idle
        self._is_stopping = False

    def attach(self, entity: int, handler: Handler) -> None:
        """Register a handler to be called while an enabled status of the entity is set."""
        self._handlers[entity] = handler
        check_call(self._dds.dds_waitset_attach(self._waitset, entity, entity), "attaching an entity to the waitset")

    def detach(self, entity: int) -> None:
        """Stop calling the handler of an entity.

        A call in progress continues.
        """
        self._handlers.pop(entity, None)
        self._dds.dds_waitset_detach(self._waitset, entity)

    def wake(self) -> None:
        """Wake the thread so that it calls `idle`.

        Any thread may call this method.
        """
        self._dds.dds_set_guardcondition(self._guard, True)

    def stop(self, timeout: float) -> bool:
        """End the thread, and return whether it has ended within `timeout` seconds."""
        self._is_stopping = True
        self.wake()
        if threading.current_thread() is not self and self.is_alive():
            self.join(timeout)
        return not self.is_alive()

    def run(self) -> None:
        """Wait for work and call handlers until `stop` is called."""
        triggered = (c.c_ssize_t * _MAX_TRIGGERED)()
        was_set = c.c_bool()
        unfinished: set[int] = set()
        deadline: float | None = None
        while not self._is_stopping:
            timeout = 0 if unfinished else _nanoseconds_until(deadline)
            count = self._dds.dds_waitset_wait(self._waitset, triggered, _MAX_TRIGGERED, timeout)
            if count < 0:
                return  # the participant was deleted
            entities = unfinished.union(triggered[: min(count, _MAX_TRIGGERED)])
            unfinished = set()
            if 0 in entities:
                entities.discard(0)
                self._dds.dds_take_guardcondition(self._guard, c.byref(was_set))
            for entity in entities:
                handler = self._handlers.get(entity)
                if handler is not None and call_guarded(handler, self._report):
                    unfinished.add(entity)
            if self._idle is not None and not self._is_stopping:
                seconds = call_guarded(self._idle, self._report)
                deadline = None if seconds is None else time.monotonic() + seconds


def _nanoseconds_until(deadline: float | None) -> int:
    return INFINITY_NS if deadline is None else max(0, int((deadline - time.monotonic()) * 1e9))
