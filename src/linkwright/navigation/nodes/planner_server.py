"""nav2's planner_server, which plans paths for ``compute_path_to_pose`` and ``compute_path_through_poses``.

Parameters, topics, texts and results are those of nav2, Humble and Jazzy. All types of planners are accepted, but they
share one method (`linkwright.navigation.planning.planner`); a line is logged for types that have another method in
nav2. A deliberate difference: a goal in an obstacle is refused however large the tolerance is.
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
from linkwright.navigation.nodes.paths import path_message, pose_of, poses_of
from linkwright.navigation.nodes.plugins import declare_unused, string_list, type_of
from linkwright.navigation.nodes.slices import WAIT, SlicedWork
from linkwright.navigation.planning.planner import PlanError, Settings, plan
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.parameter_tables import declared
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_NAVFN: Final = "nav2_navfn_planner/NavfnPlanner"
_USUAL: Final = {"GridBased": _NAVFN}
_OTHERS: Final = {
    "nav2_theta_star_planner/ThetaStarPlanner": Settings(),
    "nav2_smac_planner/SmacPlanner2D": Settings(tolerance=0.125),
    "nav2_smac_planner/SmacPlannerHybrid": Settings(tolerance=0.25),
    "nav2_smac_planner/SmacPlannerLattice": Settings(tolerance=0.25),
}
"""The types whose work NavFn's method does, with their default parameters."""

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
        self._planners = {name: self._planner(name) for name in string_list(self, "planner_plugins", ["GridBased"])}
        self.get_logger().info(f"Planner Server has {' '.join(self._planners)}  planners available.")
        if self.get_parameter("expected_planner_frequency").value <= 0.0:
            self.get_logger().warning(
                "The expected planner frequency parameter is 0 Hz or less: slow plans cause no warning"
            )
        self.costmap.trigger_configure()
        self._plans = self.register(self.create_publisher(get_message("nav_msgs/msg/Path"), "plan", 1))
        self._offer("ComputePathToPose", "compute_path_to_pose", self._plan_to_pose)
        self._offer("ComputePathThroughPoses", "compute_path_through_poses", self._plan_through_poses)
        kind = get_service("nav2_msgs/srv/IsPathValid")
        self.register(self.create_service(kind, "is_path_valid", self._on_is_path_valid))

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

    def _planner(self, name: str) -> Settings:
        kind = type_of(self, name, _USUAL)
        settings = declared(self, Settings, name, _OTHERS.get(kind))
        if kind != _NAVFN:
            declare_unused(self, name)
            self.get_logger().warning(
                f"{kind} is not supported: plans of '{name}' are computed like those of NavFn, in all directions and "
                "without regard to the turning radius"
            )
        self.get_logger().info(f"Created global planner plugin {name} of type {kind}")
        return settings

    def _chosen(self, name: str) -> tuple[str, Settings]:
        if not name and len(self._planners) == 1:
            name = next(iter(self._planners))
        if name not in self._planners:
            known = " ".join(self._planners)
            self.get_logger().error(f"planner {name} is not a valid planner. Planner names are: {known}")
            raise GoalError("INVALID_PLANNER", f"Planner id {name} is invalid")
        names = [field.name for field in fields(Settings)]
        now = {parameter: self.get_parameter(f"{name}.{parameter}").value for parameter in names}
        return name, replace(self._planners[name], **now)

    # --- goals --------------------------------------------------------------------------------------------------------

    def _offer(self, kind: str, name: str, work: Callable[[Any], Work]) -> None:
        """Offer an action whose paths are computed by the generator that `work` returns."""

        def begin(goal: ServerGoalHandle) -> None:
            self._stop(name)
            began_ns = self.now_ns()

            def done(poses: Any, error: Exception | None) -> None:
                del self._work[name]
                self._finish(server, poses, error, began_ns)

            self._work[name] = SlicedWork(self, work(goal.request), lambda: not server.is_canceled, done)

        server = self.register(GoalServer(self, f"nav2_msgs/action/{kind}", name, begin))

    def _finish(self, server: GoalServer, poses: Any, error: Exception | None, began_ns: int) -> None:
        if isinstance(error, GoalError):
            server.abort(error.code, str(error))
        elif error is not None:
            self.get_logger().error(f"planning failed: {error!r}")
            server.abort("UNKNOWN", str(error))
        elif poses is None:
            self.get_logger().info("Goal was canceled. Canceling planning action.")
            server.canceled()
        else:
            path = path_message(poses, self.costmap.global_frame, self.get_clock().now().to_msg())
            self._plans.publish(path)
            took_ns = self.now_ns() - began_ns
            self._warn_if_slow(took_ns / NANOSECONDS_PER_SECOND)
            server.succeed(path=path, planning_time=Duration(nanoseconds=took_ns).to_msg())

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
        start, goal = self._start_of(request), self._placed(request.goal)
        return (yield from self._planned(start, goal, request.planner_id))

    def _plan_through_poses(self, request: Any) -> Work:
        yield from self._wait_until_current()
        goals = getattr(request.goals, "poses", request.goals)
        if not len(goals):
            raise GoalError("NO_VIAPOINTS_GIVEN", "No viapoints given")
        start = self._start_of(request)
        parts = []
        for goal in goals:
            part = yield from self._planned(start, self._placed(goal), request.planner_id)
            parts.append(part)
            start = (float(part[-1, 0]), float(part[-1, 1]), float(part[-1, 2]))
        return np.concatenate(parts)

    def _wait_until_current(self) -> Work:
        timeout_ns = self.get_parameter("costmap_update_timeout").value * NANOSECONDS_PER_SECOND
        began_ns = self.now_ns()
        while not self.costmap.is_current:
            if self.now_ns() - began_ns > timeout_ns:
                raise GoalError("TIMEOUT", "Costmap timed out waiting for update")
            yield WAIT

    def _planned(self, start: Pose, goal: Pose, planner: str) -> Work:
        name, settings = self._chosen(planner)
        try:
            return (yield from plan(self.costmap.costmap.copy(), start, goal, settings))
        except PlanError as error:
            self.get_logger().warning(
                f"{name} plugin failed to plan from ({start[0]:.2f}, {start[1]:.2f}) "
                f'to ({goal[0]:.2f}, {goal[1]:.2f}): "{error}"'
            )
            raise GoalError(error.problem.value, str(error)) from None

    def _start_of(self, request: Any) -> Pose:
        if request.use_start:
            return self._placed(request.start)
        pose = self.costmap.robot_pose()
        if pose is None:
            raise GoalError("TF_ERROR", "Unable to get start pose")
        return pose

    def _placed(self, stamped: Any) -> Pose:
        pose = self.costmap.pose_of(pose_of(stamped), stamped.header.frame_id)
        if pose is None:
            raise GoalError("TF_ERROR", "Unable to transform poses to global frame")
        return pose

    # --- the service --------------------------------------------------------------------------------------------------

    def _on_is_path_valid(self, request: Any, response: Any) -> Any:
        """Report whether a path is collision-free from the robot's position onward."""
        poses = poses_of(request.path.poses)
        here = self.costmap.robot_pose() if self.is_active else None
        response.is_valid = bool(len(poses))
        if not len(poses) or here is None:
            return response
        first = int(np.argmin(np.hypot(poses[:, 0] - here[0], poses[:, 1] - here[1])))
        ahead = poses[first:]
        if self.costmap.uses_radius:
            costs = self.costmap.costmap.cost_at(ahead[:, :2], outside=LETHAL)
            bad = (costs == LETHAL) | (costs == INSCRIBED)
        else:
            bad = self.costmap.costmap.footprint_cost(ahead, self.costmap.footprint) == LETHAL
        response.invalid_pose_indices = [first + int(index) for index in np.flatnonzero(bad)]
        response.is_valid = not bad.any()
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
