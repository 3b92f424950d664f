"""The services of a node through which others read and set its parameters, and the topic that tells of changes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from linkwright.graph.parameters.errors import (
    ParameterException,
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.qos import PARAMETER_EVENTS_QOS, PARAMETERS_QOS

if TYPE_CHECKING:
    from linkwright.graph.node import Node
    from linkwright.graph.parameters.store import ParameterChange
    from linkwright.graph.publisher import Publisher


class ParameterServices:
    """The six services, named after the node: ``~/describe_parameters`` and so on.

    Their types are built when the first request comes. Answers are those of rclpy: where one of several names asked
    for is not declared, the answer is empty.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        name = node.get_name()
        for service, type_name, callback in (
            ("describe_parameters", "DescribeParameters", self._describe),
            ("get_parameters", "GetParameters", self._get),
            ("get_parameter_types", "GetParameterTypes", self._get_types),
            ("list_parameters", "ListParameters", self._list),
            ("set_parameters", "SetParameters", self._set),
            ("set_parameters_atomically", "SetParametersAtomically", self._set_atomically),
        ):
            node.create_service(
                f"rcl_interfaces/srv/{type_name}", f"{name}/{service}", callback, qos_profile=PARAMETERS_QOS
            )

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
        response.results = [self._set_together([each]) for each in request.parameters]
        return response

    def _set_atomically(self, request: Any, response: Any) -> Any:
        response.result = self._set_together(request.parameters)
        return response

    def _set_together(self, messages: Any) -> Any:
        from linkwright.graph.parameters.messages import interface

        try:
            return self._node.set_parameters_atomically([Parameter.from_parameter_msg(each) for each in messages])
        except (ParameterException, ValueError) as error:
            return interface("SetParametersResult")(successful=False, reason=str(error))


class ParameterEvents:
    """Publishes what changes among a node's parameters on ``/parameter_events``.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher: Publisher[Any] = node.create_publisher(
            "rcl_interfaces/msg/ParameterEvent", "/parameter_events", PARAMETER_EVENTS_QOS
        )

    def publish(self, change: ParameterChange) -> None:
        """Publish a change, if somebody listens: the topic keeps nothing for late comers."""
        if not self._publisher.get_subscription_count():
            return
        event: Any = self._publisher.msg_type()
        event.stamp = self._node.get_clock().now().to_msg()
        event.node = self._node.get_fully_qualified_name()
        event.new_parameters = [each.to_parameter_msg() for each in change.new]
        event.changed_parameters = [each.to_parameter_msg() for each in change.changed]
        event.deleted_parameters = [each.to_parameter_msg() for each in change.deleted]
        self._publisher.publish(event)
