"""Motion primitives: motions that the controller forwards to the planner of an industrial robot."""

from __future__ import annotations

from math import isnan, nan
from typing import Any

import pytest

from linkwright.control.controllers.controller import ControllerError
from linkwright.control.controllers.motion_primitives_controller import MotionPrimitivesForwardController
from linkwright.control.controllers.registry import controller_class
from linkwright.messages import Quaternion, get_action, get_message
from tests.control.controllers.arm import SentGoal

ACTION = "control_msgs/action/ExecuteMotionPrimitiveSequence"
COMMANDS = (
    *("motion_type", "q1", "q2", "q3", "q4", "q5", "q6"),
    *("pos_x", "pos_y", "pos_z", "pos_qx", "pos_qy", "pos_qz", "pos_qw"),
    *("pos_via_x", "pos_via_y", "pos_via_z", "pos_via_qx", "pos_via_qy", "pos_via_qz", "pos_via_qw"),
    *("blend_radius", "velocity", "acceleration", "move_time"),
)
JOINT, LINE, CIRCLE, STOP, RESET, START, END = 0, 50, 51, 66, 67, 100, 101
IDLE, EXECUTING, SUCCESS, ERROR, STOPPED = 0, 1, 2, 3, 5
SUCCEEDED, CANCELED = 4, 5


class Robot:
    """An industrial robot on a test bench, whose execution the test determines."""

    def __init__(self, bench: Any, prefix: str = "") -> None:
        self.bench, self.name = bench, f"{prefix}motion_primitive"
        bench.joint(self.name, commands=COMMANDS, execution_status=float(IDLE), ready_for_new_primitive=1.0)
        parameters = {"tf_prefix": prefix} if prefix else {}
        self.controller = bench.start(MotionPrimitivesForwardController, **parameters)

    def command(self, name: str) -> float:
        value: float = self.bench.commands[f"{self.name}/{name}"].value
        return value

    async def step(self, status: int = IDLE, *, ready: bool = True) -> float:
        """Update the controller once, and return the motion type."""
        self.bench.states[f"{self.name}/execution_status"].value = float(status)
        self.bench.states[f"{self.name}/ready_for_new_primitive"].value = float(ready)
        await self.bench.step(self.controller)
        return self.command("motion_type")

    def send(self, *motions: Any) -> SentGoal:
        goal = get_action(ACTION).Goal()
        goal.trajectory.motions = list(motions)
        return SentGoal(self.bench, ACTION, "/controller/motion_sequence", goal)


def move_joints(*positions: float, **arguments: float) -> Any:
    argument = get_message("control_msgs/msg/MotionArgument")
    return get_message("control_msgs/msg/MotionPrimitive")(
        type=JOINT,
        joint_positions=list(positions),
        additional_arguments=[argument(name=name, value=value) for name, value in arguments.items()],
    )


def move_tool(kind: int, *heights: float) -> Any:
    """Return a motion along poses at heights."""
    poses = []
    for height in heights:
        pose = get_message("geometry_msgs/msg/PoseStamped")()
        pose.pose.position.z, pose.pose.orientation = height, Quaternion(x=1.0, w=0.0)
        poses.append(pose)
    return get_message("control_msgs/msg/MotionPrimitive")(type=kind, poses=poses, blend_radius=0.1)


def test_controller_is_found_by_type():
    name = "motion_primitives_controllers/MotionPrimitivesForwardController"
    assert controller_class(name) is MotionPrimitivesForwardController


async def test_single_motion_is_forwarded_and_succeeds(bench):
    robot = Robot(bench)
    goal = robot.send(
        move_joints(0.1, 0.2, 0.3, 0.4, 0.5, 0.6, velocity=0.7, acceleration=0.8, move_time=0.9, speed=1.0)
    )
    assert await robot.step() == JOINT
    assert [robot.command(f"q{number}") for number in range(1, 7)] == [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]
    assert [robot.command(name) for name in ("velocity", "acceleration", "move_time")] == [0.7, 0.8, 0.9]
    assert isnan(robot.command("pos_x"))
    assert "Unknown additional argument: speed" in [str(record.text) for record in bench.log]
    await robot.step(SUCCESS)
    assert goal.status is None
    await robot.step(EXECUTING, ready=False)
    await robot.step(SUCCESS)
    assert (goal.status, goal.result.error_code) == (SUCCEEDED, 0)
    assert goal.result.error_string == "Motion primitives executed successfully"


