"""The base class of transports.

A transport mirrors this process's graph in the background.
"""

from __future__ import annotations

import atexit
import os
import threading
import time
import weakref
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING, Any, Protocol, TypedDict, TypeVar

from linkwright.diagnostics import LinkwrightError, Phrase, render
from linkwright.graph.endpoints.base import EndpointInfo
from linkwright.graph.log.logger import Logger, run_logged
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.engine import Engine, Work
from linkwright.wire.remote_entities import RemoteEntities
from linkwright.wire.switch import is_switched_off

if TYPE_CHECKING:
    from linkwright.graph.endpoints.base import Presence
    from linkwright.graph.endpoints.publisher import Publisher
    from linkwright.graph.endpoints.service import Client, Service
    from linkwright.graph.endpoints.subscription import Subscription
    from linkwright.graph.node import Graph

_JOIN_TIMEOUT_S = 10.0
"""Seconds after which the joining thread is abandoned, because an import that Ctrl-C ended may keep its lock."""

_POLL_INTERVAL_S = 0.01
_CLOSE_CHECK_INTERVAL_S = 0.05
"""The interval, in seconds, at which a waiting thread checks whether the domain was left."""


class DepartureMonitor(Protocol):
    """Decides whether remote publishers that disappeared were lost."""

    def watch(self, lost: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost publishers."""


class BackgroundTransport(ABC):
    """The base class of transports, which connect the graph of this process to the network.

    Subclasses implement `graph.endpoints.bus.Transport`.

    Separate threads do the work, and never run a user's callback. No method blocks unless its docstring states that it
    does. In a forked process, the transport neither sends nor receives anything.

    Args:
        domain_id: the ROS domain.
        remote_entities: the tables of remote nodes and endpoints.
        departures: decides whether remote publishers that disappeared were lost.
        logger: logs problems.
        discovers_only: whether the transport only discovers remote nodes and endpoints. The nodes and endpoints of this
            graph are then not announced, which saves creating them on the network.
        must_join: whether the caller of `join` needs the network, and raises `problem` itself. The problem is then not
            logged.
    """

    def __init__(
        self,
        domain_id: int,
        remote_entities: RemoteEntities,
        departures: DepartureMonitor,
        logger: Logger,
        *,
        discovers_only: bool = False,
        must_join: bool = False,
    ) -> None:
        self.domain_id = domain_id
        self._remote_entities = remote_entities
        self._departure_monitor = departures
        self._discovers_only = discovers_only
        self._must_join = must_join
        self._logger = logger
        self._engine: Engine | None = None
        self._work: Work = deque()
        self._join_ended = threading.Event()
        self._given_up = threading.Event()
        self._closed = False
        self._join_lock = threading.Lock()
        self._has_left = False
        self._joined_at = 0.0
        self.problem: LinkwrightError | None = None
        """The reason why the domain could not be joined, or None if it was joined, or joining has not ended."""
        self._join_thread = threading.Thread(target=self._join, name="linkwright-join", daemon=True)
        _open_transports.add(self)
        self._join_thread.start()

    @abstractmethod
    def _make_engine(self) -> Engine:
        """Join the domain, and return the engine. Runs in a separate thread.

        Raises:
            LinkwrightError: the domain cannot be joined.
        """

    @abstractmethod
    def _has_settled(self, quiet_s: float) -> bool:
        """Return whether discovery counts as complete.

        Args:
            quiet_s: the seconds since the last change to the remote graph, or since joining if that is later.
        """

    @property
    def waits_for_others(self) -> bool:
        """Whether joining waits for other processes, because the settings require them."""
        return False

    # --- called by the code that joined ------------------------------------------------------------------------------

    def wait_until_ready(self, timeout: float | None = None) -> bool:
        """Block until the domain is joined and every endpoint requested so far is created.

        Args:
            timeout: the longest wait, in seconds; None for no limit.

        Returns:
            Whether the transport is ready. If the domain cannot be joined or was left, False is returned immediately.
        """
        deadline = None if timeout is None else time.monotonic() + timeout
        while not self._join_ended.wait(_CLOSE_CHECK_INTERVAL_S) and not self._closed:
            if deadline is not None and time.monotonic() >= deadline:
                return False
        if self._engine is None:
            return False
        ready = threading.Event()
        self._queue(lambda _: ready.set())
        while not self._closed and (deadline is None or time.monotonic() < deadline):
            if ready.wait(
                _CLOSE_CHECK_INTERVAL_S
                if deadline is None
                else min(_CLOSE_CHECK_INTERVAL_S, deadline - time.monotonic())
            ):
                break
        return ready.is_set()

    def wait_for_discovery(self, timeout: float = 5.0) -> bool:
        """Block until discovery has settled.

        Discovery has settled when every process has announced itself and nothing has changed for a while.

        Args:
            timeout: the longest wait, in seconds.

        Returns:
            Whether discovery has settled.
        """
        deadline = time.monotonic() + timeout
        if not self.wait_until_ready(timeout):
            return False
        self.start_discovery()
        while time.monotonic() < deadline and not self._closed:
            if self._has_settled(time.monotonic() - max(self._remote_entities.changed_at, self._joined_at)):
                return True
            time.sleep(_POLL_INTERVAL_S)
        return False

    # --- called by the graph -----------------------------------------------------------------------------------------

    def open_node(self, node: NodeIdentity) -> None:
        """Announce a node."""
        self._queue_mirroring(lambda engine: engine.add_node(node))

    def close_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""
        self._queue_mirroring(lambda engine: engine.remove_node(node))

    def open_publisher(self, publisher: Publisher[Any]) -> None:
        """Mirror a publisher."""
        if self._engine is not None and not self._discovers_only:
            publisher.hold_for_remote(self.wait_until_ready)
        self._queue_mirroring(lambda engine: engine.open_publisher(publisher))

    def close_publisher(self, publisher: Publisher[Any]) -> None:
        """Stop mirroring a publisher once its reliable messages are acknowledged.

        If no reader is left to acknowledge the messages, mirroring also stops.
        """
        self._queue_mirroring(lambda engine: engine.close_publisher(publisher))

    def open_subscription(self, subscription: Subscription[Any]) -> None:
        """Mirror a subscription."""
        self._queue_mirroring(lambda engine: engine.open_subscription(subscription))

    def close_subscription(self, subscription: Subscription[Any]) -> None:
        """Stop mirroring a subscription."""
        self._queue_mirroring(lambda engine: engine.close_endpoint(subscription))

    def open_service(self, service: Service[Any, Any]) -> None:
        """Mirror a service."""
        self._queue_mirroring(lambda engine: engine.open_service(service))

    def close_service(self, service: Service[Any, Any]) -> None:
        """Stop mirroring a service."""
        self._queue_mirroring(lambda engine: engine.close_endpoint(service))

    def open_client(self, client: Client[Any, Any]) -> None:
        """Mirror a client."""
        self._queue_mirroring(lambda engine: engine.open_client(client))

    def close_client(self, client: Client[Any, Any]) -> None:
        """Stop mirroring a client."""
        self._queue_mirroring(lambda engine: engine.close_endpoint(client))

    def open_presence(self, presence: Presence) -> None:
        """Announce an endpoint that neither sends nor receives."""
        self._queue_mirroring(lambda engine: engine.open_presence(presence))

    def close_presence(self, presence: Presence) -> None:
        """Withdraw an endpoint that neither sends nor receives."""
        self._queue_mirroring(lambda engine: engine.close_endpoint(presence))

    def start_discovery(self) -> None:  # noqa: B027 - not needed if discovery runs continuously
        """Start discovery for the next query, unless discovery runs continuously."""

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        """Return the nodes of other processes that have been discovered so far."""
        return self._remote_entities.nodes()

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """Return the endpoints of other processes that have been discovered so far."""
        return self._remote_entities.endpoints()

    def watch(self, callback: Callable[[], None]) -> None:
        """Register a callback for changes to remote nodes and endpoints.

        The callback may be called from any thread.
        """
        self._remote_entities.watch(
            partial(run_logged, self._logger, "a callback for changes to remote nodes", callback)
        )

    def watch_lost(self, callback: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost remote publishers.

        The callback may be called from any thread.
        """

        def notify(publisher: EndpointInfo) -> None:
            run_logged(self._logger, "a callback for lost publishers", partial(callback, publisher))

        self._departure_monitor.watch(notify)
        self._queue(lambda _: None)  # wakes the engine, which monitors processes from now on

    def close(self) -> None:
        """Leave the domain, after reliable messages were acknowledged or a second has passed.

        If the domain is still being joined, this method first waits until joining ends, for at most 10 s.
        """
        if self._closed:
            return
        self._closed = True
        self._given_up.set()
        _open_transports.discard(self)
        if self._join_thread.ident is not None:  # Ctrl-C may have interrupted `__init__` before the thread was started
            self._end_joining()
        with self._join_lock:
            self._has_left = True
            engine, self._engine = self._engine, None
        if engine is not None:
            engine.close()
        self._work.clear()

    # --- inside ------------------------------------------------------------------------------------------------------

    def _end_joining(self) -> None:
        deadline = time.monotonic() + _JOIN_TIMEOUT_S
        while self._join_thread.is_alive() and time.monotonic() < deadline:
            self._join_thread.join(_CLOSE_CHECK_INTERVAL_S)
            if self.waits_for_others:  # The thread may be in a call that cannot be interrupted.
                break

    def abandon(self) -> None:
        """Stop using the network in a forked process."""
        self._closed = True
        if self._engine is not None:
            self._engine.abandon()
            self._engine = None

    def _queue_mirroring(self, work: Callable[[Engine], None]) -> None:
        """Queue work on an endpoint or node of this process, unless the transport only discovers."""
        if not self._discovers_only:
            self._queue(work)

    def _queue(self, work: Callable[[Engine], None]) -> None:
        """Queue a call for the engine's thread, which makes the call once the domain is joined."""
        if self._closed or self.problem is not None:
            return
        self._work.append(work)
        engine = self._engine
        if engine is not None:
            engine.wake()

    def _join(self) -> None:
        try:
            engine = self._make_engine()
            with self._join_lock:
                if not self._has_left:
                    self._engine = engine
                    self._joined_at = time.monotonic()
                    engine.start()
                    engine.wake()
            if self._has_left:  # `close` does not wait for this thread
                engine.close()
        except LinkwrightError as error:
            self.problem = error
            self._work.clear()
            if not self._must_join and not self._closed:
                log_join_failure(self._logger, error)
        except RuntimeError:
            # From Python 3.12 on, no thread can be started once the main thread has ended.
            if threading.main_thread().is_alive():
                raise
        finally:
            self._join_ended.set()


_open_transports: weakref.WeakSet[BackgroundTransport] = weakref.WeakSet()


def _close_all() -> None:
    for transport in tuple(_open_transports):
        transport.close()


def _abandon_all() -> None:
    for transport in tuple(_open_transports):
        transport.abandon()
    _open_transports.clear()


atexit.register(_close_all)
if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_abandon_all)


