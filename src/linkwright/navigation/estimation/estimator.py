"""Fuse measurements from several sensors, received in any order, in one filter."""

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
    """A filter that processes queued measurements in the order of their stamps.

    Args:
        kalman: the filter.
        timing: the settings of prediction and of late measurements.
    """

    def __init__(self, kalman: KalmanFilter, timing: Timing) -> None:
        self.filter = kalman
        self._timing = timing
        self._queue: list[tuple[int, int, Measurement]] = []
        self._count = 0
        self._processed: deque[Measurement] = deque()
        self._states: deque[Snapshot] = deque()

    def add(self, measurement: Measurement) -> None:
        """Queue a measurement until `advance` is called with its time or a later one."""
        self._count += 1  # Measurements with equal stamps are processed in the order of their arrival.
        heapq.heappush(self._queue, (measurement.time_ns, self._count, measurement))

    def clear(self) -> None:
        """Drop all queued and processed measurements and all saved states."""
        self._queue.clear()
        self._processed.clear()
        self._states.clear()

    def advance(self, now_ns: int) -> None:
        """Process the measurements up to now.

        The state is then predicted up to now if `Timing.predict_to_now` is set, or if measurements have timed out.
        """
        kalman, history_ns = self.filter, self._timing.history_ns
        must_predict = self._timing.predict_to_now
        if self._queue:
            requeued_count = 0
            if history_ns is not None and kalman.is_initialized and self._queue[0][0] < kalman.time_ns:
                requeued_count = self._rewind(self._queue[0][0])
            self._process_queue(now_ns, requeued_count)
        elif kalman.is_initialized and now_ns - kalman.time_ns >= self._timing.sensor_timeout_ns:
            must_predict = True
        if kalman.is_initialized and must_predict and now_ns > kalman.time_ns:
            kalman.predict(now_ns)
        if history_ns is not None:
            self._drop_history(kalman.time_ns - history_ns)

    def _process_queue(self, now_ns: int, requeued_count: int) -> None:
        kalman = self.filter
        while self._queue and self._queue[0][0] <= now_ns:
            _, _, measurement = heapq.heappop(self._queue)
            if requeued_count > 0 and measurement.control is not None:
                kalman.command = measurement.control
            requeued_count -= 1
            kalman.process(measurement)
            if self._timing.history_ns is not None:
                self._processed.append(measurement)
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
        while self._processed and self._processed[-1].time_ns >= time_ns:
            measurement = self._processed.pop()
            if measurement.time_ns > snapshot.time_ns:
                self.add(measurement)
                count += 1
        return count

    def _drop_history(self, before_ns: int) -> None:
        while self._processed and self._processed[0].time_ns < before_ns:
            self._processed.popleft()
        while self._states and self._states[0].time_ns < before_ns:
            self._states.popleft()
