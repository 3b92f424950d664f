"""Measure ros2_control_node at 1 kHz: updates per second, jitter, and processor load.

Run it with ``python -m benchmarks control``. The node has twelve joints of ``mock_components``, a
joint_trajectory_controller that holds them and a joint_state_broadcaster, and runs 1,000 updates per second, without
and with a subscription to ``/joint_states`` in this process. "A bare loop" is a Python program that only sleeps until
the next update, which shows what the machine allows. All run in turns of two seconds under the same conditions, and the
median turn is reported.
"""

from __future__ import annotations

import asyncio
import gc
import statistics
import time
from dataclasses import dataclass
from itertools import pairwise
from unittest.mock import patch

from benchmarks.measure import Row, show
from linkwright.control.nodes.ros2_control_node import Ros2ControlNode
from linkwright.graph import Graph
from linkwright.graph.log.logger import LogLevel
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.nodes.options import NodeOptions

JOINTS = [f"joint{number}" for number in range(12)]
RATE_HZ = 1000
TURNS = 5
_TURN_S = 2.0
_CYCLES = 5000
_TRAJECTORY = "joint_trajectory_controller/JointTrajectoryController"
_BROADCASTER = "joint_state_broadcaster/JointStateBroadcaster"


@dataclass(frozen=True)
class CycleTimes:
    """The result of a turn.

    Attributes:
        rate: the number of updates per second.
        load: the load of a processor, in percent.
        late_us: the delay that one period in a hundred exceeds, in microseconds.
        longest_us: the delay of the longest period, in microseconds.
    """

    rate: float
    load: float
    late_us: float
    longest_us: float


def make_robot() -> str:
    """Return a chain of joints with position commands, positions and velocities."""
    links = '<link name="base"/>' + "".join(f'<link name="{joint}_link"/>' for joint in JOINTS)
    parents = ["base", *(f"{joint}_link" for joint in JOINTS)]
    joints = "".join(
        f'<joint name="{joint}" type="continuous"><parent link="{parent}"/><child link="{joint}_link"/></joint>'
        for joint, parent in zip(JOINTS, parents, strict=False)
    )
    interfaces = "".join(
        f'<joint name="{joint}"><command_interface name="position"/><state_interface name="position"/>'
        '<state_interface name="velocity"/></joint>'
        for joint in JOINTS
    )
    return (
        f'<robot name="chain">{links}{joints}<ros2_control name="mock" type="system"><hardware>'
        f"<plugin>mock_components/GenericSystem</plugin></hardware>{interfaces}</ros2_control></robot>"
    )


def start_node(graph: Graph) -> Ros2ControlNode:
    """Return the node with both controllers active."""
    parameters = {
        "robot_description": make_robot(),
        "update_rate": RATE_HZ,
        "broadcaster": {"type": _BROADCASTER},
        "arm": {"type": _TRAJECTORY},
    }
    of_controllers = ParameterRules()
    for name, value in {
        "joints": JOINTS,
        "command_interfaces": ["position"],
        "state_interfaces": ["position", "velocity"],
    }.items():
        of_controllers.set("arm", name, value)
    graph.levels.set("", LogLevel.ERROR)
    node = Ros2ControlNode(graph, NodeOptions(parameters=parameters, parameters_of_others=of_controllers))
    manager = node._manager
    for name in ("broadcaster", "arm"):
        assert manager.load(name)
        assert manager.configure(name)
    assert manager.switch(["broadcaster", "arm"], [], 2)[0]
    return node


async def measure_controller(*, listened: bool) -> tuple[CycleTimes, float]:
    """Return the result of a turn, and the microseconds of a cycle without pauses."""
    graph = Graph()
    node = start_node(graph)
    if listened:
        graph.create_node("audience").create_subscription(
            "sensor_msgs/msg/JointState", "/joint_states", ignore_message, 10
        )
    manager, times = node._manager, list[int]()
    cycle = manager.cycle
    node._timer.cancel()  # the clock restarts, so its first updates would be early
    begin_ns, start = time.time_ns(), time.process_time()
    for number in range(_CYCLES):
        cycle(begin_ns + number * 1_000_000, 0.001)
        if listened:
            await asyncio.sleep(0)
    alone_us = (time.process_time() - start) / _CYCLES * 1e6
    node._timer.reset()

    def counted(time_ns: int, period_s: float) -> None:
        times.append(time.monotonic_ns())
        cycle(time_ns, period_s)

    with patch.object(manager, "cycle", counted):
        await asyncio.sleep(0.1)
        times.clear()
        gc.collect()
        begun, start = time.monotonic(), time.process_time()
        await asyncio.sleep(_TURN_S)
        beats = summarize(times, time.process_time() - start, time.monotonic() - begun)
    node.close()
    await graph.close()
    return beats, alone_us


def ignore_message(message: object) -> None:
    """Do nothing with a message."""


def measure_bare_loop() -> CycleTimes:
    """Return the result of a loop that only sleeps."""
    times = list[int]()
    begun, start = time.monotonic(), time.process_time()
    due = begun
    while due < begun + _TURN_S:
        due += 1.0 / RATE_HZ
        left = due - time.monotonic()
        if left > 0.0:
            time.sleep(left)
        times.append(time.monotonic_ns())
    return summarize(times, time.process_time() - start, time.monotonic() - begun)


def summarize(times: list[int], cpu_s: float, real_s: float) -> CycleTimes:
    """Return the result for the times of updates."""
    over = sorted((time_ns - previous_ns) / 1e3 - 1e6 / RATE_HZ for previous_ns, time_ns in pairwise(times))
    return CycleTimes(len(times) / real_s, 100.0 * cpu_s / real_s, over[len(over) * 99 // 100], over[-1])


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    turns: dict[str, list[CycleTimes]] = {"nobody": [], "somebody": [], "bare": []}
    cycles: dict[str, list[float]] = {"nobody": [], "somebody": []}
    for _ in range(TURNS):
        for name in ("nobody", "somebody"):
            beats, alone_us = asyncio.run(measure_controller(listened=name == "somebody"))
            turns[name].append(beats)
            cycles[name].append(alone_us)
        turns["bare"].append(measure_bare_loop())
    table = []
    for name, about in (("nobody", "nobody listens"), ("somebody", "/joint_states is listened to")):

        def row(what: str, field: str, unit: str, target: str = "", name: str = name, about: str = about) -> Row:
            def middle(which: str) -> float:
                return float(statistics.median(getattr(turn, field) for turn in turns[which]))

            peers: dict[str, float | None] = {"bare loop": middle("bare")}
            return Row(f"12 joints at 1 kHz, {about}: {what}", middle(name), unit, target, peers)

        table += [
            row("updates", "rate", "/s", "1000"),
            row("load", "load", "% of a core", "15"),
            row("99 of 100 periods over by less than", "late_us", "us"),
            row("longest period over by", "longest_us", "us"),
            Row(f"12 joints, {about}: a cycle without pause", statistics.median(cycles[name]), "us"),
        ]
    return table


if __name__ == "__main__":
    show(rows())
