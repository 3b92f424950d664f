"""Commands for drives, and wheels that do as they are told."""

from __future__ import annotations

from typing import Any

from linkwright.control.controllers.controller import Controller
from linkwright.messages import Header, Time, Vector3, get_message
from tests.control.stand import Stand

STEP = 0.01


def twist(forward: float = 0.0, turning: float = 0.0, sideways: float = 0.0) -> Any:
    """A velocity."""
    return get_message("geometry_msgs/msg/Twist")(
        linear=Vector3(x=forward, y=sideways, z=0.0), angular=Vector3(x=0.0, y=0.0, z=turning)
    )


def stamped(nanoseconds: int, *velocity: float) -> Any:
    """A velocity with the time that it was told at."""
    header = Header(stamp=Time.from_nanoseconds(nanoseconds), frame_id="base_link")
    return get_message("geometry_msgs/msg/TwistStamped")(header=header, twist=twist(*velocity))


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
    return [record.text for record in stand.log if record.level.name in ("WARN", "ERROR")]
