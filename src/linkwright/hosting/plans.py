"""Plans of hosted nodes and viewers, and the interface of a run for the host of nodes."""

from __future__ import annotations

import os
from collections.abc import Callable, Coroutine, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from linkwright.hosting.history_size import DEFAULT_HISTORY
from linkwright.hosting.launch_log import LaunchLog, output_destinations

if TYPE_CHECKING:
    from linkwright.descriptions import DescriptionLibrary
    from linkwright.graph.parameters.parameter import ParameterRules
    from linkwright.hosting.reload import LiveReload
    from linkwright.hosting.rqt_programs import PanelProgram
    from linkwright.hosting.xacro_calls import Descriptions
    from linkwright.nodes import NodeOptions
    from linkwright.packages import PackageFinder
    from linkwright.panels.panel_request import PanelRequest
    from linkwright.rviz import RvizConfig
    from linkwright.viewer import Viewer

VIEWER = ("rviz2", "rviz2")
"""The package and executable of RViz, which Linkwright's viewer replaces."""

_NODES_WITH_WINDOWS = frozenset({("turtlesim", "turtlesim_node")})
"""The nodes that need a page, because a panel of the page replaces their window."""

_GAZEBO_WINDOW = "gzclient"
"""The executable of Gazebo's window, which Linkwright's viewer also replaces."""


@dataclass(eq=False)
class HostedPlan:
    """The plan of a node or viewer that is started in this process.

    Attributes:
        owner: the object that requested the node, such as an action of a launch file; None if another node needs the
            node.
        process_name: the name of the node in the log, such as ``robot_state_publisher-1``.
        package: the package of the node.
        executable: the name of the executable in that package.
        node_name: the name of the node; None for the name that its code sets.
        namespace: the namespace of the node.
        parameters: the values of the parameters by name.
        remappings: pairs of an original name and a new name.
        arguments: the command-line arguments.
        viewer_config: returns the configuration of the viewer; None if the command line determines it.
        viewer_started: called with the viewer after its start; None if no call is needed.
        destinations: the destinations of the lines that the node writes to stdout (1) and stderr (2), see
            `linkwright.hosting.launch_log`.
        respawns: the maximum number of restarts after the node has finished; unlimited if negative.
        respawn_delay: the seconds to wait before a restart.
        parameters_of_others: parameters, by node name, for other nodes that the node creates; None if there are none.
        environment: the environment variables when the plan was created.
        waits_for_fix: whether a node with an invalid description file is started when the file is fixed.
        replaced_window: the name of the window that a viewer replaces, for the log.
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
    waits_for_fix: bool = True
    replaced_window: str = "RViz"
    parameters_of_others: ParameterRules | None = None
    environment: Mapping[str, str] = field(default_factory=lambda: dict(os.environ))

    @property
    def is_viewer(self) -> bool:
        """Whether the node is RViz, which Linkwright's viewer replaces."""
        return is_viewer(self.package, self.executable)

    @property
    def panel_program(self) -> PanelProgram | None:
        """The program of rqt whose window is a panel of the page, or None for other nodes."""
        return _find_panel_program(self.package, self.executable)

    @property
    def has_panel(self) -> bool:
        """Whether the node needs a page: a panel of the page replaces its window."""
        return has_window(self.package, self.executable) or self.panel_program is not None

    @property
    def opens_gazebo_window(self) -> bool:
        """Whether the executable is Gazebo's window, or opens that window."""
        return self.executable == _GAZEBO_WINDOW or self.parameters.get("gui") is True

    @property
    def gazebo_window(self) -> HostedPlan:
        """The plan of the viewer that replaces Gazebo's window."""
        from linkwright.hosting.world_config import create_world_config

        return HostedPlan(
            None,
            f"{self.process_name}-window",
            *VIEWER,
            "viewer",
            "/",
            {"use_sim_time": True},
            viewer_config=lambda: create_world_config("Gazebo"),
            replaced_window="Gazebo's window",
        )

    @property
    def panel_page(self) -> HostedPlan:
        """The plan of the viewer that opens for a panel if no viewer is running."""
        page = HostedPlan(None, f"{self.process_name}-page", *VIEWER, "viewer", "/")
        if self.panel_program is not None:
            page.replaced_window = "the windows of rqt"
        else:
            page.replaced_window = f"the window of {self.executable}"
            page.viewer_config = _create_window_config
        return page

    def node_options(self, library: DescriptionLibrary) -> NodeOptions:
        """Return the options with which the node is started.

        The library contains the robot descriptions that this process has read.
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
            parameters_of_others=self.parameters_of_others or ParameterRules(),
            environment=self.environment,
        )

    @property
    def details(self) -> dict[str, Any]:
        """The attributes of the launch events of the node."""
        command = [self.executable, *self.arguments]
        return {"name": self.process_name, "cmd": command, "cwd": None, "env": None, "pid": os.getpid()}


class NodeWithPanel:
    """A node whose window is a panel of the page.

    Attributes:
        requests: the panels to open; empty if the page opens as it is.
    """

    requests: Sequence[PanelRequest]


def is_viewer(package: str | None, executable: str) -> bool:
    """Return whether a node is RViz, which Linkwright's viewer replaces."""
    return (package, executable) == VIEWER


