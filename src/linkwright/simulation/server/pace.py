"""The finding that this computer cannot simulate a world as fast as requested."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from linkwright.diagnostics import Diagnostic, Severity, phrase

_SLOW_SPEED_FRACTION = 0.8
_NORMAL_SPEED_FRACTION = 0.9
"""The fractions of the requested real-time factor below which a world becomes slow, and above which it recovers."""
_CHANGE_DURATION_S = 10.0
"""The real time in s for which the speed must differ before the state changes."""


class PaceWatch:
    """Measures the real-time factor of a simulation.

    Args:
        report: called with the finding when the world has become slow, and with None when it has recovered.
    """

    def __init__(self, report: Callable[[Diagnostic | None], object]) -> None:
        self._report = report
        self._is_slow = False
        self._differing_s = 0.0

    def add(self, factor: float, requested: float, elapsed_s: float) -> None:
        """Add a measurement.

        Args:
            factor: the real-time factor.
            requested: the requested real-time factor; infinite for as fast as possible.
            elapsed_s: the real time since the last measurement.
        """
        fraction = _NORMAL_SPEED_FRACTION if self._is_slow else _SLOW_SPEED_FRACTION
        is_slow = requested < inf and factor < fraction * requested
        self._differing_s = 0.0 if is_slow == self._is_slow else self._differing_s + elapsed_s
        if self._differing_s >= _CHANGE_DURATION_S:
            self._differing_s = 0.0
            self._is_slow = not self._is_slow
            self._report(_create_finding(factor) if self._is_slow else None)


def _create_finding(factor: float) -> Diagnostic:
    message = phrase(
        "the world runs at {factor} of real time: this computer cannot simulate it faster", factor=f"{factor:.1g}"
    )
    hint = phrase(
        "nodes follow the simulated time, so everything works, only slower; switch off displays of images, give "
        "cameras fewer pixels and lower rates, and close other programs"
    )
    return Diagnostic("SIM146", message, severity=Severity.WARNING, hint=hint)
