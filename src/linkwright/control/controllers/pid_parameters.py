"""The parameters of PID controllers, as in control_toolbox."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from linkwright.control.motion.pid import CLAMPED, NONE, STRATEGIES, PidGains
from linkwright.nodes.parameter_tables import one_of, parameter


@dataclass(frozen=True, kw_only=True)
class PidParameters:
    """The parameters of a PID controller.

    The integral term is bounded by `i_clamp`, or by `i_clamp_min` and `i_clamp_max` if `i_clamp` is not set.
    """

    p: float = parameter(0.0, description="the proportional gain")
    i: float = parameter(0.0, description="the integral gain")
    d: float = parameter(0.0, description="the derivative gain")
    i_clamp: float | None = parameter(None, description="the maximum magnitude of the integral term")
    i_clamp_max: float = parameter(inf, description="the maximum integral term")
    i_clamp_min: float = parameter(-inf, description="the minimum integral term")
    u_clamp_max: float = parameter(inf, description="the maximum command")
    u_clamp_min: float = parameter(-inf, description="the minimum command")
    antiwindup: bool = parameter(False, description="whether to bound the integral, not only the integral term")
    antiwindup_strategy: str = parameter(
        NONE, description="how the integral is bounded while the command is at its limit", check=one_of(*STRATEGIES)
    )
    tracking_time_constant: float = parameter(0.0, description="the time constant of back_calculation, in seconds")
    error_deadband: float = parameter(1e-16, description="smaller errors do not change the integral")

    @property
    def pid(self) -> PidGains:
        """The gains as `PidGains`, for `Pid`."""
        low, high = self.i_clamp_min, self.i_clamp_max
        if self.i_clamp is not None:
            low, high = -abs(self.i_clamp), abs(self.i_clamp)
        return PidGains(
            p=self.p,
            i=self.i,
            d=self.d,
            i_min=low,
            i_max=high,
            u_min=self.u_clamp_min,
            u_max=self.u_clamp_max,
            antiwindup=CLAMPED if self.antiwindup else self.antiwindup_strategy,
            tracking_time_constant=self.tracking_time_constant,
            error_deadband=self.error_deadband,
        )
