"""Nav2's docking server: it drives to a dock (``dock_robot``), and leaves it (``undock_robot``).

Differences: the path to a dock is not checked against a costmap, so let a collision_monitor stop the robot; plugins of
docks are SimpleChargingDock and SimpleNonChargingDock.

Source: opennav_docking (parameters, topics, actions, defaults, messages of errors).
"""

from __future__ import annotations

from collections.abc import Generator
from math import hypot, pi
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import normalized, rpy_from_quaternion
from linkwright.graph import ActionClient, ParameterType
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.time.values import Duration
from linkwright.messages import get_action, get_service
from linkwright.messages.distribution import is_before_iron
from linkwright.navigation.following.smooth_control import SmoothControl
from linkwright.navigation.nodes.docking.docks import (
    Dock,
    SimpleDock,
    create_dock_plugins,
    find_pose_in_robot,
    find_relative_pose,
    make_pose,
    read_dock_file,
    read_docks,
)
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedServer
from linkwright.navigation.nodes.plugins import get_or_declare
from linkwright.navigation.nodes.steps import Step, StepError, StepNode
from linkwright.navigation.slam.poses import FloatArray, compose, inverse, wrap_angles
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.settings import check_positive
from linkwright.nodes.velocity_topic import VelocityTopic
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_PROJECTION_M = 0.25
"""How far behind the dock the robot aims, so that it does not turn on the last centimeters."""
_NAVIGATING, _PERCEIVING, _CONTROLLING, _WAITING = 1, 2, 3, 4
"""States of DockRobot's feedback."""
_UNUSED_PARAMETERS: dict[str, bool | float | str] = {
    "controller.use_collision_detection": True,
    "controller.costmap_topic": "local_costmap/costmap_raw",
    "controller.footprint_topic": "local_costmap/published_footprint",
    "controller.transform_tolerance": 0.1,
    "controller.projection_time": 5.0,
    "controller.simulation_time_step": 0.1,
    "controller.dock_collision_threshold": 0.3,
}
_CONTROL_NAMES = (
    "k_phi",
    "k_delta",
    "beta",
    "lambda",
    "v_linear_min",
    "v_linear_max",
    "v_angular_max",
    "slowdown_radius",
)


