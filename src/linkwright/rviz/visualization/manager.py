"""A visualization: a configuration, its displays and its undo history.

Pages share one visualization, but a page may request a separate one.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Protocol

from linkwright.diagnostics import phrase
from linkwright.page.audience import Page, PageGroup
from linkwright.page.protocol.configuration import DisplayStatus, EditName, PropertyChanged, StatusRow, Tree
from linkwright.page.protocol.message import FrameTable, ServerMessage
from linkwright.page.protocol.time import SyncMode, TimeState
from linkwright.rviz.config.panels import Synchronization, read_synchronization, write_synchronization
from linkwright.rviz.config.property_store import PropertyStore
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.config.schema import Path
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.displays.base.display import ViewerDisplay, find_worst_level
from linkwright.rviz.displays.frames import FRAME_TIMEOUT, TfDisplay
from linkwright.rviz.displays.robot_model import RobotModelDisplay
from linkwright.rviz.frames.stream import FrameStream, FrameView, TimeControl
from linkwright.rviz.visualization.display_tree import DisplayTree, Edit, History

if TYPE_CHECKING:
    from linkwright.page.outbox import Payload
    from linkwright.rviz.config.yaml_tree import SavedEntry


GLOBAL_OWNER = "global"
"""The owner of the Global Options, used instead of the ID of a display."""

_FIXED_FRAME = "Fixed Frame"
_FRAME_RATE = "Frame Rate"


class ManagerOwner(Protocol):
    """The owner of visualization managers, to be notified of their events."""

    def on_edit(self, manager: VisualizationManager) -> None:
        """Handle a change to the undo history or the unsaved state."""

    def on_robot_changed(self) -> None:
        """Handle a change of the robot that a display shows."""

    def on_fixed_frame_changed(self, manager: VisualizationManager) -> None:
        """Handle a change of the Fixed Frame."""

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Handle the closing of a manager."""


