"""Nodes that can be started in this process: their options, interfaces and registry.

Nodes are declared by entry points of the groups ``linkwright.nodes`` and ``linkwright.components``. The names of the
entry points are ``PACKAGE/EXECUTABLE``, or ``PACKAGE/PLUGIN`` for nodes that containers load. Each entry point refers
to a `Factory`. Linkwright's entry points are in its ``pyproject.toml``; other packages can declare their own. A module
is imported when its first node is started.
"""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar, runtime_checkable

from linkwright.diagnostics import Diagnostic, LinkwrightError, foreign, phrase
from linkwright.graph import Graph, Node
from linkwright.graph.command_line.ros_arguments import RosArguments, parse
from linkwright.graph.names.rules import Remappings, absolute_namespace, join
from linkwright.graph.parameters.parameter import ParameterRules
from linkwright.loading.extensions import extensions

if TYPE_CHECKING:
    from linkwright.descriptions import DescriptionLibrary
    from linkwright.loading.extensions import EntryPoint
    from linkwright.nodes.watched_files import FileWatcher


N = TypeVar("N", bound=Node)


def _create_library() -> DescriptionLibrary:
    from linkwright.descriptions import DescriptionLibrary

    return DescriptionLibrary()


def _print_line(line: str) -> None:
    print(line, flush=True)


@dataclass(slots=True)
class NodeOptions:
    """The options of a node, from a launch file or a command line.

    Attributes:
        name: the name; None for the default name of the node.
        namespace: the namespace of the node.
        parameters: the values by name; nested dictionaries represent names with dots.
        remappings: the rules ``(from, to)``.
        arguments: the command line without the program's name, including ``--ros-args`` sections.
        library: the parsed robot descriptions that the process shares.
        parameters_of_others: the parameters of other nodes that the node creates, by node name, from the parameter
            files of its process.
        environment: the environment variables that the node uses to find files; by default the environment of the
            process.
        output: receives the lines that the node prints as its result; by default standard output.
        terminal: the file descriptor of a terminal that only this node uses; None if the node shares its process.
    """

    name: str | None = None
    namespace: str = "/"
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    library: DescriptionLibrary = field(default_factory=_create_library)
    parameters_of_others: ParameterRules = field(default_factory=ParameterRules)
    environment: Mapping[str, str] = field(default_factory=lambda: os.environ)
    output: Callable[[str], None] = _print_line
    terminal: int | None = None


class RunningNode(Protocol):
    """A running node.

    Some nodes also implement one of the protocols below; the host checks which ones a node implements.
    """

    @property
    def node(self) -> Node:
        """The node in the graph."""

    def close(self) -> None:
        """Close the node and remove it from the graph."""


@runtime_checkable
class FinishingNode(RunningNode, Protocol):
    """A node that ends by itself."""

    finished: asyncio.Future[int]
    """Receives the exit status when the node is done. The node must then be closed."""


@runtime_checkable
class LoadingNode(RunningNode, Protocol):
    """A node that loads further nodes into its process."""

    on_loaded: list[Callable[[RunningNode, NodeOptions], None]]
    """The functions to call with each loaded node and its options."""
    loading: Callable[[], AbstractContextManager[object]]
    """The function that returns a context for the creation of a node. The host replaces this function."""


@runtime_checkable
class NodeWithDescription(RunningNode, Protocol):
    """A node whose host reports the findings about its robot description."""

    @property
    def description_parameter(self) -> str:
        """The name of the parameter that contains the description."""


@runtime_checkable
class NodeWithFiles(RunningNode, Protocol):
    """A node that reloads its files when they are saved."""

    def watch_files(self, host: FileWatcher) -> None:
        """Make the host watch the node's files.

        This method is called once on the event loop, after the node has started.
        """


@runtime_checkable
class NodeWithWindow(RunningNode, Protocol):
    """A node whose window is a panel of the page."""

    @property
    def window_feature(self) -> str:
        """The page feature of the panel, as ``module:class``; its method ``show`` is called with the node."""


class SingleNode:
    """The base class of nodes with a single graph node, `_node`.

    `close` destroys it.

    Attributes:
        DEFAULT_NAME: the name of a node whose options do not set a name; not defined if each node has a different name.
    """

    DEFAULT_NAME: ClassVar[str]

    _node: Node

    @property
    def node(self) -> Node:
        """The node in the graph."""
        return self._node

    def close(self) -> None:
        """Destroy the node."""
        self._node.destroy_node()


Factory = Callable[[Graph, NodeOptions], RunningNode]
"""A function that starts a node. It raises LinkwrightError if the node cannot start."""


