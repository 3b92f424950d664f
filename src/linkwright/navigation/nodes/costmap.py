"""Costmaps of nav2's servers, such as the node ``/local_costmap/local_costmap``.

Each costmap runs in the process of its server.

Source: nav2_costmap_2d ``Costmap2DROS``, Humble and Jazzy. A deliberate difference: a costmap can be activated before
the robot's pose is known, and starts updating once it is known. Layers and costmap filters of unsupported types are
skipped with a log line.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from linkwright.diagnostics import LinkwrightError
from linkwright.geometry.single import Transform, compose, quaternion_from_rpy, rpy_from_quaternion
from linkwright.graph import Graph, Node, Parameter, TransformException
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.names.rules import join
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.graph.transforms.core import BufferCore
from linkwright.graph.transforms.listener import DEFAULT_STATIC_TF_TOPIC, DEFAULT_TF_TOPIC, TransformListener
from linkwright.messages import get_message, get_service, is_before_iron
from linkwright.navigation.costmaps.costmap import Costmap
from linkwright.navigation.costmaps.footprints import (
    BadFootprintError,
    Footprint,
    make_circle,
    parse_footprint,
    place_footprint,
)
from linkwright.navigation.costmaps.layered import LayeredCostmap, Pose
from linkwright.navigation.grids.grid import Grid
from linkwright.navigation.grids.library import load_scipy
from linkwright.navigation.nodes.costmap_filters import make_filters
from linkwright.navigation.nodes.costmap_layers import (
    DEFAULT_LAYERS,
    LayerContext,
    apply_parameters,
    make_layers,
)
from linkwright.navigation.nodes.costmap_messages import CostmapPublisher, raw_message
from linkwright.navigation.nodes.managed import ManagedNode
from linkwright.navigation.nodes.plugins import get_string_list
from linkwright.nodes.options import NodeOptions
from linkwright.nodes.parameter_tables import ParameterTable
from linkwright.nodes.settings import invalid_value_error

_WARNING_PERIOD_S = 5.0
_MIN_CORNERS = 3
_TF_TOPICS = (DEFAULT_TF_TOPIC, DEFAULT_STATIC_TF_TOPIC)


@dataclass(frozen=True, kw_only=True)
class CostmapParameters:
    """The parameters that do not belong to a layer, with nav2's names.

    Units are m, s and Hz.
    """

    always_send_full_costmap: bool = False
    map_vis_z: float = 0.0
    footprint_padding: float = 0.01
    footprint: str = "[]"
    global_frame: str = "map"
    height: int = 5
    width: int = 5
    lethal_cost_threshold: int = 100
    observation_sources: str = ""
    origin_x: float = 0.0
    origin_y: float = 0.0
    publish_frequency: float = 1.0
    resolution: float = 0.1
    robot_base_frame: str = "base_link"
    robot_radius: float = 0.1
    rolling_window: bool = False
    track_unknown_space: bool = False
    transform_tolerance: float = 0.3
    initial_transform_timeout: float = 60.0
    trinary_costmap: bool = True
    unknown_cost_value: int = 255
    update_frequency: float = 5.0
    use_maximum: bool = False
    map_topic: str = "map"


class CostmapNode(ManagedNode):
    """The managed node of a costmap.

    Attributes:
        transforms: the transforms between frames; available before the node is configured.
    """

    def __init__(self, *arguments: Any, **keywords: Any) -> None:
        super().__init__(*arguments, **keywords)
        self._heartbeat_period = 0.0  # A costmap needs no bond because its server has one.

    def declare(self) -> None:
        """Declare the parameters that do not belong to a layer."""
        self._layer_context: LayerContext | None = None
        self._layered: LayeredCostmap | None = None
        self._publisher: CostmapPublisher | None = None
        self._last_published_ns: int | None = None
        self.add_post_set_parameters_callback(self._apply_parameters)
        self._table = ParameterTable(self, CostmapParameters)  # Added last, so that its callback runs first.
        self._filters: list[str] = get_string_list(self, "filters", [])
        self.transforms = BufferCore(logger=self.get_logger().get_child("tf2"))
        TransformListener(self.transforms, self)

    # --- queries by servers -------------------------------------------------------------------------------------------

    @property
    def global_frame(self) -> str:
        """The frame of the costmap."""
        return self._parameter_values.global_frame

    @property
    def robot_base_frame(self) -> str:
        """The frame of the robot."""
        return self._parameter_values.robot_base_frame

    @property
    def layered(self) -> LayeredCostmap:
        """The costmap with its layers.

        Raises:
            RuntimeError: the node is not configured.
        """
        if self._layered is None:
            raise RuntimeError(f"{self.get_name()} is not configured")
        return self._layered

    @property
    def costmap(self) -> Costmap:
        """The costs after the last update.

        Moving the costmap replaces this object. See `layered` for exceptions.
        """
        return self.layered.costmap

    @property
    def footprint(self) -> Footprint:
        """The padded footprint in the frame of the robot. See `layered` for exceptions."""
        return self.layered.footprint

    @property
    def uses_radius(self) -> bool:
        """Whether the robot is round, because the parameter ``footprint`` is empty."""
        return self._parameter_values.footprint.replace(" ", "") in {"", "[]"}

    @property
    def is_current(self) -> bool:
        """Whether the costmap was updated and the data of its layers are recent enough."""
        return self._layered is not None and self._layered.is_current(self.now_ns())

    def find_robot_pose(self) -> Pose | None:
        """Return x, y (meters) and yaw (radians) of the robot in the frame of the costmap.

        Returns None if the transform is not available.
        """
        return self.transform_pose((0.0, 0.0, 0.0), self.robot_base_frame)

    def transform_pose(self, pose: Pose, frame: str, time_ns: int = 0) -> Pose | None:
        """Transform a pose to the frame of the costmap.

        Returns None if no transform is available.

        Args:
            pose: x, y (meters) and yaw (radians).
            frame: the frame of the pose. As in nav2, there is no transform for a pose without a frame.
            time_ns: the time of the transform; 0 for the latest.
        """
        if frame == self.global_frame:
            return pose
        if not frame:
            self.get_logger().warning(f"Failed to transform from  to {self.global_frame}: the pose has no frame_id")
            return None
        try:
            transform: Transform = self.transforms.lookup(self.global_frame, frame, time_ns)[0]
        except TransformException as error:
            self.get_logger().warning(str(error), throttle_duration_sec=_WARNING_PERIOD_S)
            return None
        x, y, yaw = pose
        transformed = compose(transform, (x, y, 0.0, *quaternion_from_rpy((0.0, 0.0, yaw))))
        return transformed[0], transformed[1], rpy_from_quaternion(transformed[3:])[2]

    # --- lifecycle ----------------------------------------------------------------------------------------------------

    def configure(self) -> None:
        """Create the layers, the publishers, the subscriptions and the services.

        Raises:
            LinkwrightError: NODE431, a parameter is missing; NODE433, a parameter has an invalid value; NAV101, SciPy
                is not installed.
        """
        load_scipy("ndimage")
        footprint = self._read_footprint()
        self._layer_context = LayerContext(self, self.transforms, self.global_frame, self._on_map)
        make_filters(self._layer_context, self._filters)
        make_layers(self._layer_context, get_string_list(self, "plugins", list(DEFAULT_LAYERS)))
        resolution = self._get_positive_value("resolution")
        rows, columns = (max(1, int(self._get_positive_value(name) / resolution)) for name in ("height", "width"))
        cells = np.zeros((rows, columns), np.uint8)
        grid = Grid(
            cells=cells,
            resolution=resolution,
            x=self._parameter_values.origin_x,
            y=self._parameter_values.origin_y,
        )
        self._layered = LayeredCostmap(
            grid,
            list(self._layer_context.layers.values()),
            footprint,
            is_rolling=self._parameter_values.rolling_window,
            track_unknown=self._parameter_values.track_unknown_space,
            footprint_padding=self._parameter_values.footprint_padding,
            filters=list(self._layer_context.filters.values()),
        )
        always_full = self._parameter_values.always_send_full_costmap
        self._publisher = self.register(
            CostmapPublisher(self, self._layered, self.global_frame, always_full=always_full)
        )
        polygon = get_message("geometry_msgs/msg/PolygonStamped")
        self._footprint_publisher = self.register(self.create_publisher(polygon, "published_footprint", 10))
        polygon = get_message("geometry_msgs/msg/Polygon")
        self.register(self.create_subscription(polygon, "footprint", self._on_footprint, 10))
        self._create_services()

    def activate(self) -> None:
        """Start updating the costmap."""
        self.layered.invalidate()
        self._begin_updates()

    def deactivate(self) -> None:
        """Stop updating the costmap."""
        self.end_cycles()

    def cleanup(self) -> None:
        """Drop the layers, and remove their subscriptions."""
        self.end_cycles()
        for topic in self._layer_context.topics if self._layer_context is not None else []:
            topic.destroy()
        self._layer_context = self._layered = self._publisher = None

    def update(self) -> bool:
        """Process queued sensor data, update the costmap, and publish the footprint.

        Returns False, without an update, if the robot's pose is unknown.
        """
        assert self._layer_context is not None, "it is configured"
        pose = self.find_robot_pose()
        if pose is None:
            return False
        for sensor in self._layer_context.sensors:
            sensor.process_queue()
        layered = self.layered
        if layered.update(pose, self.now_ns()) and self._publisher is not None:
            self._publisher.add_change(layered.changed_window)
        self._publish_footprint(pose)
        return True

    # --- updates ------------------------------------------------------------------------------------------------------

    @property
    def _parameter_values(self) -> CostmapParameters:
        return self._table.values

    def _get_positive_value(self, name: str) -> float:
        value: float = getattr(self._parameter_values, name)
        if not value > 0:
            raise invalid_value_error(name, value, self.get_name())
        return float(value)

    def _read_footprint(self) -> Footprint:
        text = self._parameter_values.footprint
        if self.uses_radius:
            return make_circle(self._get_positive_value("robot_radius"))
        try:
            return parse_footprint(text)
        except BadFootprintError as error:
            self.get_logger().error(str(error))
            raise invalid_value_error("footprint", text, self.get_name()) from None

    def _begin_updates(self) -> None:
        self.end_cycles()
        frequency = self._parameter_values.update_frequency
        if frequency > 0.0:
            self.begin_cycles(1.0 / frequency, self._run_cycle)

    def _run_cycle(self) -> None:
        if not self.update() or self._publisher is None:
            return
        frequency, now_ns = self._parameter_values.publish_frequency, self.now_ns()
        if frequency <= 0.0:
            return
        if self._last_published_ns is None or not 0 <= now_ns - self._last_published_ns < 1e9 / frequency:
            self._last_published_ns = now_ns
            self._publisher.publish()

    def _publish_footprint(self, pose: Pose) -> None:
        message = self._footprint_publisher.msg_type()
        message.header.frame_id, message.header.stamp = self.global_frame, self.get_clock().now().to_msg()
        point = get_message("geometry_msgs/msg/Point32")
        corners = place_footprint(self.layered.footprint, *pose)
        message.polygon.points = [point(x=float(x), y=float(y)) for x, y in corners]
        self._footprint_publisher.publish(message)

    def _on_map(self, grid: Grid, frame: str) -> None:
        """Resize the costmap to a new map, unless the costmap moves with the robot."""
        self.get_logger().info(
            f"StaticLayer: Resizing costmap to {grid.columns} X {grid.rows} at {grid.resolution:g} m/pix"
        )
        layered = self._layered
        if layered is None or layered.is_rolling:
            return
        old_grid = layered.costmap.grid
        new_grid = _make_axis_aligned_grid(grid) if frame == self.global_frame else grid
        if (old_grid.rows, old_grid.columns, old_grid.resolution, old_grid.x, old_grid.y) != (
            new_grid.rows,
            new_grid.columns,
            new_grid.resolution,
            new_grid.x,
            new_grid.y,
        ):
            layered.resize(new_grid)

    def _on_footprint(self, message: Any) -> None:
        corners = np.array([(point.x, point.y) for point in message.points], np.float64).reshape(-1, 2)
        if len(corners) < _MIN_CORNERS or not np.isfinite(corners).all():
            self.get_logger().error(
                f"a footprint needs at least three corners, but the received one has {len(corners)}"
            )
            return
        self.layered.footprint = corners

    def _apply_parameters(self, changed: list[Parameter]) -> None:
        """Apply changed parameters to the configured node."""
        layered = self._layered
        if layered is None or self._layer_context is None:
            return
        names = {parameter.name for parameter in changed}
        if names & {"footprint", "robot_radius", "footprint_padding"}:
            try:
                layered.padding = self._parameter_values.footprint_padding
                layered.footprint = self._read_footprint()
            except LinkwrightError as error:
                self.log_error(error)
        if apply_parameters(self._layer_context, changed):
            layered.invalidate()
        if "update_frequency" in names and self.is_cycling:
            self._begin_updates()

    # --- services -----------------------------------------------------------------------------------------------------

    def _create_services(self) -> None:
        name = self.get_name()
        services: list[tuple[str, str, Any]] = [
            ("ClearEntireCostmap", f"clear_entirely_{name}", self._clear_entirely),
            ("ClearCostmapAroundRobot", f"clear_around_{name}", self._clear_around),
            ("ClearCostmapExceptRegion", f"clear_except_{name}", self._clear_except),
            ("GetCostmap", "get_costmap", self._get_costmap),
        ]
        if not is_before_iron():
            services.append(("GetCost", f"get_cost_{name}", self._get_cost))
        for type_name, service, callback in services:
            self.register(self.create_service(get_service(f"nav2_msgs/srv/{type_name}"), service, callback))

    def _clear_entirely(self, _request: Any, response: Any) -> Any:
        self.get_logger().info("Received request to clear entirely the " + self.get_name())
        self.layered.clear_entirely()
        self.update()
        return response

    def _clear_around(self, request: Any, response: Any) -> Any:
        return self._clear(request, response, clear_outside=False)

    def _clear_except(self, request: Any, response: Any) -> Any:
        return self._clear(request, response, clear_outside=True)

    def _clear(self, request: Any, response: Any, *, clear_outside: bool) -> Any:
        pose = self.find_robot_pose()
        if pose is None:
            self.get_logger().error("Cannot clear map because robot pose cannot be retrieved.")
            return response
        self.layered.clear_around(pose, request.reset_distance, clear_outside=clear_outside)
        self.update()
        return response

    def _get_costmap(self, _request: Any, response: Any) -> Any:
        response.map = raw_message(self.costmap, self.global_frame, self.get_clock().now().to_msg())
        return response

    def _get_cost(self, request: Any, response: Any) -> Any:
        pose = (request.x, request.y, request.theta)
        if request.use_footprint:
            response.cost = float(self.costmap.compute_footprint_cost(pose, self.footprint))
        else:
            response.cost = float(self.costmap.cost_at(np.array(pose[:2])))
        return response


def make_costmap(server: Node, graph: Graph, options: NodeOptions, name: str) -> CostmapNode:
    """Create the costmap of a server, in a sub-namespace with the costmap's name.

    Args:
        server: the server; its ``use_sim_time`` also applies to the costmap.
        graph: the graph to which the costmap's node is added.
        options: the options of the server, which include the costmap's parameters.
        name: ``local_costmap`` or ``global_costmap``.

    Raises:
        LinkwrightError: a parameter has the wrong type.
    """
    ros_arguments = parse(options.arguments)
    rules = ParameterRules()
    rules.add(options.parameters_of_others)
    rules.add(ros_arguments.parameters)
    namespace = join(server.get_namespace(), name)
    remappings = [*ros_arguments.remappings_for(name), *options.remappings]
    parameters = rules.for_node(join(namespace, name))
    parameters["use_sim_time"] = server.get_parameter("use_sim_time").value
    return CostmapNode(
        graph,
        name,
        namespace=namespace,
        parameters=parameters,
        remappings=[
            _adapt_tf_remapping(server, remapping) for remapping in remappings if not remapping[0].startswith("__")
        ],
        enclave=ros_arguments.enclave or "/",
    )


def _adapt_tf_remapping(server: Node, rule: tuple[str, str]) -> tuple[str, str]:
    """Return a remapping rule of the server, adapted to the costmap.

    A relative tf topic is resolved in the server's namespace, because in nav2 a costmap listens to transforms with a
    node of its process that is not in the costmap's namespace.
    """
    source, target = rule
    if source not in _TF_TOPICS or target.startswith("/"):
        return rule
    return source, join(server.get_namespace(), target)


def _make_axis_aligned_grid(grid: Grid) -> Grid:
    """Return an axis-aligned grid that contains another grid.

    Only the size, origin and resolution of the result are meaningful.
    """
    if not grid.yaw:
        return grid
    rows, columns = grid.rows, grid.columns
    corners = grid.centers_of(np.array([[-1, -1], [-1, columns], [rows, -1], [rows, columns]]))
    (x, y), (right, top) = corners.min(axis=0), corners.max(axis=0)
    shape = (int(np.ceil((top - y) / grid.resolution)), int(np.ceil((right - x) / grid.resolution)))
    return replace(grid, cells=np.zeros(shape, np.uint8), x=float(x), y=float(y), yaw=0.0)
