"""nav2's controller_server, which follows paths for the action ``follow_path``.

The node has nav2's parameters, topics and results. Deliberate differences: unless ``enable_stamped_cmd_vel`` is set,
the node publishes the type that subscribers expect, Twist or TwistStamped; the robot stops while the costmap is not
current.
"""

from __future__ import annotations

from math import cos, hypot, sin
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import Graph, ParameterType, TransformException
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.lifecycle.states import INACTIVE
from linkwright.messages import get_message
from linkwright.navigation.following.follower import (
    ZERO_VELOCITY,
    ControlInput,
    Follower,
    FollowingError,
    Pose,
    Velocity,
)
from linkwright.navigation.following.path import FollowedPath
from linkwright.navigation.nodes.costmap import CostmapNode, make_costmap
from linkwright.navigation.nodes.followers import make_follower, make_goal_checker, make_progress_checker
from linkwright.navigation.nodes.goals import GoalError, GoalServer
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.paths import poses_from_messages
from linkwright.navigation.nodes.plugins import get_string_list
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.settings import check_positive
from linkwright.nodes.velocity_topic import VelocityTopic

_QUEUE_DEPTH = 10
_WARNING_PERIOD_S = 2.0
_MIN_WAIT_S = 3.0
"""The minimum time that the robot waits for missing data before the goal is aborted, in seconds."""
_MAX_PATH_FRAME_AGE_S = 5.0
"""The maximum age of the pose of the path's frame, in seconds."""


class _TemporarilyUnavailableError(GoalError):
    """Raised when data are temporarily unavailable.

    If the data stay unavailable, the goal is aborted.
    """


