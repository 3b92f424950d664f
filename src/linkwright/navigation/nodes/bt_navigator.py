"""nav2's bt_navigator, which navigates to poses by calling nav2's other servers.

The node offers the actions ``navigate_to_pose`` and ``navigate_through_poses``, and subscribes to ``goal_pose`` (RViz's
2D Goal Pose). It behaves as nav2's default trees do (``navigate_to_pose_w_replanning_and_recovery.xml``): it plans a
new path each second. When planning or driving fails, it clears the costmaps; if that does not help, the robot spins,
waits, backs up and tries again, up to six times. A deliberate difference: it does not run users' behavior trees, and
logs a warning instead.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np

from linkwright.graph import LATCHED_QOS, ActionClient, TransformException
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.time.values import Duration
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import TransformListener
from linkwright.messages import get_action, get_message, get_service
from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL, Costmap
from linkwright.navigation.nodes.costmap_conversion import costmap_from_message
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedServer
from linkwright.navigation.nodes.plugins import get_string_list
from linkwright.navigation.nodes.steps import SentGoal, Step, StepError, StepNode

_QUEUE_DEPTH = 10
_COSTMAP_TOPIC = "global_costmap/costmap_raw"
_UNKNOWN_COST = 255
"""The cost of positions that are unknown or outside the map."""
_MAX_RECOVERIES = 6
"""The number of recoveries after which a goal is aborted."""
_REPLANNING_PERIODS_S = {"pose": 1.0, "poses": 3.0}
"""The seconds between two plans for each action, as in nav2's trees."""
_PASSED_DISTANCE_M = 0.7
"""The distance within which an intermediate pose counts as passed, in meters."""
_SPIN_ANGLE_RAD, _WAIT_S, _BACK_UP_DISTANCE_M, _BACK_UP_SPEED_M_S = 1.57, 5.0, 0.3, 0.05
_EXTRA_TIME_S = 10.0


