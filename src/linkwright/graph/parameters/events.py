"""Callbacks for changes of parameters, of any node, as ``rclpy.parameter_event_handler`` has them."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Any

from linkwright.graph.qos import PARAMETER_EVENTS_QOS, QoSProfile


@dataclass(eq=False)
class ParameterCallbackHandle:
    """A callback for one parameter of one node; kept to take it away again."""

    parameter_name: str
    node_name: str
    callback: Callable[[Any], object]


@dataclass(eq=False)
class ParameterEventCallbackHandle:
    """A callback for all events; kept to take it away again."""

    callback: Callable[[Any], object]


class ParameterEventHandler:
    """Subscribes to ``/parameter_events`` and tells of single parameters, or of whole events.

    Callbacks that were added last are called first.

    Args:
        node: subscribes.
        qos_profile: that of the subscription.
        options: what else ``create_subscription`` of the node takes.
    """

    def __init__(self, node: Any, qos_profile: QoSProfile = PARAMETER_EVENTS_QOS, **options: Any) -> None:
        from linkwright.messages import get_message

        self.node = node
        self.qos_profile = qos_profile
        self._lock = threading.Lock()
        self._of_parameters: list[ParameterCallbackHandle] = []
        self._of_events: list[ParameterEventCallbackHandle] = []
        event_type = get_message("rcl_interfaces/msg/ParameterEvent")
        self.parameter_event_subscription = node.create_subscription(
            event_type, "/parameter_events", self._on_event, qos_profile, **options
        )

    def destroy(self) -> None:
        """Listen no more."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], object]
    ) -> ParameterCallbackHandle:
        """Have a callback called with the rcl_interfaces/msg/Parameter whenever a parameter gets a value.

        Args:
            parameter_name: its name.
            node_name: the node whose it is: absolute, relative to the namespace of our node, or empty for our node.
            callback: what is called.
        """
        handle = ParameterCallbackHandle(parameter_name, self._resolved(node_name), callback)
        with self._lock:
            self._of_parameters.insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Take a callback away.

        Raises:
            RuntimeError: it is not there.
        """
        with self._lock:
            if handle not in self._of_parameters:
                raise RuntimeError("Callback doesn't exist")
            self._of_parameters.remove(handle)

    def add_parameter_event_callback(self, callback: Callable[[Any], object]) -> ParameterEventCallbackHandle:
        """Have a callback called with every rcl_interfaces/msg/ParameterEvent."""
        handle = ParameterEventCallbackHandle(callback)
        with self._lock:
            self._of_events.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Take a callback away.

        Raises:
            RuntimeError: it is not there.
        """
        with self._lock:
            if handle not in self._of_events:
                raise RuntimeError("Callback doesn't exist")
            self._of_events.remove(handle)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any:
        """The new value of a parameter in an event, as rcl_interfaces/msg/Parameter; None when it is not in it."""
        if event.node == node_name:
            for parameter in chain(event.new_parameters, event.changed_parameters):
                if parameter.name == parameter_name:
                    return parameter
        return None

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterator[Any]:
        """All parameters that got a value in an event."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def _on_event(self, event: Any) -> None:
        with self._lock:
            of_parameters, of_events = list(self._of_parameters), list(self._of_events)
        for handle in of_parameters:
            parameter = self.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if parameter is not None:
                handle.callback(parameter)
        for each in of_events:
            each.callback(event)

    def _resolved(self, node_name: str) -> str:
        if not node_name:
            return str(self.node.get_fully_qualified_name())
        if node_name.startswith("/"):
            return node_name
        namespace = str(self.node.get_namespace()).strip("/")
        return f"/{namespace}/{node_name}" if namespace else f"/{node_name}"
