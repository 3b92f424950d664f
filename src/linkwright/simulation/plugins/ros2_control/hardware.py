"""ros2_control hardware made of simulated joints and sensors.

The hardware replaces ``gazebo_ros2_control/GazeboSystem``, ``gz_ros2_control/GazeboSimSystem``,
``ign_ros2_control/IgnitionSystem``, ``gz_quadruped_hardware/GazeboSimSystem``, and any other plugin that a description
in a simulated world names.

Source: gazebo_ros2_control and gz_ros2_control (interfaces, holding of joints, texts).
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from math import nan
from types import MappingProxyType
from typing import Any, Protocol

import numpy as np

from linkwright.control.hardware.component import Hardware
from linkwright.control.hardware.description import ComponentDescription, HardwareDescription
from linkwright.control.hardware.interfaces import EFFORT, POSITION, VELOCITY
from linkwright.control.motion.pid import Pid, PidGains
from linkwright.diagnostics import LinkwrightError, phrase
from linkwright.graph.log.logger import Logger
from linkwright.simulation.plugins.plugin import PluginContext
from linkwright.simulation.plugins.ros2_control.impedance import GAIN_KINDS, ImpedanceJoint
from linkwright.simulation.plugins.ros2_control.joints import SimulatedJoint
from linkwright.simulation.plugins.ros2_control.pids import extract_pid_gains
from linkwright.simulation.plugins.ros2_control.sensors import (
    SimulatedSensor,
    create_magnitude_sensor,
    create_sensor,
    find_sensors,
)
from linkwright.simulation.scene.structure import PlacedJoint
from linkwright.simulation.simulation import Simulation

_COMMAND_KINDS = (POSITION, VELOCITY, EFFORT)


class ControlledModel(Protocol):
    """The attributes and methods of `SimulatedControl` that the hardware uses."""

    simulation: Simulation
    context: PluginContext

    def joint(self, name: str) -> str:
        """Return the full name of a movable joint of the plugin's model, as used in the simulation."""

    def create_generator(self, name: str) -> np.random.Generator:
        """Return the random number generator of a sensor, determined by the seed."""


class SimulatedSystem(Hardware):
    """Joints and sensors of a model as ros2_control hardware.

    Args:
        description: the description of the hardware in the URDF.
        logger: receives warnings about joints and sensors that the model does not have.
        plugin: the plugin that runs the hardware.
        holds_position: whether joints hold their positions while they have no command.
        gain: the fraction of a position error that each update corrects; with NaN, an update corrects the whole error.
        values: parameters of the plugin's node, which may include gains of PID controllers.

    Attributes:
        has_pids: whether `push` has to be called after each step of the world.
    """

    def __init__(
        self,
        description: HardwareDescription,
        logger: Logger,
        plugin: ControlledModel,
        *,
        holds_position: bool,
        gain: float = nan,
        values: Mapping[str, Any] = MappingProxyType({}),
    ) -> None:
        description, gains = self._split_gains(description, values, logger)
        super().__init__(description, logger)
        self.has_pids = bool(gains)
        self._joints: dict[str, SimulatedJoint | ImpedanceJoint] = {}
        for joint_description in description.joints:
            try:
                name = plugin.joint(joint_description.name)
            except LinkwrightError as error:
                logger.warning(
                    f"Skipping joint in the URDF named '{joint_description.name}' which is not in the gazebo model."
                )
                logger.debug(error.diagnostics[0].message)
                self._remove_interfaces(joint_description.name)
                continue
            states = {state.kind: state for state in self.states if state.component == joint_description.name}
            commands = {
                command.kind: command
                for command in self.commands
                if command.component == joint_description.name and joint_description.mimic is None
            }
            if commands.keys() >= {*GAIN_KINDS}:
                self._joints[joint_description.name] = ImpedanceJoint(
                    plugin.simulation, name, joint_description, states, commands
                )
                continue
            self._joints[joint_description.name] = SimulatedJoint(
                plugin.simulation,
                name,
                joint_description,
                states,
                {kind: command for kind, command in commands.items() if kind in _COMMAND_KINDS},
                holds_position=holds_position
                and self._may_hold(joint_description, plugin.simulation.scene.joints[name]),
                gain=gain,
                pids={
                    kind: Pid(each_gains)
                    for (joint, kind), each_gains in gains.items()
                    if joint == joint_description.name
                },
            )
        for joint in self._joints.values():
            joint.begin()
        self._sensors = self._create_sensors(plugin)

    def _split_gains(
        self, description: HardwareDescription, values: Mapping[str, Any], logger: Logger
    ) -> tuple[HardwareDescription, Mapping[tuple[str, str], PidGains]]:
        """Return the description without PID interfaces, and the gains, as `extract_pid_gains` does."""
        return extract_pid_gains(description, values, logger)

    def _may_hold(self, joint: ComponentDescription, placed_joint: PlacedJoint) -> bool:
        """Return whether a joint of the model can hold its position while it has no command."""
        return True

    def _remove_interfaces(self, component: str) -> None:
        """Remove the state and command interfaces of a component that the model does not have."""
        self.states = [state for state in self.states if state.component != component]
        self.commands = [command for command in self.commands if command.component != component]

    def _create_sensors(self, plugin: ControlledModel) -> list[SimulatedSensor]:
        simulated_sensors = []
        placed_sensors = find_sensors(plugin.context)
        for sensor in self.description.sensors:
            placed_sensor = placed_sensors.get(sensor.name)
            states = [state for state in self.states if state.component == sensor.name]
            if placed_sensor is None and all(state.kind in placed_sensors for state in states):
                simulated_sensors += [
                    create_magnitude_sensor(
                        plugin.simulation,
                        placed_sensors[state.kind],
                        state,
                        plugin.create_generator(placed_sensors[state.kind].name),
                    )
                    for state in states
                ]
                continue
            if placed_sensor is None:
                message = phrase(
                    "sensor '{name}' of <ros2_control> has no IMU or force-torque sensor of this name in the "
                    "model, so its states do not change",
                    name=sensor.name,
                )
                self.logger.warning(message)
                continue
            simulated_sensors.append(
                create_sensor(plugin.simulation, placed_sensor, states, plugin.create_generator(placed_sensor.name))
            )
        return simulated_sensors

    def begin(self) -> None:
        """Restore the initial state of the joints when the world restarts, and keep their modes."""
        for joint in self._joints.values():
            mode = joint.mode
            joint.begin()
            joint.set_mode(mode)

    def on_activate(self) -> None:
        """Read the joints, so that controllers get valid positions before the first update."""
        for joint in self._joints.values():
            joint.read()

    def perform_switch(self, start: Collection[str], stop: Collection[str]) -> None:
        """Select the interface that commands each joint, after controllers have started or stopped."""
        for name, joint in self._joints.items():
            if f"{name}/{joint.mode}" in stop:
                joint.set_mode("")
            for kind in (EFFORT, POSITION, VELOCITY):  # velocity takes precedence over position, as in gz_ros2_control
                if f"{name}/{kind}" in start:
                    joint.set_mode(kind)

    def read(self, time_ns: int, period_s: float) -> None:
        """Update the state interfaces of the joints and sensors."""
        for joint in self._joints.values():
            joint.read()
        for sensor in self._sensors:
            sensor.read()

    def write(self, time_ns: int, period_s: float) -> None:
        """Apply the commands to the joints."""
        for joint in self._joints.values():
            joint.write(period_s)

    def push(self, period_s: float) -> None:
        """Apply the forces of the PID controllers.

        Call this after each step of the world.
        """
        for joint in self._joints.values():
            joint.push(period_s)
