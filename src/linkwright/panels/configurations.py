"""Handles edits of configurations from pages: adding and removing displays, undo, open, and save."""

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
    AskConfigurationText,
    AskDisplayChoices,
    AskFolder,
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
    RevertConfiguration,
    SaveConfiguration,
    ShowPanels,
    Undo,
)
from linkwright.page.protocol.message import ServerMessage
from linkwright.panels.page_feature import FeatureHost, PageFeature
from linkwright.rviz.config import file as configuration_file
from linkwright.rviz.config.locations import RecentFiles, configuration_path, list_folder, remove_recovery_files
from linkwright.rviz.config.rviz_config import RvizConfig
from linkwright.rviz.config.schema import MAXIMUM_TEXT
from linkwright.rviz.displays.catalogue import has_display

if TYPE_CHECKING:
    from linkwright.rviz.displays.base.display import ViewerDisplay
    from linkwright.rviz.visualization.manager import VisualizationManager


_UNNAMED = "untitled.rviz"


Message = TypeVar("Message")


@dataclass(frozen=True, slots=True)
class Request(Generic[Message]):
    """A request of a page, and the configuration that the page shows."""

    page: Page
    manager: VisualizationManager
    message: Message


class ConfigurationFeature(PageFeature):
    """Handles pages' requests about configurations.

    Unsaved edits are never discarded unless the page confirms it.

    Args:
        viewer: the viewer of the feature.
        recent: the recently opened or saved files.
    """

    def __init__(self, viewer: FeatureHost, recent: RecentFiles | None = None) -> None:
        super().__init__(viewer)
        self._recent = recent or RecentFiles()
        self._sent: dict[VisualizationManager, Configuration] = {}

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the current state of the configuration: its file, and the names of undo and redo."""
        self._sent[manager] = self._state(manager)
        return [self._sent[manager]]

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Discard the state that was sent to the manager's pages."""
        self._sent.pop(manager, None)

    def edited(self, manager: VisualizationManager) -> None:
        """Send the state of the configuration to its pages if the state has changed."""
        state = self._state(manager)
        if self._sent.get(manager) != state:
            self._sent[manager] = state
            manager.publish(state)

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request, or send the reason for refusing it."""
        manager = self.managers.of(page)
        try:
            _HANDLERS[type(message)](self, Request(page, manager, message))
        except LinkwrightError as error:
            first = error.diagnostics[0]
            where = f" ({first.span.file}:{first.span.line})" if first.span else ""
            page.send(ConfigurationRefused(first.message + where, None, None))
        except ValueError as error:
            page.send(ConfigurationRefused(str(error), None, None))

    def _state(self, manager: VisualizationManager) -> Configuration:
        config, history = manager.config, manager.history
        return Configuration(
            path=None if config.path is None else str(config.path),
            opened=manager.opened,
            unsaved=history.unsaved,
            undo=history.undoable,
            redo=history.redoable,
            own=manager is not self.managers.shared,
            recent=self._recent.paths,
        )

    # --- displays ----------------------------------------------------------------------------------------------

    def _add(self, asked: Request[AddDisplay]) -> None:
        message, manager = asked.message, asked.manager
        if not has_display(message.cls):
            raise ValueError(f"there are no displays of the class '{message.cls[:100]}'")
        entry = manager.config.make(message.cls, _name(message.name))
        group = manager.display(message.group) if message.group is not None else None
        topic = message.topic
        prepare: Callable[[ViewerDisplay], None] | None = None
        if topic is not None:
            from linkwright.panels.displays import show_topic

            prepare = partial(show_topic, topic=topic)
        manager.tree.add(entry, group.config if group else None, prepare)

    def _duplicate(self, asked: Request[DuplicateDisplays]) -> None:
        if displays := _displays_of(asked.manager, asked.message.displays):
            asked.manager.tree.duplicate(displays)

    def _rename(self, asked: Request[RenameDisplay]) -> None:
        for display in _displays_of(asked.manager, [asked.message.display]):
            asked.manager.tree.rename(display, _name(asked.message.name))

    def _remove(self, asked: Request[RemoveDisplays]) -> None:
        if displays := _displays_of(asked.manager, asked.message.displays):
            asked.manager.tree.remove(displays)

    def _move(self, asked: Request[MoveDisplays]) -> None:
        message, manager = asked.message, asked.manager
        group = manager.display(message.group) if message.group is not None else None
        before = manager.display(message.before) if message.before is not None else None
        displays = _displays_of(manager, message.displays)
        if displays and (group is None) == (message.group is None):
            manager.tree.move(displays, group.config if group else None, before.config if before else None)

    def _group(self, asked: Request[GroupDisplays]) -> None:
        if displays := _displays_of(asked.manager, asked.message.displays):
            asked.manager.tree.gather(displays, _name(asked.message.name))

    def _undo(self, asked: Request[Undo]) -> None:
        asked.manager.history.undo()

    def _redo(self, asked: Request[Redo]) -> None:
        asked.manager.history.redo()

    # --- questions ---------------------------------------------------------------------------------------------

    def _ask_displays(self, asked: Request[AskDisplayChoices]) -> None:
        from linkwright.panels.displays import choices

        asked.page.send(choices(self.context.node))

    def _ask_folder(self, asked: Request[AskFolder]) -> None:
        asked.page.send(list_folder(asked.message.path, _folder(asked.manager)))

    def _ask_text(self, asked: Request[AskConfigurationText]) -> None:
        path = asked.manager.config.path
        asked.page.send(ConfigurationText(path.name if path else _UNNAMED, asked.manager.config.text()))

    # --- files -------------------------------------------------------------------------------------------------

    def _new(self, asked: Request[NewConfiguration]) -> None:
        if asked.message.discard or self._may_lose(asked.page, asked.manager, None):
            self._show(asked.manager, RvizConfig.default())

    def _open(self, asked: Request[OpenConfiguration]) -> None:
        path = configuration_path(asked.message.path, _folder(asked.manager))
        config = RvizConfig.load(path)
        if asked.message.discard or self._may_lose(asked.page, asked.manager, str(path)):
            self._show(asked.manager, config)
            self._remember(asked.manager, path)

    def _load(self, asked: Request[LoadConfiguration]) -> None:
        config = RvizConfig.parse(asked.message.text.removeprefix("\ufeff"), asked.message.name[:MAXIMUM_TEXT])
        if asked.message.discard or self._may_lose(asked.page, asked.manager, None):
            self._show(asked.manager, config)

    def _revert(self, asked: Request[RevertConfiguration]) -> None:
        if asked.manager.config.path is not None:
            self._show(asked.manager, RvizConfig.load(asked.manager.config.path))

    def _save(self, asked: Request[SaveConfiguration]) -> None:
        config, named = asked.manager.config, asked.message.path
        path = config.path if named is None else configuration_path(named, _folder(asked.manager))
        if path is None:
            raise ValueError("the configuration has no file yet")
        if not asked.message.replace:
            if path == config.path and config.changed_on_disk:
                self._ask(asked.page, "changed_on_disk", f"'{path}' was changed by another program", str(path))
                return
            if path != config.path and configuration_file.state_of(path) is not None:
                self._ask(asked.page, "exists", f"'{path}' is there already", str(path))
                return
        former = config.path
        config.save(path)
        remove_recovery_files(former, config, self._recent)
        asked.page.send(ConfigurationSaved(str(path)))
        asked.manager.history.saved()
        self._remember(asked.manager, path)

    def _may_lose(self, page: Page, manager: VisualizationManager, path: str | None) -> bool:
        if manager.history.unsaved:
            self._ask(page, "unsaved", "there are unsaved changes", path)
        return not manager.history.unsaved

    def _ask(self, page: Page, question: Question, text: str, path: str | None) -> None:
        page.send(ConfigurationRefused(text, question, path))

    def _show(self, manager: VisualizationManager, config: RvizConfig) -> None:
        manager.open(config)
        for message in self.viewer.configured(manager):
            manager.publish(message)

    def _remember(self, manager: VisualizationManager, path: Path) -> None:
        self._recent.add(path)
        self.edited(manager)


_HANDLERS: dict[type, Callable[..., None]] = {
    AddDisplay: ConfigurationFeature._add,
    AskConfigurationText: ConfigurationFeature._ask_text,
    AskDisplayChoices: ConfigurationFeature._ask_displays,
    AskFolder: ConfigurationFeature._ask_folder,
    DuplicateDisplays: ConfigurationFeature._duplicate,
    GroupDisplays: ConfigurationFeature._group,
    LoadConfiguration: ConfigurationFeature._load,
    MoveDisplays: ConfigurationFeature._move,
    NewConfiguration: ConfigurationFeature._new,
    OpenConfiguration: ConfigurationFeature._open,
    Redo: ConfigurationFeature._redo,
    RemoveDisplays: ConfigurationFeature._remove,
    RenameDisplay: ConfigurationFeature._rename,
    RevertConfiguration: ConfigurationFeature._revert,
    SaveConfiguration: ConfigurationFeature._save,
    Undo: ConfigurationFeature._undo,
}

ConfigurationFeature.RECEIVES = tuple(_HANDLERS)


def _displays_of(manager: VisualizationManager, identities: list[str]) -> list[ViewerDisplay]:
    """Return the displays with these IDs, in the order of the tree; unknown IDs are ignored."""
    selected = set(identities)
    return [display for display in manager.displays if display.id in selected]


def _folder(manager: VisualizationManager) -> Path:
    """Return the folder to which paths are relative: the open file's folder, or the working directory."""
    path = manager.config.path
    return path.absolute().parent if path is not None else Path.cwd()


def _name(text: str) -> str:
    """Return a name that a page sent, with each run of white space replaced by a blank.

    Raises:
        ValueError: the name is empty or too long.
    """
    name = " ".join(text.split())
    if not name or len(name) > 200:
        raise ValueError("a display's name has 1 to 200 characters")
    return name


class PanelsFeature(PageFeature):
    """The open panels of pages, which are initially those of the file.

    Each page has its own panels, so a change does not affect the other pages. The file receives the panels of the page
    that changed them last. If there is no file, only the browser stores the panels.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = (ShowPanels,)

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the panels that the file opens."""
        config = manager.config
        return [Panels(manager.opened, config.document.source.name, config.panels.shown)]

    def receive(self, page: Page, message: Any) -> None:
        """Write the page's open panels into the configuration."""
        manager = self.managers.of(page)
        config = manager.config
        if config.panels.show(message.shown) and config.path is not None:
            manager.edited()
