"""Nodes that are loaded into a container (``launch_ros.descriptions``)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError
from linkwright.launch.errors.locations import Located, with_location
from linkwright.launch.model.action import parse_condition
from linkwright.launch.model.context import LaunchContext
from linkwright.launch.model.markup.entity import parse_attributes
from linkwright.launch.model.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from linkwright.launch.ros.deprecated_arguments import with_deprecated_arguments
from linkwright.launch.ros.names import (
    RemapRule,
    evaluate_rules,
    make_namespace_absolute,
    normalize_remap_rules,
    prefix_namespace,
)
from linkwright.launch.ros.parameter_lists import normalize_parameters
from linkwright.launch.ros.parameters import (
    FileSource,
    NodeParameters,
    evaluate_own_parameters,
    evaluate_scope_parameters,
)
from linkwright.launch.ros.parsing import Entities, parse_parameters, parse_remappings
from linkwright.launch.ros.scoping import NAMESPACE, PARAMETERS, REMAPPINGS

if TYPE_CHECKING:
    from linkwright.launch.model.conditions import Condition
    from linkwright.launch.model.markup.entity import Entity, Parser


@with_deprecated_arguments(node_plugin="plugin", node_name="name", node_namespace="namespace")
class ComposableNode(Located):
    """A node that can be loaded into a container.

    Args:
        package: the package of the node's library.
        plugin: the name of the node's class in the library, such as ``composition::Talker``.
        name: the name to give to the node.
        namespace: the namespace of the node. Without a leading slash, it is relative to the namespaces of
            `PushRosNamespace`.
        parameters: the parameters, as for a `Node`.
        remappings: pairs of an original name and a new name.
        extra_arguments: parameters that are passed to the container, such as ``use_intra_process_comms``.
        condition: decides whether the node is loaded; None to load it always.
    """

    def __init__(
        self,
        *,
        package: SomeSubstitutionsType,
        plugin: SomeSubstitutionsType,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        parameters: Sequence[Any] | None = None,
        remappings: Iterable[tuple[SomeSubstitutionsType, SomeSubstitutionsType]] | None = None,
        extra_arguments: Sequence[Any] | None = None,
        condition: Condition | None = None,
    ) -> None:
        self.__package = normalize_to_list_of_substitutions(package)
        self.__node_plugin = normalize_to_list_of_substitutions(plugin)
        self.__node_name = None if name is None else normalize_to_list_of_substitutions(name)
        self.__node_namespace = None if namespace is None else normalize_to_list_of_substitutions(namespace)
        self.__parameters = None if parameters is None else normalize_parameters(parameters)
        self.__remappings = None if remappings is None else list(normalize_remap_rules(remappings))
        self.__extra_arguments = None if extra_arguments is None else normalize_parameters(extra_arguments)
        self.__condition = condition

    @classmethod
    def parse(cls, parser: Parser, entity: Entity) -> tuple[type[ComposableNode], dict[str, Any]]:
        """Return the class and keyword arguments for the tag ``composable_node``.

        Raises:
            RuntimeError: LAUNCH118, the tag has both ``if`` and ``unless``.
        """
        kwargs: dict[str, Any] = {
            "package": parser.parse_substitution(entity.get_attr("pkg")),
            "plugin": parser.parse_substitution(entity.get_attr("plugin")),
            **parse_condition(entity, parser),
            **parse_attributes(entity, parser, name="name", namespace="namespace"),
            **parse_remappings(entity, parser),
        }
        parameters = entity.get_attr("param", data_type=Entities, optional=True)
        if parameters is not None:
            kwargs["parameters"] = parse_parameters(parameters, parser)
        extra_tags = entity.get_attr("extra_arg", data_type=Entities, optional=True)
        if extra_tags is not None:
            kwargs["extra_arguments"] = [_parse_extra_argument(tag, parser) for tag in extra_tags]
        entity.assert_entity_completely_parsed()
        return cls, kwargs

    @property
    def package(self) -> list[Substitution]:
        """The package, as substitutions."""
        return self.__package

    @property
    def node_plugin(self) -> list[Substitution]:
        """The name of the node's class, as substitutions."""
        return self.__node_plugin

    @property
    def node_name(self) -> Any:
        """The name of the node as substitutions, or None if the node's code sets the name."""
        return self.__node_name

    @property
    def node_namespace(self) -> list[Substitution] | None:
        """The node's namespace, as substitutions, or None."""
        return self.__node_namespace

    @property
    def parameters(self) -> tuple[Any, ...] | None:
        """The normalized parameters of the node, or None."""
        return self.__parameters

    @property
    def remappings(self) -> list[RemapRule] | None:
        """The remapping rules of the node, as pairs of tuples of substitutions, or None."""
        return self.__remappings

    @property
    def extra_arguments(self) -> tuple[Any, ...] | None:
        """The normalized parameters for the container, or None."""
        return self.__extra_arguments

    def condition(self) -> Condition | None:
        """Return the condition that decides whether the node is loaded, or None."""
        return self.__condition


