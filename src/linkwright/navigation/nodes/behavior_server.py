"""nav2's behavior_server: spin, back up, drive on heading, wait and assisted teleoperation.

It was recoveries_server in Foxy and Galactic, with fewer behaviors.

Source: nav2_behaviors, Humble and Jazzy; nav2_recoveries, Foxy and Galactic. Obstacles are read from
``local_costmap/costmap_raw``, and the footprint from ``local_costmap/published_footprint``. A deliberate difference: a
behavior other than wait fails when the costmap is no longer published.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import LATCHED_QOS, ParameterType
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.time.values import Duration, Time
from linkwright.messages import get_message
from linkwright.navigation.behaviors.behaviors import (
    Behavior,
    DriveStraight,
    IsFree,
    Outcome,
    Spin,
    SpinParameters,
    Step,
    Wait,
    slow_near_obstacles,
)
from linkwright.navigation.costmaps.costmap import LETHAL, Costmap
from linkwright.navigation.costmaps.footprints import Footprint
from linkwright.navigation.following.follower import ZERO_VELOCITY, Pose, Velocity
from linkwright.navigation.nodes.costmap_conversion import costmap_from_message
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.plugins import get_plugin_type, get_string_list
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.settings import check_positive, invalid_value_error
from linkwright.nodes.velocity_topic import VelocityTopic, choose_velocity_types

_QUEUE_DEPTH = 10
_COSTMAP_TIMEOUT_S = 5.0
"""The age in seconds at which a costmap is out of date."""
_ERROR_CODES = {Outcome.TIMEOUT: "TIMEOUT", Outcome.COLLISION: "COLLISION_AHEAD"}
_CLASS_NAMES = {
    "spin": "Spin",
    "backup": "BackUp",
    "drive_on_heading": "DriveOnHeading",
    "assisted_teleop": "AssistedTeleop",
    "wait": "Wait",
}
"""The behaviors, each with the name of its class and of its action type."""


class _AssistedTeleop(Behavior):
    """A behavior that drives with an operator's velocities, slowed down near obstacles.

    The behavior ends when it is canceled or times out.

    Args:
        allowance: the time limit in seconds; 0 for no limit.
        seconds: how far ahead the motion is checked for collisions, in seconds.
        requested_velocity: returns the requested velocity.
    """

    def __init__(self, allowance: float, seconds: float, requested_velocity: Callable[[], Velocity]) -> None:
        super().__init__(allowance)
        self._seconds, self._requested_velocity = seconds, requested_velocity

    def _step(self, pose: Pose, elapsed: float, is_free: IsFree) -> Step:
        return Step(Outcome.RUNNING, slow_near_obstacles(pose, self._requested_velocity(), self._seconds, is_free))


class BehaviorNode(ManagedNode):
    """The managed node of behavior_server.

    Attributes:
        PACKAGE: the package of the plugins.
        KIND: what the parameter of the plugins calls them.
        BEHAVIORS: the behaviors that it has.
    """

    _FRAME: ClassVar[str] = "odom"
    PACKAGE: ClassVar[str] = "nav2_behaviors"
    KIND: ClassVar[str] = "behavior"
    BEHAVIORS: ClassVar[tuple[str, ...]] = tuple(_CLASS_NAMES)

    @classmethod
    def plugin_types(cls) -> dict[str, str]:
        """Return the types of the plugins, as a mapping to the behaviors."""
        return {f"{cls.PACKAGE}/{_CLASS_NAMES[name]}": name for name in cls.BEHAVIORS}

    def declare(self) -> None:
        """Declare nav2's parameters."""
        declare = self.declare_parameter
        overrides = set(self.undeclared_overrides())
        self._humble_parameters = {"costmap_topic", "footprint_topic"} & overrides
        for scope in ("local", "global"):
            declare(f"{scope}_costmap_topic", f"{scope}_costmap/costmap_raw")
            declare(f"{scope}_footprint_topic", f"{scope}_costmap/published_footprint")
        declare("costmap_topic", "local_costmap/costmap_raw")  # Humble's names of the parameters above.
        declare("footprint_topic", "local_costmap/published_footprint")
        declare("cycle_frequency", 10.0)
        declare("local_frame", self._FRAME)
        declare("global_frame", "")  # Humble uses this name for the local frame.
        declare("robot_base_frame", "base_link")
        declare("transform_tolerance", 0.1)
        declare("simulate_ahead_time", 2.0)
        declare("max_rotational_vel", 1.0)
        declare("min_rotational_vel", 0.4)
        declare("rotational_acc_lim", 3.2)
        declare("projection_time", 1.0)
        declare("simulation_time_step", 0.1)
        declare("cmd_vel_teleop", "cmd_vel_teleop")
        declare("action_server_result_timeout", 10.0)
        self._publishes_stamped: bool | None = declare("enable_stamped_cmd_vel", ParameterType.BOOL).value
        self._poses = FramePoses(self, "the pose of the robot is not known:")
        self._servers: dict[str, GoalServer] = {}
        self._running: tuple[GoalServer, Behavior, str] | None = None
        self._costmap: Costmap | None = None
        self._costmap_received_ns = 0
        self._costmap_frame = ""
        self._footprint: Footprint | None = None
        self._requested_velocity = ZERO_VELOCITY

    def configure(self) -> None:
        """Create the subscriptions, the publisher and the action servers.

        Raises:
            LinkwrightError: a parameter is missing or has an invalid value.
        """
        self._period = 1.0 / check_positive(self, "cycle_frequency", self._get_parameter_value("cycle_frequency"))
        costmap_type, polygon = get_message("nav2_msgs/msg/Costmap"), get_message("geometry_msgs/msg/PolygonStamped")
        self.register(
            self.create_subscription(costmap_type, self._get_topic_name("costmap"), self._on_costmap, LATCHED_QOS)
        )
        self.register(
            self.create_subscription(polygon, self._get_topic_name("footprint"), self._on_footprint, _QUEUE_DEPTH)
        )
        teleop_topic = self._get_parameter_value("cmd_vel_teleop")
        for message_type in choose_velocity_types(self, teleop_topic, self._publishes_stamped):
            self.register(self.create_subscription(message_type, teleop_topic, self._on_teleop_velocity, _QUEUE_DEPTH))
        self._output = VelocityTopic(self, "cmd_vel", self._publishes_stamped)
        behaviors_by_type = self.plugin_types()
        default_types = {name: plugin_type for plugin_type, name in behaviors_by_type.items()}
        for plugin in get_string_list(self, f"{self.KIND}_plugins", self.BEHAVIORS):
            plugin_type = get_plugin_type(self, plugin, default_types)
            if plugin_type not in behaviors_by_type:
                raise invalid_value_error(f"{plugin}.plugin", plugin_type, self.get_name(), list(behaviors_by_type))
            name = behaviors_by_type[plugin_type]
            self.get_logger().info(f"Creating {self.KIND} plugin {plugin} of type {plugin_type}")
            self._servers[plugin] = self.register(self._create_server(plugin, name))

    def deactivate(self) -> None:
        """Stop the robot and abort the current goal."""
        if self._running is not None:
            server, _, _ = self._running
            self._halt()
            server.abort("UNKNOWN", "the server was deactivated")

    def cleanup(self) -> None:
        """Stop the running behavior, and remove the action servers and the output topic."""
        self.end_cycles()
        self._servers.clear()
        self._costmap = self._footprint = None
        if hasattr(self, "_output"):
            self._output.close()

    # --- goals --------------------------------------------------------------------------------------------------------

    def _create_server(self, plugin: str, name: str) -> GoalServer:
        def begin(goal: ServerGoalHandle) -> None:
            self._start(self._servers[plugin], name, goal.request)

        return GoalServer(self, f"nav2_msgs/action/{_CLASS_NAMES[name]}", plugin, begin)

    def _start(self, server: GoalServer, name: str, goal: Any) -> None:
        self.get_logger().info(f"Running {name}")
        if self._running is not None and self._running[0] is not server:
            self._running[0].abort("UNKNOWN", f"{name} replaced it")
        self._halt()
        start = self._find_robot_pose() if name not in ("wait", "assisted_teleop") else (0.0, 0.0, 0.0)
        if start is None:
            server.abort("TF_ERROR", "Initial robot pose is not available.")
            return
        behavior = self._create_behavior(name, goal, start)
        if isinstance(behavior, str):
            self.get_logger().error(behavior)
            server.abort("INVALID_INPUT", behavior)
            return
        self._running = (server, behavior, name)
        self._started_ns = self.now_ns()
        self._requested_velocity = ZERO_VELOCITY
        self._output.update_type()
        self.begin_cycles(self._period, self._run_cycle)

    def _create_behavior(self, name: str, goal: Any, start: Pose) -> Behavior | str:
        """Return the behavior for a goal, or the reason why the goal is aborted."""
        if name == "wait":
            return Wait(_seconds_from_duration(goal.time))
        allowance = _seconds_from_duration(goal.time_allowance)
        if name == "spin":
            parameters = SpinParameters(
                max_rotational_vel=self._get_parameter_value("max_rotational_vel"),
                min_rotational_vel=self._get_parameter_value("min_rotational_vel"),
                rotational_acc_lim=self._get_parameter_value("rotational_acc_lim"),
                simulate_ahead_time=self._get_parameter_value("simulate_ahead_time"),
            )
            return Spin(goal.target_yaw, allowance, parameters, start)
        if name == "assisted_teleop":
            return _AssistedTeleop(
                allowance, self._get_parameter_value("projection_time"), lambda: self._requested_velocity
            )
        if goal.target.y or goal.target.z:
            return f"{name} drives only along x, but its target has y or z"
        distance, speed = goal.target.x, abs(goal.speed)
        if name == "backup":
            distance = -abs(distance)
        elif (goal.target.x > 0.0) != (goal.speed > 0.0):
            return "Speed and command sign did not match"
        if not speed > 0.0:
            return f"{name} needs a speed other than 0"
        return DriveStraight(distance, speed, allowance, self._get_parameter_value("simulate_ahead_time"), start)

    def _run_cycle(self) -> None:
        if self._running is None:
            self.end_cycles()
            return
        server, behavior, name = self._running
        elapsed = (self.now_ns() - self._started_ns) / 1e9
        if server.is_canceled:
            self.get_logger().info(f"Canceling {name}")
            self._halt()
            server.end_canceled(total_elapsed_time=_duration_from_seconds(elapsed))
            return
        pose = self._find_robot_pose() if name != "wait" else (0.0, 0.0, 0.0)
        if pose is None:
            self._finish(server, name, "TF_ERROR", "the pose of the robot is not known", elapsed)
            return
        if name != "wait" and (reason := self._find_missing_data_reason()):
            self._finish(server, name, "UNKNOWN", reason, elapsed)
            return
        step = behavior.step(pose, elapsed, self._is_free)
        if step.outcome is Outcome.RUNNING:
            if name != "wait":
                self._output.publish((step.velocity.x, step.velocity.y, 0.0), (0.0, 0.0, step.velocity.yaw))
            server.publish_feedback(**_make_feedback(name, step, elapsed, server.goal))
        elif step.outcome is Outcome.DONE:
            self.get_logger().info(f"{name} completed successfully")
            self._halt()
            server.succeed(total_elapsed_time=_duration_from_seconds(elapsed))
        else:
            self._finish(server, name, _ERROR_CODES[step.outcome], step.outcome.value, elapsed)

    def _finish(self, server: GoalServer, name: str, code: str, reason: str, elapsed: float) -> None:
        self.get_logger().warning(f"{name} failed: {reason}")
        self._halt()
        server.abort(code, reason, total_elapsed_time=_duration_from_seconds(elapsed))

    def _halt(self) -> None:
        """End the cycles of the running behavior, and stop the robot if the behavior moved it."""
        self.end_cycles()
        if self._running is not None and self._running[2] != "wait":
            self._output.stop()
        self._running = None

    # --- costmap, pose and requests -----------------------------------------------------------------------------------

    def _find_missing_data_reason(self) -> str:
        """Return the reason why obstacles are unknown, or an empty string if they are known."""
        if self._costmap is None or self._footprint is None:
            return "no costmap has been received yet"
        if self.now_ns() - self._costmap_received_ns > _COSTMAP_TIMEOUT_S * 1e9:
            return "the costmap is no longer published"
        return ""

    def _is_free(self, poses: NDArray[np.float64]) -> bool:
        assert self._costmap is not None, "`_missing_data_reason` checked it"
        assert self._footprint is not None, "`_missing_data_reason` checked it"
        return not bool(np.any(self._costmap.compute_footprint_cost(poses, self._footprint) == LETHAL))

    def _find_robot_pose(self) -> Pose | None:
        """Return the robot's pose in the frame of the costmap, or None if it is unknown."""
        frame = self._costmap_frame or self._get_parameter_value("local_frame")
        pose = self._poses.pose(frame, self._get_parameter_value("robot_base_frame"), 0)
        return None if pose is None else (pose[0], pose[1], rpy_from_quaternion(pose[3:])[2])

    def _on_costmap(self, message: Any) -> None:
        self._costmap = costmap_from_message(message)
        self._costmap_frame = message.header.frame_id
        self._costmap_received_ns = self.now_ns()

    def _on_footprint(self, message: Any) -> None:
        """Store a published footprint, transformed to the robot's frame at the time of the message."""
        pose = self._poses.pose(
            message.header.frame_id,
            self._get_parameter_value("robot_base_frame"),
            Time.from_msg(message.header.stamp).nanoseconds,
        )
        if pose is None:
            return
        yaw = rpy_from_quaternion(pose[3:])[2]
        corners = np.array([(point.x, point.y) for point in message.polygon.points], np.float64).reshape(-1, 2)
        cosine, sine = np.cos(yaw), np.sin(yaw)
        footprint: Footprint = (corners - pose[:2]) @ np.array([[cosine, -sine], [sine, cosine]])
        self._footprint = footprint

    def _on_teleop_velocity(self, message: Any) -> None:
        twist = message.twist if hasattr(message, "twist") else message
        self._requested_velocity = Velocity(twist.linear.x, twist.linear.y, twist.angular.z)

    def _get_topic_name(self, kind: str) -> str:
        """Return the name of the costmap or footprint topic.

        Humble's parameter is used if it is set, and Jazzy's parameter otherwise.
        """
        humble_topic = str(self._get_parameter_value(f"{kind}_topic"))
        jazzy_topic = str(self._get_parameter_value(f"local_{kind}_topic"))
        return humble_topic if f"{kind}_topic" in self._humble_parameters else jazzy_topic

    def _get_parameter_value(self, name: str) -> Any:
        return self.get_parameter(name).value


