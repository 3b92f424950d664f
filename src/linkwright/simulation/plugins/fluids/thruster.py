"""Propellers in water: ``gz-sim-thruster-system``.

The thrust acts along the axis of the propeller's joint, at the origin of its link. It grows with the square of the
propeller's speed: ``T = K rho D^4 |w| w``, with w in rad/s. The propeller turns at the speed of its thrust.

Source: gz-sim (parameters, topics, defaults, formulas); T. I. Fossen, *Guidance and Control of Ocean Vehicles*, 1994,
section 4.1 (the thrust coefficient that depends on the speed of the inflowing water).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import copysign, inf, sqrt
from typing import Any

import numpy as np

from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.battery import GzBattery
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.pid import Gains, Pid
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_FLOAT_TYPE = "std_msgs/msg/Float64"
_MOTOR_GAIN = 20.0
"""The gain of the motor that holds the propeller's speed, in N m of torque per rad/s of speed error."""

_MIN_SPEED_ERROR = 0.1
"""The error of the propeller's speed, in rad/s, up to which its torque is zero."""


@dataclass(frozen=True, kw_only=True)
class ThrusterParameters:
    """Parameters of ``gz-sim-thruster-system``."""

    joint_name: str = parameter()
    namespace: str = ""
    topic: str = ""
    use_angvel_cmd: bool = False
    velocity_control: bool = False
    fluid_density: float = 1000.0
    propeller_diameter: float = 0.02
    thrust_coefficient: float | None = None
    wake_fraction: float = 0.2
    alpha_1: float = 1.0
    alpha_2: float = 0.0
    max_thrust_cmd: float = 1000.0
    min_thrust_cmd: float = -1000.0
    deadband: float = 0.0
    p_gain: float = 0.1
    i_gain: float = 0.0
    d_gain: float = 0.0
    battery_name: str = ""
    power_load: float = 0.0


