"""The actions of commands, as a command file declares them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, TypeAlias

from linkwright.speech.commands.phrases import Value

Values: TypeAlias = Mapping[str, Value]
"""The spoken value of each slot."""


@dataclass(frozen=True, slots=True)
class Slot:
    """A placeholder for the spoken value of a slot."""

    name: str


Amount: TypeAlias = float | Slot


@dataclass(frozen=True, slots=True)
class Drive:
    """A drive for a distance, an angle or a time, or until the silence timeout expires.

    Attributes:
        x: the speed forward, as a multiple of the robot's speed; negative for backward.
        y: the speed to the left, as a multiple of the robot's speed.
        turn: the angular speed to the left, as a multiple of the robot's turning speed.
        duration: the duration in s; None for no limit.
        distance: the distance in m; None for no limit.
        angle: the angle in rad; None for no limit.
    """

    x: float = 0.0
    y: float = 0.0
    turn: float = 0.0
    duration: Amount | None = None
    distance: Amount | None = None
    angle: Amount | None = None


@dataclass(frozen=True, slots=True)
class ScaleSpeed:
    """A multiplication of the speed for all following commands.

    Attributes:
        factor: the factor by which the current speed is multiplied.
    """

    factor: float


@dataclass(frozen=True, slots=True)
class SetSpeed:
    """A new speed for all following commands.

    Attributes:
        speed: the speed in m/s.
    """

    speed: Amount


@dataclass(frozen=True, slots=True)
class GoTo:
    """Navigation to a place with nav2_msgs/action/NavigateToPose.

    Attributes:
        place: the name of a place in the file.
        action: the name of the action, such as ``navigate_to_pose``.
    """

    place: str | Slot
    action: str


@dataclass(frozen=True, slots=True)
class SendGoal:
    """A goal for any action.

    Attributes:
        action: the name of the action.
        type_name: the type of the action.
        goal: the fields of the goal.
    """

    action: str
    type_name: str
    goal: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class CallService:
    """A service call.

    The field ``message`` of the response, if there is one, is spoken.

    Attributes:
        name: the name of the service.
        type_name: the type of the service.
        request: the fields of the request.
    """

    name: str
    type_name: str
    request: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Publish:
    """A message to publish.

    Attributes:
        topic: the topic on which the message is published.
        type_name: the message type.
        message: the fields of the message.
    """

    topic: str
    type_name: str
    message: Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop of the robot, and of everything that commands have started.

    Attributes:
        publishes: messages that stop other nodes that drive the robot. They are also published before a command starts
            another motion.
    """

    publishes: tuple[Publish, ...] = ()


@dataclass(frozen=True, slots=True)
class Launch:
    """The start of a launch file, which runs until the next stop.

    The command line is not passed to a shell.

    Attributes:
        package: the package that contains the file.
        file: the name of the file.
        arguments: the arguments of the launch file.
    """

    package: str
    file: str
    arguments: Mapping[str, Any]


Action: TypeAlias = Drive | Stop | ScaleSpeed | SetSpeed | GoTo | SendGoal | CallService | Publish | Launch
MOTIONS = Drive, GoTo, Launch
"""The actions that replace a running motion."""


def fill_template(template: Any, values: Values) -> Any:
    """Fill a template with the values of slots.

    A string that consists of one slot becomes the slot's value. In other strings, slots are replaced with their
    formatted values.

    Args:
        template: a string, a number, or lists and mappings of them.
        values: the values of the slots.
    """
    if isinstance(template, Mapping):
        return {key: fill_template(value, values) for key, value in template.items()}
    if isinstance(template, list):
        return [fill_template(item, values) for item in template]
    if not isinstance(template, str):
        return template
    for name, value in values.items():
        if template == f"{{{name}}}":
            return value
        template = template.replace(f"{{{name}}}", format_value(value))
    return template


def resolve_amount(amount_or_slot: Amount | None, values: Values) -> float | None:
    """Return an amount as a number, or None if there is no amount."""
    return float(values[amount_or_slot.name]) if isinstance(amount_or_slot, Slot) else amount_or_slot


def format_value(value: Value) -> str:
    """Format a value for a sentence or a message, with numbers rounded to thousandths."""
    return value if isinstance(value, str) else f"{round(value, 3):g}"
