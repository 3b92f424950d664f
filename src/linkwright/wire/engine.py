"""The base class of transport engines.

A mirror is the entity of a transport that represents an endpoint of this process, such as a DDS writer for a publisher.
A single thread serves the requests of all threads.
"""

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
from linkwright.wire.guarded_calls import call_guarded

_MAX_WORK_S = 0.02
"""Seconds after which the engine interrupts work on endpoints of this process to handle changes outside."""

Work: TypeAlias = "deque[Callable[[Engine], None]]"
"""Requests to the engine: functions that are called with the engine, in order."""


class Engine(ABC):
    """The part of a transport that creates, serves and deletes mirrors, in separate threads.

    Args:
        work: the queue of requests; other threads append to it and call `wake`.
        logger: logs problems.
    """

    library_error: ClassVar[type[Exception]]
    """The exception class of the transport's library, which is logged without a traceback."""

    def __init__(self, work: Work, logger: Logger) -> None:
        self._work = work
        self._logger = logger

    @abstractmethod
    def start(self) -> None:
        """Start the threads."""

    @abstractmethod
    def wake(self) -> None:
        """Wake the thread that processes the queue of requests.

        Any thread may call this method.
        """

    @abstractmethod
    def close(self) -> None:
        """End the engine, after waiting at most a second for reliable messages to be delivered."""

    @abstractmethod
    def abandon(self) -> None:
        """Stop sending in a forked process, and end the engine without using the network."""

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
        """Announce an endpoint that neither sends nor receives."""

    @abstractmethod
    def close_endpoint(self, endpoint: Any) -> None:
        """Stop mirroring a subscription, a service, a client or a presence."""

    # --- requests ----------------------------------------------------------------------------------------------------

    def _process_some_requests(self) -> None:
        """Process requests to create and delete endpoints, for a limited time."""
        deadline = time.monotonic() + _MAX_WORK_S
        while self._work and time.monotonic() < deadline:
            self._process_next_request()

    def _process_all_requests(self) -> None:
        """Process all requests before the engine ends, without a time limit."""
        while self._work:
            self._process_next_request()

    def _process_next_request(self) -> None:
        call_guarded(partial(self._work.popleft(), self), self._report)

    def _report(self, error: Exception) -> None:
        """Log that an endpoint is not mirrored, with the reason.

        For an error of Linkwright itself, the traceback is logged.
        """
        lines = [str(error)] if isinstance(error, self.library_error) else traceback.format_exception(error)
        self._logger.error("A part of the graph is not visible outside this process: " + "".join(lines).rstrip())


def is_ending_by_error() -> bool:
    """Return whether this program is ending because of an uncaught exception other than Ctrl-C."""
    error = getattr(sys, "last_value", None)
    is_interactive = hasattr(sys, "ps1")
    return isinstance(error, Exception) and not isinstance(error, ExternalShutdownException) and not is_interactive
