"""slam_gmapping: the mapper of slam_toolbox's nodes with the parameters, topics and frames of gmapping.

A graph of scans replaces gmapping's particles, so the parameters of particles and of their motion have no effect, and
``entropy`` is not published. The topics ``pose`` and ``slam_toolbox/graph_visualization`` are additional.

Source: gmapping (parameters and defaults as on its wiki page), slam_gmapping for ROS 2 (topics and frames).
"""

from __future__ import annotations

from typing import Any

from linkwright.graph import Graph, Node
from linkwright.messages import get_service
from linkwright.navigation.nodes.slam_toolbox.parameters import Settings
from linkwright.navigation.nodes.slam_toolbox.toolbox import Toolbox
from linkwright.navigation.slam.settings import MapperSettings
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.settings import check_positive, log_unknown_parameters
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_PARAMETERS_WITHOUT_EFFECT: dict[str, int | float] = {
    "sigma": 0.05,
    "kernelSize": 1,
    "lstep": 0.05,
    "astep": 0.05,
    "iterations": 5,
    "lsigma": 0.075,
    "ogain": 3.0,
    "lskip": 0,
    "minimumScore": 0.0,
    "srr": 0.1,
    "srt": 0.2,
    "str": 0.1,
    "stt": 0.2,
    "temporalUpdate": -1.0,
    "resampleThreshold": 0.5,
    "particles": 30,
    "xmin": -10.0,
    "ymin": -10.0,
    "xmax": 10.0,
    "ymax": 10.0,
    "llsamplerange": 0.01,
    "llsamplestep": 0.01,
    "lasamplerange": 0.005,
    "lasamplestep": 0.005,
    "tf_delay": 0.05,
}
_TRANSFORM_TIMEOUT_S = 0.2
_TF_BUFFER_S = 30
_DEFAULT_RANGE_M = 80.0


class SlamGmapping(SingleNode):
    """The running node.

    Raises:
        LinkwrightError: a parameter has an invalid value (NODE433, GRAPH201), or SciPy is not installed (NAV101).
    """

    DEFAULT_NAME = "slam_gmapping"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        with handle_start_errors(self._node):
            settings = _read_settings(self._node)
            self._toolbox = Toolbox(self._node, settings, keeps_all_scans=False, localizes=False)
            self._node.declare_parameter("paused_new_measurements", False)
            log_unknown_parameters(self._node)
        self._node.create_service(get_service("nav_msgs/srv/GetMap"), "dynamic_map", self._on_get_map)
        self._toolbox.start()

    def close(self) -> None:
        """Close the node."""
        self._toolbox.stop()
        super().close()

    def _on_get_map(self, _request: Any, response: Any) -> Any:
        message = self._toolbox.make_map_message()
        if message is not None:
            response.map = message
        return response


def _read_settings(node: Node) -> Settings:
    """Declare the parameters, and return the settings of the mapper.

    Raises:
        LinkwrightError: NODE433, a value is not valid; GRAPH201, a value has the wrong type.
    """

    def read(name: str, default: Any) -> Any:
        return node.declare_parameter(name, default).value

    def read_positive(name: str, default: float) -> float:
        return check_positive(node, name, float(read(name, default)))

    for name, default in _PARAMETERS_WITHOUT_EFFECT.items():
        node.declare_parameter(name, default)
    usable_range, sensor_range = read_positive("maxUrange", _DEFAULT_RANGE_M), float(read("maxRange", 0.0))
    return Settings(
        odom_frame=read("odom_frame", "odom").removeprefix("/"),
        map_frame=read("map_frame", "map").removeprefix("/"),
        base_frame=read("base_frame", "base_link").removeprefix("/"),
        scan_topic="scan",
        map_name="map",
        resolution=read_positive("delta", 0.05),
        ranges=(0.0, min(usable_range, sensor_range) if sensor_range > 0.0 else usable_range),
        throttle_scans=max(1, int(read("throttle_scans", 1))),
        transform_timeout_ns=round(_TRANSFORM_TIMEOUT_S * NANOSECONDS_PER_SECOND),
        transform_period=float(read("transform_publish_period", 0.05)),
        map_update_interval=read_positive("map_update_interval", 5.0),
        tf_buffer_ns=_TF_BUFFER_S * NANOSECONDS_PER_SECOND,
        position_covariance_scale=1.0,
        yaw_covariance_scale=1.0,
        min_pass_through=0,
        occupancy_threshold=float(read("occ_thresh", 0.25)),
        map_file_name="",
        start=None,
        mapper=MapperSettings(
            minimum_travel_distance=float(read("linearUpdate", 1.0)),
            minimum_travel_heading=float(read("angularUpdate", 0.5)),
        ),
    )