class NavigatorNode(StepNode):
    """The managed node of bt_navigator."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        declare = self.declare_parameter
        for name, value in _PARAMETERS.items():
            declare(name, value)
        for name in _STRING_LISTS:
            get_string_list(self, name, [])
        self._buffer = BufferCore(logger=self.get_logger().get_child("tf2"))
        TransformListener(self._buffer, self)
        self._costmap: Costmap | None = None
        self._costmap_frame = ""
        self._path: _Path | None = None
        self._remaining_distance = 0.0
        self._speed = 0.0

    def configure(self) -> None:
        """Create the subscriptions, the clients and the action servers."""
        pose, odometry = get_message("geometry_msgs/msg/PoseStamped"), get_message("nav_msgs/msg/Odometry")
        self.register(self.create_subscription(pose, "goal_pose", self._on_goal_pose, _QUEUE_DEPTH))
        self.register(
            self.create_subscription(odometry, self._get_parameter_value("odom_topic"), self._on_odometry, _QUEUE_DEPTH)
        )
        costmap_type = get_message("nav2_msgs/msg/Costmap")
        self.register(self.create_subscription(costmap_type, _COSTMAP_TOPIC, self._on_costmap, LATCHED_QOS))
        self._clients = {
            name: self.register(ActionClient(self, f"nav2_msgs/action/{kind}", name)) for name, kind in _ACTIONS.items()
        }
        clear_type = get_service("nav2_msgs/srv/ClearEntireCostmap")
        self._clear_clients = {
            variant: self.register(
                self.create_client(clear_type, f"{variant}_costmap/clear_entirely_{variant}_costmap")
            )
            for variant in ("global", "local")
        }
        self._goal_client = self.register(ActionClient(self, "nav2_msgs/action/NavigateToPose", "navigate_to_pose"))
        self._servers = {
            "pose": self._create_server("NavigateToPose", "navigate_to_pose", "pose"),
            "poses": self._create_server("NavigateThroughPoses", "navigate_through_poses", "poses"),
        }
        for variant in ("pose", "poses"):
            tree = self._get_parameter_value(
                f"default_nav_{'to_pose' if variant == 'pose' else 'through_poses'}_bt_xml"
            )
            if tree and not _is_default_tree(tree):
                self._log_ignored_tree(tree)

    def activate(self) -> None:
        """Accept goals."""

    # --- goals --------------------------------------------------------------------------------------------------------

    def _create_server(self, action_type: str, name: str, variant: str) -> GoalServer:
        def begin(goal: ServerGoalHandle) -> None:
            self._start(variant, goal.request)

        return self.register(
            GoalServer(
                self,
                f"nav2_msgs/action/{action_type}",
                name,
                begin,
                accepts_goal=lambda goal: self._accepts_goal(variant, goal),
            )
        )

    def _accepts_goal(self, variant: str, goal: Any) -> bool:
        poses = [goal.pose] if variant == "pose" else list(goal.poses)
        if not poses:
            self.get_logger().error("the goal has no poses, so it is rejected")
            return False
        if goal.behavior_tree and not _is_default_tree(goal.behavior_tree):
            self._log_ignored_tree(goal.behavior_tree)
        return True

    def _log_ignored_tree(self, path: str) -> None:
        self.get_logger().warning(f"behavior trees are not supported: the default navigation runs instead of {path}")

    def _start(self, variant: str, goal: Any) -> None:
        """Start navigating for a goal, and abort a running goal of the other action."""
        poses = [goal.pose] if variant == "pose" else list(goal.poses)
        goal_position = poses[-1].pose.position
        x, y = self._find_robot_position() or (float("nan"),) * 2
        self.get_logger().info(
            f"Begin navigating from current location ({x:.2f}, {y:.2f}) to ({goal_position.x:.2f}, "
            f"{goal_position.y:.2f})"
        )
        self._poses = poses
        self._recovery_count = 0
        self._path, self._remaining_distance = None, 0.0
        self._started_ns = self.now_ns()
        self.work_on(self._servers[variant], self._navigate(variant))

    def publish_feedback(self, server: GoalServer) -> None:
        """Publish the robot's pose and the remaining distance and time as feedback for the goal."""
        pose = get_message("geometry_msgs/msg/PoseStamped")()
        robot_pose = self._find_robot_pose()
        if robot_pose is not None:
            pose.header.frame_id, pose.header.stamp = (
                self._get_parameter_value("global_frame"),
                self.get_clock().now().to_msg(),
            )
            pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = robot_pose[:3]
            orientation = pose.pose.orientation
            orientation.x, orientation.y, orientation.z, orientation.w = robot_pose[3:]
        remaining_distance = self._remaining_distance
        feedback: dict[str, Any] = {
            "current_pose": pose,
            "distance_remaining": remaining_distance,
            "number_of_recoveries": self._recovery_count,
            "navigation_time": Duration(nanoseconds=self.now_ns() - self._started_ns).to_msg(),
            "estimated_time_remaining": Duration(
                seconds=remaining_distance / max(self._speed, _MIN_SPEED_M_S)
            ).to_msg(),
        }
        if server is self._servers["poses"]:
            feedback["number_of_poses_remaining"] = len(self._poses)
        server.publish_feedback(**feedback)

    # --- navigation ---------------------------------------------------------------------------------------------------

    def _navigate(self, variant: str) -> Step:
        """Navigate to the goal's poses, and run recoveries after failures."""
        recoveries = [self._clear_costmaps, self._spin, self._wait, self._back_up]
        while True:
            try:
                yield from self._plan_and_drive(variant)
            except StepError as failure:
                if failure.is_final or self._recovery_count >= _MAX_RECOVERIES:
                    raise
                self.get_logger().warning(f"{failure}: recovery {self._recovery_count + 1} of {_MAX_RECOVERIES}")
            else:
                return
            yield from self._recover(recoveries)

    def _recover(self, recoveries: Sequence[Any]) -> Step:
        """Run the recoveries in turn until one succeeds, as nav2's RoundRobin does."""
        for _ in recoveries:
            recovery = recoveries[self._next_recovery % len(recoveries)]
            self._next_recovery += 1
            self._recovery_count += 1
            try:
                yield from recovery()
            except StepError as failure:
                self.get_logger().warning(str(failure))
            else:
                return

    _next_recovery = 0

    def _plan_and_drive(self, variant: str) -> Step:
        """Plan a path and follow it, with periodic replanning."""
        path = yield from self._plan_with_retry(variant)
        path_goal = SentGoal(self._clients["follow_path"], self._make_follow_path_goal(path))
        is_cleared = False
        planned_ns = self.now_ns()
        try:
            while True:
                yield
                if variant == "poses":
                    self._drop_passed_poses()
                if path_goal.has_failed:
                    if is_cleared:
                        raise StepError("UNKNOWN", path_goal.reason("the controller failed"))
                    is_cleared = True
                    yield from self._clear("local")
                    path_goal = SentGoal(self._clients["follow_path"], self._make_follow_path_goal(path))
                elif path_goal.has_succeeded:
                    return
                elif self.now_ns() - planned_ns > _REPLANNING_PERIODS_S[variant] * 1e9:
                    path = yield from self._plan_with_retry(variant)
                    planned_ns = self.now_ns()
                    if not path_goal.is_over:
                        path_goal = SentGoal(self._clients["follow_path"], self._make_follow_path_goal(path))
        finally:
            path_goal.cancel()

    def _plan_with_retry(self, variant: str) -> Step:
        """Plan and return a path, with one retry after the global costmap is cleared."""
        try:
            return (yield from self._plan(variant))
        except StepError as failure:
            self.get_logger().warning(str(failure))
        yield from self._clear("global")
        try:
            return (yield from self._plan(variant))
        except StepError as failure:
            if reason := self._find_refusal_reason():
                raise StepError("UNKNOWN", f"{reason}: {failure}", is_final=True) from None
            raise

    def _plan(self, variant: str) -> Step:
        if variant == "pose":
            goal = get_action("nav2_msgs/action/ComputePathToPose").Goal(goal=self._poses[0])
            name = "compute_path_to_pose"
        else:
            self._drop_passed_poses()
            goal = get_action("nav2_msgs/action/ComputePathThroughPoses").Goal(goals=self._poses)
            name = "compute_path_through_poses"
        response = yield from self.run_remote_goal(self._clients[name], goal, "the planner found no path")
        path = response.path
        if not path.poses:
            raise StepError("NO_VALID_PATH", "the planner found no path")
        self._path = _Path(path)
        self._remaining_distance = self._path.length
        return path

    def _find_refusal_reason(self) -> str:
        """Return the reason why the robot cannot be at the goal, or an empty string.

        Unless a pose has no frame, the reason comes from the global costmap.
        """
        if not all(pose.header.frame_id for pose in self._poses):
            return "the goal has no frame_id, such as map"
        goal_position, frame = self._poses[-1].pose.position, self._poses[-1].header.frame_id
        if self._costmap is None or frame != self._costmap_frame:
            return ""
        cost = int(self._costmap.cost_at(np.array([goal_position.x, goal_position.y]), outside_cost=_UNKNOWN_COST))
        if cost == _UNKNOWN_COST:
            return f"the goal ({goal_position.x:.2f}, {goal_position.y:.2f}) is outside of the map or in unknown space"
        if cost == LETHAL:
            return f"the goal ({goal_position.x:.2f}, {goal_position.y:.2f}) is in an obstacle"
        if cost == INSCRIBED:
            return f"the goal ({goal_position.x:.2f}, {goal_position.y:.2f}) is too close to an obstacle"
        return ""

    def _drop_passed_poses(self) -> None:
        robot_position = self._find_robot_position()
        while robot_position is not None and len(self._poses) > 1:
            pose_position = self._poses[0].pose.position
            if hypot(pose_position.x - robot_position[0], pose_position.y - robot_position[1]) > _PASSED_DISTANCE_M:
                return
            self._poses = self._poses[1:]

    def _make_follow_path_goal(self, path: Any) -> Any:
        return get_action("nav2_msgs/action/FollowPath").Goal(path=path, controller_id="FollowPath")

    def _clear_costmaps(self) -> Step:
        yield from self._clear("local")
        yield from self._clear("global")

    def _clear(self, scope: str) -> Step:
        """Clear a costmap, or log a warning if its service is not available."""
        client = self._clear_clients[scope]
        if not client.service_is_ready():
            self.get_logger().warning(f"the {scope} costmap is not cleared: no node offers {client.service_name}")
            return
        future = client.call_async(get_service("nav2_msgs/srv/ClearEntireCostmap").Request())
        yield from self.wait_until(future.done, client.service_name)

    def _spin(self) -> Step:
        goal = get_action("nav2_msgs/action/Spin").Goal(target_yaw=_SPIN_ANGLE_RAD)
        goal.time_allowance = Duration(seconds=_EXTRA_TIME_S).to_msg()
        yield from self.run_remote_goal(self._clients["spin"], goal, "the robot could not spin")

    def _wait(self) -> Step:
        goal = get_action("nav2_msgs/action/Wait").Goal()
        goal.time = Duration(seconds=_WAIT_S).to_msg()
        yield from self.run_remote_goal(self._clients["wait"], goal, "the robot could not wait")

    def _back_up(self) -> Step:
        goal = get_action("nav2_msgs/action/BackUp").Goal(speed=_BACK_UP_SPEED_M_S)
        goal.target.x = _BACK_UP_DISTANCE_M
        goal.time_allowance = Duration(seconds=_EXTRA_TIME_S).to_msg()
        yield from self.run_remote_goal(self._clients["backup"], goal, "the robot could not back up")

    # --- topics -------------------------------------------------------------------------------------------------------

    def _on_goal_pose(self, message: Any) -> None:
        """Navigate to a pose sent by RViz's 2D Goal Pose."""
        if not self.is_active:
            self.get_logger().warning("a goal was received on goal_pose, but this node is not active")
            return
        self._goal_client.send_goal_async(get_action("nav2_msgs/action/NavigateToPose").Goal(pose=message))

    def _on_costmap(self, message: Any) -> None:
        self._costmap, self._costmap_frame = costmap_from_message(message), message.header.frame_id

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._speed = hypot(twist.linear.x, twist.linear.y)
        path = self._path
        robot_position = self._find_robot_position() if path is not None else None
        if path is not None and robot_position is not None:
            self._remaining_distance = path.find_remaining_distance(*robot_position)

    def _find_robot_pose(self) -> Any:
        """Return the robot's pose in the global frame, or None if it is unknown."""
        try:
            return self._buffer.lookup(
                self._get_parameter_value("global_frame"), self._get_parameter_value("robot_base_frame"), 0
            )[0]
        except TransformException:
            return None

    def _find_robot_position(self) -> tuple[float, float] | None:
        robot_pose = self._find_robot_pose()
        return None if robot_pose is None else (robot_pose[0], robot_pose[1])

    def _get_parameter_value(self, name: str) -> Any:
        return self.get_parameter(name).value


