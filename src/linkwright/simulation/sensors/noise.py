"""Sensor noise, as the ``<noise>`` element of SDF describes it.

Source: SDFormat specification 1.12 (the elements of ``<noise>``), and the ``GaussianNoiseModel`` of Gazebo (how a bias
changes over time).
"""

from __future__ import annotations

from math import exp, sqrt

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.geometry.single import Vector3
from linkwright.sdf.noise import Noise, NoiseXyz

_BATCH_SIZE = 64
"""The number of random vectors drawn at a time."""


class NoiseSource:
    """The noise of one measured value, or of several values that share a bias.

    Args:
        noise: the parsed ``<noise>``, in the unit of the values.
        generator: the random number generator.
    """

    def __init__(self, noise: Noise, generator: np.random.Generator) -> None:
        self._noise = noise
        self._generator = generator
        self._drift = 0.0
        self._bias = 0.0
        if noise.type != "none" and (noise.bias_mean or noise.bias_stddev):
            self._bias = generator.normal(noise.bias_mean, abs(noise.bias_stddev)) * generator.choice((-1.0, 1.0))

    @property
    def variance(self) -> float:
        """The square of the standard deviation, or 0 for noise of type ``none``."""
        return 0.0 if self._noise.type == "none" else self._noise.stddev**2

    @property
    def is_silent(self) -> bool:
        """Whether the noise is of type ``none``."""
        return self._noise.type == "none"

    @property
    def is_white(self) -> bool:
        """Whether the noise is Gaussian with a constant bias and without quantization."""
        noise = self._noise
        return noise.type == "gaussian" and not noise.dynamic_bias_stddev and noise.stddev > 0

    @property
    def offset(self) -> float:
        """The constant offset of all values: the sum of the bias and the mean."""
        return 0.0 if self.is_silent else float(self._bias + self._noise.mean)

    def apply(self, values: Array, period: float = 0.0) -> Array:
        """Return values with noise added.

        Args:
            values: an array of any shape.
            period: the time in s since the last call, during which the bias drifts; 0 for no drift.
        """
        noise = self._noise
        if self.is_silent:
            return values
        if noise.dynamic_bias_stddev > 0 and noise.dynamic_bias_correlation_time > 0 and period > 0:
            self._drift_bias(period)
        noisy: Array = values + self._bias + self._drift
        if noise.stddev > 0 or noise.mean:
            noisy = noisy + self._generator.normal(noise.mean, abs(noise.stddev), np.shape(values) or None)
        if noise.type == "gaussian_quantized" and noise.precision > 0:
            noisy = np.round(noisy / noise.precision) * noise.precision
        return noisy

    def _drift_bias(self, period: float) -> None:
        stddev, tau = self._noise.dynamic_bias_stddev, self._noise.dynamic_bias_correlation_time
        step = sqrt(stddev**2 * tau / 2 * (1 - exp(-2 * period / tau)))
        self._drift = exp(-period / tau) * self._drift + self._generator.normal(0.0, step)


class VectorNoise:
    """Noise on the three components of a vector.

    Args:
        noise: the parsed ``<noise>`` of each component.
        generator: the random number generator.
    """

    def __init__(self, noise: NoiseXyz, generator: np.random.Generator) -> None:
        self._sources = [NoiseSource(component, generator) for component in (noise.x, noise.y, noise.z)]
        self.variances: Array = np.array([source.variance for source in self._sources])
        """The squares of the standard deviations, shape (3,)."""
        self.covariance: Array = np.diag(self.variances).ravel()
        """The covariance matrix, row by row, shape (9,)."""
        self._generator = generator
        self._is_white = all(source.is_white for source in self._sources)
        self._is_silent = all(source.is_silent for source in self._sources)
        self._offsets = [source.offset for source in self._sources]
        self._deviations: list[float] = np.sqrt(self.variances).tolist()
        self._samples: list[list[float]] = []

    def apply(self, vector: Array, period: float = 0.0) -> Array:
        """Return a vector, shape (3,), with noise added."""
        x, y, z = vector.tolist()
        return np.array(self.apply_to_tuple((x, y, z), period))

    def apply_to_tuple(self, vector: Vector3, period: float = 0.0) -> Vector3:
        """Return a vector, given as a tuple, with noise added.

        For three numbers, computing with plain floats is faster than computing with arrays.

        Args:
            vector: the components of the vector.
            period: the time in s since the last call, during which a bias drifts; 0 for no drift.
        """
        if self._is_silent:
            return vector
        if self._is_white:  # Drawing many numbers takes hardly longer than drawing three numbers.
            if not self._samples:
                self._samples = self._generator.standard_normal((_BATCH_SIZE, 3)).tolist()
            (x, y, z), (a, b, c) = vector, self._samples.pop()
            (i, j, k), (u, v, w) = self._offsets, self._deviations
            return x + (i + u * a), y + (j + v * b), z + (k + w * c)
        x, y, z = (
            value if source.is_silent else float(source.apply(np.array(value), period))
            for value, source in zip(vector, self._sources, strict=True)
        )
        return x, y, z