class BehaviorServer(ManagedServer):
    """The running behavior_server node."""

    DEFAULT_NAME = "behavior_server"
    NODE = BehaviorNode


class _RecoveryNode(BehaviorNode):
    """The managed node of recoveries_server."""

    PACKAGE, KIND, BEHAVIORS = "nav2_recoveries", "recovery", ("spin", "backup", "wait")


class RecoveriesServer(ManagedServer):
    """The running recoveries_server node."""

    DEFAULT_NAME = "recoveries_server"
    NODE = _RecoveryNode


def _make_feedback(name: str, step: Step, elapsed: float, goal: Any) -> dict[str, Any]:
    """Return the fields of a behavior's feedback."""
    if name == "spin":
        return {"angular_distance_traveled": float(step.traveled)}
    if name == "wait":
        return {"time_left": _duration_from_seconds(max(0.0, _seconds_from_duration(goal.time) - elapsed))}
    if name == "assisted_teleop":
        return {"current_teleop_duration": _duration_from_seconds(elapsed)}
    return {"distance_traveled": float(step.traveled)}


def _seconds_from_duration(message: Any) -> float:
    return float(message.sec + message.nanosec / 1e9)


def _duration_from_seconds(seconds: float) -> Any:
    return Duration(seconds=seconds).to_msg()
