"""Tasks for boats of VRX in Gazebo Classic: ``libstationkeeping_scoring_plugin.so`` and its like for waypoints.

States and scores are those of the tasks for gz. Goals are positions on earth, which are published once, when the task
becomes ready, and the messages are those of VRX for ROS 1.

Source: VRX (parameters, defaults, topics, states, scores, types). The simulation does not end with the task, markers
are left out, joints that hold the boat are not released, and collisions are those on ``/vrx/contacts``, as for gz.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Generic, TypeVar

from linkwright.graph.qos.profile import DurabilityPolicy, QoSProfile
from linkwright.messages import Duration, Header, Time, get_message
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND
from linkwright.simulation.plugins.boats.tasks import (
    Goal,
    Stationkeeping,
    StationkeepingParameters,
    Task,
    TaskParameters,
    Wayfinding,
    WayfindingParameters,
)

_TASK_TYPE, _FLOAT_TYPE, _ARRAY_TYPE = "vrx_gazebo/msg/Task", "std_msgs/msg/Float64", "std_msgs/msg/Float64MultiArray"
_GOAL_TYPE, _PATH_TYPE = "geographic_msgs/msg/GeoPoseStamped", "geographic_msgs/msg/GeoPath"
_LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)
_IGNORED = ("markers", "per_plugin_exit_on_completion", "silent", "release_joints", "contact_debug_topic")
P = TypeVar("P", bound=TaskParameters)


class _ClassicTask(Task[P], Generic[P]):
    """A task with the topics of VRX for Gazebo Classic."""

    def create_outputs(self) -> None:
        """Create the topic of the task's state."""
        self.collision_buffer = self.number_in(self.context.element, "collision_buffer", self.collision_buffer)
        self._info = self.node.publisher(_TASK_TYPE, self.parameters.task_info_topic)

    def publish_state(self) -> None:
        """Publish the state of the task."""
        values = {name: value for name, _, value in self.describe_state()}
        message = get_message(_TASK_TYPE)(score=float(values.pop("score")))
        for name, value in values.items():
            kind = {"ready_time": Time, "running_time": Time, "elapsed_time": Duration, "remaining_time": Duration}
            is_time = name in kind
            setattr(message, name, kind[name].from_nanoseconds(_to_nanoseconds(value)) if is_time else value)
        self._info.publish(message)

    def to_geographic_pose(self, goal: Goal) -> Any:
        """Return a goal as a position and a heading on earth, with the current time."""
        message = get_message(_GOAL_TYPE)(header=Header(stamp=self.stamp()))
        message.pose.position.latitude, message.pose.position.longitude = goal.latitude, goal.longitude
        message.pose.orientation = goal.to_message().orientation
        return message


@dataclass(frozen=True, kw_only=True)
class ClassicStationkeepingParameters(StationkeepingParameters):
    """Parameters of ``libstationkeeping_scoring_plugin.so``."""

    goal_topic: str = "/vrx/station_keeping/goal"
    pose_error_topic: str = "/vrx/station_keeping/pose_error"
    mean_error_topic: str = "/vrx/station_keeping/mean_pose_error"


class ClassicStationkeeping(_ClassicTask[StationkeepingParameters], Stationkeeping):
    """The substitute for ``libstationkeeping_scoring_plugin.so``: the score is the mean error of the pose."""

    PARAMETERS = ClassicStationkeepingParameters
    IGNORED = (*_IGNORED, "collision_buffer")

    def create_goal_outputs(self) -> None:
        """Create the topics of the goal and of the errors."""
        parameters, node = self.parameters, self.node
        self._goal_output = node.publisher(_GOAL_TYPE, parameters.goal_topic, _LATCHED)
        self._error_output = node.publisher(_FLOAT_TYPE, parameters.pose_error_topic)
        self._mean_output = node.publisher(_FLOAT_TYPE, parameters.mean_error_topic)

    def announce_ready(self) -> None:
        """Publish the goal."""
        self._goal_output.publish(self.to_geographic_pose(self.goal))

    def publish_goals(self) -> None:
        """Publish the errors of a running task."""
        if self.is_running:
            self._error_output.publish(get_message(_FLOAT_TYPE)(data=self.error))
            self._mean_output.publish(get_message(_FLOAT_TYPE)(data=self.score))


class ClassicWayfinding(_ClassicTask[WayfindingParameters], Wayfinding):
    """The substitute for ``libwayfinding_scoring_plugin.so``: the score is the mean of the smallest errors."""

    PARAMETERS = WayfindingParameters
    IGNORED = (*_IGNORED, "collision_buffer", "waypoints")

    def create_goal_outputs(self) -> None:
        """Create the topics of the waypoints and of the errors."""
        parameters, node = self.parameters, self.node
        self._goals_output = node.publisher(_PATH_TYPE, parameters.waypoints_topic, _LATCHED)
        self._errors_output = node.publisher(_ARRAY_TYPE, parameters.min_errors_topic)
        self._mean_output = node.publisher(_FLOAT_TYPE, parameters.mean_error_topic)

    def announce_ready(self) -> None:
        """Publish the waypoints."""
        poses = [self.to_geographic_pose(goal) for goal in self.goals]
        self._goals_output.publish(get_message(_PATH_TYPE)(header=Header(stamp=self.stamp()), poses=poses))

    def publish_goals(self) -> None:
        """Publish the errors of a running task."""
        if not self.is_running:
            return
        count = len(self.errors)
        message = get_message(_ARRAY_TYPE)(data=self.errors)
        dimension = get_message("std_msgs/msg/MultiArrayDimension")(label="minimum errors", size=count, stride=count)
        message.layout.dim = [dimension]
        self._errors_output.publish(message)
        self._mean_output.publish(get_message(_FLOAT_TYPE)(data=self.score))


def _to_nanoseconds(seconds: float) -> int:
    return round(seconds * NANOSECONDS_PER_SECOND)
