"""Clocks of nodes: system, steady and ROS time, and jumps of time; and the timebase of a graph, which sets alarms."""

from __future__ import annotations

import heapq
import threading
import time
from abc import ABC, abstractmethod
from asyncio import AbstractEventLoop
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from itertools import count
from typing import TYPE_CHECKING, Any, Protocol

from linkwright.graph.faults import NotInitializedError
from linkwright.graph.time.fine_alarms import ScheduledAlarm, fine_alarms
from linkwright.graph.time.values import ClockType, Duration, Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from collections.abc import Iterable

    from typing_extensions import Self


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


_SYSTEM = SystemClock()
_LONGEST_WAIT_S = 0.1
"""How long a sleep by ROS time waits at most before it looks whether it was interrupted."""


class ClockChange(IntEnum):
    """The cause of a time jump; numbers as in rcl."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """Which time jumps of a clock a callback is called for (rclpy ``JumpThreshold``).

    Args:
        min_forward: the least jump forward, more than zero; None for no jump forward.
        min_backward: the least jump backward, less than zero; None for no jump backward.
        on_clock_change: whether it is called when ROS time switches to simulated time, or back.

    Raises:
        ValueError: a threshold has the wrong sign, or there is none.
    """

    def __init__(
        self, *, min_forward: Duration | None, min_backward: Duration | None, on_clock_change: bool = True
    ) -> None:
        if min_forward is not None and min_forward.nanoseconds <= 0:
            raise ValueError("min_forward must be a positive non-zero duration")
        if min_backward is not None and min_backward.nanoseconds >= 0:
            raise ValueError("min_backward must be a negative non-zero duration")
        if min_forward is None and min_backward is None and not on_clock_change:
            raise ValueError("At least one jump threshold must be enabled")
        self.min_forward = min_forward
        self.min_backward = min_backward
        self.on_clock_change = on_clock_change

    def is_exceeded(self, jump: TimeJump) -> bool:
        """Whether callbacks are called for a jump."""
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        forward, backward = self.min_forward, self.min_backward
        return (forward is not None and jump.delta >= forward) or (backward is not None and jump.delta <= backward)


@dataclass(frozen=True, slots=True)
class TimeJump:
    """A time jump of a clock: its cause, and how far time went forward, or back where `delta` is negative."""

    clock_change: ClockChange
    delta: Duration


class JumpHandle:
    """Callbacks for the time jumps of a clock; made by `Clock.create_jump_callback`."""

    def __init__(
        self,
        *,
        clock: Clock,
        threshold: JumpThreshold,
        pre_callback: Callable[[], object] | None,
        post_callback: Callable[[TimeJump], object] | None,
    ) -> None:
        if pre_callback is None and post_callback is None:
            raise ValueError("One of pre_callback or post_callback must be callable")
        if pre_callback is not None and not callable(pre_callback):
            raise ValueError("pre_callback must be callable if given")
        if post_callback is not None and not callable(post_callback):
            raise ValueError("post_callback must be callable if given")
        self.threshold = threshold
        self.pre_callback = pre_callback
        self.post_callback = post_callback
        self._clock: Clock | None = clock

    def unregister(self) -> None:
        """Call the callbacks no more."""
        if self._clock is not None:
            self._clock.forget_jump_callback(self)
            self._clock = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Clock:
    """A clock (rclpy ``Clock``). One of type ROS_TIME is a `ROSClock`.

    Args:
        clock_type: system, steady or ROS time.
        timebase: where the time comes from; the computer's clocks when left out.

    Raises:
        TypeError: `clock_type` is not a ClockType.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME, timebase: Timebase | None = None) -> Self:  # noqa: ARG004
        """A clock of the class that fits its type."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        wanted: Any = ROSClock if cls is Clock and clock_type is ClockType.ROS_TIME else cls
        return object.__new__(wanted)  # type: ignore[no-any-return]  # a ROSClock is a Clock

    context: Any = None
    """The context whose shutdown ends a sleep that is given none; None for no context."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME, timebase: Timebase | None = None) -> None:
        self.clock_type = clock_type
        self.timebase: Timebase = timebase or _SYSTEM
        self._jump_handles: list[JumpHandle] = []
        self._lock = threading.RLock()
        self._changed = threading.Condition(self._lock)

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now(self) -> Time:
        """The present as a point in time."""
        return Time(nanoseconds=self.now_ns(), clock_type=self.clock_type)

    def now_ns(self) -> int:
        """Nanoseconds since the clock's epoch."""
        return self.timebase.steady_ns() if self.clock_type is ClockType.STEADY_TIME else self.timebase.now_ns()

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], object] | None = None,
        post_callback: Callable[[TimeJump], object] | None = None,
    ) -> JumpHandle:
        """Register callbacks for before and after time jumps of this clock; only ROS time jumps.

        Raises:
            ValueError: neither callback is given, or one cannot be called.
        """
        handle = JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)
        with self._changed:
            self._jump_handles.append(handle)
        return handle

    def forget_jump_callback(self, handle: JumpHandle) -> None:
        """Remove a handle; see `JumpHandle.unregister`."""
        with self._changed:
            if handle in self._jump_handles:
                self._jump_handles.remove(handle)

    # --- timers ------------------------------------------------------------------------------------------------

    def timer_ns(self) -> int:
        """The time that timers on this clock use, nanoseconds: steady time, or simulated time where that is active."""
        return self.timebase.steady_ns()

    def call_at(self, dispatcher: AlarmSetter, timer_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a value of `timer_ns`; the callback is short."""
        return dispatcher.call_at(timer_ns, callback)

    def add_timer(self, timer: FollowsClock) -> None:
        """Notify a timer when its time switches to simulated time or back, or jumps back."""

    def remove_timer(self, timer: FollowsClock) -> None:
        """Notify it no more."""

    # --- sleeping ----------------------------------------------------------------------------------------------

    def sleep_until(self, until: Time, context: Any = None) -> bool:
        """Block the calling thread until a point in time.

        Args:
            until: when, by a clock of this type.
            context: an object with ``ok()``; the sleep ends early when that is no longer true. The clock's own when
                None.

        Returns:
            Whether the time has come; False when the sleep ended early, because of the context or because the clock
            became simulated or ceased to be.

        Raises:
            ValueError: the point belongs to another type of clock.
            NotInitializedError: the context is not ok to begin with.
        """
        context = self.context if context is None else context
        if context is not None and not context.ok():
            raise NotInitializedError
        if until.clock_type != self.clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        with self._changed:
            generation = self._generation()
            while (left_ns := until.nanoseconds - self.now_ns()) > 0:
                if context is not None and not context.ok():
                    return False
                self._changed.wait(self._longest_wait_s(left_ns))
                if generation != self._generation():
                    return False
        return True

    def sleep_for(self, rel_time: Duration, context: Any = None) -> bool:
        """Block the calling thread for a span of time by this clock; see `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)

    def _longest_wait_s(self, left_ns: int) -> float:
        return min(left_ns / 1e9, _LONGEST_WAIT_S)

    def _generation(self) -> int:
        return 0

    def _notify_before(self, handles: Iterable[JumpHandle]) -> None:
        for handle in handles:
            if handle.pre_callback is not None:
                handle.pre_callback()

    def _notify_after(self, handles: Iterable[JumpHandle], jump: TimeJump) -> None:
        for handle in handles:
            if handle.post_callback is not None:
                handle.post_callback(jump)


class FollowsClock(Protocol):
    """A timer, as its clock knows it."""

    def before_switch(self) -> None:
        """The clock is about to switch to simulated time, or back."""

    def after_switch(self) -> None:
        """The clock has switched."""

    def after_jump_back(self) -> None:
        """Simulated time has jumped back."""


@dataclass(slots=True, order=True)
class _SimulatedAlarm:
    at_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        self.cancelled = True


class ROSClock(Clock):
    """ROS time: the system's until a simulation takes over (rclpy ``ROSClock``).

    While it is simulated (`ros_time_is_active`), only `set_ros_time_override` moves it, forward or back. Timers on it
    keep the rest of their period when it becomes simulated or ceases to be, and restart their period when it jumps
    back (rcl ``rcl_timer``).
    """

    def __init__(self, *, clock_type: ClockType = ClockType.ROS_TIME, timebase: Timebase | None = None) -> None:
        super().__init__(clock_type=clock_type, timebase=timebase)
        self._active = False
        self._switches = 0
        self._override_ns = 0
        self._alarms: list[_SimulatedAlarm] = []
        self._numbers = count()
        self._timers: dict[FollowsClock, None] = {}

    @property
    def ros_time_is_active(self) -> bool:
        """Whether time is simulated."""
        return self._active

    def now_ns(self) -> int:
        """Nanoseconds since the epoch; 0 while simulated time has not begun."""
        return self._override_ns if self._active else self.timebase.now_ns()

    def timer_ns(self) -> int:
        """Simulated time, or steady time."""
        return self._override_ns if self._active else self.timebase.steady_ns()

    def call_at(self, dispatcher: AlarmSetter, timer_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a value of `timer_ns`."""
        with self._lock:  # that of the condition, which enters it in Python: timers come here with each beat
            if not self._active:
                return dispatcher.call_at(timer_ns, callback)
            alarm = _SimulatedAlarm(timer_ns, next(self._numbers), callback)
            if timer_ns > self._override_ns:
                heapq.heappush(self._alarms, alarm)
                return alarm
        return dispatcher.call_at(self.timebase.steady_ns(), callback)

    def add_timer(self, timer: FollowsClock) -> None:
        """Notify a timer of switches, and of jumps back."""
        self._timers[timer] = None

    def remove_timer(self, timer: FollowsClock) -> None:
        """Notify it no more."""
        self._timers.pop(timer, None)

    def set_ros_time_is_active(self, enabled: bool) -> None:
        """Begin or end simulated time."""
        with self._changed:
            if enabled == self._active:
                return
            handles = [handle for handle in self._jump_handles if handle.threshold.on_clock_change]
            timers = tuple(self._timers)
            self._notify_before(handles)
            for timer in timers:
                timer.before_switch()
            before_ns = self.now_ns()
            self._active = enabled
            self._switches += 1
            self._alarms.clear()
            for timer in timers:
                timer.after_switch()
            change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
            self._notify_after(handles, TimeJump(change, Duration(nanoseconds=self.now_ns() - before_ns)))
            self._changed.notify_all()

    _set_ros_time_is_active = set_ros_time_is_active
    """As rclpy names it."""

    def set_ros_time_override(self, time: Time) -> None:
        """Set simulated time; it counts once simulated time is active.

        Raises:
            TypeError: `time` is not a Time.
        """
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        self.override(time.nanoseconds)

    def override(self, now_ns: int) -> None:
        """Set simulated time, nanoseconds since the epoch."""
        with self._changed:
            if not self._active:
                self._override_ns = now_ns
                return
            if self._jump_handles or now_ns < self._override_ns:
                self._jump_to(now_ns)
            else:  # as nearly always
                self._override_ns = now_ns
            self._changed.notify_all()
            due = []
            while self._alarms and self._alarms[0].at_ns <= now_ns:
                due.append(heapq.heappop(self._alarms))
        for alarm in due:
            if not alarm.cancelled:
                alarm.callback()

    def _jump_to(self, now_ns: int) -> None:
        """Set simulated time, and call the jump callbacks that it exceeds, and timers if it goes back."""
        jump = TimeJump(ClockChange.ROS_TIME_NO_CHANGE, Duration(nanoseconds=now_ns - self._override_ns))
        handles = [handle for handle in self._jump_handles if handle.threshold.is_exceeded(jump)]
        self._notify_before(handles)
        self._override_ns = now_ns
        if jump.delta.nanoseconds < 0:
            self._alarms.clear()
            for timer in tuple(self._timers):
                timer.after_jump_back()
        self._notify_after(handles, jump)

    def interrupt(self) -> None:
        """Let sleepers look at their contexts."""
        with self._changed:
            self._changed.notify_all()

    def _longest_wait_s(self, left_ns: int) -> float:
        return _LONGEST_WAIT_S if self._active else super()._longest_wait_s(left_ns)

    def _generation(self) -> int:
        return self._switches
