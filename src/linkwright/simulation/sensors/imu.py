"""Inertial measurement units."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from linkwright.geometry.single import (
    Quaternion,
    Vector3,
    quaternion_from_rpy,
    quaternion_inverse,
    quaternion_multiply,
    rotate,
)
from linkwright.sdf.sensors import Imu
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.sensors.noise import VectorNoise

_NED_RPY = (np.pi, 0.0, np.pi / 2)
_NWU_RPY = (0.0, 0.0, np.pi / 2)
"""The roll, pitch and yaw in rad of these axes in the world, whose x axis points east and y axis north."""


@dataclass(frozen=True, slots=True)
class ImuMeasurement:
    """A measurement of an IMU, in its own axes.

    Attributes:
        orientation: the orientation of the IMU in its reference frame, a quaternion x, y, z, w.
        angular_velocity: the angular velocity in rad/s.
        linear_acceleration: the proper acceleration in m/s2, which at rest is the reaction to gravity.
    """

    orientation: Quaternion
    angular_velocity: Vector3
    linear_acceleration: Vector3


class ImuSensor:
    """An inertial measurement unit.

    The measured acceleration is the acceleration in the last step, including the reaction to gravity, as REP 145
    defines for raw data.

    Args:
        mount: the mount of the sensor.
        imu: the parsed sensor; None for no noise.
        initial_reference: whether the orientation is relative to the initial orientation instead of the world.
        generator: the source of the noise.
    """

    def __init__(
        self, mount: Mount, imu: Imu | None, *, generator: np.random.Generator, initial_reference: bool = False
    ) -> None:
        settings = imu or Imu()
        self.angular_velocity_noise = VectorNoise(settings.angular_velocity, generator)
        self.acceleration_noise = VectorNoise(settings.linear_acceleration, generator)
        self._mount = mount
        self._last_time = mount.simulation.time
        self._reference = self._find_reference_orientation(settings, initial_reference=initial_reference)

    def _find_reference_orientation(self, imu: Imu, *, initial_reference: bool) -> Quaternion:
        """Return the orientation in the world of the reference frame, as a quaternion."""
        if initial_reference:
            return self._mount.pose()[3:]
        reference_rpy = {"NED": _NED_RPY, "NWU": _NWU_RPY, "CUSTOM": imu.custom_rpy}
        return quaternion_from_rpy(reference_rpy.get(imu.localization, (0.0, 0.0, 0.0)))

    def measure(self) -> ImuMeasurement:
        """Return the current orientation, angular velocity and acceleration, with noise.

        Raises:
            KeyError: the link no longer exists.
        """
        simulation = self._mount.simulation
        period, self._last_time = (simulation.time - self._last_time) * 1e-9, simulation.time
        orientation = self._mount.pose()[3:]
        to_sensor = quaternion_inverse(orientation)
        angular, acceleration = self._mount.measure_inertial_motion()
        return ImuMeasurement(
            quaternion_multiply(quaternion_inverse(self._reference), orientation),
            self.angular_velocity_noise.apply_to_tuple(rotate(to_sensor, angular), period),
            self.acceleration_noise.apply_to_tuple(rotate(to_sensor, acceleration), period),
        )
