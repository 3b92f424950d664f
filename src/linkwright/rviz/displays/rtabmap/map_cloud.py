"""The display of the clouds of rtabmap's map."""

from __future__ import annotations

import time
from collections import deque
from contextlib import suppress
from dataclasses import replace
from typing import Any, ClassVar

import numpy as np

from linkwright.diagnostics import LinkwrightError, foreign
from linkwright.geometry.arrays import compose
from linkwright.graph import Publisher
from linkwright.images import BadImageError
from linkwright.rviz.clouds import BadCloudError, Points
from linkwright.rviz.config.rviz_config import DisplayConfig
from linkwright.rviz.config.schema import Path, PropertySpec, Schema, topic_spec
from linkwright.rviz.displays.base.display import DisplayHost, Pose
from linkwright.rviz.displays.cloud_properties import DECAY_TIME, STYLE_SPECS, TRANSFORMER_SPECS
from linkwright.rviz.displays.point_clouds import CloudDisplay, ShownCloud
from linkwright.rviz.displays.rtabmap.node_points import CloudLimits, read_depth_points, read_scan_points

_FROM_SCAN = "Cloud from scan"
_DECIMATION, _VOXEL_SIZE = "Cloud decimation", "Cloud voxel size (m)"
_MAX_DEPTH, _MIN_DEPTH = "Cloud max depth (m)", "Cloud min depth (m)"
_FLOOR, _CEILING = "Filter floor (m)", "Filter ceiling (m)"
_RADIUS, _ANGLE = "Node filtering radius (m)", "Node filtering angle (degrees)"
_NAMESPACE = "Download namespace"
_NODE_ROW = "Node"


def _number(name: str, default: float, description: str, minimum: float, maximum: float) -> PropertySpec:
    return PropertySpec(name, "float", default, description, minimum=minimum, maximum=maximum)


