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


_BATCHES = 4
"""The number of batches that may wait for the event loop before the simulation waits for it."""


class Exchange:
    """Carries messages out of the simulation's thread, and commands into it.

    Messages are collected and delivered in batches. If the simulation has its own thread, batches are delivered to the
    event loop of the graph, otherwise directly. Commands may come from any thread. The simulation executes them between
    two intervals of simulated time.

    Attributes:
        has_commands: an event that is set while commands are queued.
    """

    def __init__(self) -> None:
        self.has_commands = threading.Event()
        self._out: list[tuple[Outlet, Any]] = []
        self._in: deque[Command] = deque()
        self._free: SimpleQueue[None] = SimpleQueue()  # tokens for free batches; faster than a semaphore
        self._make_room()
        self._closed = False

    def send(self, publisher: Outlet, message: Any) -> None:
        """Add a message to the next batch. The message must not change afterwards."""
        self._out.append((publisher, message))

    def deliver(self, dispatcher: LoopDispatcher | None = None) -> None:
        """Publish the messages that were added with `send`.

        Args:
            dispatcher: the dispatcher of the event loop that publishes; None to publish in this call.
        """
        if not self._out:
            return
        batch, self._out = self._out, []
        if dispatcher is None:
            _publish(batch)
            return
        self._free.get()
        if not self._closed:
            dispatcher.call_threadsafe(partial(self._deliver, batch))

    def post(self, command: Command) -> None:
        """Queue a function to be called in the simulation's thread. Callable from any thread."""
        self._in.append(command)
        self.has_commands.set()

    def run_commands(self) -> None:
        """Call the functions that were queued with `post`."""
        if self.has_commands.is_set():
            self.has_commands.clear()
        while self._in:
            self._in.popleft()()

    def close(self) -> None:
        """Stop delivering, and release a simulation that waits in `deliver`."""
        self._closed = True
        self._in.clear()
        self._make_room()
        self.has_commands.set()

    def _deliver(self, batch: list[tuple[Outlet, Any]]) -> None:
        self._free.put(None)
        if not self._closed:
            _publish(batch)

    def _make_room(self) -> None:
        for _ in range(_BATCHES):
            self._free.put(None)


def _publish(batch: list[tuple[Outlet, Any]]) -> None:
    for publisher, message in batch:
        try:
            publisher.publish(message)
        except InvalidHandleError:  # noqa: PERF203 - `suppress` for each takes longer than to publish
            continue  # the publisher's model was removed