class BtNavigator(ManagedServer):
    """The running bt_navigator node."""

    DEFAULT_NAME = "bt_navigator"
    NODE = NavigatorNode


def _is_default_tree(path: str) -> bool:
    """Return whether a behavior tree has the file name of one of nav2's defaults."""
    return path.rpartition("/")[2] in _DEFAULT_TREES


class _Path:
    """The positions of a path, and the distances between them in meters.

    Args:
        message: the path, a ``nav_msgs/Path``.
    """

    def __init__(self, message: Any) -> None:
        self._positions = [(pose.pose.position.x, pose.pose.position.y) for pose in message.poses]
        self._lengths = [hypot(end[0] - start[0], end[1] - start[1]) for start, end in pairwise(self._positions)]

    @property
    def length(self) -> float:
        """The length of the path in meters."""
        return sum(self._lengths)

    def find_remaining_distance(self, x: float, y: float) -> float:
        """Return the remaining distance from a position along the path, in meters.

        The result is the distance to the nearest pose of the path plus the length of the path from that pose to the
        end.
        """
        distances = [hypot(position_x - x, position_y - y) for position_x, position_y in self._positions]
        distance = min(distances)
        return distance + sum(self._lengths[distances.index(distance) :])


_ACTIONS = {
    "compute_path_to_pose": "ComputePathToPose",
    "compute_path_through_poses": "ComputePathThroughPoses",
    "follow_path": "FollowPath",
    "spin": "Spin",
    "wait": "Wait",
    "backup": "BackUp",
}
_DEFAULT_TREES = (
    "navigate_to_pose_w_replanning_and_recovery.xml",
    "navigate_through_poses_w_replanning_and_recovery.xml",
)
_MIN_SPEED_M_S = 0.1
"""The minimum speed for the estimate of the remaining time, in m/s."""
_STRING_LISTS = ("plugin_lib_names", "navigators", "error_code_names", "error_code_name_prefixes")
_PARAMETERS: dict[str, Any] = {
    "global_frame": "map",
    "robot_base_frame": "base_link",
    "odom_topic": "odom",
    "transform_tolerance": 0.1,
    "bt_loop_duration": 10,
    "default_server_timeout": 20,
    "wait_for_service_timeout": 1000,
    "action_server_result_timeout": 900.0,
    "filter_duration": 0.3,
    "default_nav_to_pose_bt_xml": "",
    "default_nav_through_poses_bt_xml": "",
    "always_reload_bt_xml": False,
    "goal_blackboard_id": "goal",
    "goals_blackboard_id": "goals",
    "path_blackboard_id": "path",
    "enable_groot_monitoring": False,
    "groot_zmq_publisher_port": 1666,
    "groot_zmq_server_port": 1667,
}
