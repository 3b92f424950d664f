"""What a node of this room is started with, and what starting one gives."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, Protocol

from linkwright.diagnostics import LinkwrightError
from linkwright.graph import Graph, Node
from linkwright.nodes.ros_arguments import split_ros_arguments
from linkwright.urdf import DescriptionLibrary


@dataclass(slots=True)
class NodeOptions:
    """How to start a node, as a launch file or a command line says it.

    Attributes:
        name: its name; None for the one its code gives it.
        namespace: where it lives.
        parameters: values by name; nested dictionaries stand for names with dots.
        remappings: rules ``(from, to)``.
        arguments: its command line without the program's name; ``--ros-args`` sections count.
        library: the readings of robot descriptions that the process shares.
    """

    name: str | None = None
    namespace: str = "/"
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    library: DescriptionLibrary = field(default_factory=DescriptionLibrary)


class RunningNode(Protocol):
    """A node that was started."""

    @property
    def node(self) -> Node:
        """Its node in the graph."""

    def close(self) -> None:
        """End it and take it out of the graph."""


Factory = Callable[[Graph, NodeOptions], RunningNode]
"""Starts a node; raises LinkwrightError when it cannot start."""


def create_node(graph: Graph, options: NodeOptions, default_name: str) -> tuple[Node, list[str]]:
    """The graph node for the options, and the arguments that are not ROS arguments.

    Raises:
        LinkwrightError: a name, a remapping or a ROS argument is not valid.
    """
    ros, arguments = split_ros_arguments(options.arguments)
    node = graph.create_node(
        options.name or default_name,
        namespace=options.namespace,
        parameters={**options.parameters, **ros.parameters},
        remappings=[*ros.remappings, *options.remappings],
    )
    if ros.log_level is not None:
        node.get_logger().level = ros.log_level
    return node, arguments


@contextmanager
def starting(node: Node) -> Iterator[None]:
    """While a node starts: an error in what it was given is logged as FATAL, ends the node, and goes on upwards."""
    try:
        yield
    except LinkwrightError as error:
        node.get_logger().fatal(error.diagnostics[0].message)
        node.destroy_node()
        raise
