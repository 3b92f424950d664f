"""PID control as in control_toolbox of ros2_control.

Source: control_toolbox's ``Pid`` of Humble and Jazzy. The PID controller of gz, which applies the bounds in a different
order, is `linkwright.simulation.plugins.pid`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, isfinite, sqrt

NONE, CLAMPED, BACK_CALCULATION, CONDITIONAL = "none", "legacy", "back_calculation", "conditional_integration"
STRATEGIES = (NONE, CLAMPED, BACK_CALCULATION, CONDITIONAL)
"""The strategies against integral windup, with control_toolbox's names."""


@dataclass(frozen=True, kw_only=True)
class PidGains:
    """The gains and bounds of a PID controller.

    Attributes:
        p, i, d: the gains of the error, its integral and its derivative.
        i_min, i_max: the bounds of the integral term.
        u_min, u_max: the bounds of the command.
        antiwindup: ``none`` bounds the integral term while the integral continues to grow; ``legacy`` bounds the
            integral itself; ``conditional_integration`` stops integrating if that would exceed the bounds further;
            ``back_calculation`` subtracts the excess of a bounded command from the integral.
        tracking_time_constant: the time constant of ``back_calculation`` in s; 0 derives it from the gains.
        error_deadband: the last two strategies do not integrate errors up to this value.
    """

    p: float = 0.0
    i: float = 0.0
    d: float = 0.0
    i_min: float = -inf
    i_max: float = inf
    u_min: float = -inf
    u_max: float = inf
    antiwindup: str = NONE
    tracking_time_constant: float = 0.0
    error_deadband: float = 1e-16

    @property
    def tracking_time(self) -> float:
        """The time constant of ``back_calculation`` in s, or 0 if the gains do not define one."""
        if self.tracking_time_constant > 0.0 or not self.i:
            return self.tracking_time_constant
        return sqrt(self.d / self.i) if self.d and self.d / self.i > 0.0 else abs(self.p / self.i)


class Pid:
    """A PID controller.

    Attributes:
        gains: the gains, which may be replaced at any time.
        integral: the integral term before it is bounded, in units of the command.
    """

    def __init__(self, gains: PidGains) -> None:
        self.gains = gains
        self.reset()

    def reset(self) -> None:
        """Reset the integral and the last error."""
        self.integral = 0.0
        self._previous_error = 0.0

    def command(self, error: float, period_s: float, rate: float | None = None) -> float:
        """Return the command for an error.

        Args:
            error: the error, in any unit.
            period_s: the time since the last call, in seconds.
            rate: the error's rate of change, in its unit per second; None to compute the rate from the previous error.

        Returns:
            The command; 0 if an argument is not finite or no time has passed. The controller's state is then unchanged.
        """
        if period_s <= 0.0 or not isfinite(error):
            return 0.0
        if rate is None:
            rate = (error - self._previous_error) / period_s
            self._previous_error = error
        elif not isfinite(rate):
            return 0.0
        gains = self.gains
        integral_step = gains.i * error * period_s
        proportional_and_derivative = gains.p * error + gains.d * rate
        if gains.antiwindup == CLAMPED:
            self.integral = min(max(self.integral + integral_step, gains.i_min), gains.i_max)
        elif gains.antiwindup == NONE:
            self.integral += integral_step
        unbounded = proportional_and_derivative + min(max(self.integral, gains.i_min), gains.i_max)
        command = min(max(unbounded, gains.u_min), gains.u_max)
        if abs(error) > gains.error_deadband:
            self._update_integral(error, integral_step, period_s, command, unbounded)
        return command

    def _update_integral(self, error: float, step: float, period_s: float, command: float, unbounded: float) -> None:
        if self.gains.antiwindup == BACK_CALCULATION and self.gains.i:
            time_constant = self.gains.tracking_time
            self.integral += step + ((command - unbounded) * period_s / time_constant if time_constant else 0.0)
        elif self.gains.antiwindup == CONDITIONAL and (command == unbounded or error * unbounded <= 0.0):
            self.integral += step
