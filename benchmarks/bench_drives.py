"""Measure the controllers of drives: the cost of an update, and of a hundred robots.

Run it with ``python -m benchmarks drives``. The figures are processor times of updates in one process, with state
feedback of the wheels and with limits. For a hundred robots, the figure is the time of a simulated second at 100 Hz,
where 1000 ms are real time on one processor.
"""

from __future__ import annotations

import asyncio
import gc
import statistics
import time
from collections.abc import Mapping
from typing import Any

from benchmarks.measure import Row
from linkwright.control.controllers.controller import Controller, ControllerContext
from linkwright.control.controllers.node import ControllerNode
from linkwright.control.controllers.registry import controller_class
from linkwright.control.hardware.interfaces import CommandInterface, Interfaces, StateInterface
from linkwright.graph import Graph
from linkwright.graph.stepped.exchange import Exchange

_TURNS = 9
_ROBOTS, _RATE = 100, 100.0
_DIFFERENTIAL: Mapping[str, Any] = {
    "left_wheel_names": ["left"],
    "right_wheel_names": ["right"],
    "wheel_separation": 0.4,
    "wheel_radius": 0.1,
    "linear": {"x": {"max_velocity": 1.0, "max_acceleration": 2.0}},
}
_CAR: Mapping[str, Any] = {
    "traction_joints_names": ["right", "left"],
    "steering_joints_names": ["steer_right", "steer_left"],
    "wheelbase": 1.0,
    "traction_track_width": 0.5,
    "traction_wheels_radius": 0.1,
}
_DRIVE, _STEER = (
    "diff_drive_controller/DiffDriveController",
    "ackermann_steering_controller/AckermannSteeringController",
)
_SUBSCRIBED_TOPICS = {"drive/odom": "nav_msgs/msg/Odometry", "tf": "tf2_msgs/msg/TFMessage"}


class _Fleet:
    """Active controllers of one type, each in its own namespace.

    Another controller sets their references.
    """

    def __init__(self, graph: Graph, type_name: str, parameters: Mapping[str, Any], count: int) -> None:
        self._graph = graph
        self._exchange = Exchange()
        self._time = 0
        self._controllers = [
            self._create_controller(type_name, parameters, f"/robot{number}") for number in range(count)
        ]

    def _create_controller(self, type_name: str, parameters: Mapping[str, Any], namespace: str) -> Controller[Any]:
        node = self._graph.create_node("drive", namespace=namespace, parameters=parameters)
        controller = controller_class(type_name)(
            ControllerContext("drive", ControllerNode(node, self._exchange), _RATE)
        )
        controller.on_configure()
        asked, measured = controller.command_interfaces(), controller.state_interfaces()
        assert not isinstance(asked, Interfaces)
        assert not isinstance(measured, Interfaces)
        controller.commands = [CommandInterface(*_split_name(name)) for name in asked]
        controller.states = [StateInterface(*_split_name(name), 0.1) for name in measured]
        controller.references = [
            CommandInterface("drive", reference_interface) for reference_interface in controller.reference_interfaces()
        ]
        controller.on_activate()
        controller.is_chained = True
        return controller

    def update(self, count: int) -> float:
        """Return the processor time of updates of each controller with their publications, in s."""
        gc.collect()
        begin = time.process_time()
        for _ in range(count):
            self._time += round(1e9 / _RATE)
            for controller in self._controllers:
                controller.references[0].value, controller.references[1].value = 0.5, 0.3
                controller.step(self._time, 1.0 / _RATE)
            self._exchange.deliver()
        return time.process_time() - begin


def _split_name(name: str) -> tuple[str, str]:
    component, _, kind = name.rpartition("/")
    return component, kind


def rows() -> list[Row]:
    """Measure, and return the rows of the table."""
    return asyncio.run(_measure_rows())


async def _measure_rows() -> list[Row]:
    one = [
        Row(f"{name}, an update", await _measure_seconds(kind, parameters, 1, 5000, {}) / 5000 * 1e6, "us")
        for name, kind, parameters in (
            ("diff_drive_controller", _DRIVE, _DIFFERENTIAL),
            ("ackermann_steering_controller", _STEER, _CAR),
        )
    ]
    hundred = [
        Row(what, await _measure_seconds(_DRIVE, _DIFFERENTIAL, _ROBOTS, int(_RATE), topics) * 1000.0, "ms", target)
        for what, topics, target in (
            ("100 diff_drive_controllers at 100 Hz, nobody listens", {}, "2000 ms"),
            ("the same, odometry and transforms of all are heard", _SUBSCRIBED_TOPICS, "2000 ms"),
        )
    ]
    return one + hundred


async def _measure_seconds(
    type_name: str, parameters: Mapping[str, Any], robots: int, updates: int, topics: Mapping[str, str]
) -> float:
    """Return the processor time of updates of robots, in s: the median turn.

    The topics of the robots have subscribers.
    """
    graph = Graph(on_log=lambda _: None)
    fleet = _Fleet(graph, type_name, parameters, robots)
    listener = graph.create_node("listener")
    for topic, kind in topics.items():
        for name in {f"/robot{number}/{topic}" if "/" in topic else f"/{topic}" for number in range(robots)}:
            listener.create_subscription(kind, name, lambda _: None, 10)
    turns = []
    for _ in range(_TURNS):
        turns.append(fleet.update(updates))
        await graph.settle()
    await graph.close()
    return statistics.median(turns)
