"""talker_qos and listener_qos of demo_nodes_py, with options for reliability and count."""

from __future__ import annotations

import argparse
import asyncio
from abc import ABC, abstractmethod
from collections.abc import Sequence

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import SENSOR_DATA_QOS, Graph, QoSProfile
from linkwright.messages import String
from linkwright.nodes.options import NodeOptions, SingleNode, create_node, handle_start_errors

_PERIOD_S = 1.0
_QUEUE_DEPTH = 10
_UNLIMITED_COUNT = 1 << 31


class _CountingNode(SingleNode, ABC):
    """The base class of both nodes: parses arguments, and ends after a number of messages."""

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self.finished: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._node, arguments = create_node(graph, options, self.DEFAULT_NAME)
        self._count = 0
        with handle_start_errors(self._node):
            settings = _parse_arguments(self.DEFAULT_NAME, arguments)
            self._message_limit = settings.number_of_cycles
            self._create_endpoint(QoSProfile.of(_QUEUE_DEPTH) if settings.reliable else SENSOR_DATA_QOS)
        self._node.get_logger().info(f"{'Reliable' if settings.reliable else 'Best effort'} {self._role}")

    _role: str

    @abstractmethod
    def _create_endpoint(self, qos: QoSProfile) -> None: ...

    def _count_message(self) -> None:
        self._count += 1
        if self._count >= self._message_limit and not self.finished.done():
            self.finished.set_result(0)


class TalkerQos(_CountingNode):
    """The running talker_qos node."""

    DEFAULT_NAME = "talker_qos"
    _role = "talker"

    def _create_endpoint(self, qos: QoSProfile) -> None:
        self._publisher = self._node.create_publisher(String, "chatter", qos)
        self._node.create_timer(_PERIOD_S, self._talk)

    def _talk(self) -> None:
        text = f"Hello World: {self._count}"
        self._node.get_logger().info(f'Publishing: "{text}"')
        self._publisher.publish(String(data=text))
        self._count_message()


class ListenerQos(_CountingNode):
    """The running listener_qos node."""

    DEFAULT_NAME = "listener_qos"
    _role = "listener"

    def _create_endpoint(self, qos: QoSProfile) -> None:
        self._node.create_subscription(String, "chatter", self._receive, qos)

    def _receive(self, message: String) -> None:
        self._node.get_logger().info(f"I heard: [{message.data}]")
        self._count_message()


def _parse_arguments(name: str, arguments: Sequence[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog=name, add_help=False, exit_on_error=False)
    parser.add_argument("--reliable", action="store_true")
    parser.add_argument("-n", "--number_of_cycles", type=int, default=_UNLIMITED_COUNT)
    try:
        return parser.parse_known_args(arguments)[0]
    except argparse.ArgumentError as error:
        raise LinkwrightError(
            Diagnostic(
                "NODE602", phrase("the arguments of '{name}' are invalid: {error}", name=name, error=foreign(error))
            )
        ) from error