class GzThruster(SimulatedPlugin[ThrusterParameters]):
    """The substitute for ``gz-sim-thruster-system``.

    Commands are ``std_msgs/msg/Float64``: thrusts in N, or with ``<use_angvel_cmd>`` speeds in rad/s. The speed of the
    propeller is published, or with ``<use_angvel_cmd>`` the thrust. The propeller stops while a battery of its model is
    empty, and draws ``<power_load>`` from the battery that ``<battery_name>`` names.
    """

    PARAMETERS = ThrusterParameters
    CARRIED = ("_command", "_has_deadband")

    def start(self) -> None:
        """Find the joint, and create the topics."""
        parameters, simulation, node = self.parameters, self.simulation, self.node
        self._joint = self.joint(parameters.joint_name)
        self._link = simulation.scene.joints[self._joint].child
        simulation.keep_awake(self._link)
        self._motor = None
        if parameters.velocity_control:
            self._motor = simulation.add_velocity_motor(self._joint, _MOTOR_GAIN, inf)
        self.reset()
        namespace = parameters.namespace or self.context.path
        base = f"/model/{namespace}/joint/{parameters.joint_name}"
        topic = f"{base}/cmd_vel" if parameters.use_angvel_cmd else f"{base}/cmd_thrust"
        if parameters.topic:
            topic = f"/{namespace}/{parameters.topic}"
        command_guard = node.command_guard(self._stop_motion)
        node.subscribe(_FLOAT_TYPE, topic, self._on_command, command_guard=command_guard, stop_motion=self._stop_motion)
        node.subscribe("std_msgs/msg/Bool", f"{base}/enable_deadband", self._on_deadband)
        feedback = "force" if parameters.use_angvel_cmd else "ang_vel"
        self._feedback = node.publisher(
            _FLOAT_TYPE, f"{topic}/{feedback}" if parameters.topic else f"{base}/{feedback}"
        )
        self.every(0.0, self._apply_thrust)
        self._apply_thrust()

    def reset(self) -> None:
        """Stop the propeller."""
        parameters = self.parameters
        self._command = 0.0
        self._has_deadband = parameters.deadband > 0.0
        self._pid = Pid(
            Gains(
                p=parameters.p_gain,
                i=parameters.i_gain,
                d=parameters.d_gain,
                i_min=-1.0,
                i_max=1.0,
                cmd_min=self._compute_speed(parameters.min_thrust_cmd, self._compute_thrust_factor(0.0)),
                cmd_max=self._compute_speed(parameters.max_thrust_cmd, self._compute_thrust_factor(0.0)),
                cmd_offset=0.0,
            )
        )

    def _on_command(self, message: Any) -> None:
        self._command = float(message.data)

    def _on_deadband(self, message: Any) -> None:
        self._has_deadband = bool(message.data)

    def _stop_motion(self) -> bool:
        """Command a thrust of zero, and return whether it was nonzero."""
        old_command, self._command = self._command, 0.0
        return old_command != 0.0

    def _compute_thrust_and_speed(self, water_speed: float) -> tuple[float, float]:
        """Return the thrust in N and the speed in rad/s for the current command.

        `water_speed` is the propeller's speed along its axis, in m/s.
        """
        parameters = self.parameters
        factor, thrust = self._compute_thrust_factor(water_speed), self._command
        if parameters.use_angvel_cmd:
            thrust = factor * abs(self._command) * self._command
        thrust = min(max(thrust, parameters.min_thrust_cmd), parameters.max_thrust_cmd)
        if self._has_deadband and abs(thrust) < parameters.deadband:
            return 0.0, 0.0
        return thrust, self._compute_speed(thrust, factor)

    def _compute_thrust_factor(self, water_speed: float) -> float:
        """Return the thrust per squared speed of the propeller, in N s2.

        Without a coefficient in the parameters, it depends on the advance ratio of the propeller.
        """
        parameters = self.parameters
        coefficient = parameters.thrust_coefficient
        if coefficient is None:
            _, turning_speed = self.simulation.joint_state(self._joint)
            inflow = (1.0 - parameters.wake_fraction) * water_speed
            advance = inflow / (turning_speed * parameters.propeller_diameter) if turning_speed else 0.0
            coefficient = parameters.alpha_1 + parameters.alpha_2 * advance
        return coefficient * parameters.fluid_density * parameters.propeller_diameter**4

    @staticmethod
    def _compute_speed(thrust: float, factor: float) -> float:
        """Return the speed in rad/s of a propeller with a thrust in N."""
        return copysign(sqrt(abs(thrust / factor)), thrust) if factor else 0.0

    def _find_batteries(self) -> list[GzBattery]:
        """Return the batteries of the model."""
        path = self.context.path
        return [item for item in self.model_plugins if isinstance(item, GzBattery) and item.context.path == path]

    def _apply_thrust(self) -> None:
        simulation = self.simulation
        pose = simulation.link_pose(self._link)
        axis = np.array(simulation.data.joint(self._joint).xaxis)
        velocity, _ = simulation.link_velocity(self._link)
        thrust, speed = self._compute_thrust_and_speed(float(velocity @ axis))
        torque, batteries = 0.0, self._find_batteries()
        for battery in batteries:
            if battery.parameters.battery_name == self.parameters.battery_name:
                battery.loads[self._joint] = self.parameters.power_load
        if any(battery.is_empty for battery in batteries):
            thrust = 0.0
            if self._motor is not None:
                self._motor.release()
        elif self._motor is not None:
            self._motor.target = speed
        else:
            error = speed - simulation.joint_state(self._joint)[1]
            if abs(error) > _MIN_SPEED_ERROR:
                torque = self._pid.force(error, simulation.step / NANOSECONDS_PER_SECOND)
        self.push(self._link, thrust * axis, torque * axis, at=pose[:3])
        if self._feedback.is_wanted:
            value = thrust if self.parameters.use_angvel_cmd else simulation.joint_state(self._joint)[1]
            self._feedback.publish(get_message(_FLOAT_TYPE)(data=value))
