"""The DDS transport: mirrors the graph of this process in a DDS domain."""

from __future__ import annotations

import atexit
import os
import threading
import time
import weakref
from collections import deque
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from linkwright.diagnostics import LinkwrightError, render
from linkwright.graph.endpoints.info import EndpointInfo
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.identity import NodeIdentity
from linkwright.wire.dds.departures import Departures
from linkwright.wire.dds.local_sockets import other_processes
from linkwright.wire.dds.remote import RemoteGraph
from linkwright.wire.dds.settings import Range, Settings

if TYPE_CHECKING:
    from linkwright.graph.endpoints.client import Client
    from linkwright.graph.endpoints.publisher import Publisher
    from linkwright.graph.endpoints.service import Service
    from linkwright.graph.endpoints.subscription import Subscription
    from linkwright.wire.dds.engine import Engine

SETTLED_AFTER = 0.3
"""Seconds without news after which discovery counts as complete."""

_SETTLED_AMONG_KNOWN = 0.05
"""The same where all processes are known: one may have further participants, or be making endpoints just now."""

_JOINED_WITHIN = 10.0
"""Seconds after which the thread that joins is given up: an import that Ctrl-C ended may keep its lock for ever."""

_LOOK_AGAIN = 0.01
_CLOSED_WITHIN = 0.05
"""Seconds after which who waits sees that the domain was left."""