def log_join_failure(logger: Logger, error: LinkwrightError) -> None:
    """Log why the domain could not be joined, and that the process runs without the network."""
    findings = "\n".join(render(diagnostic) for diagnostic in error.diagnostics)
    logger.error(f"{findings}\nThis process continues without the network: other processes cannot discover its nodes.")


def log_no_transport(logger: Logger, reason: Phrase) -> None:
    """Log a warning that the process has no transport, with the reason."""
    logger.warning(f"This process does not communicate with other processes: {reason}. Communication inside it works.")


AnyTransport = TypeVar("AnyTransport", bound=BackgroundTransport)


class TransportOptions(TypedDict, total=False):
    """The options with which a transport is created."""

    discovers_only: bool
    """Whether the graph discovers other processes without announcing itself to them."""

    must_join: bool
    """Whether the caller raises the transport's `problem`. The problem is then not logged."""


class JoinOptions(TransportOptions, total=False):
    """The options with which a graph joins the network."""

    domain_id: int | None
    """The ROS domain, or None for the domain in ROS_DOMAIN_ID."""

    environment: Mapping[str, str] | None
    """The environment variables, by default the variables of this process."""


def join_with(
    graph: Graph,
    name: str,
    read_settings: Callable[..., Any],
    make_transport: Callable[..., AnyTransport],
    unavailable_reason: Callable[[Mapping[str, str] | None], Phrase],
    options: JoinOptions,
) -> AnyTransport | None:
    """Attach a transport to a graph and return it, or None if no transport is available.

    Args:
        graph: the graph.
        name: the name of the logger that reports why there is no transport.
        read_settings: reads the settings from an environment and a domain; may raise LinkwrightError.
        make_transport: creates the transport from the settings; may raise LinkwrightError.
        unavailable_reason: returns the reason why an environment has no transport; empty if it has one.
        options: how the graph is joined.
    """
    logger = graph.get_logger(name)
    environment = options.get("environment")
    reason = unavailable_reason(environment)
    if reason:
        if not is_switched_off(environment):
            log_no_transport(logger, reason)
        return None
    try:
        settings = read_settings(environment, domain_id=options.get("domain_id"))
        discovers_only, must_join = options.get("discovers_only", False), options.get("must_join", False)
        transport = make_transport(settings, logger, discovers_only=discovers_only, must_join=must_join)
    except LinkwrightError as error:
        log_join_failure(logger, error)
        return None
    graph.attach(transport)
    return transport
