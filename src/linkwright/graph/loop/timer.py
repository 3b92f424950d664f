"""Timers, which call back at a fixed period, and rates, which sleep until the next tick."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from linkwright.graph.faults import InterruptedWaitError, InvalidHandleError
from linkwright.graph.loop.dispatcher import Entity, accepts
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.node_handle import CallbackGroup, Dispatcher, NodeHandle
from linkwright.graph.time.clock import Alarm, Clock
from linkwright.graph.time.values import ClockType, Time


@dataclass(frozen=True, init=False)
class TimerInfo:
    """The expected and the actual time of a timer's call (rclpy ``TimerInfo``).

    Args:
        expected_call_time: in nanoseconds, or as a point in time.
        actual_call_time: in nanoseconds, or as a point in time.
        clock_type: the type of the clock to which times in nanoseconds refer.
    """

    expected_call_time: Time
    actual_call_time: Time

    def __init__(
        self,
        *,
        expected_call_time: Time | int = 0,
        actual_call_time: Time | int = 0,
        clock_type: ClockType = ClockType.SYSTEM_TIME,
    ) -> None:
        def point(value: Time | int) -> Time:
            return value if isinstance(value, Time) else Time(nanoseconds=value, clock_type=clock_type)

        object.__setattr__(self, "expected_call_time", point(expected_call_time))
        object.__setattr__(self, "actual_call_time", point(actual_call_time))


class Timer(Entity):
    """A timer that calls a callback at a fixed period.

    A late call does not shift the next one. As in rcl, calls that were missed entirely are skipped. The period is
    measured on the timer's clock, which may be a ROS clock that follows simulated time.

    Args:
        node: the node that owns the timer.
        callback: called with a `TimerInfo` if it requires one argument, otherwise without arguments.
        period_ns: the period in nanoseconds; 0 to call as often as possible.
        clock: the clock that measures the period.
        callback_group: decides which entities may run at the same time.
        autostart: whether the timer runs from the start; otherwise `reset` starts it.

    Raises:
        ValueError: the period is negative.
    """

    def __init__(
        self,
        node: NodeHandle,
        callback: Callable[..., object] | None,
        period_ns: int,
        clock: Clock,
        callback_group: CallbackGroup | None = None,
        *,
        autostart: bool = True,
    ) -> None:
        _check_period(period_ns)
        super().__init__(node, callback_group)
        self.callback = callback
        self.clock = clock
        self._period_ns = int(period_ns)
        self._alarm: Alarm | None = None
        self._alarm_ns = 0
        self._is_due = False
        self._running = autostart
        self._last_ns = clock.timer_ns()
        self._due_ns = self._last_ns + self._period_ns
        self._remaining_ns = 0
        clock.add_timer(self)

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds.

        A new period takes effect with the next `reset` or call.
        """
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, period_ns: int) -> None:
        _check_period(period_ns)
        self._period_ns = int(period_ns)

    @property
    def callback(self) -> Callable[..., object] | None:
        """The callback, or None for a timer without a callback."""
        return self._callback

    @callback.setter
    def callback(self, callback: Callable[..., object] | None) -> None:
        self._callback = callback
        self._wants_info = (
            callback is not None and not accepts(callback, 0, unknown=True) and accepts(callback, 1, unknown=False)
        )

    @property
    def description(self) -> str:
        """The description of this entity in log messages."""
        return "timer callback"

    def is_canceled(self) -> bool:
        """Return whether the timer is stopped."""
        return not self._running

    def is_ready(self) -> bool:
        """Return whether a call is due."""
        return self._running and self.clock.timer_ns() >= self._due_ns

    def cancel(self) -> None:
        """Stop the timer.

        `reset` starts it again.
        """
        self._running = False
        self._disarm()

    def reset(self) -> None:
        """Restart the period, so that the next call is due one period from now.

        Raises:
            InvalidHandleError: the timer was destroyed.
        """
        if self.destroyed:
            raise InvalidHandleError
        self._is_due = False
        self._running = True
        self._last_ns = self.clock.timer_ns()
        self._due_ns = self._last_ns + self._period_ns
        # An alarm that fires too early sets itself again, so a timer that is reset with each message does not need a
        # new alarm each time.
        if self._alarm is None or self._alarm_ns > self._due_ns:
            self._disarm_alarm()
            self._arm()

    def time_since_last_call(self) -> int:
        """Return the nanoseconds since the last call, or since the start if there was none."""
        return self.clock.timer_ns() - self._last_ns

    def time_until_next_call(self) -> int | None:
        """Return the nanoseconds until the next call.

        The number is negative if the call is late. Returns None if the timer is stopped.
        """
        return self._due_ns - self.clock.timer_ns() if self._running else None

    def next_call_ns(self) -> int:
        """Return when the next call is due, in nanoseconds of the clock's `Clock.timer_ns`."""
        return self._due_ns

    def retire(self) -> None:
        """Stop the timer permanently, and remove it from its clock."""
        super().retire()
        self.cancel()
        self.clock.remove_timer(self)

    def set_dispatcher(self, dispatcher: Dispatcher | None) -> None:
        """Set the dispatcher that runs the calls.

        Calls that became due while there was no dispatcher result in a single call.
        """
        self._disarm()
        super().set_dispatcher(dispatcher)
        if self._running:
            self._arm()

    def has_work(self) -> bool:
        """Return whether a call is due and has not been taken."""
        return self._is_due

    def take(self) -> Callable[[], object] | None:
        """Return the call of the callback that is due, or None if there is none."""
        self._announced = False
        if not self._is_due:
            return None
        self._is_due = False
        now_ns = self.clock.timer_ns()
        expected_ns = self._due_ns
        self._last_ns = now_ns
        period_ns = self._period_ns
        self._due_ns += period_ns
        if self._due_ns <= now_ns:
            late_ns = now_ns - self._due_ns
            self._due_ns = now_ns if period_ns == 0 else self._due_ns + (late_ns // period_ns + 1) * period_ns
        self._arm()
        callback = self._callback
        if callback is None or not self._wants_info:
            return callback
        clock_type = self.clock.clock_type
        return partial(
            callback,
            TimerInfo(expected_call_time=expected_ns, actual_call_time=now_ns, clock_type=clock_type),
        )

    def before_switch(self) -> None:
        """Save the remaining time to the next call before the clock changes its time source."""
        self._remaining_ns = min(max(self._due_ns - self.clock.timer_ns(), 0), self._period_ns)
        self._disarm_alarm()

    def after_switch(self) -> None:
        """Continue with the remaining time after the clock has changed its time source."""
        self._due_ns = self.clock.timer_ns() + self._remaining_ns
        self._last_ns = self._due_ns - self._period_ns
        if self._running and not self._is_due:
            self._arm()

    def after_jump_back(self) -> None:
        """Adjust the timer after its clock has jumped back.

        The period restarts if the clock is now before the last call; otherwise the next call stays due at the same
        time.
        """
        self._disarm_alarm()
        now_ns = self.clock.timer_ns()
        if now_ns < self._last_ns:
            self._last_ns = now_ns
            self._due_ns = now_ns + self._period_ns
        if self._running and not self._is_due:
            self._arm()

    def _arm(self) -> None:
        dispatcher = self.dispatcher
        if dispatcher is not None:
            self._alarm_ns = self._due_ns
            self._alarm = self.clock.call_at(dispatcher, self._due_ns, self._fire)

    def _disarm(self) -> None:
        self._disarm_alarm()
        self._is_due = False

    def _disarm_alarm(self) -> None:
        alarm, self._alarm = self._alarm, None
        if alarm is not None:
            alarm.cancel()

    def _fire(self) -> None:
        self._alarm = None
        if not self._running:
            return
        if self._alarm_ns < self._due_ns:
            self._arm()
            return
        self._is_due = True
        self.announce()


def _check_period(period_ns: int) -> None:
    if period_ns < 0:
        raise ValueError(f"timer period must be non-negative, not {period_ns} ns")


_MAX_QUIET_WAIT_S = 5.0
"""The time in s after which a sleep reports that its node has no executor."""


class Rate:
    """A fixed rate for a loop: each `sleep` ends with the next tick of a timer.

    A thread other than the sleeping thread must run the timer's callbacks. A coroutine calls `wait` instead of `sleep`.
    A late tick does not shift the ticks after it.

    Args:
        timer: the timer that ticks; the rate replaces its callback.
    """

    def __init__(self, timer: Timer) -> None:
        self.timer = timer
        self._next_tick: Future[None] = Future()
        self._is_ended = self._is_reported = False
        timer.callback = self._tick
        timer.node.add_cleanup(self.wake)

    def sleep(self) -> None:
        """Block the calling thread until the next tick.

        Raises:
            InterruptedWaitError: the rate's node was destroyed, or its graph closed.
        """
        tick = self._begin()
        if not tick.wait(_MAX_QUIET_WAIT_S):
            self._report_idle_node()
            tick.wait()
        self._check_not_ended()

    async def wait(self) -> None:
        """Wait for the next tick in a coroutine.

        Raises:
            InterruptedWaitError: the rate's node was destroyed, or its graph closed.
        """
        await self._begin()
        self._check_not_ended()

    def wake(self) -> None:
        """End all current and future sleeps on this rate."""
        self._is_ended = True
        self._tick()

    def destroy(self) -> bool:
        """Destroy the rate, and wake the threads that sleep on it.

        Returns False if the rate was already destroyed.
        """
        self.wake()
        self.timer.node.remove_cleanup(self.wake)
        return self.timer.node.remove(self.timer)

    def _begin(self) -> Future[None]:
        if self._is_ended or self.timer.destroyed:
            raise InterruptedWaitError
        if self.timer.is_canceled():
            self.timer.reset()
        return self._next_tick

    def _report_idle_node(self) -> None:
        """Log an error if no executor runs the callbacks of the node, so that no tick comes."""
        node = self.timer.node
        if node.dispatcher is None and not self._is_reported:
            self._is_reported = True
            node.logger.error(
                "rate.sleep() does not end, because no executor runs the callbacks of this node. rclpy.spin_once(node) "
                "and rclpy.spin_until_future_complete(node, future) take the node out of the executor that another "
                "thread spins, also on a robot: wait for the future there without spinning the node"
            )

    def _check_not_ended(self) -> None:
        if self._is_ended:
            raise InterruptedWaitError

    def _tick(self) -> None:
        tick, self._next_tick = self._next_tick, Future()
        tick.set_result(None)
