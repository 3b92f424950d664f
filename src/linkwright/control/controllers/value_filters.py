"""Filters of single values, for chains of filters.

Source: the packages filters and control_toolbox (``control_filters``): types, parameters, formulas.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Collection
from dataclasses import dataclass
from math import exp, isnan, nan, pi
from statistics import fmean, median_low
from typing import Any, ClassVar

from linkwright.control.controllers.speed_limits import SpeedLimits
from linkwright.diagnostics import Phrase, phrase
from linkwright.nodes.parameter_tables import above, parameter

ValueFilter = Callable[[float], float]
"""A function that returns the filtered value for the next value."""


def _check_fraction(name: str, value: float) -> Phrase | None:
    """Return an error message unless a value is between 0 and 1."""
    if 0.0 <= value <= 1.0:
        return None
    return phrase("parameter '{name}' must be from 0 to {limit}, but it is {value}", name=name, limit=1, value=value)


def _check_divisor(name: str, value: tuple[float, ...]) -> Phrase | None:
    """Return an error message if the first of some coefficients is missing or 0."""
    if value and value[0]:
        return None
    return phrase("parameter '{name}' must begin with a number other than 0", name=name)


class FilterParameters(ABC):
    """The base class of the parameter tables of filters."""

    @abstractmethod
    def create(self) -> ValueFilter:
        """Return a filter that has received no value."""


@dataclass(frozen=True, kw_only=True)
class _WindowFilter(FilterParameters):
    """A filter of the last values."""

    REDUCE: ClassVar[Callable[[Collection[float]], float]]
    """The function that returns the result for the last values."""
    number_of_observations: int = parameter(0, description="the number of values", check=above(0))

    def create(self) -> ValueFilter:
        """Return a filter that has received no value."""
        window: deque[float] = deque(maxlen=self.number_of_observations)

        def apply(value: float) -> float:
            window.append(value)
            return type(self).REDUCE(window)

        return apply


@dataclass(frozen=True, kw_only=True)
class MeanFilter(_WindowFilter):
    """``filters/MeanFilterDouble``: the mean of the last values."""

    REDUCE = fmean


@dataclass(frozen=True, kw_only=True)
class MedianFilter(_WindowFilter):
    """``filters/MedianFilterDouble``: the median of the last values.

    For an even number of values, it is the smaller one of the two in the middle.
    """

    REDUCE = median_low


@dataclass(frozen=True, kw_only=True)
class TransferFunctionFilter(FilterParameters):
    """``filters/TransferFunctionFilterDouble``: a digital filter.

    The results are a[0] y[n] = sum b[k] x[n-k] - sum a[k] y[n-k].

    Values before the first one are equal to the first one, and so are the results.
    """

    a: tuple[float, ...] = parameter((), description="the coefficients of the results", check=_check_divisor)
    b: tuple[float, ...] = parameter((), description="the coefficients of the values")

    def create(self) -> ValueFilter:
        """Return a filter that has received no value."""
        divisor = self.a[0]
        values: deque[float] = deque(maxlen=len(self.b))
        results: deque[float] = deque(maxlen=len(self.a) - 1)

        def apply(value: float) -> float:
            if not values:
                values.extend([value] * len(self.b))
                results.extend([value] * (len(self.a) - 1))
            values.appendleft(value)
            forward = sum(factor * item for factor, item in zip(self.b, values, strict=True))
            backward = sum(factor * item for factor, item in zip(self.a[1:], results, strict=True))
            result = (forward - backward) / divisor
            results.appendleft(result)
            return result

        return apply


@dataclass(frozen=True, kw_only=True)
class LowPassFilter(FilterParameters):
    """``control_filters/LowPassFilterDouble``: y[n] = b x[n-1] + a y[n-1].

    The first value passes unchanged.
    """

    sampling_frequency: float = parameter(0.0, description="the rate of the values, in Hz", check=above(0.0))
    damping_frequency: float = parameter(0.0, description="the cutoff frequency, in Hz", check=above(0.0))
    damping_intensity: float = parameter(0.0, description="the damping, in dB")

    def create(self) -> ValueFilter:
        """Return a filter that has received no value."""
        damping = 10.0 ** (self.damping_intensity / -10.0)
        decay = exp(-2.0 * pi * self.damping_frequency / (self.sampling_frequency * damping))
        last_value = last_result = nan

        def apply(value: float) -> float:
            nonlocal last_value, last_result
            if isnan(last_result):
                last_value = last_result = value
            last_result = last_value * (1.0 - decay) + last_result * decay
            last_value = value
            return last_result

        return apply


@dataclass(frozen=True, kw_only=True)
class ExponentialFilter(FilterParameters):
    """``control_filters/ExponentialFilterDouble``: y[n] = alpha x[n] + (1 - alpha) y[n-1]."""

    alpha: float = parameter(0.5, description="the weight of the new value, 0 to 1", check=_check_fraction)

    def create(self) -> ValueFilter:
        """Return a filter that has received no value."""
        last_result = nan

        def apply(value: float) -> float:
            nonlocal last_result
            last_result = value if isnan(last_result) else self.alpha * value + (1.0 - self.alpha) * last_result
            return last_result

        return apply


@dataclass(frozen=True, kw_only=True)
class RateLimiter(FilterParameters):
    """``control_filters/RateLimiterDouble``: limits a value and its derivatives.

    A limit that is NaN does not apply. A minimum that is NaN is the negative maximum.
    """

    sampling_interval: float = parameter(0.0, description="the time between two values, in seconds", check=above(0.0))
    max_value: float = parameter(nan, description="the maximum value")
    min_value: float = parameter(nan, description="the minimum value")
    max_first_derivative_pos: float = parameter(nan, description="the maximum first derivative of positive values")
    min_first_derivative_pos: float = parameter(nan, description="the minimum first derivative of positive values")
    max_first_derivative_neg: float = parameter(nan, description="the maximum first derivative of negative values")
    min_first_derivative_neg: float = parameter(nan, description="the minimum first derivative of negative values")
    max_second_derivative: float = parameter(nan, description="the maximum second derivative")
    min_second_derivative: float = parameter(nan, description="the minimum second derivative")

    def create(self) -> ValueFilter:
        """Return a filter that starts at 0.

        Raises:
            ControllerError: a minimum is above its maximum.
        """
        limits = SpeedLimits(
            has_velocity_limits=not isnan(self.max_value),
            has_acceleration_limits=not isnan(self.max_first_derivative_pos),
            has_jerk_limits=not isnan(self.max_second_derivative),
            max_velocity=self.max_value,
            min_velocity=self.min_value,
            max_acceleration=self.max_first_derivative_pos,
            max_acceleration_reverse=self.min_first_derivative_neg,
            max_deceleration=self.min_first_derivative_pos,
            max_deceleration_reverse=self.max_first_derivative_neg,
            max_jerk=self.max_second_derivative,
            min_jerk=self.min_second_derivative,
        )
        limiter = limits.create_limiter("RateLimiterDouble")
        return lambda value: limiter.approach(value, self.sampling_interval)


FILTERS: dict[str, type[Any]] = {
    "filters/MeanFilterDouble": MeanFilter,
    "filters/MedianFilterDouble": MedianFilter,
    "filters/TransferFunctionFilterDouble": TransferFunctionFilter,
    "control_filters/LowPassFilterDouble": LowPassFilter,
    "control_filters/ExponentialFilterDouble": ExponentialFilter,
    "control_filters/RateLimiterDouble": RateLimiter,
}
"""The parameter tables of filters, by the type of the filter."""
