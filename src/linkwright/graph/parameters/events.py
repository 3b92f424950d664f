"""Callbacks for changes to any node's parameters, as in ``rclpy.parameter_event_handler``."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Any, TypeVar

from linkwright.graph.qos.profile import PARAMETER_EVENTS_QOS, QoSProfile

H = TypeVar("H")


@dataclass(eq=False)
class ParameterCallbackHandle:
    """The handle for removing a callback for one parameter of one node."""

    parameter_name: str
    node_name: str
    callback: Callable[[Any], object]


@dataclass(eq=False)
class ParameterEventCallbackHandle:
    """The handle for removing a callback for all events."""

    callback: Callable[[Any], object]


class _Callbacks:
    """The callbacks of a `ParameterEventHandler`, in the reverse order of their registration.

    Attributes:
        parameter_callbacks: the callbacks for single parameters, by parameter name and node name.
        event_callbacks: the callbacks for all events.
    """

    def __init__(self) -> None:
        self._lock = threading.RLock()
        self.parameter_callbacks: dict[tuple[str, str], list[ParameterCallbackHandle]] = {}
        self.event_callbacks: list[ParameterEventCallbackHandle] = []

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], object]
    ) -> ParameterCallbackHandle:
        """Add a callback for one parameter of the node with the full name `node_name`."""
        handle = ParameterCallbackHandle(parameter_name, node_name, callback)
        with self._lock:
            self.parameter_callbacks.setdefault((parameter_name, node_name), []).insert(0, handle)
        return handle

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove a callback for one parameter.

        Raise RuntimeError if it is not registered.
        """
        key = (handle.parameter_name, handle.node_name)
        with self._lock:
            _remove(handle, self.parameter_callbacks.get(key, []))
            if not self.parameter_callbacks[key]:
                del self.parameter_callbacks[key]

    def add_parameter_event_callback(self, callback: Callable[[Any], object]) -> ParameterEventCallbackHandle:
        """Add a callback for all events."""
        handle = ParameterEventCallbackHandle(callback)
        with self._lock:
            self.event_callbacks.insert(0, handle)
        return handle

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove a callback for all events.

        Raise RuntimeError if it is not registered.
        """
        with self._lock:
            _remove(handle, self.event_callbacks)

    def event_callback(self, event: Any) -> None:
        """Call the callbacks of the parameters in an event, then the callbacks for all events."""
        with self._lock:
            parameter_handles = [handle for handles in self.parameter_callbacks.values() for handle in handles]
            event_handles = list(self.event_callbacks)
        for handle in parameter_handles:
            parameter = ParameterEventHandler.get_parameter_from_event(event, handle.parameter_name, handle.node_name)
            if parameter is not None:
                handle.callback(parameter)
        for event_handle in event_handles:
            event_handle.callback(event)


def _remove(handle: H, handles: list[H]) -> None:
    if handle not in handles:
        raise RuntimeError("Callback doesn't exist")
    handles.remove(handle)


class ParameterEventHandler:
    """A registry of callbacks for the events on ``/parameter_events`` or for single parameters.

    Callbacks are called in the reverse order of their registration.

    Args:
        node: the node that owns the subscription.
        qos_profile: the QoS of the subscription.
        options: further arguments for the node's ``create_subscription``.
    """

    Callbacks = _Callbacks

    def __init__(self, node: Any, qos_profile: QoSProfile = PARAMETER_EVENTS_QOS, **options: Any) -> None:
        from linkwright.messages import get_message

        self.node = node
        self.qos_profile = qos_profile
        self._callbacks = self.Callbacks()
        event_type = get_message("rcl_interfaces/msg/ParameterEvent")
        self.parameter_event_subscription = node.create_subscription(
            event_type, "/parameter_events", self._callbacks.event_callback, qos_profile, **options
        )

    def destroy(self) -> None:
        """Destroy the subscription."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], object]
    ) -> ParameterCallbackHandle:
        """Register a callback for one parameter of one node.

        Args:
            parameter_name: the name of the parameter.
            node_name: the node that has the parameter: absolute, relative to the namespace of the handler's node, or
                empty for the handler's node.
            callback: called with the rcl_interfaces/msg/Parameter whenever the parameter is set.
        """
        return self._callbacks.add_parameter_callback(parameter_name, self._resolve_path(node_name), callback)

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove a callback for one parameter.

        Raises:
            RuntimeError: the callback is not registered.
        """
        self._callbacks.remove_parameter_callback(handle)

    def add_parameter_event_callback(self, callback: Callable[[Any], object]) -> ParameterEventCallbackHandle:
        """Register a callback that receives every rcl_interfaces/msg/ParameterEvent."""
        return self._callbacks.add_parameter_event_callback(callback)

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove a callback for all events.

        Raises:
            RuntimeError: the callback is not registered.
        """
        self._callbacks.remove_parameter_event_callback(handle)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any:
        """Return the new value of a parameter in an event, as rcl_interfaces/msg/Parameter.

        Returns None if the event does not contain the parameter.
        """
        if event.node == node_name:
            for parameter in chain(event.new_parameters, event.changed_parameters):
                if parameter.name == parameter_name:
                    return parameter
        return None

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterator[Any]:
        """Iterate over the parameters that an event reports as new or changed."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def _resolve_path(self, node_path: str = "") -> str:
        """Return the full name of a node.

        Args:
            node_path: absolute, relative to the namespace of the handler's node, or empty for the handler's node.
        """
        if not node_path:
            return str(self.node.get_fully_qualified_name())
        if node_path.startswith("/"):
            return node_path
        namespace = str(self.node.get_namespace()).strip("/")
        return f"/{namespace}/{node_path}" if namespace else f"/{node_path}"
