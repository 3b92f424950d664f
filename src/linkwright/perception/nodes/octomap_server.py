"""octomap_server's nodes: a map of occupied space from point clouds, and a map of a file.

Differences: with ``filter_ground_plane``, the ground is made of the points within ``ground_filter.distance`` of the
plane of the base frame, without a search for a plane; cells have no colors (``colored_map``); topics without a
subscription are updated once a second.

Source: octomap_server for ROS 2 (parameters, topics, services, defaults).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from linkwright.diagnostics import Diagnostic, LinkwrightError, display_path, foreign, phrase
from linkwright.files.input_files import read_file
from linkwright.geometry.arrays import rotation_matrix
from linkwright.geometry.octrees import DEPTH, keys_of_codes
from linkwright.geometry.single import Transform
from linkwright.graph import LATCHED_QOS, Graph, Publisher, QoSProfile, ReliabilityPolicy
from linkwright.messages import get_message, get_service
from linkwright.nodes.frame_poses import FramePoses
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.perception.nodes.pointcloud_to_laserscan import read_points
from linkwright.perception.octomaps.occupancy import OccupancyOctree, SensorModel
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_CLOUD_QOS = QoSProfile(1, ReliabilityPolicy.BEST_EFFORT)
"""Only the latest cloud waits: an update takes longer than the period of some cameras."""
_IDLE_PERIOD_NS = NANOSECONDS_PER_SECOND
_FLOAT32 = 7
_FREE, _OCCUPIED, _UNKNOWN = 0, 100, -1
_MAX_FILE_BYTES = 1 << 30
_LARGEST = float(np.finfo(np.float64).max)
_HUE_SECTORS = ((0, 1, 2), (1, 0, 2), (2, 0, 1), (2, 1, 0), (1, 2, 0), (0, 2, 1))
"""For each sixth of the hues, the places of red, green and blue among the highest, middle and lowest value."""

Points = NDArray[np.float64]


class OctomapServer(SingleNode):
    """The node that maps space.

    Raises:
        LinkwrightError: a parameter has an invalid value or type (NODE433, GRAPH201).
    """

    DEFAULT_NAME = "octomap_server"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._declare()
            log_unknown_parameters(self._node)
        self._poses = FramePoses(self._node, "The cloud is dropped:")
        self._published_ns: dict[str, int] = {}
        self._create_endpoints()

    def _declare(self) -> None:
        node = self._node

        def read(name: str, default: Any) -> Any:
            return node.declare_parameter(name, default).value

        self._frame: str = read("frame_id", "map")
        self._base_frame: str = read("base_frame_id", "base_footprint")
        self._uses_height_colors: bool = read("use_height_map", False)
        if read("colored_map", False):
            node.get_logger().error("colored_map is not supported: the cells of the map have no colors")
        self._color_factor: float = read("color_factor", 0.8)
        heights = {"z": (-100.0, 100.0), "x": (-_LARGEST, _LARGEST), "y": (-_LARGEST, _LARGEST)}
        self._box = np.array(
            [
                [read(f"point_cloud_{side}_{axis}", heights[axis][index]) for axis in "xyz"]
                for index, side in enumerate(("min", "max"))
            ]
        )
        self._heights: tuple[float, float] = read("occupancy_min_z", -100.0), read("occupancy_max_z", 100.0)
        self._min_size: tuple[float, float] = read("min_x_size", 0.0), read("min_y_size", 0.0)
        self._filters_speckles: bool = read("filter_speckles", False)
        self._filters_ground: bool = read("filter_ground_plane", False)
        self._ground_distance: float = read("ground_filter.distance", 0.04)
        for name, default in (("ground_filter.angle", 0.15), ("ground_filter.plane_distance", 0.07)):
            node.declare_parameter(name, default)
        for name, flag in (("incremental_2D_projection", False), ("latch", True)):
            node.declare_parameter(name, flag)
        for name, path in (("octomap_path", ""), ("max_depth", DEPTH)):
            node.declare_parameter(name, path)
        resolution = check_positive(node, "resolution", float(read("resolution", 0.05)))
        max_range = float(read("sensor_model.max_range", -1.0))
        model = SensorModel(
            hit=self._check_probability("sensor_model.hit", read("sensor_model.hit", 0.7)),
            miss=self._check_probability("sensor_model.miss", read("sensor_model.miss", 0.4)),
            minimum=self._check_probability("sensor_model.min", read("sensor_model.min", 0.12)),
            maximum=self._check_probability("sensor_model.max", read("sensor_model.max", 0.97)),
            max_range=max_range if max_range > 0.0 else float("inf"),
        )
        self._merges: bool = read("compress_map", True)
        self._colors = {
            name: tuple(read(f"{name}.{channel}", value) for channel, value in zip("rgba", values, strict=True))
            for name, values in (("color", (0.0, 0.0, 1.0, 1.0)), ("color_free", (0.0, 1.0, 0.0, 1.0)))
        }
        self._publishes_free_space: bool = read("publish_free_space", False)
        self._octree = OccupancyOctree(resolution, model)

    def _check_probability(self, name: str, value: float) -> float:
        check_positive(self._node, name, float(value))
        check_positive(self._node, name, 1.0 - float(value))
        return float(value)

    def _create_endpoints(self) -> None:
        node = self._node
        self._publishers: dict[str, Publisher[Any]] = {
            topic: node.create_publisher(get_message(message), topic, LATCHED_QOS)
            for topic, message in (
                ("occupied_cells_vis_array", "visualization_msgs/msg/MarkerArray"),
                ("free_cells_vis_array", "visualization_msgs/msg/MarkerArray"),
                ("octomap_binary", "octomap_msgs/msg/Octomap"),
                ("octomap_full", "octomap_msgs/msg/Octomap"),
                ("octomap_point_cloud_centers", "sensor_msgs/msg/PointCloud2"),
                ("projected_map", "nav_msgs/msg/OccupancyGrid"),
            )
        }
        node.create_subscription(get_message("sensor_msgs/msg/PointCloud2"), "cloud_in", self._on_cloud, _CLOUD_QOS)
        octomap = get_service("octomap_msgs/srv/GetOctomap")
        node.create_service(octomap, "octomap_binary", self._on_get_binary)
        node.create_service(octomap, "octomap_full", self._on_get_full)
        node.create_service(get_service("octomap_msgs/srv/BoundingBoxQuery"), "~/clear_bbox", self._on_clear_box)
        node.create_service(get_service("std_srvs/srv/Empty"), "~/reset", self._on_reset)

    # --- updates ------------------------------------------------------------------------------------------------------

    def _on_cloud(self, message: Any) -> None:
        stamp_ns = message.header.stamp.nanoseconds
        sensor = self._poses.pose(self._frame, message.header.frame_id, stamp_ns)
        points = read_points(message)
        if points is None:
            self._node.get_logger().error("a point cloud lacks fields x, y and z, or has too little data", once=True)
        if points is None or sensor is None:
            return
        points = points[np.isfinite(points).all(axis=1)]
        ground: Points = np.zeros((0, 3))
        base_in_map = self._poses.pose(self._frame, self._base_frame, stamp_ns) if self._filters_ground else None
        base_to_sensor = (
            self._poses.pose(self._base_frame, message.header.frame_id, stamp_ns) if base_in_map is not None else None
        )
        if base_in_map is not None and base_to_sensor is not None:
            points = self._crop(_transform(points, base_to_sensor))
            is_ground = np.abs(points[:, 2]) <= self._ground_distance
            ground, points = _transform(points[is_ground], base_in_map), _transform(points[~is_ground], base_in_map)
        else:
            points = self._crop(_transform(points, sensor))
        self._octree.insert(np.array(sensor[:3]), points, ground)
        self._publish(message.header.stamp)

    def _crop(self, points: Points) -> Points:
        is_inside = np.all((points >= self._box[0]) & (points <= self._box[1]), axis=1)
        cropped: Points = points[is_inside]
        return cropped

    def _on_clear_box(self, request: Any, response: Any) -> Any:
        low, high = (np.array((point.x, point.y, point.z)) for point in (request.min, request.max))
        self._octree.clear_box(low, high)
        self._publish(self._node.get_clock().now().to_msg(), is_forced=True)
        return response

    def _on_reset(self, _request: Any, response: Any) -> Any:
        self._octree.clear()
        self._node.get_logger().info("Cleared octomap")
        self._publish(self._node.get_clock().now().to_msg(), is_forced=True)
        return response

    # --- publishing ---------------------------------------------------------------------------------------------------

    def _on_get_binary(self, _request: Any, response: Any) -> Any:
        response.map = self._make_octomap(self._node.get_clock().now().to_msg(), is_binary=True)
        return response

    def _on_get_full(self, _request: Any, response: Any) -> Any:
        response.map = self._make_octomap(self._node.get_clock().now().to_msg(), is_binary=False)
        return response

    def _publish(self, stamp: Any, *, is_forced: bool = False) -> None:
        """Publish the map on the topics that have a subscription or were not updated for a second."""
        makers: dict[str, Callable[[], Any]] = {
            "occupied_cells_vis_array": lambda: self._make_markers(stamp, is_occupied=True),
            "octomap_point_cloud_centers": lambda: self._make_cloud(stamp),
            "octomap_binary": lambda: self._make_octomap(stamp, is_binary=True),
            "octomap_full": lambda: self._make_octomap(stamp, is_binary=False),
            "projected_map": lambda: self._make_grid(stamp),
        }
        if self._publishes_free_space:
            makers["free_cells_vis_array"] = lambda: self._make_markers(stamp, is_occupied=False)
        now_ns = self._node.get_clock().now_ns()
        for topic, make in makers.items():
            publisher = self._publishers[topic]
            is_due = abs(now_ns - self._published_ns.get(topic, -_IDLE_PERIOD_NS)) >= _IDLE_PERIOD_NS
            if is_forced or is_due or publisher.get_subscription_count():
                self._published_ns[topic] = now_ns
                publisher.publish(make())

    def _make_octomap(self, stamp: Any, *, is_binary: bool) -> Any:
        message = get_message("octomap_msgs/msg/Octomap")(binary=is_binary, id="OcTree")
        message.header.frame_id, message.header.stamp = self._frame, stamp
        message.resolution = self._octree.resolution
        data = self._octree.encode_binary() if is_binary else self._octree.encode_full()
        message.data = np.frombuffer(data, dtype=np.int8)
        return message

    def _find_leaves(self, *, is_occupied: bool) -> list[tuple[Points, float]]:
        """Return the centers of the leaves at each depth, shape (n, 3), with their size in meters."""
        leaves: list[tuple[Points, float]] = []
        for level in self._octree.find_levels(merges=self._merges):
            size = self._octree.resolution * (1 << (DEPTH - level.depth))
            codes = level.codes[(level.children == 0) & ((level.values >= 0) == is_occupied)]
            centers = keys_of_codes(codes, level.depth).astype(np.float64) * self._octree.resolution + size / 2
            heights = centers[:, 2]
            is_shown = (heights + size / 2 > self._heights[0]) & (heights - size / 2 < self._heights[1])
            leaves.append((centers[is_shown], size))
        if is_occupied and self._filters_speckles:
            leaves[-1] = _remove_speckles(*leaves[-1]), leaves[-1][1]
        return leaves

    def _make_markers(self, stamp: Any, *, is_occupied: bool) -> Any:
        marker_class, point = get_message("visualization_msgs/msg/Marker"), get_message("geometry_msgs/msg/Point")
        array = get_message("visualization_msgs/msg/MarkerArray")()
        leaves = self._find_leaves(is_occupied=is_occupied)
        for number, (centers, size) in enumerate(leaves):
            marker = marker_class()
            marker.header.frame_id, marker.header.stamp = self._frame, stamp
            marker.ns, marker.id, marker.type = "map", number, marker_class.CUBE_LIST
            marker.action = marker_class.ADD if len(centers) else marker_class.DELETE
            marker.pose.orientation.w = 1.0
            marker.scale.x = marker.scale.y = marker.scale.z = size
            color = self._colors["color" if is_occupied else "color_free"]
            marker.color.r, marker.color.g, marker.color.b, marker.color.a = color
            marker.points = [point(x=x, y=y, z=z) for x, y, z in centers.tolist()]
            if is_occupied and self._uses_height_colors and len(centers):
                marker.colors = self._make_height_colors(centers[:, 2])
            array.markers.append(marker)
        return array

    def _make_height_colors(self, heights: NDArray[np.float64]) -> list[Any]:
        """Return colors from red above to violet below."""
        color = get_message("std_msgs/msg/ColorRGBA")
        known = self._octree.find_centers(self._octree.codes)[:, 2]
        low, high = float(known.min()), float(known.max())
        shares = np.clip((heights - low) / max(high - low, 1e-9), 0.0, 1.0)
        hues = (1.0 - shares) * self._color_factor % 1.0 * 6
        colors = []
        for hue in hues.tolist():
            sector = int(hue) % 6
            part = hue - int(hue)
            values = (1.0, part if sector % 2 == 0 else 1.0 - part, 0.0)
            red, green, blue = (values[place] for place in _HUE_SECTORS[sector])
            colors.append(color(r=red, g=green, b=blue, a=1.0))
        return colors

    def _make_cloud(self, stamp: Any) -> Any:
        centers = np.concatenate([centers for centers, _ in self._find_leaves(is_occupied=True)]).astype("<f4")
        field_class = get_message("sensor_msgs/msg/PointField")
        message = get_message("sensor_msgs/msg/PointCloud2")()
        message.header.frame_id, message.header.stamp = self._frame, stamp
        message.fields = [
            field_class(name=name, offset=4 * index, datatype=_FLOAT32, count=1) for index, name in enumerate("xyz")
        ]
        message.height, message.width = 1, len(centers)
        message.point_step, message.row_step = 12, 12 * len(centers)
        message.is_dense = True
        message.data = np.frombuffer(centers.tobytes(), np.uint8)
        return message

    def _make_grid(self, stamp: Any) -> Any:
        """Return the map seen from above: occupied where a cell between the heights is."""
        octree, resolution = self._octree, self._octree.resolution
        message = get_message("nav_msgs/msg/OccupancyGrid")()
        message.header.frame_id, message.header.stamp = self._frame, stamp
        message.info.map_load_time, message.info.resolution = stamp, resolution
        message.info.origin.orientation.w = 1.0
        keys = keys_of_codes(octree.codes)
        heights = (keys[:, 2] + 0.5) * resolution
        half = resolution / 2
        is_shown = (heights + half > self._heights[0]) & (heights - half < self._heights[1])
        if not is_shown.any():
            return message
        size = np.array(self._min_size) / resolution / 2
        low = np.minimum(keys[:, :2].min(axis=0), np.floor(-size).astype(np.int64))
        high = np.maximum(keys[:, :2].max(axis=0), np.ceil(size).astype(np.int64) - 1)
        columns, rows = high - low + 1
        cells = np.full((rows, columns), _UNKNOWN, dtype=np.int8)
        for value, mask in ((_FREE, octree.values < 0), (_OCCUPIED, octree.values >= 0)):
            shown = keys[is_shown & mask, :2] - low
            cells[shown[:, 1], shown[:, 0]] = value
        message.info.width, message.info.height = int(columns), int(rows)
        message.info.origin.position.x, message.info.origin.position.y = (low * resolution).tolist()
        message.data = cells.reshape(-1)
        return message


class OctomapServerStatic(SingleNode):
    """The node that offers the map of a file, as services.

    Raises:
        LinkwrightError: NODE435, the file cannot be read; GRAPH201, a parameter has the wrong type.
    """

    DEFAULT_NAME = "octomap_server_static"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            self._frame: str = self._node.declare_parameter("frame_id", "map").value
            path: str = self._node.declare_parameter("octomap_path", "").value
            log_unknown_parameters(self._node)
            self._message = _read_octomap(Path(path))
        octomap = get_service("octomap_msgs/srv/GetOctomap")
        name = "octomap_binary" if self._message.binary else "octomap_full"
        self._node.create_service(octomap, name, self._on_get)

    def _on_get(self, _request: Any, response: Any) -> Any:
        self._message.header.frame_id = self._frame
        self._message.header.stamp = self._node.get_clock().now().to_msg()
        response.map = self._message
        return response


def _transform(points: Points, pose: Transform) -> Points:
    """Return points of the frame at a pose in its parent frame, shape (n, 3)."""
    transformed: Points = points @ rotation_matrix(pose[3:]).T + np.array(pose[:3])
    return transformed


def _remove_speckles(centers: Points, size: float) -> Points:
    """Return the cells of one size, shape (n, 3), that have a neighbor."""
    keys = np.floor(centers / size).astype(np.int64)
    known = {tuple(key) for key in keys.tolist()}
    neighbors = [step for step in product((-1, 0, 1), repeat=3) if any(step)]
    is_kept = [any((x + dx, y + dy, z + dz) in known for dx, dy, dz in neighbors) for x, y, z in keys.tolist()]
    kept: Points = centers[np.array(is_kept, dtype=bool)]
    return kept


def _read_octomap(path: Path) -> Any:
    """Return the map of a file ``.bt`` or ``.ot`` as an octomap_msgs/Octomap.

    Raises:
        LinkwrightError: NODE435, the file cannot be read, or is not a map.
    """
    try:
        data = read_file(path, _MAX_FILE_BYTES)
    except OSError as error:
        reason = foreign(error.strerror or error)
        message = phrase("the octomap '{path}' cannot be read: {reason}", path=display_path(path), reason=reason)
        raise LinkwrightError(Diagnostic("NODE435", message)) from None
    header, separator, content = data.partition(b"\ndata\n")
    lines = [line.split() for line in header.decode("utf-8", "replace").splitlines()]
    values = {words[0]: words[1] for words in lines if len(words) == 2 and words[0] in ("id", "res")}
    try:
        resolution = float(values["res"])
    except (KeyError, ValueError):
        resolution = 0.0
    if not separator or not lines or lines[0][:2] != ["#", "Octomap"] or not resolution > 0.0:
        message = phrase("the file '{path}' is not an octomap", path=display_path(path))
        hint = phrase("octomap_path names a file of OctoMap, .bt or .ot")
        raise LinkwrightError(Diagnostic("NODE435", message, hint=hint))
    octomap = get_message("octomap_msgs/msg/Octomap")(binary="binary" in lines[0], id=values.get("id", "OcTree"))
    octomap.resolution, octomap.data = resolution, np.frombuffer(content, dtype=np.int8)
    return octomap
