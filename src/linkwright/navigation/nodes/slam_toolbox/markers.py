"""Markers that display a pose graph: a sphere for each scan and a line for each edge."""

from __future__ import annotations

from itertools import chain
from typing import Any

from linkwright.messages import get_message
from linkwright.navigation.slam.pose_graph import PoseGraph

_SPHERE_DIAMETER_M = 0.1
_LINE_WIDTH_M = 0.02


def graph_markers(graph: PoseGraph, frame: str, stamp: Any) -> Any:
    """Convert a pose graph to a visualization_msgs/MarkerArray.

    Edges between consecutive scans are blue, other edges are green.
    """
    array = get_message("visualization_msgs/msg/MarkerArray")()
    point = get_message("geometry_msgs/msg/Point")
    points = [point(x=x, y=y) for x, y in graph.poses[:, :2].tolist()]
    edges = list(zip(graph.first, graph.second, strict=True))
    consecutive_edges = [(first, second) for first, second in edges if second == first + 1]
    other_edges = [(first, second) for first, second in edges if second != first + 1]
    marker_class = get_message("visualization_msgs/msg/Marker")
    for number, (shape, size, color, marker_points) in enumerate(
        (
            (marker_class.SPHERE_LIST, _SPHERE_DIAMETER_M, (1.0, 0.0, 0.0), points),
            (
                marker_class.LINE_LIST,
                _LINE_WIDTH_M,
                (0.0, 0.0, 1.0),
                [points[index] for index in chain.from_iterable(consecutive_edges)],
            ),
            (
                marker_class.LINE_LIST,
                _LINE_WIDTH_M,
                (0.0, 0.8, 0.0),
                [points[index] for index in chain.from_iterable(other_edges)],
            ),
        )
    ):
        marker = marker_class()
        marker.header.frame_id, marker.header.stamp = frame, stamp
        marker.ns, marker.id, marker.type = "slam_toolbox", number, shape
        marker.action = marker_class.ADD if marker_points else marker_class.DELETE
        marker.pose.orientation.w = 1.0
        marker.scale.x = marker.scale.y = marker.scale.z = size
        marker.color.r, marker.color.g, marker.color.b = color
        marker.color.a = 1.0
        marker.points = marker_points
        array.markers.append(marker)
    return array
