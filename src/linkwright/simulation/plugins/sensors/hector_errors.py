"""Sensor errors of hector_gazebo_plugins: offset, slow drift, white noise and scale.

Source: hector_gazebo_plugins (parameters, defaults, formulas).
"""

from __future__ import annotations

from math import exp

import numpy as np

from linkwright.geometry.arrays import Array
from linkwright.xmltree import Element

_PARAMETER_NAMES = ("offset", "drift", "driftFrequency", "gaussianNoise", "scaleError")
_DEFAULT_DRIFT_FREQUENCY_HZ = 1.0 / 3600.0
"""The default of the frequency of the drift, in 1/s."""


def error_names(prefix: str) -> tuple[str, ...]:
    """Return the names of an error model's parameters with a prefix, such as ``rateDrift``."""
    return tuple(f"{prefix}{name[0].upper()}{name[1:]}" if prefix else name for name in _PARAMETER_NAMES)


class ErrorModel:
    """The errors of three measured values.

    Args:
        element: the element of the plugin; a parameter has one number, or one for each value.
        prefix: the first part of the names of the parameters.
        generator: the source of the noise.

    Attributes:
        gaussian_noise: the standard deviations of the white noise, shape (3,).
        drift: the current drift, shape (3,).
    """

    def __init__(self, element: Element | None, prefix: str, generator: np.random.Generator) -> None:
        self._generator = generator
        offset, drift, frequency, noise, scale = error_names(prefix)
        self._offset = _read_vector(element, offset, 0.0)
        self._drift_deviation = _read_vector(element, drift, 0.0)
        self._frequency = _read_vector(element, frequency, _DEFAULT_DRIFT_FREQUENCY_HZ)
        self.gaussian_noise = _read_vector(element, noise, 0.0)
        self._scale = _read_vector(element, scale, 1.0)
        self.drift = self._drift_deviation * generator.standard_normal(3)

    @property
    def bias(self) -> Array:
        """The errors without the white noise, shape (3,)."""
        return self._offset + self.drift

    @property
    def covariance(self) -> Array:
        """The covariance of the white noise, shape (9,)."""
        return np.diag(self.gaussian_noise**2).ravel()

    @property
    def total_covariance(self) -> Array:
        """The covariance of the white noise and the drift, shape (9,)."""
        return np.diag(self.gaussian_noise**2 + self._drift_deviation**2).ravel()

    def advance(self, seconds: float) -> None:
        """Let the drift change for a time in s."""
        decay = np.array([exp(-seconds * frequency) for frequency in self._frequency])
        deviation = np.sqrt(2.0 * self._frequency) * self._drift_deviation
        self.drift = decay * self.drift + seconds * deviation * self._generator.standard_normal(3)

    def apply(self, values: Array, seconds: float) -> Array:
        """Return values with errors, after a time in s."""
        self.advance(seconds)
        noisy: Array = values * self._scale + self.bias + self.gaussian_noise * self._generator.standard_normal(3)
        return noisy


def _read_vector(element: Element | None, tag: str, default: float) -> Array:
    """Return the numbers of a parameter, shape (3,).

    A text without one or three numbers means the default.
    """
    child = None if element is None else element.first(tag)
    try:
        numbers = np.array([float(word) for word in ("" if child is None else child.text()).split()])
    except ValueError:
        return np.full(3, default)
    return np.array(np.broadcast_to(numbers, 3)) if len(numbers) in (1, 3) else np.full(3, default)
