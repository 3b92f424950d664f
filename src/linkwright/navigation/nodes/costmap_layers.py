"""Create costmap layers from nav2's parameters.

Source: nav2_costmap_2d, Humble and Jazzy.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any, Final, Protocol

from linkwright.diagnostics import Diagnostic, LinkwrightError, phrase
from linkwright.geometry.single import rpy_from_quaternion
from linkwright.graph import Node, Parameter, TransformException
from linkwright.graph.names.rules import join, split
from linkwright.graph.transforms.core import BufferCore
from linkwright.navigation.costmaps.denoise_layer import DenoiseLayer
from linkwright.navigation.costmaps.inflation_layer import Inflation, InflationLayer
from linkwright.navigation.costmaps.layer import Layer
from linkwright.navigation.costmaps.observations import ObservationBuffer, Source
from linkwright.navigation.costmaps.obstacle_layer import HeightRange, ObstacleLayer
from linkwright.navigation.costmaps.range_layer import RangeLayer, RangeSettings
from linkwright.navigation.costmaps.static_layer import Interpretation, MapPose, StaticLayer
from linkwright.navigation.costmaps.voxel_layer import MAX_LEVELS, VoxelLayer, Voxels
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.nodes.costmap_sources import MapTopic, PointsTopic, RangeTopic, SensorTopic
from linkwright.navigation.nodes.plugins import declare_unused, get_or_declare, get_string_list
from linkwright.nodes.parameter_tables import declare_table
from linkwright.nodes.settings import invalid_value_error

DEFAULT_LAYERS: Final = {
    "static_layer": "nav2_costmap_2d::StaticLayer",
    "obstacle_layer": "nav2_costmap_2d::ObstacleLayer",
    "inflation_layer": "nav2_costmap_2d::InflationLayer",
}
_DATA_TYPES: Final = ("LaserScan", "PointCloud2")


class DestroyableTopic(Protocol):
    """The subscriptions of a layer."""

    def destroy(self) -> None:
        """Remove the subscriptions."""


@dataclass(slots=True)
class LayerContext:
    """The node and data that the layers of a costmap share.

    Attributes:
        node: the node of the costmap.
        transforms: the transforms between frames.
        frame: the frame of the costmap.
        on_map: called with each full map of the static layer and the map's frame.
        topics: the subscriptions of the layers, which are destroyed with the costmap.
        sensors: the subscriptions whose messages are processed when the costmap is updated.
        layers: the layers by name, from the bottom to the top.
        filters: the costmap filters by name, in the order in which they apply.
    """

    node: Node
    transforms: BufferCore
    frame: str
    on_map: Callable[[Grid, str], None]
    topics: list[DestroyableTopic] = field(default_factory=list)
    sensors: list[SensorTopic] = field(default_factory=list)
    layers: dict[str, Layer] = field(default_factory=dict)
    filters: dict[str, Layer] = field(default_factory=dict)

    def pose_in(self, frame: str | None) -> MapPose | None:
        """Return the pose of the costmap's frame in the frame of a map, or None while it is unknown."""
        if frame is None or frame == self.frame:
            return 0.0, 0.0, 0.0
        try:
            frame_pose, _ = self.transforms.lookup(frame, self.frame, 0)
        except TransformException:
            return None
        return frame_pose[0], frame_pose[1], rpy_from_quaternion(frame_pose[3:])[2]

    def value(self, name: str, default: Any) -> Any:
        """Return the value of a parameter, declaring it first if necessary."""
        return get_or_declare(self.node, name, default)

    def required_value(self, name: str, default: str = "") -> str:
        """Return the text of a parameter that must not be empty, declaring it first if necessary.

        Raises:
            LinkwrightError: NODE431, the parameter is not set.
        """
        value = str(self.value(name, default))
        if not value:
            message = phrase("parameter '{name}' of '{node}' is not set", name=name, node=self.node.get_name())
            raise LinkwrightError(Diagnostic("NODE431", message))
        return value


def make_layers(context: LayerContext, names: list[str]) -> None:
    """Create the layers named by the parameter ``plugins``, and add them to `context`.

    Layers of unsupported types are skipped with a warning.

    Raises:
        LinkwrightError: NODE431, a layer has no type; NODE433, a parameter has an invalid value.
    """
    factories: dict[str, Callable[[LayerContext, str], Layer]] = {
        "StaticLayer": _make_static_layer,
        "ObstacleLayer": _make_obstacle_layer,
        "VoxelLayer": _make_voxel_layer,
        "InflationLayer": _make_inflation_layer,
        "DenoiseLayer": _make_denoise_layer,
        "RangeSensorLayer": _make_range_layer,
    }
    node = context.node
    for name in names:
        kind = context.required_value(f"{name}.plugin", DEFAULT_LAYERS.get(name, ""))
        factory = factories.get(kind.removeprefix("nav2_costmap_2d::"))
        if factory is None:
            declare_unused(node, name)
            node.get_logger().warning(f"layers of type {kind} are not supported: the costmap ignores '{name}'")
            continue
        node.get_logger().info(f'Using plugin "{name}"')
        layer = factory(context, name)
        layer.enabled = context.value(f"{name}.enabled", True)
        context.layers[name] = layer
    ignored_layers = [
        undeclared_override.removesuffix(".plugin")
        for undeclared_override in node.undeclared_overrides()
        if undeclared_override.endswith(".plugin")
    ]
    for name in ignored_layers:
        declare_unused(node, name)
    if ignored_layers:
        node.get_logger().info(f"layers that 'plugins' does not name are ignored: {', '.join(ignored_layers)}")


