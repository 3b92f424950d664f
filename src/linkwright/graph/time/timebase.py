"""Where a graph gets its time from: the computer's clocks, or one that a test advances; and alarms set by it."""

from __future__ import annotations

import heapq
import time
from abc import ABC, abstractmethod
from asyncio import AbstractEventLoop
from collections.abc import Callable
from itertools import count
from typing import Protocol

from linkwright.graph.time.fine_alarms import ScheduledAlarm, fine_alarms
from linkwright.graph.time.values import ClockType, Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_SHORT_NS = 20_000_000
"""Waits of up to this length end in time to some microseconds; longer ones may be a millisecond late."""


class Alarm(Protocol):
    """A call that is scheduled for a time."""

    def cancel(self) -> None:
        """Cancel the call."""


class AlarmSetter(Protocol):
    """Schedules calls."""

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a steady time of the graph, in nanoseconds; from any thread.

        It is never made before this returns. The callback marks entities as ready: it is short, and not a user's code.
        """


class Settling(Protocol):
    """Runs the callbacks of a graph, and can be waited for."""

    async def settle(self) -> None:
        """Wait until nothing is ready any more, including the calls that other calls make ready."""


class Timebase(ABC):
    """The two times of a graph: system time, which stamps messages and may jump, and steady time, which timers use."""

    @abstractmethod
    def now_ns(self) -> int:
        """Nanoseconds since the epoch."""

    @abstractmethod
    def steady_ns(self) -> int:
        """Steady time, nanoseconds from an arbitrary start."""

    @abstractmethod
    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call on an event loop for a steady time, in nanoseconds; called in the loop's thread."""

    def now(self) -> Time:
        """The present as a point in time."""
        return Time(nanoseconds=self.now_ns(), clock_type=ClockType.SYSTEM_TIME)

    def attach(self, dispatcher: Settling) -> None:  # noqa: B027  # most need not know
        """Note the dispatcher of a graph that uses this timebase."""


class SystemClock(Timebase):
    """The computer's clocks: system time, and monotonic time, which event loops use too; asked thousands of times."""

    now_ns = staticmethod(time.time_ns)
    steady_ns = staticmethod(time.monotonic_ns)

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback on an event loop."""
        if steady_ns - time.monotonic_ns() <= _SHORT_NS:
            alarms = fine_alarms(loop)
            if alarms is not None:
                return alarms.call_at(steady_ns, callback)
        return loop.call_at(steady_ns / NANOSECONDS_PER_SECOND, callback)


class JumpClock(Timebase):
    """Time that moves only when a test advances it, so that an hour of timers takes milliseconds.

    Args:
        start_ns: what `now_ns` gives at first, nanoseconds since the epoch.
    """

    def __init__(self, start_ns: int = 1_700_000_000 * NANOSECONDS_PER_SECOND) -> None:
        self._now_ns = start_ns
        self._steady_ns = 0
        self._alarms: list[ScheduledAlarm] = []
        self._numbers = count()
        self._dispatchers: list[Settling] = []

    def now_ns(self) -> int:
        """Nanoseconds since the epoch, as moved so far."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Nanoseconds advanced so far."""
        return self._steady_ns

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback for when the clock is advanced that far."""
        alarm = ScheduledAlarm(steady_ns, next(self._numbers), callback)
        heapq.heappush(self._alarms, alarm)
        return alarm

    def attach(self, dispatcher: Settling) -> None:
        """Let a dispatcher finish its work before each step of the clock."""
        self._dispatchers.append(dispatcher)

    async def advance(self, seconds: float, *, is_settled: bool = False) -> None:
        """Advance the time; each timer is called when it falls due, and its effects are done before the next.

        Args:
            seconds: how much.
            is_settled: whether all ready work is done, so that there is nothing to wait for.
        """
        end = self._steady_ns + round(seconds * NANOSECONDS_PER_SECOND)
        if not is_settled:
            await self._settle()
        while self._alarms and self._alarms[0].steady_ns <= end:
            alarm = heapq.heappop(self._alarms)
            if not alarm.cancelled:
                self._move_to(max(alarm.steady_ns, self._steady_ns))
                alarm.callback()
                await self._settle()
        self._move_to(end)

    def jump(self, seconds: float) -> None:
        """Set the time of stamps forward or back, as a corrected system clock or a restarted recording does.

        Timers are not called.
        """
        self._now_ns += round(seconds * NANOSECONDS_PER_SECOND)

    def _move_to(self, steady_ns: int) -> None:
        self._now_ns += steady_ns - self._steady_ns
        self._steady_ns = steady_ns

    async def _settle(self) -> None:
        for dispatcher in self._dispatchers:
            await dispatcher.settle()