class ControllerNode(ManagedNode):
    """The managed node of controller_server.

    Attributes:
        costmap: the costmap around the robot; set before the node is configured.
    """

    costmap: CostmapNode

    def declare(self) -> None:
        """Declare nav2's parameters that do not belong to a plugin."""
        declare = self.declare_parameter
        declare("controller_frequency", 20.0)
        for axis in ("x", "y", "theta"):
            declare(f"min_{axis}_velocity_threshold", 0.0001)
        declare("speed_limit_topic", "speed_limit")
        declare("failure_tolerance", 0.0)
        declare("costmap_update_timeout", 0.3)
        declare("odom_topic", "odom")
        declare("odom_duration", 0.3)
        declare("publish_zero_velocity", True)
        declare("use_realtime_priority", False)
        declare("action_server_result_timeout", 10.0)
        self._is_stamped: bool | None = declare("enable_stamped_cmd_vel", ParameterType.BOOL).value
        self._humble_progress_checker: str = declare("progress_checker_plugin", "").value  # Humble's parameter.
        self._followers: dict[str, Follower] = {}
        self._goals: GoalServer | None = None
        self._measured_velocity = ZERO_VELOCITY
        self._command: Velocity | None = None

    def configure(self) -> None:
        """Create the plugins, the costmap and the action server.

        Raises:
            LinkwrightError: a parameter is missing or has an invalid value.
        """
        self._frequency = check_positive(
            self, "controller_frequency", self._get_parameter_value("controller_frequency")
        )
        humble_checkers = [self._humble_progress_checker] if self._humble_progress_checker else None
        self._progress = {
            checker: make_progress_checker(self, checker)
            for checker in humble_checkers or get_string_list(self, "progress_checker_plugins", ["progress_checker"])
        }
        names = get_string_list(self, "goal_checker_plugins", ["goal_checker"])
        self._goal_checkers = {name: make_goal_checker(self, name) for name in names}
        names = get_string_list(self, "controller_plugins", ["FollowPath"])
        self._followers = {name: make_follower(self, name) for name in names}
        self.costmap.trigger_configure()
        odometry, limit = get_message("nav_msgs/msg/Odometry"), get_message("nav2_msgs/msg/SpeedLimit")
        self.register(
            self.create_subscription(odometry, self._get_parameter_value("odom_topic"), self._on_odometry, _QUEUE_DEPTH)
        )
        self.register(
            self.create_subscription(
                limit, self._get_parameter_value("speed_limit_topic"), self._on_speed_limit, _QUEUE_DEPTH
            )
        )
        self._output = VelocityTopic(self, "cmd_vel", self._is_stamped)
        self._goals = self.register(GoalServer(self, "nav2_msgs/action/FollowPath", "follow_path", self._start))

    def activate(self) -> None:
        """Activate the costmap, and accept goals."""
        self.costmap.trigger_activate()

    def deactivate(self) -> None:
        """Stop the robot, abort the current goal, and deactivate the costmap."""
        if self._goals is not None and self._goals.active_goal is not None:
            self._halt()
            self._goals.abort("UNKNOWN", "the server was deactivated")
        if self.costmap.is_active:
            self.costmap.trigger_deactivate()

    def cleanup(self) -> None:
        """Drop the plugins, and clean up the costmap."""
        self.end_cycles()
        self._followers.clear()
        self._goals = None
        if hasattr(self, "_output"):
            self._output.close()
        if self.costmap.lifecycle_state == INACTIVE:
            self.costmap.trigger_cleanup()

    # --- goals --------------------------------------------------------------------------------------------------------

    def _start(self, goal: ServerGoalHandle) -> None:
        """Start following the path of a goal, without a stop if the robot already follows a path."""
        request = goal.request
        assert self._goals is not None, "it is configured"
        is_driving = self.is_cycling
        self.get_logger().info(
            "Passing new path to controller." if is_driving else "Received a goal, begin computing control effort."
        )
        try:
            self._follower = _choose_plugin(self._followers, request.controller_id, "controller", "INVALID_CONTROLLER")
            self._goal_checker = _choose_plugin(
                self._goal_checkers, request.goal_checker_id, "goal checker", "INVALID_CONTROLLER"
            )
            checker_name = getattr(request, "progress_checker_id", "")
            checker = _choose_plugin(self._progress, checker_name, "progress checker", "INVALID_CONTROLLER")
            self._accept_path(request.path)
        except GoalError as failure:
            self._fail(failure)
            return
        if not is_driving:
            self._progress_checker = checker
            self._progress_checker.reset()
            self._last_valid_ns = self.now_ns()
            self._output.update_type()
            self.begin_cycles(1.0 / self._frequency, self._run_cycle)

    def _accept_path(self, message: Any) -> None:
        poses = poses_from_messages(message.poses)
        if not len(poses):
            raise GoalError("INVALID_PATH", "Path is empty.")
        goal = tuple(poses[-1])
        if not self.is_cycling or getattr(self, "_goal_in_path", None) != goal:
            self._goal_checker.reset()
        self._goal_in_path: Pose = goal
        self._path_frame = message.header.frame_id or message.poses[0].header.frame_id
        grid = self.costmap.costmap.grid
        self._local_radius = max(grid.rows, grid.columns) * grid.resolution / 2.0
        self._path = FollowedPath(poses if len(poses) > 1 else np.repeat(poses, 2, axis=0), self._local_radius)
        self._follower.reset()

    def _run_cycle(self) -> None:
        """Run one control cycle: drive, or stop if there is no goal or it was canceled."""
        goals = self._goals
        if goals is None or goals.active_goal is None:
            self._halt()
            return
        if goals.is_canceled:
            self.get_logger().info("Goal was canceled. Stopping the robot.")
            self._halt()
            goals.end_canceled()
            return
        try:
            self._drive(goals)
        except _TemporarilyUnavailableError as error:
            self._wait(error)
        except GoalError as failure:
            self._fail(failure)

    def _wait(self, error: _TemporarilyUnavailableError) -> None:
        """Stop the robot until missing data arrive, or abort the goal after a timeout."""
        self._publish(ZERO_VELOCITY)
        waited_seconds = (self.now_ns() - self._last_valid_ns) / 1e9
        if waited_seconds > max(self._get_parameter_value("costmap_update_timeout"), _MIN_WAIT_S):
            self._fail(GoalError(error.code, f"{error}; the goal is aborted"))
        else:
            message = f"{error}; the robot waits"
            self.get_logger().warning(message, throttle_duration_sec=_WARNING_PERIOD_S)

    def _drive(self, goals: GoalServer) -> None:
        """Compute and publish the next velocity, or succeed if the goal is reached.

        Raises:
            GoalError: the goal must be aborted, or data are temporarily unavailable.
        """
        now_ns = self.now_ns()
        frame = self._find_frame_pose(self._path_frame, _MAX_PATH_FRAME_AGE_S)
        pose = self._find_frame_pose(
            self.costmap.robot_base_frame, self.costmap.get_parameter("transform_tolerance").value
        )
        if not self.costmap.is_current:
            raise _TemporarilyUnavailableError("CONTROLLER_TIMED_OUT", "the costmap is not current")
        x, y, yaw = _relative_pose(frame, pose)
        self._path.update_progress(x, y)
        velocity = self._get_current_velocity()
        if self._goal_checker.is_reached((x, y, yaw), self._goal_in_path, self._measured_velocity):
            self.get_logger().info("Reached the goal!")
            self._halt()
            goals.succeed()
            return
        if not self._progress_checker.makes_progress((x, y, yaw), now_ns):
            raise GoalError("FAILED_TO_MAKE_PROGRESS", "Failed to make progress")
        control_input = ControlInput(
            pose=pose,
            velocity=velocity,
            path=_transform_poses(frame, self._path.get_poses_ahead(self._local_radius)),
            costmap=self.costmap.costmap,
            footprint=self.costmap.footprint,
            period=1.0 / self._frequency,
            xy_tolerance=self._goal_checker.xy_tolerance,
        )
        try:
            command = self._follower.compute_velocity(control_input)
        except FollowingError as error:
            self._tolerate_failure(str(error), now_ns)
            return
        self._last_valid_ns = now_ns
        self._publish(command)
        goals.publish_feedback(
            distance_to_goal=self._path.compute_remaining_distance(x, y),
            speed=hypot(self._measured_velocity.x, self._measured_velocity.y),
        )

    def _tolerate_failure(self, reason: str, now_ns: int) -> None:
        """Stop the robot when there is no valid velocity.

        Raises:
            GoalError: there was no valid velocity for longer than ``failure_tolerance``.
        """
        tolerance = self._get_parameter_value("failure_tolerance")
        if not tolerance:
            raise GoalError("NO_VALID_CONTROL", reason)
        self.get_logger().warning(reason, throttle_duration_sec=_WARNING_PERIOD_S)
        self._publish(ZERO_VELOCITY)
        if 0.0 < tolerance < (now_ns - self._last_valid_ns) / 1e9:
            raise GoalError("PATIENCE_EXCEEDED", "Controller patience exceeded")

    def _get_current_velocity(self) -> Velocity:
        """Return the last commanded velocity, or the measured velocity before the first command."""
        return self._measured_velocity if self._command is None else self._command

    def _find_frame_pose(self, frame: str, max_age: float) -> Pose:
        """Return the pose of a frame in the frame of the costmap.

        Raises:
            _TemporarilyUnavailableError: the pose is unknown, or older than `max_age` seconds.
        """
        target = self.costmap.global_frame
        if not frame or frame == target:
            return 0.0, 0.0, 0.0
        try:
            pose, stamp_ns = self.costmap.transforms.lookup(target, frame, 0)
        except TransformException as error:
            raise _TemporarilyUnavailableError(
                "TF_ERROR", f"Failed to obtain the pose of {frame} in {target}: {error}"
            ) from None
        age = (self.now_ns() - stamp_ns) / 1e9
        if stamp_ns and age > max_age:
            raise _TemporarilyUnavailableError("TF_ERROR", f"the pose of {frame} in {target} is {age:.2f} s old")
        return pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]

    def _fail(self, error: GoalError) -> None:
        self.get_logger().error(str(error))
        self._halt()
        assert self._goals is not None, "it is configured"
        self._goals.abort(error.code, str(error))

    def _halt(self) -> None:
        """End the control cycles, and stop the robot."""
        self.end_cycles()
        self._output.stop()
        self._command = None

    def _publish(self, velocity: Velocity) -> None:
        self._command = velocity
        self._output.publish((velocity.x, velocity.y, 0.0), (0.0, 0.0, velocity.yaw))

    # --- topics -------------------------------------------------------------------------------------------------------

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        measured = (twist.linear.x, twist.linear.y, twist.angular.z)
        thresholds = (self._get_parameter_value(f"min_{axis}_velocity_threshold") for axis in ("x", "y", "theta"))
        self._measured_velocity = Velocity(
            *(value if abs(value) > threshold else 0.0 for value, threshold in zip(measured, thresholds, strict=True))
        )

    def _on_speed_limit(self, message: Any) -> None:
        for follower in self._followers.values():
            follower.limit_speed(message.speed_limit, is_percentage=message.percentage)

    def _get_parameter_value(self, name: str) -> Any:
        return self.get_parameter(name).value


