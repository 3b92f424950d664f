"""Queues between the thread of a simulation and the event loop of the graph."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from functools import partial
from queue import SimpleQueue
from typing import Any, Protocol

from linkwright.graph.faults import InvalidHandleError
from linkwright.graph.loop.dispatcher import LoopDispatcher

Command = Callable[[], object]


class Outlet(Protocol):
    """A destination of messages: a publisher, or an object that passes them to a function."""

    def publish(self, message: Any) -> object:
        """Publish a message, or pass it to the function."""


_MAX_PENDING_BATCHES = 4
"""The maximum number of batches that wait for the event loop. A simulation that sends more is blocked."""


class Exchange:
    """Queues for messages out of the simulation's thread, and for commands into it.

    Messages are collected and delivered in batches. If the simulation has its own thread, batches are delivered to the
    event loop of the graph, otherwise directly. Commands may come from any thread. The simulation executes them between
    two intervals of simulated time.

    Attributes:
        has_commands: an event that is set while commands are queued.
    """

    def __init__(self) -> None:
        self.has_commands = threading.Event()
        self._outgoing: list[tuple[Outlet, Any]] = []
        self._commands: deque[Command] = deque()
        self._batch_tokens: SimpleQueue[None] = SimpleQueue()  # tokens for free batches; faster than a semaphore
        self._release_batches()
        self._closed = False

    def send(self, publisher: Outlet, message: Any) -> None:
        """Add a message to the next batch.

        The message must not change afterwards.
        """
        self._outgoing.append((publisher, message))

    def deliver(self, dispatcher: LoopDispatcher | None = None) -> None:
        """Publish the messages that were added with `send`.

        Args:
            dispatcher: the dispatcher of the event loop that publishes; None to publish in this call.
        """
        if not self._outgoing:
            return
        batch, self._outgoing = self._outgoing, []
        if dispatcher is None:
            _publish(batch)
            return
        self._batch_tokens.get()
        if not self._closed:
            dispatcher.call_threadsafe(partial(self._deliver, batch))

    def post(self, command: Command) -> None:
        """Queue a function to be called in the simulation's thread.

        Any thread may call this method.
        """
        self._commands.append(command)
        self.has_commands.set()

    def run_commands(self) -> None:
        """Call the functions that were queued with `post`."""
        if self.has_commands.is_set():
            self.has_commands.clear()
        while self._commands:
            self._commands.popleft()()

    def close(self) -> None:
        """Stop delivering, and release a simulation that waits in `deliver`."""
        self._closed = True
        self._commands.clear()
        self._release_batches()
        self.has_commands.set()

    def _deliver(self, batch: list[tuple[Outlet, Any]]) -> None:
        self._batch_tokens.put(None)
        if not self._closed:
            _publish(batch)

    def _release_batches(self) -> None:
        for _ in range(_MAX_PENDING_BATCHES):
            self._batch_tokens.put(None)


def _publish(batch: list[tuple[Outlet, Any]]) -> None:
    for publisher, message in batch:
        try:
            publisher.publish(message)
        except InvalidHandleError:  # noqa: PERF203 - `suppress` for each takes longer than to publish
            continue  # the publisher's model was removed
