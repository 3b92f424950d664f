"""nav2's planner_server, which plans paths to poses.

The actions are ``compute_path_to_pose`` and ``compute_path_through_poses``.

The node has nav2's parameters, topics, logs and results, for Humble and Jazzy. All types of planners are accepted, but
they share one method (`linkwright.navigation.planning.planner`); a warning is logged for types that have another method
in nav2. A deliberate difference: a goal in an obstacle is rejected, however large the tolerance is.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import fields, replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from linkwright.graph import Graph
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.lifecycle.states import INACTIVE
from linkwright.graph.time.values import Duration
from linkwright.messages import get_message, get_service
from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL
from linkwright.navigation.costmaps.layered import Pose
from linkwright.navigation.nodes.costmap import CostmapNode, make_costmap
from linkwright.navigation.nodes.goals import GoalError, GoalServer
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.paths import path_message, pose_from_message, poses_from_messages
from linkwright.navigation.nodes.plugins import declare_unused, get_plugin_type, get_string_list
from linkwright.navigation.nodes.slices import WAIT, SlicedWork
from linkwright.navigation.planning.planner import PlanError, Settings, plan
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.parameter_tables import declare_table
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_NAVFN: Final = "nav2_navfn_planner/NavfnPlanner"
_DEFAULT_TYPES: Final = {"GridBased": _NAVFN}
_REPLACED_TYPES: Final = {
    "nav2_theta_star_planner/ThetaStarPlanner": Settings(),
    "nav2_smac_planner/SmacPlanner2D": Settings(tolerance=0.125),
    "nav2_smac_planner/SmacPlannerHybrid": Settings(tolerance=0.25),
    "nav2_smac_planner/SmacPlannerLattice": Settings(tolerance=0.25),
}
"""The planner types that NavFn's method replaces, with their default parameters."""

Poses = NDArray[np.float64]
Work = Generator[str | None, None, Any]


