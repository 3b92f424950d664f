"""Simulated sensors that the hardware reads: IMUs, and force-torque sensors in joints.

Source: gazebo_ros2_control and gz_ros2_control (which sensors, names of interfaces).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np

from linkwright.control.hardware.interfaces import StateInterface
from linkwright.simulation.plugins.places import model_plugins
from linkwright.simulation.plugins.plugin import PlacedSensor, PluginPlace
from linkwright.simulation.sensors.force_torque import ForceTorqueSensor
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation

_TYPES = ("imu", "force_torque")


class SimulatedSensor:
    """A simulated sensor of the hardware.

    Args:
        measure: returns the measured values, by interface name.
        states: the state interfaces of the sensor.
    """

    def __init__(self, measure: Callable[[], dict[str, float]], states: Sequence[StateInterface]) -> None:
        self._measure = measure
        self._states = states

    def read(self) -> None:
        """Measure, and update the state interfaces; interfaces without a measured value keep theirs."""
        measured = self._measure()
        for state in self._states:
            state.value = measured.get(state.kind, state.value)


def sensors_of(place: PluginPlace) -> dict[str, PlacedSensor]:
    """Return the IMUs and force-torque sensors of a model, by name."""
    assert place.model is not None
    places: Iterator[PluginPlace] = model_plugins(place.world, place.model, place.path)
    return {
        place.sensor.sensor.name: place.sensor
        for place in places
        if place.sensor is not None and place.sensor.sensor.type in _TYPES
    }


def simulated_sensor(
    simulation: Simulation, placed: PlacedSensor, states: Sequence[StateInterface], generator: np.random.Generator
) -> SimulatedSensor:
    """Return the IMU or force-torque sensor that measures values for state interfaces."""
    if placed.sensor.type == "imu":
        return SimulatedSensor(_imu(simulation, placed, generator), states)
    return SimulatedSensor(_forces(simulation, placed, generator), states)


def _imu(
    simulation: Simulation, placed: PlacedSensor, generator: np.random.Generator
) -> Callable[[], dict[str, float]]:
    mount = Mount(simulation, placed.link, placed.pose)
    sensor = ImuSensor(mount, placed.sensor.imu, generator=generator)

    def measure() -> dict[str, float]:
        measured = sensor.measure()
        return {
            **_named("orientation", "xyzw", measured.orientation),
            **_named("angular_velocity", "xyz", measured.angular_velocity),
            **_named("linear_acceleration", "xyz", measured.linear_acceleration),
        }

    return measure


def _forces(
    simulation: Simulation, placed: PlacedSensor, generator: np.random.Generator
) -> Callable[[], dict[str, float]]:
    simulation.keep_awake(placed.link)
    sensor = ForceTorqueSensor(simulation, placed.joint, placed.sensor.force_torque, generator)

    def measure() -> dict[str, float]:
        force, torque = sensor.measure()
        return {**_named("force", "xyz", force.tolist()), **_named("torque", "xyz", torque.tolist())}

    return measure


def _named(name: str, axes: str, values: Sequence[float]) -> dict[str, float]:
    return {f"{name}.{axis}": float(value) for axis, value in zip(axes, values, strict=True)}
