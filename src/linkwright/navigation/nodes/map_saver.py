"""nav2's map_saver, which saves a map received on a topic.

map_saver_cli saves one map and exits; map_saver_server saves maps on request by a service.
"""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.diagnostics import LinkwrightError, render
from linkwright.graph import LATCHED_QOS, Graph, Logger, Node, QoSProfile
from linkwright.graph.command_line.ros_arguments import remove_ros_arguments
from linkwright.graph.loop.node_handle import ReentrantCallbackGroup
from linkwright.messages import get_message, get_service
from linkwright.navigation.grids.occupancy import BadGridError, grid_from_message
from linkwright.navigation.maps.map_files import FREE_THRESH, OCCUPIED_THRESH, MapSaveSettings, save_map
from linkwright.navigation.maps.map_yaml import MapMode
from linkwright.navigation.nodes.managed import ManagedNode, ManagedServer
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors
from linkwright.nodes.service_waits import wait_for_future
from linkwright.nodes.settings import log_unknown_parameters
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_USAGE = """Usage:
  map_saver_cli [arguments] [--ros-args ROS remapping args]

Arguments:
  -h/--help
  -t <map_topic>
  -f <mapname>
  --occ <threshold_occupied>
  --free <threshold_free>
  --fmt <image_format>
  --mode trinary(default)/scale/raw

NOTE: --ros-args should be passed at the end of command line"""
_OPTIONS = ("-t", "-f", "--occ", "--free", "--fmt", "--mode")
_INVALID_ARGUMENT_STATUS = 255
"""The exit status of nav2's ``return -1``."""


class _MapReceiver:
    """A receiver that saves a map, shared by both programs."""

    def __init__(self, node: Node) -> None:
        self._node = node
        declare = node.declare_parameter
        self._timeout: float = declare("save_map_timeout", 2.0).value
        self._default_free: float = declare("free_thresh_default", FREE_THRESH).value
        self._default_occupied: float = declare("occupied_thresh_default", OCCUPIED_THRESH).value
        self._is_latched: bool = declare("map_subscribe_transient_local", True).value

    def parse_mode(self, text: str) -> MapMode:
        """Return the map mode with the given name.

        If there is no such mode, log a warning and return ``trinary``.
        """
        try:
            return MapMode(text or MapMode.TRINARY.value)
        except ValueError:
            self._node.get_logger().warning(
                f"Map mode parameter not recognized: '{text}', using default value (trinary)"
            )
            return MapMode.TRINARY

    async def save(self, topic: str, name: str, image_format: str, mode: MapMode, free: float, occupied: float) -> bool:
        """Save the next map of a topic, and return whether that succeeded.

        A threshold of 0 selects the default from the parameters.
        """
        logger = self._node.get_logger()
        logger.info(f"Saving map from '{topic}' topic to '{name}' file")
        if not topic:
            topic = "map"
            logger.warning(f"Map topic unspecified. Map messages will be read from '{topic}' topic")
        if not free:
            free = self._default_free
            logger.warning(f"Free threshold unspecified. Setting it to default value: {free:f}")
        if not occupied:
            occupied = self._default_occupied
            logger.warning(f"Occupied threshold unspecified. Setting it to default value: {occupied:f}")
        message = await self._receive_map(topic)
        if message is None:
            return False
        io_logger = self._node.graph.get_logger("map_io")
        if not name:
            name = f"map_{self._node.get_clock().now().nanoseconds // NANOSECONDS_PER_SECOND}"
            io_logger.warning(f"Map file unspecified. Map will be saved to {name} file")
        settings = MapSaveSettings(
            name=name, occupied_thresh=occupied, free_thresh=free, image_format=image_format, mode=mode
        )
        problem = self._write(message, settings, io_logger)
        if problem is not None:
            logger.error(f"Failed to save the map: {problem}")
            return False
        logger.info("Map saved successfully")
        return True

    def _write(self, message: Any, settings: MapSaveSettings, io_logger: Logger) -> str | None:
        """Save the map of a message, and return the reason for a failure, or None after success."""
        try:
            grid = grid_from_message(message)
            io_logger.info(f"Received a {grid.columns} X {grid.rows} map @ {grid.resolution:g} m/pix")
            for path in save_map(grid, settings, io_logger.warning):
                io_logger.info(f"Wrote {path}")
        except BadGridError as error:
            return f"the message is not a map: {error}"
        except LinkwrightError as error:
            return "\n".join(render(diagnostic) for diagnostic in error.diagnostics)
        return None

    async def _receive_map(self, topic: str) -> Any:
        """Return the next message of a topic.

        If no message arrives in time, log an error and return None.
        """
        node = self._node
        received: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

        def receive(message: Any) -> None:
            if not received.done():
                received.set_result(message)

        qos = LATCHED_QOS if self._is_latched else QoSProfile(depth=10)
        group = ReentrantCallbackGroup()  # The service callback that waits occupies the node's default group.
        map_class = get_message("nav_msgs/msg/OccupancyGrid")
        subscription = node.create_subscription(map_class, topic, receive, qos, callback_group=group)
        try:
            if not await wait_for_future(node, received, self._timeout):
                publisher_count = node.count_publishers(topic)
                reason = (
                    f"no node publishes on '{subscription.name}'"
                    if not publisher_count
                    else f"'{subscription.name}' has publishers ({publisher_count}), but no map arrived: check the QoS"
                )
                node.get_logger().error(
                    f"Failed to spin map subscription: no map arrived within {self._timeout:g} s; {reason}"
                )
                return None
            return received.result()
        finally:
            subscription.destroy()


