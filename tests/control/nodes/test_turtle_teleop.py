"""turtle_teleop_key in a terminal of the test."""

from __future__ import annotations

import os
import sys
from math import radians

import pytest

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import GoalStatus
from linkwright.nodes import NodeOptions
from linkwright.nodes.turtlesim.simulator import Turtlesim
from linkwright.nodes.turtlesim.turtle import normalize_angle
from tests.waiting import eventually

if sys.platform == "win32":
    pytest.skip("Windows has no pseudo-terminals", allow_module_level=True)

from linkwright.control.nodes.teleop.turtle import TurtleTeleopKey

UP, DOWN, RIGHT, LEFT = "\x1b[A", "\x1b[B", "\x1b[C", "\x1b[D"


class Typist:
    """A user of turtle_teleop_key."""

    def __init__(self, harness, terminal, **parameters):
        self.harness, (self.typing_end, program_end) = harness, terminal
        self.printed, self.twists, self.statuses = [], [], []
        harness.node.create_subscription("geometry_msgs/msg/Twist", "/turtle1/cmd_vel", self.twists.append, 10)
        harness.node.create_subscription(
            "action_msgs/msg/GoalStatusArray",
            "/turtle1/rotate_absolute/_action/status",
            lambda message: self.statuses.append(GoalStatus(message.status_list[-1].status)),
            10,
        )
        options = NodeOptions(parameters=parameters, output=self.printed.append, terminal=program_end)
        self.teleop = TurtleTeleopKey(harness.graph, options)

    def press(self, keys):
        os.write(self.typing_end, keys.encode())

    async def drive(self, keys, count):
        """Press keys, and return the linear and angular velocities of all messages so far, of which there are some."""
        self.press(keys)
        await eventually(lambda: len(self.twists) >= count, what=lambda: self.twists)
        return [(twist.linear.x, twist.angular.z) for twist in self.twists]


@pytest.fixture
def terminal():
    sides = os.openpty()
    yield sides
    for side in sides:
        os.close(side)


@pytest.fixture
def start_typist(harness, terminal):
    typists = []

    def start(**parameters):
        typists.append(Typist(harness, terminal, **parameters))
        return typists[-1]

    yield start
    for typist in typists:
        typist.teleop.close()


async def test_arrow_keys_drive_the_turtle(start_typist):
    typist = start_typist()
    assert "Use arrow keys to move the turtle." in typist.printed[0]
    expected = [(2.0, 0.0), (-2.0, 0.0), (0.0, -2.0), (0.0, 2.0)]
    assert await typist.drive(UP + "x" + DOWN + RIGHT + LEFT, 4) == expected
    assert await typist.drive("\x1bOA", 5) == [*expected, (2.0, 0.0)]


async def test_speeds_are_parameters(start_typist):
    typist = start_typist(scale_linear=0.5, scale_angular=1.5)
    assert await typist.drive(UP + LEFT, 2) == [(0.5, 0.0), (0.0, 1.5)]


@pytest.mark.parametrize(
    ("key", "heading"),
    [("g", 0), ("t", 45), ("r", 90), ("e", 135), ("d", 180), ("c", -135), ("v", -90), ("b", -45), ("R", 90)],
)
async def test_letters_around_f_rotate_the_turtle(start_typist, harness, key, heading):
    simulator, typist = Turtlesim(harness.graph, NodeOptions()), start_typist()
    typist.press(key)
    await eventually(lambda: GoalStatus.EXECUTING in typist.statuses, what=lambda: typist.statuses)
    await harness.clock.advance(4.0)
    assert typist.statuses[-1] is GoalStatus.SUCCEEDED
    assert abs(normalize_angle(simulator.turtles["turtle1"].theta - radians(heading))) < 0.02
    simulator.close()


async def test_f_cancels_a_rotation(start_typist, harness):
    simulator, typist = Turtlesim(harness.graph, NodeOptions()), start_typist()
    typist.press("d")
    await eventually(lambda: GoalStatus.EXECUTING in typist.statuses, what=lambda: typist.statuses)
    await harness.clock.advance(0.5)
    typist.press("f")
    await eventually(lambda: GoalStatus.CANCELING in typist.statuses, what=lambda: typist.statuses)
    await harness.clock.advance(0.1)
    assert typist.statuses[-1] is GoalStatus.CANCELED
    assert simulator.turtles["turtle1"].theta < 0.7
    simulator.close()


async def test_keys_that_nobody_receives_are_reported(start_typist, harness, logged):
    typist = start_typist()
    typist.press("g")
    await eventually(lambda: logged("WARN"), what=lambda: logged("WARN"))
    assert logged("WARN") == ["no node offers the action turtle1/rotate_absolute"]


async def test_q_ends_the_program(start_typist):
    typist = start_typist()
    typist.press("q")
    await eventually(typist.teleop.finished.done, what=lambda: typist.printed)
    assert typist.teleop.finished.result() == 0


async def test_program_needs_a_terminal(harness):
    with pytest.raises(LinkwrightError, match="turtle_teleop_key needs a terminal") as caught:
        TurtleTeleopKey(harness.graph, NodeOptions())
    assert "ros2 run turtlesim turtle_teleop_key" in str(caught.value.diagnostics[0].hint)
