"""Page features, which answer pages' requests besides displays: their base class, and making them.

They are found through the entry points ``linkwright.page_features``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

from linkwright.diagnostics import Diagnostic
from linkwright.extensions import extensions
from linkwright.viewer.context import ViewerContext
from linkwright.viewer.protocol.message import ServerMessage
from linkwright.viewer.visualization.manager import Managers, VisualizationManager
from linkwright.viewer.web.audience import Page
from linkwright.viewer.web.outbox import Payload

if TYPE_CHECKING:
    from linkwright.viewer.live_history import LiveHistory

F = TypeVar("F", bound="PageFeature")


class FeatureHost(Protocol):
    """The viewer, as its features see it.

    Attributes:
        context: the viewer's node, files and pages.
        managers: the configurations that pages see: one that they share, and those of single pages.
        live: keeps what came in the last minutes; None where nothing does.
    """

    context: ViewerContext
    managers: Managers
    live: LiveHistory | None

    def add_feature(self, cls: type[F], receives: Iterable[type] = ()) -> F:
        """A feature of a class, told of all events from now on; the present one, if any.

        Args:
            cls: its class.
            receives: classes of messages that it receives beside those that its class names.
        """

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """The messages of all features about a configuration."""

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Messages for a page that begins to see a configuration, the frame table last; and binary frames."""


class PageFeature:
    """Answers some of the messages of pages.

    A feature must cost nothing while no page uses it: keep what a page subscribed to per page, and drop it in
    `page_gone`.

    Args:
        viewer: the viewer that it belongs to.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = ()
    """The messages of pages that come to `receive`; of features that are made on demand `on_demand` names them."""

    BEFORE_DISPLAYS: ClassVar[bool] = False
    """Whether a page is told of its `opening` before the displays, whose places may depend on it."""

    def __init__(self, viewer: FeatureHost) -> None:
        self.viewer = viewer
        self.context = viewer.context
        self.managers = viewer.managers

    def start(self) -> None:
        """The viewer has begun to listen."""

    def opening(self) -> list[ServerMessage]:
        """Messages for a page that opens now."""
        return []

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Messages about a configuration, for a page that opens, or for all its pages when another file was opened."""
        return []

    def edited(self, manager: VisualizationManager) -> None:
        """Undo, redo or whether something of a configuration is unsaved may have changed."""

    def manager_closed(self, manager: VisualizationManager) -> None:
        """A manager was closed: drop what is kept for it."""

    def robot_changed(self) -> None:
        """A display shows another robot."""

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """The findings about the description have changed; an empty list when it is in order."""

    def recording_shown(self) -> None:
        """A recording is shown: requests to robots and simulations are refused from now on."""

    def receive(self, page: Page, message: Any) -> None:
        """Carry out a request; the message is of one of the classes that it takes."""

    def page_gone(self, page: Page) -> None:
        """A page was closed."""

    def keep_unsaved(self) -> list[Diagnostic]:
        """Keep unsaved edits of pages, before the program ends; returns the notices about it."""
        return []

    def close(self) -> None:
        """End for good."""


GROUP = "linkwright.page_features"
"""The group of the entry points."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """A feature of each kind; one of another package that cannot be made is logged, and left out."""
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
            problem = f"{entry.value} makes no PageFeature"
        viewer.context.node.get_logger().error(f"The page feature '{name}' cannot be had: {problem}")
    return made
