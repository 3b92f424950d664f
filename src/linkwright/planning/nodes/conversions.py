"""Conversions between MoveIt's messages and the values of the planner."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from linkwright.geometry.arrays import Array, compose
from linkwright.geometry.shapes import Box, Cylinder, Sphere
from linkwright.graph.time.values import Duration
from linkwright.messages import get_message
from linkwright.planning.cartesian import ArcPoint
from linkwright.planning.goals import Goal, JointTarget, LinkTarget
from linkwright.planning.robot_model import PlacedShape
from linkwright.planning.shapes import hull_corners
from linkwright.planning.timing import Trajectory
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_BOX, _SPHERE, _CYLINDER, _CONE = 1, 2, 3, 4
_CONE_CORNERS = 24
_PLANE_SIZE_M = 10.0
"""The edge of the box that represents an infinite plane."""

FrameLookup = Callable[[str], Array]
"""Returns the pose of a frame in the frame of the robot's root link, shape (7,).

It raises UnknownFrameError.
"""


class RequestError(Exception):
    """Raised for a request that cannot be handled.

    Attributes:
        code: the name of the error code in moveit_msgs/msg/MoveItErrorCodes.
    """

    def __init__(self, code: str, reason: str) -> None:
        super().__init__(reason)
        self.code = code


class UnknownFrameError(RequestError):
    """Raised for a frame that neither the robot nor tf knows.

    Attributes:
        frame: the name of the frame.
    """

    def __init__(self, frame: str) -> None:
        super().__init__("FRAME_TRANSFORM_FAILURE", f"there is no frame '{frame}'")
        self.frame = frame


class InvalidShapeError(ValueError):
    """Raised for a shape that cannot be used.

    The message gives the reason.
    """


def pose_row(message: Any) -> Array:
    """Return the pose of a geometry_msgs/msg/Pose, shape (7,).

    A quaternion of zeros is the identity.
    """
    position, rotation = message.position, message.orientation
    quaternion = np.array((rotation.x, rotation.y, rotation.z, rotation.w))
    length = float(np.linalg.norm(quaternion))
    quaternion = quaternion / length if length > 0.0 else np.array((0.0, 0.0, 0.0, 1.0))
    return np.array((position.x, position.y, position.z, *quaternion))


def pose_message(row: Array) -> Any:
    """Return a geometry_msgs/msg/Pose of a pose of shape (7,)."""
    message = get_message("geometry_msgs/msg/Pose")()
    message.position.x, message.position.y, message.position.z = map(float, row[:3])
    rotation = message.orientation
    rotation.x, rotation.y, rotation.z, rotation.w = map(float, row[3:])
    return message


def shapes_of(message: Any) -> list[PlacedShape]:
    """Return the shapes of a CollisionObject or BoundingVolume, in its own frame.

    Raises:
        InvalidShapeError: a size is not positive, a mesh has no volume, or a pose is missing.
    """
    shapes = [
        PlacedShape(_convert_primitive(primitive), pose_row(pose))
        for primitive, pose in _with_poses(message.primitives, message.primitive_poses)
    ]
    for mesh, pose in _with_poses(message.meshes, message.mesh_poses):
        points = np.array([(point.x, point.y, point.z) for point in mesh.vertices])
        corners = hull_corners(points) if len(points) else None
        if corners is None:
            raise InvalidShapeError("a mesh has no volume")
        shapes.append(PlacedShape(corners, pose_row(pose)))
    for plane, pose in _with_poses(getattr(message, "planes", ()), getattr(message, "plane_poses", ())):
        shapes.append(_convert_plane(plane, pose_row(pose)))
    return shapes


def _with_poses(shapes: Sequence[Any], poses: Sequence[Any]) -> list[tuple[Any, Any]]:
    """Pair shapes with their poses; without poses, all are at the origin."""
    if not poses:
        identity = get_message("geometry_msgs/msg/Pose")()
        return [(shape, identity) for shape in shapes]
    if len(shapes) != len(poses):
        raise InvalidShapeError(f"there are {len(shapes)} shapes and {len(poses)} poses")
    return list(zip(shapes, poses, strict=True))


def _convert_primitive(primitive: Any) -> Box | Sphere | Cylinder | Array:
    kind, sizes = primitive.type, [float(size) for size in primitive.dimensions]
    if not all(size > 0.0 and np.isfinite(size) for size in sizes):
        raise InvalidShapeError("a size is not positive")
    if kind == _BOX and len(sizes) == 3:
        return Box((sizes[0], sizes[1], sizes[2]))
    if kind == _SPHERE and len(sizes) == 1:
        return Sphere(sizes[0])
    if kind in (_CYLINDER, _CONE) and len(sizes) == 2:
        height, radius = sizes
        return Cylinder(radius, height) if kind == _CYLINDER else _make_cone(height, radius)
    raise InvalidShapeError(f"a primitive of type {kind} with {len(sizes)} sizes is not supported")


def _make_cone(height: float, radius: float) -> Array:
    angles = np.linspace(0.0, 2.0 * np.pi, _CONE_CORNERS, endpoint=False)
    rim = np.column_stack((radius * np.cos(angles), radius * np.sin(angles), np.full_like(angles, -height / 2.0)))
    return np.concatenate((rim, [(0.0, 0.0, height / 2.0)]))


def _convert_plane(plane: Any, pose: Array) -> PlacedShape:
    """Return a box that fills the side of a plane below its normal."""
    a, b, c, d = map(float, plane.coef)
    normal = np.array((a, b, c))
    length = float(np.linalg.norm(normal))
    if not length > 0.0:
        raise InvalidShapeError("a plane has no normal")
    normal /= length
    helper = np.eye(3)[int(np.argmin(np.abs(normal)))]
    first = np.cross(normal, helper)
    first /= np.linalg.norm(first)
    second = np.cross(normal, first)
    half = _PLANE_SIZE_M / 2.0
    edges = [x * half * first + y * half * second for x in (-1, 1) for y in (-1, 1)]
    top = -d / length * normal
    corners = np.array([top + edge - depth * normal for edge in edges for depth in (0.0, 0.5)])
    return PlacedShape(corners, pose)


def goal_from_constraints(message: Any, lookup: FrameLookup, default_link: str | None) -> Goal:
    """Return the goal of a moveit_msgs/msg/Constraints.

    A position and an orientation of the same link become one target. Visibility constraints are left out.

    Args:
        message: the constraints.
        lookup: returns the poses of frames.
        default_link: the link of constraints that name none.

    Raises:
        UnknownFrameError: a frame is not known.
        InvalidShapeError: a region has an invalid shape.
    """
    joints = {
        joint.joint_name: JointTarget(joint.position, abs(joint.tolerance_above), abs(joint.tolerance_below))
        for joint in message.joint_constraints
    }
    targets: dict[str, LinkTarget] = {}
    for position in message.position_constraints:
        link = position.link_name or default_link or ""
        frame = lookup(position.header.frame_id)
        region = position.constraint_region
        regions = [PlacedShape(item.shape, compose(frame, item.pose)) for item in shapes_of(region)]
        offset = position.target_point_offset
        targets[link] = LinkTarget(link, regions, np.array((offset.x, offset.y, offset.z)))
    for orientation in message.orientation_constraints:
        link = orientation.link_name or default_link or ""
        frame = lookup(orientation.header.frame_id)
        rotation = orientation.orientation
        quaternion = compose(frame, np.array((0.0, 0.0, 0.0, rotation.x, rotation.y, rotation.z, rotation.w)))[3:]
        previous = targets.get(link)
        targets[link] = LinkTarget(
            link,
            previous.regions if previous else (),
            previous.offset if previous else np.zeros(3),
            quaternion / np.linalg.norm(quaternion),
            np.array(
                (
                    orientation.absolute_x_axis_tolerance,
                    orientation.absolute_y_axis_tolerance,
                    orientation.absolute_z_axis_tolerance,
                )
            ),
        )
    return Goal(joints, tuple(targets.values()))


def arc_point_from_constraints(message: Any, lookup: FrameLookup) -> ArcPoint:
    """Return the center or the interim point in the path constraints of a request for Pilz' ``CIRC``.

    Args:
        message: a moveit_msgs/msg/Constraints.
        lookup: returns the poses of frames.

    Raises:
        RequestError: the constraints do not define a point.
        UnknownFrameError: the frame of the point is not known.
    """
    if message.name not in ("center", "interim"):
        raise RequestError(
            "INVALID_MOTION_PLAN", f"CIRC needs path constraints named 'center' or 'interim', not '{message.name}'"
        )
    poses = [pose for item in message.position_constraints[:1] for pose in item.constraint_region.primitive_poses]
    if not poses:
        raise RequestError("INVALID_MOTION_PLAN", f"the path constraint '{message.name}' of CIRC has no position")
    row = compose(lookup(message.position_constraints[0].header.frame_id), pose_row(poses[0]))
    if not np.all(np.isfinite(row)):
        raise RequestError("INVALID_MOTION_PLAN", f"the position of '{message.name}' is not a number")
    return ArcPoint(row[:3], message.name == "center")


def joint_state_message(names: Sequence[str], positions: Array, frame: str = "") -> Any:
    """Return a sensor_msgs/msg/JointState."""
    message = get_message("sensor_msgs/msg/JointState")()
    message.header.frame_id = frame
    message.name, message.position = list(names), [float(position) for position in positions]
    return message


def trajectory_message(names: Sequence[str], trajectory: Trajectory, frame: str) -> Any:
    """Return a moveit_msgs/msg/RobotTrajectory."""
    message = get_message("moveit_msgs/msg/RobotTrajectory")()
    joint_trajectory = message.joint_trajectory
    joint_trajectory.header.frame_id = frame
    joint_trajectory.joint_names = list(names)
    point_class = get_message("trajectory_msgs/msg/JointTrajectoryPoint")
    for time, positions, velocities, accelerations in zip(
        trajectory.times, trajectory.positions, trajectory.velocities, trajectory.accelerations, strict=True
    ):
        point = point_class()
        point.positions, point.velocities = positions.tolist(), velocities.tolist()
        point.accelerations = accelerations.tolist()
        point.time_from_start = Duration(nanoseconds=round(float(time) * NANOSECONDS_PER_SECOND)).to_msg()
        joint_trajectory.points.append(point)
    return message


def update_positions(names: Sequence[str], positions: Array, state: Any) -> Array:
    """Return positions that are updated by a sensor_msgs/msg/JointState.

    Args:
        names: the joints of the positions; other joints of the message are left out.
        positions: in rad or m, shape (joints,).
        state: the message.
    """
    result = positions.copy()
    indexes = {name: index for index, name in enumerate(names)}
    for name, position in zip(state.name, state.position, strict=False):
        if name in indexes:
            result[indexes[name]] = position
    return result
