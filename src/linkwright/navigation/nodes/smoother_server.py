"""nav2's smoother_server, which smooths paths for the action ``smooth_path``.

The node has nav2's parameters, topics and results, for Humble and Jazzy. All types of smoothers are accepted, but they
share the method of nav2's simple smoother; a warning is logged for types that have another method in nav2.
"""

from __future__ import annotations

from dataclasses import fields
from typing import Any, Final

import numpy as np

from linkwright.graph import LATCHED_QOS
from linkwright.graph.actions.goal import ServerGoalHandle
from linkwright.graph.time.values import Duration
from linkwright.messages import get_message
from linkwright.navigation.costmaps.costmap import INSCRIBED, LETHAL, Costmap
from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.nodes.costmap_conversion import costmap_from_message
from linkwright.navigation.nodes.goals import GoalServer
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.navigation.nodes.paths import path_message, poses_from_messages
from linkwright.navigation.nodes.plugins import declare_unused, get_plugin_type, get_string_list
from linkwright.navigation.planning.smoothing import Smoothing, compute_directions, smooth_path
from linkwright.nodes.parameter_tables import declare_table

_SIMPLE: Final = "nav2_smoother/SimpleSmoother"
_DEFAULT_TYPES: Final = {"simple_smoother": _SIMPLE}


class SmootherNode(ManagedNode):
    """The managed node of smoother_server."""

    def declare(self) -> None:
        """Declare nav2's parameters that do not belong to a smoother."""
        self.declare_parameter("costmap_topic", "global_costmap/costmap_raw")
        self.declare_parameter("footprint_topic", "global_costmap/published_footprint")
        self.declare_parameter("robot_base_frame", "base_link")
        self.declare_parameter("transform_tolerance", 0.1)
        self.declare_parameter("action_server_result_timeout", 10.0)

    def configure(self) -> None:
        """Create the smoothers, the publisher, the subscriptions and the action server.

        Raises:
            LinkwrightError: NODE431, a smoother has no type; NAV101, SciPy is not installed.
        """
        load_scipy("linalg")
        self._costmap: Costmap | None = None
        names = get_string_list(self, "smoother_plugins", ["simple_smoother"])
        for name in names:
            self._declare_smoother(name)
        self._smoothers = names
        self.get_logger().info(f"Smoother Server has {' '.join(names)}  smoothers available.")
        costmap_type, path = get_message("nav2_msgs/msg/Costmap"), get_message("nav_msgs/msg/Path")
        topic = self.get_parameter("costmap_topic").value
        self.register(self.create_subscription(costmap_type, topic, self._on_costmap, LATCHED_QOS))
        self._output = self.register(self.create_publisher(path, "plan_smoothed", 1))
        self._goals = self.register(GoalServer(self, "nav2_msgs/action/SmoothPath", "smooth_path", self._smooth))

    def _declare_smoother(self, name: str) -> None:
        kind = get_plugin_type(self, name, _DEFAULT_TYPES)
        declare_table(self, Smoothing, name)
        declare_unused(self, name)
        if kind != _SIMPLE:
            self.get_logger().warning(f"{kind} is not supported: '{name}' smooths as {_SIMPLE} does")
        self.get_logger().info(f"Created smoother : {name} of type {kind}")

    def _on_costmap(self, message: Any) -> None:
        self._costmap = costmap_from_message(message)

    def _smooth(self, goal: ServerGoalHandle) -> None:
        request, began_ns = goal.request, self.get_clock().now().nanoseconds
        self.get_logger().info("Received a path to smooth.")
        name = request.smoother_id or (self._smoothers[0] if len(self._smoothers) == 1 else "")
        if name not in self._smoothers:
            self._fail("INVALID_SMOOTHER", f"Invalid Smoother: {name}")
        elif not len(request.path.poses):
            self._fail("INVALID_PATH", "Requested path to smooth is invalid")
        elif self._costmap is None:
            self._fail("FAILED_TO_SMOOTH_PATH", "Costmap is not available")
        else:
            values = {field.name: self.get_parameter(f"{name}.{field.name}").value for field in fields(Smoothing)}
            poses = poses_from_messages(request.path.poses)
            points, _ = smooth_path(poses[:, :2], Smoothing(**values), self._costmap)
            poses = np.column_stack((points, compute_directions(points, poses[-1, 2])))
            path = path_message(poses, request.path.header.frame_id, request.path.header.stamp)
            self._output.publish(path)
            self._finish(request, path, poses, began_ns)

    def _finish(self, request: Any, path: Any, poses: Any, began_ns: int) -> None:
        assert self._costmap is not None, "a goal is accepted only with a costmap"
        duration = Duration(nanoseconds=self.get_clock().now().nanoseconds - began_ns).to_msg()
        if request.check_for_collisions:
            costs = self._costmap.cost_at(poses[:, :2], outside_cost=LETHAL)
            collision_indices = np.flatnonzero((costs == LETHAL) | (costs == INSCRIBED))
            if len(collision_indices):
                x, y, yaw = poses[collision_indices[0]]
                self._fail("SMOOTHED_PATH_IN_COLLISION", f"Smoothed Path collided at X: {x:f} Y: {y:f} Theta: {yaw:f}")
                return
        self._goals.succeed(path=path, smoothing_duration=duration, was_completed=True)

    def _fail(self, code: str, reason: str) -> None:
        self.get_logger().error(reason)
        self._goals.abort(code, reason)


class SmootherServer(ManagedServer):
    """The running smoother_server node."""

    NODE = SmootherNode
    DEFAULT_NAME = "smoother_server"
