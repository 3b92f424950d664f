"""Pitot tubes: the dynamic pressure of the air that flows against a sensor.

Source: gz-sensors and PX4-SITL_gazebo-classic (formula of the pressure, density of the standard atmosphere).
"""

from __future__ import annotations

import numpy as np

from linkwright.geometry.arrays import quaternion_inverse, rotate
from linkwright.sdf.sensors import AirSpeed
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.sensors.noise import NoiseSource

_TEMPERATURE_KELVIN, _LAPSE_RATE_KELVIN_PER_M, _DENSITY_KG_PER_M3 = 288.15, 0.0065, 1.225
"""The air at sea level."""
_DENSITY_EXPONENT = 4.256
_PASCAL_PER_HECTOPASCAL = 100.0


class AirSpeedSensor:
    """A pitot tube that measures the dynamic pressure of the air along the x axis of its mount.

    gz multiplies the noise by 100, and there is no wind at its sensor; both are mistakes of Gazebo.

    Args:
        mount: the mount of the sensor.
        settings: noise in Pa; None for no noise.
        generator: the source of the noise.
        with_mistakes: whether to reproduce the mistakes of gz.

    Attributes:
        noise: the noise of the pressure.
    """

    def __init__(
        self, mount: Mount, settings: AirSpeed | None, generator: np.random.Generator, *, with_mistakes: bool = False
    ) -> None:
        self.noise = NoiseSource((settings or AirSpeed()).noise, generator)
        self._mount = mount
        self._with_mistakes = with_mistakes

    def measure(self) -> float:
        """Return the dynamic pressure in Pa, with noise.

        Raises:
            KeyError: the link no longer exists.
        """
        unit = _PASCAL_PER_HECTOPASCAL if self._with_mistakes else 1.0
        pressure = measure_dynamic_pressure(self._mount, has_wind=not self._with_mistakes) / unit
        return float(self.noise.apply(np.array(pressure))) * unit


def measure_dynamic_pressure(mount: Mount, *, elevation: float = 0.0, has_wind: bool = True) -> float:
    """Return the dynamic pressure in Pa of the air along the x axis of a mount; negative if it comes from behind.

    Args:
        mount: the mount of the sensor.
        elevation: the altitude of the world's origin, in m.
        has_wind: whether the wind of the world blows at the sensor.

    Raises:
        KeyError: the link no longer exists.
    """
    pose, (linear, _) = mount.pose(), mount.velocity()
    velocity = np.array(linear) - (np.array(mount.simulation.wind) if has_wind else 0.0)
    speed = float(rotate(quaternion_inverse(np.array(pose[3:])), velocity)[0])
    return 0.5 * _compute_density(elevation + pose[2]) * speed * abs(speed)


def _compute_density(altitude: float) -> float:
    """Return the density of the air in kg/m3 at an altitude in m."""
    ratio = (_TEMPERATURE_KELVIN - _LAPSE_RATE_KELVIN_PER_M * altitude) / _TEMPERATURE_KELVIN
    return float(_DENSITY_KG_PER_M3 * ratio**_DENSITY_EXPONENT)