def create_node(
    graph: Graph, options: NodeOptions, default_name: str, *, any_parameters: bool = False
) -> tuple[Node, list[str]]:
    """Create a node from options.

    Args:
        graph: the graph to which the node is added.
        options: the options of the node.
        default_name: the name of the node if the options do not set one.
        any_parameters: whether to declare all parameters in the options, and to accept undeclared parameters.

    Returns:
        The node, and the command-line arguments that are not ROS arguments.

    Raises:
        LinkwrightError: a name, a remapping or a ROS argument is not valid.
    """
    return create_node_with_class(Node, graph, options, default_name, any_parameters=any_parameters)


def create_node_with_class(
    node_class: Callable[..., N],
    graph: Graph,
    options: NodeOptions,
    default_name: str,
    *,
    any_parameters: bool = False,
) -> tuple[N, list[str]]:
    """Create a node as `create_node` does, with a given class.

    The class is a subclass of `Node`, or a function that creates one.

    Raises:
        LinkwrightError: a name, a remapping or a ROS argument is not valid.
    """
    ros_arguments = parse(options.arguments)
    name = options.name or default_name
    remappings = [*ros_arguments.remappings_for(name), *options.remappings]
    node = node_class(
        graph,
        name,
        namespace=options.namespace,
        parameters={
            **options.parameters,
            **ros_arguments.parameters_for(_compute_full_name(name, options.namespace, remappings)),
        },
        remappings=remappings,
        enclave=ros_arguments.enclave or "/",
        enable_rosout=ros_arguments.rosout_logs is not False,
        allow_undeclared_parameters=any_parameters,
        automatically_declare_parameters_from_overrides=any_parameters,
    )
    _set_log_levels(graph, node, ros_arguments)
    return node, ros_arguments.non_ros_arguments


@contextmanager
def handle_start_errors(node: Node) -> Iterator[None]:
    """Return a context that handles a LinkwrightError during the start of a node.

    The error is logged as FATAL, the node is destroyed, and the error is raised again.
    """
    try:
        yield
    except LinkwrightError as error:
        node.get_logger().fatal(error.diagnostics[0].message)
        node.destroy_node()
        raise


def _compute_full_name(name: str, namespace: str, remappings: list[tuple[str, str]]) -> str:
    rules = Remappings(remappings)
    return join(absolute_namespace(rules.namespace(namespace, name)), rules.node_name(name))


def _set_log_levels(graph: Graph, node: Node, ros_arguments: RosArguments) -> None:
    """Apply the options ``--log-level``.

    An option without the name of a logger applies only to this node, which may share its process with other nodes.
    """
    if ros_arguments.log_level is not None:
        node.get_logger().set_level(ros_arguments.log_level)
    for logger, level in ros_arguments.log_levels.items():
        graph.get_logger(logger).set_level(level)


class NodeRegistry(Mapping[tuple[str, str], Factory]):
    """A mapping from package and executable to the function or class that starts the node.

    Args:
        group: the group of the entry points.
    """

    def __init__(self, group: str) -> None:
        self._group = group

    @cached_property
    def entry_points(self) -> dict[tuple[str, str], EntryPoint]:
        """The entry points by package and executable or plugin."""
        entry_points: dict[tuple[str, str], EntryPoint] = {}
        for name, entry_point in extensions(self._group).items():
            package, _, node = name.partition("/")
            entry_points[package, node] = entry_point
        return entry_points

    def __getitem__(self, key: tuple[str, str]) -> Factory:
        """Return the function or class that starts a node.

        Raises:
            KeyError: there is no such node.
            LinkwrightError: NODE002, the package that provides the node cannot be imported.
        """
        entry_point = self.entry_points[key]
        try:
            factory: Factory = entry_point.load()
        except Exception as error:
            package, name = key
            message = phrase("the node '{package}/{name}' cannot be imported", package=package, name=name)
            hint = phrase(
                "fix the Python package '{package}', whose import fails: {problem}",
                package=entry_point.distribution,
                problem=foreign(error),
            )
            raise LinkwrightError(Diagnostic("NODE002", message, hint=hint)) from error
        return factory

    def __contains__(self, key: object) -> bool:
        return key in self.entry_points

    def __iter__(self) -> Iterator[tuple[str, str]]:
        return iter(self.entry_points)

    def __len__(self) -> int:
        return len(self.entry_points)


def find_default_name(package: str, executable: str) -> str | None:
    """Return the default name of a node, or None if only the node's own code determines it."""
    with suppress(LinkwrightError, KeyError):
        name: str | None = getattr(EXECUTABLES[package, executable], "DEFAULT_NAME", None)
        return name
    return None


EXECUTABLES = NodeRegistry("linkwright.nodes")
"""The nodes that a launch file or a command can name."""

COMPONENTS = NodeRegistry("linkwright.components")
"""The nodes that can be composed."""
