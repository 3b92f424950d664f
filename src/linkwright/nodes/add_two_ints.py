"""add_two_ints_server and add_two_ints_client of demo_nodes_cpp and demo_nodes_py.

The tutorials on services use these nodes.
"""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.graph import Graph
from linkwright.messages import get_service
from linkwright.nodes.options import NodeOptions, SingleNode, create_node

_SERVICE_TYPE = "example_interfaces/srv/AddTwoInts"
_LOG_PERIOD_S = 1.0


class AddTwoIntsServer(SingleNode):
    """The running add_two_ints_server node, which logs each request."""

    DEFAULT_NAME = "add_two_ints_server"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._node.create_service(get_service(_SERVICE_TYPE), "add_two_ints", self._add)

    def _add(self, request: Any, response: Any) -> Any:
        self._node.get_logger().info(f"Incoming request\na: {request.a} b: {request.b}")
        response.sum = request.a + request.b
        return response


class AddTwoIntsClient(SingleNode):
    """The running add_two_ints_client node, which requests the sum of 2 and 3 and exits."""

    DEFAULT_NAME = "add_two_ints_client"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._client = self._node.create_client(get_service(_SERVICE_TYPE), "add_two_ints")
        self._timer = self._node.create_timer(0.05, self._call_when_available)
        self._ticks = 0

    def _call_when_available(self) -> None:
        if self._client.service_is_ready():
            self._timer.cancel()
            request = self._client.srv_type.Request(a=2, b=3)
            self._client.call_async(request).add_done_callback(self._log_result)
            return
        self._ticks += 1
        if self._ticks * 0.05 >= _LOG_PERIOD_S:
            self._ticks = 0
            self._node.get_logger().info("service not available, waiting again...")

    def _log_result(self, future: Any) -> None:
        self._node.get_logger().info(f"Result of add_two_ints: {future.result().sum}")
        if not self.finished.done():
            self.finished.set_result(0)
