"""A simulator that can only be paused and resumed, for tests."""

from __future__ import annotations

from typing import Any

from linkwright.graph import LATCHED_QOS, Graph
from linkwright.messages import get_message, get_service


class FakeSimulator:
    """Offers the services that pause a simulation, and publishes its state.

    Attributes:
        calls: the names of the services that were called.
    """

    def __init__(self, graph: Graph, *, paused: bool = False) -> None:
        self.calls: list[str] = []
        node = graph.create_node("gazebo")
        self._message = get_message("simulation_interfaces/msg/SimulationState")
        self._publisher = node.create_publisher(self._message, "/simulation_state", LATCHED_QOS)
        empty = get_service("std_srvs/srv/Empty")
        node.create_service(empty, "/pause_physics", self._pause)
        node.create_service(empty, "/unpause_physics", self._resume)
        self.set_paused(paused=paused)

    def set_paused(self, *, paused: bool) -> None:
        """Publish the state."""
        self._publisher.publish(
            self._message(state=self._message.STATE_PAUSED if paused else self._message.STATE_PLAYING)
        )

    def _pause(self, _: Any, response: Any) -> Any:
        self.calls.append("pause")
        self.set_paused(paused=True)
        return response

    def _resume(self, _: Any, response: Any) -> Any:
        self.calls.append("resume")
        self.set_paused(paused=False)
        return response
