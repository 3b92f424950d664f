"""The base class of page features, and the creation of features.

Features handle most requests of pages. Most features are found through the entry points ``linkwright.page_features``,
and are created with the viewer.

Other features are created on demand: when a page sends one of their messages, or when one of their topics is
published. An `OnDemand` declares the class by name, so that its module is imported only then. Until then, pages
receive a default message. The declarations are found through the entry points
``linkwright.page_features_on_demand``. The value of such an entry point is a module with a tuple ``ON_DEMAND``.
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
from linkwright.page.protocol.message import ServerMessage, define_later, get_import_path, get_tag
from linkwright.rviz.context import ViewerContext
from linkwright.rviz.visualization.manager import Managers, VisualizationManager

if TYPE_CHECKING:
    from linkwright.panels.live_history import LiveHistory


F = TypeVar("F", bound="PageFeature")


class FeatureHost(Protocol):
    """The interface of the viewer for its page features.

    Attributes:
        context: the viewer's node, files and pages.
        managers: the managers of the configurations that pages show.
        live: the history of the last minutes; None if it is not stored.
    """

    context: ViewerContext
    managers: Managers
    live: LiveHistory | None

    def add_feature(self, cls: type[F], receives: Iterable[str] = ()) -> F:
        """Return the feature of a class, creating it if it does not exist yet.

        The feature receives all events from then on.

        Args:
            cls: the class of the feature.
            receives: the import paths of messages that the feature handles in addition to its `RECEIVES`.
        """

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the messages of all features about a configuration."""

    def opening_messages(self, manager: VisualizationManager) -> tuple[list[ServerMessage], list[Payload]]:
        """Return the messages and binary frames for a page that opens a configuration.

        The frame table is the last message.
        """


class PageFeature:
    """The base class of features. Each feature handles some of the messages of pages.

    A feature must use no resources while no page uses it. It subscribes when a page needs it, and unsubscribes in
    `remove_page`.

    Args:
        viewer: the viewer of the feature.
    """

    RECEIVES: ClassVar[tuple[type, ...]] = ()
    """The messages that `receive` handles. For a feature created on demand, its `OnDemand` declares them."""

    BEFORE_DISPLAYS: ClassVar[bool] = False
    """Whether a page receives the messages of `opening_messages` before the displays, which may depend on them."""

    def __init__(self, viewer: FeatureHost) -> None:
        self.viewer = viewer
        self.context = viewer.context
        self.managers = viewer.managers

    @property
    def receives(self) -> tuple[str, ...]:
        """The messages of pages that this feature handles, as ``module:class``."""
        return tuple(map(get_import_path, self.RECEIVES))

    def start(self) -> None:
        """Start the feature when the viewer starts."""

    def opening_messages(self) -> list[ServerMessage]:
        """Return the messages for a newly opened page that do not concern a configuration."""
        return []

    def configuration_messages(self, manager: VisualizationManager) -> list[ServerMessage]:
        """Return the messages about a configuration.

        They are sent to a page that opens, and to all its pages after a file was opened.
        """
        return []

    def on_edit(self, manager: VisualizationManager) -> None:
        """Handle a change to a configuration's undo history or its unsaved state."""

    def remove_manager(self, manager: VisualizationManager) -> None:
        """Discard the data of a manager that was closed."""

    def on_robot_changed(self) -> None:
        """Handle a new robot of any display."""

    def on_diagnostics_changed(self, diagnostics: Sequence[Diagnostic]) -> None:
        """Handle new findings about the description.

        They replace the previous findings. The list may be empty.
        """

    def on_recording_shown(self) -> None:
        """Handle the display of a recording.

        Refuse requests to robots and simulations from now on.
        """

    def receive(self, page: Page, message: Any) -> None:
        """Handle a message of a page, whose class is one of `receives`."""

    def remove_page(self, page: Page) -> None:
        """Discard the data of a page that was closed."""

    def keep_unsaved(self) -> list[Diagnostic]:
        """Store unsaved edits of pages before the program ends, and return the findings about them."""
        return []

    def close(self) -> None:
        """Release all resources when the viewer closes."""


ENTRY_POINT_GROUP = "linkwright.page_features"
"""The group of the entry points of features that are created with the viewer."""


def make_features(viewer: FeatureHost) -> list[PageFeature]:
    """Return new features for all entry points.

    Features that fail are logged and omitted.
    """
    features: list[PageFeature] = []
    for name, entry_point in extensions(ENTRY_POINT_GROUP).items():
        try:
            feature = entry_point.load()(viewer)
        except Exception as error:  # noqa: BLE001  # a third-party package may raise any exception
            problem = f"{type(error).__name__}: {error}"
        else:
            if isinstance(feature, PageFeature):
                features.append(feature)
                continue
            problem = f"{entry_point.value} does not make a PageFeature"
        viewer.context.node.get_logger().error(f"The page feature '{name}' cannot be loaded: {problem}")
    return features


