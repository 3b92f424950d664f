"""What one set of pages sees: a configuration, its displays, and what was edited in it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.diagnostics import Diagnostic
from linkwright.graph import Node
from linkwright.urdf import DescriptionLibrary
from linkwright.viewer.audience import Circle, Page
from linkwright.viewer.display_tree import DisplayTree
from linkwright.viewer.displays import RobotModelDisplay, Stage, TfDisplay, ViewerDisplay, worst
from linkwright.viewer.edits import ValueEdit
from linkwright.viewer.frame_history import FrameHistory
from linkwright.viewer.frame_stream import FrameStream, StreamSettings
from linkwright.viewer.frame_view import FrameView
from linkwright.viewer.history import History
from linkwright.viewer.mesh_files import MeshFolders
from linkwright.viewer.property_store import Path, PropertyStore
from linkwright.viewer.protocol import (
    DisplayStatus,
    FrameTable,
    PropertyChanged,
    ServerMessage,
    StatusRow,
    SyncMode,
    TimeState,
    Tree,
)
from linkwright.viewer.rviz_config import RvizConfig
from linkwright.viewer.time_config import Synchronization, read_synchronization, write_synchronization
from linkwright.viewer.time_control import TimeControl
from linkwright.workspace import PackageFinder

if TYPE_CHECKING:
    from linkwright.viewer.outbox import Payload
    from linkwright.viewer.yaml_tree import Memory

GLOBAL = "global"
"""The owner of the Global Options, where others have the id of a display."""

_FIXED_FRAME = "Fixed Frame"


@dataclass(frozen=True, slots=True)
class Surroundings:
    """What managers of a viewer share.

    Attributes:
        node: to subscribe and to log with.
        library: reads descriptions.
        finder: finds packages.
        meshes: the folders that pages may read from.
        history: where frames were.
        report: shows a finding in the terminal.
        next_id: an id that no display of the viewer has had.
        robot_changed: told of a new robot of any display.
    """

    node: Node
    library: DescriptionLibrary
    finder: PackageFinder
    meshes: MeshFolders
    history: FrameHistory
    report: Callable[[Diagnostic], None]
    next_id: Callable[[], str]
    robot_changed: Callable[[], None]


class VisualizationManager:
    """A configuration, its displays and their frames, for the pages that see them.

    Args:
        surroundings: what it shares with others.
        config: displays, options and view.
        edited: told when undo, redo or whether something is unsaved may be another.
        fixed_frame_set: told of another Fixed Frame.

    Attributes:
        pages: those that see it.
        view: where the camera of a page that opens is, wherever others have gone.
        config: the configuration now.
        opened: counts the configurations that it has had.
        stage: what displays work with.
        tree: the displays, and what is done to them.
        history: what was edited.
    """

    def __init__(
        self,
        surroundings: Surroundings,
        config: RvizConfig,
        *,
        edited: Callable[[VisualizationManager], None],
        fixed_frame_set: Callable[[str], None] = lambda _: None,
    ) -> None:
        self.pages = Circle()
        self.config = config
        self.view = config.views.current
        self.opened = 1
        self.history = History(lambda: edited(self))
        self._around = surroundings
        self._fixed_frame_set = fixed_frame_set
        self._global_status: list[StatusRow] = []
        self._running = False
        self.stage = Stage(
            node=surroundings.node,
            library=surroundings.library,
            finder=surroundings.finder,
            meshes=surroundings.meshes,
            publish=self.pages.publish,
            send_data=self.pages.send_data,
            history=surroundings.history,
            robot_changed=self._robot_changed,
            report=surroundings.report,
            frames=FrameView(fixed_frame=self.fixed_frame),
            time=TimeControl(surroundings.node.get_clock(), self._time_changed, self._time_signalled),
        )
        self._stream = FrameStream(
            surroundings.node,
            StreamSettings(
                fixed_frame=lambda: self.fixed_frame,
                rate=lambda: self.config.options.number("Frame Rate"),
                fade_time=self._fade_time,
                own_frames=self._own_frames,
                watched=lambda: len(self.pages) > 0,
                paused=lambda: self.stage.time.paused,
                lookup_ns=self.stage.time.lookup_ns,
            ),
            on_table=self.pages.publish,
            on_transforms=self.pages.send_transforms,
            on_frames=self._frames_changed,
            history=surroundings.history,
        )
        self.tree = DisplayTree(config, self.stage, self.history, surroundings.next_id, rearranged=self._rearranged)
        self._offer_frames()

    # --- life --------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe, and begin."""
        self._warn()
        self._stream.start()
        self.tree.start()
        self._stream.refresh()
        self._synchronize()

    def close(self) -> None:
        """End for good."""
        self._stream.close()
        self.tree.stop()

    def open(self, config: RvizConfig) -> None:
        """Show another configuration; what was edited in the one before is forgotten."""
        self.tree.stop()
        self.config = config
        self.view = config.views.current
        self.opened += 1
        self._offer_frames()
        self._warn()
        self.tree.fill(config)
        self.publish(self.told())
        self.tree.start()
        self._stream.refresh()
        self._synchronize()
        self._fixed_frame_set(self.fixed_frame)
        self.history.clear()

    def _warn(self) -> None:
        for warning in self.config.warnings:
            self._around.report(warning)

    def _offer_frames(self) -> None:
        self.config.options.offer_frames(lambda: sorted(self.stage.frames.names))

    # --- pages -------------------------------------------------------------------------------------------------

    def publish(self, message: ServerMessage) -> None:
        """Send a message to the pages that see this configuration."""
        self.pages.publish(message)

    def opening(self) -> tuple[list[ServerMessage], FrameTable, list[Payload]]:
        """What a page must be told that opens now: messages, then the frame table, then binary frames."""
        self._stream.refresh()
        table, transforms = self._stream.opening
        messages: list[ServerMessage] = [self.told()]
        for display in self.displays:
            messages += display.messages()
        data: list[Payload] = [frame for display in self.displays for frame in display.data()]
        return messages, table, [*([transforms] if transforms else []), *data]

    def told(self) -> Tree:
        """The Displays panel, as pages are told of it."""
        return Tree(
            global_options=self.config.options.rows(),
            global_status=self._global_status,
            global_level=worst(self._global_status),
            displays=[display.row() for display in self.displays],
        )

    # --- displays and their properties -------------------------------------------------------------------------

    @property
    def displays(self) -> list[ViewerDisplay]:
        """Every display, each group before what is in it."""
        return self.tree.displays

    def display(self, identity: str) -> ViewerDisplay | None:
        """The display with an id."""
        return self.tree.find(identity)

    def robot_models(self) -> list[RobotModelDisplay]:
        """The displays that show robots."""
        return [display for display in self.displays if isinstance(display, RobotModelDisplay)]

    def store(self, owner: str) -> PropertyStore:
        """The properties of a display, or the Global Options.

        Raises:
            KeyError: there is no such display.
        """
        if owner == GLOBAL:
            return self.config.options
        display = self.display(owner)
        if display is None:
            raise KeyError(owner)
        return display.properties

    def set_property(self, page: Page, identity: str, value: object) -> None:
        """Take a value from a page; one that is refused is answered with that which stands."""
        owner, _, rest = identity.partition("/")
        display = self.display(owner)
        if display is None and owner != GLOBAL:
            return  # it was removed since
        if display is not None and rest == "Enabled":
            if not isinstance(value, bool):
                page.send(PropertyChanged(identity, display.config.checked))
            else:
                self.tree.check(display, value)
            return
        store = self.store(owner)
        path = store.find(identity)
        if path is None:
            return  # rows of a robot or frame that has gone since
        before = store.get(*path)
        try:
            self._edit(identity, path, lambda: self._set(display, path, value))
        except ValueError as error:
            self._around.node.get_logger().warning(f"'{identity}': {error}")
            page.send(PropertyChanged(identity, before))

    def _set(self, display: ViewerDisplay | None, path: Path, value: object) -> None:
        if display is not None:
            display.set_property(path, value)
        else:
            self._set_option(path[0], value)

    def _edit(self, identity: str, path: Path, change: Callable[[], None]) -> None:
        """Change a property so that it can be undone; of a drag only the first step is remembered."""
        if self.history.is_at(identity):
            change()
            self.history.prolong()
            return
        with self.store(identity.partition("/")[0]).recording() as before:
            change()
        if before:
            self.history.add(ValueEdit(self, identity, path[-1], before))

    def set_fixed_frame(self, frame: str) -> None:
        """Show everything in another frame, as a page would have it."""
        path = (_FIXED_FRAME,)
        self._edit(self.config.options.identity(path), path, lambda: self._set_option(_FIXED_FRAME, frame))

    def recall(self, owner: str, memories: list[Memory]) -> None:
        """Make the file say what it said of properties, and act on what is another now."""
        display = self.display(owner)
        if display is not None:
            display.recall(memories)
        elif owner == GLOBAL:
            for path in self.config.options.recall(memories):
                self._option_changed(path[0])

    def edited(self) -> None:
        """Something of the file was changed that undo does not know of."""
        self.history.touch()

    # --- time --------------------------------------------------------------------------------------------------

    def set_time(self, *, paused: bool, mode: SyncMode, source: str) -> None:
        """Pause or go on, and follow the messages of a display, or none."""
        self.stage.time.set(paused=paused, mode=mode, source=source)
        if write_synchronization(self.config.document, Synchronization(mode, source)):
            self.edited()
        self._stream.time_changed()
        for display in self.displays:
            display.time_changed()

    def reset_time(self) -> None:
        """Begin anew: displays forget what messages said, and frames that move must be heard of again."""
        self.stage.time.reset()
        self.stage.history.forget()
        self._stream.forget()
        for display in self.displays:
            display.time_reset()

    def _synchronize(self) -> None:
        """Begin with what the file says of time, and not paused."""
        wanted = read_synchronization(self.config.document)
        self.set_time(paused=False, mode=wanted.mode, source=wanted.source)

    def _time_changed(self) -> None:
        time = self.stage.time
        self.publish(TimeState(time.paused, time.mode, time.source, list(time.sources)))

    def _time_signalled(self) -> None:
        self._stream.look_soon()

    # --- options and frames ------------------------------------------------------------------------------------

    @property
    def fixed_frame(self) -> str:
        """The frame that everything is shown in."""
        return self.config.options.text(_FIXED_FRAME)

    def _set_option(self, name: str, value: object) -> None:
        self.config.options.set((name,), value)
        self._option_changed(name)

    def _option_changed(self, name: str) -> None:
        options = self.config.options
        self.publish(PropertyChanged(options.identity((name,)), options.get(name)))
        if name == _FIXED_FRAME:
            self._stream.refresh()
            self._fixed_frame_set(self.fixed_frame)

    def _rearranged(self) -> None:
        self.publish(self.told())

    def _frames_changed(self, frames: FrameView) -> None:
        others = frames.names != self.stage.frames.names
        self.stage.frames = frames
        for display in self.displays:
            display.frames_changed()
        if others:
            stores = [self.config.options, *(display.properties for display in self.displays)]
            for change in (change for store in stores for change in store.frame_changes()):
                self.publish(change)
        self._show_global_status()

    def _show_global_status(self) -> None:
        frame, names = self.stage.frames.fixed_frame, self.stage.frames.names
        missing = f"Frame [{frame}] does not exist"
        if frame in names:
            row = StatusRow("Fixed Frame", "ok", "OK")
        elif names:
            row = StatusRow("Fixed Frame", "error", missing)
        else:
            row = StatusRow("Fixed Frame", "warn", f"No tf data.  Actual error: {missing}")
        if [row] != self._global_status:
            self._global_status = [row]
            self.publish(DisplayStatus(GLOBAL, row.level, [row]))

    def _robot_changed(self, gone: set[str]) -> None:
        self._stream.robot_changed(gone - self._own_frames())
        self._around.robot_changed()

    def _own_frames(self) -> frozenset[str]:
        return frozenset(link.frame for robot in self.robot_models() for link in robot.scene.links)

    def _fade_time(self) -> float | None:
        shown = (display for display in self.displays if isinstance(display, TfDisplay) and display.enabled)
        return min((display.properties.number("Frame Timeout") for display in shown), default=None)