class DdsTransport:
    """The graph of this process on the wire (`linkwright.graph.endpoints.transport.Transport`).

    Threads of its own do the work, so that nothing here blocks but what says so; none of them runs a user's callback. A
    process that is forked off has no part in it: there, nothing goes out and nothing comes in.

    Args:
        settings: the domain and how to join it.
        logger: for what there is to tell.
        only_looks: whether it only finds out what there is outside: nobody outside hears of the graph's nodes and
            endpoints, which saves making them there.
    """

    def __init__(self, settings: Settings, logger: Logger, *, only_looks: bool = False) -> None:
        self._settings = settings
        self._only_looks = only_looks
        self._logger = logger
        self._remote = RemoteGraph()
        self._departures = Departures(self._remote)
        self._engine: Engine | None = None
        self._work: deque[Callable[[Engine], None]] = deque()
        self._decided = threading.Event()
        self._closed = False
        self._joining = threading.Lock()
        self._has_left = False
        self._joined_at = 0.0
        self.problem: LinkwrightError | None = None
        """Why the domain could not be joined; None when it could, or was not tried yet."""
        self._starter = threading.Thread(target=self._join, name="linkwright-dds-join", daemon=True)
        _open_transports.add(self)
        self._starter.start()

    # --- for whoever joined ------------------------------------------------------------------------------------------

    @property
    def domain_id(self) -> int:
        """The DDS domain."""
        return self._settings.domain_id

    def wait_until_ready(self, timeout: float | None = None) -> bool:
        """Block until the domain is joined and all that was asked for so far is made.

        Args:
            timeout: seconds at most; None for any time.

        Returns:
            Whether it is so; False at once when the domain cannot be joined, or was left.
        """
        deadline = None if timeout is None else time.monotonic() + timeout
        if not self._decided.wait(timeout) or self._engine is None:
            return False
        done = threading.Event()
        self._do(lambda _: done.set())
        while not self._closed and (deadline is None or time.monotonic() < deadline):
            if done.wait(_CLOSED_WITHIN if deadline is None else min(_CLOSED_WITHIN, deadline - time.monotonic())):
                break
        return done.is_set()

    def wait_for_discovery(self, timeout: float = 5.0) -> bool:
        """Block until discovery has settled: every participant has announced its nodes, and nothing is new.

        Args:
            timeout: seconds at most.

        Returns:
            Whether discovery has settled.
        """
        deadline = time.monotonic() + timeout
        if not self.wait_until_ready(timeout):
            return False
        while time.monotonic() < deadline and not self._closed:
            quiet = time.monotonic() - max(self._remote.changed_at, self._joined_at)
            if self._remote.is_complete() and (
                quiet >= SETTLED_AFTER or (quiet >= _SETTLED_AMONG_KNOWN and self._knows_everybody())
            ):
                return True
            time.sleep(_LOOK_AGAIN)
        return False

    def _knows_everybody(self) -> bool:
        """Whether all processes that can take part are known, so that there is nothing to wait for.

        That can be told of Linkwright's processes on this machine, and only where nobody else is looked for. Of several
        participants of this process it cannot be told.
        """
        if self._settings.range is not Range.MACHINE:
            return False
        others, known = other_processes(self._settings.domain_id), self._remote.our_processes()
        return others is not None and os.getpid() not in known and len(known) >= others

    # --- for the graph -----------------------------------------------------------------------------------------------

    def open_node(self, node: NodeIdentity) -> None:
        """Announce a node."""
        self._mirror(lambda engine: engine.add_node(node))

    def close_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""
        self._mirror(lambda engine: engine.remove_node(node))

    def open_publisher(self, publisher: Publisher[Any]) -> None:
        """Mirror a publisher."""
        if self._engine is not None and not self._only_looks:
            publisher.hold_for_outside(self.wait_until_ready)
        self._mirror(lambda engine: engine.open_publisher(publisher))

    def close_publisher(self, publisher: Publisher[Any]) -> None:
        """Stop mirroring a publisher once what it sent reliably is acknowledged, or no reader is there to do so."""
        self._mirror(lambda engine: engine.close_publisher(publisher))

    def open_subscription(self, subscription: Subscription[Any]) -> None:
        """Mirror a subscription."""
        self._mirror(lambda engine: engine.open_subscription(subscription))

    def close_subscription(self, subscription: Subscription[Any]) -> None:
        """Stop mirroring a subscription."""
        self._mirror(lambda engine: engine.close_endpoint(subscription))

    def open_service(self, service: Service[Any, Any]) -> None:
        """Mirror a service."""
        self._mirror(lambda engine: engine.open_service(service))

    def close_service(self, service: Service[Any, Any]) -> None:
        """Stop mirroring a service."""
        self._mirror(lambda engine: engine.close_endpoint(service))

    def open_client(self, client: Client[Any, Any]) -> None:
        """Mirror a client."""
        self._mirror(lambda engine: engine.open_client(client))

    def close_client(self, client: Client[Any, Any]) -> None:
        """Stop mirroring a client."""
        self._mirror(lambda engine: engine.close_endpoint(client))

    def remote_nodes(self) -> Sequence[NodeIdentity]:
        """The nodes of other processes, as far as discovery has come."""
        return self._remote.nodes()

    def remote_endpoints(self) -> Sequence[EndpointInfo]:
        """The endpoints of other processes, as far as discovery has come."""
        return self._remote.endpoints()

    def watch(self, changed: Callable[[], None]) -> None:
        """Have something called, from any thread, whenever nodes or endpoints outside come or go."""
        self._remote.watch(changed)

    def watch_lost(self, lost: Callable[[EndpointInfo], None]) -> None:
        """Have something called, from any thread, with each publisher outside that is gone without having left."""
        self._departures.watch(lost)
        self._do(lambda _: None)  # processes are looked at from now on

    def close(self) -> None:
        """Leave the domain once what was sent reliably is acknowledged, or a second has passed."""
        if self._closed:
            return
        self._closed = True
        _open_transports.discard(self)
        if self._starter.ident is not None:  # Ctrl-C may have come before it was started
            self._starter.join(_JOINED_WITHIN)
        with self._joining:
            self._has_left = True
            engine, self._engine = self._engine, None
        if engine is not None:
            engine.close()
        self._work.clear()

    # --- inside ------------------------------------------------------------------------------------------------------

    def abandon(self) -> None:
        """In a process that was forked off: take no part."""
        self._closed = True
        if self._engine is not None:
            self._engine.abandon()
            self._engine = None

    def _mirror(self, work: Callable[[Engine], None]) -> None:
        """Have something done about what this process has."""
        if not self._only_looks:
            self._do(work)

    def _do(self, work: Callable[[Engine], None]) -> None:
        """Have something done in the thread that makes and deletes, in the order of asking."""
        if self._closed or self.problem is not None:
            return
        self._work.append(work)
        engine = self._engine
        if engine is not None:
            engine.wake()

    def _join(self) -> None:
        try:
            # Imported in this thread because loading Cyclone takes 0.15 s.
            from linkwright.wire.dds.engine import Engine

            engine = Engine(self._settings, self._remote, self._departures, self._work, self._logger)
            with self._joining:
                if not self._has_left:
                    self._engine = engine
                    self._joined_at = time.monotonic()
                    engine.start()
                    engine.wake()
            if self._has_left:  # `close` has given this thread up
                engine.close()
        except LinkwrightError as error:
            self.problem = error
            self._work.clear()
            log_join_failure(self._logger, error)
        except RuntimeError:
            # From Python 3.12 on no thread can be started any more once the main one has ended.
            if threading.main_thread().is_alive():
                raise
        finally:
            self._decided.set()


_open_transports: weakref.WeakSet[DdsTransport] = weakref.WeakSet()


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
    """Log why a domain is not joined."""
    findings = "\n".join(render(each) for each in error.diagnostics)
    logger.error(f"{findings}\nThis process goes on by itself: nobody outside sees its nodes.")
