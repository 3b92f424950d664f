"""Which calls of a logger write: once, not the first time, not too often. The options are those of rclpy's loggers."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

_DEFAULT_TIME_SOURCE = "RCUTILS_STEADY_TIME"
_OPTIONS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class CallFilter:
    """The filters of one place in the code that logs, with what they remember.

    Args:
        severity: that of the place's records.
        name: the name of their logger.
        options: ``throttle_duration_sec``, ``throttle_time_source_type``, ``skip_first``, ``once``.
        steady_ns: the steady count that is meant where no time source is given.

    Raises:
        TypeError: an option is not known, or goes only with another.
        ValueError: the time source is neither a clock nor rcutils' steady time.
    """

    __slots__ = ("_duration_s", "_last_s", "_logged", "_now_s", "_once", "_options", "_severity_and_name", "_skip")

    def __init__(
        self,
        severity: int,
        name: str,
        options: dict[str, Any],
        steady_ns: Callable[[], int] = time.monotonic_ns,
    ) -> None:
        for option in options:
            if option not in _OPTIONS:
                raise TypeError(f'parameter "{option}" is not one of the recognized logging options "{list(_OPTIONS)}"')
        if options.get("throttle_time_source_type") and options.get("throttle_duration_sec") is None:
            raise TypeError(
                'required parameter "throttle_duration_sec" not specified but is required for the the logging '
                'filter "throttle"'
            )
        self._options = dict(options)
        self._severity_and_name = (severity, name)
        self._duration_s = float(options.get("throttle_duration_sec") or 0.0)
        self._now_s = _clock_of(options.get("throttle_time_source_type", _DEFAULT_TIME_SOURCE), steady_ns)
        self._last_s: float | None = None
        self._skip = bool(options.get("skip_first"))
        self._once = bool(options.get("once"))
        self._logged = False

    def check_unchanged(self, severity: int, name: str, options: dict[str, Any]) -> None:
        """Raise ValueError unless a call at the place asks for the same as the first one did."""
        if severity != self._severity_and_name[0]:
            raise ValueError("Logger severity cannot be changed between calls.")
        if name != self._severity_and_name[1]:
            raise ValueError("Logger name cannot be changed between calls.")
        if options != self._options:
            if _filters(options) != _filters(self._options):
                raise ValueError("Requested logging filters cannot be changed between calls.")
            raise ValueError("Logging filter parameters cannot be changed between calls.")

    def lets_through(self) -> bool:
        """Whether the record of one more call is written; takes note of the call."""
        if self._duration_s:
            now_s = self._now_s()
            # A clock that jumped back begins anew.
            if self._last_s is not None and self._last_s <= now_s < self._last_s + self._duration_s:
                return False
            self._last_s = now_s
        if self._skip:
            self._skip = False
            return False
        if self._once:
            first, self._logged = not self._logged, True
            return first
        return True


def _filters(options: dict[str, Any]) -> list[bool]:
    return [bool(options.get(option)) for option in ("throttle_duration_sec", "skip_first", "once")]


def _clock_of(source: Any, steady_ns: Callable[[], int]) -> Callable[[], float]:
    if source == _DEFAULT_TIME_SOURCE:
        return lambda: steady_ns() / 1e9
    now = getattr(source, "now", None)
    if now is None:
        raise ValueError(
            f'Received throttle_time_source_type of "{source}"; it must be a clock or "{_DEFAULT_TIME_SOURCE}"'
        )
    return lambda: float(now().nanoseconds) / 1e9
