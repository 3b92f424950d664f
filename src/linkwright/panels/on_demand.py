"""Features that are created on demand: when a page asks for one, or one of their topics is published.

Each is declared by an `OnDemand`, which names its class; the class's module is imported then. Until then pages receive
a default message in its place. They are found through the entry points ``linkwright.page_features_on_demand``, whose
values are modules with a tuple ``ON_DEMAND``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from linkwright.graph import Logger
from linkwright.loading.extensions import extensions
from linkwright.page.audience import Page
from linkwright.page.protocol.message import ServerMessage, address_of, define_later, tag_of
from linkwright.panels.page_feature import FeatureHost, PageFeature

GROUP = "linkwright.page_features_on_demand"
"""The group of the entry points."""


@dataclass(frozen=True, eq=False)
class OnDemand:
    """A feature that is created on demand.

    Attributes:
        feature: its class, as ``module:class``.
        receives: the classes of messages that it handles, as ``module:class``: a module is imported with the first.
        topics: the topics whose publishers make it necessary.
        until: the message that pages receive while the feature does not exist.
        refuses_recordings: whether it must exist beside a recording that is shown, to refuse requests.
    """

    feature: str
    receives: tuple[str, ...] = ()
    topics: tuple[str, ...] = ()
    until: ServerMessage | None = None
    refuses_recordings: bool = False


def messages(module: str, *names: str) -> tuple[str, ...]:
    """Return the addresses of classes of messages that a module defines."""
    return tuple(f"{module}:{name}" for name in names)


def _declared(logger: Logger) -> Iterator[OnDemand]:
    """Yield the declarations of all packages; a module that cannot be imported is logged, and left out."""
    for name, entry in extensions(GROUP).items():
        try:
            found: tuple[OnDemand, ...] = entry.load().ON_DEMAND
        except Exception as error:  # noqa: BLE001  # of a package that is not ours anything may be wrong
            problem = f"{type(error).__name__}: {error}"
        else:
            yield from found
            continue
        logger.error(f"The page features '{name}' cannot be loaded: {problem}")


class OnDemandFeatures(PageFeature):
    """Creates each of them once, and forwards the message that asked for it; later messages go to it directly."""

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
        """The messages of all features that are not created yet."""
        return tuple(self._by_message)

    def opening(self) -> list[ServerMessage]:
        """Return the messages of features that do not exist yet; watches their topics while there are pages."""
        if not self._listening and self._asleep:
            self._listening = True
            self.context.graph_changes.listen(self._review)
        self._review()
        waiting = (feature.until for feature in self._declared if feature not in self._created)
        return sorted((message for message in waiting if message is not None), key=tag_of)

    def receive(self, page: Page, message: Any) -> None:
        """Create the feature that handles the message, and forward it."""
        self._create(self._by_message[address_of(type(message))]).receive(page, message)

    def recording_shown(self) -> None:
        """Create the features that refuse requests beside a recording; they are notified next."""
        for feature in self._declared:
            if feature.refuses_recordings:
                self._create(feature)

    def page_gone(self, page: Page) -> None:
        """Stop watching after the last page."""
        if self._listening and len(self.context.pages) == 0:
            self._stop()

    def close(self) -> None:
        """Create no more features."""
        self._stop()

    def _stop(self) -> None:
        self._listening = False
        self.context.graph_changes.ignore(self._review)

    def _review(self) -> None:
        """Create the features whose topics are published now."""
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
