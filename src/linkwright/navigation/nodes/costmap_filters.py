"""Create costmap filters from nav2's parameters.

Source: nav2_costmap_2d ``CostmapFilter``, ``KeepoutFilter``, ``SpeedFilter``, Humble and Jazzy. Names of topics are
relative to the namespace of the costmap, as in nav2.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph import LATCHED_QOS, Node, Publisher
from linkwright.messages import get_message, get_service
from linkwright.navigation.costmaps.filters import KeepoutFilter, SpeedFilter, SpeedScale
from linkwright.navigation.costmaps.layer import Layer
from linkwright.navigation.costmaps.static_layer import MapPose
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.occupancy import BadGridError, grid_from_message
from linkwright.navigation.nodes.costmap_layers import LayerContext
from linkwright.navigation.nodes.plugins import declare_unused

_PERCENT, _ABSOLUTE = 1, 2
"""The values of ``type`` in nav2_msgs/msg/CostmapFilterInfo for speed limits."""
_QUEUE_DEPTH = 10


class FilterTopics:
    """The topics of a filter's information and mask, and the service that switches the filter on and off.

    Args:
        node: the node of the costmap.
        name: the name of the filter.
        kind: the type of the filter, for the log.
        on_info: called with each information; returns whether the filter can use the mask.
        on_mask: called with each mask.

    Attributes:
        frame: the frame of the mask; None before the first mask.
        layer: the filter, which is set after it was created.
        publishers: the publishers of the filter, which are removed with the topics.
    """

    layer: Layer

    def __init__(
        self, node: Node, name: str, kind: str, on_info: Callable[[Any], bool], on_mask: Callable[[Grid], None]
    ) -> None:
        self.frame: str | None = None
        self.publishers: list[Publisher[Any]] = []
        self._node, self._kind, self._on_info, self._on_mask = node, kind, on_info, on_mask
        topic = node.get_parameter(f"{name}.filter_info_topic").value
        self._log(f'Subscribing to "{topic}" topic for filter info...')
        info = get_message("nav2_msgs/msg/CostmapFilterInfo")
        self._mask_subscription: Any = None
        self._info_subscription = node.create_subscription(info, topic, self._receive_info, LATCHED_QOS)
        self._service = node.create_service(get_service("std_srvs/srv/SetBool"), f"{name}/toggle_filter", self._toggle)

    def destroy(self) -> None:
        """Remove the subscriptions, the service and the publishers."""
        for entity in (self._info_subscription, self._mask_subscription, self._service, *self.publishers):
            if entity is not None:
                entity.destroy()

    def _log(self, text: str) -> None:
        self._node.get_logger().info(f"{self._kind}: {text}")

    def _receive_info(self, message: Any) -> None:
        self._log("Received filter info")
        if self._mask_subscription is not None:
            self._mask_subscription.destroy()
            self._mask_subscription = None
        if not self._on_info(message):
            return
        self._log(f'Subscribing to "{message.filter_mask_topic}" topic for filter mask...')
        grid = get_message("nav_msgs/msg/OccupancyGrid")
        self._mask_subscription = self._node.create_subscription(
            grid, message.filter_mask_topic, self._receive_mask, LATCHED_QOS
        )

    def _receive_mask(self, message: Any) -> None:
        try:
            grid = grid_from_message(message)
        except BadGridError as error:
            self._node.get_logger().error(f"{self._kind}: the mask is malformed: {error}")
            return
        self._log("Received filter mask")
        self.frame = message.header.frame_id
        self._on_mask(grid)

    def _toggle(self, request: Any, response: Any) -> Any:
        self.layer.enabled = request.data
        response.success, response.message = True, "Enabled" if request.data else "Disabled"
        return response


def make_filters(context: LayerContext, names: list[str]) -> None:
    """Create the filters named by the parameter ``filters``, and add them to `context`.

    Filters of unsupported types are skipped with a warning.

    Raises:
        LinkwrightError: NODE431, a filter has no type or no topic.
    """
    factories = {"KeepoutFilter": _make_keepout_filter, "SpeedFilter": _make_speed_filter}
    node = context.node
    for name in names:
        kind = context.required_value(f"{name}.plugin")
        factory = factories.get(kind.removeprefix("nav2_costmap_2d::"))
        if factory is None:
            declare_unused(node, name)
            node.get_logger().warning(f"filters of type {kind} are not supported: the costmap ignores '{name}'")
            continue
        node.get_logger().info(f'Using costmap filter "{name}"')
        enabled = context.value(f"{name}.enabled", True)
        context.value(f"{name}.transform_tolerance", 0.1)
        context.required_value(f"{name}.filter_info_topic")
        layer, topics = factory(context, name)
        declare_unused(node, name)
        layer.enabled, topics.layer = enabled, layer
        context.topics.append(topics)
        context.filters[name] = layer


def _make_keepout_filter(context: LayerContext, name: str) -> tuple[Layer, FilterTopics]:
    def on_info(message: Any) -> bool:
        if message.base or message.multiplier != 1.0:
            context.node.get_logger().error(
                "KeepoutFilter: For proper use of keepout filter base and multiplier in CostmapFilterInfo message "
                "should be set to their default values (0 and 1)"
            )
        return True

    def pose() -> MapPose | None:
        return context.pose_in(topics.frame)

    keepout = KeepoutFilter(pose)
    topics = FilterTopics(context.node, name, "KeepoutFilter", on_info, keepout.set_map)
    return keepout, topics


def _make_speed_filter(context: LayerContext, name: str) -> tuple[Layer, FilterTopics]:
    node = context.node
    limit_class = get_message("nav2_msgs/msg/SpeedLimit")
    publisher = node.create_publisher(
        limit_class, context.value(f"{name}.speed_limit_topic", "speed_limit"), _QUEUE_DEPTH
    )

    def publish(limit: float, is_percentage: bool) -> None:
        message = limit_class(percentage=is_percentage, speed_limit=limit)
        message.header.frame_id, message.header.stamp = context.frame, node.get_clock().now().to_msg()
        publisher.publish(message)

    def on_info(message: Any) -> bool:
        if message.type not in (_PERCENT, _ABSOLUTE):
            node.get_logger().error("SpeedFilter: Mode is not supported")
            return False
        speed.scale = SpeedScale(message.base, message.multiplier, message.type == _PERCENT)
        return True

    def on_mask(mask: Grid) -> None:
        speed.mask = mask

    def pose() -> MapPose | None:
        return context.pose_in(topics.frame)

    speed = SpeedFilter(pose, publish)
    topics = FilterTopics(node, name, "SpeedFilter", on_info, on_mask)
    topics.publishers.append(publisher)
    return speed, topics
