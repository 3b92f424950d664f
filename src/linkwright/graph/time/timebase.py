"""The source of a graph's time: the clocks of the computer, or one that a test advances; alarms that are set by it."""

from __future__ import annotations

import heapq
import time
from abc import ABC, abstractmethod
from asyncio import AbstractEventLoop
from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Protocol

from linkwright.graph.time.values import NANOSECONDS_PER_SECOND, ClockType, Time


class Alarm(Protocol):
    """A callback that will be called at a time."""

    def cancel(self) -> None:
        """Do not call it."""


class AlarmSetter(Protocol):
    """What calls back at a time."""

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once at a count of the graph's timebase; never in the caller's frame, from any thread.

        What is called only makes entities ready: it is quick, and none of the user's code.
        """


class Settling(Protocol):
    """What runs the callbacks of a graph and can be waited for."""

    async def settle(self) -> None:
        """Wait until nothing is ready any more, including the calls that other calls make ready."""


class Timebase(ABC):
    """What stamps messages and wakes timers.

    Stamps are points in time (they may jump, as system clocks do); timers go by a steady count that never goes back.
    """

    @abstractmethod
    def now_ns(self) -> int:
        """Nanoseconds since the epoch."""

    @abstractmethod
    def steady_ns(self) -> int:
        """Nanoseconds of a steady count with an arbitrary start."""

    @abstractmethod
    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once on an event loop, from whose thread this is asked, at a value of the steady count."""

    def now(self) -> Time:
        """The present as a point in time."""
        return Time(nanoseconds=self.now_ns(), clock_type=ClockType.SYSTEM_TIME)

    def attach(self, dispatcher: Settling) -> None:  # noqa: B027  # most need not know
        """Learn of the dispatcher of a graph that goes by this time."""


class SystemClock(Timebase):
    """The computer's clocks: the one it shows, and its monotonic one, by which event loops go too."""

    def now_ns(self) -> int:
        """Nanoseconds since the epoch."""
        return time.time_ns()

    def steady_ns(self) -> int:
        """``time.monotonic_ns``."""
        return time.monotonic_ns()

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Call something once on an event loop."""
        return loop.call_at(steady_ns / NANOSECONDS_PER_SECOND, callback)


@dataclass(slots=True, order=True)
class _JumpAlarm:
    steady_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        self.cancelled = True


class JumpClock(Timebase):
    """Time that stands still until a test moves it, so that an hour of timers takes milliseconds.

    Args:
        start_ns: what `now_ns` gives at first, nanoseconds since the epoch.
    """

    def __init__(self, start_ns: int = 1_700_000_000 * NANOSECONDS_PER_SECOND) -> None:
        self._now_ns = start_ns
        self._steady_ns = 0
        self._alarms: list[_JumpAlarm] = []
        self._numbers = count()
        self._dispatchers: list[Settling] = []

    def now_ns(self) -> int:
        """Nanoseconds since the epoch, as moved so far."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Nanoseconds advanced so far."""
        return self._steady_ns

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:  # noqa: ARG002
        """Call something once when the clock is advanced that far."""
        alarm = _JumpAlarm(steady_ns, next(self._numbers), callback)
        heapq.heappush(self._alarms, alarm)
        return alarm

    def attach(self, dispatcher: Settling) -> None:
        """Let a dispatcher finish its work before each step of the clock."""
        self._dispatchers.append(dispatcher)

    async def advance(self, seconds: float) -> None:
        """Let time go by; each timer is called when it falls due, and what it causes is done before the next."""
        end = self._steady_ns + round(seconds * NANOSECONDS_PER_SECOND)
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
