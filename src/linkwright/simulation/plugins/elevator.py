"""Elevators with doors: ``gz-sim-elevator-system``.

The elevator moves its cabin to the commanded floor, opens the door, waits, and closes it. It remembers commands, and
stops at floors on its way. Controllers move the joints: the plugin publishes positions on their topics.

Source: gz-sim (parameters, defaults, topics, states, tolerances, the order of the floors).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from functools import partial
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import compose, invert
from linkwright.graph.qos.profile import SENSOR_DATA_QOS
from linkwright.graph.stepped.node import Output
from linkwright.messages import get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.plugin import SimulatedPlugin

_FLOAT_TYPE, _INTEGER_TYPE = "std_msgs/msg/Float64", "std_msgs/msg/Int32"
_DOOR_TOLERANCE_M, _CABIN_TOLERANCE_M = 0.02, 0.15
"""The distances from its target at which a joint has arrived, in m."""
_MAX_ARRIVAL_SPEED = 0.01
"""The speed in m/s up to which a joint has arrived."""
_RANGE_TOLERANCE_M = 0.005
"""How much shorter than its maximum, in m, a range must be to show an obstacle in the door."""


class _State(Enum):
    """The state of an elevator."""

    IDLE = "idle"
    MOVING = "moving"
    OPENING = "opening"
    WAITING = "waiting"
    CLOSING = "closing"


@dataclass(frozen=True, kw_only=True)
class ElevatorParameters:
    """Parameters of ``gz-sim-elevator-system``."""

    update_rate: float = 10.0
    floor_link_prefix: str = "floor_"
    door_joint_prefix: str = "door_"
    cabin_joint: str = "lift"
    cmd_topic: str = ""
    state_topic: str = ""
    state_publish_rate: float = 5.0
    open_door_wait_duration: float = 5.0


@dataclass(slots=True)
class _Joint:
    """A joint that a controller moves to targets.

    Attributes:
        name: the full name of the joint.
        output: the topic of its controller.
        tolerance: the distance from its target at which it has arrived, in m.
        target: the last target, in m.
    """

    name: str
    output: Output
    tolerance: float
    target: float = 0.0

    def move(self, target: float) -> None:
        """Command a position in m."""
        self.target = target
        self.output.publish(get_message(_FLOAT_TYPE)(data=target))


@dataclass(slots=True)
class _Floor:
    """A floor.

    Attributes:
        height: the position of the cabin's joint at the floor, in m.
        door: the joint of the door.
        open_position: the position of the open door, in m.
        is_blocked: whether something is in the door.
    """

    height: float
    door: _Joint
    open_position: float
    is_blocked: bool = False


class GzElevator(SimulatedPlugin[ElevatorParameters]):
    """The substitute for ``gz-sim-elevator-system``.

    Commands and states are numbers of floors, ``std_msgs/msg/Int32``. Lidars in the doors keep them open.
    """

    PARAMETERS = ElevatorParameters
    CARRIED = ("_state", "_targets", "_later_targets", "_close_time")

    def start(self) -> None:
        """Find the joints and the floors, and create the topics.

        Raises:
            LinkwrightError: SIM134, the cabin or a door has no joint; SIM160, there is no floor.
        """
        parameters, node, base = self.parameters, self.node, f"/model/{self.context.path}"
        self._cabin = self._find_joint(parameters.cabin_joint, _CABIN_TOLERANCE_M)
        self._floors = list(self._find_floors())
        if not self._floors:
            raise self.parameter_error(
                phrase(
                    "plugin '{plugin}': there is no link '{name}'",
                    plugin=self.context.name,
                    name=f"{parameters.floor_link_prefix}0",
                )
            )
        for number, floor in enumerate(self._floors):
            topic = f"{base}/{parameters.door_joint_prefix}{number}/lidar"
            node.subscribe("sensor_msgs/msg/LaserScan", topic, partial(self._on_scan, floor), SENSOR_DATA_QOS)
        self.reset()
        self._output = node.publisher(_INTEGER_TYPE, parameters.state_topic or f"{base}/state")
        node.subscribe(_INTEGER_TYPE, parameters.cmd_topic or f"{base}/cmd", self._on_command)
        self.every(parameters.update_rate, self._update)
        self.every(parameters.state_publish_rate, self._publish)

    def reset(self) -> None:
        """Discard the commands."""
        self._state = _State.IDLE
        self._targets: list[int] = []
        self._later_targets: list[int] = []
        self._close_time = 0

    def _find_joint(self, name: str, tolerance: float) -> _Joint:
        full_name = self.joint(name)
        self.simulation.keep_awake(self.simulation.scene.joints[full_name].child)
        topic = f"/model/{self.context.path}/joint/{name}/0/cmd_pos"
        return _Joint(full_name, self.node.publisher(_FLOAT_TYPE, topic), tolerance)

    def _find_floors(self) -> Iterator[_Floor]:
        parameters, simulation, model = self.parameters, self.simulation, self.context.model
        pattern = re.compile(re.escape(parameters.floor_link_prefix) + r"\d+")
        links = () if model is None else model.links
        from_world = invert(simulation.model_pose(self.context.path))
        for number in range(sum(pattern.fullmatch(link.name) is not None for link in links)):
            link = self.link(f"{parameters.floor_link_prefix}{number}")
            door = self._find_joint(f"{parameters.door_joint_prefix}{number}", _DOOR_TOLERANCE_M)
            height = compose(from_world, simulation.link_pose(link))[2]
            yield _Floor(height, door, simulation.scene.joints[door.name].axes[0][0].limit.upper)

    @property
    def _floor_number(self) -> int:
        """The number of the floor that is closest to the cabin."""
        position, _ = self.simulation.joint_state(self._cabin.name)
        return min(range(len(self._floors)), key=lambda number: abs(self._floors[number].height - position))

    def _on_scan(self, floor: _Floor, message: Any) -> None:
        if len(message.ranges):
            floor.is_blocked = message.ranges[0] < message.range_max - _RANGE_TOLERANCE_M

    def _on_command(self, message: Any) -> None:
        target = int(message.data)
        if not 0 <= target < len(self._floors):
            self.node.logger.warning(
                phrase("the elevator '{model}' has no floor {number}", model=self.context.path, number=target)
            )
        elif self._state in (_State.IDLE, _State.CLOSING):
            self._add_target(target)
        else:
            self._later_targets.append(target)
        if self._state is _State.IDLE and self._targets:
            self._leave_or_open()

    def _add_target(self, target: int) -> None:
        """Add a floor to the targets, before the first target beyond the floor."""
        if target in self._targets:
            return
        previous = self._floor_number
        for index, next_target in enumerate(self._targets):
            if min(previous, next_target) <= target < max(previous, next_target):
                self._targets.insert(index, target)
                return
            previous = next_target
        self._targets.append(target)

    def _leave_or_open(self) -> None:
        """Open the door if the cabin is at the next target, or else move there."""
        if self._targets[0] == self._floor_number:
            self._targets.pop(0)
            self._open()
        else:
            self._leave()

    def _leave(self) -> None:
        self._state = _State.MOVING
        self._cabin.move(self._floors[self._targets[0]].height)

    def _open(self) -> None:
        self._state = _State.OPENING
        floor = self._floors[self._floor_number]
        floor.door.move(floor.open_position)

    def _close(self) -> None:
        self._state = _State.CLOSING
        self._floors[self._floor_number].door.move(0.0)
        for target in self._later_targets:
            self._add_target(target)
        self._later_targets = []

    def _update(self) -> None:
        """Begin the next state if the current one has ended."""
        floor, now = self._floors[self._floor_number], self.simulation.time
        wait_time = round(self.parameters.open_door_wait_duration * NANOSECONDS_PER_SECOND)
        if self._state is _State.MOVING:
            if self._has_arrived(self._cabin):
                self._targets.pop(0)
                self._open()
        elif self._state is _State.OPENING:
            if self._has_arrived(floor.door):
                self._state, self._close_time = _State.WAITING, now + wait_time
        elif self._state is _State.WAITING:
            if floor.is_blocked:
                self._close_time = now + wait_time
            elif now >= self._close_time:
                self._close()
        elif self._state is _State.CLOSING and self._has_arrived(floor.door):
            self._state = _State.IDLE
            if self._targets:
                self._leave()

    def _has_arrived(self, joint: _Joint) -> bool:
        position, velocity = self.simulation.joint_state(joint.name)
        return abs(joint.target - position) <= joint.tolerance and abs(velocity) <= _MAX_ARRIVAL_SPEED

    def _publish(self) -> None:
        self._output.publish(get_message(_INTEGER_TYPE)(data=self._floor_number))