class VisualizationManager:
    """A configuration with its displays and frames, for the pages that show it.

    Args:
        context: the viewer's node, files and pages.
        config: the configuration with displays, options and view.
        owner: the owner, which receives events.

    Attributes:
        context: the viewer's node, files and pages.
        pages: the pages that show the configuration.
        view: the view with which a new page opens, independent of the current views of other pages.
        shows_whole_robot: whether no user has chosen a view, so that pages fit the camera to the robot.
        config: the current configuration.
        opened: the number of configurations opened so far.
        frames: the current frames.
        time: whether time is paused, and its synchronization.
        tree: the displays, and the operations on them.
        history: the undo history.
    """

    def __init__(self, context: ViewerContext, config: RvizConfig, owner: ManagerOwner) -> None:
        self.context = context
        self.pages = PageGroup()
        self.config = config
        self.view, self.shows_whole_robot = config.views.current, config.shows_whole_robot
        self.opened = 1
        self.history = History(lambda: owner.on_edit(self))
        self._owner = owner
        self._global_status: list[StatusRow] = []
        self.time = TimeControl(context.node.get_clock(), self._on_time_changed, self._on_time_signal)
        self._stream = FrameStream(
            context.node,
            self.pages,
            self.time,
            context.transforms,
            on_frames=self._on_frames_changed,
            own_frames=self._robot_frames,
        )
        self._read_options()
        self.frames = FrameView(fixed_frame=self.fixed_frame)
        self.tree = DisplayTree(config, self, self.history, rearranged=self._on_rearranged)
        self.on_fading_changed()

    # --- lifecycle ---------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Subscribe to transforms and start the displays."""
        self._report_warnings()
        self._stream.start()
        self.tree.start()
        self._stream.refresh()
        self._synchronize()

    def close(self) -> None:
        """Stop the displays and the transforms permanently."""
        self._stream.close()
        self.tree.stop()

    def open(self, config: RvizConfig) -> None:
        """Replace the configuration and its displays, and clear the undo history."""
        self.tree.stop()
        self.config = config
        self.view, self.shows_whole_robot = config.views.current, config.shows_whole_robot
        self.opened += 1
        self._read_options()
        self._report_warnings()
        self.tree.fill(config)
        self.on_fading_changed()
        self.publish(self.make_tree_message())
        self.tree.start()
        self._stream.refresh()
        self._synchronize()
        self._owner.on_fixed_frame_changed(self)
        self.history.clear()

    def _report_warnings(self) -> None:
        for warning in self.config.warnings:
            self.context.report(warning)

    def _read_options(self) -> None:
        """Apply the Fixed Frame and the Frame Rate of the Global Options."""
        options = self.config.options
        options.offer_frames(lambda: sorted(self.frames.names))
        self._stream.fixed_frame, self._stream.rate = options.text(_FIXED_FRAME), options.number(_FRAME_RATE)

    # --- pages -------------------------------------------------------------------------------------------------

    def publish(self, message: ServerMessage) -> None:
        """Send a message to the pages that show this configuration."""
        self.pages.publish(message)

    def make_opening_state(self) -> tuple[list[ServerMessage], FrameTable, list[Payload]]:
        """Return the messages, frame table and binary frames for a new page, to send in this order."""
        self._stream.refresh()
        table, transforms = self._stream.current_frames
        messages: list[ServerMessage] = [self.make_tree_message()]
        for display in self.displays:
            messages += display.messages()
        data: list[Payload] = [frame for display in self.displays for frame in display.data()]
        return messages, table, [*([transforms] if transforms else []), *data]

    def make_tree_message(self) -> Tree:
        """Return the message with the content of the Displays panel, for pages."""
        return Tree(
            global_options=self.config.options.rows(),
            global_status=self._global_status,
            global_level=find_worst_level(self._global_status),
            displays=[display.row() for display in self.displays],
        )

    # --- displays and their properties -------------------------------------------------------------------------

    @property
    def displays(self) -> list[ViewerDisplay]:
        """Every display, each group before its contents."""
        return self.tree.displays

    def display(self, identity: str) -> ViewerDisplay | None:
        """Return the display with an ID, or None if there is none."""
        return self.tree.find(identity)

    def robot_models(self) -> list[RobotModelDisplay]:
        """Return the RobotModel displays, in the order of the Displays panel."""
        return [display for display in self.displays if isinstance(display, RobotModelDisplay)]

    def store(self, owner: str) -> PropertyStore:
        """Return the properties of a display or the Global Options.

        Raises:
            KeyError: there is no such display.
        """
        if owner == GLOBAL_OWNER:
            return self.config.options
        display = self.display(owner)
        if display is None:
            raise KeyError(owner)
        return display.properties

    def set_property(self, page: Page, identity: str, value: object) -> None:
        """Set a property at the request of a page.

        If the value is not accepted, the current value is sent back to the page.
        """
        owner, _, property_name = identity.partition("/")
        display = self.display(owner)
        if display is None and owner != GLOBAL_OWNER:
            return  # the display was removed in the meantime
        if display is not None and property_name == "Enabled":
            if not isinstance(value, bool):
                page.send(PropertyChanged(identity, display.config.checked))
            else:
                self.tree.check(display, value)
            return
        store = self.store(owner)
        path = store.find(identity)
        if path is None:
            return  # the row of a link or frame that no longer exists
        previous_value = store.get(*path)
        try:
            self._edit_property(identity, path, lambda: self._set_value(display, path, value))
        except ValueError as error:
            self.context.node.get_logger().warning(phrase("'{identity}': {error}", identity=identity, error=error))
            page.send(PropertyChanged(identity, previous_value))

    def _set_value(self, display: ViewerDisplay | None, path: Path, value: object) -> None:
        if display is not None:
            display.set_property(path, value)
        else:
            self._set_option(path[0], value)

    def _edit_property(self, identity: str, path: Path, change: Callable[[], None]) -> None:
        """Change a property so that it can be undone.

        Quick successive changes, such as the steps of a drag, are one edit.
        """
        if self.history.would_merge(identity):
            change()
            self.history.merge_change()
            return
        owner = identity.partition("/")[0]
        with self.store(owner).recording() as previous_entries:
            change()
        if previous_entries:
            self.history.add(
                Edit(EditName("set", path[-1]), partial(self._swap_values, owner), previous_entries, identity)
            )

    def set_fixed_frame(self, frame: str) -> None:
        """Change the Fixed Frame as an edit that can be undone."""
        path = (_FIXED_FRAME,)
        self._edit_property(self.config.options.identity(path), path, lambda: self._set_option(_FIXED_FRAME, frame))

    def _swap_values(self, owner: str, saved_entries: list[SavedEntry]) -> list[SavedEntry]:
        """Restore previous entries of properties in the file, and return the replaced entries."""
        replaced = self.store(owner).current_entries(saved_entries)
        self._restore_entries(owner, saved_entries)
        return replaced

    def _restore_entries(self, owner: str, saved_entries: list[SavedEntry]) -> None:
        display = self.display(owner)
        if display is not None:
            display.restore(saved_entries)
        elif owner == GLOBAL_OWNER:
            for path in self.config.options.restore(saved_entries):
                self._on_option_changed(path[0])

    def fit_to_robot(self, diagonal: float, ground: float) -> None:
        """Fit grid and axes to a measured robot, except sizes that the user has changed.

        Args:
            diagonal: the diagonal of the robot's bounding box, m.
            ground: the height of the ground below the robot, in the Fixed Frame, m.
        """
        for config, path, value in self.config.take_sizes(diagonal, ground):
            for display in self.displays:
                if display.config is config:
                    display.set_property(path, value)

    def record_permanent_edit(self) -> None:
        """Record a change to the file that cannot be undone."""
        self.history.add_permanent_edit()

    # --- time --------------------------------------------------------------------------------------------------

    def set_time(self, *, paused: bool, mode: SyncMode, source: str) -> None:
        """Pause or resume, and set the synchronization mode and the source display."""
        self.time.set(paused=paused, mode=mode, source=source)
        if write_synchronization(self.config.document, Synchronization(mode, source)):
            self.record_permanent_edit()
        self._stream.on_time_changed()
        for display in self.displays:
            display.on_time_changed()

    def reset_time(self) -> None:
        """Reset time: discard displayed messages, and all transforms except static ones."""
        self.time.reset()
        self.context.transforms.clear()
        self._stream.clear()
        for display in self.displays:
            display.on_time_reset()

    def _synchronize(self) -> None:
        """Apply the time synchronization of the file, and resume time."""
        synchronization = read_synchronization(self.config.document)
        self.set_time(paused=False, mode=synchronization.mode, source=synchronization.source)

    def _on_time_changed(self) -> None:
        time = self.time
        self.publish(TimeState(time.paused, time.mode, time.source, list(time.sources)))

    def _on_time_signal(self) -> None:
        self._stream.schedule_update()

    # --- options and frames ------------------------------------------------------------------------------------

    @property
    def fixed_frame(self) -> str:
        """The Fixed Frame, which is the reference frame of the scene."""
        return self._stream.fixed_frame

    def _set_option(self, name: str, value: object) -> None:
        self.config.options.set((name,), value)
        self._on_option_changed(name)

    def _on_option_changed(self, name: str) -> None:
        options = self.config.options
        changes_rows = options.is_condition((name,))
        self.publish(
            self.make_tree_message() if changes_rows else PropertyChanged(options.identity((name,)), options.get(name))
        )
        if name == _FRAME_RATE:
            self._stream.rate = options.number(_FRAME_RATE)
        elif name == _FIXED_FRAME:
            self._stream.fixed_frame = options.text(_FIXED_FRAME)
            self._stream.refresh()
            self._owner.on_fixed_frame_changed(self)

    def _on_rearranged(self) -> None:
        self.on_fading_changed()
        self.publish(self.make_tree_message())

    def _on_frames_changed(self, frames: FrameView) -> None:
        has_new_names = frames.names != self.frames.names
        self.frames = frames
        for display in self.displays:
            display.on_frames_changed()
        if has_new_names:
            stores = [self.config.options, *(display.properties for display in self.displays)]
            for change in (change for store in stores for change in store.frame_changes()):
                self.publish(change)
        self._show_global_status()

    def _show_global_status(self) -> None:
        frame, names = self.frames.fixed_frame, self.frames.names
        missing = phrase("Frame [{frame}] does not exist", frame=frame)
        if frame in names or self.context.transforms.placed_frame(frame) is not None:
            row = StatusRow("Fixed Frame", "ok", phrase("OK"))
        elif names:
            row = StatusRow("Fixed Frame", "error", missing)
        else:
            row = StatusRow("Fixed Frame", "warn", phrase("No tf data.  Actual error: {missing}", missing=missing))
        if [row] != self._global_status:
            self._global_status = [row]
            self.publish(DisplayStatus(GLOBAL_OWNER, row.level, [row]))

    def on_robot_changed(self, removed_frames: set[str]) -> None:
        """Handle a display's new robot.

        `removed_frames` contains the frames that only the previous robot had.
        """
        self._stream.on_robot_changed(removed_frames - self._robot_frames())
        self._owner.on_robot_changed()

    def _robot_frames(self) -> frozenset[str]:
        return frozenset(link.frame for robot in self.robot_models() for link in robot.scene.links)

    def on_fading_changed(self) -> None:
        """Apply the shortest Frame Timeout of the TF displays that are enabled."""
        tf_displays = (display for display in self.displays if isinstance(display, TfDisplay) and display.enabled)
        self._stream.fade_time = min(
            (display.properties.number(FRAME_TIMEOUT) for display in tf_displays), default=None
        )


