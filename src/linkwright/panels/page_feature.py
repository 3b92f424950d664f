"""The base class of page features, which handle most requests of pages, and their creation.

Most features are found through the entry points ``linkwright.page_features`` and are created with the viewer.

Others are created on demand: when a page sends one of their messages, or when one of their topics is published. Each is
declared by an `OnDemand`, which names the class, so that the class's module is imported only then. Until then, pages
receive a default message instead. The declarations are found through the entry points
``linkwright.page_features_on_demand``, whose values are modules with a tuple ``ON_DEMAND``.
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
    """The viewer as its page features see it.

    Attributes:
        context: the viewer's node, files and pages.
        managers: the managers of the configurations that pages show: a shared one, and those of single pages.
        live: the history of the last minutes; None if it is not stored.
    """

    context: ViewerContext
    managers: Managers
    live: LiveHistory | None

    def add_feature(self, cls: type[F], receives: Iterable[str] = ()) -> F:
        """Return the feature of a class, which is created if it does not exist yet.

        The feature receives all events from then on.

        Args:
            cls: the class of the feature.
            receives: addresses of messages that the feature handles in addition to those that its class names.
        """

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return all features' messages about a configuration."""

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Return the messages and binary frames for a page that opens a configuration.

        The frame table is the last message.
        """


class PageFeature:
    """The base class of features, each of which handles some of the messages of pages.

    A feature must cost nothing while no page uses it: it subscribes for the pages that need it, and unsubscribes in
    `page_closed`.

    Args:
        viewer: the viewer of the feature.
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
        """Return the messages that do not concern a configuration, for a page that has just opened."""
        return []

    def configured(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the messages about a configuration, for a page that opens, or after a file was opened."""
        return []

    def edited(self, manager: VisualizationManager) -> None:
        """Handle a change of a configuration's undo history or of its unsaved state."""

    def manager_closed(self, manager: VisualizationManager) -> None:
        """Discard the data of a manager that was closed."""

    def robot_changed(self) -> None:
        """Handle a new robot of any display."""

    def diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Handle new findings on the description, which replace the former ones; the list may be empty."""

    def recording_shown(self) -> None:
        """Switch to showing a recording: from now on, refuse requests to robots and simulations."""

    def receive(self, page: Page, message: Any) -> None:
        """Handle a message of a page, whose address is one of `receives`."""

    def page_closed(self, page: Page) -> None:
        """Discard the data of a page that was closed."""

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store pages' unsaved edits before the program ends, and return the findings about that."""
        return []

    def close(self) -> None:
        """Release everything; called when the viewer closes."""


GROUP = "linkwright.page_features"
"""The group of the entry points."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """Create all features that have an entry point; those that fail are logged and omitted."""
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
        feature: the feature's class, as ``module:class``.
        receives: the classes of messages that the feature handles, as ``module:class``; the first such message creates
            the feature.
        topics: the topics whose first publisher creates the feature.
        until: the message that pages receive while the feature does not exist.
        refuses_recordings: whether the feature must exist while a recording is shown, to refuse requests.
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
    """Creates features on demand, and passes on the message for which a feature was created.

    Each feature is created once; later messages are passed to it directly.
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
        """Create the feature that handles the message, and pass the message on."""
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
