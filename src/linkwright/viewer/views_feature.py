"""The views of a configuration, for the pages that see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.viewer.audience import Page
from linkwright.viewer.features import Desk, PageFeature
from linkwright.viewer.protocol import (
    ChangeSavedView,
    RemoveSavedView,
    SavedView,
    SavedViews,
    SaveView,
    ServerMessage,
    ViewChanged,
    ViewClasses,
    ViewState,
)
from linkwright.viewer.views import view_classes

if TYPE_CHECKING:
    from linkwright.viewer.manager import VisualizationManager


class ViewsFeature(PageFeature):
    """Every page has a camera of its own and begins with the file's; the last that any page told is saved."""

    RECEIVES: ClassVar[tuple[type, ...]] = (ViewChanged, SaveView, ChangeSavedView, RemoveSavedView)

    def __init__(self, desk: Desk) -> None:
        self._desk = desk
        self._classes = ViewClasses(view_classes())

    def opening(self) -> list[ServerMessage]:
        """The classes of views."""
        return [self._classes]

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """The view of the file, wherever pages have gone since, and the saved ones."""
        return [ViewState(manager.view, manager.opened), self._saved(manager)]

    def receive(self, page: Page, message: Any) -> None:
        """Keep what pages tell; views that are none are refused."""
        manager = self._desk.manager_of(page)
        views = manager.config.views
        try:
            if isinstance(message, ViewChanged):
                views.current = message.view
                return
            if isinstance(message, SaveView):
                views.save(message.view)
            elif isinstance(message, ChangeSavedView):
                views.change(message.id, message.view)
            elif isinstance(message, RemoveSavedView):
                views.remove(message.id)
        except KeyError:
            return  # another page removed it
        except ValueError as error:
            self._desk.node.get_logger().warning(f"A page sent a view that is none: {error}")
            return
        manager.edited()
        manager.publish(self._saved(manager))

    @staticmethod
    def _saved(manager: VisualizationManager) -> SavedViews:
        return SavedViews([SavedView(identity, view) for identity, view in manager.config.views.saved.items()])
