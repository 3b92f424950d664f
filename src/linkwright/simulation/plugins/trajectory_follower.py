"""A model that follows waypoints: ``gz-sim-trajectory-follower-system``.

The torque turns the link until it faces the next waypoint in the plane. Then the force pushes it forward, along its x
axis, until it is close to the waypoint. The force acts at the origin of the link.

Source: gz-sim (parameters, defaults, topic, waypoints of lines and circles).
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from math import atan2, copysign, cos, degrees, hypot, pi, sin
from typing import Any

from linkwright.diagnostics import phrase
from linkwright.geometry.single import quaternion_inverse, rotate
from linkwright.simulation.plugins.parameters import parameter
from linkwright.simulation.plugins.plugin import SimulatedPlugin
from linkwright.xmltree import Element

_CIRCLE_CORNER_COUNT = 8
_AT_REST = (0.0, 0.0, 0.0)

Point = tuple[float, float]
"""A point of the horizontal plane of the world, in m."""


@dataclass(frozen=True, kw_only=True)
class TrajectoryFollowerParameters:
    """Parameters of ``gz-sim-trajectory-follower-system``."""

    link_name: str = parameter()
    loop: bool = False
    force: float = 60.0
    torque: float = 50.0
    range_tolerance: float = 0.5
    bearing_tolerance: float = 2.0
    zero_vel_on_bearing_reached: bool = False
    topic: str = ""


class GzTrajectoryFollower(SimulatedPlugin[TrajectoryFollowerParameters]):
    """The substitute for ``gz-sim-trajectory-follower-system``.

    ``<waypoints>`` lists waypoints; ``<line>`` and ``<circle>`` place them relative to the initial pose of the link. A
    ``std_msgs/msg/Bool`` pauses the motion.
    """

    PARAMETERS = TrajectoryFollowerParameters
    IGNORED = ("waypoints", "line", "circle")  # read by _read_waypoints
    CARRIED = ("_waypoints", "_is_paused")

    def start(self) -> None:
        """Find the link and the waypoints, and subscribe to the pauses.

        Raises:
            LinkwrightError: SIM133, there is no such link; SIM160, a waypoint, line or circle is not valid.
        """
        self._link = self.link(self.parameters.link_name)
        self.simulation.keep_awake(self._link)
        self.reset()
        topic = self.parameters.topic or f"/model/{self.context.path}/trajectory_follower/pause"
        self.node.subscribe("std_msgs/msg/Bool", topic, self._on_pause)
        self.every(0.0, self._follow)

    def reset(self) -> None:
        """Start again at the first waypoint."""
        self._is_paused = False
        self._waypoints = deque(self._read_waypoints())

    def _read_waypoints(self) -> list[Point]:
        element = self.context.element
        waypoints, circle, line = (
            None if element is None else element.first(tag) for tag in ("waypoints", "circle", "line")
        )
        if waypoints is not None:
            return [self._read_point(child) for child in waypoints.elements("waypoint")]
        pose = self.simulation.link_pose(self._link)
        if circle is not None:
            radius = self.number_in(circle, "radius")
            angles = [2 * pi * index / _CIRCLE_CORNER_COUNT for index in range(_CIRCLE_CORNER_COUNT)]
            return [(pose[0] + radius * cos(angle), pose[1] + radius * sin(angle)) for angle in angles]
        if line is not None:
            direction, length = self.number_in(line, "direction"), self.number_in(line, "length")
            x, y, _ = rotate(pose[3:], (length * cos(direction), length * sin(direction), 0.0))
            return [pose[:2], (pose[0] + x, pose[1] + y)]
        return []

    def _read_point(self, waypoint: Element) -> Point:
        try:
            x, y = (float(word) for word in waypoint.text().split())
        except ValueError as error:
            raise self.parameter_error(
                phrase("plugin '{plugin}': <waypoint> needs two numbers, x and y", plugin=self.context.name)
            ) from error
        return x, y

    def _on_pause(self, message: Any) -> None:
        self._is_paused = bool(message.data)

    def _follow(self) -> None:
        parameters, simulation = self.parameters, self.simulation
        pose = simulation.link_pose(self._link)
        force = torque = 0.0
        if self._waypoints and not self._is_paused:
            x, y = self._waypoints[0]
            to_waypoint = rotate(quaternion_inverse(pose[3:]), (x - pose[0], y - pose[1], 0.0))
            bearing = degrees(atan2(to_waypoint[1], to_waypoint[0]))
            if hypot(*to_waypoint) <= parameters.range_tolerance:
                self._choose_next_waypoint()
            elif abs(bearing) <= parameters.bearing_tolerance:
                force = parameters.force
                if parameters.zero_vel_on_bearing_reached and abs(bearing) <= 0.5 * parameters.bearing_tolerance:
                    self._stop_turning()
            else:
                torque = copysign(parameters.torque, bearing)
        axes = pose[3:]
        self.push(self._link, rotate(axes, (force, 0.0, 0.0)), rotate(axes, (0.0, 0.0, torque)), at=pose[:3])

    def _choose_next_waypoint(self) -> None:
        """Choose the next waypoint.

        The last waypoint remains, so that the model returns to it if it is moved.
        """
        if self.parameters.loop:
            self._waypoints.rotate(-1)
        elif len(self._waypoints) > 1:
            self._waypoints.popleft()

    def _stop_turning(self) -> None:
        simulation, model = self.simulation, self.context.path
        if simulation.moves_freely(model):
            linear, _ = simulation.link_velocity(self.first_link)
            simulation.set_model_velocity(model, (linear[0], linear[1], linear[2]), _AT_REST)
