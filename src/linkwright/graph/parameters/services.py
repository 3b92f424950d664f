"""The services of a node through which others read and set its parameters, and the topic of parameter events."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.parameters.errors import (
    ParameterException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from linkwright.graph.parameters.node_parameters import NodeParameters
from linkwright.graph.parameters.parameter import Parameter, interface, service_type
from linkwright.graph.parameters.store import ParameterChange
from linkwright.graph.qos.profile import PARAMETERS_QOS
from linkwright.graph.time.clock import Clock

EVENTS_TYPE = "rcl_interfaces/msg/ParameterEvent"
EVENTS_TOPIC = "/parameter_events"


class ParameterServices:
    """The six services, named after the node: ``~/describe_parameters`` and so on.

    Their types are built when the first request comes. Answers are those of rclpy: where one of several names asked
    for is not declared, the answer is empty.

    Args:
        node: whose parameters they are.
        node_name: its name.
        create_service: its `Node.create_service`.
    """

    def __init__(self, node: NodeParameters, node_name: str, create_service: Callable[..., object]) -> None:
        self._node = node
        for service, callback in (
            ("describe_parameters", self._describe),
            ("get_parameters", self._get),
            ("get_parameter_types", self._get_types),
            ("list_parameters", self._list),
            ("set_parameters", self._set),
            ("set_parameters_atomically", self._set_atomically),
        ):
            create_service(service_type(service), f"{node_name}/{service}", callback, qos_profile=PARAMETERS_QOS)

    def _describe(self, request: Any, response: Any) -> Any:
        try:
            response.descriptors = self._node.describe_parameters(request.names)
        except ParameterNotDeclaredException:
            response.descriptors = []
        return response

    def _get(self, request: Any, response: Any) -> Any:
        try:
            response.values = [self._node.get_parameter(name).get_parameter_value() for name in request.names]
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            response.values = []
        return response

    def _get_types(self, request: Any, response: Any) -> Any:
        try:
            response.types = self._node.get_parameter_types(request.names)
        except ParameterNotDeclaredException:
            response.types = []
        return response

    def _list(self, request: Any, response: Any) -> Any:
        response.result = self._node.list_parameters(list(request.prefixes), request.depth)
        return response

    def _set(self, request: Any, response: Any) -> Any:
        response.results = [self._set_together([parameter]) for parameter in request.parameters]
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._set_together(request.parameters)
        return response

    def _set_together(self, messages: Any) -> Any:
        try:
            return self._node.set_parameters_atomically([Parameter.from_parameter_msg(message) for message in messages])
        except (ParameterException, ValueError) as error:
            return interface("SetParametersResult")(successful=False, reason=str(error))


class ParameterEvents:
    """Publishes the changes of a node's parameters.

    Args:
        publisher: of ``/parameter_events``.
        clock: stamps the events.
        node_name: the full name of the node.
    """

    def __init__(self, publisher: Publisher[Any], clock: Clock, node_name: str) -> None:
        self._publisher = publisher
        self._clock = clock
        self._node_name = node_name

    def publish(self, change: ParameterChange) -> None:
        """Publish a change, if a subscription matches: the topic keeps nothing for late joiners."""
        if not self._publisher.get_subscription_count():
            return
        event: Any = self._publisher.msg_type()
        event.stamp = self._clock.now().to_msg()
        event.node = self._node_name
        event.new_parameters = [parameter.to_parameter_msg() for parameter in change.new]
        event.changed_parameters = [parameter.to_parameter_msg() for parameter in change.changed]
        event.deleted_parameters = [parameter.to_parameter_msg() for parameter in change.deleted]
        self._publisher.publish(event)
