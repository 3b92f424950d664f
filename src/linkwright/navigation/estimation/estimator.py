"""Fusion of measurements from several sensors, received in any order, in one filter."""

from __future__ import annotations

import heapq
from collections import deque
from dataclasses import dataclass

from linkwright.navigation.estimation.kalman import KalmanFilter, Measurement, Snapshot


@dataclass(frozen=True, slots=True)
class Timing:
    """The settings for prediction without measurements and for late measurements.

    Attributes:
        sensor_timeout_ns: the time without measurements after which the state is predicted.
        predict_to_now: whether the state is always predicted up to the current time.
        history_ns: how long states are kept so that late measurements can be applied at their own time; None to apply
            late measurements to the current state.
    """

    sensor_timeout_ns: int
    predict_to_now: bool = False
    history_ns: int | None = None


class Estimator:
    """A queue of measurements that are passed to a filter in the order of their stamps.

    Args:
        kalman: the filter.
        timing: when to predict and rewind; see `Timing`.
    """

    def __init__(self, kalman: KalmanFilter, timing: Timing) -> None:
        self.filter = kalman
        self._timing = timing
        self._queue: list[tuple[int, int, Measurement]] = []
        self._count = 0
        self._past: deque[Measurement] = deque()
        self._states: deque[Snapshot] = deque()

    def add(self, measurement: Measurement) -> None:
        """Queue a measurement until `advance` is called with its time or a later one."""
        self._count += 1  # Measurements with equal stamps are processed in the order of their arrival.
        heapq.heappush(self._queue, (measurement.time_ns, self._count, measurement))

    def clear(self) -> None:
        """Drop all queued and processed measurements and all saved states."""
        self._queue.clear()
        self._past.clear()
        self._states.clear()

    def advance(self, now_ns: int) -> None:
        """Process the measurements up to now.

        The state is then predicted up to now if `Timing` demands it, or if measurements have timed out.
        """
        kalman, history_ns = self.filter, self._timing.history_ns
        predict = self._timing.predict_to_now
        if self._queue:
            restored = 0
            if history_ns is not None and kalman.initialized and self._queue[0][0] < kalman.time_ns:
                restored = self._rewind(self._queue[0][0])
            self._use(now_ns, restored)
        elif kalman.initialized and now_ns - kalman.time_ns >= self._timing.sensor_timeout_ns:
            predict = True
        if kalman.initialized and predict and now_ns > kalman.time_ns:
            kalman.predict(now_ns)
        if history_ns is not None:
            self._forget(kalman.time_ns - history_ns)

    def _use(self, now_ns: int, restored: int) -> None:
        kalman = self.filter
        while self._queue and self._queue[0][0] <= now_ns:
            _, _, measurement = heapq.heappop(self._queue)
            if restored > 0 and measurement.control is not None:
                kalman.command = measurement.control
            restored -= 1
            kalman.process(measurement)
            if self._timing.history_ns is not None:
                self._past.append(measurement)
                if not self._queue or self._queue[0][0] != kalman.time_ns:
                    self._states.append(kalman.snapshot())

    def _rewind(self, time_ns: int) -> int:
        """Restore the last state before a time, and queue the later measurements again.

        Returns the number of measurements that were queued again.
        """
        oldest = None
        while self._states and self._states[-1].time_ns >= time_ns:
            oldest = self._states.pop()
        snapshot = self._states[-1] if self._states else oldest
        if snapshot is None:
            return 0
        self.filter.restore(snapshot)
        count = 0
        while self._past and self._past[-1].time_ns >= time_ns:
            measurement = self._past.pop()
            if measurement.time_ns > snapshot.time_ns:
                self.add(measurement)
                count += 1
        return count

    def _forget(self, before_ns: int) -> None:
        while self._past and self._past[0].time_ns < before_ns:
            self._past.popleft()
        while self._states and self._states[0].time_ns < before_ns:
            self._states.popleft()
