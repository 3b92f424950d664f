"""The handles with which the page drags the tips of a planning group, and an object of the planning scene."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt
from typing import Any

from linkwright.geometry.single import Transform
from linkwright.messages import get_message
from linkwright.page.files import MeshIndex
from linkwright.page.protocol.markers import InteractiveMarkerShape
from linkwright.planning.page.groups import Tip
from linkwright.planning.page.move_group import make_pose
from linkwright.rviz.displays.moveit.robot import JointPositions, PosableRobot
from linkwright.rviz.markers.interactive import read_interactive_marker

_SHARE_OF_REACH = 0.2
_MIN_SIZE_M, _MAX_SIZE_M = 0.05, 1.0
_BALL_SHARE = 0.4
"""The diameter of the ball in the middle of a handle, relative to the handle's size."""

_HALF = 1.0 / sqrt(2.0)
_AXES = {"x": (_HALF, 0.0, 0.0, _HALF), "y": (0.0, 0.0, _HALF, _HALF), "z": (0.0, _HALF, 0.0, _HALF)}
"""Orientations as x, y, z, w whose x axis is one of the axes, as in interactive markers."""

_MOVE_AXIS, _ROTATE_AXIS, _MOVE_ROTATE_3D = 3, 5, 9
_SPHERE = 2


def name_handle(query: str, tip: Tip) -> str:
    """Return the name of the handle of a tip in the start or goal state."""
    return f"{query} {tip.link}"


def name_object_handle(name: str) -> str:
    """Return the name of the handle of an object of the planning scene."""
    return f"object {name}"


def choose_size(robot: PosableRobot, link: str, size: float) -> float:
    """Return the size of a handle in meters.

    Args:
        robot: the robot.
        link: the tip of the arm.
        size: the size that the user chose; 0 for a fifth of the arm's reach.
    """
    if size > 0.0:
        return size
    return min(max(_SHARE_OF_REACH * robot.compute_reach(link), _MIN_SIZE_M), _MAX_SIZE_M)


def make_handle(
    name: str, frame: str, pose: Transform, size: float, color: Sequence[float], index: MeshIndex
) -> InteractiveMarkerShape:
    """Return a handle that moves along and turns about three axes, with a ball that moves in the plane of the screen.

    Args:
        name: the name of the handle.
        frame: the frame of the pose.
        pose: the pose of the handle.
        size: its size in meters.
        color: red, green, blue of the ball.
        index: finds the files of markers; the handle has none.
    """
    message = get_message("visualization_msgs/msg/InteractiveMarker")()
    message.header.frame_id, message.name, message.scale = frame, name, size
    message.pose = make_pose(pose)
    for axis, orientation in _AXES.items():
        for kind, mode in (("rotate", _ROTATE_AXIS), ("move", _MOVE_AXIS)):
            message.controls.append(_make_control(f"{kind}_{axis}", mode, orientation))
    ball = _make_control("move_freely", _MOVE_ROTATE_3D, (0.0, 0.0, 0.0, 1.0))
    ball.markers = [_make_ball(size * _BALL_SHARE, color)]
    message.controls.append(ball)
    return read_interactive_marker(message, index, lambda _reference, _frame: pose, transparent=True)


def describe_place(robot: PosableRobot, state: JointPositions, tip: Tip) -> tuple[str, Transform]:
    """Return the frame and the pose of a tip in a state."""
    return robot.frame_of(state), robot.link_poses(state)[tip.link]


def _make_control(name: str, mode: int, orientation: Sequence[float]) -> Any:
    control = get_message("visualization_msgs/msg/InteractiveMarkerControl")()
    control.name, control.interaction_mode = name, mode
    rotation = control.orientation
    rotation.x, rotation.y, rotation.z, rotation.w = map(float, orientation)
    return control


def _make_ball(diameter: float, color: Sequence[float]) -> Any:
    marker = get_message("visualization_msgs/msg/Marker")()
    marker.type = _SPHERE
    marker.scale.x = marker.scale.y = marker.scale.z = diameter
    marker.color.r, marker.color.g, marker.color.b = map(float, color)
    marker.color.a = 0.5
    marker.pose.orientation.w = 1.0
    return marker
