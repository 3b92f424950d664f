"""A node that sends goals to nav2, without callbacks (API of ``nav2_simple_commander``)."""

from __future__ import annotations

from enum import Enum
from typing import Any

from linkwright.graph import LATCHED_QOS
from linkwright.graph.actions.goal import GoalStatus
from linkwright.graph.time.values import Duration
from linkwright.messages import get_action, get_message, get_service
from linkwright.standins.rclpy_api.action import ActionClient
from linkwright.standins.rclpy_api.node import Node
from linkwright.standins.rclpy_api.session import spin_once, spin_until_future_complete

_LOG_PERIOD_S = 1.0
"""Seconds between log messages about a missing server."""
_SPIN_TIMEOUT_S = 0.1
_ACTIVE_STATE = "active"


class TaskResult(Enum):
    """The result of a navigation task; `UNKNOWN` while it runs."""

    UNKNOWN = 0
    SUCCEEDED = 1
    CANCELED = 2
    FAILED = 3


_RESULTS_BY_STATUS = {
    GoalStatus.SUCCEEDED: TaskResult.SUCCEEDED,
    GoalStatus.ABORTED: TaskResult.FAILED,
    GoalStatus.CANCELED: TaskResult.CANCELED,
}
_ACTION_TYPES = {
    "navigate_to_pose": "NavigateToPose",
    "navigate_through_poses": "NavigateThroughPoses",
    "follow_waypoints": "FollowWaypoints",
    "follow_path": "FollowPath",
    "compute_path_to_pose": "ComputePathToPose",
    "compute_path_through_poses": "ComputePathThroughPoses",
    "smooth_path": "SmoothPath",
    "spin": "Spin",
    "backup": "BackUp",
    "drive_on_heading": "DriveOnHeading",
    "assisted_teleop": "AssistedTeleop",
}


