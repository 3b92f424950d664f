"""A node that is to run in the launcher's own process."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from linkwright.launch.engine.log import output_destinations

if TYPE_CHECKING:
    from linkwright.launch.actions.execute import ExecuteLocal
    from linkwright.nodes import NodeOptions
    from linkwright.urdf import DescriptionLibrary
    from linkwright.viewer import RvizConfig

VIEWER = ("rviz2", "rviz2")
"""Package and executable of RViz, for which our viewer stands in."""


@dataclass(eq=False)
class HostedPlan:
    """A node to be started in this process.

    Attributes:
        action: the action that asks for it.
        process_name: its name in the log, such as ``robot_state_publisher-1``.
        package: the package it belongs to.
        executable: its executable there.
        node_name: the name given to it, or None.
        namespace: its namespace.
        parameters: values by name.
        remappings: rules ``(from, to)``.
        arguments: its command line.
        viewer_config: makes the viewer's configuration; by default the command line says which.
        destinations: where its lines on stdout (1) and stderr (2) go, see `linkwright.launch.engine.log`.
        respawns: how often it is started again when it has done its work; without end if negative.
        respawn_delay: seconds to wait before that.
    """

    action: ExecuteLocal
    process_name: str
    package: str
    executable: str
    node_name: str | None
    namespace: str
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    viewer_config: Callable[[], RvizConfig] | None = None
    destinations: Mapping[int, frozenset[str]] = field(default_factory=lambda: output_destinations("screen"))
    respawns: int = 0
    respawn_delay: float = 0.0

    @property
    def is_viewer(self) -> bool:
        """Whether it is RViz, for which our viewer stands in."""
        return is_viewer(self.package, self.executable)

    def node_options(self, library: DescriptionLibrary) -> NodeOptions:
        """How to start it; `library` is the readings of robot descriptions that the process shares."""
        from linkwright.nodes import NodeOptions

        return NodeOptions(
            name=self.node_name,
            namespace=self.namespace,
            parameters=dict(self.parameters),
            remappings=self.remappings,
            arguments=self.arguments,
            library=library,
        )

    @property
    def details(self) -> dict[str, Any]:
        """What events say of it."""
        command = [self.executable, *self.arguments]
        return {"name": self.process_name, "cmd": command, "cwd": None, "env": None, "pid": os.getpid()}


def is_viewer(package: str | None, executable: str) -> bool:
    """Whether a node is RViz, for which our viewer stands in."""
    return (package, executable) == VIEWER


def is_hosted(package: str | None, executable: str) -> bool:
    """Whether a node is one of ours, which runs in this process."""
    if is_viewer(package, executable):
        return True
    from linkwright.nodes import EXECUTABLES

    return (package, executable) in EXECUTABLES


def hosted_executables() -> list[tuple[str, str]]:
    """Package and executable of all nodes that run in this process."""
    from linkwright.nodes import EXECUTABLES

    return [*EXECUTABLES, VIEWER]
