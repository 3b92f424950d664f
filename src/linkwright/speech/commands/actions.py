"""Actions of commands, as the file of commands declares them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from linkwright.speech.commands.phrases import Value

Values: TypeAlias = Mapping[str, Value]
"""Slot -> its spoken value."""


@dataclass(frozen=True, slots=True)
class Slot:
    """A placeholder for the spoken value of a slot."""

    name: str


Amount: TypeAlias = float | Slot


@dataclass(frozen=True, slots=True)
class Drive:
    """Drive for a distance, an angle or a time, or until the silence timeout.

    Attributes:
        x: forward, as a multiple of the robot's speed; backward is negative.
        y: to the left, likewise.
        turn: to the left, as a multiple of its turning speed.
        duration: s.
        distance: m.
        angle: rad.
    """

    x: float = 0.0
    y: float = 0.0
    turn: float = 0.0
    duration: Amount | None = None
    distance: Amount | None = None
    angle: Amount | None = None


@dataclass(frozen=True, slots=True)
class ScaleSpeed:
    """Multiply the speed from now on.

    Attributes:
        factor: the factor of the speeds.
    """

    factor: float


@dataclass(frozen=True, slots=True)
class SetSpeed:
    """Set the speed from now on.

    Attributes:
        speed: m/s.
    """

    speed: Amount


@dataclass(frozen=True, slots=True)
class GoTo:
    """Navigate to a place by nav2_msgs/action/NavigateToPose.

    Attributes:
        place: name of a place of the file.
        action: name of the action.
    """

    place: str | Slot
    action: str


@dataclass(frozen=True, slots=True)
class SendGoal:
    """Send a goal to any action.

    Attributes:
        action: its name.
        type_name: its type.
        goal: fields of the goal.
    """

    action: str
    type_name: str
    goal: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class CallService:
    """Call a service; a ``message`` in its response is spoken.

    Attributes:
        name: of the service.
        type_name: its type.
        request: fields of the request.
    """

    name: str
    type_name: str
    request: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Publish:
    """Publish a message.

    Attributes:
        topic: where.
        type_name: its type.
        message: its fields.
    """

    topic: str
    type_name: str
    message: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Stop:
    """Stop, and end everything that commands have started.

    Attributes:
        publishes: what is published besides, for others that drive the robot; also when it begins to move otherwise.
    """

    publishes: tuple[Publish, ...] = ()


@dataclass(frozen=True, slots=True)
class Launch:
    """Start a launch file, which the next stop ends. No shell reads any part of it.

    Attributes:
        package: where the file is.
        file: its name.
        arguments: of the launch file.
    """

    package: str
    file: str
    arguments: Mapping[str, Any]


Action: TypeAlias = Drive | Stop | ScaleSpeed | SetSpeed | GoTo | SendGoal | CallService | Publish | Launch
MOTIONS = Drive, GoTo, Launch
"""Actions that replace another motion."""


def filled(template: Any, values: Values) -> Any:
    """Fill a template: a text that is a slot alone becomes its value, other texts have it inserted.

    Args:
        template: texts, numbers, and lists and mappings of them.
        values: the values of the slots.
    """
    if isinstance(template, Mapping):
        return {key: filled(value, values) for key, value in template.items()}
    if isinstance(template, list):
        return [filled(part, values) for part in template]
    if not isinstance(template, str):
        return template
    for name, value in values.items():
        if template == f"{{{name}}}":
            return value
        template = template.replace(f"{{{name}}}", shown(value))
    return template


def amount(given: Amount | None, values: Values) -> float | None:
    """The number of an amount."""
    return float(values[given.name]) if isinstance(given, Slot) else given


def shown(value: Value) -> str:
    """Format a value for a sentence or a message: numbers to a thousandth."""
    return value if isinstance(value, str) else f"{round(value, 3):g}"
