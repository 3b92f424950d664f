"""The channels of PX4's simulator in the loop: each commands a joint, a topic or a rotor.

Source: PX4-SITL_gazebo-classic (parameters, defaults, formulas). A joint without ``<joint_control_pid>`` gets no force.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from linkwright.diagnostics import LinkwrightError, phrase, quoted_names
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.autopilots.channels import Vehicle
from linkwright.simulation.plugins.autopilots.mavlink import Controls
from linkwright.simulation.plugins.pid import Gains, Pid
from linkwright.simulation.simulation import Simulation
from linkwright.xmltree import Element

_CHANNEL_COUNT = 16
_KINDS = ("velocity", "position", "position_kinematic", "position_gztopic")
_FLOAT_TYPE = "std_msgs/msg/Float64"
_PERIOD_S = 1.0 / 250.0


@dataclass(slots=True)
class Px4Channel:
    """A channel of the autopilot.

    Attributes:
        simulation: the simulation.
        number: the number of the channel in the commands.
        kind: one of ``velocity``, ``position``, ``position_kinematic`` and ``position_gztopic``.
        joint: the full name of the joint; empty for a channel that only commands a rotor or a topic, or whose joint the
            model does not have.
        offset, scaling, armed: the command of an armed vehicle is ``(value + offset) * scaling + armed``.
        disarmed: the command of a disarmed vehicle.
        gains: the gains of the controller of the joint.
        max_error: the limit of the position error of the controller; 0 for none.
        output: publishes the command; None for other kinds.
        command: the current command.
    """

    simulation: Simulation
    number: int
    kind: str
    joint: str
    offset: float
    scaling: float
    armed: float
    disarmed: float
    gains: Gains
    max_error: float = 0.0
    output: Any = None
    command: float = 0.0
    _pid: Pid = field(init=False)

    def __post_init__(self) -> None:
        self._pid = Pid(self.gains)

    def set_command(self, controls: Controls) -> None:
        """Set the command from those of all channels."""
        value = controls.values[self.number]
        self.command = (value + self.offset) * self.scaling + self.armed if controls.is_armed else self.disarmed

    def stop(self) -> None:
        """End the command and the force."""
        self.command, self._pid = 0.0, Pid(self.gains)
        if self.joint and self.kind in ("velocity", "position"):
            self.simulation.push_joint(self.joint, 0.0)

    def move(self) -> None:
        """Move the joint, or publish the command."""
        if self.output is not None:
            self.output.publish(get_message(_FLOAT_TYPE)(data=self.command))
        elif self.joint and self.kind == "position_kinematic":
            self.simulation.set_joint_position(self.joint, self.command)
        elif self.joint:
            position, velocity = self.simulation.joint_state(self.joint)
            error = self.command - (velocity if self.kind == "velocity" else position)
            if self.kind == "position" and self.max_error:
                error = min(max(error, -self.max_error), self.max_error)
            seconds = max(self.simulation.step / NANOSECONDS_PER_SECOND, _PERIOD_S)
            self.simulation.push_joint(self.joint, self._pid.force(error, seconds))


def read_channels(vehicle: Vehicle) -> tuple[Px4Channel, ...]:
    """Return the channels in the element ``<control_channels>`` of a plugin.

    Raises:
        LinkwrightError: SIM160, a value is not valid.
    """
    element = vehicle.context.element
    parent = None if element is None else element.first("control_channels")
    return () if parent is None else tuple(_read_channel(vehicle, channel) for channel in parent.elements("channel"))


def _read_channel(vehicle: Vehicle, element: Element) -> Px4Channel:
    name, number = vehicle.context.name, int(vehicle.number_in(element, "input_index"))
    if not 0 <= number < _CHANNEL_COUNT:
        message = phrase("plugin '{plugin}': '{text}' is not the number of a channel", plugin=name, text=str(number))
        raise vehicle.parameter_error(message, element)
    kind, joint_name = (
        vehicle.text_in(element, "joint_control_type") or "velocity",
        vehicle.text_in(element, "joint_name"),
    )
    if kind not in _KINDS:
        message = phrase(
            "plugin '{plugin}': <{tag}> must be {types}, not '{kind}'",
            plugin=name,
            tag="joint_control_type",
            types=quoted_names(_KINDS, " or "),
            kind=kind,
        )
        raise vehicle.parameter_error(message, element)
    joint = _find_joint(vehicle, joint_name) if joint_name and kind != "position_gztopic" else ""
    simulation = vehicle.simulation
    if joint:
        simulation.keep_awake(simulation.scene.joints[joint].child)
    pid = element.first("joint_control_pid")
    channel = Px4Channel(
        simulation,
        number,
        kind,
        joint,
        vehicle.number_in(element, "input_offset", 0.0),
        vehicle.number_in(element, "input_scaling", 0.0),
        vehicle.number_in(element, "zero_position_armed", 0.0),
        vehicle.number_in(element, "zero_position_disarmed", 0.0),
        Gains(
            p=vehicle.number_in(pid, "p", 0.0),
            i=vehicle.number_in(pid, "i", 0.0),
            d=vehicle.number_in(pid, "d", 0.0),
            i_min=vehicle.number_in(pid, "iMin", 0.0),
            i_max=vehicle.number_in(pid, "iMax", 0.0),
            cmd_min=vehicle.number_in(pid, "cmdMin", 0.0),
            cmd_max=vehicle.number_in(pid, "cmdMax", 0.0),
            cmd_offset=0.0,
        ),
        vehicle.number_in(pid, "errMax", 0.0),
    )
    if kind == "position_gztopic":
        topic = vehicle.text_in(element, "gztopic")
        model = vehicle.context.path
        channel.output = vehicle.node.publisher(
            _FLOAT_TYPE, f"/{model}/{topic.lstrip('/')}" if topic else f"/control_position_gztopic_{number}"
        )
    return channel


def _find_joint(vehicle: Vehicle, name: str) -> str:
    """Return the full name of a joint, or an empty name: models of PX4 have channels for joints of other models."""
    try:
        return vehicle.joint(name)
    except LinkwrightError:
        return ""
