"""Clocks of nodes (system, steady and ROS time), time jumps, and the timebase of a graph."""

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
from linkwright.graph.time.fine_alarms import ScheduledAlarm, get_fine_alarms
from linkwright.graph.time.values import ClockType, Duration, Time
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

if TYPE_CHECKING:
    from collections.abc import Iterable

    from typing_extensions import Self


_MAX_PRECISE_WAIT_NS = 20_000_000
"""The maximum length of waits that are precise to some microseconds. Longer waits may end a millisecond late."""


class Alarm(Protocol):
    """A call that is scheduled for a time."""

    def cancel(self) -> None:
        """Cancel the call."""


class CallScheduler(Protocol):
    """A scheduler of calls."""

    def call_at(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a steady time of the graph, in nanoseconds.

        Any thread may call this method. The callback never runs before this method returns. It must be short: it only
        marks entities as ready, and never runs a user's code.
        """


class SettlingDispatcher(Protocol):
    """A dispatcher of a graph's callbacks that can wait until they are done."""

    async def settle(self) -> None:
        """Wait until no work is ready, including calls that other calls make ready."""


class Timebase(ABC):
    """The two clocks of a graph: system time and steady time.

    System time stamps messages and may jump; timers use steady time.

    Attributes:
        is_lockstep: whether time waits for all computations, also for long ones, so that runs repeat exactly.
    """

    is_lockstep = False

    @abstractmethod
    def now_ns(self) -> int:
        """Return the system time, in nanoseconds since the epoch."""

    @abstractmethod
    def steady_ns(self) -> int:
        """Return the steady time, in nanoseconds since an arbitrary start."""

    @abstractmethod
    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call on an event loop for a steady time, in nanoseconds.

        This method must be called in the loop's thread.
        """

    def now(self) -> Time:
        """Return the current system time."""
        return Time(nanoseconds=self.now_ns(), clock_type=ClockType.SYSTEM_TIME)

    def attach(self, dispatcher: SettlingDispatcher) -> None:  # noqa: B027  # most timebases do not need it
        """Attach the dispatcher of a graph that uses this timebase."""


class SystemClock(Timebase):
    """The computer's clocks: system time, and the monotonic time that event loops use as well."""

    def now_ns(self) -> int:
        """Return the computer's time, in nanoseconds since the epoch."""
        return time.time_ns()

    def steady_ns(self) -> int:
        """Return the computer's monotonic time, in nanoseconds."""
        return time.monotonic_ns()

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback on an event loop, with microsecond precision where possible."""
        if steady_ns - time.monotonic_ns() <= _MAX_PRECISE_WAIT_NS:
            alarms = get_fine_alarms(loop)
            if alarms is not None:
                return alarms.call_at(steady_ns, callback)
        return loop.call_at(steady_ns / NANOSECONDS_PER_SECOND, callback)


class JumpClock(Timebase):
    """A clock that only a test advances, so that an hour of timers takes milliseconds.

    Args:
        start_ns: the initial value of `now_ns`, in nanoseconds since the epoch.
        is_lockstep: whether nodes finish long computations before time advances, instead of in other threads.
    """

    def __init__(self, start_ns: int = 1_700_000_000 * NANOSECONDS_PER_SECOND, *, is_lockstep: bool = False) -> None:
        self.is_lockstep = is_lockstep
        self._now_ns = start_ns
        self._steady_ns = 0
        self._alarms: list[ScheduledAlarm] = []
        self._sequence_numbers = count()
        self._dispatchers: list[SettlingDispatcher] = []

    def now_ns(self) -> int:
        """Return the simulated system time, in nanoseconds since the epoch."""
        return self._now_ns

    def steady_ns(self) -> int:
        """Return the time by which the clock was advanced, in nanoseconds."""
        return self._steady_ns

    def call_at(self, loop: AbstractEventLoop, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback for a steady time. See `schedule`."""
        return self.schedule(steady_ns, callback)

    def attach(self, dispatcher: SettlingDispatcher) -> None:
        """Add a dispatcher, which finishes its work before each step of the clock."""
        self._dispatchers.append(dispatcher)

    async def advance(self, seconds: float, *, is_settled: bool = False) -> None:
        """Advance both system time and steady time.

        Each timer is called when it becomes due, and all resulting work is completed before the next one.

        Args:
            seconds: the time to advance, in seconds.
            is_settled: whether all ready work is already done, so that there is nothing to wait for at the start.
        """
        end_ns = self._steady_ns + round(seconds * NANOSECONDS_PER_SECOND)
        if not is_settled:
            await self._settle()
        while self._alarms and self._alarms[0].steady_ns <= end_ns:
            alarm = heapq.heappop(self._alarms)
            if not alarm.cancelled:
                self._move_to(max(alarm.steady_ns, self._steady_ns))
                alarm.callback()
                await self._settle()
        self._move_to(end_ns)

    def schedule(self, steady_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a callback for the moment when the clock is advanced to a steady time."""
        alarm = ScheduledAlarm(steady_ns, next(self._sequence_numbers), callback)
        heapq.heappush(self._alarms, alarm)
        return alarm

    def jump(self, seconds: float) -> None:
        """Move system time forward or back, as when the system clock is corrected.

        Steady time does not change, and no timers are called.

        Args:
            seconds: the time to move forward, in seconds; negative to move back.
        """
        self._now_ns += round(seconds * NANOSECONDS_PER_SECOND)

    def _move_to(self, steady_ns: int) -> None:
        self._now_ns += steady_ns - self._steady_ns
        self._steady_ns = steady_ns

    async def _settle(self) -> None:
        for dispatcher in self._dispatchers:
            await dispatcher.settle()


_SYSTEM = SystemClock()
_MAX_WAIT_S = 0.1
"""The longest time, in seconds, for which a sleep in ROS time waits before it checks for an interruption."""


class ClockChange(IntEnum):
    """The causes of a time jump, with the numbers of rcl."""

    ROS_TIME_NO_CHANGE = 1
    ROS_TIME_ACTIVATED = 2
    ROS_TIME_DEACTIVATED = 3
    SYSTEM_TIME_NO_CHANGE = 4


class JumpThreshold:
    """The time jumps of a clock for which a callback is called (rclpy ``JumpThreshold``).

    Args:
        min_forward: the minimum jump forward, more than zero; None to ignore jumps forward.
        min_backward: the minimum jump backward, less than zero; None to ignore jumps backward.
        on_clock_change: whether the callback is called when ROS time switches to simulated time or back.

    Raises:
        ValueError: a threshold has the wrong sign, or both are None and `on_clock_change` is False.
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
        """Return whether callbacks are called for a jump."""
        if jump.clock_change in (ClockChange.ROS_TIME_ACTIVATED, ClockChange.ROS_TIME_DEACTIVATED):
            return self.on_clock_change
        forward, backward = self.min_forward, self.min_backward
        return (forward is not None and jump.delta >= forward) or (backward is not None and jump.delta <= backward)


@dataclass(frozen=True, slots=True)
class TimeJump:
    """A time jump of a clock: its cause, and its size `delta`, negative for a jump backward."""

    clock_change: ClockChange
    delta: Duration


class JumpHandle:
    """The handle of callbacks for the time jumps of a clock. See `Clock.create_jump_callback`."""

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
        """Unregister the callbacks of this handle."""
        if self._clock is not None:
            self._clock.remove_jump_callback(self)
            self._clock = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.unregister()


class Clock:
    """A clock (rclpy ``Clock``).

    A clock of type ROS_TIME is a `ROSClock`.

    Args:
        clock_type: system, steady or ROS time.
        timebase: the source of the time; the computer's clocks by default.

    Raises:
        TypeError: `clock_type` is not a ClockType.
    """

    def __new__(cls, *, clock_type: ClockType = ClockType.SYSTEM_TIME, timebase: Timebase | None = None) -> Self:  # noqa: ARG004
        """Create a clock of the class that fits its type."""
        if not isinstance(clock_type, ClockType):
            raise TypeError("Clock type must be a ClockType enum")
        clock_class: Any = ROSClock if cls is Clock and clock_type is ClockType.ROS_TIME else cls
        return object.__new__(clock_class)  # type: ignore[no-any-return]  # a ROSClock is a Clock

    context: Any = None
    """The context whose shutdown ends a sleep without a context argument, or None for no context."""

    def __init__(self, *, clock_type: ClockType = ClockType.SYSTEM_TIME, timebase: Timebase | None = None) -> None:
        self.clock_type = clock_type
        self.timebase: Timebase = timebase or _SYSTEM
        self._jump_handles: list[JumpHandle] = []
        self._lock = threading.RLock()
        self._change_condition = threading.Condition(self._lock)

    def __repr__(self) -> str:
        return f"Clock(clock_type={self.clock_type.name})"

    def now(self) -> Time:
        """Return the current time."""
        return Time(nanoseconds=self.now_ns(), clock_type=self.clock_type)

    def now_ns(self) -> int:
        """Return the current time, in nanoseconds since the clock's epoch."""
        return self.timebase.steady_ns() if self.clock_type is ClockType.STEADY_TIME else self.timebase.now_ns()

    def create_jump_callback(
        self,
        threshold: JumpThreshold,
        *,
        pre_callback: Callable[[], object] | None = None,
        post_callback: Callable[[TimeJump], object] | None = None,
    ) -> JumpHandle:
        """Register callbacks that are called before and after time jumps of this clock.

        Only clocks of type ROS_TIME have time jumps.

        Raises:
            ValueError: neither callback is given, or one is not callable.
        """
        handle = JumpHandle(clock=self, threshold=threshold, pre_callback=pre_callback, post_callback=post_callback)
        with self._change_condition:
            self._jump_handles.append(handle)
        return handle

    def remove_jump_callback(self, handle: JumpHandle) -> None:
        """Remove a handle. See `JumpHandle.unregister`."""
        with self._change_condition:
            if handle in self._jump_handles:
                self._jump_handles.remove(handle)

    # --- timers ------------------------------------------------------------------------------------------------

    def timer_ns(self) -> int:
        """Return the time that timers on this clock use, in nanoseconds.

        This is simulated time while it is active, otherwise steady time.
        """
        return self.timebase.steady_ns()

    def call_at(self, dispatcher: CallScheduler, timer_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a value of `timer_ns`.

        The callback must be short.
        """
        return dispatcher.call_at(timer_ns, callback)

    def add_timer(self, timer: ClockFollower) -> None:
        """Register a timer that is notified when the clock switches its time source or jumps back."""

    def remove_timer(self, timer: ClockFollower) -> None:
        """Unregister a timer."""

    # --- sleeping ----------------------------------------------------------------------------------------------

    def sleep_until(self, until: Time, context: Any = None) -> bool:
        """Block the calling thread until a point in time.

        Args:
            until: the point in time, of this clock's type.
            context: an object with ``ok()``; the sleep ends early when this returns False. None for the clock's own
                context.

        Returns:
            Whether the time was reached. False if the sleep ended early, because of the context or because the clock
            switched to simulated time or back.

        Raises:
            ValueError: the point in time belongs to another type of clock.
            NotInitializedError: the context is not ok at the start.
        """
        context = self.context if context is None else context
        if context is not None and not context.ok():
            raise NotInitializedError
        if until.clock_type != self.clock_type:
            raise ValueError("until's clock type does not match this clock's type")
        with self._change_condition:
            generation = self._generation()
            while (remaining_ns := until.nanoseconds - self.now_ns()) > 0:
                if context is not None and not context.ok():
                    return False
                self._change_condition.wait(self._longest_wait_s(remaining_ns))
                if generation != self._generation():
                    return False
        return True

    def sleep_for(self, rel_time: Duration, context: Any = None) -> bool:
        """Block the calling thread for a duration of this clock. See `sleep_until`."""
        return self.sleep_until(self.now() + rel_time, context)

    def _longest_wait_s(self, remaining_ns: int) -> float:
        return min(remaining_ns / 1e9, _MAX_WAIT_S)

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


class ClockFollower(Protocol):
    """The part of a timer that its clock needs."""

    def before_switch(self) -> None:
        """Prepare for a switch of the clock to simulated time or back."""

    def after_switch(self) -> None:
        """Continue after the clock has switched."""

    def after_jump_back(self) -> None:
        """Handle a jump back of simulated time."""


@dataclass(slots=True, order=True)
class _SimulatedAlarm:
    at_ns: int
    number: int
    callback: Callable[[], None] = field(compare=False)
    cancelled: bool = field(default=False, compare=False)

    def cancel(self) -> None:
        self.cancelled = True


class ROSClock(Clock):
    """ROS time: system time until simulated time is activated (rclpy ``ROSClock``).

    While simulated time is active (`ros_time_is_active`), only `set_ros_time_override` moves the clock, forward or
    back. When the clock switches to simulated time or back, timers keep the remaining time to their next call. When
    simulated time jumps back, they restart their period (rcl ``rcl_timer``).
    """

    def __init__(self, *, clock_type: ClockType = ClockType.ROS_TIME, timebase: Timebase | None = None) -> None:
        super().__init__(clock_type=clock_type, timebase=timebase)
        self._active = False
        self._switch_count = 0
        self._override_ns = 0
        self._alarms: list[_SimulatedAlarm] = []
        self._sequence_numbers = count()
        self._timers: dict[ClockFollower, None] = {}

    @property
    def ros_time_is_active(self) -> bool:
        """Whether simulated time is active."""
        return self._active

    def now_ns(self) -> int:
        """Return the current time, in nanoseconds since the epoch.

        While simulated time is active but has not been set, the result is 0.
        """
        return self._override_ns if self._active else self.timebase.now_ns()

    def timer_ns(self) -> int:
        """Return simulated time while it is active, otherwise steady time, in nanoseconds."""
        return self._override_ns if self._active else self.timebase.steady_ns()

    def call_at(self, dispatcher: CallScheduler, timer_ns: int, callback: Callable[[], None]) -> Alarm:
        """Schedule a call for a value of `timer_ns`.

        Simulated time triggers the call while it is active.
        """
        with self._lock:  # Faster than locking the condition; timers often call this.
            if not self._active:
                return dispatcher.call_at(timer_ns, callback)
            alarm = _SimulatedAlarm(timer_ns, next(self._sequence_numbers), callback)
            if timer_ns > self._override_ns:
                heapq.heappush(self._alarms, alarm)
                return alarm
        return dispatcher.call_at(self.timebase.steady_ns(), callback)

    def add_timer(self, timer: ClockFollower) -> None:
        """Register a timer that is notified when the clock switches its time source or jumps back."""
        self._timers[timer] = None

    def remove_timer(self, timer: ClockFollower) -> None:
        """Unregister a timer."""
        self._timers.pop(timer, None)

    def set_ros_time_is_active(self, enabled: bool) -> None:
        """Activate or deactivate simulated time."""
        with self._change_condition:
            if enabled == self._active:
                return
            handles = [handle for handle in self._jump_handles if handle.threshold.on_clock_change]
            timers = tuple(self._timers)
            self._notify_before(handles)
            for timer in timers:
                timer.before_switch()
            previous_ns = self.now_ns()
            self._active = enabled
            self._switch_count += 1
            self._alarms.clear()
            for timer in timers:
                timer.after_switch()
            change = ClockChange.ROS_TIME_ACTIVATED if enabled else ClockChange.ROS_TIME_DEACTIVATED
            self._notify_after(handles, TimeJump(change, Duration(nanoseconds=self.now_ns() - previous_ns)))
            self._change_condition.notify_all()

    _set_ros_time_is_active = set_ros_time_is_active
    """rclpy's name of this method."""

    def set_ros_time_override(self, time: Time) -> None:
        """Set simulated time, which takes effect once simulated time is active.

        Raises:
            TypeError: `time` is not a Time.
        """
        if not isinstance(time, Time):
            raise TypeError(f"Time must be specified as rclpy.time.Time. Received type: {type(time)}")
        self.set_simulated_time(time.nanoseconds)

    def set_simulated_time(self, now_ns: int) -> None:
        """Set simulated time, in nanoseconds since the epoch."""
        with self._change_condition:
            if not self._active:
                self._override_ns = now_ns
                return
            if self._jump_handles or now_ns < self._override_ns:
                self._jump_to(now_ns)
            else:  # the usual case
                self._override_ns = now_ns
            self._change_condition.notify_all()
            due_alarms = []
            while self._alarms and self._alarms[0].at_ns <= now_ns:
                due_alarms.append(heapq.heappop(self._alarms))
        for alarm in due_alarms:
            if not alarm.cancelled:
                alarm.callback()

    def _jump_to(self, now_ns: int) -> None:
        """Set simulated time, and call the jump callbacks whose threshold the jump exceeds.

        If the time jumps back, timers are also notified.
        """
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
        """Wake sleeping threads, so that they check their contexts."""
        with self._change_condition:
            self._change_condition.notify_all()

    def _longest_wait_s(self, remaining_ns: int) -> float:
        return _MAX_WAIT_S if self._active else super()._longest_wait_s(remaining_ns)

    def _generation(self) -> int:
        return self._switch_count
