"""Plans of hosted nodes and viewers, and the interface between the host of nodes and its run."""

from __future__ import annotations

import os
from collections.abc import Callable, Coroutine, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from linkwright.hosting.last_minutes import DEFAULT_HISTORY
from linkwright.hosting.launch_log import LaunchLog, output_destinations

if TYPE_CHECKING:
    from linkwright.descriptions import DescriptionLibrary
    from linkwright.graph.parameters.parameter import ParameterRules
    from linkwright.hosting.reload import LiveReload
    from linkwright.hosting.xacro_calls import Descriptions
    from linkwright.nodes import NodeOptions
    from linkwright.packages import PackageFinder
    from linkwright.rviz import RvizConfig
    from linkwright.viewer import Viewer

VIEWER = ("rviz2", "rviz2")
"""Package and executable of RViz, which our viewer replaces."""

_GAZEBO_WINDOW = "gzclient"
"""The executable of Gazebo's window, which our viewer replaces too."""


@dataclass(eq=False)
class HostedPlan:
    """The plan of a node or viewer that is started in this process.

    Attributes:
        owner: the object that requests the node, such as an action of a launch file; None for a node that another node
            needs.
        process_name: the name in the log, such as ``robot_state_publisher-1``.
        package: the package of the node.
        executable: the executable in that package.
        node_name: the name given to the node, or None.
        namespace: the namespace of the node.
        parameters: values by name.
        remappings: rules ``(from, to)``.
        arguments: the command line.
        viewer_config: returns the viewer's configuration; by default the command line selects it.
        viewer_started: called with the viewer after it has started.
        destinations: the destinations of the node's lines on stdout (1) and stderr (2), see
            `linkwright.hosting.launch_log`.
        respawns: how often the node is restarted after it has finished; without limit if negative.
        respawn_delay: the seconds to wait before a restart.
        for_others: parameters for further nodes that the node creates, by node name; None for none.
        environment: the environment variables at the time of the plan.
        waits: whether a node that cannot start because of its model file is started as soon as the file is fixed.
    """

    owner: Any
    process_name: str
    package: str
    executable: str
    node_name: str | None
    namespace: str
    parameters: dict[str, Any] = field(default_factory=dict)
    remappings: list[tuple[str, str]] = field(default_factory=list)
    arguments: list[str] = field(default_factory=list)
    viewer_config: Callable[[], RvizConfig] | None = None
    viewer_started: Callable[[Viewer], object] | None = None
    destinations: Mapping[int, frozenset[str]] = field(default_factory=lambda: output_destinations("screen"))
    respawns: int = 0
    respawn_delay: float = 0.0
    waits: bool = True
    for_others: ParameterRules | None = None
    environment: Mapping[str, str] = field(default_factory=lambda: dict(os.environ))

    @property
    def is_viewer(self) -> bool:
        """Whether the node is RViz, which our viewer replaces."""
        return is_viewer(self.package, self.executable)

    @property
    def opens_gazebo_window(self) -> bool:
        """Whether the executable is Gazebo's window, or also opens that window."""
        return self.executable == _GAZEBO_WINDOW or self.parameters.get("gui") is True

    @property
    def gazebo_window(self) -> HostedPlan:
        """The plan of the viewer that replaces Gazebo's window."""
        from linkwright.hosting.world_config import world_config

        return HostedPlan(
            None,
            f"{self.process_name}-window",
            *VIEWER,
            "viewer",
            "/",
            {"use_sim_time": True},
            viewer_config=lambda: world_config("Gazebo"),
        )

    def node_options(self, library: DescriptionLibrary) -> NodeOptions:
        """Return the options for starting the node.

        `library` contains the robot descriptions that the process has read.
        """
        from linkwright.graph.parameters.parameter import ParameterRules
        from linkwright.nodes import NodeOptions

        return NodeOptions(
            name=self.node_name,
            namespace=self.namespace,
            parameters=dict(self.parameters),
            remappings=self.remappings,
            arguments=self.arguments,
            library=library,
            for_others=self.for_others or ParameterRules(),
            environment=self.environment,
        )

    @property
    def details(self) -> dict[str, Any]:
        """The details of the node's launch events."""
        command = [self.executable, *self.arguments]
        return {"name": self.process_name, "cmd": command, "cwd": None, "env": None, "pid": os.getpid()}


def is_viewer(package: str | None, executable: str) -> bool:
    """Return whether a node is RViz, which our viewer replaces."""
    return (package, executable) == VIEWER


@dataclass(frozen=True)
class HostOptions:
    """The options of the nodes and viewers of this process.

    Attributes:
        host: the address that the viewer's server binds to.
        port: the server's port; None for the default port, or the next free one.
        open_browser: whether the page is opened in the user's browser.
        title: the title of the page.
        network: whether the nodes join the ROS 2 network, where other programs discover them.
        history: the maximum number of bytes of messages that a viewer stores as live history; 0 for no history.
        rviz: the file with the viewer's configuration; None for the default one.
    """

    host: str = "127.0.0.1"
    port: int | None = None
    open_browser: bool = True
    title: str = ""
    network: bool = True
    history: int = DEFAULT_HISTORY
    rviz: Path | None = None


class Supervisor(Protocol):
    """The run to which a host belongs: a launch, or the view of one model."""

    @property
    def finder(self) -> PackageFinder:
        """The finder of packages."""

    @property
    def options(self) -> HostOptions:
        """The options of nodes and viewers."""

    @property
    def log(self) -> LaunchLog:
        """The log of the run."""

    @property
    def descriptions(self) -> Descriptions:
        """The robot descriptions of the run."""

    @property
    def reload(self) -> LiveReload:
        """The live reload, which passes new texts of descriptions to nodes."""

    @property
    def ending(self) -> bool:
        """Whether the run is about to end."""

    @property
    def has_processes(self) -> bool:
        """Whether the run includes any processes in addition to nodes."""

    def fail(self, what: object) -> None:
        """Record a failure of `what`: the exit status is 1 unless the failure is cleared."""

    def clear_failure(self, what: object) -> None:
        """Clear the recorded failure of `what`, because it was fixed."""

    def spawn(self, work: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background; the run waits for it before it ends."""

    def shut_down(self, reason: str) -> None:
        """End the run as soon as the current work is completed."""

    def node_started(self, plan: HostedPlan) -> None:
        """Handle the start of a node or viewer."""

    def node_ended(self, plan: HostedPlan, status: int) -> None:
        """Handle the end of a node or viewer, or its failure to start, with an exit status."""
