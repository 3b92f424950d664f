"""cartographer_occupancy_grid_node: it paints submaps into a nav_msgs/OccupancyGrid.

It works with any cartographer_node, of Linkwright or of cartographer_ros.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

from linkwright.geometry.single import Transform
from linkwright.graph import DurabilityPolicy, Graph, QoSProfile
from linkwright.messages import get_message, get_service
from linkwright.navigation.grids.occupancy import occupancy_message
from linkwright.navigation.nodes.cartographer.submaps import Texture, paint, read_texture, transform_from_pose
from linkwright.nodes.flags import FlagValue, parse_flags
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters

_FLAGS: dict[str, FlagValue] = {
    "resolution": 0.05,
    "publish_period_sec": 1.0,
    "include_frozen_submaps": True,
    "include_unfrozen_submaps": True,
    "occupancy_grid_topic": "map",
}
_QOS = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@dataclass(slots=True)
class _Submap:
    """A submap: its pose in the map, and its texture with the version that was received or requested."""

    pose: Transform
    texture: Texture | None = None
    version: int = -1
    requested_version: int = -1


class OccupancyGridNode(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: an argument is not valid (NODE432, NODE433).
    """

    DEFAULT_NAME = "cartographer_occupancy_grid_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        node = self._node
        with handle_start_errors(node):
            flags = parse_flags(arguments, _FLAGS)
            self._resolution = check_positive(node, "resolution", float(flags["resolution"]))
            period = check_positive(node, "publish_period_sec", float(flags["publish_period_sec"]))
            log_unknown_parameters(node)
        self._includes = {True: flags["include_frozen_submaps"], False: flags["include_unfrozen_submaps"]}
        self._submaps: dict[tuple[int, int], _Submap] = {}
        self._header: Any = None
        self._is_changed = False
        self._client = node.create_client(get_service("cartographer_ros_msgs/srv/SubmapQuery"), "submap_query")
        self._publisher = node.create_publisher(
            get_message("nav_msgs/msg/OccupancyGrid"), str(flags["occupancy_grid_topic"]), _QOS
        )
        node.create_subscription(
            get_message("cartographer_ros_msgs/msg/SubmapList"), "submap_list", self._on_submap_list, 10
        )
        node.create_timer(period, self._publish)

    def _on_submap_list(self, message: Any) -> None:
        self._header = message.header
        entries = {
            (entry.trajectory_id, entry.submap_index): entry
            for entry in message.submap
            if self._includes[bool(entry.is_frozen)]
        }
        for key in self._submaps.keys() - entries.keys():
            del self._submaps[key]
            self._is_changed = True
        for key, entry in entries.items():
            pose = transform_from_pose(entry.pose)
            submap = self._submaps.setdefault(key, _Submap(pose))
            self._is_changed |= submap.pose != pose
            submap.pose = pose
            if entry.submap_version != submap.requested_version and self._client.service_is_ready():
                submap.requested_version = entry.submap_version
                request = self._client.srv_type.Request(trajectory_id=key[0], submap_index=key[1])
                self._client.call_async(request).add_done_callback(partial(self._on_texture, key))

    def _on_texture(self, key: tuple[int, int], future: Any) -> None:
        submap, response = self._submaps.get(key), future.result()
        if submap is None or response is None:
            return
        texture = read_texture(response.textures[0]) if response.textures else None
        if texture is None:
            submap.requested_version = -1  # The next list asks again.
            return
        submap.texture, submap.version = texture, response.submap_version
        self._is_changed = True

    def _publish(self) -> None:
        painted = [(submap.pose, submap.texture) for submap in self._submaps.values() if submap.texture is not None]
        if not painted:
            return
        if self._is_changed:
            self._is_changed = False
            self._grid = paint(painted, self._resolution)
        if self._grid is not None:
            frame = self._header.frame_id
            self._publisher.publish(occupancy_message(self._grid, frame, self._header.stamp))