class DockingNode(StepNode):
    """The managed node of the docking server."""

    def declare(self) -> None:
        """Declare the parameters."""
        for name, default in (
            ("controller_frequency", 50.0),
            ("initial_perception_timeout", 5.0),
            ("wait_charge_timeout", 5.0),
            ("dock_approach_timeout", 30.0),
            ("undock_linear_tolerance", 0.05),
            ("undock_angular_tolerance", 0.05),
            ("max_retries", 3),
            ("base_frame", "base_link"),
            ("fixed_frame", "odom"),
            ("dock_backwards", False),
            ("dock_prestaging_tolerance", 0.5),
            ("navigator_bt_xml", ""),
            ("action_server_result_timeout", 10.0),
            *_UNUSED_PARAMETERS.items(),
        ):
            self.declare_parameter(name, default)
        self._publishes_stamped: bool | None = self.declare_parameter(
            "enable_stamped_cmd_vel", ParameterType.BOOL
        ).value
        self._docked_kind = ""
        self._state = self._retry_count = self._start_ns = 0
        self._has_succeeded = False

    def configure(self) -> None:
        """Read the parameters, and create the docks and the action servers.

        Raises:
            LinkwrightError: a parameter or a dock is not valid.
        """
        self._period = 1.0 / check_positive(self, "controller_frequency", self._value("controller_frequency"))
        defaults = SmoothControl()
        gains = {}
        for name in _CONTROL_NAMES:
            attribute = "lambda_" if name == "lambda" else name
            value = float(get_or_declare(self, f"controller.{name}", getattr(defaults, attribute)))
            gains[attribute] = check_positive(self, f"controller.{name}", value) if "radius" in name else value
        self._control = SmoothControl(**gains)
        self._poses = FramePoses(self, "Transform error:")
        self._plugins = create_dock_plugins(self, self._poses, self._value("base_frame"))
        self._docks = read_docks(self)
        self._output = VelocityTopic(self, "cmd_vel", self._publishes_stamped)
        package = "opennav_docking_msgs" if is_before_iron() else "nav2_msgs"
        self._navigation = self.register(ActionClient(self, "nav2_msgs/action/NavigateToPose", "navigate_to_pose"))
        self._dock_server = self.register(
            GoalServer(self, f"{package}/action/DockRobot", "dock_robot", self._start_docking)
        )
        self._undock_server = self.register(
            GoalServer(self, f"{package}/action/UndockRobot", "undock_robot", self._start_undocking)
        )
        service = "ReloadDatabase" if is_before_iron() else "ReloadDockDatabase"
        self.register(
            self.create_service(get_service(f"{package}/srv/{service}"), "~/reload_database", self._on_reload)
        )

    def cleanup(self) -> None:
        """Stop the execution, and remove the output topic."""
        super().cleanup()
        if hasattr(self, "_output"):
            self._output.close()
            del self._output

    def publish_feedback(self, server: GoalServer) -> None:
        """Publish the state of docking as feedback."""
        if server is self._dock_server:
            elapsed = Duration(nanoseconds=self.now_ns() - self._start_ns).to_msg()
            server.publish_feedback(state=self._state, docking_time=elapsed, num_retries=self._retry_count)

    def result(self) -> dict[str, Any]:
        """Return the fields of the result."""
        result: dict[str, Any] = {"success": self._has_succeeded}
        if self._server is self._dock_server:
            result["num_retries"] = self._retry_count
        return result

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _on_reload(self, request: Any, response: Any) -> Any:
        try:
            self._docks = read_dock_file(Path(request.filepath))
            response.success = True
        except LinkwrightError as error:
            self.log_error(error)
            response.success = False
        return response

    # --- goals --------------------------------------------------------------------------------------------------------

    def _start_docking(self, goal: ServerGoalHandle) -> None:
        self._begin(self._dock_server, self._dock(goal.request))

    def _start_undocking(self, goal: ServerGoalHandle) -> None:
        self._begin(self._undock_server, self._undock(goal.request))

    def _begin(self, server: GoalServer, work: Step) -> None:
        self._has_succeeded, self._retry_count, self._state, self._start_ns = False, 0, 0, self.now_ns()
        self.work_on(server, self._stop_at_the_end(work), self._period)

    def _stop_at_the_end(self, work: Step) -> Step:
        """Do the work, and stop the robot when it ends, fails or is canceled."""
        try:
            yield from work
            self._has_succeeded = True
        finally:
            self._drive(0.0, 0.0)

    def _dock(self, goal: Any) -> Step:
        dock = self._find_dock(goal)
        plugin = self._find_plugin(dock.kind)
        self._state = _NAVIGATING
        staging = plugin.find_staging_pose(dock.frame, dock.pose)
        robot = self._find_robot(dock.frame)
        offset = robot - staging
        offset[2] = wrap_angles(offset)[2]
        if not goal.navigate_to_staging_pose or np.linalg.norm(offset) < self._value("dock_prestaging_tolerance"):
            self.get_logger().info("Robot already within pre-staging pose tolerance for dock")
        else:
            yield from self._navigate(dock.frame, staging, goal.max_staging_time)
            self.get_logger().info("Successful navigation to staging pose")
        fixed = str(self._value("fixed_frame"))
        frame_in_fixed = find_relative_pose(self._poses, fixed, dock.frame)
        if frame_in_fixed is None:
            raise StepError("UNKNOWN", f"Transform error: there is no transform from {dock.frame} to {fixed}")
        pose = compose(frame_in_fixed, dock.pose)
        self._state = _PERCEIVING
        pose = yield from self._perceive(plugin, fixed, pose)
        self.get_logger().info("Successful initial dock detection")
        while True:
            try:
                yield from self._approach(plugin, fixed, pose)
                self.get_logger().info("Made contact with dock, waiting for charge to start")
                yield from self._wait_for_charge(plugin)
            except StepError as failure:
                self._retry_count += 1
                if self._retry_count > self._value("max_retries"):
                    self._retry_count -= 1
                    self.get_logger().error("Failed to dock, all retries have been used")
                    raise
                self.get_logger().warning(f"Docking failed, will retry: {failure}")
            else:
                break
            self._state = _PERCEIVING
            in_fixed = compose(frame_in_fixed, plugin.find_staging_pose(dock.frame, dock.pose))
            yield from self._drive_to(fixed, in_fixed, self._value("dock_approach_timeout"), "resetting dock approach")
            self.get_logger().info("Returned to staging pose, attempting docking again")
        self._docked_kind = dock.kind
        self.get_logger().info("Robot is charging!" if plugin.charges else "Robot has docked!")

    def _undock(self, goal: Any) -> Step:
        kind = goal.dock_type or self._docked_kind
        if not kind and len(self._plugins) > 1:
            raise StepError("DOCK_NOT_VALID", "No dock information to undock from!")
        plugin = self._find_plugin(kind)
        self.get_logger().info(f"Attempting to undock robot from charger of type {kind or next(iter(self._plugins))}.")
        fixed = str(self._value("fixed_frame"))
        staging = plugin.find_staging_pose(fixed, self._find_robot(fixed))
        yield from self._drive_to(fixed, staging, goal.max_undocking_time, "undocking")
        self.get_logger().info("Robot has reached staging pose")
        if plugin.is_charging():
            raise StepError("FAILED_TO_CONTROL", "Failed to control off dock, still charging")
        self._docked_kind = ""
        self.get_logger().info("Robot has undocked!")

    def _find_dock(self, goal: Any) -> Dock:
        if goal.use_dock_id:
            self.get_logger().info(f"Attempting to dock robot at charger {goal.dock_id}.")
            if goal.dock_id not in self._docks:
                raise StepError("DOCK_NOT_IN_DB", f"Dock ID requested is not in database: '{goal.dock_id}'")
            return self._docks[goal.dock_id]
        position, orientation = goal.dock_pose.pose.position, goal.dock_pose.pose.orientation
        yaw = rpy_from_quaternion(normalized(orientation.x, orientation.y, orientation.z, orientation.w))[2]
        return Dock(goal.dock_pose.header.frame_id or "map", np.array((position.x, position.y, yaw)), goal.dock_type)

    def _find_plugin(self, kind: str) -> SimpleDock:
        """Return the plugin with a name; an empty name is that of the only one."""
        if not kind and len(self._plugins) == 1:
            return next(iter(self._plugins.values()))
        if kind not in self._plugins:
            raise StepError("DOCK_NOT_VALID", f"Dock requested has no valid plugin: '{kind}'")
        return self._plugins[kind]

    # --- parts of docking ---------------------------------------------------------------------------------------------

    def _navigate(self, frame: str, staging: FloatArray, seconds: float) -> Step:
        goal = get_action("nav2_msgs/action/NavigateToPose").Goal()
        goal.pose = make_pose(frame, staging, self.get_clock().now().to_msg())
        goal.behavior_tree = self._value("navigator_bt_xml")
        deadline_ns = self._deadline(seconds)
        work = self.run_remote_goal(self._navigation, goal, "Navigation request to staging pose failed")
        try:
            for _ in work:
                if self.now_ns() > deadline_ns:
                    break
                yield
            else:
                return
        except StepError as failure:
            raise StepError("FAILED_TO_STAGE", str(failure)) from None
        finally:
            work.close()
        raise StepError("FAILED_TO_STAGE", "Navigation request to staging pose timed out")

    def _perceive(self, plugin: SimpleDock, fixed: str, pose: FloatArray) -> Generator[None, None, FloatArray]:
        deadline_ns = self._deadline(self._value("initial_perception_timeout"))
        while True:
            refined = plugin.refine_pose(fixed, pose)
            if refined is not None:
                return refined
            if self.now_ns() > deadline_ns:
                raise StepError("FAILED_TO_DETECT_DOCK", "Failed initial dock detection")
            yield

    def _approach(self, plugin: SimpleDock, fixed: str, pose: FloatArray) -> Step:
        self._state = _CONTROLLING
        deadline_ns = self._deadline(self._value("dock_approach_timeout"))
        backward = bool(self._value("dock_backwards"))
        while not (plugin.is_docked() or plugin.is_charging()):
            refined = plugin.refine_pose(fixed, pose)
            if refined is None:
                raise StepError("FAILED_TO_DETECT_DOCK", "Failed dock detection")
            pose = refined
            behind = compose(pose, np.array((_PROJECTION_M, 0.0, pi if backward else 0.0)))
            self._drive_towards(fixed, behind, backward=backward)
            if self.now_ns() > deadline_ns:
                reason = "Timed out approaching dock; dock nor charging detected"
                raise StepError("FAILED_TO_CONTROL", reason)
            yield

    def _wait_for_charge(self, plugin: SimpleDock) -> Step:
        self._drive(0.0, 0.0)
        self._state = _WAITING
        deadline_ns = self._deadline(self._value("wait_charge_timeout"))
        while plugin.charges and not plugin.is_charging():
            if self.now_ns() > deadline_ns:
                raise StepError("FAILED_TO_CHARGE", "Timed out waiting for charge to start")
            yield

    def _drive_to(self, frame: str, pose: FloatArray, seconds: float, activity: str) -> Step:
        """Drive away from the dock to a pose."""
        deadline_ns = self._deadline(seconds)
        while True:
            offset = compose(inverse(self._find_robot(frame)), pose)
            is_near = hypot(offset[0], offset[1]) < self._value("undock_linear_tolerance")
            if is_near and abs(offset[2]) < self._value("undock_angular_tolerance"):
                return
            self._drive_towards(frame, pose, backward=not self._value("dock_backwards"))
            if self.now_ns() > deadline_ns:
                raise StepError("FAILED_TO_CONTROL", f"Timed out {activity}")
            yield

    def _drive_towards(self, frame: str, pose: FloatArray, *, backward: bool) -> None:
        target = find_pose_in_robot(self._poses, self._value("base_frame"), frame, pose)
        if target is None:
            raise StepError("FAILED_TO_CONTROL", "Failed to get control")
        x, y, yaw = target.tolist()
        self._drive(*self._control.find_velocity((x, y, yaw), backward=backward))

    def _drive(self, speed: float, rotation: float) -> None:
        self._output.publish((speed, 0.0, 0.0), (0.0, 0.0, rotation))

    def _find_robot(self, frame: str) -> FloatArray:
        base = self._value("base_frame")
        pose = find_relative_pose(self._poses, frame, base)
        if pose is None:
            raise StepError("UNKNOWN", f"Transform error: there is no transform from {base} to {frame}")
        return pose

    def _deadline(self, seconds: float) -> int:
        return self.now_ns() + round(seconds * NANOSECONDS_PER_SECOND)


class DockingServer(ManagedServer):
    """The running docking server."""

    DEFAULT_NAME = "docking_server"
    NODE = DockingNode