ON_DEMAND_ENTRY_POINT_GROUP = "linkwright.page_features_on_demand"
"""The group of the entry points of features that are created on demand."""


@dataclass(frozen=True, eq=False)
class OnDemand:
    """The declaration of a feature that is created on demand.

    Attributes:
        feature: the feature's class, as ``module:class``.
        receives: the classes of messages that the feature handles, as ``module:class``; the first such message creates
            the feature.
        topics: the topics whose first publisher creates the feature.
        until: the message that pages receive while the feature does not exist; None for no message.
        refuses_recordings: whether the feature must exist while a recording is shown, to refuse requests.
    """

    feature: str
    receives: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    until: ServerMessage | None = None
    refuses_recordings: bool = False


def list_message_paths(module: str, *names: str) -> tuple[str, ...]:
    """Return the import paths of message classes of a module, each as ``module:class``."""
    return tuple(f"{module}:{name}" for name in names)


def _load_declarations(logger: Logger) -> Iterator[OnDemand]:
    """Yield the declarations of all packages.

    Modules that cannot be imported are logged and skipped.
    """
    for name, entry_point in extensions(ON_DEMAND_ENTRY_POINT_GROUP).items():
        try:
            declarations: tuple[OnDemand, ...] = entry_point.load().ON_DEMAND
        except Exception as error:  # noqa: BLE001  # a third-party package may raise any exception
            problem = f"{type(error).__name__}: {error}"
        else:
            yield from declarations
            continue
        logger.error(f"The page features '{name}' cannot be loaded: {problem}")


class OnDemandFeatures(PageFeature):
    """The feature that creates other features on demand, and forwards the first message.

    Each feature is created once. Later messages are passed to it directly.
    """

    def __init__(self, viewer: FeatureHost) -> None:
        super().__init__(viewer)
        self._declared = tuple(_load_declarations(self.context.node.get_logger()))
        self._declaration_by_message = {message: feature for feature in self._declared for message in feature.receives}
        for message in self._declaration_by_message:
            define_later(message)
        self._declaration_by_topic = {topic: feature for feature in self._declared for topic in feature.topics}
        self._created: set[OnDemand] = set()
        self._is_watching = False

    @property
    def receives(self) -> tuple[str, ...]:
        """The messages of all features that are created on demand."""
        return tuple(self._declaration_by_message)

    def opening_messages(self) -> list[ServerMessage]:
        """Return the `until` messages of features that do not exist yet, and watch their topics."""
        if not self._is_watching and self._declaration_by_topic:
            self._is_watching = True
            self.context.graph_changes.watch(self._create_published)
        self._create_published()
        default_messages = (feature.until for feature in self._declared if feature not in self._created)
        return sorted((message for message in default_messages if message is not None), key=get_tag)

    def receive(self, page: Page, message: Any) -> None:
        """Create the feature that handles the message, and pass the message on."""
        self._create(self._declaration_by_message[get_import_path(type(message))]).receive(page, message)

    def on_recording_shown(self) -> None:
        """Create and notify the features that refuse requests while a recording is shown."""
        for feature in self._declared:
            if feature.refuses_recordings:
                self._create(feature)

    def remove_page(self, page: Page) -> None:
        """Stop watching topics when the last page has closed."""
        if self._is_watching and len(self.context.pages) == 0:
            self._stop_watching()

    def close(self) -> None:
        """Stop watching topics."""
        self._stop_watching()

    def _stop_watching(self) -> None:
        self._is_watching = False
        self.context.graph_changes.unwatch(self._create_published)

    def _create_published(self) -> None:
        """Create the features whose topics have publishers."""
        for topic, feature in list(self._declaration_by_topic.items()):
            if self.context.node.count_publishers(topic):
                self._create(feature)

    def _create(self, declaration: OnDemand) -> PageFeature:
        module, _, name = declaration.feature.partition(":")
        feature: PageFeature = self.viewer.add_feature(getattr(import_module(module), name), declaration.receives)
        if declaration not in self._created:
            self._created.add(declaration)
            self._declaration_by_topic = {
                topic: other for topic, other in self._declaration_by_topic.items() if other is not declaration
            }
            for message in feature.opening_messages():
                self.context.pages.publish(message)
            if not self._declaration_by_topic:
                self._stop_watching()
        return feature
