"""component_container: loads nodes into its process and unloads them (rclcpp_components)."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager, nullcontext
from typing import Any

from linkwright.diagnostics import Diagnostic, LinkwrightError, did_you_mean, joined, phrase
from linkwright.graph import Graph, Parameter
from linkwright.graph.command_line.ros_arguments import parse
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.messages import get_service
from linkwright.nodes.options import COMPONENTS, NodeOptions, RunningNode, SingleNode, create_node, handle_start_errors


class ComponentContainer(SingleNode):
    """The running component container.

    The container offers the services ``~/_container/load_node``, ``unload_node`` and ``list_nodes``, as
    rclcpp_components does. It can load the components of Linkwright (`COMPONENTS`); other components are compiled
    libraries, which it cannot load. If a component creates further nodes, such as costmaps, they receive the
    parameters from the parameter files of the container's process.

    Attributes:
        on_loaded: callbacks, which receive each loaded node and its options.
        loading: a function that returns a context, which is active while a node is created, to attribute its log lines.
    """

    DEFAULT_NAME = "ComponentManager"

    def __init__(self, graph: Graph, options: NodeOptions) -> None:
        self._graph = graph
        self._library = options.library
        self._for_others = ParameterRules()
        self._for_others.add(options.parameters_of_others)
        self._for_others.add(parse(options.arguments).parameters)
        self._node, _ = create_node(graph, options, self.DEFAULT_NAME)
        self._loaded_nodes: dict[int, RunningNode] = {}
        self._last_id = 0
        self.on_loaded: list[Callable[[RunningNode, NodeOptions], None]] = []
        self.loading: Callable[[], AbstractContextManager[object]] = nullcontext
        with handle_start_errors(self._node):
            for name, type_name, callback in (
                ("load_node", "LoadNode", self._load),
                ("unload_node", "UnloadNode", self._unload),
                ("list_nodes", "ListNodes", self._list),
            ):
                self._node.create_service(f"composition_interfaces/srv/{type_name}", f"~/_container/{name}", callback)

    @property
    def loaded(self) -> dict[int, RunningNode]:
        """The loaded nodes by unique ID."""
        return dict(self._loaded_nodes)

    def close(self) -> None:
        """Unload all nodes and close the container."""
        for node_id in tuple(self._loaded_nodes):
            self._close(node_id)
        super().close()

    def load(self, package: str, plugin: str, options: NodeOptions) -> tuple[int, RunningNode]:
        """Load a component, and return the unique ID and the node.

        Raises:
            LinkwrightError: NODE601 if there is no such component, or an error of the node itself.
        """
        factory = COMPONENTS.get((package, plugin))
        if factory is None:
            raise _missing_component_error(package, plugin)
        with self.loading():
            running_node = factory(self._graph, options)
        self._last_id += 1
        self._loaded_nodes[self._last_id] = running_node
        for callback in self.on_loaded:
            callback(running_node, options)
        return self._last_id, running_node

    def _load(self, request: Any, response: Any) -> Any:
        logger = self._node.get_logger()
        logger.info(f"Load Library: {request.package_name}")
        options = NodeOptions(
            name=request.node_name or None,
            namespace=request.node_namespace or "/",
            parameters={
                parameter.name: Parameter.from_parameter_msg(parameter).value for parameter in request.parameters
            },
            remappings=[_parse_remapping(rule) for rule in request.remap_rules],
            library=self._library,
            parameters_of_others=self._for_others,
        )
        try:
            node_id, running_node = self.load(request.package_name, request.plugin_name, options)
        except LinkwrightError as error:
            problem = error.diagnostics[0].message
            logger.error(f"Component constructor threw an exception: {problem}")  # noqa: TRY400 - a user's mistake
            response.success = False
            response.error_message = "; ".join(_to_text(diagnostic) for diagnostic in error.diagnostics)
            return response
        logger.info(f"Instantiate class: rclcpp_components::NodeFactoryTemplate<{request.plugin_name}>")
        response.success = True
        response.unique_id = node_id
        response.full_node_name = running_node.node.get_fully_qualified_name()
        return response

    def _unload(self, request: Any, response: Any) -> Any:
        if request.unique_id not in self._loaded_nodes:
            response.success = False
            response.error_message = f"No node found with unique_id: {request.unique_id}"
            self._node.get_logger().warning(response.error_message)
            return response
        self._close(request.unique_id)
        response.success = True
        return response

    def _list(self, _: Any, response: Any) -> Any:
        for node_id, running_node in self._loaded_nodes.items():
            response.unique_ids.append(node_id)
            response.full_node_names.append(running_node.node.get_fully_qualified_name())
        return response

    def _close(self, node_id: int) -> None:
        self._loaded_nodes.pop(node_id).close()


def load_request() -> Any:
    """Return an empty request for the service ``load_node``."""
    return get_service("composition_interfaces/srv/LoadNode").Request()


def _missing_component_error(package: str, plugin: str) -> LinkwrightError:
    message = phrase(
        "Failed to find class with the requested plugin name: package '{package}' has no component '{plugin}'",
        package=package,
        plugin=plugin,
    )
    package_plugins = [name for owner, name in COMPONENTS if owner == package]
    suggestion = did_you_mean(plugin, package_plugins) or did_you_mean(plugin, [name for _, name in COMPONENTS])
    if suggestion is None and package_plugins:
        suggestion = phrase("the package has {names}", names=joined(package_plugins))
    hint = suggestion or phrase(
        "without ROS, only Linkwright's own nodes can be composed, because other components are compiled libraries"
    )
    return LinkwrightError(Diagnostic("NODE601", message, hint=hint))


def _to_text(diagnostic: Diagnostic) -> str:
    return diagnostic.message if diagnostic.hint is None else f"{diagnostic.message} ({diagnostic.hint})"


def _parse_remapping(rule: str) -> tuple[str, str]:
    source, _, target = rule.partition(":=")
    return source, target
