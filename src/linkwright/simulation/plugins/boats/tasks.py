"""Tasks for boats: ``libStationkeepingScoringPlugin.so`` and ``libWayfindingScoringPlugin.so``.

A task has the states initial, ready, running and finished. The boat is released when the task becomes ready, and the
score is computed while the task runs: the mean distance from a pose, or from each of some poses at the closest
approach. A heading error counts, too, near the pose: ``d + 0.75^d e`` for the distance d in m and the error e in rad.

Source: VRX (parameters, topics, states, scores); ros_gz_bridge (types). The simulation does not end with the task, and
markers are left out.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot, pi
from typing import Any, ClassVar, Generic, TypeVar

import numpy as np

from linkwright.diagnostics import phrase
from linkwright.geometry.single import Pose, pose_quaternion, rpy_from_quaternion
from linkwright.messages import get_message
from linkwright.sdf.worlds import SphericalCoordinates
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.simulation.sensors.earth import Globe
from linkwright.xmltree import Element

_PARAMETERS_TYPE, _FLOAT_TYPE = "ros_gz_interfaces/msg/ParamVec", "std_msgs/msg/Float32"
_RATE_HZ = 1.0
_COLLISION_BUFFER_S = 3.0
"""The time after a collision in which further ones do not count."""
_HEADING_BASE = 0.75
_INITIAL, _READY, _RUNNING, _FINISHED = "initial", "ready", "running", "finished"


@dataclass(frozen=True, kw_only=True)
class TaskParameters:
    """Parameters of all tasks: durations in s."""

    vehicle: str = parameter()
    task_name: str = parameter()
    task_info_topic: str = "/vrx/task/info"
    release_topic: str = "/vrx/release"
    initial_state_duration: float = 30.0
    ready_state_duration: float = 60.0
    running_state_duration: float = 300.0


@dataclass(frozen=True, slots=True)
class Goal:
    """A pose on the water.

    Attributes:
        latitude, longitude: the position on earth in degrees.
        x, y: the position in the world in m.
        yaw: the heading in rad.
    """

    latitude: float
    longitude: float
    x: float
    y: float
    yaw: float

    def compute_error(self, pose: tuple[float, float, float], *, with_heading: bool) -> float:
        """Return the error of a pose x, y, yaw in m."""
        x, y, yaw = pose
        distance = hypot(self.x - x, self.y - y)
        heading_error = pi - abs(abs(self.yaw - yaw) - pi)
        return distance + (_HEADING_BASE**distance * heading_error if with_heading else 0.0)

    def to_message(self) -> Any:
        """Return the pose with latitude and longitude as x and y, as in VRX."""
        message = get_message("geometry_msgs/msg/Pose")()
        message.position.x, message.position.y = self.latitude, self.longitude
        x, y, z, w = pose_quaternion(Pose(rpy=(0.0, 0.0, self.yaw)))
        orientation = message.orientation
        orientation.x, orientation.y, orientation.z, orientation.w = x, y, z, w
        return message


P = TypeVar("P", bound=TaskParameters)


class Task(SimulatedPlugin[P], ABC, Generic[P]):
    """A task with its states, its collisions and its score.

    Attributes:
        collision_buffer: the time in s after a collision in which further ones do not count.
        state: the current state.
        score: the current score.
    """

    collision_buffer = _COLLISION_BUFFER_S
    CARRIED: ClassVar[tuple[str, ...]] = ("state", "score", "_collision_count", "_last_collision_s")

    @abstractmethod
    def update_score(self, pose: tuple[float, float, float]) -> None:
        """Compute the score for the pose x, y, yaw of the boat after a step of a running task."""

    @abstractmethod
    def publish_goals(self) -> None:
        """Publish the goals and the errors, once a second while the task is ready or running."""

    def create_outputs(self) -> None:
        """Create the topics of the task's state and of the boat's release."""
        self._info = self.node.publisher(_PARAMETERS_TYPE, self.parameters.task_info_topic)
        self._release = self.node.publisher("std_msgs/msg/Empty", self.parameters.release_topic)

    def announce_ready(self) -> None:
        """Publish that the task became ready: the boat is released."""
        self._release.publish(get_message("std_msgs/msg/Empty")())

    def start(self) -> None:
        """Create the topics, and start the task."""
        parameters, node = self.parameters, self.node
        self.create_outputs()
        node.subscribe("ros_gz_interfaces/msg/Contacts", "/vrx/contacts", self._on_contacts)
        self._globe = Globe(self.context.world.spherical_coordinates or SphericalCoordinates())
        self._ready_s = parameters.initial_state_duration
        self._running_s = self._ready_s + parameters.ready_state_duration
        self._finish_s = self._running_s + parameters.running_state_duration
        self.reset()
        self.every(0.0, self._update)
        self.every(_RATE_HZ, self._publish)

    def reset(self) -> None:
        """Start the task again."""
        self.state, self.score = _INITIAL, 0.0
        self._collision_count, self._last_collision_s = 0, -_COLLISION_BUFFER_S

    def read_goal(self, text: str, element: Element | None) -> Goal:
        """Return the goal in a text with latitude, longitude and yaw."""
        latitude, longitude, yaw = self._read_numbers(text, element)
        x, y, _ = self._globe.from_geodetic(latitude, longitude, 0.0).tolist()
        return Goal(latitude, longitude, x, y, yaw)

    def read_world_goal(self, text: str, element: Element | None) -> Goal:
        """Return the goal in a text with x, y and yaw."""
        x, y, yaw = self._read_numbers(text, element)
        latitude, longitude, _ = self._globe.to_geodetic(np.array((x, y, 0.0)))
        return Goal(latitude, longitude, x, y, yaw)

    def _read_numbers(self, text: str, element: Element | None) -> tuple[float, float, float]:
        try:
            first, second, yaw = (float(word) for word in text.split())
        except ValueError as error:
            message = phrase("plugin '{plugin}': a goal needs three numbers", plugin=self.context.name)
            raise self.parameter_error(message, element) from error
        return first, second, yaw

    def _update(self) -> None:
        seconds = self.simulation.seconds
        if self.state == _INITIAL and seconds >= self._ready_s:
            self.state = _READY
            self.announce_ready()
        elif self.state == _READY and seconds >= self._running_s:
            self.state = _RUNNING
        elif self.state == _RUNNING and seconds >= self._finish_s:
            self.state = _FINISHED
            self._publish()
        elif self.state == _RUNNING and self.parameters.vehicle in self.simulation.scene.models:
            x, y, _, *quaternion = self.simulation.model_pose(self.parameters.vehicle)
            qx, qy, qz, qw = quaternion
            self.update_score((x, y, rpy_from_quaternion((qx, qy, qz, qw))[2]))

    def _publish(self) -> None:
        self.publish_state()
        if self.state in (_READY, _RUNNING):
            self.publish_goals()

    @property
    def is_running(self) -> bool:
        """Whether the task runs."""
        return self.state == _RUNNING

    def publish_state(self) -> None:
        """Publish the state of the task."""
        names = {"bool_value": 1, "integer_value": 2, "double_value": 3, "string_value": 4}
        parameter_class = get_message("rcl_interfaces/msg/Parameter")
        value_class = get_message("rcl_interfaces/msg/ParameterValue")
        parameters = [
            parameter_class(name=name, value=value_class(type=names[field], **{field: value}))
            for name, field, value in self.describe_state()
        ]
        self._info.publish(get_message(_PARAMETERS_TYPE)(params=parameters))

    def describe_state(self) -> Iterator[tuple[str, str, Any]]:
        """Yield the names of the values of a task, their fields in messages, and the values."""
        seconds = self.simulation.seconds
        elapsed = min(max(seconds - self._running_s, 0.0), self.parameters.running_state_duration)
        yield "name", "string_value", self.parameters.task_name
        yield "state", "string_value", self.state
        yield "ready_time", "double_value", self._ready_s
        yield "running_time", "double_value", self._running_s
        yield "elapsed_time", "double_value", elapsed
        yield "remaining_time", "double_value", self.parameters.running_state_duration - elapsed
        yield "timed_out", "bool_value", self.state == _FINISHED
        yield "num_collisions", "integer_value", self._collision_count
        yield "score", "double_value", self.score

    def _on_contacts(self, message: Any) -> None:
        hull = f"{self.parameters.vehicle}/base_link::"
        seconds = self.simulation.seconds
        is_hit = any(hull in item.collision1.name or hull in item.collision2.name for item in message.contacts)
        if is_hit and seconds - self._last_collision_s > self.collision_buffer:
            self._collision_count += 1
            self._last_collision_s = seconds


@dataclass(frozen=True, kw_only=True)
class StationkeepingParameters(TaskParameters):
    """Parameters of ``libStationkeepingScoringPlugin.so``."""

    goal_pose: str = ""
    goal_pose_cart: str = ""
    goal_topic: str = "/vrx/stationkeeping/goal"
    pose_error_topic: str = "/vrx/stationkeeping/pose_error"
    mean_error_topic: str = "/vrx/stationkeeping/mean_pose_error"
    head_error_on: bool = True


class Stationkeeping(Task[StationkeepingParameters]):
    """The substitute for ``libStationkeepingScoringPlugin.so``: the score is the mean error of the pose."""

    PARAMETERS = StationkeepingParameters
    IGNORED: ClassVar[tuple[str, ...]] = ("markers", "per_plugin_exit_on_completion", "exit_delay", "silent")
    CARRIED = (*Task.CARRIED, "_total", "_count", "error")

    def start(self) -> None:
        """Read the goal, create the topics, and start the task.

        Raises:
            LinkwrightError: SIM160, the goal is not valid.
        """
        parameters = self.parameters
        super().start()
        if parameters.goal_pose or not parameters.goal_pose_cart:
            self.goal = self.read_goal(parameters.goal_pose or "0 0 0", self.context.element)
        else:
            self.goal = self.read_world_goal(parameters.goal_pose_cart, self.context.element)
        self.create_goal_outputs()

    def create_goal_outputs(self) -> None:
        """Create the topics of the goal and of the errors."""
        parameters, node = self.parameters, self.node
        self._goal_output = node.publisher("geometry_msgs/msg/Pose", parameters.goal_topic)
        self._error_output = node.publisher(_FLOAT_TYPE, parameters.pose_error_topic)
        self._mean_output = node.publisher(_FLOAT_TYPE, parameters.mean_error_topic)

    def reset(self) -> None:
        """Start the task again."""
        super().reset()
        self._total, self._count, self.error = 0.0, 0, 0.0

    def update_score(self, pose: tuple[float, float, float]) -> None:
        """Add the error of a pose to the mean."""
        self.error = self.goal.compute_error(pose, with_heading=self.parameters.head_error_on)
        self._total, self._count = self._total + self.error, self._count + 1
        self.score = self._total / self._count

    def publish_goals(self) -> None:
        """Publish the goal, and the errors of a running task."""
        self._goal_output.publish(self.goal.to_message())
        if self.state == _RUNNING:
            self._error_output.publish(get_message(_FLOAT_TYPE)(data=self.error))
            self._mean_output.publish(get_message(_FLOAT_TYPE)(data=self.score))


@dataclass(frozen=True, kw_only=True)
class WayfindingParameters(TaskParameters):
    """Parameters of ``libWayfindingScoringPlugin.so``."""

    waypoints_topic: str = "/vrx/wayfinding/waypoints"
    min_errors_topic: str = "/vrx/wayfinding/min_errors"
    mean_error_topic: str = "/vrx/wayfinding/mean_error"


class Wayfinding(Task[WayfindingParameters]):
    """The substitute for ``libWayfindingScoringPlugin.so``: the score is the mean of the smallest errors."""

    PARAMETERS = WayfindingParameters
    IGNORED: ClassVar[tuple[str, ...]] = (
        "waypoints",
        "markers",
        "per_plugin_exit_on_completion",
        "exit_delay",
        "silent",
    )
    CARRIED = (*Task.CARRIED, "errors")

    def start(self) -> None:
        """Read the waypoints, create the topics, and start the task.

        Raises:
            LinkwrightError: SIM160, there is no waypoint, or one is not valid.
        """
        element = self.context.element
        super().start()
        parent = None if element is None else element.first("waypoints")
        children = () if parent is None else parent.elements("waypoint")
        self.goals = [self.read_goal(self.text_in(child, "pose"), child) for child in children]
        if not self.goals:
            message = phrase("plugin '{plugin}': <waypoints> needs a <waypoint>", plugin=self.context.name)
            raise self.parameter_error(message, parent)
        self.create_goal_outputs()

    def create_goal_outputs(self) -> None:
        """Create the topics of the waypoints and of the errors."""
        parameters, node = self.parameters, self.node
        self._goals_output = node.publisher("geometry_msgs/msg/PoseArray", parameters.waypoints_topic)
        self._errors_output = node.publisher("ros_gz_interfaces/msg/Float32Array", parameters.min_errors_topic)
        self._mean_output = node.publisher(_FLOAT_TYPE, parameters.mean_error_topic)

    def reset(self) -> None:
        """Start the task again."""
        super().reset()
        self.errors: list[float] = []

    def update_score(self, pose: tuple[float, float, float]) -> None:
        """Keep the smallest error of each waypoint."""
        errors = [goal.compute_error(pose, with_heading=True) for goal in self.goals]
        self.errors = [min(pair) for pair in zip(errors, self.errors or errors, strict=True)]
        self.score = sum(self.errors) / len(self.errors)

    def publish_goals(self) -> None:
        """Publish the waypoints, and the errors of a running task."""
        poses = [goal.to_message() for goal in self.goals]
        self._goals_output.publish(get_message("geometry_msgs/msg/PoseArray")(poses=poses))
        if self.state == _RUNNING:
            self._errors_output.publish(get_message("ros_gz_interfaces/msg/Float32Array")(data=self.errors))
            self._mean_output.publish(get_message(_FLOAT_TYPE)(data=self.score))
