"""The base of the transports' engines: work that any thread asks for, done by one thread in order."""

from __future__ import annotations

import sys
import time
import traceback
from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable
from functools import partial
from typing import Any, ClassVar, TypeAlias

from linkwright.graph.faults import ExternalShutdownException
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.living_threads import guarded

_WORK_SPAN = 0.02
"""Seconds after which work on the own endpoints makes room for news from outside."""

Work: TypeAlias = "deque[Callable[[Engine], None]]"
"""Requests to the engine, called with it in the order of asking."""


class Engine(ABC):
    """Makes, feeds and deletes the mirrors of this process's endpoints, in threads of its own.

    Args:
        work: the queue of requests; others append to it and `wake`.
        logger: logs problems.
    """

    refusal: ClassVar[type[Exception]]
    """The exception of the wire's library, which is logged without a traceback."""

    def __init__(self, work: Work, logger: Logger) -> None:
        self._work = work
        self._logger = logger

    @abstractmethod
    def start(self) -> None:
        """Begin."""

    @abstractmethod
    def wake(self) -> None:
        """Look at the work soon; from any thread."""

    @abstractmethod
    def close(self) -> None:
        """End, once reliable messages are on their way or a second has passed."""

    @abstractmethod
    def abandon(self) -> None:
        """Send nothing more, and end without the parts that need the network: this process was forked off."""

    @abstractmethod
    def add_node(self, node: NodeIdentity) -> None:
        """Announce a node."""

    @abstractmethod
    def remove_node(self, node: NodeIdentity) -> None:
        """Withdraw a node."""

    @abstractmethod
    def open_publisher(self, publisher: Any) -> None:
        """Mirror a publisher."""

    @abstractmethod
    def close_publisher(self, publisher: Any) -> None:
        """Stop mirroring a publisher."""

    @abstractmethod
    def open_subscription(self, subscription: Any) -> None:
        """Mirror a subscription."""

    @abstractmethod
    def open_service(self, service: Any) -> None:
        """Mirror a service."""

    @abstractmethod
    def open_client(self, client: Any) -> None:
        """Mirror a client."""

    @abstractmethod
    def open_presence(self, presence: Any) -> None:
        """Show an endpoint that takes no part."""

    @abstractmethod
    def close_endpoint(self, endpoint: Any) -> None:
        """Stop mirroring a subscription, a service, a client or a presence."""

    # --- requests ----------------------------------------------------------------------------------------------------

    def _do_some_work(self) -> None:
        """Make and delete the endpoints that were asked for, for a limited time."""
        until = time.monotonic() + _WORK_SPAN
        while self._work and time.monotonic() < until:
            self._do_next()

    def _do_all_work(self) -> None:
        """The same without a limit, before the engine ends."""
        while self._work:
            self._do_next()

    def _do_next(self) -> None:
        guarded(partial(self._work.popleft(), self), self._report)

    def _report(self, error: Exception) -> None:
        """Log that an endpoint is not mirrored: the library's refusal, or the traceback of an error of ours."""
        lines = [str(error)] if isinstance(error, self.refusal) else traceback.format_exception(error)
        self._logger.error("A part of the graph is not visible outside this process: " + "".join(lines).rstrip())


def ends_by_error() -> bool:
    """Whether this program has ended with an uncaught exception; Ctrl-C is none of these."""
    error = getattr(sys, "last_value", None)
    is_interactive = hasattr(sys, "ps1")
    return isinstance(error, Exception) and not isinstance(error, ExternalShutdownException) and not is_interactive
