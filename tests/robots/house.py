"""mbot in the house with nav2's servers, all in one thread, in lock-step.

The servers use the parameters of my_robot_navigation.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import yaml

from linkwright.graph import ActionClient
from linkwright.graph.actions.goal import GoalStatus
from linkwright.messages import get_action
from linkwright.nodes import NodeOptions
from linkwright.navigation.nodes.amcl import Amcl
from linkwright.navigation.nodes.behavior_server import BehaviorServer
from linkwright.navigation.nodes.bt_navigator import BtNavigator
from linkwright.navigation.nodes.controller_server import ControllerServer
from linkwright.navigation.nodes.map_server import MapServer
from linkwright.navigation.nodes.planner_server import PlannerServer
from linkwright.testing import SteppedSimulation
from tests.places import GAZEBO_PACKAGE, NAVIGATION_PACKAGE

WORLD = GAZEBO_PACKAGE / "worlds" / "house.world"
ROBOT = "package://my_robot_description/urdf/mbot_gazebo.xacro"
STEP_S = 0.1


def flatten_parameters(nested: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """Return parameters by dotted names."""
    parameters: dict[str, Any] = {}
    for name, value in nested.items():
        parameters.update(flatten_parameters(value, f"{prefix}{name}.") if isinstance(value, dict) else {prefix + name: value})
    return parameters


class House(SteppedSimulation):
    """The house, mbot in its middle, and the servers."""

    def __init__(self) -> None:
        super().__init__(WORLD, ROBOT, arguments={"laser": True}, robot_state_publisher=True, period=0.02)
        self._told = yaml.safe_load((NAVIGATION_PACKAGE / "config" / "nav2_params.yaml").read_text())
        self.touched: set[str] = set()

    def __enter__(self) -> House:
        super().__enter__()
        MapServer(self.graph, self._options("map_server", yaml_filename=str(GAZEBO_PACKAGE / "maps" / "house.yaml")))
        Amcl(self.graph, self._options("amcl"))
        PlannerServer(self.graph, self._options("planner_server", "global_costmap"))
        ControllerServer(self.graph, self._options("controller_server", "local_costmap"))
        BehaviorServer(self.graph, self._options("behavior_server"))
        BtNavigator(self.graph, self._options("bt_navigator"))
        self._kind = get_action("nav2_msgs/action/NavigateToPose")
        self._client = ActionClient(self.node, self._kind, "navigate_to_pose")
        self.advance_and_watch(3.0)
        return self

    def _options(self, name: str, costmap: str = "", **parameters: Any) -> NodeOptions:
        file_parameters = flatten_parameters(self._told[name]["ros__parameters"])
        options = NodeOptions(parameters={**file_parameters, "autostart_node": True, **parameters})
        if costmap:
            for key, value in flatten_parameters(self._told[costmap][costmap]["ros__parameters"]).items():
                options.parameters_of_others.set(f"/{costmap}/{costmap}", key, value)
        return options

    def advance_and_watch(self, seconds: float) -> None:
        """Advance the time, and record the contacts of mbot's body and wheels.

        Contacts with the ground are left out.
        """
        for _ in range(round(seconds / STEP_S)):
            self.advance(STEP_S)
            model, data = self.simulation.model, self.simulation.data
            for first, second in np.array(data.contact.geom[: data.ncon]).reshape(-1, 2):
                names = [str(model.geom(int(geometry)).name) for geometry in (first, second)]
                if any("mbot" in name for name in names):
                    other = next((name for name in names if "mbot" not in name), "itself")
                    if not any(surface in other for surface in ("ground", "floor")):
                        self.touched.add(other)

    def send(self, x: float, y: float, yaw: float = 0.0) -> list[Any]:
        """Send mbot to a pose; the list gets the result, the handle of the goal is `goal`."""
        goal = self._kind.Goal()
        goal.pose.header.frame_id = "map"
        goal.pose.pose.position.x, goal.pose.pose.position.y = float(x), float(y)
        goal.pose.pose.orientation.z, goal.pose.pose.orientation.w = math.sin(yaw / 2), math.cos(yaw / 2)
        results: list[Any] = []

        def accepted(future: Any) -> None:
            self.goal = future.result()
            self.goal.get_result_async().add_done_callback(lambda response: results.append(response.result()))

        self._client.send_goal_async(goal).add_done_callback(accepted)
        return results

    def go_to(self, x: float, y: float, yaw: float = 0.0, *, seconds: float = 120.0) -> GoalStatus:
        """Navigate to a pose, and return the result."""
        results = self.send(x, y, yaw)
        for _ in range(round(seconds)):
            self.advance_and_watch(1.0)
            if results:
                return GoalStatus(results[0].status)
        return GoalStatus.EXECUTING

    def place(self) -> tuple[float, float]:
        """Return mbot's true position."""
        x, y, *_ = self.robot_pose()
        return x, y

    def logged(self) -> list[str]:
        """Return the log of the nodes."""
        return [record.text for record in self.log]
