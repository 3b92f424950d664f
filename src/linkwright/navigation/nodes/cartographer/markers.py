"""Markers and clouds that display the graph of a map, as cartographer_node publishes them."""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np

from linkwright.messages import get_message
from linkwright.navigation.slam.pose_graph import PoseGraph
from linkwright.navigation.slam.poses import FloatArray

_TRAJECTORY_WIDTH_M, _TRAJECTORY_HEIGHT_M = 0.07, 0.05
_CONSTRAINT_WIDTH_M = 0.025
_COLORS = ((0.9, 0.2, 0.2), (0.2, 0.4, 0.9), (0.2, 0.7, 0.3), (0.9, 0.6, 0.1), (0.6, 0.3, 0.8))
_FLOAT32 = 7


def make_trajectory_markers(trajectories: list[FloatArray], frame: str, stamp: Any) -> Any:
    """Return a line through the poses of each trajectory, of shape (n, 3)."""
    array = get_message("visualization_msgs/msg/MarkerArray")()
    for number, poses in enumerate(trajectories):
        marker = _make_marker(frame, stamp, f"Trajectory {number}", 0, "LINE_STRIP", _TRAJECTORY_WIDTH_M)
        marker.pose.position.z = _TRAJECTORY_HEIGHT_M
        marker.color.r, marker.color.g, marker.color.b = _COLORS[number % len(_COLORS)]
        marker.points = _make_points(poses)
        array.markers.append(marker)
    return array


def make_constraint_markers(graph: PoseGraph, frame: str, stamp: Any) -> Any:
    """Return lines for the edges of a graph: those between consecutive scans, and the others."""
    array = get_message("visualization_msgs/msg/MarkerArray")()
    edges = list(zip(graph.first, graph.second, strict=True))
    points = _make_points(graph.poses)
    for number, (namespace, color, selected) in enumerate(
        (
            ("Intra constraints", (0.0, 0.5, 1.0), [edge for edge in edges if edge[1] == edge[0] + 1]),
            ("Inter constraints, same trajectory", (0.0, 0.8, 0.2), [edge for edge in edges if edge[1] != edge[0] + 1]),
        )
    ):
        marker = _make_marker(frame, stamp, namespace, number, "LINE_LIST", _CONSTRAINT_WIDTH_M)
        marker.color.r, marker.color.g, marker.color.b = color
        marker.points = [points[index] for index in chain.from_iterable(selected)]
        array.markers.append(marker)
    return array


def make_cloud(points: FloatArray, frame: str, stamp: Any) -> Any:
    """Return points of the plane, of shape (n, 2), as a sensor_msgs/PointCloud2."""
    message = get_message("sensor_msgs/msg/PointCloud2")()
    message.header.frame_id, message.header.stamp = frame, stamp
    field_class = get_message("sensor_msgs/msg/PointField")
    message.fields = [
        field_class(name=name, offset=4 * index, datatype=_FLOAT32, count=1) for index, name in enumerate("xyz")
    ]
    values = np.zeros((len(points), 3), dtype="<f4")
    values[:, :2] = points
    message.height, message.width = 1, len(points)
    message.point_step, message.row_step = 12, 12 * len(points)
    message.is_dense = True
    message.data = np.frombuffer(values.tobytes(), np.uint8)
    return message


def _make_marker(frame: str, stamp: Any, namespace: str, number: int, shape: str, width: float) -> Any:
    marker_class = get_message("visualization_msgs/msg/Marker")
    marker = marker_class()
    marker.header.frame_id, marker.header.stamp = frame, stamp
    marker.ns, marker.id, marker.type = namespace, number, getattr(marker_class, shape)
    marker.pose.orientation.w = 1.0
    marker.scale.x = width
    marker.color.a = 1.0
    return marker


def _make_points(poses: FloatArray) -> list[Any]:
    point = get_message("geometry_msgs/msg/Point")
    return [point(x=x, y=y) for x, y in poses[:, :2].tolist()]
