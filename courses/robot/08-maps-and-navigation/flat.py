"""What the checks of the lesson share: the flat, mbot in it, and nodes with the learner's parameters."""

import math
from functools import cache

import numpy as np

from linkwright import SteppedSimulation
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import LogLevel
from linkwright.learning import NotYet
from linkwright.navigation.maps.map_files import load_map
from linkwright.navigation.nodes.amcl import Amcl
from linkwright.navigation.nodes.behavior_server import BehaviorServer
from linkwright.navigation.nodes.bt_navigator import BtNavigator
from linkwright.navigation.nodes.controller_server import ControllerServer
from linkwright.navigation.nodes.map_server import MapServer
from linkwright.navigation.nodes.planner_server import PlannerServer
from linkwright.nodes import NodeOptions

PACKAGE, CONFIG, MAP = "my_navigation", "config/navigation.yaml", "maps/flat.yaml"
BODY = 0.2
BOXES = (
    *((-1.55, 0.5, 0.1, 4.2), (4.55, 0.5, 0.1, 4.2), (1.5, -1.55, 6.0, 0.1), (1.5, 2.55, 6.0, 0.1)),
    *((1.5, -0.45, 0.1, 2.1), (1.5, 2.1, 0.1, 0.8), (-1.2, 2.0, 0.6, 1.0), (3.1, 0.2, 0.8, 0.6)),
)
"""x, y, length and width of walls and furniture, in m, as in flat.world."""


def gap(position):
    """Return the distance from a position to the nearest wall or piece of furniture, in m."""
    x, y = position
    return min(math.hypot(max(abs(x - a) - c / 2, 0), max(abs(y - b) - d / 2, 0)) for a, b, c, d in BOXES)


def read_parameters(work, file, *names):
    """Return the parameters of a node in a YAML file, with nested names joined by dots.

    Args:
        work: the learner's workspace.
        file: the path of the file in the package.
        names: the name of the node, or of a costmap twice.
    """
    path = work.package(PACKAGE).file(file)
    found = work.package(PACKAGE).yaml(file)
    place = " / ".join(names)
    for level, name in enumerate((*names, "ros__parameters")):
        if isinstance(found, dict) and isinstance(found.get(name), dict):
            found = found[name]
            continue
        if name == "ros__parameters":
            raise NotYet(
                en=f"In {path.name}, ros__parameters, with two underscores, is missing below {place}.",
                zh=f"{path.name} 中，{place} 的下一层缺少 ros__parameters（有两个下划线）。",
            )
        if level:
            raise NotYet(
                en=f"{path.name} needs the name '{name}' twice: once at the left margin, and below it, indented.",
                zh=f"{path.name} 中，“{name}”要写两次：一次在最左边，一次在它的下一层（缩进）。",
            )
        others = ", ".join(map(str, found)) if isinstance(found, dict) else "-"
        raise NotYet(
            en=f"{path.name} has no '{name}' at the left margin; it has: {others}.",
            zh=f"{path.name} 的最左边没有“{name}”；它有：{others}。",
        )
    return flatten(found)


def flatten(nested, prefix=""):
    """Return nested parameters by names with dots."""
    flat = {}
    for name, value in nested.items():
        flat.update(flatten(value, f"{prefix}{name}.") if isinstance(value, dict) else {prefix + name: value})
    return flat


class Flat(SteppedSimulation):
    """The flat, mbot, and nodes of nav2 with the learner's parameters.

    Args:
        work: the learner's workspace.
        start: the x, y and yaw at which mbot begins.
        navigates: whether there are planner and controller besides map_server and amcl.
    """

    def __init__(self, work, *, start=(0.0, 0.0, 0.0), navigates=True):
        x, y, yaw = start
        robot = work.package("my_robot_description").file("urdf/mbot_sim.xacro")
        world = work.package("my_flat").file("worlds/flat.world")
        super().__init__(world, robot, pose=(x, y, 0, 0, 0, yaw), robot_state_publisher=True, period=0.02)
        self._work = work
        self._navigates = navigates
        self._options = {"amcl": self._read("amcl")}
        if navigates:
            self._options |= {name: self._read(name) for name in ("bt_navigator", "behavior_server")}
            self._options["planner_server"] = self._read("planner_server", "global_costmap")
            self._options["controller_server"] = self._read("controller_server", "local_costmap")
        self.smallest_gap = math.inf

    def _read(self, name, costmap=""):
        parameters = read_parameters(self._work, CONFIG, name)
        options = NodeOptions(parameters={**parameters, "use_sim_time": True, "autostart_node": True})
        if costmap:
            for key, value in read_parameters(self._work, CONFIG, costmap, costmap).items():
                options.parameters_of_others.set(f"/{costmap}/{costmap}", key, value)
        return options

    def __enter__(self):
        super().__enter__()
        path = str(self._work.package(PACKAGE).file(MAP))
        parameters = {"yaml_filename": path, "use_sim_time": True, "autostart_node": True}
        MapServer(self.graph, NodeOptions(parameters=parameters))
        self.estimates = self.record("/amcl_pose", "geometry_msgs/msg/PoseWithCovarianceStamped")
        Amcl(self.graph, self._options["amcl"])
        if self._navigates:
            PlannerServer(self.graph, self._options["planner_server"])
            ControllerServer(self.graph, self._options["controller_server"])
            BehaviorServer(self.graph, self._options["behavior_server"])
            BtNavigator(self.graph, self._options["bt_navigator"])
        self.watch(3.0)
        self._begin = len(self.log)
        return self

    @property
    def place(self):
        """The true x, y and yaw of mbot."""
        pose = self.robot_pose()
        return pose[0], pose[1], rpy_from_quaternion(pose[3:])[2]

    def watch(self, seconds):
        """Advance, and note how near mbot comes to walls and furniture."""
        for _ in range(round(seconds / 0.1)):
            self.advance(0.1)
            self.smallest_gap = min(self.smallest_gap, gap(self.place[:2]))

    def last_warning(self):
        """Return the last warning or error of a node, with its name; empty if there is none.

        While the nodes start, they warn of what is not there yet; then only errors count.
        """
        late = [record for record in self.log[self._begin :] if record.level >= LogLevel.WARN]
        found = late or [record for record in self.log[: self._begin] if record.level >= LogLevel.ERROR]
        return f"{found[-1].node}: {found[-1].text}" if found else ""

    def has_goal(self):
        """Return whether bt_navigator got a goal."""
        return any(record.text.startswith("Begin navigating") for record in self.log)


@cache
def read_map(work):
    """Return the learner's map."""
    return load_map(work.package(PACKAGE).file(MAP))


def wall_points():
    """Return points on the walls that mbot's laser can see, in the frame of the map."""
    points = []
    for x in np.arange(-0.8, 4.45, 0.1):
        points += [(x, -1.5), (x, 2.5)] if abs(x - 1.5) > 0.15 else []
    for y in np.arange(-1.4, 1.4, 0.1):
        points += [(-1.5, y), (4.5, y)]
    return np.array(points)


def free_points():
    """Return points of both rooms that are free."""
    grid = np.stack(np.meshgrid(np.arange(-1.4, 4.45, 0.1), np.arange(-1.4, 2.45, 0.1)), -1).reshape(-1, 2)
    return np.array([point for point in grid if gap(point) > 0.15])
