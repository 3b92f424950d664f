"""The channels of an autopilot: each moves a joint, or publishes its command.

A channel has a command from 0 to 1, which an offset and a multiplier turn into a velocity, a position or an effort. A
PID controller applies the effort that reaches the velocity or the position; without force, a motor holds the velocity.

Source: ardupilot_gazebo (parameters, defaults, formulas).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Any, Protocol

from linkwright.diagnostics import LinkwrightError, Phrase, phrase, quoted_names
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.actuators import Motor
from linkwright.simulation.plugins.autopilots.packets import Servos
from linkwright.simulation.plugins.node import PluginNode
from linkwright.simulation.plugins.pid import Gains, Pid
from linkwright.simulation.plugins.plugin import PluginContext
from linkwright.simulation.simulation import Simulation
from linkwright.xmltree import Element

_KINDS = ("VELOCITY", "POSITION", "EFFORT", "COMMAND")
_DEFAULT_GAINS = {
    "p_gain": 0.1,
    "i_gain": 0.0,
    "d_gain": 0.0,
    "i_max": 0.0,
    "i_min": 0.0,
    "cmd_max": 1.0,
    "cmd_min": -1.0,
}
_MOTOR_GAIN = 20.0
"""The gain of a joint motor, in N m of torque per rad/s of velocity error."""
_DIRECTIONS = {"cw": -1.0, "ccw": 1.0}
_FLOAT_TYPE = "std_msgs/msg/Float64"


class Vehicle(Protocol):
    """The part of a plugin that channels use."""

    @property
    def simulation(self) -> Simulation:
        """The simulation in which the plugin runs."""

    @property
    def node(self) -> PluginNode:
        """The node of the plugin."""

    @property
    def context(self) -> PluginContext:
        """The elements that contain the plugin."""

    def joint(self, name: str) -> str:
        """Return the full name of a joint."""

    def parameter_error(self, message: Phrase, element: Element | None = None) -> LinkwrightError:
        """Return the error for contradictory parameters."""

    def text_in(self, parent: Element | None, tag: str) -> str:
        """Return the text in a child of an element."""

    def number_in(self, parent: Element | None, tag: str, default: float | None = None) -> float:
        """Return the number in a child of an element."""


@dataclass(slots=True)
class Channel:
    """A channel of an autopilot.

    Attributes:
        simulation: the simulation.
        number: the number of the channel in the packets.
        joint: the full name of the joint.
        kind: ``VELOCITY``, ``POSITION``, ``EFFORT`` or ``COMMAND``.
        multiplier, offset: the command is ``multiplier * (fraction + offset)``.
        shortest, longest: the pulse widths in µs for 0 and 1.
        slowdown: the factor by which the joint turns slower than the command, for velocities.
        gains: the gains of the controller.
        motor: the motor that holds a velocity without a controller; None with one.
        output: publishes the command instead; None for other kinds.
        command: the command, or None if the channel has no output.
    """

    simulation: Simulation
    number: int
    joint: str
    kind: str
    multiplier: float
    offset: float
    shortest: float
    longest: float
    slowdown: float
    gains: Gains
    motor: Motor | None = None
    output: Any = None
    command: float | None = None
    _pid: Pid = field(init=False)

    def __post_init__(self) -> None:
        self._pid = Pid(self.gains)

    def set_command(self, servos: Servos) -> None:
        """Set the command from a packet."""
        fraction = servos.compute_fraction(self.number, self.shortest, self.longest)
        self.command = None if fraction is None else self.multiplier * (fraction + self.offset)

    def stop(self) -> None:
        """Drop the command, and end the effort."""
        self.command, self._pid = None, Pid(self.gains)
        if self.motor is not None:
            self.motor.target = 0.0
        elif self.output is None:
            self.simulation.push_joint(self.joint, 0.0)

    def move(self) -> None:
        """Move the joint for a step, or publish the command."""
        if self.command is None:
            return
        if self.output is not None:
            self.output.publish(get_message(_FLOAT_TYPE)(data=self.command))
        elif self.motor is not None:
            self.motor.target = self.command
        elif self.kind == "EFFORT":
            self.simulation.push_joint(self.joint, self.command)
        else:
            position, velocity = self.simulation.joint_state(self.joint)
            error = self.command - position if self.kind == "POSITION" else self.command / self.slowdown - velocity
            seconds = self.simulation.step / NANOSECONDS_PER_SECOND
            self.simulation.push_joint(self.joint, self._pid.force(error, seconds))


def read_channel(vehicle: Vehicle, element: Element, index: int) -> Channel:
    """Return the channel that an element ``<control>`` or ``<rotor>`` describes.

    Args:
        vehicle: the plugin.
        element: the element.
        index: the number of the channel if the element has none.

    Raises:
        LinkwrightError: SIM134, there is no such joint; SIM160, a value is not valid.
    """
    simulation, name = vehicle.simulation, vehicle.context.name
    kind = vehicle.text_in(element, "type") or "VELOCITY"
    if kind not in _KINDS:
        message = phrase(
            "plugin '{plugin}': <type> must be {types}, not '{kind}'",
            plugin=name,
            types=quoted_names(_KINDS, " or "),
            kind=kind,
        )
        raise vehicle.parameter_error(message, element)
    joint = vehicle.joint(vehicle.text_in(element, "jointName"))
    shortest, longest = (
        vehicle.number_in(element, "servo_min", 1000.0),
        vehicle.number_in(element, "servo_max", 2000.0),
    )
    if shortest == longest:
        message = phrase("plugin '{plugin}': <servo_min> and <servo_max> must differ", plugin=name)
        raise vehicle.parameter_error(message, element)
    channel = Channel(
        simulation,
        _read_number(vehicle, element, index),
        joint,
        kind,
        _read_multiplier(vehicle, element),
        vehicle.number_in(element, "offset", 0.0),
        shortest,
        longest,
        vehicle.number_in(element, "rotorVelocitySlowdownSim", 1.0) or 1.0,
        _read_gains(vehicle, element),
    )
    uses_force = (vehicle.text_in(element, "useForce") or "true").lower() in ("1", "true")
    if kind == "COMMAND":
        world, model, leaf = vehicle.context.world.name, vehicle.context.path, vehicle.text_in(element, "jointName")
        topic = vehicle.text_in(element, "cmd_topic") or f"/world/{world}/model/{model}/joint/{leaf}/cmd"
        channel.output = vehicle.node.publisher(_FLOAT_TYPE, topic)
    elif kind == "VELOCITY" and not uses_force:
        channel.motor = simulation.add_velocity_motor(joint, _MOTOR_GAIN, inf)
    simulation.keep_awake(simulation.scene.joints[joint].child)
    return channel


def _read_number(vehicle: Vehicle, element: Element, index: int) -> int:
    text = element.attributes.get("channel") or element.attributes.get("id") or str(index)
    try:
        return int(text)
    except ValueError as error:
        message = phrase(
            "plugin '{plugin}': '{text}' is not the number of a channel", plugin=vehicle.context.name, text=text
        )
        raise vehicle.parameter_error(message, element) from error


def _read_multiplier(vehicle: Vehicle, element: Element) -> float:
    """Return the multiplier, with its older name ``<turningDirection>``: ``cw``, ``ccw`` or a number."""
    direction = vehicle.text_in(element, "turningDirection")
    if element.first("multiplier") is None and direction:
        return _DIRECTIONS.get(direction) or vehicle.number_in(element, "turningDirection")
    return vehicle.number_in(element, "multiplier", 1.0)


def _read_gains(vehicle: Vehicle, element: Element) -> Gains:
    """Return the gains, with their older names that begin with ``vel_``."""
    gains = {
        tag: vehicle.number_in(element, tag, vehicle.number_in(element, f"vel_{tag}", default))
        for tag, default in _DEFAULT_GAINS.items()
    }
    return Gains(
        p=gains["p_gain"],
        i=gains["i_gain"],
        d=gains["d_gain"],
        i_min=gains["i_min"],
        i_max=gains["i_max"],
        cmd_min=gains["cmd_min"],
        cmd_max=gains["cmd_max"],
        cmd_offset=0.0,
    )