class ControllerServer(ManagedServer):
    """The running controller_server node, with its costmap."""

    DEFAULT_NAME = "controller_server"
    NODE = ControllerNode
    _node: ControllerNode

    def prepare(self, graph: Graph, options: NodeOptions) -> None:
        """Create the costmap."""
        self._node.costmap = make_costmap(self._node, graph, options, "local_costmap")

    def close(self) -> None:
        """Close the server and its costmap."""
        super().close()
        self._node.costmap.destroy_node()


def _choose_plugin(plugins: dict[str, Any], name: str, kind: str, code: str) -> Any:
    """Return the plugin that a goal names, or the only plugin if the goal names none.

    `kind` is the kind of plugin, for the error message.

    Raises:
        GoalError: there is no such plugin; the error has the code `code`.
    """
    if name in plugins:
        return plugins[name]
    if not name and len(plugins) == 1:
        return next(iter(plugins.values()))
    raise GoalError(code, f"there is no {kind} '{name}'; available: {', '.join(plugins)}")


def _transform_poses(frame: Pose, poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """Transform poses, of shape (poses, 3), out of the frame whose pose is `frame`."""
    x, y, yaw = frame
    cosine, sine = cos(yaw), sin(yaw)
    transformed: NDArray[np.float64] = np.stack(
        (
            x + cosine * poses[:, 0] - sine * poses[:, 1],
            y + sine * poses[:, 0] + cosine * poses[:, 1],
            yaw + poses[:, 2],
        ),
        axis=-1,
    )
    return transformed


def _relative_pose(frame: Pose, pose: Pose) -> Pose:
    """Return the pose relative to a frame.

    Both arguments are poses in a common frame.
    """
    cosine, sine = cos(frame[2]), sin(frame[2])
    dx, dy = pose[0] - frame[0], pose[1] - frame[1]
    return cosine * dx + sine * dy, cosine * dy - sine * dx, pose[2] - frame[2]