def apply_parameters(context: LayerContext, changed: list[Parameter]) -> bool:
    """Apply changed parameters to the layers, and return whether any belongs to a layer."""
    is_layer_changed = False
    for changed_parameter in changed:
        name, _, parameter = changed_parameter.name.partition(".")
        layer = context.layers.get(name) or context.filters.get(name)
        if layer is None:
            continue
        is_layer_changed = True
        if parameter == "enabled":
            layer.enabled = changed_parameter.value
        elif isinstance(layer, InflationLayer) and hasattr(layer.inflation, parameter):
            layer.inflation = replace(layer.inflation, **{parameter: changed_parameter.value})
        elif isinstance(layer, ObstacleLayer) and hasattr(layer.heights, parameter):
            layer.heights = replace(layer.heights, **{parameter: changed_parameter.value})
        elif isinstance(layer, ObstacleLayer) and parameter == "combination_method":
            layer.combination_method = changed_parameter.value
    return is_layer_changed


def _make_static_layer(context: LayerContext, name: str) -> Layer:
    interpretation = Interpretation(
        track_unknown_space=context.value("track_unknown_space", False),
        unknown_cost_value=context.value("unknown_cost_value", 255) % 256,
        lethal_threshold=max(0, min(100, context.value("lethal_cost_threshold", 100))),
        trinary=context.value("trinary_costmap", True),
    )
    context.value(f"{name}.transform_tolerance", 0.0)
    topic = context.value(f"{name}.map_topic", "") or context.value("map_topic", "map")
    map_topic: list[MapTopic] = []

    def pose() -> MapPose | None:
        return context.pose_in(map_topic[0].frame)

    layer = StaticLayer(
        interpretation,
        use_maximum=context.value("use_maximum", False),
        footprint_clearing=context.value(f"{name}.footprint_clearing_enabled", False),
        pose=pose,
    )
    map_topic.append(
        MapTopic(
            context.node,
            _in_parent_namespace(context.node, topic),
            layer,
            transient_local=context.value(f"{name}.map_subscribe_transient_local", True),
            has_updates=context.value(f"{name}.subscribe_to_updates", False),
            on_map=context.on_map,
        )
    )
    context.topics += map_topic
    return layer


def _make_obstacle_layer(context: LayerContext, name: str) -> Layer:
    return ObstacleLayer(
        _make_buffers(context, name),
        declare_table(context.node, HeightRange, name),
        combination_method=context.value(f"{name}.combination_method", 1),
        footprint_clearing=context.value(f"{name}.footprint_clearing_enabled", True),
    )


def _make_voxel_layer(context: LayerContext, name: str) -> Layer:
    if context.value(f"{name}.publish_voxel_map", False):
        context.node.get_logger().info(f"{name}.publish_voxel_map is not supported: '{name}' publishes no voxels")
    voxels: Voxels = declare_table(context.node, Voxels, name)
    if not 0 < voxels.z_voxels <= MAX_LEVELS:
        valid_counts = [str(count) for count in range(1, MAX_LEVELS + 1)]
        raise invalid_value_error(f"{name}.z_voxels", voxels.z_voxels, context.node.get_name(), valid_counts)
    return VoxelLayer(
        _make_buffers(context, name),
        declare_table(context.node, HeightRange, name),
        voxels,
        combination_method=context.value(f"{name}.combination_method", 1),
        footprint_clearing=context.value(f"{name}.footprint_clearing_enabled", True),
    )


def _make_buffers(context: LayerContext, name: str) -> list[ObservationBuffer]:
    context.value(f"{name}.tf_filter_tolerance", 0.05)
    buffers = []
    for source in context.value(f"{name}.observation_sources", "").split():
        prefix = f"{name}.{source}"
        kind = context.value(f"{prefix}.data_type", "LaserScan")
        if kind not in _DATA_TYPES:
            raise invalid_value_error(f"{prefix}.data_type", kind, context.node.get_name(), _DATA_TYPES)
        buffer = ObservationBuffer(declare_table(context.node, Source, prefix))
        topic = PointsTopic(
            context.node,
            _in_parent_namespace(context.node, context.value(f"{prefix}.topic", source)),
            kind,
            buffer,
            context.transforms,
            context.frame,
            sensor_frame=context.value(f"{prefix}.sensor_frame", ""),
            inf_is_valid=context.value(f"{prefix}.inf_is_valid", False),
        )
        context.topics.append(topic)
        context.sensors.append(topic)
        buffers.append(buffer)
    return buffers


def _make_inflation_layer(context: LayerContext, name: str) -> Layer:
    return InflationLayer(declare_table(context.node, Inflation, name))


def _make_range_layer(context: LayerContext, name: str) -> Layer:
    layer = RangeLayer(declare_table(context.node, RangeSettings, name))
    context.value(f"{name}.inflate_cone", 1.0)
    context.value(f"{name}.input_sensor_type", "ALL")
    for topic in get_string_list(context.node, f"{name}.topics", []):
        range_topic = RangeTopic(
            context.node, _in_parent_namespace(context.node, topic), layer, context.transforms, context.frame
        )
        context.topics.append(range_topic)
        context.sensors.append(range_topic)
    return layer


def _make_denoise_layer(context: LayerContext, name: str) -> Layer:
    return DenoiseLayer(
        context.value(f"{name}.minimal_group_size", 2), context.value(f"{name}.group_connectivity_type", 8)
    )


def _in_parent_namespace(node: Node, topic: str) -> str:
    """Resolve a relative topic in the parent of the costmap's namespace."""
    return topic if topic.startswith(("/", "~")) else join(split(node.get_namespace())[0], topic)
