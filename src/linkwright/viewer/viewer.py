"""The viewer: a node of the graph whose window is a page in a browser."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Graph, Parameter, ParameterDescriptor
from linkwright.nodes.options import NodeOptions, create_node
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.access import Gate
from linkwright.viewer.audience import Audience, Page
from linkwright.viewer.configurations import ConfigurationFeature
from linkwright.viewer.description import DescriptionFeature
from linkwright.viewer.diagnostic_items import item_of
from linkwright.viewer.displays import ViewerDisplay
from linkwright.viewer.export.feature import ExportedFiles, ExportFeature
from linkwright.viewer.export.snapshot import Snapshot, no_robot, take_snapshot
from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.frame_history import FrameHistory
from linkwright.viewer.joints import JointBridge
from linkwright.viewer.listening import is_open_to_others, listen
from linkwright.viewer.manager import Surroundings, VisualizationManager
from linkwright.viewer.managers import Managers
from linkwright.viewer.mesh_files import MeshFolders
from linkwright.viewer.monitor import live_panels
from linkwright.viewer.outbox import Payload
from linkwright.viewer.panels_feature import PanelsFeature
from linkwright.viewer.point_inquiry import PointInquiry
from linkwright.viewer.protocol import (
    PROTOCOL_VERSION,
    Diagnostics,
    Hello,
    MarkerFeedback,
    MeshStatus,
    PageMessage,
    ServerMessage,
    SetProperty,
    View,
    ViewState,
)
from linkwright.viewer.recovery import keep_unsaved
from linkwright.viewer.rviz_config import RvizConfig
from linkwright.viewer.time_feature import TimeFeature
from linkwright.viewer.tools_feature import ToolsFeature
from linkwright.viewer.views_feature import ViewsFeature
from linkwright.viewer.wire import encode
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from linkwright.nodes.joint_panel import JointPanel
    from linkwright.viewer.server import WebServer

_NAME = "rviz2"
_FIXED_FRAME = "fixed_frame"
"""A parameter of the node, by which tools learn what the viewer shows and say what it is to show."""


class Viewer:
    """Shows what RViz would show of a graph, in a browser.

    It must be made inside of a running asyncio loop. What pages change is kept in `config`; they save it, or
    `config.save` does.

    Args:
        graph: what it is a node of.
        library: reads descriptions, each once for the whole process.
        finder: finds packages, and so meshes.
        config: displays, options and view.
        host: what to listen on; anything but this machine's loopback address lets others in who know the token.
        port: 0 for any; None for 7447 or the next free one.
        title: of the page.
        options: of the node: its name, remappings, parameters and ROS arguments.

    Raises:
        LinkwrightError: a name, a remapping or a ROS argument is not valid.
    """

    def __init__(
        self,
        graph: Graph,
        *,
        library: DescriptionLibrary,
        finder: PackageFinder,
        config: RvizConfig,
        host: str = "127.0.0.1",
        port: int | None = None,
        title: str = "",
        options: NodeOptions | None = None,
    ) -> None:
        self._host, self._port, self._title = host, port, title
        self._url = ""
        self._node, _ = create_node(graph, options or NodeOptions(), _NAME)
        frame = self._node.declare_parameter(
            _FIXED_FRAME,
            config.options.text("Fixed Frame"),
            ParameterDescriptor(description="the frame that everything is shown in"),
        )
        config.options.set(("Fixed Frame",), frame.value)
        self._meshes = MeshFolders()
        self._audience = Audience(self._opening, self._receive, self._page_gone, self._node.get_logger())
        numbers = itertools.count(1)
        self._surroundings = Surroundings(
            node=self._node,
            library=library,
            finder=finder,
            meshes=self._meshes,
            history=FrameHistory(self._node),
            report=self._report,
            next_id=lambda: f"display-{next(numbers)}",
            robot_changed=self._robot_changed,
        )
        shared = VisualizationManager(
            self._surroundings, config, edited=self._edited, fixed_frame_set=self._tell_parameter
        )
        self._managers = Managers(shared, self._make_own, self._dropped)
        self._node.add_post_set_parameters_callback(self._take_parameters)
        self._joints = JointBridge(self._audience.publish)
        desk = Desk(self._node, library, finder, self._audience.publish, self._managers.of, self._managers.all)
        self._configurations = ConfigurationFeature(desk, self._configured)
        self._descriptions = DescriptionFeature(desk)
        self._exported = ExportedFiles()
        self._features = self._make_features(desk)
        self._diagnostics = Diagnostics([])
        self._server: WebServer | None = None

    # --- life --------------------------------------------------------------------------------------------------

    async def start(self) -> None:
        """Listen, subscribe, and serve.

        Raises:
            LinkwrightError: VIEW101 to VIEW103, it cannot listen where it should.
        """
        try:
            listener = listen(self._host, self._port)
        except Exception:
            self._node.destroy_node()
            raise
        from linkwright.viewer.server import WebServer

        gate = Gate(self._host, listener.getsockname()[1])
        self._server = WebServer(gate, self._audience, self._meshes, self._exported)
        self._url = await self._server.start(listener)
        if is_open_to_others(listener):
            self._node.get_logger().warning(
                f"Listening on '{self._host}': whoever reaches it and knows the token can see and move the robot"
            )
        self._managers.shared.start()
        for feature in self._features:
            feature.start()

    async def close(self) -> None:
        """Say goodbye to the pages, leave the graph and stop listening."""
        for feature in self._features:
            feature.close()
        self._managers.close()
        if self._server is not None:
            await self._server.close()
            self._server = None
        self._node.destroy_node()

    def keep_unsaved(self) -> list[Diagnostic]:
        """Keep what pages edited and did not save, before the program ends; what there is to be said of it."""
        return keep_unsaved(self._managers.all())

    @property
    def url(self) -> str:
        """What to open in a browser, token included; empty before `start`."""
        return self._url

    @property
    def manager(self) -> VisualizationManager:
        """What all pages see that have no displays of their own."""
        return self._managers.shared

    @property
    def config(self) -> RvizConfig:
        """The configuration that all pages share."""
        return self.manager.config

    @property
    def displays(self) -> list[ViewerDisplay]:
        """The displays that all pages share."""
        return self.manager.displays

    # --- what the rest of the program shows --------------------------------------------------------------------

    def attach_joint_panel(self, panel: JointPanel | None) -> None:
        """Show sliders for the joints of a panel; None takes them away."""
        self._joints.attach(panel)

    def show_diagnostics(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show what is wrong with the description; none clears the list."""
        self._diagnostics = Diagnostics([item_of(each) for each in diagnostics])
        self._descriptions.show_diagnostics(diagnostics)
        self._audience.publish(self._diagnostics)

    def snapshot(self, manager: VisualizationManager | None = None, view: View | None = None) -> Snapshot:
        """What is seen now, to be exported.

        Args:
            manager: of the pages that see it; None for what all share.
            view: the camera; None for where a page that opens has it.

        Raises:
            LinkwrightError: VIEW201, there is no robot.
        """
        manager = manager or self.manager
        models = (model for model in manager.robot_models() if model.enabled and model.scene.links)
        model = next(models, None)
        if model is None:
            raise no_robot()
        told, frames = self._told(manager)
        if view is not None:
            told = [ViewState(view, each.revision) if isinstance(each, ViewState) else each for each in told]
        return take_snapshot(model, told, frames, self._meshes)

    # --- pages -------------------------------------------------------------------------------------------------

    def _make_features(self, desk: Desk) -> list[PageFeature]:
        """What pages can ask for besides displays."""
        views = [ViewsFeature(desk), PanelsFeature(desk), ToolsFeature(desk), TimeFeature(desk)]
        own = [*views, PointInquiry(desk), self._exports()]
        return [*own, self._configurations, self._joints, self._descriptions, *live_panels(desk)]

    def _exports(self) -> PageFeature:
        return ExportFeature(
            lambda page, view: self.snapshot(self._managers.of(page), view), self._exported, self._node.get_logger()
        )

    def _opening(self, page: Page) -> list[Payload]:
        manager = self._managers.enter(page)
        messages, frames = self._told(manager)
        manager.pages.add(page)  # what it is told from here on comes after all this
        return [*map(encode, messages), *frames]

    def _told(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """What a page must be told that begins to see a manager, the frame table last; and binary frames."""
        messages: list[ServerMessage] = [Hello(PROTOCOL_VERSION, __version__, self._title)]
        shown, table, frames = manager.opening()
        messages += shown
        for feature in self._features:
            messages += feature.opening()
        return [*messages, *self._configured(manager), self._diagnostics, table], frames

    def _page_gone(self, page: Page) -> None:
        for feature in self._features:
            feature.page_gone(page)
        self._managers.leave(page)

    def _receive(self, page: Page, message: PageMessage) -> None:
        manager = self._managers.of(page)
        if isinstance(message, SetProperty):
            manager.set_property(page, message.id, message.value)
        elif isinstance(message, (MeshStatus, MarkerFeedback)):
            if display := manager.display(message.display):
                display.receive(message)
        else:
            for feature in self._features:
                if isinstance(message, feature.RECEIVES):
                    feature.receive(page, message)

    def _robot_changed(self) -> None:
        self._descriptions.look()

    # --- configurations ----------------------------------------------------------------------------------------

    def _make_own(self) -> VisualizationManager:
        """For a page of its own: a copy of what all see now."""
        manager = VisualizationManager(self._surroundings, self.config.copy(), edited=self._edited)
        manager.start()
        return manager

    def _configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """What pages are told of a configuration besides its displays."""
        return [message for feature in self._features for message in feature.configured(manager)]

    def _edited(self, manager: VisualizationManager) -> None:
        self._configurations.edited(manager)

    def _dropped(self, manager: VisualizationManager) -> None:
        for feature in self._features:
            feature.dropped(manager)

    def _tell_parameter(self, frame: str) -> None:
        if self._node.get_parameter(_FIXED_FRAME).value != frame:
            self._node.set_parameters([Parameter(_FIXED_FRAME, value=frame)])

    def _take_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == _FIXED_FRAME and parameter.value != self.manager.fixed_frame:
                self.manager.set_fixed_frame(str(parameter.value))

    def _report(self, diagnostic: Diagnostic) -> None:
        where = f"{diagnostic.span}: " if diagnostic.span else ""
        logger = self._node.get_logger()
        say: Callable[[str], object] = logger.error if diagnostic.severity is Severity.ERROR else logger.warning
        say(where + diagnostic.message)
