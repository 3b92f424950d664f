"""Commands for drives, and wheels that follow their commands."""

from __future__ import annotations

from typing import Any

from linkwright.control.controllers.controller import Controller
from linkwright.messages import Header, Time, Vector3, get_message
from tests.control.bench import TestBench

STEP_S = 0.01


def twist(forward: float = 0.0, yaw_rate: float = 0.0, sideways: float = 0.0) -> Any:
    """Return a velocity command."""
    return get_message("geometry_msgs/msg/Twist")(
        linear=Vector3(x=forward, y=sideways, z=0.0), angular=Vector3(x=0.0, y=0.0, z=yaw_rate)
    )


def stamped_twist(nanoseconds: int, *velocity: float) -> Any:
    """Return a velocity command with its time stamp."""
    header = Header(stamp=Time.from_nanoseconds(nanoseconds), frame_id="base_link")
    return get_message("geometry_msgs/msg/TwistStamped")(header=header, twist=twist(*velocity))


async def roll_wheels(bench: TestBench, controller: Controller[Any], count: int = 1) -> None:
    """Step a controller; after each step the wheels move by their commands."""
    for _ in range(count):
        await bench.step(controller, STEP_S)
        for name, command in bench.commands.items():
            joint, interface = name.rsplit("/", 1)
            if interface == "velocity":
                bench.states[f"{joint}/position"].value += command.value * STEP_S
            bench.states[name].value = command.value


def logged_warnings(bench: TestBench) -> list[str]:
    """Return the log's warnings and errors so far."""
    return [record.text for record in bench.log if record.level.name in ("WARN", "ERROR")]
