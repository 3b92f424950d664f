"""nav2's map_server, which loads a map from files, and provides it on a topic and a service.

A difference from nav2 in Humble: as in Jazzy, the node can be configured without ``yaml_filename``, and serves a map
once one is loaded.
"""

from __future__ import annotations

from typing import Any

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import LATCHED_QOS, Parameter, ParameterType
from linkwright.messages import get_message, get_service
from linkwright.navigation.grids.occupancy import occupancy_message
from linkwright.navigation.maps.map_files import load_map
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer


class MapServerNode(ManagedNode):
    """The managed node of map_server."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        self.declare_parameter("yaml_filename", ParameterType.STRING)
        self.declare_parameter("topic_name", "map")
        self.declare_parameter("frame_id", "map")
        self._map: Any = None

    def configure(self) -> None:
        """Read the map, and create the topic and the services.

        Raises:
            LinkwrightError: NAV201 to NAV204, the map cannot be read.
        """
        self._map = None
        path = self.get_parameter_or("yaml_filename", Parameter("yaml_filename")).value
        if path:
            self._load(path)
        else:
            self.get_logger().info("yaml-filename parameter is empty, set map through '/load_map'-service")
        name = self.get_name()
        self.register(self.create_service(get_service("nav_msgs/srv/GetMap"), f"{name}/map", self._on_get))
        self.register(self.create_service(get_service("nav2_msgs/srv/LoadMap"), f"{name}/load_map", self._on_load))
        map_class = get_message("nav_msgs/msg/OccupancyGrid")
        self._publisher = self.register(
            self.create_publisher(map_class, self.get_parameter("topic_name").value, LATCHED_QOS)
        )

    def activate(self) -> None:
        """Publish the map."""
        if self._map is not None:
            self._publisher.publish(self._map)

    def _load(self, path: str) -> None:
        logger = self.graph.get_logger("map_io")
        logger.info(f"Loading yaml file: {path}")
        grid = load_map(path)
        logger.info(f"Read map {path}: {grid.columns} X {grid.rows} map @ {grid.resolution:g} m/cell")
        self._map = occupancy_message(grid, self.get_parameter("frame_id").value, self.get_clock().now().to_msg())

    def _on_get(self, _request: Any, response: Any) -> Any:
        if not self.is_active:
            self.get_logger().warning("Received GetMap request but not in ACTIVE state, ignoring!")
            return response
        self.get_logger().info("Handling GetMap request")
        if self._map is not None:
            response.map = self._map
        return response

    def _on_load(self, request: Any, response: Any) -> Any:
        if not self.is_active:
            self.get_logger().warning("Received LoadMap request but not in ACTIVE state, ignoring!")
            response.result = response.RESULT_UNDEFINED_FAILURE
            return response
        self.get_logger().info("Handling LoadMap request")
        try:
            self._load(request.map_url)
        except LinkwrightError as error:
            self.log_error(error)
            response.result = _find_result_code(error, response)
            return response
        self._publisher.publish(self._map)
        response.map, response.result = self._map, response.RESULT_SUCCESS
        return response


def _find_result_code(error: LinkwrightError, response: Any) -> int:
    """Return nav2's result code for an error."""
    results: dict[str, int] = {
        "NAV201": response.RESULT_MAP_DOES_NOT_EXIST,
        "NAV202": response.RESULT_INVALID_MAP_METADATA,
    }
    return int(results.get(error.diagnostics[0].code, response.RESULT_INVALID_MAP_DATA))


class MapServer(ManagedServer):
    """The running map_server node."""

    NODE = MapServerNode
    DEFAULT_NAME = "map_server"
