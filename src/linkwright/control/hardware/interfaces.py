"""The interfaces of ros2_control: named numbers that hardware and controllers exchange.

Source: hardware_interface of ros2_control (names, units of REP 103, NaN for unknown values).
"""

from __future__ import annotations

from enum import Enum
from math import nan

POSITION, VELOCITY, ACCELERATION, EFFORT = "position", "velocity", "acceleration", "effort"
"""The standard interfaces: rad or m, rad/s or m/s, rad/s² or m/s², Nm or N."""


class Interface:
    """A named number that hardware and controllers exchange.

    Args:
        component: the joint, sensor or GPIO; for interfaces of a chained controller, the controller.
        kind: the kind of value, such as ``position`` or ``orientation.x``.
        value: the initial number; NaN while it is unknown.

    Attributes:
        component: the joint, sensor, GPIO or controller.
        kind: the kind of value.
        name: the component and the kind, such as ``joint1/position``.
        value: the current number.
    """

    __slots__ = ("component", "kind", "name", "value")

    def __init__(self, component: str, kind: str, value: float = nan) -> None:
        self.component = component
        self.kind = kind
        self.name = f"{component}/{kind}"
        self.value = value

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name} = {self.value:g})"


class StateInterface(Interface):
    """A hardware state that any number of controllers may read."""

    __slots__ = ()


class CommandInterface(Interface):
    """A command to hardware, or to a chained controller.

    Only one active controller at a time can claim it.
    """

    __slots__ = ()


class Interfaces(Enum):
    """A constant for a controller that uses all interfaces."""

    ALL = "all"
    """All interfaces."""
