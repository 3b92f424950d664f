"""nav2's bt_navigator, which navigates to poses with the planner, controller and behaviour servers.

The node offers the actions ``navigate_to_pose`` and ``navigate_through_poses``, and subscribes to ``goal_pose`` (RViz's
2D Goal Pose). It behaves as nav2's default trees do (``navigate_to_pose_w_replanning_and_recovery.xml``): it plans a
new path each second. When planning or driving fails, it clears the costmaps; if that does not help, the robot spins,
waits, backs up and tries again, up to six times. A deliberate difference: it does not read users' behaviour trees, and
logs this.
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
from linkwright.navigation.nodes.costmap_reading import costmap_of
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedServer
from linkwright.navigation.nodes.plugins import string_list
from linkwright.navigation.nodes.steps import SentGoal, Step, StepError, StepNode

_DEPTH = 10
_COSTMAP_TOPIC = "global_costmap/costmap_raw"
_OUTSIDE = 255
"""The cost of an unknown place, or one outside of the map."""
_RETRIES = 6
"""The number of recoveries after which a goal is aborted."""
_REPLANNING = {"pose": 1.0, "poses": 3.0}
"""Seconds between two paths, as nav2's trees have it."""
_PASSED = 0.7
"""A pose on the way counts as passed when the robot is so close, in metres."""
_SPIN, _WAIT, _BACK_UP, _BACK_UP_SPEED = 1.57, 5.0, 0.3, 0.05
_ALLOWANCE = 10.0


