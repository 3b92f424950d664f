"""The display of Autoware's planning factors: walls where a module stops or slows the vehicle."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from linkwright.messages import get_message
from linkwright.rviz.config.schema import PropertySpec, length_spec, topic_spec
from linkwright.rviz.displays.marker import MessageMarkersDisplay
from linkwright.rviz.displays.message_drawing import (
    Marker,
    Rgba,
    compute_yaw,
    make_marker,
    make_pose,
    make_text,
)

_Factor = get_message("autoware_internal_planning_msgs/msg/PlanningFactor")
_RED: Rgba = (1.0, 0.0, 0.0, 0.5)
_YELLOW: Rgba = (1.0, 1.0, 0.0, 0.5)
_WHITE: Rgba = (1.0, 1.0, 1.0, 0.999)
_WALLS = {
    _Factor.STOP: ("stop wall", _RED),
    _Factor.SLOW_DOWN: ("slow down wall", _YELLOW),
    _Factor.UNKNOWN: ("slow down wall", _YELLOW),
}
_WALL_SIZE_M = (0.1, 5.0, 2.0)
_SAFE: Rgba = (0.0, 0.902, 0.463, 0.999)
_UNSAFE: Rgba = (1.0, 0.239, 0.0, 0.999)
_GRAY: Rgba = (0.741, 0.741, 0.741, 0.999)
_TARGET_HEIGHT_M = 2.0
_RING = np.linspace(0, 2 * math.pi, 21)
_SHOW_SAFETY = "Show Safety Factors"
_FRONT, _REAR = "BaseLink to Front", "BaseLink to Rear"


class PlanningFactorDisplay(MessageMarkersDisplay):
    """A display of the points at which a module of the planner stops or slows the vehicle, and of the reasons.

    RViz asks a node for the distances from the rear axle to the bumpers; here they are properties.
    """

    CLASS = "tier4_planning_factor_rviz_plugin/PlanningFactorRvizPlugin"
    MESSAGE = "autoware_internal_planning_msgs/msg/PlanningFactorArray"
    SCHEMA = (
        topic_spec(description=MESSAGE),
        PropertySpec(_SHOW_SAFETY, "bool", False, "Mark the points that the module judged: green is safe."),
        length_spec(_FRONT, 0.0, "Distance from the control point to the front bumper, in meters."),
        length_spec(_REAR, 0.0, "Distance from the control point to the rear bumper, in meters."),
    )

    def markers(self, message: Any) -> Iterator[Any]:
        """Return the walls and the points that were judged."""
        number = 0
        for factor in message.factors:
            wall = _WALLS.get(factor.behavior)
            for point in factor.control_points if wall else ():
                assert wall is not None
                yield from self._make_wall(*wall, number, factor, point.pose)
                number += 1
            if self.properties.flag(_SHOW_SAFETY):
                for safety in factor.safety_factors.factors:
                    for point in safety.points:
                        color = _SAFE if safety.is_safe else _UNSAFE
                        yield from _make_target(number, (point.x, point.y, point.z), color, factor.module)
                        number += 1

    def _make_wall(self, namespace: str, color: Rgba, number: int, factor: Any, pose: Any) -> Iterator[Any]:
        distance = self.properties.number(_FRONT if factor.is_driving_forward else _REAR)
        distance *= 1.0 if factor.is_driving_forward else -1.0
        yaw = compute_yaw(pose.orientation)
        x = pose.position.x + distance * math.cos(yaw)
        y, z = pose.position.y + distance * math.sin(yaw), pose.position.z
        middle = make_pose((x, y, z + _WALL_SIZE_M[2] / 2), yaw)
        yield make_marker(namespace, number, Marker.CUBE, color, scale=_WALL_SIZE_M, pose=middle)
        text = f"{factor.module} ({factor.detail})" if factor.detail else factor.module
        yield make_text(f"{namespace} text", number, text, (x, y, z + 2.5), 1.0, _WHITE)


def _make_target(number: int, point: tuple[float, float, float], color: Rgba, module: str) -> Iterator[Any]:
    """Return an arrow that points down at a point, two circles around it, and the module's name."""
    x, y, z = point
    z += _TARGET_HEIGHT_M
    arrow = [(x, y, z + 1.0), (x, y, z)]
    yield make_marker("safety arrow", number, Marker.ARROW, color, scale=(0.25, 0.5, 0.5), points=arrow)
    for name, radius in (("safety circle 1", 0.5), ("safety circle 2", 0.75)):
        ring = np.stack([x + radius * np.cos(_RING), y + radius * np.sin(_RING), np.full(21, z + 0.75)], axis=1)
        yield make_marker(name, number, Marker.LINE_STRIP, color, scale=(0.1, 0, 0), points=ring)
    yield make_text("safety text", number, module, (x, y, z + 1.5), 0.5, _GRAY)