class MapCloudDisplay(CloudDisplay):
    """A display of the points of all nodes of a map, each at the pose that the graph gives to its node.

    The points of a node stay until the graph no longer contains it. Nodes of the graph whose data never arrived are
    requested once.
    """

    CLASS = "rtabmap_rviz_plugins/MapCloud"
    DRAWN_AS = "rviz_default_plugins/PointCloud2"
    MESSAGE = "rtabmap_msgs/msg/MapData"
    SCHEMA: ClassVar[Schema] = (
        topic_spec(description=MESSAGE, filter_size=10),
        *(replace(spec, hidden=True) if spec.name == DECAY_TIME else spec for spec in STYLE_SPECS),
        *TRANSFORMER_SPECS,
        PropertySpec(_FROM_SCAN, "bool", False, "Take the points from laser scans instead of depth images."),
        PropertySpec(_DECIMATION, "int", 4, "Use every n-th row and column of the images.", minimum=1, maximum=16),
        _number(_MAX_DEPTH, 4.0, "The maximum depth of new clouds, in meters.", 0.0, 999.0),
        _number(_MIN_DEPTH, 0.0, "The minimum depth of new clouds, in meters.", 0.0, 999.0),
        _number(_VOXEL_SIZE, 0.01, "The voxel size of new clouds, in meters.", 0.0, 1.0),
        _number(_FLOOR, 0.0, "Leave out points below this height, in meters; 0 keeps all.", -999.0, 999.0),
        _number(_CEILING, 0.0, "Leave out points above this height, in meters; 0 keeps all.", -999.0, 999.0),
        _number(_RADIUS, 0.0, "Draw only one node in this radius, in meters; 0 draws all.", 0.0, 10.0),
        _number(_ANGLE, 30.0, "Draw only one node in this angle inside the radius.", 0.0, 359.0),
        PropertySpec(_NAMESPACE, "string", "rtabmap", "The namespace of rtabmap, which is asked for missing nodes."),
    )

    def __init__(self, host: DisplayHost, identity: str, config: DisplayConfig) -> None:
        super().__init__(host, identity, config)
        self._nodes: dict[int, Points] = {}
        self._requested: set[int] = set()
        self._requests: Publisher[Any] | None = None

    def start(self) -> None:
        """Subscribe, and get ready to ask for missing nodes."""
        self._open_requests()
        super().start()

    def stop(self) -> None:
        """Unsubscribe."""
        super().stop()
        self._close_requests()

    def process_message(self, message: Any, pose: Pose | None) -> None:
        """Read the points of new nodes, and draw all nodes at their poses in the graph."""
        assert pose is not None
        self.delete_status_row(_NODE_ROW)
        for node in message.nodes:
            self._read(node)
        graph = message.graph
        poses = {
            int(identity): _to_row(node_pose) for identity, node_pose in zip(graph.poses_id, graph.poses, strict=False)
        }
        poses = {identity: row for identity, row in poses.items() if np.isfinite(row).all()}
        self._request(poses.keys() - self._nodes.keys() - self._requested)
        self._draw_nodes(self._thin(poses), pose, self.frame_of(message)[1])

    def on_property_changed(self, path: Path) -> None:
        """Subscribe again if necessary, color the points again, or discard those of the other source."""
        super().on_property_changed(path)
        if path == (_FROM_SCAN,):
            self.reset()
            self.show_again()
        elif path in ((_RADIUS,), (_ANGLE,)):
            self.show_again()
        elif path == (_NAMESPACE,):
            self._open_requests()

    def on_frames_changed(self) -> None:
        """Draw the nodes in the new Fixed Frame."""
        nodes = self._nodes
        super().on_frames_changed()
        if not self._nodes and self.last_message is not None:
            self._nodes = nodes
            self.show_again()

    def reset(self) -> None:
        """Discard all points."""
        self._nodes = {}
        self._requested = set()
        super().reset()

    # --- nodes -------------------------------------------------------------------------------------------------

    def _read(self, node: Any) -> None:
        """Read the points of a node, if it has data."""
        number = self.properties.number
        limits = CloudLimits(
            int(number(_DECIMATION)),
            number(_MIN_DEPTH),
            number(_MAX_DEPTH),
            number(_VOXEL_SIZE),
            number(_FLOOR),
            number(_CEILING),
        )
        read = read_scan_points if self.properties.flag(_FROM_SCAN) else read_depth_points
        try:
            points = read(node, limits)
        except (BadCloudError, BadImageError) as error:
            self.set_status_row(_NODE_ROW, "error", foreign(error))
            return
        if points is not None:
            self._nodes[int(node.id)] = points

    def _request(self, missing: set[int]) -> None:
        """Ask rtabmap for the data of nodes. A negative ID is a landmark, which has none."""
        wanted = sorted(identity for identity in missing if identity > 0)
        self._requested.update(wanted)
        if wanted and self._requests is not None:
            self._requests.publish(self._requests.msg_type(data=wanted))

    def _open_requests(self) -> None:
        """Create the publisher of requests; a name that is not valid is shown in the status."""
        self._close_requests()
        self.delete_status_row(_NAMESPACE)
        topic = f"{self.properties.text(_NAMESPACE).strip().rstrip('/')}/republish_node_data"
        try:
            self._requests = self.context.node.create_publisher("std_msgs/msg/Int32MultiArray", topic, 1)
        except LinkwrightError as error:
            self.set_status_row(_NAMESPACE, "error", error.diagnostics[0].message)

    def _close_requests(self) -> None:
        if self._requests is not None:
            with suppress(ValueError):  # the node may already have been destroyed
                self.context.node.destroy_publisher(self._requests)
            self._requests = None

    def _thin(self, poses: dict[int, Pose]) -> dict[int, Pose]:
        """Return the poses that are not near a later one, if the properties limit them."""
        radius, angle = self.properties.number(_RADIUS), np.radians(self.properties.number(_ANGLE))
        if not (radius > 0 and angle > 0):
            return poses
        kept: dict[int, Pose] = {}
        for identity, row in sorted(poses.items(), reverse=True):
            if all(not _is_near(row, other, radius, angle) for other in kept.values()):
                kept[identity] = row
        return kept

    def _draw_nodes(self, poses: dict[int, Pose], map_pose: Pose, stamp_ns: int) -> None:
        """Send the nodes that are new, or have moved, and remove those that the graph no longer contains."""
        now = time.monotonic()
        previous = {cloud.key: cloud for cloud in self._shown_clouds}
        shown: deque[ShownCloud] = deque()
        for identity, row in sorted(poses.items()):
            points = self._nodes.get(identity)
            if points is None or not len(points):
                continue
            pose = compose(map_pose, row)
            cloud = ShownCloud(str(identity), points, pose, stamp_ns, now)
            earlier = previous.get(cloud.key)
            if earlier is not None and earlier.points is points and np.array_equal(earlier.pose, pose):
                shown.append(earlier)
                continue
            self._offer_transformers(points)
            shown.append(cloud)
            self._draw(cloud)
        self._shown_clouds = shown
        for key in previous.keys() - {cloud.key for cloud in shown}:
            self.remove_content(key)
        self._count_points()


def _to_row(pose: Any) -> Pose:
    position, orientation = pose.position, pose.orientation
    quaternion = (orientation.x, orientation.y, orientation.z, orientation.w)
    return np.array((position.x, position.y, position.z, *(quaternion if any(quaternion) else (0, 0, 0, 1))))


def _is_near(first: Pose, last: Pose, radius: float, angle: float) -> bool:
    distance = float(np.linalg.norm(first[:3] - last[:3]))
    turn = 2 * np.arccos(min(1.0, abs(float(first[3:] @ last[3:]))))
    return distance < radius and turn < angle
