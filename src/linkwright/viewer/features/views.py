"""The views of a configuration, for the pages that see it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar

from linkwright.viewer.config.views import view_classes
from linkwright.viewer.features.page_feature import FeatureHost, PageFeature
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.protocol.views import (
    ChangeSavedView,
    RemoveSavedView,
    SavedView,
    SavedViews,
    SaveView,
    ViewChanged,
    ViewClasses,
    ViewState,
)
from linkwright.viewer.web.audience import Page

if TYPE_CHECKING:
    from linkwright.viewer.visualization.manager import VisualizationManager


class ViewsFeature(PageFeature):
    """Every page has a camera of its own and begins with the file's; the last that any page told is saved."""

    RECEIVES: ClassVar[tuple[type, ...]] = (ViewChanged, SaveView, ChangeSavedView, RemoveSavedView)

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._classes = ViewClasses(view_classes())

    def opening(self) -> list[ServerMessage]:
        """The classes of views."""
        return [self._classes]

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """The view of the file, wherever pages have gone since, and the saved ones."""
        return [ViewState(manager.view, manager.opened), self._saved(manager)]

    def receive(self, page: Page, message: Any) -> None:
        """Keep the views that pages send; those that are not valid are refused."""
        manager = self.managers.of(page)
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
            self.context.node.get_logger().warning(f"A page sent a view that is none: {error}")
            return
        manager.edited()
        manager.publish(self._saved(manager))

    @staticmethod
    def _saved(manager: VisualizationManager) -> SavedViews:
        return SavedViews([SavedView(identity, view) for identity, view in manager.config.views.saved.items()])
