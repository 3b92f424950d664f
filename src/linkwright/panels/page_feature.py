"""Page features, which handle pages' requests besides displays: their base class, and their creation.

They are found through the entry points ``linkwright.page_features``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

from linkwright.diagnostics import Diagnostic
from linkwright.loading.extensions import extensions
from linkwright.page.audience import Page
from linkwright.page.outbox import Payload
from linkwright.page.protocol.message import ServerMessage, address_of
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.visualization.manager import Managers, VisualizationManager

if TYPE_CHECKING:
    from linkwright.panels.live_history import LiveHistory

F = TypeVar("F", bound="PageFeature")


class FeatureHost(Protocol):
    """The viewer, as its features see it.

    Attributes:
        context: the viewer's node, files and pages.
        managers: the configurations that pages see: one that they share, and those of single pages.
        live: the history of the last minutes; None if there is none.
    """

    context: ViewerContext
    managers: Managers
    live: LiveHistory | None

    def add_feature(self, cls: type[F], receives: Iterable[str] = ()) -> F:
        """Return the feature of a class, which receives all events from now on; the existing one, if any.

        Args:
            cls: its class.
            receives: addresses of messages that it receives beside those that its class names.
        """

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the messages of all features about a configuration."""

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Return messages for a page that begins to see a configuration, the frame table last; and binary frames."""


class PageFeature:
    """Handles some of the messages of pages.

    A feature must cost nothing while no page uses it: keep what a page subscribed to per page, and drop it in
    `page_gone`.

    Args:
        viewer: the viewer that it belongs to.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = ()
    """The messages of pages that `receive` handles; those of features created on demand are in their `OnDemand`."""

    BEFORE_DISPLAYS: ClassVar[bool] = False
    """Whether a page receives its `opening` before the displays, whose places may depend on it."""

    def __init__(self, viewer: FeatureHost) -> None:
        self.viewer = viewer
        self.context = viewer.context
        self.managers = viewer.managers

    @property
    def receives(self) -> tuple[str, ...]:
        """The messages of pages that this object handles, as ``module:class``."""
        return tuple(map(address_of, self.RECEIVES))

    def start(self) -> None:
        """Start: the viewer is listening."""

    def opening(self) -> list[ServerMessage]:
        """Return messages for a page that opens now."""
        return []

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return messages about a configuration, for a page that opens, or for all pages after a file was opened."""
        return []

    def edited(self, manager: VisualizationManager) -> None:
        """Handle a change of undo, redo or the unsaved state of a configuration."""

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Handle the end of a manager: drop its data."""

    def robot_changed(self) -> None:
        """Handle another robot of a display."""

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Handle new findings on the description; an empty list if it is in order."""

    def recording_shown(self) -> None:
        """Handle a recording that is shown: requests to robots and simulations are refused from now on."""

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request, a message of one of its classes."""

    def page_gone(self, page: Page) -> None:
        """Handle the end of a page."""

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store unsaved edits of pages, before the program ends; returns the findings about it."""
        return []

    def close(self) -> None:
        """Stop for good."""


GROUP = "linkwright.page_features"
"""The group of the entry points."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """Return a feature of each kind; one of another package that cannot be made is logged, and left out."""
    made: list[PageFeature] = []
    for name, entry in extensions(GROUP).items():
        try:
            feature = entry.load()(viewer)
        except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
            problem = f"{type(error).__name__}: {error}"
        else:
            if isinstance(feature, PageFeature):
                made.append(feature)
                continue
            problem = f"{entry.value} does not make a PageFeature"
        viewer.context.node.get_logger().error(f"The page feature '{name}' cannot be loaded: {problem}")
    return made
