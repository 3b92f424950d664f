"""The viewer: a node of the graph whose window is a page in a browser."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from linkwright._version import __version__
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Graph, Parameter, ParameterDescriptor
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.access import Gate
from linkwright.viewer.audience import Audience, Page
from linkwright.viewer.diagnostic_items import item_of
from linkwright.viewer.displays import RobotModelDisplay, Stage, TfDisplay, make_display, worst
from linkwright.viewer.frame_stream import FrameStream, StreamSettings
from linkwright.viewer.frame_view import FrameView
from linkwright.viewer.joints import JointBridge
from linkwright.viewer.listening import is_open_to_others, listen
from linkwright.viewer.mesh_files import MeshFolders
from linkwright.viewer.protocol import (
    PROTOCOL_VERSION,
    AskStory,
    Diagnostics,
    DisplayStatus,
    Hello,
    MeshStatus,
    PageMessage,
    PropertyChanged,
    ServerMessage,
    SetProperty,
    StatusRow,
    Tree,
    ViewChanged,
    ViewState,
)
from linkwright.viewer.rviz_config import RvizConfig
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

    It must be made inside of a running asyncio loop. What pages change is kept in `config`, whose `save` writes it.

    Args:
        graph: what it is a node of.
        library: reads descriptions, each once for the whole process.
        finder: finds packages, and so meshes.
        config: displays, options and view.
        host: what to listen on; anything but this machine's loopback address lets others in who know the token.
        port: 0 for any; None for 7447 or the next free one.
        title: of the page.
        name: of the node.
        namespace: of the node.
        remappings: of the node's topics.
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
        name: str = _NAME,
        namespace: str = "/",
        remappings: Sequence[tuple[str, str]] = (),
    ) -> None:
        self.config = config
        self._host, self._port, self._title = host, port, title
        self._url = ""
        self._node = graph.create_node(name, namespace=namespace, remappings=remappings)
        self._node.declare_parameter(
            _FIXED_FRAME, self._fixed_frame(), ParameterDescriptor(description="the frame that everything is shown in")
        )
        self._node.add_post_set_parameters_callback(self._take_parameters)
        self._meshes = MeshFolders()
        self._audience = Audience(self._opening, self._receive, self._node.get_logger())
        self._joints = JointBridge(self._audience.publish)
        self._view = ViewState(config.view)  # every page begins with the file's view, wherever others have gone
        self._diagnostics = Diagnostics([])
        self._global_status: list[StatusRow] = []
        self._stories: dict[Page, asyncio.Task[None]] = {}
        self._telling = asyncio.Lock()
        self._server: WebServer | None = None
        self._stage = Stage(
            node=self._node,
            library=library,
            finder=finder,
            meshes=self._meshes,
            publish=self._audience.publish,
            robot_changed=self._robot_changed,
            report=self._report,
            frames=FrameView(fixed_frame=self._fixed_frame()),
        )
        self._stream = FrameStream(
            self._node,
            StreamSettings(
                fixed_frame=self._fixed_frame,
                rate=lambda: config.options.number("Frame Rate"),
                fade_time=self._fade_time,
                own_frames=self._own_frames,
                watched=lambda: len(self._audience) > 0,
            ),
            on_table=self._audience.publish,
            on_transforms=self._audience.send_transforms,
            on_frames=self._frames_changed,
        )
        self.displays = [
            make_display(self._stage, f"display-{number}", display) for number, display in enumerate(config.displays, 1)
        ]
        config.options.offer_frames(lambda: sorted(self._stage.frames.names))

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
        self._server = WebServer(gate, self._audience, self._meshes)
        self._url = await self._server.start(listener)
        if is_open_to_others(listener):
            self._node.get_logger().warning(
                f"Listening on '{self._host}': whoever reaches it and knows the token can see and move the robot"
            )
        for warning in self.config.warnings:
            self._report(warning)
        self._stream.start()
        for display in self.displays:
            display.start()
        self._stream.refresh()

    async def close(self) -> None:
        """Say goodbye to the pages, leave the graph and stop listening."""
        for task in self._stories.values():
            task.cancel()
        self._joints.attach(None)
        self._stream.close()
        for display in self.displays:
            display.stop()
        if self._server is not None:
            await self._server.close()
            self._server = None
        self._node.destroy_node()

    @property
    def url(self) -> str:
        """What to open in a browser, token included; empty before `start`."""
        return self._url

    # --- what the rest of the program shows --------------------------------------------------------------------

    def attach_joint_panel(self, panel: JointPanel | None) -> None:
        """Show sliders for the joints of a panel; None takes them away."""
        self._joints.attach(panel)

    def show_diagnostics(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Show what is wrong with the description; none clears the list."""
        self._diagnostics = Diagnostics([item_of(each) for each in diagnostics])
        self._audience.publish(self._diagnostics)

    # --- pages -------------------------------------------------------------------------------------------------

    def _opening(self) -> list[str | bytes]:
        self._stream.refresh()
        table, transforms = self._stream.opening
        messages: list[ServerMessage] = [Hello(PROTOCOL_VERSION, __version__, self._title), self._tree()]
        for display in self.displays:
            messages += display.messages()
        messages += [self._view, *self._joints.messages(), self._diagnostics, table]
        return [*map(encode, messages), *([transforms] if transforms else [])]

    def _tree(self) -> Tree:
        return Tree(
            global_options=self.config.options.rows(),
            global_status=self._global_status,
            global_level=worst(self._global_status),
            displays=[display.row() for display in self.displays],
        )

    def _receive(self, page: Page, message: PageMessage) -> None:
        if isinstance(message, SetProperty):
            self._set_property(page, message)
        elif isinstance(message, ViewChanged):
            self._keep_view(message)
        elif isinstance(message, MeshStatus):
            if display := self._robot_model(message.display):
                display.mesh_status(message)
        elif isinstance(message, AskStory):
            self._ask(page, message)
        else:
            self._joints.receive(message)

    def _robot_model(self, identity: str) -> RobotModelDisplay | None:
        models = (display for display in self.displays if isinstance(display, RobotModelDisplay))
        return next((model for model in models if model.id == identity), None)

    def _ask(self, page: Page, question: AskStory) -> None:
        """Tell a page a link's story, which takes a while; of several questions of a page the newest counts."""
        if page in self._stories:
            self._stories[page].cancel()
        task = asyncio.get_running_loop().create_task(self._tell(page, question))
        self._stories[page] = task
        task.add_done_callback(lambda done: self._stories.pop(page) if self._stories.get(page) is done else None)

    async def _tell(self, page: Page, question: AskStory) -> None:
        display = self._robot_model(question.display)
        if display is None:
            return
        async with self._telling:
            story = await asyncio.to_thread(display.story, question.link)
        if story is not None:
            page.send(story)

    def _keep_view(self, message: ViewChanged) -> None:
        try:
            self.config.view = message.view
        except ValueError as error:
            self._node.get_logger().warning(f"A page sent a view that is none: {error}")

    def _set_property(self, page: Page, message: SetProperty) -> None:
        owner, _, rest = message.id.partition("/")
        display = next((display for display in self.displays if display.id == owner), None)
        store = display.properties if display else self.config.options
        if display is not None and rest == "Enabled":
            if isinstance(message.value, bool):
                display.set_enabled(message.value)
            else:
                page.send(PropertyChanged(message.id, display.enabled))
            return
        path = store.find(message.id)
        if path is None:
            return  # rows of a robot or frame that has gone since
        try:
            if display is not None:
                display.set_property(path, message.value)
            else:
                self._set_option(path[0], message)
        except ValueError as error:
            self._node.get_logger().warning(f"'{message.id}': {error}")
            page.send(PropertyChanged(message.id, store.get(*path)))

    def _set_option(self, name: str, message: SetProperty) -> None:
        value = self.config.options.set((name,), message.value)
        self._audience.publish(PropertyChanged(message.id, value))
        if name == "Fixed Frame":
            self._stream.refresh()
            if self._node.get_parameter(_FIXED_FRAME).value != value:
                self._node.set_parameters([Parameter(_FIXED_FRAME, value=value)])

    def _take_parameters(self, parameters: list[Parameter]) -> None:
        for parameter in parameters:
            if parameter.name == _FIXED_FRAME and parameter.value != self._fixed_frame():
                identity = self.config.options.identity(("Fixed Frame",))
                self._set_option("Fixed Frame", SetProperty(identity, parameter.value))

    # --- frames ------------------------------------------------------------------------------------------------

    def _frames_changed(self, frames: FrameView) -> None:
        others = frames.names != self._stage.frames.names
        self._stage.frames = frames
        for display in self.displays:
            display.frames_changed()
        if others:
            stores = [self.config.options, *(display.properties for display in self.displays)]
            for change in (change for store in stores for change in store.frame_changes()):
                self._audience.publish(change)
        self._show_global_status()

    def _show_global_status(self) -> None:
        frame, names = self._stage.frames.fixed_frame, self._stage.frames.names
        missing = f"Frame [{frame}] does not exist"
        if frame in names:
            row = StatusRow("Fixed Frame", "ok", "OK")
        elif names:
            row = StatusRow("Fixed Frame", "error", missing)
        else:
            row = StatusRow("Fixed Frame", "warn", f"No tf data.  Actual error: {missing}")
        if [row] != self._global_status:
            self._global_status = [row]
            self._audience.publish(DisplayStatus("global", row.level, [row]))

    def _robot_changed(self, gone: set[str]) -> None:
        self._stream.robot_changed(gone - self._own_frames())

    def _own_frames(self) -> frozenset[str]:
        robots = (display for display in self.displays if isinstance(display, RobotModelDisplay))
        return frozenset(link.frame for robot in robots for link in robot.scene.links)

    def _fixed_frame(self) -> str:
        return self.config.options.text("Fixed Frame")

    def _fade_time(self) -> float | None:
        times = [
            display.properties.number("Frame Timeout")
            for display in self.displays
            if isinstance(display, TfDisplay) and display.enabled
        ]
        return min(times, default=None)

    def _report(self, diagnostic: Diagnostic) -> None:
        where = f"{diagnostic.span}: " if diagnostic.span else ""
        logger = self._node.get_logger()
        say: Callable[[str], object] = logger.error if diagnostic.severity is Severity.ERROR else logger.warning
        say(where + diagnostic.message)
