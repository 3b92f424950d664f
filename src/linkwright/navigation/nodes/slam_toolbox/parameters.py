"""The parameters of slam_toolbox's nodes, as in 2.6 (Humble) and 2.8 (Jazzy)."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np

from linkwright.graph import Node, Parameter, ParameterType
from linkwright.navigation.nodes.plugins import get_or_declare
from linkwright.navigation.slam.poses import FloatArray
from linkwright.navigation.slam.search import Search
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.nodes.settings import check_positive

_PARAMETERS_WITHOUT_EFFECT: dict[str, bool | int | float | str] = {
    "mode": "mapping",
    "debug_logging": False,
    "scan_queue_size": 1,
    "stack_size_to_use": 40_000_000,
    "use_map_saver": True,
    "enable_interactive_mode": False,
    "restamp_tf": False,
    "use_scan_barycenter": True,
    "fine_search_angle_offset": 0.00349,
    "solver_plugin": "solver_plugins::CeresSolver",
    "ceres_linear_solver": "SPARSE_NORMAL_CHOLESKY",
    "ceres_preconditioner": "SCHUR_JACOBI",
    "ceres_trust_strategy": "LEVENBERG_MARQUARDT",
    "ceres_dogleg_type": "TRADITIONAL_DOGLEG",
    "ceres_loss_function": "None",
}
"""Parameters that occur in parameter files but have no effect, with their defaults."""


@dataclass(frozen=True, slots=True)
class Settings:
    """The parameters of a node, in meters, radians, and nanoseconds if the name ends in ``_ns``.

    Attributes:
        odom_frame: the frame of odometry.
        map_frame: the frame of the map, the parent of `odom_frame`.
        base_frame: the frame of the robot.
        scan_topic: the topic of scans.
        map_name: the topic of the map; its metadata is published with the suffix ``_metadata``.
        resolution: the side of a cell.
        ranges: the minimum and maximum range of a reading.
        throttle_scans: n, if every n-th scan is processed.
        transform_timeout_ns: how long a scan waits for its transform; also added to the stamps of published transforms.
        transform_period: the seconds between published transforms; 0 to publish none.
        map_update_interval: the seconds between published maps.
        tf_buffer_ns: how long transforms are kept.
        position_covariance_scale: the factor applied to the covariance of the published position.
        yaw_covariance_scale: the factor applied to the variance of the published yaw.
        min_pass_through: see `OccupancyMap`.
        occupancy_threshold: see `OccupancyMap`.
        map_file_name: the saved pose graph to continue; "" for none.
        start: the robot's initial pose in that graph, shape (3,); None for the pose of the graph's first scan.
        mapper: the settings of the mapper.
    """

    odom_frame: str
    map_frame: str
    base_frame: str
    scan_topic: str
    map_name: str
    resolution: float
    ranges: tuple[float, float]
    throttle_scans: int
    transform_timeout_ns: int
    transform_period: float
    map_update_interval: float
    tf_buffer_ns: int
    position_covariance_scale: float
    yaw_covariance_scale: float
    min_pass_through: int
    occupancy_threshold: float
    map_file_name: str
    start: FloatArray | None
    mapper: MapperSettings


class _ParameterReader:
    """A parameter reader that declares each parameter of a node on the first read."""

    def __init__(self, node: Node) -> None:
        self._node = node

    def _read_value(self, name: str, default: object) -> Any:
        return get_or_declare(self._node, name, default)

    def read_flag(self, name: str, default: bool) -> bool:
        return bool(self._read_value(name, default))

    def read_integer(self, name: str, default: int) -> int:
        return int(self._read_value(name, default))

    def read_number(self, name: str, default: float) -> float:
        return float(self._read_value(name, default))

    def read_positive_number(self, name: str, default: float) -> float:
        return check_positive(self._node, name, self.read_number(name, default))

    def read_text(self, name: str, default: str) -> str:
        return str(self._read_value(name, default))

    def read_frame(self, name: str, default: str) -> str:
        return self.read_text(name, default).removeprefix("/")

    def declare_without_effect(self) -> None:
        for name, default in _PARAMETERS_WITHOUT_EFFECT.items():
            self._read_value(name, default)


def read_settings(node: Node) -> Settings:
    """Read the parameters of a node, and declare the missing ones.

    Raises:
        LinkwrightError: NODE433, a value is invalid; GRAPH201, a value has the wrong type.
    """
    reader = _ParameterReader(node)
    reader.declare_without_effect()
    reader.read_flag("paused_new_measurements", False)
    _log_unsupported(node)
    resolution = reader.read_number("resolution", 0.05)
    if resolution <= 0.0:
        node.get_logger().warning(
            "You've set resolution of map to be zero or negative, this isn't allowed so it will be set to default "
            "value 0.05."
        )
        resolution = 0.05
    throttle = reader.read_integer("throttle_scans", 1)
    if throttle <= 0:
        node.get_logger().warning(
            "You've set throttle_scans to be zero, this isn't allowed so it will be set to default value 1."
        )
        throttle = 1
    return Settings(
        odom_frame=reader.read_frame("odom_frame", "odom"),
        map_frame=reader.read_frame("map_frame", "map"),
        base_frame=reader.read_frame("base_frame", "base_footprint"),
        scan_topic=reader.read_text("scan_topic", "/scan"),
        map_name=reader.read_text("map_name", "/map"),
        resolution=resolution,
        ranges=(reader.read_number("min_laser_range", 0.0), reader.read_positive_number("max_laser_range", 25.0)),
        throttle_scans=throttle,
        transform_timeout_ns=round(reader.read_number("transform_timeout", 0.5) * 1e9),
        transform_period=reader.read_number("transform_publish_period", 0.05),
        map_update_interval=reader.read_positive_number("map_update_interval", 10.0),
        tf_buffer_ns=round(reader.read_number("tf_buffer_duration", 30.0) * 1e9),
        position_covariance_scale=reader.read_number("position_covariance_scale", 1.0),
        yaw_covariance_scale=reader.read_number("yaw_covariance_scale", 1.0),
        min_pass_through=reader.read_integer("min_pass_through", 2),
        occupancy_threshold=reader.read_number("occupancy_threshold", 0.1),
        map_file_name=reader.read_text("map_file_name", ""),
        start=_read_start_pose(node),
        mapper=_read_mapper_settings(reader),
    )


def _log_unsupported(node: Node) -> None:
    solver: str = node.get_parameter("solver_plugin").value
    node.get_logger().info(f"Using Linkwright's sparse Gauss-Newton solver in place of solver plugin {solver}")
    if node.get_parameter("enable_interactive_mode").value:
        node.get_logger().info("enable_interactive_mode is not supported: scans cannot be moved by hand")


def _read_start_pose(node: Node) -> FloatArray | None:
    """Return the initial pose in a saved map, or None for the pose of its first scan.

    A wrong number of values is logged, as in slam_toolbox.
    """
    for name, kind in (("map_start_pose", ParameterType.DOUBLE_ARRAY), ("map_start_at_dock", ParameterType.BOOL)):
        if not node.has_parameter(name):
            node.declare_parameter(name, kind)
    pose = node.get_parameter_or("map_start_pose", Parameter("map_start_pose")).value
    if pose is None:
        return None
    if len(pose) != 3:
        node.get_logger().error(
            "Incorrect number of arguments for map starting pose. Must be in format: [x, y, theta]. Starting at the "
            "origin"
        )
        return np.zeros(3)
    return np.array(pose, dtype=np.float64)


def _read_mapper_settings(reader: _ParameterReader) -> MapperSettings:
    read_number, read_positive_number = reader.read_number, reader.read_positive_number
    angle_offset = read_number("coarse_search_angle_offset", 0.349)
    angle_resolution = read_positive_number("coarse_angle_resolution", 0.0349)
    return MapperSettings(
        use_scan_matching=reader.read_flag("use_scan_matching", True),
        minimum_time_interval=read_number("minimum_time_interval", 0.5),
        minimum_travel_distance=read_number("minimum_travel_distance", 0.5),
        minimum_travel_heading=read_number("minimum_travel_heading", 0.5),
        scan_buffer_size=max(1, reader.read_integer("scan_buffer_size", 10)),
        scan_buffer_maximum_scan_distance=read_number("scan_buffer_maximum_scan_distance", 10.0),
        link_match_minimum_response_fine=read_number("link_match_minimum_response_fine", 0.1),
        link_scan_maximum_distance=read_number("link_scan_maximum_distance", 1.5),
        do_loop_closing=reader.read_flag("do_loop_closing", True),
        loop_search_maximum_distance=read_number("loop_search_maximum_distance", 3.0),
        loop_match_minimum_chain_size=reader.read_integer("loop_match_minimum_chain_size", 10),
        loop_match_maximum_variance_coarse=read_number("loop_match_maximum_variance_coarse", 3.0),
        loop_match_minimum_response_coarse=read_number("loop_match_minimum_response_coarse", 0.35),
        loop_match_minimum_response_fine=read_number("loop_match_minimum_response_fine", 0.45),
        matching=Search(
            dimension=read_positive_number("correlation_search_space_dimension", 0.5),
            resolution=read_positive_number("correlation_search_space_resolution", 0.01),
            smear_deviation=read_positive_number("correlation_search_space_smear_deviation", 0.1),
            angle_offset=angle_offset,
            angle_resolution=angle_resolution,
            distance_variance_penalty=read_positive_number("distance_variance_penalty", 0.5),
            angle_variance_penalty=read_positive_number("angle_variance_penalty", 1.0),
            minimum_distance_penalty=read_number("minimum_distance_penalty", 0.5),
            minimum_angle_penalty=read_number("minimum_angle_penalty", 0.9),
        ),
        loop=Search(
            dimension=read_positive_number("loop_search_space_dimension", 8.0),
            resolution=read_positive_number("loop_search_space_resolution", 0.05),
            smear_deviation=read_positive_number("loop_search_space_smear_deviation", 0.03),
            angle_offset=angle_offset,
            angle_resolution=angle_resolution,
            distance_variance_penalty=inf,
            angle_variance_penalty=inf,
        ),
        use_response_expansion=reader.read_flag("use_response_expansion", True),
    )
