"""Handles edits of configurations from pages: displays, undo, opening and saving."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from linkwright.diagnostics import LinkwrightError
from linkwright.page.audience import Page
from linkwright.page.protocol.configuration import (
    AddDisplay,
    Configuration,
    ConfigurationRefused,
    ConfigurationSaved,
    ConfigurationText,
    DuplicateDisplays,
    GroupDisplays,
    LoadConfiguration,
    MoveDisplays,
    NewConfiguration,
    OpenConfiguration,
    Panels,
    Question,
    Redo,
    RemoveDisplays,
    RenameDisplay,
    RequestConfigurationText,
    RequestDisplayChoices,
    RequestFolder,
    RevertConfiguration,
    SaveConfiguration,
    ShowPanels,
    Undo,
)
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config import file as configuration_file
from linkwright.rviz.config.locations import RecentFiles, list_folder, remove_recovery_files, resolve_configuration_path
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.config.schema import MAX_TEXT_LENGTH
from linkwright.rviz.displays.catalog import has_display

if TYPE_CHECKING:
    from linkwright.rviz.displays.base.display import ViewerDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager


_DEFAULT_FILE_NAME = "untitled.rviz"


Message = TypeVar("Message")


@dataclass(frozen=True, slots=True)
class Request(Generic[Message]):
    """A request of a page, and the manager of the configuration that the page shows."""

    page: Page
    manager: VisualizationManager
    message: Message


class ConfigurationFeature(PageFeature):
    """The feature that handles requests of pages about configurations.

    Unsaved edits are discarded only if the page confirms it.

    Args:
        viewer: the viewer of the feature.
        recent: the recently opened or saved files.
    """

    def __init__(self, viewer: FeatureHost, recent: RecentFiles | None = None) -> None:
        super().__init__(viewer)
        self._recent = recent or RecentFiles()
        self._sent_states: dict[VisualizationManager, Configuration] = {}

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the state of the configuration: its file, and the edits to undo or redo."""
        self._sent_states[manager] = self._make_state(manager)
        return [self._sent_states[manager]]

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Discard the state that was sent to the pages of the manager."""
        self._sent_states.pop(manager, None)

    def on_edit(self, manager: VisualizationManager) -> None:
        """Send the state of the configuration to its pages if the state has changed."""
        state = self._make_state(manager)
        if self._sent_states.get(manager) != state:
            self._sent_states[manager] = state
            manager.publish(state)

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request, or send the page the reason why it is refused."""
        manager = self.managers.of(page)
        try:
            _HANDLERS[type(message)](self, Request(page, manager, message))
        except LinkwrightError as error:
            diagnostic = error.diagnostics[0]
            location = f" ({diagnostic.span.file}:{diagnostic.span.line})" if diagnostic.span else ""
            page.send(ConfigurationRefused(diagnostic.message + location, None, None))
        except ValueError as error:
            page.send(ConfigurationRefused(str(error), None, None))

    def _make_state(self, manager: VisualizationManager) -> Configuration:
        config, history = manager.config, manager.history
        return Configuration(
            path=None if config.path is None else str(config.path),
            opened=manager.opened,
            unsaved=history.has_unsaved_edits,
            undo=history.undo_name,
            redo=history.redo_name,
            is_own=manager is not self.managers.shared,
            recent=self._recent.paths,
        )

    # --- displays ----------------------------------------------------------------------------------------------

    def _add(self, request: Request[AddDisplay]) -> None:
        message, manager = request.message, request.manager
        if not has_display(message.cls):
            raise ValueError(f"there are no displays of the class '{message.cls[:100]}'")
        entry = manager.config.make_display(message.cls, _check_name(message.name))
        group = manager.display(message.group) if message.group is not None else None
        topic = message.topic
        prepare: Callable[[ViewerDisplay], None] | None = None
        if topic is not None:
            from linkwright.panels.displays import show_topic

            prepare = partial(show_topic, topic=topic)
        manager.tree.add(entry, group.config if group else None, prepare)

    def _duplicate(self, request: Request[DuplicateDisplays]) -> None:
        if displays := _find_displays(request.manager, request.message.displays):
            request.manager.tree.duplicate(displays)

    def _rename(self, request: Request[RenameDisplay]) -> None:
        for display in _find_displays(request.manager, [request.message.display]):
            request.manager.tree.rename(display, _check_name(request.message.name))

    def _remove(self, request: Request[RemoveDisplays]) -> None:
        if displays := _find_displays(request.manager, request.message.displays):
            request.manager.tree.remove(displays)

    def _move(self, request: Request[MoveDisplays]) -> None:
        message, manager = request.message, request.manager
        group = manager.display(message.group) if message.group is not None else None
        next_display = manager.display(message.before) if message.before is not None else None
        displays = _find_displays(manager, message.displays)
        if displays and (group is None) == (message.group is None):
            manager.tree.move(displays, group.config if group else None, next_display.config if next_display else None)

    def _group(self, request: Request[GroupDisplays]) -> None:
        if displays := _find_displays(request.manager, request.message.displays):
            request.manager.tree.group(displays, _check_name(request.message.name))

    def _undo(self, request: Request[Undo]) -> None:
        request.manager.history.undo()

    def _redo(self, request: Request[Redo]) -> None:
        request.manager.history.redo()

    # --- questions ---------------------------------------------------------------------------------------------

    def _send_display_choices(self, request: Request[RequestDisplayChoices]) -> None:
        from linkwright.panels.displays import find_display_choices

        request.page.send(find_display_choices(self.context.node))

    def _send_folder(self, request: Request[RequestFolder]) -> None:
        request.page.send(list_folder(request.message.path, _get_base_folder(request.manager)))

    def _send_text(self, request: Request[RequestConfigurationText]) -> None:
        path = request.manager.config.path
        request.page.send(ConfigurationText(path.name if path else _DEFAULT_FILE_NAME, request.manager.config.text()))

    # --- files -------------------------------------------------------------------------------------------------

    def _create_configuration(self, request: Request[NewConfiguration]) -> None:
        if request.message.discard or self._may_discard(request.page, request.manager, None):
            self._open_config(request.manager, RvizConfig.default())

    def _open(self, request: Request[OpenConfiguration]) -> None:
        path = resolve_configuration_path(request.message.path, _get_base_folder(request.manager))
        config = RvizConfig.load(path)
        if request.message.discard or self._may_discard(request.page, request.manager, str(path)):
            self._open_config(request.manager, config)
            self._add_to_recent(request.manager, path)

    def _load(self, request: Request[LoadConfiguration]) -> None:
        config = RvizConfig.parse(request.message.text.removeprefix("\ufeff"), request.message.name[:MAX_TEXT_LENGTH])
        if request.message.discard or self._may_discard(request.page, request.manager, None):
            self._open_config(request.manager, config)

    def _revert(self, request: Request[RevertConfiguration]) -> None:
        if request.manager.config.path is not None:
            self._open_config(request.manager, RvizConfig.load(request.manager.config.path))

    def _save(self, request: Request[SaveConfiguration]) -> None:
        config, requested_path = request.manager.config, request.message.path
        path = (
            config.path
            if requested_path is None
            else resolve_configuration_path(requested_path, _get_base_folder(request.manager))
        )
        if path is None:
            raise ValueError("the configuration has no file yet")
        if not request.message.replace:
            if path == config.path and config.changed_on_disk:
                self._send_question(
                    request.page, "changed_on_disk", f"'{path}' was changed by another program", str(path)
                )
                return
            if path != config.path and configuration_file.get_file_state(path) is not None:
                self._send_question(request.page, "exists", f"'{path}' already exists", str(path))
                return
        previous_path = config.path
        config.save(path)
        remove_recovery_files(previous_path, config, self._recent)
        request.page.send(ConfigurationSaved(str(path)))
        request.manager.history.mark_saved()
        self._add_to_recent(request.manager, path)

    def _may_discard(self, page: Page, manager: VisualizationManager, path: str | None) -> bool:
        if manager.history.has_unsaved_edits:
            self._send_question(page, "unsaved", "there are unsaved changes", path)
        return not manager.history.has_unsaved_edits

    def _send_question(self, page: Page, question: Question, text: str, path: str | None) -> None:
        page.send(ConfigurationRefused(text, question, path))

    def _open_config(self, manager: VisualizationManager, config: RvizConfig) -> None:
        manager.open(config)
        for message in self.viewer.configuration_messages(manager):
            manager.publish(message)

    def _add_to_recent(self, manager: VisualizationManager, path: Path) -> None:
        self._recent.add(path)
        self.on_edit(manager)


