"""Simulated sensors that the hardware reads: IMUs, and force-torque sensors in joints.

Source: gazebo_ros2_control and gz_ros2_control (the supported sensors, the names of interfaces).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from math import hypot

import numpy as np

from linkwright.control.hardware.interfaces import StateInterface
from linkwright.simulation.plugins.contexts import model_plugins
from linkwright.simulation.plugins.plugin import PlacedSensor, PluginContext
from linkwright.simulation.sensors.force_torque import ForceTorqueSensor
from linkwright.simulation.sensors.imu import ImuSensor
from linkwright.simulation.sensors.mount import Mount
from linkwright.simulation.simulation import Simulation

_SENSOR_TYPES = ("imu", "force_torque")


class SimulatedSensor:
    """A sensor in the simulation that a sensor of ``<ros2_control>`` reads.

    Args:
        measure: returns the measured values, by interface name, such as ``force.x``.
        states: the state interfaces that receive the values.
    """

    def __init__(self, measure: Callable[[], dict[str, float]], states: Sequence[StateInterface]) -> None:
        self._measure = measure
        self._states = states

    def read(self) -> None:
        """Measure, and update the state interfaces.

        An interface without a measured value keeps its value.
        """
        values = self._measure()
        for state in self._states:
            state.value = values.get(state.kind, state.value)


def find_sensors(context: PluginContext) -> dict[str, PlacedSensor]:
    """Return the IMUs and force-torque sensors of the plugin's model, by sensor name."""
    assert context.model is not None
    contexts: Iterator[PluginContext] = model_plugins(context.world, context.model, context.path)
    return {
        context.sensor.sensor.name: context.sensor
        for context in contexts
        if context.sensor is not None and context.sensor.sensor.type in _SENSOR_TYPES
    }


def create_sensor(
    simulation: Simulation, placed: PlacedSensor, states: Sequence[StateInterface], generator: np.random.Generator
) -> SimulatedSensor:
    """Create an IMU or force-torque sensor that updates the given state interfaces."""
    if placed.sensor.type == "imu":
        return SimulatedSensor(_create_imu_reader(simulation, placed, generator), states)
    return SimulatedSensor(_create_wrench_reader(simulation, placed, generator), states)


def create_magnitude_sensor(
    simulation: Simulation, placed: PlacedSensor, state: StateInterface, generator: np.random.Generator
) -> SimulatedSensor:
    """Create a sensor whose state is the magnitude of the force that a force-torque sensor measures.

    The state has the name of that sensor, as the forces of feet in gz_quadruped_hardware.
    """
    measure_wrench = _create_wrench_reader(simulation, placed, generator)

    def measure() -> dict[str, float]:
        wrench = measure_wrench()
        return {state.kind: hypot(*(wrench[f"force.{axis}"] for axis in "xyz"))}

    return SimulatedSensor(measure, [state])


def _create_imu_reader(
    simulation: Simulation, placed: PlacedSensor, generator: np.random.Generator
) -> Callable[[], dict[str, float]]:
    mount = Mount(simulation, placed.link, placed.pose)
    sensor = ImuSensor(mount, placed.sensor.imu, generator=generator)

    def measure() -> dict[str, float]:
        measurement = sensor.measure()
        return {
            **_name_by_interface("orientation", "xyzw", measurement.orientation),
            **_name_by_interface("angular_velocity", "xyz", measurement.angular_velocity),
            **_name_by_interface("linear_acceleration", "xyz", measurement.linear_acceleration),
        }

    return measure


def _create_wrench_reader(
    simulation: Simulation, placed: PlacedSensor, generator: np.random.Generator
) -> Callable[[], dict[str, float]]:
    simulation.keep_awake(placed.link)
    sensor = ForceTorqueSensor(simulation, placed.joint, placed.sensor.force_torque, generator)

    def measure() -> dict[str, float]:
        force, torque = sensor.measure()
        return {
            **_name_by_interface("force", "xyz", force.tolist()),
            **_name_by_interface("torque", "xyz", torque.tolist()),
        }

    return measure


def _name_by_interface(name: str, axes: str, values: Sequence[float]) -> dict[str, float]:
    return {f"{name}.{axis}": float(value) for axis, value in zip(axes, values, strict=True)}