class NavigatorNode(StepNode):
    """The managed node of bt_navigator."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        declare = self.declare_parameter
        for name, value in _PARAMETERS.items():
            declare(name, value)
        for name in _LISTS:
            string_list(self, name, [])
        self._buffer = BufferCore(logger=self.get_logger().get_child("tf2"))
        TransformListener(self._buffer, self)
        self._costmap: Costmap | None = None
        self._costmap_frame = ""
        self._path: Any = None
        self._left = 0.0
        self._speed = 0.0

    def configure(self) -> None:
        """Create the topics, the clients and the action servers."""
        pose, odometry = get_message("geometry_msgs/msg/PoseStamped"), get_message("nav_msgs/msg/Odometry")
        self.register(self.create_subscription(pose, "goal_pose", self._on_goal_pose, _DEPTH))
        self.register(self.create_subscription(odometry, self._value("odom_topic"), self._on_odometry, _DEPTH))
        raw = get_message("nav2_msgs/msg/Costmap")
        self.register(self.create_subscription(raw, _COSTMAP_TOPIC, self._on_costmap, LATCHED_QOS))
        self._clients = {
            name: self.register(ActionClient(self, f"nav2_msgs/action/{kind}", name)) for name, kind in _ACTIONS.items()
        }
        clear = get_service("nav2_msgs/srv/ClearEntireCostmap")
        self._clearing = {
            which: self.register(self.create_client(clear, f"{which}_costmap/clear_entirely_{which}_costmap"))
            for which in ("global", "local")
        }
        self._own = self.register(ActionClient(self, "nav2_msgs/action/NavigateToPose", "navigate_to_pose"))
        self._servers = {
            "pose": self._offered("NavigateToPose", "navigate_to_pose", "pose"),
            "poses": self._offered("NavigateThroughPoses", "navigate_through_poses", "poses"),
        }
        for which in ("pose", "poses"):
            given = self._value(f"default_nav_{'to_pose' if which == 'pose' else 'through_poses'}_bt_xml")
            if given and not _is_default_tree(given):
                self._log_ignored_tree(given)

    def activate(self) -> None:
        """Accept goals."""

    # --- goals --------------------------------------------------------------------------------------------------------

    def _offered(self, kind: str, name: str, which: str) -> GoalServer:
        def begin(goal: ServerGoalHandle) -> None:
            self._start(which, goal.request)

        return self.register(
            GoalServer(
                self, f"nav2_msgs/action/{kind}", name, begin, may_begin=lambda goal: self._may_begin(which, goal)
            )
        )

    def _may_begin(self, which: str, goal: Any) -> bool:
        poses = [goal.pose] if which == "pose" else list(goal.poses)
        if not poses:
            self.get_logger().error("the goal has no poses, so it is rejected")
            return False
        if goal.behavior_tree and not _is_default_tree(goal.behavior_tree):
            self._log_ignored_tree(goal.behavior_tree)
        return True

    def _log_ignored_tree(self, path: str) -> None:
        self.get_logger().warning(f"behaviour trees are not supported: the default navigation runs instead of {path}")

    def _start(self, which: str, goal: Any) -> None:
        """Start navigating for a goal; a running goal of the other action is aborted."""
        poses = [goal.pose] if which == "pose" else list(goal.poses)
        at = poses[-1].pose.position
        x, y = self._pose() or (float("nan"),) * 2
        self.get_logger().info(f"Begin navigating from current location ({x:.2f}, {y:.2f}) to ({at.x:.2f}, {at.y:.2f})")
        self._poses = poses
        self._recoveries = 0
        self._path, self._left = None, 0.0
        self._since_ns = self.now_ns()
        self.work_on(self._servers[which], self._navigate(which))

    def publish_feedback(self, server: GoalServer) -> None:
        """Publish the robot's pose and the remaining distance and time as feedback for the goal."""
        pose = get_message("geometry_msgs/msg/PoseStamped")()
        found = self._transform()
        if found is not None:
            pose.header.frame_id, pose.header.stamp = self._value("global_frame"), self.get_clock().now().to_msg()
            pose.pose.position.x, pose.pose.position.y, pose.pose.position.z = found[:3]
            turn = pose.pose.orientation
            turn.x, turn.y, turn.z, turn.w = found[3:]
        left = self._left
        feedback: dict[str, Any] = {
            "current_pose": pose,
            "distance_remaining": left,
            "number_of_recoveries": self._recoveries,
            "navigation_time": Duration(nanoseconds=self.now_ns() - self._since_ns).to_msg(),
            "estimated_time_remaining": Duration(seconds=left / max(self._speed, _SLOWEST)).to_msg(),
        }
        if server is self._servers["poses"]:
            feedback["number_of_poses_remaining"] = len(self._poses)
        server.feedback(**feedback)

    # --- navigation ---------------------------------------------------------------------------------------------------

    def _navigate(self, which: str) -> Step:
        """Navigate to the goal's poses, and run recoveries after failures."""
        recoveries = [self._clear_costmaps, self._spin, self._wait, self._back_up]
        while True:
            try:
                yield from self._plan_and_drive(which)
            except StepError as failure:
                if failure.is_final or self._recoveries >= _RETRIES:
                    raise
                self.get_logger().warning(f"{failure}: recovery {self._recoveries + 1} of {_RETRIES}")
            else:
                return
            yield from self._recover(recoveries)

    def _recover(self, recoveries: Sequence[Any]) -> Step:
        """Run recoveries in turn, like nav2's RoundRobin, until one succeeds."""
        for _ in recoveries:
            recovery = recoveries[self._turn % len(recoveries)]
            self._turn += 1
            self._recoveries += 1
            try:
                yield from recovery()
            except StepError as failure:
                self.get_logger().warning(str(failure))
            else:
                return

    _turn = 0

    def _plan_and_drive(self, which: str) -> Step:
        """Plan a path and follow it, with periodic replanning."""
        path = yield from self._planned(which)
        driving = SentGoal(self._clients["follow_path"], self._follow_path_goal(path))
        cleared = False
        planned_ns = self.now_ns()
        try:
            while True:
                yield
                if which == "poses":
                    self._drop_passed()
                if driving.has_failed:
                    if cleared:
                        raise StepError("UNKNOWN", driving.reason("the controller failed"))
                    cleared = True
                    yield from self._clear("local")
                    driving = SentGoal(self._clients["follow_path"], self._follow_path_goal(path))
                elif driving.has_succeeded:
                    return
                elif self.now_ns() - planned_ns > _REPLANNING[which] * 1e9:
                    path = yield from self._planned(which)
                    planned_ns = self.now_ns()
                    if not driving.is_over:
                        driving = SentGoal(self._clients["follow_path"], self._follow_path_goal(path))
        finally:
            driving.cancel()

    def _planned(self, which: str) -> Step:
        """Plan a path and return it; if that fails, clear the global costmap and try once more."""
        try:
            return (yield from self._plan(which))
        except StepError as failure:
            self.get_logger().warning(str(failure))
        yield from self._clear("global")
        try:
            return (yield from self._plan(which))
        except StepError as failure:
            if reason := self._refusal_reason():
                raise StepError("UNKNOWN", f"{reason}: {failure}", is_final=True) from None
            raise

    def _plan(self, which: str) -> Step:
        if which == "pose":
            goal = get_action("nav2_msgs/action/ComputePathToPose").Goal(goal=self._poses[0])
            name = "compute_path_to_pose"
        else:
            self._drop_passed()
            goal = get_action("nav2_msgs/action/ComputePathThroughPoses").Goal(goals=self._poses)
            name = "compute_path_through_poses"
        response = yield from self.run_remote_goal(self._clients[name], goal, "the planner found no path")
        path = response.path
        if not path.poses:
            raise StepError("NO_VALID_PATH", "the planner found no path")
        self._path = path
        self._left = _length(path)
        return path

    def _refusal_reason(self) -> str:
        """Return why the goal cannot be reached on the global costmap, or an empty string if it can."""
        at, frame = self._poses[-1].pose.position, self._poses[-1].header.frame_id
        if self._costmap is None or (frame and frame != self._costmap_frame):
            return ""
        cost = int(self._costmap.cost_at(np.array([at.x, at.y]), outside=_OUTSIDE))
        if cost == _OUTSIDE:
            return f"the goal ({at.x:.2f}, {at.y:.2f}) is outside of the map or in unknown space"
        if cost == LETHAL:
            return f"the goal ({at.x:.2f}, {at.y:.2f}) is in an obstacle"
        if cost == INSCRIBED:
            return f"the goal ({at.x:.2f}, {at.y:.2f}) is too close to an obstacle"
        return ""

    def _drop_passed(self) -> None:
        place = self._pose()
        while place is not None and len(self._poses) > 1:
            at = self._poses[0].pose.position
            if hypot(at.x - place[0], at.y - place[1]) > _PASSED:
                return
            self._poses = self._poses[1:]

    def _follow_path_goal(self, path: Any) -> Any:
        return get_action("nav2_msgs/action/FollowPath").Goal(path=path, controller_id="FollowPath")

    def _clear_costmaps(self) -> Step:
        yield from self._clear("local")
        yield from self._clear("global")

    def _clear(self, which: str) -> Step:
        """Clear a costmap if its service is available; otherwise log a warning."""
        client = self._clearing[which]
        if not client.service_is_ready():
            self.get_logger().warning(f"the {which} costmap is not cleared: there is no {client.service_name}")
            return
        answer = client.call_async(get_service("nav2_msgs/srv/ClearEntireCostmap").Request())
        yield from self.until(answer.done, client.service_name)

    def _spin(self) -> Step:
        goal = get_action("nav2_msgs/action/Spin").Goal(target_yaw=_SPIN)
        goal.time_allowance = Duration(seconds=_ALLOWANCE).to_msg()
        yield from self.run_remote_goal(self._clients["spin"], goal, "it could not spin")

    def _wait(self) -> Step:
        goal = get_action("nav2_msgs/action/Wait").Goal()
        goal.time = Duration(seconds=_WAIT).to_msg()
        yield from self.run_remote_goal(self._clients["wait"], goal, "it could not wait")

    def _back_up(self) -> Step:
        goal = get_action("nav2_msgs/action/BackUp").Goal(speed=_BACK_UP_SPEED)
        goal.target.x = _BACK_UP
        goal.time_allowance = Duration(seconds=_ALLOWANCE).to_msg()
        yield from self.run_remote_goal(self._clients["backup"], goal, "it could not back up")

    # --- topics -------------------------------------------------------------------------------------------------------

    def _on_goal_pose(self, message: Any) -> None:
        """Navigate to a pose sent by RViz's 2D Goal Pose."""
        if not self.is_active:
            self.get_logger().warning("a goal was received on goal_pose, but this node is not active")
            return
        self._own.send_goal_async(get_action("nav2_msgs/action/NavigateToPose").Goal(pose=message))

    def _on_costmap(self, message: Any) -> None:
        self._costmap, self._costmap_frame = costmap_of(message), message.header.frame_id

    def _on_odometry(self, message: Any) -> None:
        twist = message.twist.twist
        self._speed = hypot(twist.linear.x, twist.linear.y)
        place = self._pose() if self._path is not None else None
        if place is not None:
            self._left = _remaining_distance(self._path, *place)

    def _transform(self) -> Any:
        """Return the robot's pose in the global frame, or None if it is unknown."""
        try:
            return self._buffer.lookup(self._value("global_frame"), self._value("robot_base_frame"), 0)[0]
        except TransformException:
            return None

    def _pose(self) -> tuple[float, float] | None:
        found = self._transform()
        return None if found is None else (found[0], found[1])

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value