class MapSaver(SingleNode):
    """The running map_saver_cli node.

    The exit status is 0 if the map was saved, 1 if not, and 255 for an invalid argument.
    """

    DEFAULT_NAME = "map_saver"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        program_arguments = remove_ros_arguments(options.arguments)
        self._task: asyncio.Task[None] | None = None
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        if "-h" in program_arguments or "--help" in program_arguments:
            options.output(_USAGE)
            self.finished.set_result(0)
            return
        with handle_start_errors(self._node):
            receiver = _MapReceiver(self._node)
            log_unknown_parameters(self._node)
        try:
            option_values = _parse_options(program_arguments)
        except ValueError as error:
            self._node.get_logger().error(str(error))
            self.finished.set_result(_INVALID_ARGUMENT_STATUS)
            return
        self._task = asyncio.get_running_loop().create_task(self._run(receiver, option_values))

    def close(self) -> None:
        """Cancel a running save, and close the node."""
        if self._task is not None:
            self._task.cancel()
        super().close()

    async def _run(self, receiver: _MapReceiver, arguments: dict[str, str]) -> None:
        free, occupied = (float(arguments.get(option, 0.0)) for option in ("--free", "--occ"))
        mode = receiver.parse_mode(arguments.get("--mode", ""))
        is_saved = await receiver.save(
            arguments.get("-t", "map"), arguments.get("-f", ""), arguments.get("--fmt", ""), mode, free, occupied
        )
        if not self.finished.done():
            self.finished.set_result(0 if is_saved else 1)


def _parse_options(arguments: list[str]) -> dict[str, str]:
    """Parse the command-line options, and return their values by option.

    Raises:
        ValueError: an option does not exist, has no value, or needs a number and has another value.
    """
    option_values = {}
    remaining = iter(arguments)
    for argument in remaining:
        if argument not in _OPTIONS:
            raise ValueError(f"Wrong argument: {argument}")
        value = next(remaining, None)
        if value is None:
            raise ValueError(f"Wrong argument: {argument} should be followed by a value.")
        if argument in ("--occ", "--free"):
            try:
                float(value)
            except ValueError:
                raise ValueError(f"Wrong argument: {argument} should be followed by a number, not '{value}'") from None
        option_values[argument] = value
    return option_values


class MapSaverNode(ManagedNode):
    """The managed node of map_saver_server."""

    def declare(self) -> None:
        """Declare nav2's parameters."""
        self._saving = _MapReceiver(self)

    def configure(self) -> None:
        """Create the service ``save_map``."""
        name = f"{self.get_name()}/save_map"
        self.register(self.create_service(get_service("nav2_msgs/srv/SaveMap"), name, self._on_save))

    async def _on_save(self, request: Any, response: Any) -> Any:
        mode = self._saving.parse_mode(request.map_mode)
        response.result = await self._saving.save(
            request.map_topic,
            request.map_url,
            request.image_format,
            mode,
            _round_float32(request.free_thresh),
            _round_float32(request.occupied_thresh),
        )
        return response


def _round_float32(value: float) -> float:
    """Round a float32 value to the decimal number that was sent: 0.649999976 to 0.65."""
    return round(value, 6)


class MapSaverServer(ManagedServer):
    """The running map_saver_server node."""

    NODE = MapSaverNode
    DEFAULT_NAME = "map_saver"
