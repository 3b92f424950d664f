"""The computation graph of this process: its nodes, the bus between them, and what they share."""

from __future__ import annotations

import asyncio
import threading
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from linkwright.graph.bus import Bus
from linkwright.graph.client import Client
from linkwright.graph.endpoint import Endpoint
from linkwright.graph.executor import LoopDispatcher
from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.future import Future
from linkwright.graph.graph_queries import GraphQueries
from linkwright.graph.log.levels import LogLevels
from linkwright.graph.log.logger import Logger, LogSink, print_to_console
from linkwright.graph.names import absolute_namespace, check_node_name, join
from linkwright.graph.namesakes import Namesakes
from linkwright.graph.node import Node
from linkwright.graph.parameters.parameter import Parameter
from linkwright.graph.publisher import Publisher
from linkwright.graph.qos import ROSOUT_QOS, QoSProfile
from linkwright.graph.remapping import Remappings
from linkwright.graph.service import Service
from linkwright.graph.subscription import Subscription
from linkwright.graph.timebase import SystemClock, Timebase
from linkwright.graph.transport import NodeIdentity, Transport


class Graph(GraphQueries):
    """A ROS-like computation graph.

    Made inside a running event loop, it has that loop run the callbacks of its nodes. Made elsewhere, or with
    `threads`, its nodes have no dispatcher of their own; the executors of `linkwright.graph.executors` are ones. All
    methods may be called from any thread but for `settle` and `close`, which are the loop's.

    Args:
        clock: what stamps messages and wakes timers; the system's when left out.
        on_log: what takes log records; standard error in ROS 2's console format when left out.
        threads: whether callbacks are not for the running event loop.
        levels: the levels of the graph's loggers; new ones when left out.
    """

    def __init__(
        self,
        *,
        clock: Timebase | None = None,
        on_log: LogSink | None = None,
        threads: bool = False,
        levels: LogLevels | None = None,
    ) -> None:
        self.timebase: Timebase = clock or SystemClock()
        self.bus = Bus()
        self.levels = levels or LogLevels()
        self._sink = on_log or print_to_console
        self._nodes: dict[Node, None] = {}
        self._taken_names: Counter[str] = Counter()
        self._transport: Transport | None = None
        self._lock = threading.RLock()
        self._changed = threading.Condition()
        self._watchers: dict[Callable[[], object], None] = {}
        self._namesakes = Namesakes()
        self._closed = False
        loop = None if threads else asyncio._get_running_loop()
        self._dispatcher = None if loop is None else LoopDispatcher(self.timebase, loop)

    @property
    def clock(self) -> Timebase:
        """What the graph's time is made of."""
        return self.timebase

    @property
    def dispatcher(self) -> LoopDispatcher | None:
        """What runs the callbacks of nodes that get no other; None without an event loop."""
        return self._dispatcher

    @property
    def transport(self) -> Transport | None:
        """What carries the graph's traffic out of the process; None where nothing does."""
        return self._transport

    @property
    def closed(self) -> bool:
        """Whether the graph has ended."""
        return self._closed

    def create_node(
        self,
        name: str,
        *,
        namespace: str = "/",
        parameters: Mapping[str, Any] | Sequence[Parameter] | None = None,
        remappings: Sequence[tuple[str, str]] = (),
        enclave: str = "/",
        start_parameter_services: bool = True,
        enable_rosout: bool = True,
        rosout_qos_profile: QoSProfile = ROSOUT_QOS,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
    ) -> Node:
        """Make a node.

        Args:
            name: the name its code gives it.
            namespace: where it lives; a missing leading slash is added.
            parameters: values that take the place of declared defaults; nested mappings stand for dotted names.
            remappings: rules ``(from, to)`` for topics, services, ``__node`` and ``__ns``; see `Remappings`.
            enclave: its security enclave.
            start_parameter_services: whether others can ask for its parameters.
            enable_rosout: whether what it logs goes to ``/rosout`` too.
            rosout_qos_profile: the quality of service of that.
            allow_undeclared_parameters: whether parameters can be set that were not declared.
            automatically_declare_parameters_from_overrides: whether `parameters` are declared at once.

        Raises:
            InvalidNodeNameError: the name is not valid.
            InvalidNamespaceError: the namespace is not valid.
            InvalidHandleError: the graph is closed.
        """
        if self._closed:
            raise InvalidHandleError("the graph is closed")
        rules = Remappings(remappings)
        original = name
        name = rules.node_name(original)
        check_node_name(name)
        namespace = absolute_namespace(rules.namespace(namespace, original))
        full_name = join(namespace, name)
        logger = self.get_logger(full_name[1:].replace("/", "."))
        identity = NodeIdentity(name, namespace, enclave)
        with self._lock:
            if full_name in self._taken_names:
                logger.warning(
                    f"There are nodes in the graph that share the exact name '{full_name}': "
                    "this can have unintended side effects"
                )
            node = Node(self, identity, logger=logger, remappings=rules, dispatcher=self._dispatcher)
            self._nodes[node] = None
            self._taken_names[full_name] += 1
            if self._transport is not None:
                self._transport.open_node(identity)
            try:
                node.begin(
                    parameters or {},
                    services=start_parameter_services,
                    rosout=rosout_qos_profile if enable_rosout else None,
                    allow_undeclared=allow_undeclared_parameters,
                    declare_overrides=automatically_declare_parameters_from_overrides,
                )
            except BaseException:
                node.destroy_node()
                raise
        self._outside_changed()
        return node

    def get_logger(self, name: str) -> Logger:
        """A new logger of any name, for what speaks outside of a node."""
        return Logger(name, self._sink, self.timebase.now_ns, self.levels, self.timebase.steady_ns)

    def nodes(self) -> tuple[Node, ...]:
        """The nodes of this process, in order of creation."""
        return tuple(self._nodes)

    # --- the transport -----------------------------------------------------------------------------------------------

    def attach(self, transport: Transport) -> None:
        """Have a transport mirror the graph outside of the process: what there is now, and what comes.

        Raises:
            RuntimeError: the graph has one already, or is closed.
        """
        with self._lock:
            if self._transport is not None or self._closed:
                raise RuntimeError("the graph has a transport already, or is closed")
            self._transport = transport
            for node in self._nodes:
                transport.open_node(node.identity)
            for endpoint in self.bus.endpoints():
                _open(transport, endpoint)
        transport.watch(self._outside_changed)
        self._outside_changed()

    def detach(self) -> None:
        """Close the transport, if there is one; the graph goes on inside the process."""
        with self._lock:
            transport, self._transport = self._transport, None
        if transport is not None:
            transport.close()
            self.notify_change()

    # --- for nodes ---------------------------------------------------------------------------------------------------

    def add(self, endpoint: Endpoint) -> None:
        """Bring a new endpoint together with those of its name, here and outside."""
        with self._lock:
            self.bus.add(endpoint)
            if self._transport is not None:
                _open(self._transport, endpoint)
        self.notify_change()

    def remove(self, endpoint: Endpoint) -> None:
        """Take an endpoint away."""
        with self._lock:
            self.bus.remove(endpoint)
            if self._transport is not None:
                _close(self._transport, endpoint)
        self.notify_change()

    def forget(self, node: Node) -> None:
        """Take a node away that is destroyed."""
        with self._lock:
            if node not in self._nodes:
                return
            del self._nodes[node]
            self._taken_names -= Counter([node.get_fully_qualified_name()])
            if self._transport is not None:
                self._transport.close_node(node.identity)
        if self._dispatcher is not None:
            self._dispatcher.forget(node)
        self.notify_change()

    # --- the end -----------------------------------------------------------------------------------------------------

    async def settle(self) -> None:
        """Wait until every message published so far is delivered, and those that callbacks published, and so on."""
        if self._dispatcher is not None:
            await self._dispatcher.settle()

    async def close(self) -> None:
        """Destroy every node and forget what was not delivered yet. Nothing of the graph runs after this."""
        transport = self._end()
        if transport is not None:
            left: Future[None] = Future()
            thread = threading.Thread(target=_close_transport, args=(transport, left), name="linkwright-graph-close")
            thread.start()
            await left
            thread.join()
        if self._dispatcher is not None:
            await self._dispatcher.join()

    def close_now(self) -> None:
        """Destroy every node, from any thread but that of an event loop; see `close`."""
        transport = self._end()
        if transport is not None:
            transport.close()

    def _outside_changed(self) -> None:
        transport = self._transport
        if transport is not None:
            self._namesakes.review(self.nodes(), transport.remote_nodes())
        self.notify_change()

    def _end(self) -> Transport | None:
        for node in tuple(self._nodes):
            node.destroy_node()
        with self._lock:
            self._closed = True
            transport, self._transport = self._transport, None
        if self._dispatcher is not None:
            self._dispatcher.close()
        self.notify_change()
        return transport


def _close_transport(transport: Transport, left: Future[None]) -> None:
    try:
        transport.close()
    finally:
        left.set_result(None)


def _open(transport: Transport, endpoint: Endpoint) -> None:
    if isinstance(endpoint, Publisher):
        transport.open_publisher(endpoint)
    elif isinstance(endpoint, Subscription):
        transport.open_subscription(endpoint)
    elif isinstance(endpoint, Service):
        transport.open_service(endpoint)
    elif isinstance(endpoint, Client):
        transport.open_client(endpoint)


def _close(transport: Transport, endpoint: Endpoint) -> None:
    if isinstance(endpoint, Publisher):
        transport.close_publisher(endpoint)
    elif isinstance(endpoint, Subscription):
        transport.close_subscription(endpoint)
    elif isinstance(endpoint, Service):
        transport.close_service(endpoint)
    elif isinstance(endpoint, Client):
        transport.close_client(endpoint)