class ComposableLifecycleNode(ComposableNode):
    """A lifecycle node that can be loaded into a container.

    Args:
        autostart: whether the node is configured and activated when it is loaded.
        kwargs: see `ComposableNode`.
    """

    is_lifecycle_node = True

    def __init__(self, *, autostart: Any = False, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.__autostart = autostart
        self.__full_name: str | None = None

    @property
    def node_autostart(self) -> Any:
        """Whether the node is configured and activated when it is loaded."""
        return self.__autostart

    @property
    def node_name(self) -> Any:
        """The name of the node as substitutions, or its full name once it is loaded."""
        return super().node_name if self.__full_name is None else self.__full_name

    def record_full_name(self, full_name: str) -> None:
        """Record the full name with which the node was loaded."""
        self.__full_name = full_name


def get_composable_node_load_request(description: ComposableNode, context: LaunchContext) -> Any:
    """Return the request to load a node into a container.

    The result is None if the node's condition does not hold.

    Raises:
        LinkwrightError: the parameters of the node have errors.
    """
    condition = description.condition()
    if condition is not None and not condition.evaluate(context):
        return None
    from linkwright.nodes.component_container import load_request

    request = load_request()
    request.package_name = perform_substitutions(context, description.package)
    request.plugin_name = perform_substitutions(context, description.node_plugin)
    if description.node_name is not None:
        request.node_name = perform_substitutions(context, description.node_name)
    node_namespace = description.node_namespace
    inner_namespace = None if node_namespace is None else perform_substitutions(context, node_namespace)
    namespace = make_namespace_absolute(prefix_namespace(context.launch_configurations.get(NAMESPACE), inner_namespace))
    if namespace is not None:
        request.node_namespace = namespace
    rules = [
        *(context.launch_configurations.get(REMAPPINGS) or ()),
        *evaluate_rules(context, description.remappings or ()),
    ]
    request.remap_rules = [f"{source}:={target}" for source, target in rules]
    full_name = f"{(namespace or '').rstrip('/')}/{request.node_name}"
    try:
        scope = evaluate_scope_parameters(context.launch_configurations.get(PARAMETERS) or (), context)
        node_parameters = evaluate_own_parameters(description.parameters or (), context)
        parameters = NodeParameters([*scope.sources, *node_parameters.sources])
        request.parameters = _make_parameter_messages(context, full_name, parameters.sources)
        parameters.check(context, full_name if request.node_name else None, description.source_location)
        request.extra_arguments = _make_parameter_messages(
            context, full_name, evaluate_own_parameters(description.extra_arguments or (), context).sources
        )
    except LinkwrightError as error:
        raise with_location(error, description.source_location) from error
    return request


def to_parameters_list(
    context: LaunchContext, node_name: str, namespace: str | None, evaluated_parameters: Iterable[Any]
) -> list[Any]:
    """Return evaluated parameters as ``rclpy.parameter.Parameter`` objects.

    A parameter file may have values for several nodes. The full name of the node selects its values.
    """
    full_name = f"{(namespace or '').rstrip('/')}/{node_name.lstrip('/')}"
    full_name = full_name if full_name.startswith("/") else f"/{full_name}"
    return _read_parameters(context, full_name, evaluate_own_parameters(tuple(evaluated_parameters), context).sources)


def _make_parameter_messages(context: LaunchContext, full_name: str, sources: Iterable[Any]) -> list[Any]:
    return [parameter.to_parameter_msg() for parameter in _read_parameters(context, full_name, sources)]


def _read_parameters(context: LaunchContext, full_name: str, sources: Iterable[Any]) -> list[Any]:
    from linkwright.graph import Parameter

    parameters: list[Any] = []
    for source in sources:
        if isinstance(source, FileSource):
            values = _read_file_values(source, context, full_name)
        elif isinstance(source, tuple):
            values = dict([source])
        else:
            values = source
        parameters += [
            Parameter(name, value=list(value) if isinstance(value, tuple) else value) for name, value in values.items()
        ]
    return parameters


def _read_file_values(source: FileSource, context: LaunchContext, full_name: str) -> dict[str, Any]:
    """Return the values that a parameter file has for a node.

    As in launch_ros, values under the node's full name override values under patterns.
    """
    try:
        rules = source.file.read_rules(context)
    except LinkwrightError as error:
        raise _as_runtime_error(error, source.path) from error
    exact_values = {name: value for pattern, values in rules if pattern == full_name for name, value in values.items()}
    return {**rules.for_node(full_name), **exact_values}


def _as_runtime_error(error: LinkwrightError, path: Path) -> LinkwrightError:
    from linkwright.launch.errors.exceptions import as_ros_error

    return as_ros_error(RuntimeError(f"{path}: {error.diagnostics[0].message}"), *error.diagnostics)


def _parse_extra_argument(tag: Entity, parser: Parser) -> dict[Any, Any]:
    name = tuple(parser.parse_substitution(tag.get_attr("name")))
    value = parser.parse_substitution(tag.get_attr("value"))
    tag.assert_entity_completely_parsed()
    return {name: value}