_HANDLERS: dict[type, Callable[..., None]] = {
    AddDisplay: ConfigurationFeature._add,
    RequestConfigurationText: ConfigurationFeature._send_text,
    RequestDisplayChoices: ConfigurationFeature._send_display_choices,
    RequestFolder: ConfigurationFeature._send_folder,
    DuplicateDisplays: ConfigurationFeature._duplicate,
    GroupDisplays: ConfigurationFeature._group,
    LoadConfiguration: ConfigurationFeature._load,
    MoveDisplays: ConfigurationFeature._move,
    NewConfiguration: ConfigurationFeature._create_configuration,
    OpenConfiguration: ConfigurationFeature._open,
    Redo: ConfigurationFeature._redo,
    RemoveDisplays: ConfigurationFeature._remove,
    RenameDisplay: ConfigurationFeature._rename,
    RevertConfiguration: ConfigurationFeature._revert,
    SaveConfiguration: ConfigurationFeature._save,
    Undo: ConfigurationFeature._undo,
}

ConfigurationFeature.RECEIVES = tuple(_HANDLERS)


def _find_displays(manager: VisualizationManager, display_ids: list[str]) -> list[ViewerDisplay]:
    """Return the displays with these IDs, in the order of the tree.

    Unknown IDs are ignored.
    """
    selected = set(display_ids)
    return [display for display in manager.displays if display.id in selected]


def _get_base_folder(manager: VisualizationManager) -> Path:
    """Return the base folder of relative paths.

    This is the folder of the open file, or the working directory.
    """
    path = manager.config.path
    return path.absolute().parent if path is not None else Path.cwd()


def _check_name(text: str) -> str:
    """Return a name from a page, with each run of white space replaced by one space.

    Raises:
        ValueError: the name is empty or too long.
    """
    name = " ".join(text.split())
    if not name or len(name) > 200:
        raise ValueError("a display's name has 1 to 200 characters")
    return name


class PanelsFeature(PageFeature):
    """The open panels of pages.

    Initially they are the panels that the file opens. Each page has its own panels, so a change does not affect the
    other pages. The panels of the page that was changed last are written to the file. If there is no file, only the
    browser stores the panels.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ShowPanels,)

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the panels that the file opens."""
        config = manager.config
        return [Panels(manager.opened, config.document.source.name, config.panels.shown)]

    def receive(self, page: Page, message: Any) -> None:
        """Write the page's open panels into the configuration."""
        manager = self.managers.of(page)
        config = manager.config
        if config.panels.show(message.shown) and config.path is not None:
            manager.record_permanent_edit()
