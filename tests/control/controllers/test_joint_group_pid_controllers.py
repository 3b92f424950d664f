"""Controllers that reach the positions of several joints by efforts or velocities."""

from __future__ import annotations

from math import nan, pi
from typing import Any

import pytest

from linkwright.control.controllers.registry import controller_class
from linkwright.messages import get_message
from tests.control.robots import robot

FLOATS = "std_msgs/msg/Float64MultiArray"
GAINS = {"gains": {"hip": {"p": 10.0}, "knee": {"p": 2.0}}}
CLASSIC_GAINS = {"hip": {"pid": {"p": 10.0}}, "knee": {"pid": {"p": 2.0}}}


def start(bench: Any, interface: str = "effort", description: str = "", **parameters: Any) -> Any:
    """Return an active controller of two joints at 0.5 and -0.5."""
    for name, position in (("hip", 0.5), ("knee", -0.5)):
        bench.joint(name, commands=(interface,), position=position)
    kind = controller_class(f"{interface}_controllers/JointGroupPositionController")
    return bench.activate(bench.make(kind, description=description, joints=["hip", "knee"], **parameters))


def commands(bench: Any, interface: str = "effort") -> list[float]:
    return [bench.commands[f"{name}/{interface}"].value for name in ("hip", "knee")]


@pytest.mark.parametrize("interface", ["effort", "velocity"])
@pytest.mark.parametrize("gains", [GAINS, CLASSIC_GAINS])
@pytest.mark.parametrize("topic", ["commands", "command"])
async def test_commands_follow_errors_of_positions(bench, interface, gains, topic):
    controller = start(bench, interface, **gains)
    await bench.step(controller)
    assert commands(bench, interface) == [0.0, 0.0]
    bench.publish(FLOATS, f"/controller/{topic}", get_message(FLOATS)(data=[1.0, 0.5]))
    await bench.step(controller)
    assert commands(bench, interface) == pytest.approx([5.0, 2.0])
    controller.on_deactivate()
    assert commands(bench, interface) == [0.0, 0.0]


@pytest.mark.parametrize(
    ("data", "message"),
    [([1.0], "command size (1) does not match number of interfaces (2)"), ([1.0, nan], "a command with NaN")],
)
async def test_invalid_command_is_refused(bench, data, message):
    controller = start(bench, **GAINS)
    bench.publish(FLOATS, "/controller/commands", get_message(FLOATS)(data=data))
    await bench.step(controller)
    assert commands(bench) == [0.0, 0.0]
    assert str(bench.log[-1].text).startswith(message)


async def test_continuous_joints_turn_the_shortest_way(bench):
    controller = start(bench, description=robot("").replace("revolute", "continuous"), **GAINS)
    bench.publish(FLOATS, "/controller/commands", get_message(FLOATS)(data=[0.5 + 2 * pi, -0.5]))
    await bench.step(controller)
    assert commands(bench) == pytest.approx([0.0, 0.0], abs=1e-9)
