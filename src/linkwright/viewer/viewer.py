"""The viewer: a node of the graph with a page in the browser."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Iterable, Sequence
from contextlib import AsyncExitStack
from typing import TYPE_CHECKING, Any

from linkwright._version import __version__
from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, LinkwrightError
from linkwright.graph import Graph, Parameter, ParameterDescriptor
from linkwright.nodes.options import NodeOptions, create_node
from linkwright.packages import PackageFinder
from linkwright.page.audience import Audience, Page
from linkwright.page.outbox import Payload
from linkwright.page.page_server import PageServer
from linkwright.page.protocol.message import PROTOCOL_VERSION, Hello, ServerMessage, encode
from linkwright.panels.joints import JointsFeature
from linkwright.panels.page_feature import F, PageFeature, make_features
from linkwright.panels.timeline import TimelineFeature
from linkwright.rviz.config.locations import store_unsaved
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.context import GraphChanges, PublishedTopics, ViewerContext
from linkwright.rviz.displays.base.display import ViewerDisplay
from linkwright.rviz.frames.history import FrameHistory
from linkwright.rviz.visualization.manager import Managers, VisualizationManager

if TYPE_CHECKING:
    from linkwright.bag import BagReader, Playback
    from linkwright.descriptions.pairs import Pair
    from linkwright.graph import Node
    from linkwright.nodes.joint_state_publisher_gui import JointPanel
    from linkwright.page.uploads import Guests
    from linkwright.panels.live_history import LiveHistory

_NODE_NAME = "rviz2"
_FIXED_FRAME_PARAMETER = "fixed_frame"
"""The parameter of the node with which tools get and set the Fixed Frame."""


class Viewer:
    """A viewer that shows a graph in a browser, as RViz does.

    A viewer must be created while an asyncio loop is running. The edits of pages are in `config`. Pages save them, or
    the program does with `config.save`.

    Args:
        graph: the graph in which the viewer's node is created.
        library: reads descriptions, each of them once per process.
        finder: finds packages and the meshes in them.
        config: the configuration, with displays, options and view.
        host: the address to listen on; any address except loopback admits other machines with the token.
        port: the port; 0 for any free port; None for 7448 or the next free port.
        server: the server, which may already serve the page; None to create a server at `host` and `port`.
        title: the title of the page.
        options: the node's name, remappings, parameters and ROS arguments.
        history: the maximum size in bytes of the stored messages of the last minutes, which pages can show; 0 to store
            none.
        beside: another viewer with a server that also serves the pages of this viewer; None for a separate server.

    Attributes:
        make_guests: creates `guests`; None if pages cannot upload recordings.
        guests: the uploaded recordings that pages show; None before the first one.

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
        server: PageServer | None = None,
        title: str = "",
        options: NodeOptions | None = None,
        history: int = 0,
        beside: Viewer | None = None,
    ) -> None:
        self._history = history
        self._host_viewer = beside
        self.make_guests: Callable[[], Guests] | None = None
        self.guests: Guests | None = None
        self._server = server or PageServer(host, port)
        self._title = title
        self._run = secrets.token_hex(8)
        self._node, _ = create_node(graph, options or NodeOptions(), _NODE_NAME)
        fixed_frame_parameter = self._node.declare_parameter(
            _FIXED_FRAME_PARAMETER,
            config.options.text("Fixed Frame"),
            ParameterDescriptor(description="the reference frame of the scene"),
        )
        config.options.set(("Fixed Frame",), fixed_frame_parameter.value)
        self._receivers: dict[str, Callable[[Page, Any], object]] = {}
        self._audience = Audience(self._create_opening, self._receivers, self._on_page_closed, self._node.get_logger())
        shared_objects: dict[str, Any] = {"meshes": self._server.meshes, "downloads": self._server.downloads}
        if beside is not None:  # share the files, and the IDs, which must be unique on a server
            host_context = beside.context
            shared_objects = {
                "meshes": host_context.meshes,
                "downloads": host_context.downloads,
                "display_ids": host_context.display_ids,
            }
        self.context: ViewerContext = ViewerContext(
            node=self._node,
            library=library,
            finder=finder,
            pages=self._audience,
            transforms=FrameHistory(self._node),
            graph_changes=GraphChanges(self._node.graph),
            published=PublishedTopics(self._node),
            **shared_objects,
        )
        self._features: list[PageFeature] = []
        self._is_started = False
        self.managers = Managers(self.context, config, self)
        self._node.add_post_set_parameters_callback(self._on_parameters_set)
        self.live: LiveHistory | None = None
        for feature in make_features(self):
            self._add(feature)

    # --- lifecycle ---------------------------------------------------------------------------------------------

    async def start(self) -> None:
        """Subscribe to topics, and serve pages.

        Raises:
            LinkwrightError: VIEW101 to VIEW103, the server cannot listen at the address.
        """
        try:
            if self._host_viewer is None:
                await self._open_server()
            if self._history:
                self.live = self._get_timeline.start_history(self._history)
            self.managers.shared.start()
            self._is_started = True
            for feature in self._features:
                feature.start()
            if self._host_viewer is None:
                self._server.show(self._audience, self._open_guests if self.make_guests else None)
        except BaseException:  # also after cancellation, because the caller cannot close this viewer
            self._node.destroy_node()
            await self._server.close()
            raise

    def _open_guests(self) -> Guests:
        assert self.make_guests is not None
        if self.guests is None:
            self.guests = self.make_guests()
        return self.guests

    async def _open_server(self) -> None:
        if not self._server.url:
            await self._server.open()
        if self._server.is_open_to_others:
            host = self._server.host
            self._node.get_logger().warning(
                f"Listening on '{host}': anyone who can reach it and has the token can see and move the robot"
            )

    async def close(self) -> None:
        """Close the connections to pages, destroy the node, and stop listening."""
        self._server.store_pages_wait(pages_wait=len(self._audience) > 0)
        async with AsyncExitStack() as stack:  # each step is carried out even if another step fails
            stack.callback(self._node.destroy_node)
            stack.callback(self.context.published.close)
            if self._host_viewer is not None:
                stack.push_async_callback(self._audience.close)
            stack.push_async_callback(self._server.close)
            stack.callback(self.managers.close)
            for feature in reversed(self._features):
                stack.callback(feature.close)
            if self.guests is not None:
                stack.push_async_callback(self.guests.close)

    @property
    def pages_wait(self) -> bool:
        """Whether pages of the previous program at this port are trying to reconnect."""
        return self._server.pages_wait

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store unsaved edits of pages before the program ends, and return the findings about them."""
        findings = store_unsaved(manager.config for manager in self.managers.all() if manager.history.has_unsaved_edits)
        return [*findings, *(notice for feature in self._features for notice in feature.keep_unsaved())]

    @property
    def url(self) -> str:
        """The address to open in a browser, with the token, or an empty string before `start`."""
        return self._server.url

    @property
    def audience(self) -> Audience:
        """The open pages."""
        return self._audience

    @property
    def manager(self) -> VisualizationManager:
        """The manager shared by all pages without a separate configuration."""
        return self.managers.shared

    @property
    def config(self) -> RvizConfig:
        """The configuration that all pages share."""
        return self.manager.config

    @property
    def displays(self) -> list[ViewerDisplay]:
        """The displays that all pages share."""
        return self.manager.displays

    # --- content from the rest of the program ------------------------------------------------------------------

    def attach_joint_panel(self, panel: JointPanel | None) -> None:
        """Show the sliders of a node that moves joints.

        None removes the sliders.
        """
        self.add_feature(JointsFeature).attach(panel)

    def attach_recording(self, playback: Playback, bag: BagReader) -> None:
        """Show the timeline of a recording in pages."""
        self.live = None
        self._get_timeline.attach(playback, bag)
        for feature in self._features:
            feature.on_recording_shown()

    def on_playback_error(self, error: LinkwrightError) -> None:
        """Show pages the error that makes the rest of the recording unreadable."""
        self._get_timeline.show_error(error)

    def attach_comparison(self, pair: Pair, node: Node) -> Callable[[str], None]:
        """Show the differences between two descriptions in pages, see `ComparisonFeature.attach`."""
        from linkwright.panels.comparison.feature import ComparisonFeature

        return self.add_feature(ComparisonFeature).attach(pair, node)

    @property
    def _get_timeline(self) -> TimelineFeature:
        return self.add_feature(TimelineFeature)

    def add_feature(self, cls: type[F], receives: Iterable[str] = ()) -> F:
        """Return the feature of a class, creating it if it does not exist yet.

        The feature receives all events from then on.

        Args:
            cls: the class of the feature.
            receives: the import paths of messages that the feature handles in addition to its `RECEIVES`.
        """
        existing = next((feature for feature in self._features if type(feature) is cls), None)
        if existing is None:
            existing = cls(self)
            self._add(existing, receives)
            if self._is_started:
                existing.start()
        return existing

    def _add(self, feature: PageFeature, receives: Iterable[str] = ()) -> None:
        self._features.append(feature)
        self._receivers.update((message, feature.receive) for message in (*feature.receives, *receives))

    def show_diagnostics(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Replace the current findings about the description.

        The new list may be empty.
        """
        for feature in self._features:
            feature.on_diagnostics_changed(diagnostics)

    # --- pages -------------------------------------------------------------------------------------------------

    def _create_opening(self, page: Page) -> list[Payload]:
        manager = self.managers.enter(page)
        messages, frames = self.opening_messages(manager)
        manager.pages.add(page)  # added here so that messages published later follow the opening messages
        return [*(encode(message, page.language) for message in messages), *frames]

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Return the messages and binary frames for a page that opens a configuration.

        The frame table is the last message.
        """
        messages: list[ServerMessage] = [Hello(PROTOCOL_VERSION, __version__, self._title, self._run)]
        tree_messages, table, frames = manager.make_opening_state()
        messages += self._create_feature_openings(before_displays=True)
        messages += tree_messages
        messages += self._create_feature_openings(before_displays=False)
        return [*messages, *self.configuration_messages(manager), table], frames

    def _create_feature_openings(self, *, before_displays: bool) -> list[ServerMessage]:
        messages: list[ServerMessage] = []
        for feature in self._features:  # `opening_messages` may append features, which this loop also reaches
            if feature.BEFORE_DISPLAYS is before_displays:
                messages += feature.opening_messages()
        return messages

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the messages of all features about a configuration."""
        return [message for feature in self._features for message in feature.configuration_messages(manager)]

    def _on_page_closed(self, page: Page) -> None:
        for feature in self._features:
            feature.remove_page(page)
        self.managers.on_page_closed(page)

    # --- events of managers ------------------------------------------------------------------------------------

    def on_edit(self, manager: VisualizationManager) -> None:
        """Notify features that undo, redo or the unsaved state has changed."""
        for feature in self._features:
            feature.on_edit(manager)

    def on_robot_changed(self) -> None:
        """Notify features that a display has another robot."""
        for feature in self._features:
            feature.on_robot_changed()

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Notify features that a manager was closed."""
        for feature in self._features:
            feature.remove_manager(manager)

    def on_fixed_frame_changed(self, manager: VisualizationManager) -> None:
        """Set the parameter of the node to the Fixed Frame of the shared configuration."""
        frame = manager.fixed_frame
        if manager is self.manager and self._node.get_parameter(_FIXED_FRAME_PARAMETER).value != frame:
            self._node.set_parameters([Parameter(_FIXED_FRAME_PARAMETER, value=frame)])

    def _on_parameters_set(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == _FIXED_FRAME_PARAMETER and parameter.value != self.manager.fixed_frame:
                self.manager.set_fixed_frame(str(parameter.value))
