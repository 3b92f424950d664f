"""Limits of velocity, acceleration and jerk, as parameters of gz's drives.

Source: gz-sim (the parameters of its drives).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from linkwright.kinematics.limits import SpeedLimiter


@dataclass(frozen=True, kw_only=True)
class SpeedLimits:
    """Limits of velocity (m/s, rad/s), acceleration (m/s2, rad/s2) and jerk (m/s3, rad/s3).

    A limit for linear or angular velocity takes precedence over the limit for both.
    """

    min_velocity: float = -inf
    max_velocity: float = inf
    min_acceleration: float = -inf
    max_acceleration: float = inf
    min_jerk: float = -inf
    max_jerk: float = inf
    min_linear_velocity: float | None = None
    max_linear_velocity: float | None = None
    min_linear_acceleration: float | None = None
    max_linear_acceleration: float | None = None
    min_linear_jerk: float | None = None
    max_linear_jerk: float | None = None
    min_angular_velocity: float | None = None
    max_angular_velocity: float | None = None
    min_angular_acceleration: float | None = None
    max_angular_acceleration: float | None = None
    min_angular_jerk: float | None = None
    max_angular_jerk: float | None = None

    def create_limiter(self, kind: str) -> SpeedLimiter:
        """Return the limiter of one kind of velocity, ``linear`` or ``angular``."""
        return SpeedLimiter(*(self._select_bounds(kind, item) for item in ("velocity", "acceleration", "jerk")))

    def _select_bounds(self, kind: str, derivative: str) -> tuple[float, float]:
        specific_limits = (getattr(self, f"{side}_{kind}_{derivative}") for side in ("min", "max"))
        general_limits = (getattr(self, f"{side}_{derivative}") for side in ("min", "max"))
        lower, upper = (
            general_limit if specific_limit is None else specific_limit
            for specific_limit, general_limit in zip(specific_limits, general_limits, strict=True)
        )
        return lower, upper
