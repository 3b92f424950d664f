"""A pause of the running world while something else simulates."""

from __future__ import annotations

from typing import Any

from linkwright.graph import LATCHED_QOS, Client, Node
from linkwright.messages import get_message, get_service

_PAUSE_SERVICE, _RESUME_SERVICE = "/pause_physics", "/unpause_physics"
_STATE_TOPIC, _STATE_TYPE = "/simulation_state", "simulation_interfaces/msg/SimulationState"


class WorldPause:
    """A pause of the world that runs in this graph, if there is one.

    A weak computer cannot simulate two worlds. A world that the user has paused stays paused, and a world that the user
    has resumed in the meantime is not paused again.

    Args:
        node: the node that calls the services of the simulator.

    Attributes:
        is_active: whether a world is paused by this object.
    """

    def __init__(self, node: Node) -> None:
        self.is_active = False
        self._state_type = get_message(_STATE_TYPE)
        self._state: int | None = None
        empty = get_service("std_srvs/srv/Empty")
        self._pause, self._resume = (node.create_client(empty, name) for name in (_PAUSE_SERVICE, _RESUME_SERVICE))
        node.create_subscription(self._state_type, _STATE_TOPIC, self._receive, LATCHED_QOS)

    def set_active(self, active: bool) -> bool:
        """Begin or end the pause, and return whether a world is paused."""
        if active:
            self.begin()
        else:
            self.end()
        return self.is_active

    def begin(self) -> None:
        """Pause the world, if one is running."""
        if self._state == self._state_type.STATE_PLAYING and self._pause.service_is_ready():
            self.is_active = True
            _call_service(self._pause)

    def end(self) -> None:
        """Resume the world that `begin` has paused."""
        if self.is_active and self._state == self._state_type.STATE_PAUSED and self._resume.service_is_ready():
            _call_service(self._resume)
        self.is_active = False

    def _receive(self, message: Any) -> None:
        self._state = message.state


def _call_service(client: Client[Any, Any]) -> None:
    client.call_async(client.srv_type.Request())
