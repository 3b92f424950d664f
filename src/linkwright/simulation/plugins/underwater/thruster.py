"""Thrusters of vehicles under water: ``libuuv_thruster_ros_plugin.so``.

A command passes through the dynamics of the propeller, whose state is its speed, and a conversion gives the thrust.

Source: uuv_simulator (parameters, defaults, topics, formulas); D. R. Yoerger, J. G. Cooke, J. E. Slotine, "The
influence of thruster dynamics on underwater vehicle behavior", 1990; W. M. Bessa and others, "Thruster dynamics
compensation for the positioning of underwater robotic vehicles", 2006. Services are left out.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.messages import Header, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.plugins.underwater.dynamics import create_step, require_child, unknown_type_error
from linkwright.xmltree import Element

_FLOAT_TYPE = "uuv_gazebo_ros_plugins_msgs/msg/FloatStamped"
_SPIN_GAIN = 1e-3
_RATE_HZ = 20.0


@dataclass(frozen=True, kw_only=True)
class UuvThrusterParameters:
    """Parameters of ``libuuv_thruster_ros_plugin.so``."""

    link_name: str = parameter(aliases=("linkName",))
    thruster_id: int = parameter(aliases=("thrusterID",))
    joint_name: str = parameter("", aliases=("jointName",))
    clamp_min: float = parameter(-inf, aliases=("clampMin",))
    clamp_max: float = parameter(inf, aliases=("clampMax",))
    thrust_min: float = parameter(-inf, aliases=("thrustMin",))
    thrust_max: float = parameter(inf, aliases=("thrustMax",))
    gain: float = 1.0
    thrust_efficiency: float = 1.0
    propeller_efficiency: float = 1.0


class UuvThruster(SimulatedPlugin[UuvThrusterParameters]):
    """The substitute for ``libuuv_thruster_ros_plugin.so``.

    ``uuv_gazebo_ros_plugins_msgs/msg/FloatStamped`` on ``/MODEL/thrusters/ID/input`` is the command, and the thrust is
    published on ``/MODEL/thrusters/ID/thrust``. The thrust acts along the axis of the joint, or along x.
    """

    PARAMETERS = UuvThrusterParameters
    IGNORED = ("dynamics", "conversion")
    CARRIED = ("_command", "_state")

    def start(self) -> None:
        """Find the link and the joint, and read the dynamics and the conversion.

        Raises:
            LinkwrightError: SIM133, SIM134, there is no such link or joint; SIM160, a coefficient is not valid.
        """
        parameters, simulation = self.parameters, self.simulation
        self._link = self.link(parameters.link_name)
        self._joint = self.joint(parameters.joint_name) if parameters.joint_name else ""
        self._step, self._convert = create_step(self, require_child(self, "dynamics")), self._read_conversion()
        self._motor = simulation.add_velocity_motor(self._joint, _SPIN_GAIN, inf) if self._joint else None
        simulation.keep_awake(self._link)
        self.reset()
        base = f"/{self.context.path}/thrusters/{parameters.thruster_id}"
        guard = self.node.command_guard(self._stop_motion)
        self.node.subscribe(
            _FLOAT_TYPE, f"{base}/input", self._on_command, command_guard=guard, stop_motion=self._stop_motion
        )
        self._output = self.node.publisher(_FLOAT_TYPE, f"{base}/thrust")
        self.every(0.0, self._apply_thrust)
        self.every(_RATE_HZ, self._publish)
        self._apply_thrust()

    def reset(self) -> None:
        """Stop the propeller."""
        self._command = self._state = self._thrust = 0.0

    def _on_command(self, message: Any) -> None:
        self._command = float(message.data)

    def _stop_motion(self) -> bool:
        """Command a speed of zero, and return whether it was nonzero."""
        old_command, self._command = self._command, 0.0
        return old_command != 0.0

    def _read_conversion(self) -> Callable[[float], float]:
        """Return the conversion from the state of the propeller to the thrust in N."""
        element = require_child(self, "conversion")
        kind = self.text_in(element, "type")
        if kind == "Basic":
            constant = self.number_in(element, "rotorConstant")
            return lambda speed: constant * speed * abs(speed)
        if kind == "Bessa":
            left, right, lower, upper = (
                self.number_in(element, tag) for tag in ("rotorConstantL", "rotorConstantR", "deltaL", "deltaR")
            )

            def convert(speed: float) -> float:
                square = speed * abs(speed)
                return left * min(square - lower, 0.0) + right * max(square - upper, 0.0)

            return convert
        if kind == "LinearInterp":
            inputs, outputs = (self._read_numbers(element, tag) for tag in ("inputValues", "outputValues"))
            if len(inputs) == len(outputs) > 0:
                order = np.argsort(inputs)
                return lambda speed: float(np.interp(speed, np.array(inputs)[order], np.array(outputs)[order]))
            message = phrase(
                "plugin '{plugin}': <inputValues> and <outputValues> must be equally many numbers",
                plugin=self.context.name,
            )
            raise self.parameter_error(message, element)
        raise unknown_type_error(self, element, "Basic, Bessa, LinearInterp")

    def _read_numbers(self, parent: Element, tag: str) -> list[float]:
        try:
            return [float(word) for word in self.text_in(parent, tag).split()]
        except ValueError:
            return []

    def _apply_thrust(self) -> None:
        parameters, simulation = self.parameters, self.simulation
        simulation.refresh()
        command = parameters.gain * min(max(self._command, parameters.clamp_min), parameters.clamp_max)
        self._state = self._step(self._state, command, simulation.step / NANOSECONDS_PER_SECOND)
        speed = parameters.propeller_efficiency * self._state
        thrust = parameters.thrust_efficiency * self._convert(speed)
        self._thrust = min(max(thrust, parameters.thrust_min), parameters.thrust_max)
        if self._motor is not None:
            axis = np.array(simulation.data.joint(self._joint).xaxis)
            self._motor.target = speed
        else:
            axis = simulation.data.xmat[simulation.body(self._link)].reshape(3, 3)[:, 0]
        self.push(self._link, self._thrust * axis)

    def _publish(self) -> None:
        header = Header(stamp=self.stamp(), frame_id=self.parameters.link_name)
        self._output.publish(get_message(_FLOAT_TYPE)(header=header, data=self._thrust))
