"""Alarms of an event loop to some microseconds, where the loop itself waits for whole milliseconds.

asyncio waits with ``epoll_wait`` on Linux, whose time-out is counted in milliseconds and rounded up: a beat of 1 kHz
would come late each time, and each seventh be missed. A timer of the kernel that the loop watches as a file
(``timerfd``) wakes it in time. The event loops of other systems need none.
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


def fine_alarms(loop: AbstractEventLoop) -> FineAlarms | None:
    """The fine alarms of an event loop, asked for in its thread; None where its own alarms must do."""
    try:
        return _of_loops[id(loop)]  # no weak dictionary, which is Python: timers look here with each beat
    except KeyError:
        found = _of_loops[id(loop)] = _made(loop)
        weakref.finalize(loop, _of_loops.pop, id(loop), None)
        return found


def _made(loop: AbstractEventLoop) -> FineAlarms | None:
    if sys.platform != "linux":
        return None
    import ctypes  # here, as most programs have no use for it: it takes longer than all of this file

    if ctypes.sizeof(ctypes.c_long) != 8:  # the layout of times is another one there
        return None
    libc = ctypes.PyDLL(None)  # its calls are short: the interpreter's lock is kept meanwhile
    file = libc.timerfd_create(_CLOCK_MONOTONIC, os.O_NONBLOCK | os.O_CLOEXEC)
    if file < 0:
        return None
    period_and_next = (ctypes.c_long * 4)()  # each in seconds and nanoseconds
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
    """A call among those that are scheduled, which are in the order of their times.

    Attributes:
        steady_ns: when it is due.
        number: its place among alarms that are due at the same time; the least comes first.
        callback: the callback.
        cancelled: whether it is not called any more.
    """

    steady_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        """Cancel the call."""
        self.cancelled = True


class FineAlarms:
    """Calls that are scheduled on one event loop, in the order in which they are due.

    The timer is set again after each time it rings, which also makes its file unreadable again: no read is needed.

    Args:
        set_timer: gives the kernel the setting.
        setting: of the timer, by monotonic time: the seconds and nanoseconds of its period, which has none, and of when
            it rings next.
    """

    def __init__(self, set_timer: Callable[[], int], setting: Array[c_long]) -> None:
        self._set_timer = set_timer
        self._setting = setting
        self._alarms: list[ScheduledAlarm] = []
        self._numbers = count()
        self._is_running = False

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> ScheduledAlarm:
        """Schedule a call for a count of ``time.monotonic_ns``; it is never made before this returns."""
        alarm = ScheduledAlarm(steady_ns, next(self._numbers), callback)
        heapq.heappush(self._alarms, alarm)
        if not self._is_running and self._alarms[0] is alarm:
            self._set()
        return alarm

    def run(self) -> None:
        """Make the calls that are due. Those that they schedule come in another turn of the loop."""
        alarms, due = self._alarms, []
        now_ns = time.monotonic_ns()
        while alarms and alarms[0].steady_ns <= now_ns:
            due.append(heapq.heappop(alarms))
        self._is_running = True
        try:
            while due:
                alarm = due.pop(0)
                if not alarm.cancelled:
                    alarm.callback()
        finally:
            self._is_running = False
            for alarm in due:
                heapq.heappush(alarms, alarm)
            self._set()

    def _set(self) -> None:
        setting = self._setting
        # A time of 0 would stop it, as no alarm has; a time that has passed rings at once.
        setting[2], setting[3] = divmod(self._alarms[0].steady_ns, NANOSECONDS_PER_SECOND) if self._alarms else (0, 0)
        self._set_timer()


_of_loops: dict[int, FineAlarms | None] = {}
"""By the identity of the loop; the entry is removed with the loop."""
