"""The state that the nodes of a process share: the bus, the transport, time and logging."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter
from collections.abc import Callable

from linkwright.graph.endpoints.base import Endpoint, EndpointInfo, Presence
from linkwright.graph.endpoints.bus import Bus, Transport
from linkwright.graph.endpoints.publisher import Publisher
from linkwright.graph.endpoints.service import Client, Service
from linkwright.graph.endpoints.subscription import Subscription
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.introspection.graph_queries import GraphQueries, OnSharedNames, SharedNameMonitor
from linkwright.graph.log.console import print_to_console
from linkwright.graph.log.logger import Logger, LogLevels, LogSink
from linkwright.graph.loop.dispatcher import LoopDispatcher
from linkwright.graph.loop.future import Future
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity, Remappings
from linkwright.graph.time.clock import SystemClock, Timebase


class LocalGraph(GraphQueries):
    """The graph without the methods that create nodes.

    The subclass `Graph` adds these methods. All methods may be called from any thread except `settle` and `close`,
    which must be called in the loop's thread.

    Args:
        clock: stamps messages and wakes timers; the system's clock by default.
        on_log: receives log records; by default they are written to standard error in ROS 2's console format.
        threads: whether other threads run the callbacks, instead of the running event loop.
        levels: the levels of the graph's loggers; new ones by default.
        on_shared_names: receives the names that nodes of this process share with nodes of other processes; by default a
            warning is logged.

    Attributes:
        creators: the logger name of the node that created another node, such as the node of a controller, by the
            logger name of the created node.
    """

    def __init__(
        self,
        *,
        clock: Timebase | None = None,
        on_log: LogSink | None = None,
        threads: bool = False,
        levels: LogLevels | None = None,
        on_shared_names: OnSharedNames | None = None,
    ) -> None:
        self.timebase: Timebase = clock or SystemClock()
        self.bus = Bus()
        self.creators: dict[str, str] = {}
        self.levels = levels or LogLevels()
        self._sink = on_log or print_to_console
        self._logger = self.get_logger("graph")
        self._nodes: dict[NodeHandle, None] = {}
        self._taken_names: Counter[str] = Counter()
        self._transport: Transport | None = None
        self._lock = threading.RLock()
        self._changed = threading.Condition()
        self._watchers: dict[Callable[[], object], None] = {}
        self._shared_name_monitor = SharedNameMonitor(on_shared_names)
        self._closed = False
        self._watches_lost = False
        loop = None if threads else asyncio._get_running_loop()
        self._dispatcher = None if loop is None else LoopDispatcher(self.timebase, loop)

    @property
    def clock(self) -> Timebase:
        """The source of the graph's time."""
        return self.timebase

    @property
    def dispatcher(self) -> LoopDispatcher | None:
        """The default dispatcher of callbacks, or None if there is no event loop."""
        return self._dispatcher

    @property
    def transport(self) -> Transport | None:
        """The transport to other processes, or None if there is none."""
        return self._transport

    @property
    def closed(self) -> bool:
        """Whether the graph is closed."""
        return self._closed

    def open_node(
        self,
        identity: NodeIdentity,
        remappings: Remappings,
        *,
        copies_messages: bool = False,
        stays_inside: bool = False,
    ) -> NodeHandle:
        """Add a node to the graph.

        Log a warning if another node of this process has the same name.

        Args:
            identity: the node's name.
            remappings: the node's remapping rules for topics and services.
            copies_messages: whether messages are copied, so that the node may change a message after publishing it.
            stays_inside: whether the node and its endpoints are hidden from other processes.

        Raises:
            InvalidHandleError: the graph is closed.
        """
        full_name = identity.full_name
        logger = self.get_logger(full_name[1:].replace("/", "."))
        with self._lock:
            if self._closed:
                raise InvalidHandleError("the graph is closed")
            if full_name in self._taken_names:
                logger.warning(
                    f"There are nodes in the graph that share the exact name '{full_name}': "
                    "this can have unintended side effects"
                )
            node = NodeHandle(
                self,
                identity,
                remappings=remappings,
                logger=logger,
                dispatcher=self._dispatcher,
                copies_messages=copies_messages,
                stays_inside=stays_inside,
            )
            self._nodes[node] = None
            self._taken_names[full_name] += 1
            if self._transport is not None and not stays_inside:
                self._transport.open_node(identity)
        self._on_remote_change()
        return node

    def get_logger(self, name: str) -> Logger:
        """Return a new logger with an arbitrary name, for code outside a node."""
        return Logger(name, self._sink, self.timebase.now_ns, self.levels, self.timebase.steady_ns)

    def nodes(self) -> tuple[NodeHandle, ...]:
        """Return the nodes of this process, in order of creation."""
        return tuple(self._nodes)

    # --- the transport -----------------------------------------------------------------------------------------------

    def attach(self, transport: Transport) -> None:
        """Attach a transport, which mirrors the graph's endpoints outside the process.

        Both existing and later endpoints are mirrored.

        Raises:
            RuntimeError: the graph already has a transport, or is closed.
        """
        with self._lock:
            if self._transport is not None or self._closed:
                raise RuntimeError("the graph has a transport already, or is closed")
            self._transport = transport
            for node in self._nodes:
                if not node.stays_inside:
                    transport.open_node(node.identity)
            for endpoint in self.bus.endpoints():
                if not endpoint.node.stays_inside:
                    _open_endpoint(transport, endpoint)
            if self._watches_lost:
                transport.watch_lost(self._on_lost_publisher)
        transport.watch(self._on_remote_change)
        self._on_remote_change()

    def detach(self) -> None:
        """Close the transport, if there is one.

        Endpoints inside the process stay connected.
        """
        with self._lock:
            transport, self._transport = self._transport, None
        if transport is not None:
            transport.close()
            self.notify_change()

    # --- called by nodes ---------------------------------------------------------------------------------------------

    def add(self, endpoint: Endpoint) -> None:
        """Connect a new endpoint to the endpoints with the same name, in this process and others."""
        with self._lock:
            self.bus.add(endpoint)
            if self._transport is not None and not endpoint.node.stays_inside:
                _open_endpoint(self._transport, endpoint)
        self.notify_change()

    def remove(self, endpoint: Endpoint) -> None:
        """Remove an endpoint, in this process and others."""
        with self._lock:
            self.bus.remove(endpoint)
            if self._transport is not None and not endpoint.node.stays_inside:
                _close_endpoint(self._transport, endpoint)
        self.notify_change()

    def watch_lost(self) -> None:
        """Start notifying subscriptions of lost publishers (see `Subscription.watch_lost`)."""
        with self._lock:
            if not self._watches_lost:
                self._watches_lost = True
                if self._transport is not None:
                    self._transport.watch_lost(self._on_lost_publisher)

    def forget(self, node: NodeHandle) -> None:
        """Remove a node that was destroyed."""
        with self._lock:
            if node not in self._nodes:
                return
            del self._nodes[node]
            self._taken_names -= Counter([node.identity.full_name])
            if self._transport is not None and not node.stays_inside:
                self._transport.close_node(node.identity)
        if self._dispatcher is not None:
            self._dispatcher.forget(node)
        self.notify_change()

    # --- shutdown ----------------------------------------------------------------------------------------------------

    async def settle(self) -> None:
        """Wait until all messages are delivered, including messages that callbacks publish."""
        if self._dispatcher is not None:
            await self._dispatcher.settle()

    async def close(self) -> None:
        """Destroy every node, drop undelivered messages, and close the transport.

        After this, no code of the graph runs.
        """
        transport = self._end()
        if transport is not None:
            transport_closed: Future[None] = Future()
            thread = threading.Thread(
                target=_close_transport, args=(transport, transport_closed), name="linkwright-graph-close"
            )
            thread.start()
            await transport_closed
            thread.join()
        if self._dispatcher is not None:
            await self._dispatcher.join()

    def close_threadsafe(self) -> None:
        """Destroy every node, from any thread except the thread of an event loop. See `close`."""
        transport = self._end()
        if transport is not None:
            transport.close()

    def _on_remote_change(self) -> None:
        transport = self._transport
        if transport is not None:
            self._shared_name_monitor.update(self.nodes(), transport.remote_nodes())
        self.notify_change()

    def _on_lost_publisher(self, publisher: EndpointInfo) -> None:
        for subscription in self.bus.subscriptions(publisher.name):
            subscription.queue_lost_publisher(publisher)

    def _end(self) -> Transport | None:
        for node in tuple(self._nodes):
            node.destroy()
        with self._lock:
            self._closed = True
            transport, self._transport = self._transport, None
        if self._dispatcher is not None:
            self._dispatcher.close()
        self.notify_change()
        return transport


def _close_transport(transport: Transport, transport_closed: Future[None]) -> None:
    try:
        transport.close()
    finally:
        transport_closed.set_result(None)


def _open_endpoint(transport: Transport, endpoint: Endpoint) -> None:
    if isinstance(endpoint, Publisher):
        transport.open_publisher(endpoint)
    elif isinstance(endpoint, Subscription):
        transport.open_subscription(endpoint)
    elif isinstance(endpoint, Service):
        transport.open_service(endpoint)
    elif isinstance(endpoint, Client):
        transport.open_client(endpoint)
    elif isinstance(endpoint, Presence):
        transport.open_presence(endpoint)


def _close_endpoint(transport: Transport, endpoint: Endpoint) -> None:
    if isinstance(endpoint, Publisher):
        transport.close_publisher(endpoint)
    elif isinstance(endpoint, Subscription):
        transport.close_subscription(endpoint)
    elif isinstance(endpoint, Service):
        transport.close_service(endpoint)
    elif isinstance(endpoint, Client):
        transport.close_client(endpoint)
    elif isinstance(endpoint, Presence):
        transport.close_presence(endpoint)