LINGERING_S = 60.0
"""Seconds for which the displays of a closed page are kept, because the page may only be reloading."""

MAX_LINGERING = 8
"""The largest number of managers without pages. If there are more, the oldest of them is closed."""


class Managers:
    """The manager that most pages share, and the separate managers of single pages.

    A separate manager begins with a copy of the shared configuration.

    Args:
        context: the viewer's node, files and pages.
        config: the configuration of the shared manager.
        owner: the owner of the managers, which receives their events.
    """

    def __init__(self, context: ViewerContext, config: RvizConfig, owner: ManagerOwner) -> None:
        self.shared = VisualizationManager(context, config, owner)
        self._owner = owner
        self._own_managers: dict[str, VisualizationManager] = {}
        self._close_timers: dict[str, asyncio.TimerHandle] = {}

    def all(self) -> list[VisualizationManager]:
        """Return all managers, beginning with the shared manager."""
        return [self.shared, *self._own_managers.values()]

    def of(self, page: Page) -> VisualizationManager:
        """Return the manager of a page: a separate manager, or the shared one."""
        return self._own_managers.get(page.configuration_name, self.shared)

    def enter(self, page: Page) -> VisualizationManager:
        """Return the manager of a page that opens, and create it if it does not exist."""
        if page.configuration_name:
            timer = self._close_timers.pop(page.configuration_name, None)
            if timer is not None:
                timer.cancel()
            if page.configuration_name not in self._own_managers:
                self._own_managers[page.configuration_name] = VisualizationManager(
                    self.shared.context, self.shared.config.copy(), self._owner
                )
                self._own_managers[page.configuration_name].start()
        return self.of(page)

    def on_page_closed(self, page: Page) -> None:
        """Handle the closing of a page.

        A separate manager is closed if the page does not return.
        """
        manager = self.of(page)
        manager.pages.discard(page)
        if manager is not self.shared and not len(manager.pages):
            self._close_timers[page.configuration_name] = asyncio.get_running_loop().call_later(
                LINGERING_S, self._drop, page.configuration_name
            )
            if len(self._close_timers) > MAX_LINGERING:
                self._drop(next(iter(self._close_timers)))

    def close(self) -> None:
        """Close all managers."""
        for key in list(self._own_managers):
            self._drop(key)
        self.shared.close()

    def _drop(self, key: str) -> None:
        timer = self._close_timers.pop(key, None)
        if timer is not None:
            timer.cancel()
        manager = self._own_managers.pop(key)
        manager.close()
        self._owner.remove_manager(manager)
