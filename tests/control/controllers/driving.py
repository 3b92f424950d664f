"""Commands for drives, and wheels that do as they are told."""

from __future__ import annotations

from typing import Any

from linkwright.control.controllers.controller import Controller
from linkwright.messages import Header, Time, Vector3, get_message
from tests.control.stand import Stand

STEP = 0.01


def twist(forward: float = 0.0, turning: float = 0.0, sideways: float = 0.0) -> Any:
    """A velocity."""
    return get_message("geometry_msgs/msg/Twist")(Vector3(forward, sideways, 0.0), Vector3(0.0, 0.0, turning))


def stamped(nanoseconds: int, *velocity: float) -> Any:
    """A velocity with the time that it was told at."""
    header = Header(Time(*divmod(nanoseconds, 1_000_000_000)), "base_link")
    return get_message("geometry_msgs/msg/TwistStamped")(header, twist(*velocity))


async def roll(stand: Stand, controller: Controller[Any], count: int = 1) -> None:
    """Go on in steps, after each of which the wheels are where their commands bring them."""
    for _ in range(count):
        await stand.step(controller, STEP)
        for name, command in stand.commands.items():
            joint, kind = name.rsplit("/", 1)
            if kind == "velocity":
                stand.states[f"{joint}/position"].value += command.value * STEP
            stand.states[name].value = command.value


def warnings(stand: Stand) -> list[str]:
    """What was told so far, from warnings on."""
    return [each.text for each in stand.log if each.level.name in ("WARN", "ERROR")]
