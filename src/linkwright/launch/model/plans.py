"""What actions have the engine run: processes, and nodes in the launcher's own process."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from linkwright.launch.log.launch_log import output_destinations
from linkwright.launch.model.events import ProcessAction

if TYPE_CHECKING:
    from linkwright.descriptions import DescriptionLibrary
    from linkwright.nodes import NodeOptions
    from linkwright.viewer import RvizConfig

VIEWER = ("rviz2", "rviz2")
"""Package and executable of RViz, for which our viewer stands in."""


@dataclass(frozen=True)
class ProcessPlan:
    """A process to be started; see `ExecuteLocal` for what the parts mean."""

    action: ProcessAction
    name: str
    command: Sequence[str]
    folder: str | None
    environment: Mapping[str, str]
    shell: bool
    emulate_tty: bool
    destinations: Mapping[int, frozenset[str]]
    output_format: str
    log_command: bool
    respawn: bool
    respawn_delay: float
    respawn_limit: int
    seconds_to_sigterm: float
    seconds_to_sigkill: float


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
        destinations: where its lines on stdout (1) and stderr (2) go, see `linkwright.launch.log.launch_log`.
        respawns: how often it is started again when it has done its work; without end if negative.
        respawn_delay: seconds to wait before that.
    """

    action: ProcessAction
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
