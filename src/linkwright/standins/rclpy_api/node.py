"""Nodes with a context and its command line (rclpy ``node``)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from linkwright.graph import Node as GraphNode
from linkwright.graph.command_line.ros_arguments import RosArguments
from linkwright.graph.logger_services import LoggerServices
from linkwright.graph.loop.timer import Rate
from linkwright.graph.names.rules import Remappings, absolute_namespace, join
from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.qos.profile import ROSOUT_QOS, QoSProfile
from linkwright.graph.time.clock import Clock
from linkwright.standins.rclpy_api.context import Context, read_ros_arguments
from linkwright.standins.rclpy_api.defaults import check_initialized, get_default_context


def _collect_parameter_overrides(
    node_name: str, namespace: str, remappings: Sequence[tuple[str, str]], command_lines: Sequence[RosArguments]
) -> dict[str, Any]:
    """Return the parameter overrides of a node from command lines.

    The first command line takes precedence.
    """
    rules = Remappings(remappings)
    full_name = join(absolute_namespace(rules.namespace(namespace, node_name)), rules.node_name(node_name))
    overrides: dict[str, Any] = {}
    for arguments in reversed(command_lines):
        overrides |= arguments.parameters_for(full_name)
    return overrides


class Node(GraphNode):
    """A node in the graph of a context, and the base class of users' nodes.

    Args:
        node_name: the name of the node, which the command line can change.
        context: the context of the node; None for the default context.
        cli_args: a command line that applies to this node only.
        namespace: the namespace of the node, which the command line can change.
        use_global_arguments: whether the command line of the context applies to the node.
        enable_rosout: whether the node publishes its log messages on ``/rosout``.
        rosout_qos_profile: the QoS profile of ``/rosout``.
        start_parameter_services: whether other nodes can read and set the node's parameters.
        parameter_overrides: values that take precedence over defaults and over the command lines.
        allow_undeclared_parameters: whether parameters can be set and read without being declared.
        automatically_declare_parameters_from_overrides: whether all parameters with overrides are declared.
        enable_logger_service: whether other nodes can read and set the levels of the node's loggers.

    Raises:
        NotInitializedError: the context is not initialized.
        InvalidNodeNameError, InvalidNamespaceError: the name or the namespace is not valid.
    """

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile | int = ROSOUT_QOS,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        # The name is mangled so that it cannot collide with attributes of users' nodes.
        self.__context = get_default_context() if context is None else context
        check_initialized(self.__context, "cannot create node")
        node_arguments = read_ros_arguments(cli_args or [])
        command_lines = [node_arguments, self.__context.ros_arguments] if use_global_arguments else [node_arguments]
        remappings = [rule for line in command_lines for rule in line.remappings_for(node_name)]
        overrides = _collect_parameter_overrides(node_name, namespace or "/", remappings, command_lines)
        overrides |= {parameter.name: parameter.value for parameter in parameter_overrides or ()}
        graph = self.__context.graph
        super().__init__(
            graph,
            node_name,
            namespace=namespace or "/",
            remappings=remappings,
            parameters=overrides,
            enclave=self.__context.ros_arguments.enclave or "/",
            enable_rosout=enable_rosout and self.__context.enable_rosout,
            rosout_qos_profile=rosout_qos_profile,
            start_parameter_services=start_parameter_services,
            allow_undeclared_parameters=allow_undeclared_parameters,
            automatically_declare_parameters_from_overrides=automatically_declare_parameters_from_overrides,
            copies_messages=True,
        )
        GraphNode.get_clock(self).context = self.__context
        if enable_logger_service:
            LoggerServices(self, graph.levels)
        self.__context.wait_for_network()

    def create_rate(self, frequency: float, clock: Clock | None = None) -> Rate:
        """Create a rate, with which a loop sleeps until its next iteration.

        A signal that shuts the context down ends the sleep, also if no thread runs the node's callbacks.

        Args:
            frequency: iterations per second.
            clock: the clock that measures time; the node's clock by default.

        Raises:
            ValueError: the frequency is not positive.
        """
        rate = super().create_rate(frequency, clock)
        self.__context.wake_on_signal(rate)
        return rate

    @property
    def context(self) -> Context:
        """The node's context."""
        return self.__context