class BtNavigator(ManagedServer):
    """The running bt_navigator node."""

    DEFAULT_NAME = "bt_navigator"
    NODE = NavigatorNode


def _is_default_tree(path: str) -> bool:
    """Return whether a behaviour tree has the file name of one of nav2's defaults."""
    return path.rpartition("/")[2] in _USUAL_TREES


def _length(path: Any) -> float:
    places = [pose.pose.position for pose in path.poses]
    return sum(hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(places))


def _remaining_distance(path: Any, x: float, y: float) -> float:
    """Return the remaining distance from a position along a path, in metres.

    The distance is from the position to the nearest pose of the path, plus the length from there to the end.
    """
    places = [pose.pose.position for pose in path.poses]
    nearest = min(range(len(places)), key=lambda index: hypot(places[index].x - x, places[index].y - y))
    rest = places[nearest:]
    along = sum(hypot(b.x - a.x, b.y - a.y) for a, b in pairwise(rest))
    return hypot(rest[0].x - x, rest[0].y - y) + along


_ACTIONS = {
    "compute_path_to_pose": "ComputePathToPose",
    "compute_path_through_poses": "ComputePathThroughPoses",
    "follow_path": "FollowPath",
    "spin": "Spin",
    "wait": "Wait",
    "backup": "BackUp",
}
_USUAL_TREES = (
    "navigate_to_pose_w_replanning_and_recovery.xml",
    "navigate_through_poses_w_replanning_and_recovery.xml",
)
_SLOWEST = 0.1
"""m/s with which the time that is left is reckoned at the least."""
_LISTS = ("plugin_lib_names", "navigators", "error_code_names", "error_code_name_prefixes")
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