class BasicNavigator(Node):
    """A node that sends tasks to nav2.

    A task runs in the background until `isTaskComplete` returns True.

    Attributes:
        initial_pose: the initial pose of the robot, as set by the user.
        initial_pose_received: whether the localization has responded to the initial pose.
        feedback: the latest feedback of the task.
        status: the final status of the task (action_msgs/GoalStatus); None while it runs.
        goal_handle: the goal handle of the task.
        result_future: the future of the task's result.
    """

    def __init__(self, node_name: str = "basic_navigator", namespace: str = "") -> None:
        super().__init__(node_name=node_name, namespace=namespace)
        self.initial_pose: Any = get_message("geometry_msgs/msg/PoseStamped")()
        self.initial_pose.header.frame_id = "map"
        self.initial_pose_received = False
        self.goal_handle: Any = None
        self.result_future: Any = None
        self.feedback: Any = None
        self.status: int | None = None
        self._actions: dict[str, Any] = {}
        pose = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")
        self.localization_pose_sub = self.create_subscription(pose, "amcl_pose", self._amclPoseCallback, LATCHED_QOS)
        self.initial_pose_pub = self.create_publisher(pose, "initialpose", 10)

    def destroyNode(self) -> None:
        """Destroy the node."""
        self.destroy_node()

    # --- tasks --------------------------------------------------------------------------------------------------------

    def setInitialPose(self, initial_pose: Any) -> None:
        """Publish the initial pose of the robot (geometry_msgs/PoseStamped)."""
        self.initial_pose_received = False
        self.initial_pose = initial_pose
        self._setInitialPose()

    def goToPose(self, pose: Any, behavior_tree: str = "") -> bool:
        """Navigate to a pose, and return whether the goal was accepted."""
        return self._start_task("navigate_to_pose", pose=pose, behavior_tree=behavior_tree)

    def goThroughPoses(self, poses: Any, behavior_tree: str = "") -> bool:
        """Navigate through all poses in order, and return whether the goal was accepted."""
        return self._start_task("navigate_through_poses", poses=list(poses), behavior_tree=behavior_tree)

    def followWaypoints(self, poses: Any) -> bool:
        """Navigate to each pose and run the waypoint task there.

        Return whether the goal was accepted.
        """
        return self._start_task("follow_waypoints", poses=list(poses))

    def followPath(self, path: Any, controller_id: str = "", goal_checker_id: str = "") -> bool:
        """Follow a path, and return whether the goal was accepted."""
        return self._start_task("follow_path", path=path, controller_id=controller_id, goal_checker_id=goal_checker_id)

    def spin(self, spin_dist: float = 1.57, time_allowance: float = 10) -> bool:
        """Rotate in place by an angle in radians, and return whether the goal was accepted."""
        return self._start_task("spin", target_yaw=float(spin_dist), time_allowance=_to_duration(time_allowance))

    def backup(self, backup_dist: float = 0.15, backup_speed: float = 0.025, time_allowance: float = 10) -> bool:
        """Drive straight back, in m and m/s, and return whether the goal was accepted."""
        return self._drive_straight("backup", backup_dist, backup_speed, time_allowance)

    def driveOnHeading(self, dist: float = 0.15, speed: float = 0.025, time_allowance: float = 10) -> bool:
        """Drive straight ahead, in m and m/s, and return whether the goal was accepted."""
        return self._drive_straight("drive_on_heading", dist, speed, time_allowance)

    def assistedTeleop(self, time_allowance: float = 30) -> bool:
        """Allow teleoperation with collision avoidance, and return whether the goal was accepted."""
        return self._start_task("assisted_teleop", time_allowance=_to_duration(time_allowance))

    def cancelTask(self) -> None:
        """Cancel the current task, if there is one."""
        self.info("Canceling current task.")
        if self.result_future is not None:
            spin_until_future_complete(self, self.goal_handle.cancel_goal_async())

    def isTaskComplete(self) -> bool:
        """Wait at most 0.1 s for the current task to end.

        Returns:
            Whether the task has ended; also True if there is no task.
        """
        if self.result_future is None:
            return True
        spin_until_future_complete(self, self.result_future, timeout_sec=_SPIN_TIMEOUT_S)
        response = self.result_future.result() if self.result_future.done() else None
        if response is None:
            return False
        self.status = response.status
        if self.status != GoalStatus.SUCCEEDED:
            self.debug(f"Task with failed with status code: {self.status}")
        return True

    def getFeedback(self) -> Any:
        """Return the latest feedback of the task, or None if none has arrived."""
        return self.feedback

    def getResult(self) -> TaskResult:
        """Return the result of the task."""
        return _RESULTS_BY_STATUS.get(GoalStatus(self.status or 0), TaskResult.UNKNOWN)

    # --- waiting ------------------------------------------------------------------------------------------------------

    def waitUntilNav2Active(self, navigator: str = "bt_navigator", localizer: str = "amcl") -> None:
        """Wait until nav2 is active and the robot is localized."""
        if localizer != "robot_localization":
            self._waitForNodeToActivate(localizer)
        if localizer == "amcl":
            self._waitForInitialPose()
        self._waitForNodeToActivate(navigator)
        self.info("Nav2 is ready for use!")

    # --- plans --------------------------------------------------------------------------------------------------------

    def getPath(self, start: Any, goal: Any, planner_id: str = "", use_start: bool = False) -> Any:
        """Plan a path to a pose.

        Returns:
            The path (nav_msgs/Path), or None if planning failed.
        """
        request = {"start": start, "goal": goal, "planner_id": planner_id, "use_start": use_start}
        return getattr(self._run_to_result("compute_path_to_pose", **request), "path", None)

    def getPathThroughPoses(self, start: Any, goals: Any, planner_id: str = "", use_start: bool = False) -> Any:
        """Plan a path through several poses. See `getPath`."""
        request = {"start": start, "goals": list(goals), "planner_id": planner_id, "use_start": use_start}
        return getattr(self._run_to_result("compute_path_through_poses", **request), "path", None)

    def smoothPath(
        self, path: Any, smoother_id: str = "", max_duration: float = 2.0, check_for_collision: bool = False
    ) -> Any:
        """Return a smoothed path (nav_msgs/Path), or None if smoothing failed."""
        request = {"path": path, "smoother_id": smoother_id, "max_smoothing_duration": _to_duration(max_duration)}
        return getattr(
            self._run_to_result("smooth_path", **request, check_for_collisions=check_for_collision), "path", None
        )

    # --- maps and costmaps --------------------------------------------------------------------------------------------

    def changeMap(self, map_filepath: str) -> bool:
        """Load another map, and return whether it was loaded."""
        response = self._call_service("nav2_msgs/srv/LoadMap", "map_server/load_map", map_url=map_filepath)
        if response.result != response.RESULT_SUCCESS:
            self.error("Change map request failed!")
        return bool(response.result == response.RESULT_SUCCESS)

    def clearAllCostmaps(self) -> None:
        """Clear the local and the global costmap."""
        self.clearLocalCostmap()
        self.clearGlobalCostmap()

    def clearLocalCostmap(self) -> None:
        """Clear the local costmap."""
        self._call_service("nav2_msgs/srv/ClearEntireCostmap", "local_costmap/clear_entirely_local_costmap")

    def clearGlobalCostmap(self) -> None:
        """Clear the global costmap."""
        self._call_service("nav2_msgs/srv/ClearEntireCostmap", "global_costmap/clear_entirely_global_costmap")

    def getGlobalCostmap(self) -> Any:
        """Return the global costmap (nav2_msgs/Costmap)."""
        return self._call_service("nav2_msgs/srv/GetCostmap", "global_costmap/get_costmap").map

    def getLocalCostmap(self) -> Any:
        """Return the local costmap (nav2_msgs/Costmap)."""
        return self._call_service("nav2_msgs/srv/GetCostmap", "local_costmap/get_costmap").map

    # --- the lifecycle of nav2 ----------------------------------------------------------------------------------------

    def lifecycleStartup(self) -> None:
        """Start nav2 through the lifecycle managers."""
        self._manage_lifecycle("STARTUP")

    def lifecycleShutdown(self) -> None:
        """Shut nav2 down through the lifecycle managers."""
        self._manage_lifecycle("SHUTDOWN")

    # --- internals ----------------------------------------------------------------------------------------------------

    def _drive_straight(self, name: str, distance: float, speed: float, time_allowance: float) -> bool:
        target = get_message("geometry_msgs/msg/Point")(x=float(distance))
        return self._start_task(name, target=target, speed=float(speed), time_allowance=_to_duration(time_allowance))

    def _start_task(self, name: str, **goal: Any) -> bool:
        """Send the goal of a task without waiting for its result.

        Return whether the goal was accepted.
        """
        self.feedback, self.status, self.result_future = None, None, None
        self.goal_handle = self._send_goal(name, goal, self._feedbackCallback)
        if not self.goal_handle.accepted:
            self.error(f"{name} was rejected!")
            return False
        self.result_future = self.goal_handle.get_result_async()
        return True

    def _run_to_result(self, name: str, **goal: Any) -> Any:
        """Send a goal, wait for its result, and return it, or None unless the goal succeeded."""
        handle = self._send_goal(name, goal, None)
        if not handle.accepted:
            self.error(f"{name} was rejected!")
            return None
        future = handle.get_result_async()
        spin_until_future_complete(self, future)
        self.status = future.result().status
        if self.status != GoalStatus.SUCCEEDED:
            self.warn(f"{name} failed with status code: {self.status}")
            return None
        return future.result().result

    def _send_goal(self, name: str, goal: dict[str, Any], on_feedback: Any) -> Any:
        action_class = get_action(f"nav2_msgs/action/{_ACTION_TYPES[name]}")
        if name not in self._actions:
            self._actions[name] = ActionClient(self, action_class, name)
        client = self._actions[name]
        while not client.wait_for_server(timeout_sec=_LOG_PERIOD_S):
            self.info(f"'{name}' action server not available, waiting...")
        future = client.send_goal_async(action_class.Goal(**goal), on_feedback)
        spin_until_future_complete(self, future)
        return future.result()

    def _call_service(self, service_type: str, name: str, **request: Any) -> Any:
        service = get_service(service_type)
        client = self.create_client(service, name)
        try:
            while not client.wait_for_service(timeout_sec=_LOG_PERIOD_S):
                self.info(f"{name} service not available, waiting...")
            future = client.call_async(service.Request(**request))
            spin_until_future_complete(self, future)
            return future.result()
        finally:
            self.destroy_client(client)

    def _manage_lifecycle(self, command: str) -> None:
        service_type = "nav2_msgs/srv/ManageLifecycleNodes"
        command_code = getattr(get_service(service_type).Request, command)
        for name, types in self.get_service_names_and_types():
            if service_type in types:
                self._call_service(service_type, name, command=command_code)

    def _waitForNodeToActivate(self, node_name: str) -> None:
        state = "unknown"
        while state != _ACTIVE_STATE:
            state = self._call_service("lifecycle_msgs/srv/GetState", f"{node_name}/get_state").current_state.label
            self.debug(f"Result of get_state: {state}")
            if state != _ACTIVE_STATE:
                spin_once(self, timeout_sec=_SPIN_TIMEOUT_S)

    def _waitForInitialPose(self) -> None:
        while not self.initial_pose_received:
            self.info("Setting initial pose")
            self._setInitialPose()
            self.info("Waiting for amcl_pose to be received")
            spin_once(self, timeout_sec=_LOG_PERIOD_S)

    def _setInitialPose(self) -> None:
        message = get_message("geometry_msgs/msg/PoseWithCovarianceStamped")()
        message.pose.pose = self.initial_pose.pose
        message.header.frame_id = self.initial_pose.header.frame_id
        message.header.stamp = self.initial_pose.header.stamp
        self.initial_pose_pub.publish(message)

    def _amclPoseCallback(self, msg: Any) -> None:
        self.debug("Received amcl pose")
        self.initial_pose_received = True

    def _feedbackCallback(self, msg: Any) -> None:
        self.feedback = msg.feedback

    def info(self, msg: str) -> None:
        """Log an info message."""
        self.get_logger().info(msg)

    def warn(self, msg: str) -> None:
        """Log a warning."""
        self.get_logger().warning(msg)

    def error(self, msg: str) -> None:
        """Log an error."""
        self.get_logger().error(msg)

    def debug(self, msg: str) -> None:
        """Log a debug message."""
        self.get_logger().debug(msg)


def _to_duration(seconds: float) -> Any:
    return Duration(seconds=float(seconds)).to_msg()