def has_window(package: str | None, executable: str) -> bool:
    """Return whether a node has a window that a panel of the page replaces, besides the programs of rqt."""
    return (package, executable) in _NODES_WITH_WINDOWS


def opens_page(package: str | None, executable: str) -> bool:
    """Return whether Linkwright's page replaces the window of a node: RViz, one of rqt, or turtlesim."""
    return (
        is_viewer(package, executable)
        or has_window(package, executable)
        or _find_panel_program(package, executable) is not None
    )


def _create_window_config() -> RvizConfig:
    """Return RViz's default configuration without its panels, in the frame of the tutorials about tf2."""
    from linkwright.rviz import RvizConfig

    config = RvizConfig.default("<window>")
    config.panels.show(["time"])
    config.options.set(("Fixed Frame",), "world")
    return config


def _find_panel_program(package: str | None, executable: str) -> PanelProgram | None:
    """Return the program of rqt or image_view whose window is a panel of the page, or None for other nodes."""
    if package is None or not package.startswith(("rqt", "image_view")):
        return None
    from linkwright.hosting.rqt_programs import find_panel_program  # few launches start programs of rqt

    return find_panel_program(package, executable)


@dataclass(frozen=True)
class HostOptions:
    """The options of the nodes and viewers in this process.

    Attributes:
        host: the address on which the server of the viewer listens.
        port: the port of the server; None for the default port, or the next one that is free.
        open_browser: whether to open the page in the user's browser.
        title: the title of the page.
        network: whether the nodes join the ROS 2 network, where other programs can discover them.
        history: the maximum number of bytes of messages that a viewer stores; 0 to store none.
        rviz: the path of the viewer's configuration file; None for the default configuration.
        follows_editor: whether a text editor is connected, see `linkwright.hosting.text_editor`.
        terminal: the folder in which pages of this machine can run shells; None to let no page run one.
        needs_terminal: whether the command always has a terminal, so that there is no option to leave out.
        viewer_started: called with each viewer after its start; None if no call is needed.
    """

    host: str = "127.0.0.1"
    port: int | None = None
    open_browser: bool = True
    title: str = ""
    network: bool = True
    history: int = DEFAULT_HISTORY
    rviz: Path | None = None
    follows_editor: bool = False
    terminal: Path | None = None
    needs_terminal: bool = False
    viewer_started: Callable[[Viewer], object] | None = None


class Supervisor(Protocol):
    """The callbacks from a host to the run that owns it: a launch, or a view."""

    @property
    def finder(self) -> PackageFinder:
        """The finder of ROS packages."""

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
    def is_ending(self) -> bool:
        """Whether the run is ending."""

    @property
    def has_processes(self) -> bool:
        """Whether the run has any processes in addition to its nodes."""

    def fail(self, failure: object) -> None:
        """Record a failure, which sets the exit status to 1 unless it is cleared."""

    def clear_failure(self, failure: object) -> None:
        """Clear a failure whose cause has been fixed."""

    def spawn(self, coroutine: Coroutine[Any, Any, None]) -> None:
        """Run a coroutine in the background.

        The run does not end before it has finished.
        """

    def shut_down(self, reason: str) -> None:
        """End the run when the current work is done."""

    def postpones(self, plan: HostedPlan) -> bool:
        """Return whether a node cannot start yet. Then the run schedules it again later."""

    def report_node_start(self, plan: HostedPlan) -> None:
        """Report that a node or viewer has started."""

    def report_node_end(self, plan: HostedPlan, status: int) -> None:
        """Report the exit status of a node or viewer that has ended or could not start."""