class PlannerNode(ManagedNode):
    """The managed node of planner_server.

    Attributes:
        costmap: the global costmap; set before the node is configured.
    """

    costmap: CostmapNode

    def declare(self) -> None:
        """Declare nav2's parameters that do not belong to a planner."""
        self.declare_parameter("expected_planner_frequency", 1.0)
        self.declare_parameter("action_server_result_timeout", 10.0)
        self.declare_parameter("costmap_update_timeout", 1.0)
        self._planners: dict[str, Settings] = {}
        self._work: dict[str, SlicedWork] = {}

    def configure(self) -> None:
        """Create the planners, the costmap, the action servers and the service.

        Raises:
            LinkwrightError: NODE431, a planner has no type.
        """
        self._planners = {
            name: self._create_planner(name) for name in get_string_list(self, "planner_plugins", ["GridBased"])
        }
        self.get_logger().info(f"Planner Server has {' '.join(self._planners)}  planners available.")
        if self.get_parameter("expected_planner_frequency").value <= 0.0:
            self.get_logger().warning(
                "The expected planner frequency parameter is 0 Hz or less: slow plans cause no warning"
            )
        self.costmap.trigger_configure()
        self._path_publisher = self.register(self.create_publisher(get_message("nav_msgs/msg/Path"), "plan", 1))
        self._create_action_server("ComputePathToPose", "compute_path_to_pose", self._plan_to_pose)
        self._create_action_server("ComputePathThroughPoses", "compute_path_through_poses", self._plan_through_poses)
        service_class = get_service("nav2_msgs/srv/IsPathValid")
        self.register(self.create_service(service_class, "is_path_valid", self._on_is_path_valid))

    def activate(self) -> None:
        """Activate the costmap, and accept goals."""
        self.costmap.trigger_activate()

    def deactivate(self) -> None:
        """Stop planning, deactivate the costmap, and refuse goals."""
        self._stop()
        if self.costmap.is_active:
            self.costmap.trigger_deactivate()

    def cleanup(self) -> None:
        """Stop planning, and clean up the costmap."""
        self._stop()
        if self.costmap.lifecycle_state == INACTIVE:
            self.costmap.trigger_cleanup()

    # --- planners -----------------------------------------------------------------------------------------------------

    def _create_planner(self, name: str) -> Settings:
        kind = get_plugin_type(self, name, _DEFAULT_TYPES)
        settings = declare_table(self, Settings, name, _REPLACED_TYPES.get(kind))
        if kind != _NAVFN:
            declare_unused(self, name)
            self.get_logger().warning(
                f"{kind} is not supported: plans of '{name}' are computed like those of NavFn, in all directions and "
                "without regard to the turning radius"
            )
        self.get_logger().info(f"Created global planner plugin {name} of type {kind}")
        return settings

    def _choose_planner(self, name: str) -> tuple[str, Settings]:
        if not name and len(self._planners) == 1:
            name = next(iter(self._planners))
        if name not in self._planners:
            planner_names = " ".join(self._planners)
            self.get_logger().error(f"planner {name} is not a valid planner. Planner names are: {planner_names}")
            raise GoalError("INVALID_PLANNER", f"Planner id {name} is invalid")
        names = [field.name for field in fields(Settings)]
        current_values = {parameter: self.get_parameter(f"{name}.{parameter}").value for parameter in names}
        return name, replace(self._planners[name], **current_values)

    # --- goals --------------------------------------------------------------------------------------------------------

    def _create_action_server(self, action_type: str, name: str, work: Callable[[Any], Work]) -> None:
        """Create an action server that plans paths.

        `work` returns the generator that computes the path for a request.
        """

        def begin(goal: ServerGoalHandle) -> None:
            self._stop(name)
            began_ns = self.now_ns()

            def on_done(poses: Any, error: Exception | None) -> None:
                del self._work[name]
                self._finish(server, poses, error, began_ns)

            self._work[name] = SlicedWork(self, work(goal.request), lambda: not server.is_canceled, on_done)

        server = self.register(GoalServer(self, f"nav2_msgs/action/{action_type}", name, begin))

    def _finish(self, server: GoalServer, poses: Any, error: Exception | None, began_ns: int) -> None:
        if isinstance(error, GoalError):
            server.abort(error.code, str(error))
        elif error is not None:
            self.get_logger().error(f"planning failed: {error!r}")
            server.abort("UNKNOWN", str(error))
        elif poses is None:
            self.get_logger().info("Goal was canceled. Canceling planning action.")
            server.end_canceled()
        else:
            path = path_message(poses, self.costmap.global_frame, self.get_clock().now().to_msg())
            self._path_publisher.publish(path)
            duration_ns = self.now_ns() - began_ns
            self._warn_if_slow(duration_ns / NANOSECONDS_PER_SECOND)
            server.succeed(path=path, planning_time=Duration(nanoseconds=duration_ns).to_msg())

    def _warn_if_slow(self, seconds: float) -> None:
        frequency = self.get_parameter("expected_planner_frequency").value
        if frequency > 0.0 and seconds > 1.0 / frequency:
            self.get_logger().warning(
                f"Planner loop missed its desired rate of {frequency:.4f} Hz. "
                f"Current loop rate is {1.0 / seconds:.4f} Hz"
            )

    def _stop(self, *names: str) -> None:
        """Stop planning for the named actions, or for all actions if no name is given."""
        for name in names or tuple(self._work):
            work = self._work.pop(name, None)
            if work is not None:
                work.stop()

    # --- planning -----------------------------------------------------------------------------------------------------

    def _plan_to_pose(self, request: Any) -> Work:
        yield from self._wait_until_current()
        start, goal = self._find_start_pose(request), self._pose_in_costmap(request.goal)
        return (yield from self._plan(start, goal, request.planner_id))

    def _plan_through_poses(self, request: Any) -> Work:
        yield from self._wait_until_current()
        goals = getattr(request.goals, "poses", request.goals)
        if not len(goals):
            raise GoalError("NO_VIAPOINTS_GIVEN", "No viapoints given")
        start = self._find_start_pose(request)
        paths = []
        for goal in goals:
            path = yield from self._plan(start, self._pose_in_costmap(goal), request.planner_id)
            paths.append(path)
            start = (float(path[-1, 0]), float(path[-1, 1]), float(path[-1, 2]))
        return np.concatenate(paths)

    def _wait_until_current(self) -> Work:
        timeout_ns = self.get_parameter("costmap_update_timeout").value * NANOSECONDS_PER_SECOND
        began_ns = self.now_ns()
        while not self.costmap.is_current:
            if self.now_ns() - began_ns > timeout_ns:
                raise GoalError("TIMEOUT", "Costmap timed out waiting for update")
            yield WAIT

    def _plan(self, start: Pose, goal: Pose, planner: str) -> Work:
        name, settings = self._choose_planner(planner)
        try:
            return (yield from plan(self.costmap.costmap.copy(), start, goal, settings))
        except PlanError as error:
            self.get_logger().warning(
                f"{name} plugin failed to plan from ({start[0]:.2f}, {start[1]:.2f}) "
                f'to ({goal[0]:.2f}, {goal[1]:.2f}): "{error}"'
            )
            raise GoalError(error.problem.value, str(error)) from None

    def _find_start_pose(self, request: Any) -> Pose:
        if request.use_start:
            return self._pose_in_costmap(request.start)
        pose = self.costmap.find_robot_pose()
        if pose is None:
            raise GoalError("TF_ERROR", "Unable to get start pose")
        return pose

    def _pose_in_costmap(self, stamped: Any) -> Pose:
        pose = self.costmap.transform_pose(pose_from_message(stamped), stamped.header.frame_id)
        if pose is None:
            raise GoalError("TF_ERROR", "Unable to transform poses to global frame")
        return pose

    # --- the service --------------------------------------------------------------------------------------------------

    def _on_is_path_valid(self, request: Any, response: Any) -> Any:
        """Report whether a path is collision-free from the robot's position onward."""
        poses = poses_from_messages(request.path.poses)
        robot_pose = self.costmap.find_robot_pose() if self.is_active else None
        response.is_valid = bool(len(poses))
        if not len(poses) or robot_pose is None:
            return response
        first_index = int(np.argmin(np.hypot(poses[:, 0] - robot_pose[0], poses[:, 1] - robot_pose[1])))
        poses_ahead = poses[first_index:]
        if self.costmap.uses_radius:
            costs = self.costmap.costmap.cost_at(poses_ahead[:, :2], outside_cost=LETHAL)
            is_invalid = (costs == LETHAL) | (costs == INSCRIBED)
        else:
            is_invalid = self.costmap.costmap.compute_footprint_cost(poses_ahead, self.costmap.footprint) == LETHAL
        response.invalid_pose_indices = [first_index + int(index) for index in np.flatnonzero(is_invalid)]
        response.is_valid = not is_invalid.any()
        return response


class PlannerServer(ManagedServer):
    """The running planner_server node, with its costmap."""

    DEFAULT_NAME = "planner_server"
    NODE = PlannerNode
    _node: PlannerNode

    def prepare(self, graph: Graph, options: NodeOptions) -> None:
        """Create the costmap."""
        self._node.costmap = make_costmap(self._node, graph, options, "global_costmap")

    def close(self) -> None:
        """Close the server and its costmap."""
        super().close()
        self._node.costmap.destroy_node()
