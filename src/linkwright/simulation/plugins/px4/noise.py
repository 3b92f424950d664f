"""Noise with a slowly varying bias, as in datasheets of inertial sensors.

Source: P. S. Maybeck, *Stochastic Models, Estimation and Control*, 1979, section 4.5 (Gauss-Markov processes).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, sqrt

import numpy as np

from linkwright.geometry.arrays import Array


@dataclass(frozen=True, slots=True)
class BiasedNoise:
    """The parameters of noise on the axes of a sensor.

    Attributes:
        density: the noise density, in the unit of the measurement per root of Hz.
        random_walk: the noise that drives the bias, in the unit of the measurement times the root of Hz.
        correlation_time: the time in s after which the bias is independent.
        initial_deviation: the standard deviation of the initial bias.
    """

    density: float
    random_walk: float
    correlation_time: float
    initial_deviation: float = 0.0


class BiasedNoiseSource:
    """Noise on three axes, with a bias for each.

    Args:
        noise: the parameters.
        generator: the source of random numbers.

    Attributes:
        bias: the current bias, shape (3,).
    """

    def __init__(self, noise: BiasedNoise, generator: np.random.Generator) -> None:
        self._noise, self._generator = noise, generator
        self.bias: Array = noise.initial_deviation * generator.standard_normal(3)

    def apply(self, values: Array, seconds: float) -> Array:
        """Return values with noise, and let the bias vary.

        Args:
            values: the true values, shape (3,).
            seconds: the time since the previous measurement.
        """
        noise = self._noise
        if seconds <= 0.0:
            return values + self.bias
        if noise.correlation_time > 0.0:
            decay = exp(-seconds / noise.correlation_time)
            deviation = noise.random_walk * sqrt(noise.correlation_time / 2.0 * (1.0 - decay**2))
            self.bias = decay * self.bias + deviation * self._generator.standard_normal(3)
        noisy: Array = values + self.bias + noise.density / sqrt(seconds) * self._generator.standard_normal(3)
        return noisy

    @property
    def covariance(self) -> Array:
        """The covariance in messages, which is the squared density, shape (9,)."""
        return np.diag([self._noise.density**2] * 3).ravel()