async def test_sequence_has_markers_and_waits_until_robot_is_ready(bench):
    robot = Robot(bench, "left_")
    robot.send(move_tool(LINE, 0.5), move_tool(CIRCLE, 0.25, 0.75))
    assert await robot.step() == START
    assert await robot.step(ready=False) == START
    assert await robot.step() == LINE
    assert (robot.command("pos_z"), robot.command("pos_qx"), robot.command("blend_radius")) == (0.5, 1.0, 0.1)
    assert isnan(robot.command("pos_via_z"))
    assert await robot.step(EXECUTING) == CIRCLE
    assert (robot.command("pos_z"), robot.command("pos_via_z")) == (0.25, 0.75)
    assert await robot.step(EXECUTING) == END


async def test_canceled_goal_stops_robot_and_resets_stop(bench):
    robot = Robot(bench)
    goal = robot.send(move_tool(LINE, 0.5), move_tool(LINE, 0.25))
    await robot.step()
    goal.cancel()
    assert await robot.step(EXECUTING) == STOP
    assert isnan(robot.command("pos_z"))
    early = robot.send(move_joints(1.0))
    await robot.step(EXECUTING, ready=False)
    assert early.accepted is False
    assert await robot.step(STOPPED) == RESET
    await robot.step()
    assert goal.status == CANCELED
    later = robot.send(move_joints(1.0))
    assert await robot.step() == JOINT
    assert later.accepted


@pytest.mark.parametrize(
    ("motions", "message"),
    [
        ((), "no motion primitives provided"),
        ((move_joints(),), "Primitive 0 invalid: LINEAR_JOINT requires joint_positions"),
        ((move_joints(*[0.0] * 7),), "Primitive 0 invalid: LINEAR_JOINT has more than 6 joint_positions"),
        ((move_joints(1.0), move_tool(LINE)), "Primitive 1 invalid: LINEAR_CARTESIAN requires at least one pose"),
        ((move_tool(CIRCLE, 1.0),), "Primitive 0 invalid: CIRCULAR_CARTESIAN requires exactly two poses"),
        ((move_tool(7, 1.0),), "Primitive 0 invalid: unknown motion type 7"),
        ((move_joints(1.0),) * 1023, "capacity (1024) is not enough for the requested 1023 motion primitives"),
    ],
)
async def test_invalid_goals_are_rejected(bench, motions, message):
    robot = Robot(bench)
    goal = robot.send(*motions)
    await robot.step()
    assert goal.accepted is False
    assert any(message in str(record.text) for record in bench.log)


async def test_second_goal_and_goal_of_inactive_controller_are_rejected(bench):
    robot = Robot(bench)
    first, second = robot.send(move_joints(1.0)), robot.send(move_joints(2.0))
    await robot.step()
    third = robot.send(move_joints(3.0))
    await robot.step()
    assert (first.accepted, third.accepted, robot.command("q1")) == (True, False, 1.0)
    assert second.accepted is False or second.status is not None
    robot.controller.on_deactivate()
    bench.exchange.deliver()
    await bench.graph.settle()
    assert first.status == CANCELED
    assert isnan(robot.command("q1"))
    last = robot.send(move_joints(4.0))
    await bench.graph.settle()
    assert last.accepted is False


async def test_error_is_logged_once_and_unknown_state_is_idle(bench):
    robot = Robot(bench)
    await robot.step(ERROR)
    await robot.step(ERROR)
    assert [str(record.text) for record in bench.log].count("Execution state: ERROR") == 1
    bench.states["motion_primitive/execution_status"].value = nan
    bench.states["motion_primitive/ready_for_new_primitive"].value = nan
    await bench.step(robot.controller)


async def test_undefined_state_is_an_error(bench):
    robot = Robot(bench)
    with pytest.raises(ControllerError, match="'motion_primitive/execution_status' has the undefined value 9"):
        await robot.step(9)
