"""A node that is to run in the launcher's own process."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from linkwright.launch.actions.execute import ExecuteProcess
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
    """

    action: ExecuteProcess
    process_name: str
    package: str
    executable: str
    node_name: str | None
    namespace: str
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    viewer_config: Callable[[], RvizConfig] | None = None

    @property
    def is_viewer(self) -> bool:
        """Whether it is RViz, for which our viewer stands in."""
        return (self.package, self.executable) == VIEWER

    @property
    def details(self) -> dict[str, Any]:
        """What events say of it."""
        command = [self.executable, *self.arguments]
        return {"name": self.process_name, "cmd": command, "cwd": None, "env": None, "pid": os.getpid()}


def is_hosted(package: str | None, executable: str) -> bool:
    """Whether a node is one of ours, which runs in this process."""
    if (package, executable) == VIEWER:
        return True
    from linkwright.nodes import EXECUTABLES

    return (package, executable) in EXECUTABLES


def hosted_executables() -> list[tuple[str, str]]:
    """Package and executable of all nodes that run in this process."""
    from linkwright.nodes import EXECUTABLES

    return [*EXECUTABLES, VIEWER]
