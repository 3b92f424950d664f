"""add_analyzer, which gives a running aggregator the analyzers in its parameters, and exits.

The aggregator is the node ``/analyzers``, unless ``/analyzers/set_parameters_atomically`` is remapped.
"""

from __future__ import annotations

import asyncio
from typing import Any

from linkwright.diagnostics import foreign, phrase
from linkwright.diagnostics.translation import localized
from linkwright.graph import Graph
from linkwright.messages import get_service
from linkwright.nodes.diagnostic_aggregator.creation import list_analyzer_keys
from linkwright.nodes.options import NodeOptions, SingleNode, create_node

_SERVICE_TYPE, _SERVICE = "rcl_interfaces/srv/SetParametersAtomically", "/analyzers/set_parameters_atomically"
_CHECK_PERIOD_S, _LOG_PERIOD_S = 0.05, 1.0


class AddAnalyzer(SingleNode):
    """The running add_analyzer node, which waits for the aggregator and exits with status 1 if it refuses."""

    DEFAULT_NAME = "add_analyzer_node"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME, any_parameters=True)
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._client = self._node.create_client(get_service(_SERVICE_TYPE), _SERVICE)
        self._timer = self._node.create_timer(_CHECK_PERIOD_S, self._call_when_available)
        self._waited_s = 0.0

    def _call_when_available(self) -> None:
        if self._client.service_is_ready():
            self._timer.cancel()
            self._client.call_async(self._make_request()).add_done_callback(self._finish)
            return
        self._waited_s += _CHECK_PERIOD_S
        if self._waited_s >= _LOG_PERIOD_S:
            self._waited_s = 0.0
            self._node.get_logger().info(
                localized(phrase("waiting for the service '{service}' of the aggregator", service=_SERVICE))
            )

    def _make_request(self) -> Any:
        parameters = self._node.get_parameters_by_prefix("")
        beginnings = tuple(f"{key}." for key in list_analyzer_keys(parameters))
        messages = [value.to_parameter_msg() for name, value in parameters.items() if name.startswith(beginnings)]
        return self._client.srv_type.Request(parameters=messages)

    def _finish(self, future: Any) -> None:
        result = future.result().result
        if not result.successful:
            self._node.get_logger().error(
                localized(phrase("the aggregator refuses the analyzers: {reason}", reason=foreign(result.reason)))
            )
        if not self.finished.done():
            self.finished.set_result(0 if result.successful else 1)
