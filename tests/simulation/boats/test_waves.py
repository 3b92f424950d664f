"""Fields of waves against the formulas of their spectrum and of Gerstner waves."""

from __future__ import annotations

from math import exp, pi

import numpy as np
import pytest

from linkwright.simulation.plugins.boats.waves import CONSTANT_RATIO, WaveField, WaveParameters


def heights_along_x(field: WaveField, x: np.ndarray, seconds: float, *, sine: bool = False) -> np.ndarray:
    return field.heights(np.stack([x, np.zeros_like(x)], axis=1), seconds, sine=sine)


def single_wave(**parameters: float) -> WaveField:
    """Return one wave with the amplitude 0.5 m along x that has grown."""
    return WaveField(
        WaveParameters(**{"model": CONSTANT_RATIO, "number": 1, "amplitude": 0.5, "tau": 0.0, **parameters})
    )


@pytest.mark.parametrize(("period", "gain"), [(5.0, 1.0), (3.0, 0.3), (8.0, 2.0)])
def test_three_waves_sample_spectrum(period, gain):
    field = WaveField(WaveParameters(period=period, gain=gain, scale=1.1))
    peak = 2 * pi / period
    frequencies = np.array((peak / 1.1, peak, peak * 1.1))
    bands = np.array((peak - peak / 1.1, (peak * 1.1 - peak / 1.1) / 2, peak * 1.1 - peak))
    densities = 0.0081 * 9.81**2 / frequencies**5 * np.exp(-1.25 * (peak / frequencies) ** 4)
    assert field.frequencies == pytest.approx(frequencies)
    assert field.amplitudes == pytest.approx(gain * np.sqrt(2 * densities * bands))
    assert field.wavenumbers == pytest.approx(frequencies**2 / 9.8)


def test_many_waves_have_energy_of_spectrum():
    """The integral of the spectrum above w is alpha g2 / (5 p4) (1 - exp(-5/4 (p/w)^4)), with the peak p."""
    field = WaveField(WaveParameters(number=200, scale=1.02, period=6.0))
    peak = 2 * pi / 6.0
    energy = 0.0081 * 9.81**2 / (5 * peak**4) * (1 - exp(-1.25 * 1.02**4))
    assert (field.amplitudes**2).sum() / 2 == pytest.approx(energy, rel=0.02)


def test_waves_of_constant_ratio_are_similar():
    field = WaveField(WaveParameters(model=CONSTANT_RATIO, number=3, amplitude=0.4, period=4.0, scale=1.5, angle=0.3))
    assert field.amplitudes == pytest.approx([0.4 / 1.5, 0.4, 0.4 * 1.5])
    assert field.amplitudes * field.wavenumbers == pytest.approx([0.4 * (2 * pi / 4.0) ** 2 / 9.8] * 3)
    assert np.degrees(np.arctan2(*field.directions.T[::-1])) == pytest.approx(np.degrees([-0.3, 0.0, 0.3]))


def test_crest_travels_at_phase_speed_of_deep_water():
    field = single_wave(period=5.0, direction=pi / 2)
    y = np.linspace(10.0, 49.0, 40_000)
    for seconds in (0.5, 2.0):
        heights = field.heights(np.stack([np.zeros_like(y), y], axis=1), seconds)
        distance = y[heights.argmax()] - 9.8 * 5.0 / (2 * pi) * seconds
        wavelength = 9.8 * 25.0 / (2 * pi)
        assert (distance + 1.0) % wavelength - 1.0 == pytest.approx(0.0, abs=0.01)
        assert heights.max() == pytest.approx(0.5, abs=1e-4)


def test_waves_grow_with_time_constant():
    grown, growing = single_wave(), single_wave(tau=3.0)
    x = np.linspace(0.0, 30.0, 7)
    assert heights_along_x(growing, x, 0.0) == pytest.approx(np.zeros(7))
    assert heights_along_x(growing, x, 3.0) == pytest.approx((1 - exp(-1)) * heights_along_x(grown, x, 3.0))


@pytest.mark.parametrize("steepness", [0.3, 0.9])
def test_height_is_that_of_particle_that_moved_there(steepness):
    field = WaveField(WaveParameters(gain=1.0, period=4.0, direction=0.7, steepness=steepness, tau=0.0))
    rest_points = np.random.default_rng(1).uniform(-30.0, 30.0, (50, 2))
    phases = (rest_points @ field.directions.T) * field.wavenumbers - field.frequencies * 7.0
    moved = rest_points - (np.sin(phases) * field.steepnesses * field.amplitudes) @ field.directions
    assert field.heights(moved, 7.0) == pytest.approx(np.cos(phases) @ field.amplitudes, abs=1e-6)
    assert np.abs(moved - rest_points).max() > 0.1


def test_steep_waves_have_narrow_crests_and_sine_waves_do_not():
    field = single_wave(steepness=1.0, period=2.0)
    x = np.linspace(0.0, 9.8 * 4.0 / (2 * pi), 2000, endpoint=False)
    assert (heights_along_x(field, x, 0.0) > 0.0).mean() < 0.4
    assert (heights_along_x(field, x, 0.0, sine=True) > 0.0).mean() == pytest.approx(0.5, abs=0.01)


@pytest.mark.parametrize(
    ("changes", "text"),
    [({"model": "JONSWAP"}, "'JONSWAP', not PMS or CWR"), ({"number": 0}, "<number>"), ({"period": 0.0}, "<period>")],
)
def test_invalid_parameters_are_described(changes, text):
    assert text in str(WaveParameters(**changes).find_mistake())
    assert WaveParameters().find_mistake() is None
