"""Page features, which handle pages' requests that are not about displays: their base class and their creation.

Most are found through the entry points ``linkwright.page_features`` and are created with the viewer.

Others are created on demand: when a page asks for one, or when one of their topics is published. Each is declared by an
`OnDemand`, which names its class, so that the module of the class is imported only then. Until then pages receive a
default message instead. They are found through the entry points ``linkwright.page_features_on_demand``, whose values
are modules with a tuple ``ON_DEMAND``.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, TypeVar

from linkwright.diagnostics import Diagnostic
from linkwright.graph import Logger
from linkwright.loading.extensions import extensions
from linkwright.page.audience import Page
from linkwright.page.outbox import Payload
from linkwright.page.protocol.message import ServerMessage, address_of, define_later, tag_of
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.visualization.manager import Managers, VisualizationManager

if TYPE_CHECKING:
    from linkwright.panels.live_history import LiveHistory


F = TypeVar("F", bound="PageFeature")


class FeatureHost(Protocol):
    """The viewer, as its features see it.

    Attributes:
        context: the viewer's node, files and pages.
        managers: the configurations that pages show: a shared one, and those of single pages.
        live: the history of the last minutes; None if there is none.
    """

    context: ViewerContext
    managers: Managers
    live: LiveHistory | None

    def add_feature(self, cls: type[F], receives: Iterable[str] = ()) -> F:
        """Return the feature of a class, and create it if it does not exist yet.

        From then on it receives all events.

        Args:
            cls: the class of the feature.
            receives: addresses of messages that it handles in addition to those that its class names.
        """

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return all features' messages about a configuration."""

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Return the messages (frame table last) and binary frames for a page that opens a configuration."""


class PageFeature:
    """Handles some of the messages of pages.

    A feature must cost nothing while no page uses it: store subscriptions per page, and drop them in `page_closed`.

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
        """The messages of pages that this feature handles, as ``module:class``."""
        return tuple(map(address_of, self.RECEIVES))

    def start(self) -> None:
        """Start the feature; called when the viewer starts."""

    def opening(self) -> list[ServerMessage]:
        """Return messages for a page that has just opened."""
        return []

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return messages about a configuration, for a new page, or for all pages when a file was opened."""
        return []

    def edited(self, manager: VisualizationManager) -> None:
        """Handle a change of undo, redo or the unsaved state of a configuration."""

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Drop the data of a manager that was closed."""

    def robot_changed(self) -> None:
        """Handle a display's change to another robot."""

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Handle new findings on the description; the list is empty if there are none."""

    def recording_shown(self) -> None:
        """Switch to showing a recording: from now on, refuse requests to robots and simulations."""

    def receive(self, page: Page, message: Any) -> None:
        """Handle a request, whose class is one of those that the feature receives."""

    def page_closed(self, page: Page) -> None:
        """Drop the data of a page that was closed."""

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store pages' unsaved edits before the program ends, and return the findings about that."""
        return []

    def close(self) -> None:
        """Release everything; called when the viewer closes."""


GROUP = "linkwright.page_features"
"""The group of the entry points."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """Create all features; log and skip those of other packages that fail."""
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


ON_DEMAND_GROUP = "linkwright.page_features_on_demand"
"""The group of the entry points."""


@dataclass(frozen=True, eq=False)
class OnDemand:
    """The declaration of a feature that is created on demand.

    Attributes:
        feature: its class, as ``module:class``.
        receives: the classes of messages that it handles, as ``module:class``; the first such message imports the
            module.
        topics: the topics whose publishers make it necessary.
        until: the message that pages receive while the feature does not exist.
        refuses_recordings: whether it must exist while a recording is shown, to refuse requests.
    """

    feature: str
    receives: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    until: ServerMessage | None = None
    refuses_recordings: bool = False


def messages(module: str, *names: str) -> tuple[str, ...]:
    """Return the addresses of message classes that a module defines."""
    return tuple(f"{module}:{name}" for name in names)


def _declared(logger: Logger) -> Iterator[OnDemand]:
    """Yield the declarations of all packages; log and skip modules that cannot be imported."""
    for name, entry in extensions(ON_DEMAND_GROUP).items():
        try:
            found: tuple[OnDemand, ...] = entry.load().ON_DEMAND
        except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
            problem = f"{type(error).__name__}: {error}"
        else:
            yield from found
            continue
        logger.error(f"The page features '{name}' cannot be loaded: {problem}")


class OnDemandFeatures(PageFeature):
    """Creates features on demand, and forwards the message that asked for one.

    Each feature is created once and receives later messages directly.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._declared = tuple(_declared(self.context.node.get_logger()))
        self._by_message = {message: feature for feature in self._declared for message in feature.receives}
        for message in self._by_message:
            define_later(message)
        self._asleep = {topic: feature for feature in self._declared for topic in feature.topics}
        self._created: set[OnDemand] = set()
        self._listening = False

    @property
    def receives(self) -> tuple[str, ...]:
        """The messages of all features that are created on demand."""
        return tuple(self._by_message)

    def opening(self) -> list[ServerMessage]:
        """Return the messages of features that do not exist yet, and begin to watch their topics."""
        if not self._listening and self._asleep:
            self._listening = True
            self.context.graph_changes.watch(self._review)
        self._review()
        waiting = (feature.until for feature in self._declared if feature not in self._created)
        return sorted((message for message in waiting if message is not None), key=tag_of)

    def receive(self, page: Page, message: Any) -> None:
        """Create the feature that handles the message, and forward it."""
        self._create(self._by_message[address_of(type(message))]).receive(page, message)

    def recording_shown(self) -> None:
        """Create the features that refuse requests while a recording is shown; they are notified next."""
        for feature in self._declared:
            if feature.refuses_recordings:
                self._create(feature)

    def page_closed(self, page: Page) -> None:
        """Stop watching topics when the last page has closed."""
        if self._listening and len(self.context.pages) == 0:
            self._stop()

    def close(self) -> None:
        """Stop watching topics."""
        self._stop()

    def _stop(self) -> None:
        self._listening = False
        self.context.graph_changes.unwatch(self._review)

    def _review(self) -> None:
        """Create the features whose topics have publishers."""
        for topic, feature in list(self._asleep.items()):
            if self.context.node.count_publishers(topic):
                self._create(feature)

    def _create(self, declared: OnDemand) -> PageFeature:
        module, _, name = declared.feature.partition(":")
        feature: PageFeature = self.viewer.add_feature(getattr(import_module(module), name), declared.receives)
        if declared not in self._created:
            self._created.add(declared)
            self._asleep = {topic: other for topic, other in self._asleep.items() if other is not declared}
            for message in feature.opening():
                self.context.pages.publish(message)
            if not self._asleep:
                self._stop()
        return feature
