"""A field of waves in deep water: the sum of a few Gerstner waves.

A particle of the surface that rests at x0 is at ``x0 - sum q a d sin(theta)``, at the height ``sum a cos(theta)``, with
``theta = k d x0 - omega t``: amplitude a, wavenumber k, direction d, and a steepness q between 0 (sine waves) and 1.

Source: J. Tessendorf, "Simulating ocean water", 2001; W. J. Pierson and L. Moskowitz, "A proposed spectral form for
fully developed wind seas", 1964; VRX (parameters, defaults, how the spectrum is sampled, constants).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, pi

import numpy as np

from linkwright.diagnostics import Phrase, phrase
from linkwright.geometry.arrays import Array

SPECTRUM, CONSTANT_RATIO = "PMS", "CWR"
"""The models: samples of the spectrum of Pierson and Moskowitz, and a constant ratio of wavelength to amplitude."""

_DISPERSION_GRAVITY = 9.8
"""The gravity in m/s2 that relates wavenumbers to frequencies."""
_SPECTRUM_GRAVITY = 9.81
"""The gravity in m/s2 in the spectrum."""
_SPECTRUM_ALPHA = 0.0081
_SPECTRUM_BETA = 5 / 4
_SAMPLED_COUNT = 3
"""The minimum number of frequencies from which the bandwidth of a sample is computed."""
_TOLERANCE_M = 1e-9
_MAX_ITERATIONS = 30


@dataclass(frozen=True, slots=True)
class WaveParameters:
    """The parameters of a field of waves.

    Attributes:
        model: `SPECTRUM` or `CONSTANT_RATIO`.
        number: the number of waves.
        scale: the ratio of consecutive frequencies; for `CONSTANT_RATIO`, of consecutive amplitudes.
        angle: the angle between the directions of consecutive waves, in rad.
        steepness: 0 for sine waves, 1 for the steepest waves.
        amplitude: the mean amplitude in m, for `CONSTANT_RATIO`.
        period: the mean period in s; in the spectrum, that of its peak.
        direction: the mean direction in rad.
        tau: the time constant in s with which the waves grow from calm water.
        gain: a factor for the amplitudes, for `SPECTRUM`.
    """

    model: str = SPECTRUM
    number: int = 3
    scale: float = 1.1
    angle: float = 0.4
    steepness: float = 0.0
    amplitude: float = 0.0
    period: float = 5.0
    direction: float = 0.0
    tau: float = 2.0
    gain: float = 1.0

    def find_mistake(self) -> Phrase | None:
        """Return what makes the parameters invalid, or None."""
        if self.model not in (SPECTRUM, CONSTANT_RATIO):
            return phrase(
                "the model of the waves is '{model}', not {first} or {second}",
                model=self.model,
                first=SPECTRUM,
                second=CONSTANT_RATIO,
            )
        if self.number < 1 or self.scale <= 0.0 or self.period <= 0.0:
            return phrase("<number>, <scale> and <period> of waves must be greater than 0")
        return None


class WaveField:
    """A field of waves.

    Attributes:
        parameters: the parameters, which must be valid.
        amplitudes: the amplitude of each wave in m, shape (n,).
        frequencies: the angular frequency of each wave in rad/s, shape (n,).
        wavenumbers: the wavenumber of each wave in rad/m, shape (n,).
        directions: the direction of each wave, shape (n, 2).
        steepnesses: the steepness of each wave, shape (n,).
    """

    def __init__(self, parameters: WaveParameters) -> None:
        self.parameters = parameters
        offsets, self.amplitudes, self.frequencies = (
            _sample_spectrum(parameters) if parameters.model == SPECTRUM else _scale_amplitudes(parameters)
        )
        self.wavenumbers = self.frequencies**2 / _DISPERSION_GRAVITY
        angles = parameters.direction + offsets * parameters.angle
        self.directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        slopes = self.amplitudes * self.wavenumbers * parameters.number
        self.steepnesses = np.minimum(
            np.divide(parameters.steepness, slopes, out=np.zeros_like(slopes), where=slopes > 0.0), 1.0
        )

    def heights(self, points: Array, seconds: float, *, sine: bool = False) -> Array:
        """Return the height of the surface above calm water at points of the world, in m.

        Args:
            points: x and y of the points in m, shape (m, 2).
            seconds: the time since the waves began to grow.
            sine: whether to ignore the steepness of the waves.
        """
        growth = self._compute_growth(seconds)
        rest_points = points
        if not sine and growth and self.steepnesses.any():
            rest_points = self._find_rest_points(points, seconds, growth)
        heights: Array = growth * (np.cos(self._compute_phases(rest_points, seconds)) @ self.amplitudes)
        return heights

    def wave_rows(self, *, sine: bool = False) -> tuple[tuple[float, float, float, float, float, float], ...]:
        """Return the amplitude, frequency, wavenumber, steepness and direction of each wave.

        Args:
            sine: whether to ignore the steepness of the waves.
        """
        steepnesses = np.zeros_like(self.steepnesses) if sine else self.steepnesses
        columns = (self.amplitudes, self.frequencies, self.wavenumbers, steepnesses, *self.directions.T)
        return tuple(zip(*(column.tolist() for column in columns), strict=True))

    def _compute_growth(self, seconds: float) -> float:
        tau = self.parameters.tau
        return 1.0 - exp(-max(seconds, 0.0) / tau) if tau > 0.0 else 1.0

    def _compute_phases(self, points: Array, seconds: float) -> Array:
        """Return the phase of each wave at each point, shape (m, n)."""
        phases: Array = (points @ self.directions.T) * self.wavenumbers - self.frequencies * seconds
        return phases

    def _find_rest_points(self, points: Array, seconds: float, growth: float) -> Array:
        """Return where the particles that are at some points rest in calm water (Newton's method)."""
        displacements = growth * self.steepnesses * self.amplitudes
        rest_points = points
        for _ in range(_MAX_ITERATIONS):
            phases = self._compute_phases(rest_points, seconds)
            errors = rest_points - (np.sin(phases) * displacements) @ self.directions - points
            if np.abs(errors).max() < _TOLERANCE_M:
                break
            slopes = np.cos(phases) * displacements * self.wavenumbers
            jacobians = np.eye(2) - np.einsum("mn,ni,nj->mij", slopes, self.directions, self.directions)
            rest_points = rest_points - np.linalg.solve(jacobians, errors[..., np.newaxis])[..., 0]
        return rest_points


def _sample_spectrum(parameters: WaveParameters) -> tuple[Array, Array, Array]:
    """Return the offsets from the middle wave, the amplitudes, and the angular frequencies.

    Each wave has the energy of the spectrum in its band, which reaches half way to its neighbors.
    """
    number = parameters.number
    offsets: Array = np.arange(max(number, _SAMPLED_COUNT), dtype=np.float64) - 1.0
    peak = 2 * pi / parameters.period
    frequencies: Array = peak * parameters.scale**offsets
    densities = (
        _SPECTRUM_ALPHA * _SPECTRUM_GRAVITY**2 / frequencies**5 * np.exp(-_SPECTRUM_BETA * (peak / frequencies) ** 4)
    )
    bands = np.abs(np.gradient(frequencies))
    amplitudes: Array = parameters.gain * np.sqrt(2.0 * densities * bands)
    return offsets[:number], amplitudes[:number], frequencies[:number]


def _scale_amplitudes(parameters: WaveParameters) -> tuple[Array, Array, Array]:
    """Return the same as `_sample_spectrum`, for waves with a constant ratio of wavelength to amplitude."""
    offsets: Array = np.arange(parameters.number, dtype=np.float64) - parameters.number // 2
    scales = parameters.scale**offsets
    amplitudes: Array = parameters.amplitude * scales
    frequencies: Array = 2 * pi / parameters.period / np.sqrt(scales)
    return offsets, amplitudes, frequencies
