"""Alarms with microsecond precision, for event loops that wait for whole milliseconds.

On Linux, asyncio waits with ``epoll_wait``, whose timeout is counted in milliseconds and rounded up: each tick at 1 kHz
would be late, and every seventh would be missed. A kernel timer that the loop watches as a file (``timerfd``) wakes it
in time. The event loops of other systems do not need such a timer.
"""

from __future__ import annotations

import heapq
import os
import sys
import time
import weakref
from asyncio import AbstractEventLoop
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import count
from typing import TYPE_CHECKING

from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from ctypes import Array, c_long

_CLOCK_MONOTONIC = 1
_ABSOLUTE = 1


def get_fine_alarms(loop: AbstractEventLoop) -> FineAlarms | None:
    """Return the fine alarms of an event loop.

    Return None if only the loop's own alarms are available.

    This function must be called in the loop's thread.
    """
    try:
        return _alarms_by_loop[id(loop)]  # A weak dictionary is slower, and timers call this with each tick.
    except KeyError:
        alarms = _alarms_by_loop[id(loop)] = _create_alarms(loop)
        weakref.finalize(loop, _alarms_by_loop.pop, id(loop), None)
        return alarms


def _create_alarms(loop: AbstractEventLoop) -> FineAlarms | None:
    if sys.platform != "linux":
        return None
    import ctypes  # imported here because few programs need it, and its import is slow

    if ctypes.sizeof(ctypes.c_long) != 8:  # The layout below requires 64-bit fields.
        return None
    libc = ctypes.PyDLL(None)  # PyDLL keeps the interpreter lock, since the calls are short
    file = libc.timerfd_create(_CLOCK_MONOTONIC, os.O_NONBLOCK | os.O_CLOEXEC)
    if file < 0:
        return None
    period_and_next = (ctypes.c_long * 4)()  # each has seconds and nanoseconds
    alarms = FineAlarms(partial(libc.timerfd_settime, file, _ABSOLUTE, period_and_next, None), period_and_next)
    try:
        loop.add_reader(file, alarms.run)
    except NotImplementedError:
        os.close(file)
        return None
    weakref.finalize(loop, os.close, file)
    return alarms


@dataclass(slots=True, order=True)
class ScheduledAlarm:
    """A scheduled call.

    Alarms are ordered by their times.

    Attributes:
        steady_ns: the time of the steady clock at which the call is due, in ns.
        number: the rank among alarms that are due at the same time; the lowest is called first.
        callback: the function to call.
        cancelled: whether the call was cancelled.
    """

    steady_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        """Cancel the call."""
        self.cancelled = True


class FineAlarms:
    """The scheduled calls of an event loop, in the order of their times.

    Each time the kernel timer expires, it is set again. This also makes its file unreadable again, so the file need not
    be read.

    Args:
        set_timer: passes the setting to the kernel.
        setting: the timer's setting in monotonic time: seconds and nanoseconds of its period (0 for no period), then
            seconds and nanoseconds of its next expiry.
    """

    def __init__(self, set_timer: Callable[[], int], setting: Array[c_long]) -> None:
        self._set_timer = set_timer
        self._setting = setting
        self._alarms: list[ScheduledAlarm] = []
        self._numbers = count()
        self._is_running = False

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> ScheduledAlarm:
        """Schedule a call for a value of ``time.monotonic_ns``.

        The callback never runs before this method returns.
        """
        alarm = ScheduledAlarm(steady_ns, next(self._numbers), callback)
        heapq.heappush(self._alarms, alarm)
        if not self._is_running and self._alarms[0] is alarm:
            self._update_timer()
        return alarm

    def run(self) -> None:
        """Make the calls that are due.

        Calls that the callbacks schedule are made in a later iteration of the loop.
        """
        alarms, due_alarms = self._alarms, []
        now_ns = time.monotonic_ns()
        while alarms and alarms[0].steady_ns <= now_ns:
            due_alarms.append(heapq.heappop(alarms))
        self._is_running = True
        try:
            while due_alarms:
                alarm = due_alarms.pop(0)
                if not alarm.cancelled:
                    alarm.callback()
        finally:
            self._is_running = False
            for alarm in due_alarms:
                heapq.heappush(alarms, alarm)
            self._update_timer()

    def _update_timer(self) -> None:
        setting = self._setting
        # A time of 0 stops the timer, as required if there are no alarms. With a time in the past, the timer expires
        # immediately.
        setting[2], setting[3] = divmod(self._alarms[0].steady_ns, NANOSECONDS_PER_SECOND) if self._alarms else (0, 0)
        self._set_timer()


_alarms_by_loop: dict[int, FineAlarms | None] = {}
"""The alarms by the ``id`` of their loop. An entry is removed with its loop."""
