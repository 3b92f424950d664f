"""Timers and guard conditions: callbacks that time or the node itself sets off."""

from __future__ import annotations

from collections.abc import Callable

from linkwright.graph.clock import Alarm, Clock
from linkwright.graph.executor import Executor, run_logged
from linkwright.graph.log import Logger


class Timer:
    """Calls back at a fixed period, counted from its start: a late call does not shift the next.

    Calls that were missed altogether are left out, as rcl does.
    """

    def __init__(self, period_ns: int, callback: Callable[[], object], clock: Clock, logger: Logger) -> None:
        if period_ns <= 0:
            raise ValueError(f"a timer's period must be positive, not {period_ns} ns")
        self._period_ns = period_ns
        self._callback = callback
        self._clock = clock
        self._logger = logger
        self._alarm: Alarm | None = None
        self._due_ns = 0
        self.reset()

    @property
    def timer_period_ns(self) -> int:
        """The period in nanoseconds; a new one holds from the next `reset` or call on."""
        return self._period_ns

    @timer_period_ns.setter
    def timer_period_ns(self, period_ns: int) -> None:
        if period_ns <= 0:
            raise ValueError(f"a timer's period must be positive, not {period_ns} ns")
        self._period_ns = period_ns

    def is_canceled(self) -> bool:
        """Whether the timer is stopped."""
        return self._alarm is None

    def cancel(self) -> None:
        """Stop; `reset` starts it again."""
        if self._alarm is not None:
            self._alarm.cancel()
            self._alarm = None

    def reset(self) -> None:
        """Start anew: the next call comes one period from now."""
        self.cancel()
        self._due_ns = self._clock.steady_ns() + self._period_ns
        self._alarm = self._clock.call_at(self._due_ns, self._fire)

    def _fire(self) -> None:
        now_ns = self._clock.steady_ns()
        self._due_ns += self._period_ns
        if self._due_ns <= now_ns:
            self._due_ns += ((now_ns - self._due_ns) // self._period_ns + 1) * self._period_ns
        self._alarm = self._clock.call_at(self._due_ns, self._fire)
        run_logged(self._logger, "timer callback", self._callback)


class GuardCondition:
    """Calls back soon after it was triggered: once, however often it was triggered in between."""

    def __init__(self, callback: Callable[[], object], executor: Executor, logger: Logger) -> None:
        self._callback: Callable[[], object] | None = callback
        self._executor = executor
        self._logger = logger
        self._triggered = False

    def trigger(self) -> None:
        """Have the callback called."""
        if not self._triggered and self._callback is not None:
            self._triggered = True
            self._executor.submit(self._run)

    def destroy(self) -> None:
        """Never call back again."""
        self._callback = None

    def _run(self) -> None:
        self._triggered = False
        if self._callback is not None:
            run_logged(self._logger, "guard condition callback", self._callback)
