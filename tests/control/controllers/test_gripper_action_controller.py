"""Grippers: goals that are reached, stalled or canceled."""

from __future__ import annotations

from math import nan
from typing import Any

import pytest

from linkwright.control.controllers.gripper_action_controller import EffortGripper, ParallelGripper, PositionGripper
from linkwright.control.controllers.registry import controller_class
from linkwright.messages import JointState, get_action, get_message
from tests.control.controllers.arm import SentGoal, run

ACTION = "control_msgs/action/GripperCommand"
PARALLEL = "control_msgs/action/ParallelGripperCommand"
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


class Gripper:
    """A gripper on a test bench: hardware that moves to its command at 0.1 m/s, up to a limit."""

    def __init__(
        self, bench: Any, kind: type = PositionGripper, commands: tuple[str, ...] = ("position",), **parameters: Any
    ):
        self.bench = bench
        bench.joint("finger", commands=commands, position=0.0, velocity=0.0)
        self.limit = 1.0
        self.controller = bench.start(kind, joint="finger", **parameters)

    @property
    def command(self) -> float:
        return self.bench.commands["finger/position"].value

    def move(self) -> None:
        position, speed = (self.bench.states[f"finger/{interface}"] for interface in ("position", "velocity"))
        step = min(max(min(self.command, self.limit) - position.value, -0.001), 0.001)
        position.value += step
        speed.value = step / 0.01

    async def run(self, seconds: float) -> None:
        await run(self.bench, self.controller, seconds, self.move)

    def send_goal(self, position: float, effort: float = 0.0) -> SentGoal:
        command = get_message("control_msgs/msg/GripperCommand")(position=position, max_effort=effort)
        return SentGoal(self.bench, ACTION, "/controller/gripper_cmd", get_action(ACTION).Goal(command=command))


@pytest.mark.parametrize(
    ("name", "kind"),
    [
        ("position_controllers/GripperActionController", PositionGripper),
        ("effort_controllers/GripperActionController", EffortGripper),
        ("parallel_gripper_action_controller/GripperActionController", ParallelGripper),
    ],
)
def test_controllers_are_found_by_type(name, kind):
    assert controller_class(name) is kind


async def test_gripper_holds_position_and_moves_to_goal(bench):
    fingers = Gripper(bench)
    await fingers.run(0.05)
    assert fingers.command == 0.0
    goal = fingers.send_goal(0.05, effort=7.0)
    await fingers.run(0.3)
    assert goal.status is None
    await fingers.run(0.4)
    assert goal.status == SUCCEEDED
    assert (goal.result.reached_goal, goal.result.stalled, goal.result.effort) == (True, False, 7.0)
    assert goal.result.position == pytest.approx(0.04, abs=0.0021)
    assert goal.feedback


@pytest.mark.parametrize(("allowed", "status"), [(False, ABORTED), (True, SUCCEEDED)])
async def test_blocked_gripper_stalls(bench, allowed, status):
    fingers = Gripper(bench, allow_stalling=allowed, stall_timeout=0.5)
    fingers.limit = 0.02
    goal = fingers.send_goal(0.05)
    await fingers.run(0.65)
    assert goal.status is None
    await fingers.run(0.2)
    assert goal.status == status
    assert (goal.result.reached_goal, goal.result.stalled) == (False, True)
    assert fingers.command == 0.05


async def test_canceled_goal_holds_position(bench):
    fingers = Gripper(bench)
    goal = fingers.send_goal(0.5)
    await fingers.run(0.2)
    goal.cancel()
    await fingers.run(0.2)
    assert goal.status == CANCELED
    assert fingers.command == pytest.approx(0.02, abs=0.0021)


async def test_new_goal_preempts_previous_goal(bench):
    fingers = Gripper(bench)
    first = fingers.send_goal(0.5)
    await fingers.run(0.1)
    second = fingers.send_goal(0.0)
    await fingers.run(0.5)
    assert (first.status, second.status) == (CANCELED, SUCCEEDED)


async def test_goal_is_rejected_if_not_a_number_or_inactive(bench):
    fingers = Gripper(bench)
    invalid_goal = fingers.send_goal(nan)
    await fingers.run(0.02)
    fingers.controller.on_deactivate()
    rejected = fingers.send_goal(0.1)
    await bench.graph.settle()
    assert (invalid_goal.accepted, rejected.accepted) == (False, False)


async def test_effort_follows_error_up_to_maximum_of_goal(bench):
    fingers = Gripper(
        bench, EffortGripper, ("effort", "position"), gains={"finger": {"p": 100.0, "d": 10.0}}, goal_tolerance=0.001
    )
    goal = fingers.send_goal(0.1, effort=4.0)
    await run(bench, fingers.controller, 0.05)
    assert bench.commands["finger/effort"].value == 4.0
    fingers.bench.states["finger/position"].value = 0.08
    fingers.bench.states["finger/velocity"].value = 0.1
    await run(bench, fingers.controller, 0.01)
    assert bench.commands["finger/effort"].value == pytest.approx(2.0 - 1.0)
    fingers.controller.on_deactivate()
    bench.exchange.deliver()
    await bench.graph.settle()
    assert bench.commands["finger/effort"].value == 0.0
    assert goal.status == CANCELED


async def test_parallel_gripper_forwards_maximum_effort_and_velocity(bench):
    bench.joint("limits", commands=("effort", "velocity"))
    fingers = Gripper(
        bench,
        ParallelGripper,
        max_effort_interface="limits/effort",
        max_velocity_interface="limits/velocity",
    )

    def send_goal(position: list[float], velocity: list[float], effort: list[float]) -> SentGoal:
        command = JointState(name=["finger"], position=position, velocity=velocity, effort=effort)
        return SentGoal(bench, PARALLEL, "/controller/gripper_cmd", get_action(PARALLEL).Goal(command=command))

    def limits() -> tuple[float, float]:
        return bench.commands["limits/effort"].value, bench.commands["limits/velocity"].value

    await fingers.run(0.02)
    assert limits() == (10.0, 0.1)
    goal, invalid_goal = send_goal([0.02], [0.3], [5.0]), send_goal([], [], [])
    await fingers.run(0.5)
    assert limits() == (5.0, 0.3)
    assert (goal.status, invalid_goal.accepted) == (SUCCEEDED, False)
    assert goal.result.state.name == ["finger"]
    assert goal.result.state.effort[0] == 5.0
    assert "Received action goal with wrong number of position values, expects 1, got 0" in [
        str(record.text) for record in bench.log
    ]
