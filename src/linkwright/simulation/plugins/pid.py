"""The PID controller of gz's systems.

Source: gz-math's PID (a bound whose minimum exceeds its maximum has no effect).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Gains:
    """The gains of a PID controller, and the bounds of its integral term and of its command."""

    p: float
    i: float
    d: float
    i_min: float
    i_max: float
    cmd_min: float
    cmd_max: float
    cmd_offset: float


class Pid:
    """A PID controller whose command is a force."""

    def __init__(self, gains: Gains) -> None:
        self._gains = gains
        self._integral = 0.0
        self._previous_error: float | None = None

    def force(self, error: float, seconds: float) -> float:
        """Update the controller with an error, and return the force in N m (or N).

        `seconds` is the time since the last call.
        """
        gains = self._gains
        self._integral = _clip(self._integral + gains.i * error * seconds, gains.i_min, gains.i_max)
        change = 0.0 if self._previous_error is None else (error - self._previous_error) / seconds
        self._previous_error = error
        force = gains.cmd_offset + gains.p * error + self._integral + gains.d * change
        return _clip(force, gains.cmd_min, gains.cmd_max)


def _clip(value: float, lower: float, upper: float) -> float:
    return min(max(value, lower), upper) if lower <= upper else value
