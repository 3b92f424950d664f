"""Parameters of drive controllers that limit velocity, acceleration, deceleration and jerk.

Source: diff_drive_controller of Humble (``has_..._limits``, ``min_acceleration``) and of Jazzy (NaN for no limit,
``max_deceleration``, ``..._reverse``), and control_toolbox's RateLimiter. If ``has_..._limits`` is not set, positive
limits apply.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isnan, nan

from linkwright.control.controllers.controller import ControllerError
from linkwright.diagnostics import phrase
from linkwright.kinematics.limits import UNBOUNDED, Bounds, SpeedLimiter
from linkwright.nodes.parameter_tables import HUMBLE, JAZZY, parameter


@dataclass(frozen=True, kw_only=True)
class SpeedLimits:
    """The limits of one velocity component, and of its first and second derivatives.

    Velocities are in m/s or rad/s.
    """

    has_velocity_limits: bool | None = parameter(None, description="whether the velocity limits apply", only=HUMBLE)
    has_acceleration_limits: bool | None = parameter(
        None, description="whether the acceleration limits apply", only=HUMBLE
    )
    has_jerk_limits: bool | None = parameter(None, description="whether the jerk limits apply", only=HUMBLE)
    max_velocity: float = parameter(nan, description="in m/s or rad/s; NaN for no limit")
    min_velocity: float = parameter(nan, description="in m/s or rad/s; NaN for -max_velocity")
    max_acceleration: float = parameter(nan, description="in m/s² or rad/s²; NaN for no limit")
    min_acceleration: float = parameter(nan, description="negative, in m/s² or rad/s²; NaN for -max_acceleration")
    max_deceleration: float = parameter(nan, description="negative, in m/s² or rad/s²", only=JAZZY)
    max_acceleration_reverse: float = parameter(nan, description="for driving backward, in m/s² or rad/s²", only=JAZZY)
    max_deceleration_reverse: float = parameter(nan, description="for driving backward, in m/s² or rad/s²", only=JAZZY)
    max_jerk: float = parameter(nan, description="in m/s³ or rad/s³; NaN for no limit")
    min_jerk: float = parameter(nan, description="in m/s³ or rad/s³; NaN for -max_jerk")

    def create_limiter(self, axis: str) -> SpeedLimiter:
        """Return a limiter with these limits.

        Args:
            axis: the name of the axis for error messages, such as ``linear.x``.

        Raises:
            ControllerError: an enabled limit has no value, or a minimum is above its maximum.
        """
        velocity = acceleration = reverse_acceleration = jerk = UNBOUNDED
        if self._is_enabled(axis, "velocity", self.has_velocity_limits, self.max_velocity):
            velocity = _check_bounds(axis, "velocity", self.min_velocity, self.max_velocity)
        if self._is_enabled(axis, "acceleration", self.has_acceleration_limits, self.max_acceleration):
            max_acceleration = self.max_acceleration
            min_acceleration = _first_number(self.max_acceleration_reverse, self.min_acceleration, -max_acceleration)
            braking_limit = _first_number(self.max_deceleration, min_acceleration)
            acceleration = _check_bounds(axis, "acceleration", braking_limit, max_acceleration)
            reverse_acceleration = _check_bounds(
                axis, "acceleration", min_acceleration, _first_number(self.max_deceleration_reverse, max_acceleration)
            )
        if self._is_enabled(axis, "jerk", self.has_jerk_limits, self.max_jerk):
            jerk = _check_bounds(axis, "jerk", self.min_jerk, self.max_jerk)
        return SpeedLimiter(velocity, acceleration, jerk, reverse_acceleration=reverse_acceleration, brakes_freely=True)

    @staticmethod
    def _is_enabled(axis: str, kind: str, enabled: bool | None, max_value: float) -> bool:
        if enabled is None:
            return max_value > 0.0
        if enabled and isnan(max_value):
            raise ControllerError(
                phrase(
                    "Error configuring {axis} speed limiter: Cannot apply {kind} limits if max_{kind} is not specified",
                    axis=axis,
                    kind=kind,
                )
            )
        return enabled


NO_LIMITS = SpeedLimits()


def _first_number(*values: float) -> float:
    """Return the first value that is not NaN."""
    return next(value for value in values if not isnan(value))


def _check_bounds(axis: str, kind: str, min_value: float, max_value: float) -> Bounds:
    min_value = _first_number(min_value, -max_value)
    if min_value > max_value:
        raise ControllerError(
            phrase(
                "the minimum {kind} of '{axis}' ({minimum:g}) is greater than the maximum ({maximum:g})",
                kind=kind,
                axis=axis,
                minimum=min_value,
                maximum=max_value,
            )
        )
    return min_value, max_value
