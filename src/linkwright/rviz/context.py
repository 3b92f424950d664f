"""The objects that displays share: node, files, pages, graph changes, and published topics."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from linkwright.descriptions import DescriptionLibrary
from linkwright.diagnostics import Diagnostic, Severity
from linkwright.graph import Node
from linkwright.graph.introspection.graph_queries import UNKNOWN_NODE, GraphQueries
from linkwright.graph.time.clock import ROSClock
from linkwright.packages import PackageFinder
from linkwright.page.audience import PageGroup
from linkwright.page.files import Downloads, MeshFolders
from linkwright.rviz.frames.history import FrameHistory


class PublishedTopics:
    """The topics that the nodes of a graph publish, without the viewer's own.

    The lookup is cached, because each display without messages looks for publishers every second, and a configuration
    can have hundreds of displays.

    Args:
        node: the viewer's node.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._is_up_to_date = False
        self._is_watching = False
        self._publishers: dict[str, list[tuple[str, str]]] = {}
        self._topics: dict[str, list[str]] = {}

    def publishers(self, topic: str) -> list[tuple[str, str]]:
        """Return the node name and the message type of each publisher of a topic.

        The topic's name is resolved in the viewer's node.

        Raises:
            InvalidTopicNameError: the topic's name is not valid.
        """
        name = self._node.resolve_topic_name(topic)
        self._update_if_needed()
        return self._publishers.get(name, [])

    def topics_of_type(self, message_type: str) -> list[str]:
        """Return the names of the topics that are published with a message type, sorted."""
        self._update_if_needed()
        return self._topics.get(message_type, [])

    def close(self) -> None:
        """Stop watching the graph."""
        if self._is_watching:
            self._node.graph.unwatch(self._on_graph_change)
            self._is_watching = False

    def _on_graph_change(self) -> None:
        self._is_up_to_date = False

    def _update_if_needed(self) -> None:
        if not self._is_watching:
            self._is_watching = True
            self._node.graph.watch(self._on_graph_change)
        if self._is_up_to_date:
            return
        self._is_up_to_date = True  # set first, so that a change during the lookup triggers another lookup
        publishers: dict[str, list[tuple[str, str]]] = {}
        topics: dict[str, set[str]] = {}
        own_name = self._node.get_name()
        for publisher in self._node.graph.publishers():
            node_name = (publisher.node or UNKNOWN_NODE).name
            if node_name != own_name:
                publishers.setdefault(publisher.name, []).append((node_name, publisher.type_name))
                topics.setdefault(publisher.type_name, set()).add(publisher.name)
        self._publishers = publishers
        self._topics = {message: sorted(names) for message, names in topics.items()}


_COLLECTION_PERIOD_S = 0.1
"""Seconds for which changes are collected before callbacks are called. A starting node creates dozens of endpoints."""


class GraphChanges:
    """The callbacks for changes of the graph.

    The graph is watched only while there are callbacks.

    Args:
        graph: the graph to watch; it may report changes from any thread.
    """

    def __init__(self, graph: GraphQueries) -> None:
        self._graph = graph
        self._listeners: dict[Callable[[], None], None] = {}
        self._loop = asyncio.get_running_loop()
        self._notify_timer: asyncio.TimerHandle | None = None

    def watch(self, callback: Callable[[], None]) -> None:
        """Register a callback for graph changes, to be called on the event loop."""
        if not self._listeners:
            self._graph.watch(self._on_graph_change)
        self._listeners[callback] = None

    def unwatch(self, callback: Callable[[], None]) -> None:
        """Unregister a callback that was passed to `watch`."""
        self._listeners.pop(callback, None)
        if not self._listeners:
            self._graph.unwatch(self._on_graph_change)
            if self._notify_timer is not None:
                self._notify_timer.cancel()
                self._notify_timer = None

    def _on_graph_change(self) -> None:
        with suppress(RuntimeError):  # the loop is closed, so that no callback can be called
            self._loop.call_soon_threadsafe(self._wait)

    def _wait(self) -> None:
        if self._notify_timer is None and self._listeners:
            self._notify_timer = self._loop.call_later(_COLLECTION_PERIOD_S, self._notify)

    def _notify(self) -> None:
        self._notify_timer = None
        for callback in tuple(self._listeners):
            if callback in self._listeners:
                callback()


class HeldTime:
    """A switch that stops the viewer's clock at a past time while the history is shown.

    Attributes:
        switching: whether the clock is being held or released right now; displays must not reset then.
    """

    def __init__(self) -> None:
        self._is_held = False
        self.switching = False

    def show(self, clock: ROSClock, now_ns: int) -> bool:
        """Hold a clock at a time in ns since the epoch.

        Return False, without holding the clock, if the clock follows simulated time.
        """
        if clock.ros_time_is_active and not self._is_held:
            return False
        clock.set_simulated_time(now_ns)
        self._is_held = True
        self._switch(clock, held=True)
        return True

    def release(self, clock: ROSClock) -> None:
        """Make the clock return the current time again, if it was held."""
        if self._is_held:
            self._is_held = False
            self._switch(clock, held=False)

    def _switch(self, clock: ROSClock, *, held: bool) -> None:
        self.switching = True
        try:
            clock.set_ros_time_is_active(held)
        finally:
            self.switching = False


@dataclass(frozen=True, slots=True)
class ViewerContext:
    """The node, the files and the pages of a viewer, shared by its displays.

    Attributes:
        node: the viewer's node, for subscriptions and logging.
        library: reads descriptions, each of them once per process.
        finder: finds packages and the files in them.
        pages: the group of all open pages.
        transforms: the history of transforms, from which poses at the time of a message are computed.
        graph_changes: notifies callbacks when nodes or endpoints appear or disappear.
        published: the topics that other nodes publish.
        meshes: the folders that pages may read from.
        downloads: files created for a page, each of which can be fetched once.
        held_time: holds the viewer's clock while an earlier time is shown.
        display_ids: an iterator of IDs that no display of the viewer has used.
        folder: the working directory of the program, for files that pages create.
    """

    node: Node
    library: DescriptionLibrary
    finder: PackageFinder
    pages: PageGroup
    transforms: FrameHistory
    graph_changes: GraphChanges
    published: PublishedTopics
    meshes: MeshFolders = field(default_factory=MeshFolders)
    downloads: Downloads = field(default_factory=Downloads)
    held_time: HeldTime = field(default_factory=HeldTime)
    display_ids: Iterator[str] = field(default_factory=lambda: map("display-{}".format, itertools.count(1)))
    folder: Path = field(default_factory=Path.cwd)

    def report(self, diagnostic: Diagnostic) -> None:
        """Log a finding in the terminal, as an error or a warning."""
        location = f"{diagnostic.span}: " if diagnostic.span else ""
        logger = self.node.get_logger()
        if diagnostic.severity is Severity.ERROR:  # two calls, because a logger identifies calls by line
            logger.error(location + diagnostic.message)
        else:
            logger.warning(location + diagnostic.message)
