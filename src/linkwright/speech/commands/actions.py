"""What a command does: one of these, read from the file of commands."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from linkwright.speech.commands.phrases import Value

Values: TypeAlias = Mapping[str, Value]
"""Slot -> what was said in it."""


@dataclass(frozen=True, slots=True)
class Slot:
    """Stands for what is said in a slot."""

    name: str


Amount: TypeAlias = float | Slot


@dataclass(frozen=True, slots=True)
class Drive:
    """Move, until a distance or an angle is done, a time is over, or nobody has said anything for too long.

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
    """Drive faster or slower from now on.

    Attributes:
        factor: what the speeds are multiplied by.
    """

    factor: float


@dataclass(frozen=True, slots=True)
class SetSpeed:
    """Drive at another speed from now on.

    Attributes:
        speed: m/s.
    """

    speed: Amount


@dataclass(frozen=True, slots=True)
class GoTo:
    """Go to a place by nav2_msgs/action/NavigateToPose.

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
    """Call any service; an answer that has a ``message`` is said.

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
    """Stand still, and end all that a command has begun.

    Attributes:
        tells: what is published besides, for others that drive the robot; also when it begins to move otherwise.
    """

    tells: tuple[Publish, ...] = ()


@dataclass(frozen=True, slots=True)
class Launch:
    """Start a launch file, which the next stop ends. No shell reads any of it.

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
"""What takes the place of another motion."""


def filled(template: Any, values: Values) -> Any:
    """A template with what was said: a text that is a slot alone becomes its value, and in others it is written.

    Args:
        template: texts, numbers, and lists and mappings of them.
        values: what was said.
    """
    if isinstance(template, Mapping):
        return {key: filled(value, values) for key, value in template.items()}
    if isinstance(template, list):
        return [filled(each, values) for each in template]
    if not isinstance(template, str):
        return template
    for name, value in values.items():
        if template == f"{{{name}}}":
            return value
        template = template.replace(f"{{{name}}}", shown(value))
    return template


def amount(given: Amount | None, values: Values) -> float | None:
    """The number that an amount is."""
    return float(values[given.name]) if isinstance(given, Slot) else given


def shown(value: Value) -> str:
    """A value in a sentence or a message: numbers to a thousandth."""
    return value if isinstance(value, str) else f"{round(value, 3):g}"
