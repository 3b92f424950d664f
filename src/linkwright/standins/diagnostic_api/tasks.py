"""Tasks that check frequencies and timestamps (API of ``diagnostic_updater``)."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from linkwright.graph.time.clock import ROSClock
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.standins.diagnostic_api.status import DiagnosticStatus
from linkwright.standins.diagnostic_api.updater import DiagnosticTask


@dataclass
class FrequencyStatusParam:
    """The bounds of a frequency.

    Attributes:
        freq_bound: ``min`` and optionally ``max``, in Hz. Later changes of the dictionary count.
        tolerance: the part by which a frequency may be beyond the bounds.
        window_size: the number of reports that the frequency is averaged over.
    """

    freq_bound: Mapping[str, float]
    tolerance: float = 0.1
    window_size: int = 5


class FrequencyStatus(DiagnosticTask):
    """A task that checks how often `tick` is called.

    The status is ERROR without events in the window, and WARN if the frequency is beyond the bounds.

    Args:
        params: the bounds.
        name: the name of the task.
    """

    def __init__(self, params: FrequencyStatusParam, name: str = "FrequencyStatus") -> None:
        super().__init__(name)
        self.params = params
        self.lock = threading.Lock()
        self.clear()

    def clear(self) -> None:
        """Forget all events."""
        with self.lock:
            self.count = 0
            self.times = [ROSClock().now()] * self.params.window_size
            self.seq_nums = [0] * self.params.window_size
            self.hist_indx = 0

    def tick(self) -> None:
        """Count an event."""
        with self.lock:
            self.count += 1

    def run(self, stat: Any) -> Any:
        """Fill a status with the number and frequency of events."""
        with self.lock:
            now = ROSClock().now()
            events = self.count - self.seq_nums[self.hist_indx]
            window = (now - self.times[self.hist_indx]).nanoseconds / NANOSECONDS_PER_SECOND
            frequency = events / window if window > 0.0 else 0.0
            self.seq_nums[self.hist_indx], self.times[self.hist_indx] = self.count, now
            self.hist_indx = (self.hist_indx + 1) % self.params.window_size
            stat.summary(*self._judge(events, frequency))
            stat.add("Events in window", f"{events:d}")
            stat.add("Events since startup", f"{self.count:d}")
            stat.add("Duration of window (s)", f"{window:f}")
            stat.add("Actual frequency (Hz)", f"{frequency:f}")
            self._add_bounds(stat)
        return stat

    @property
    def _bounds(self) -> tuple[float, float | None]:
        """The lowest and the highest acceptable frequency."""
        bound, tolerance = self.params.freq_bound, self.params.tolerance
        return bound["min"] * (1 - tolerance), bound["max"] * (1 + tolerance) if "max" in bound else None

    def _judge(self, events: int, frequency: float) -> tuple[Any, str]:
        lowest, highest = self._bounds
        if events == 0:
            return DiagnosticStatus.ERROR, "No events recorded."
        if frequency < lowest:
            return DiagnosticStatus.WARN, "Frequency too low."
        if highest is not None and frequency > highest:
            return DiagnosticStatus.WARN, "Frequency too high."
        return DiagnosticStatus.OK, "Desired frequency met"

    def _add_bounds(self, stat: Any) -> None:
        bound = self.params.freq_bound
        lowest, highest = self._bounds
        if bound["min"] == bound.get("max"):
            stat.add("Target frequency (Hz)", f"{bound['min']:f}")
        if bound["min"] > 0:
            stat.add("Minimum acceptable frequency (Hz)", f"{lowest:f}")
        if highest is not None:
            stat.add("Maximum acceptable frequency (Hz)", f"{highest:f}")


@dataclass
class TimeStampStatusParam:
    """The bounds of the age of timestamps, in seconds; negative ages are in the future."""

    min_acceptable: float = -1
    max_acceptable: float = 5


class TimeStampStatus(DiagnosticTask):
    """A task that checks the age of the timestamps that `tick` gets.

    Each report is about the timestamps since the last one. The counts of reports with errors remain.

    Args:
        params: the bounds; None for -1 s to 5 s.
        name: the name of the task.
    """

    def __init__(self, params: TimeStampStatusParam | None = None, name: str = "Timestamp Status") -> None:
        super().__init__(name)
        self.params = TimeStampStatusParam() if params is None else params
        self.lock = threading.Lock()
        self.early_count = self.late_count = self.zero_count = 0
        self._start_period()

    def _start_period(self) -> None:
        self.zero_seen = False
        self.max_delta = self.min_delta = 0.0
        self.deltas_valid = False

    def tick(self, stamp: Any) -> None:
        """Record a timestamp, a `Time` or seconds as a float."""
        seconds = stamp if isinstance(stamp, float) else stamp.nanoseconds / NANOSECONDS_PER_SECOND
        with self.lock:
            if seconds == 0:
                self.zero_seen = True
                return
            delta = ROSClock().now().nanoseconds / NANOSECONDS_PER_SECOND - seconds
            self.max_delta = max(delta, self.max_delta) if self.deltas_valid else delta
            self.min_delta = min(delta, self.min_delta) if self.deltas_valid else delta
            self.deltas_valid = True

    def run(self, stat: Any) -> Any:
        """Fill a status with the ages of the timestamps since the last report."""
        with self.lock:
            stat.summary(DiagnosticStatus.OK, "Timestamps are reasonable.")
            if not self.deltas_valid:
                stat.summary(DiagnosticStatus.WARN, "No data since last update.")
            else:
                self._check(stat)
            stat.add("Earliest timestamp delay:", f"{self.min_delta:f}")
            stat.add("Latest timestamp delay:", f"{self.max_delta:f}")
            stat.add("Earliest acceptable timestamp delay:", f"{self.params.min_acceptable:f}")
            stat.add("Latest acceptable timestamp delay:", f"{self.params.max_acceptable:f}")
            stat.add("Late diagnostic update count:", f"{self.late_count:d}")
            stat.add("Early diagnostic update count:", f"{self.early_count:d}")
            stat.add("Zero seen diagnostic update count:", f"{self.zero_count:d}")
            self._start_period()
        return stat

    def _check(self, stat: Any) -> None:
        if self.min_delta < self.params.min_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in future seen.")
            self.early_count += 1
        if self.max_delta > self.params.max_acceptable:
            stat.summary(DiagnosticStatus.ERROR, "Timestamps too far in past seen.")
            self.late_count += 1
        if self.zero_seen:
            stat.summary(DiagnosticStatus.ERROR, "Zero timestamp seen.")
            self.zero_count += 1


class Heartbeat(DiagnosticTask):
    """A task that is always OK: the node is alive."""

    def __init__(self) -> None:
        super().__init__("Heartbeat")

    def run(self, stat: Any) -> Any:
        """Fill a status with ``Alive``."""
        stat.summary(DiagnosticStatus.OK, "Alive")
        return stat
