"""The zones of collision_monitor, with their shapes from parameters or topics."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from linkwright.geometry.arrays import rotation_matrix
from linkwright.graph import Node, ParameterDescriptor, TransformException
from linkwright.graph.transforms.core import BufferCore
from linkwright.messages import get_message
from linkwright.navigation.behaviors.zones import Circle, Points, Polygon, Shape, SpeedRange, ZoneAction, ZoneRule
from linkwright.navigation.costmaps.footprints import BadFootprintError, Footprint, parse_footprint
from linkwright.navigation.following.follower import Velocity
from linkwright.navigation.nodes.plugins import get_or_declare, get_string_list
from linkwright.nodes.settings import invalid_value_error

_ACTIONS = {
    "stop": ZoneAction.STOP,
    "slowdown": ZoneAction.SLOWDOWN,
    "approach": ZoneAction.APPROACH,
    "limit": ZoneAction.LIMIT,
    "none": ZoneAction.NOTHING,
}
_ZONE_TYPES = ("polygon", "circle", "velocity_polygon")
_POLYGON_TYPE = "geometry_msgs/msg/PolygonStamped"
_QUEUE_DEPTH = 10


class Zone:
    """A zone with its rule and shape.

    Args:
        node: the node that has the zone's parameters.
        name: the name of the zone, which is also the prefix of its parameters.
        transforms: the transforms between frames.
        base_frame: the frame of the robot.

    Raises:
        LinkwrightError: NODE433, a parameter has an invalid value.
    """

    def __init__(self, node: Node, name: str, transforms: BufferCore, base_frame: str) -> None:
        self.name = name
        self._node, self._transforms, self._base_frame = node, transforms, base_frame
        self._endpoints: list[Any] = []
        self._shape: Shape | None = None
        self._polygon: Any = None
        self._ranges: list[SpeedRange] = []
        self._get_parameter_value("enabled", True)
        self.rule = self._read_rule()
        self._sources = get_string_list(node, f"{name}.sources_names", [])
        kind = str(self._get_parameter_value("type", "polygon"))
        if kind not in _ZONE_TYPES:
            raise invalid_value_error(f"{name}.type", kind, node.get_name(), _ZONE_TYPES)
        if kind == "velocity_polygon":
            self._ranges = [
                self._read_range(polygon) for polygon in get_string_list(node, f"{name}.velocity_polygons", [])
            ]
        else:
            self._read_shape(kind)
        self._publisher: Any = None
        if self._get_parameter_value("visualize", False):
            topic = str(self._get_parameter_value("polygon_pub_topic", name))
            self._publisher = self._register(node.create_publisher(get_message(_POLYGON_TYPE), topic, _QUEUE_DEPTH))

    def destroy(self) -> None:
        """Destroy the publisher and the subscriptions."""
        for endpoint in self._endpoints:
            endpoint.destroy()

    def input_at_velocity(
        self, velocity: Velocity, points_by_sensor: Mapping[str, Points]
    ) -> tuple[str, ZoneRule, Shape, Points] | None:
        """Return the zone's name, its rule, its shape at a velocity, and the points of its sensors.

        Returns None if the zone is disabled or has no shape yet.
        """
        if not self._get_parameter_value("enabled", True):
            return None
        for speed_range in self._ranges:
            if speed_range.covers(velocity):
                self._shape = speed_range.shape
                break
        self._transform_polygon()
        if self._shape is None:
            self._node.get_logger().warning(f"[{self.name}]: Polygon shape is not set yet", throttle_duration_sec=2.0)
            return None
        own_points = [points for name, points in points_by_sensor.items() if not self._sources or name in self._sources]
        return self.name, self.rule, self._shape, np.concatenate(own_points) if own_points else np.zeros((0, 2))

    def publish(self) -> None:
        """Publish the zone's polygon for displays, if there are subscribers."""
        if (
            self._publisher is None
            or not isinstance(self._shape, Polygon)
            or not self._publisher.get_subscription_count()
        ):
            return
        message, point = get_message(_POLYGON_TYPE)(), get_message("geometry_msgs/msg/Point32")
        message.header.frame_id = self._base_frame
        message.header.stamp = self._node.get_clock().now().to_msg()
        message.polygon.points = [point(x=float(x), y=float(y)) for x, y in self._shape.corners]
        self._publisher.publish(message)

    # --- parameters --------------------------------------------------------------------------------------------------

    def _get_parameter_value(self, name: str, default: Any) -> Any:
        return get_or_declare(self._node, f"{self.name}.{name}", default)

    def _read_rule(self) -> ZoneRule:
        action_name = str(self._get_parameter_value("action_type", ""))
        if action_name not in _ACTIONS:
            raise invalid_value_error(f"{self.name}.action_type", action_name, self._node.get_name(), list(_ACTIONS))
        min_points = int(self._get_parameter_value("min_points", 4))
        if f"{self.name}.max_points" in self._node.undeclared_overrides():  # Humble's parameter.
            min_points = int(self._get_parameter_value("max_points", 3)) + 1
        default_rule = ZoneRule(_ACTIONS[action_name])
        names = [
            *(("slowdown_ratio",) if default_rule.action is ZoneAction.SLOWDOWN else ()),
            *(("linear_limit", "angular_limit") if default_rule.action is ZoneAction.LIMIT else ()),
            *(("time_before_collision", "simulation_time_step") if default_rule.action is ZoneAction.APPROACH else ()),
        ]
        values = {name: float(self._get_parameter_value(name, getattr(default_rule, name))) for name in names}
        for name in ("time_before_collision", "simulation_time_step"):
            if values.get(name, 1.0) <= 0.0:
                raise invalid_value_error(f"{self.name}.{name}", values[name], self._node.get_name())
        return ZoneRule(default_rule.action, min_points, **values)

    def _read_range(self, polygon: str) -> SpeedRange:
        corners = self._read_corners(f"{polygon}.points")
        if corners is None:
            raise invalid_value_error(f"{self.name}.{polygon}.points", "", self._node.get_name())
        bounds = [float(self._get_parameter_value(f"{polygon}.{item}", 0.0)) for item in _RANGE_PARAMETERS]
        direction = None
        if self._get_parameter_value("holonomic", False):
            direction = (
                float(self._get_parameter_value(f"{polygon}.direction_start_angle", -np.pi)),
                float(self._get_parameter_value(f"{polygon}.direction_end_angle", np.pi)),
            )
        return SpeedRange(Polygon(corners), (bounds[0], bounds[1]), (bounds[2], bounds[3]), direction)

    def _read_shape(self, kind: str) -> None:
        """Read the shape from parameters, or subscribe to the topic that provides it."""
        polygon = get_message(_POLYGON_TYPE)
        if kind == "circle":
            radius = float(self._get_parameter_value("radius", 0.0))
            if radius > 0.0:
                self._shape = Circle(radius)
                return
            topic = str(self._get_parameter_value("polygon_sub_topic", ""))
            if not topic:
                raise invalid_value_error(f"{self.name}.radius", radius, self._node.get_name())
            number = get_message("std_msgs/msg/Float32")
            self._register(self._node.create_subscription(number, topic, self._on_radius, _QUEUE_DEPTH))
            return
        corners = self._read_corners("points")
        if corners is not None:
            self._shape = Polygon(corners)
        elif self.rule.action is ZoneAction.APPROACH:
            topic = str(self._get_parameter_value("footprint_topic", "local_costmap/published_footprint"))
            self._register(self._node.create_subscription(polygon, topic, self._on_polygon, _QUEUE_DEPTH))
        else:
            topic = str(self._get_parameter_value("polygon_sub_topic", ""))
            if not topic:
                raise invalid_value_error(f"{self.name}.points", "", self._node.get_name())
            self._register(self._node.create_subscription(polygon, topic, self._on_polygon, _QUEUE_DEPTH))

    def _read_corners(self, name: str) -> Footprint | None:
        """Return the corners from a parameter, or None if the parameter is not set.

        The parameter is a string in Jazzy and a list of numbers in Humble.
        """
        full_name = f"{self.name}.{name}"
        if not self._node.has_parameter(full_name):
            self._node.declare_parameter(full_name, None, ParameterDescriptor(dynamic_typing=True))
        value = self._node.get_parameter(full_name).value
        if value is None or value == "":
            return None
        if not isinstance(value, str):
            numbers = list(value)
            value = str([numbers[start : start + 2] for start in range(0, len(numbers), 2)])
        try:
            return parse_footprint(value)
        except BadFootprintError:
            raise invalid_value_error(full_name, value, self._node.get_name()) from None

    # --- topics ------------------------------------------------------------------------------------------------------

    def _register(self, endpoint: Any) -> Any:
        self._endpoints.append(endpoint)
        return endpoint

    def _on_radius(self, message: Any) -> None:
        self._shape = Circle(float(message.data))

    def _on_polygon(self, message: Any) -> None:
        self._polygon = message if len(message.polygon.points) >= 3 else None
        self._transform_polygon()

    def _transform_polygon(self) -> None:
        """Transform the polygon received on a topic to the robot's current frame.

        Footprints are published at the robot's pose, so they are transformed back with the transform at their stamp.
        """
        if self._polygon is None:
            return
        header = self._polygon.header
        stamp_ns = header.stamp.nanoseconds if self.rule.action is ZoneAction.APPROACH else 0
        try:
            pose = self._transforms.lookup(self._base_frame, header.frame_id or self._base_frame, stamp_ns)[0]
        except TransformException:
            return
        corners = np.array([(point.x, point.y, 0.0) for point in self._polygon.polygon.points])
        self._shape = Polygon((corners @ rotation_matrix(pose[3:]).T + np.array(pose[:3]))[:, :2])
        if header.frame_id in ("", self._base_frame) or stamp_ns:
            self._polygon = None


_RANGE_PARAMETERS = ("linear_min", "linear_max", "theta_min", "theta_max")
