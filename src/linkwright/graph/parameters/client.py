"""A client for the parameters of another node, as in ``rclpy.parameter_client``."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.graph.parameters.files import read_parameter_file
from linkwright.graph.parameters.parameter import ANY_NODE, Parameter, get_service_type
from linkwright.graph.qos.profile import PARAMETER_EVENTS_QOS, SERVICES_QOS, QoSProfile

if TYPE_CHECKING:
    from linkwright.graph.loop.future import Future
    from linkwright.graph.loop.node_handle import CallbackGroup

_SERVICES = (
    "describe_parameters",
    "get_parameters",
    "get_parameter_types",
    "list_parameters",
    "set_parameters",
    "set_parameters_atomically",
)
_POLL_INTERVAL_S = 0.05

Done = Callable[..., Any]


class AsyncParameterClient:
    """A client that reads and sets the parameters of another node through its services.

    Each method that sends a request returns a future that gets the service's response. The optional callback of the
    method is called when the future is done.

    Args:
        node: the node that owns the service clients.
        remote_node_name: the name of the other node, absolute or relative to the namespace of `node`.
        qos_profile: the QoS of the clients.
        callback_group: the callback group of the clients.
    """

    def __init__(
        self,
        node: Any,
        remote_node_name: str,
        qos_profile: QoSProfile = SERVICES_QOS,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.remote_node_name = remote_node_name
        self.node = node
        self._clients: dict[str, Any] = {
            service: node.create_client(
                get_service_type(service),
                f"{remote_node_name}/{service}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )
            for service in _SERVICES
        }

    def services_are_ready(self) -> bool:
        """Return whether all parameter services of the other node are available."""
        return all(client.service_is_ready() for client in self._clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Block the calling thread until all parameter services of the other node are available.

        No other thread needs to spin.

        Args:
            timeout_sec: the maximum wait, in seconds; None for no limit.

        Returns:
            Whether all services are available.
        """
        deadline_s = None if timeout_sec is None else time.monotonic() + timeout_sec
        while not self.services_are_ready():
            if deadline_s is not None and time.monotonic() >= deadline_s:
                return False
            time.sleep(_POLL_INTERVAL_S)
        return True

    def destroy(self) -> None:
        """Destroy the service clients."""
        for client in self._clients.values():
            self.node.destroy_client(client)
        self._clients.clear()

    def list_parameters(
        self, prefixes: list[str] | None = None, depth: int | None = None, callback: Done | None = None
    ) -> Future[Any]:
        """Request the parameter names. See `NodeParameters.list_parameters`."""
        return self._send_request("list_parameters", callback, prefixes=prefixes or [], depth=depth or 0)

    def get_parameters(self, names: list[str], callback: Done | None = None) -> Future[Any]:
        """Request the values of parameters."""
        return self._send_request("get_parameters", callback, names=names)

    def get_parameter_types(self, names: list[str], callback: Done | None = None) -> Future[Any]:
        """Request the types of parameters."""
        return self._send_request("get_parameter_types", callback, names=names)

    def describe_parameters(self, names: list[str], callback: Done | None = None) -> Future[Any]:
        """Request the descriptors of parameters."""
        return self._send_request("describe_parameters", callback, names=names)

    def set_parameters(self, parameters: Sequence[Any], callback: Done | None = None) -> Future[Any]:
        """Set parameters one by one.

        Each is a `Parameter` or an rcl_interfaces/msg/Parameter.
        """
        return self._send_request("set_parameters", callback, parameters=_convert_parameters(parameters))

    def set_parameters_atomically(self, parameters: Sequence[Any], callback: Done | None = None) -> Future[Any]:
        """Set either all of the given parameters or none."""
        return self._send_request("set_parameters_atomically", callback, parameters=_convert_parameters(parameters))

    def delete_parameters(self, names: list[str], callback: Done | None = None) -> Future[Any]:
        """Undeclare parameters whose descriptors allow dynamic typing."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self, parameter_file: str, use_wildcard: bool = False, callback: Done | None = None
    ) -> Future[Any]:
        """Set the parameters that a file contains. See `parameter_dict_from_yaml_file`."""
        return self.set_parameters(list(parameter_dict_from_yaml_file(parameter_file, use_wildcard).values()), callback)

    def load_parameter_file_atomically(
        self, parameter_file: str, use_wildcard: bool = False, callback: Done | None = None
    ) -> Future[Any]:
        """Set either all of the parameters that a file contains or none."""
        parameters = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters_atomically(list(parameters.values()), callback)

    def on_parameter_event(
        self, callback: Callable[..., Any], qos_profile: QoSProfile = PARAMETER_EVENTS_QOS, **options: Any
    ) -> Any:
        """Subscribe to changes to the parameters of all nodes."""
        event_type = _get_message_type("ParameterEvent")
        return self.node.create_subscription(event_type, "/parameter_events", callback, qos_profile, **options)

    def _send_request(self, service: str, callback: Done | None, **fields: Any) -> Future[Any]:
        client = self._clients[service]
        request = client.srv_type.Request()
        for name, value in fields.items():
            setattr(request, name, value)
        future: Future[Any] = client.call_async(request)
        if callback is not None:
            future.add_done_callback(callback)
        return future


def parameter_dict_from_yaml_file(
    parameter_file: str, use_wildcard: bool = False, target_nodes: list[str] | None = None, namespace: str = ""
) -> dict[str, Any]:
    """Return the parameters in a file as rcl_interfaces/msg/Parameter messages, by name.

    Args:
        parameter_file: the path of the file.
        use_wildcard: whether to include values for any node (``/**``), which values for single nodes override.
        target_nodes: the nodes whose parameters are read; by default all nodes in the file.
        namespace: a prefix for each name.

    Raises:
        LinkwrightError: the file cannot be read, or is not a parameter file (GRAPH211, GRAPH212).
        RuntimeError: the file has no values for one of the nodes, or none at all (rclpy).
    """
    sections = dict(read_parameter_file(parameter_file))
    patterns = [ANY_NODE] if use_wildcard and ANY_NODE in sections else []
    if target_nodes:
        for node in target_nodes:
            pattern = node if node.startswith("/") else f"/{node}"
            if pattern not in sections:
                raise RuntimeError(
                    f"Param file does not contain parameters for {node},only for nodes: {list(sections)} "
                )
            patterns.append(pattern)
    else:
        patterns += [pattern for pattern in sections if pattern != ANY_NODE]
    if not patterns:
        raise RuntimeError("Param file does not contain selected parameters")
    values = {name: value for pattern in patterns for name, value in sections[pattern].items()}
    return {
        namespace + name: Parameter(namespace + name, value=value).to_parameter_msg() for name, value in values.items()
    }


def _convert_parameters(parameters: Sequence[Any]) -> list[Any]:
    return [parameter.to_parameter_msg() if isinstance(parameter, Parameter) else parameter for parameter in parameters]


def _get_message_type(name: str) -> Any:
    from linkwright.messages import get_message

    return get_message(f"rcl_interfaces/msg/{name}")
