"""Helpers for arm controllers.

They create joints on a test bench, trajectory messages, and goals of actions.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.control.controllers.joint_trajectory_controller import JointTrajectoryController
from linkwright.graph.actions.client import ActionClient
from linkwright.messages import Duration, Header, Time, get_action, get_message
from tests.control.bench import TestBench

SECOND_NS = 1_000_000_000
JOINTS = ("shoulder", "elbow")
TRAJECTORY_ACTION = "control_msgs/action/FollowJointTrajectory"
TRAJECTORY_TYPE = "trajectory_msgs/msg/JointTrajectory"
POSITION_PARAMETERS = {
    "joints": list(JOINTS),
    "command_interfaces": ["position"],
    "state_interfaces": ["position", "velocity"],
}


def trajectory(
    *points: tuple[float, list[float]] | tuple[float, list[float], list[float]] | Any,
    names: tuple[str, ...] = JOINTS,
    start_ns: int = 0,
) -> Any:
    """Return a trajectory message.

    Each point has seconds, positions, velocities and accelerations.
    """
    point_type = get_message("trajectory_msgs/msg/JointTrajectoryPoint")
    fields = ("positions", "velocities", "accelerations", "effort")
    trajectory_points = [
        point_type(
            **dict(zip(fields, derivatives, strict=False)),
            time_from_start=Duration.from_nanoseconds(round(seconds * SECOND_NS)),
        )
        for seconds, *derivatives in points
    ]
    header = Header(stamp=Time.from_nanoseconds(start_ns))
    return get_message("trajectory_msgs/msg/JointTrajectory")(
        header=header, joint_names=list(names), points=trajectory_points
    )


def tolerance(name: str, position: float = 0.0, velocity: float = 0.0) -> Any:
    """Return the tolerance of a joint in a goal."""
    return get_message("control_msgs/msg/JointTolerance")(name=name, position=position, velocity=velocity)


class SentGoal:
    """A goal that was sent to a controller's action.

    Attributes:
        feedback: the messages so far.
        accepted, status, result: the state so far; None before.
    """

    def __init__(self, bench: TestBench, action_type: str, name: str, goal: Any) -> None:
        self.feedback: list[Any] = []
        self.status: int | None = None
        self.result: Any = None
        self._client = ActionClient(bench.node, get_action(action_type), name)
        self._handle: Any = None
        self._sent = self._client.send_goal_async(goal, feedback_callback=self._on_feedback)
        self._sent.add_done_callback(self._on_response)

    @property
    def accepted(self) -> bool | None:
        """Return whether the goal was accepted."""
        return None if self._handle is None else self._handle.accepted

    def cancel(self) -> None:
        """Request the cancellation of the goal."""
        self._handle.cancel_goal_async()

    def _on_feedback(self, message: Any) -> None:
        self.feedback.append(message.feedback)

    def _on_response(self, future: Any) -> None:
        self._handle = future.result()
        if self._handle.accepted:
            self._handle.get_result_async().add_done_callback(self._on_result)

    def _on_result(self, future: Any) -> None:
        self.status, self.result = future.result().status, future.result().result


async def run(
    bench: TestBench, controller: Any, seconds: float, hardware: Callable[[], object] | None = None, rate: float = 100.0
) -> None:
    """Update a controller for some time; the hardware moves after each update."""
    for _ in range(round(seconds * rate)):
        await bench.step(controller, 1.0 / rate)
        if hardware is not None:
            hardware()


class Arm:
    """A controller on a test bench, with hardware that follows its commands.

    It follows them at once, except for stuck joints.
    """

    def __init__(self, bench: Any, **parameters: Any) -> None:
        self.bench = bench
        facts = {**POSITION_PARAMETERS, **parameters}
        for joint in JOINTS:
            bench.joint(joint, commands=tuple(facts["command_interfaces"]), position=0.0, velocity=0.0)
        self.stuck: set[str] = set()
        self.controller = bench.start(JointTrajectoryController, **facts)

    def command(self, joint: str, interface: str = "position") -> float:
        return self.bench.commands[f"{joint}/{interface}"].value

    def follow_commands(self) -> None:
        for name, command in self.bench.commands.items():
            joint, _, interface = name.partition("/")
            if joint not in self.stuck and interface == "position":
                self.bench.states[name].value = command.value

    async def run(self, seconds: float) -> None:
        await run(self.bench, self.controller, seconds, self.follow_commands)

    def publish(self, message: Any) -> None:
        self.bench.publish(TRAJECTORY_TYPE, "/controller/joint_trajectory", message)

    def send_goal(self, message: Any, **fields: Any) -> SentGoal:
        goal = get_action(TRAJECTORY_ACTION).Goal(trajectory=message, **fields)
        return SentGoal(self.bench, TRAJECTORY_ACTION, "/controller/follow_joint_trajectory", goal)

    def log_texts(self) -> list[str]:
        return [str(record.text) for record in self.bench.log]
