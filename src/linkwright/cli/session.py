"""The session of a command that communicates with running nodes.

A session consists of a graph, joined over DDS or Zenoh, and a hidden node. A command passes a coroutine to
`run_in_graph`. Ctrl-C cancels the coroutine, leaves the graph cleanly, and ends the command with status 130. If the
program that reads the output exits, the command ends without an error.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import signal
import sys
import threading
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from contextlib import asynccontextmanager
from inspect import signature
from typing import TYPE_CHECKING, Any, TypeVar

from linkwright.diagnostics import Diagnostic, LinkwrightError, Note, phrase
from linkwright.process.event_loop import run_coroutine
from linkwright.process.interruption import raise_interrupts

if TYPE_CHECKING:
    from types import FrameType

    from linkwright.graph import Graph, Node
    from linkwright.graph.loop.future import Future
    from linkwright.hosting.signals import SignalWatch

T = TypeVar("T")

_NODE_NAME_PREFIX = "_ros2cli"
_JOIN_TIMEOUT_S = 10.0
_DISCOVERY_TIMEOUT_S = 3.0
_POLL_INTERVAL_S = 0.01


def add_session_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options that all ros2 commands on the graph have in common."""
    group = parser.add_argument_group(title="ROS graph")
    group.add_argument(
        "--spin-time",
        metavar="SECONDS",
        type=float,
        help="the time to wait for discovery (default: until the graph is discovered)",
    )
    group.add_argument("-s", "--use-sim-time", action="store_true", help="use simulated time (/clock)")
    group.add_argument(
        "--no-daemon", action="store_true", help="accepted for compatibility with ros2; there is no daemon"
    )


class Session:
    """The graph and the node of a running command.

    A `SignalWatch` can end the session.

    Attributes:
        graph: the graph, joined with other processes.
        node: the command's hidden node.
        loop: the event loop.
        is_blocking: whether code of a launch file blocks the event loop; always False.
    """

    is_blocking = False

    def __init__(self, graph: Graph, node: Node) -> None:
        self.graph = graph
        self.node = node
        self.loop = asyncio.get_running_loop()
        self._outcome: asyncio.Future[int] = self.loop.create_future()

    def finish(self, status: int = 0) -> None:
        """End the command, so that `finished` returns the status."""
        if not self._outcome.done():
            self._outcome.set_result(status)

    def interrupt(self, _reason: str) -> None:
        """End the command on a signal, so that `finished` returns 0."""
        self.finish()

    def seconds_to_end(self) -> float:
        """Return 0, because there are no processes to wait for."""
        return 0.0

    def kill_all(self) -> None:
        """Do nothing, because there are no processes to kill."""

    def guard(self, callback: Callable[..., object]) -> Callable[..., None]:
        """Wrap a callback so that its exceptions end the command.

        Without the wrapper, the graph would log the exception and continue.
        """

        def call(*arguments: Any) -> None:
            if self._outcome.done():
                return
            try:
                callback(*arguments)
            except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - passed on to the command
                if not self._outcome.done():
                    self._outcome.set_exception(error)

        return call

    def guard_receiver(self, callback: Callable[..., object]) -> Callable[..., None]:
        """Wrap a subscription's callback like `guard`, and preserve its number of parameters.

        The graph determines from this number whether the callback receives only the message or also the message's
        metadata.
        """
        guarded = self.guard(callback)

        def pass_message(message: Any) -> None:
            guarded(message)

        def pass_message_and_info(message: Any, info: Any) -> None:
            guarded(message, info)

        return pass_message if len(signature(callback).parameters) == 1 else pass_message_and_info

    def call_every(self, period: float, callback: Callable[[], object]) -> None:
        """Call a function every `period` seconds until the command ends."""
        loop = asyncio.get_running_loop()
        guarded = self.guard(callback)
        due = loop.time()

        def call() -> None:
            nonlocal due
            guarded()
            due += period
            if not self._outcome.done():
                loop.call_at(due, call)

        due += period
        loop.call_at(due, call)

    async def wait_until_finished(self, timeout: float | None = None) -> int | None:
        """Wait for the command to end, and return its exit status, or None after `timeout` seconds."""
        done_futures, _ = await asyncio.wait([self._outcome], timeout=timeout)
        return self._outcome.result() if done_futures else None

    async def wait_until(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Poll a condition until it is true.

        Returns:
            True if the condition became true; False if the command ended or `timeout` seconds passed before that.
        """
        loop = asyncio.get_running_loop()
        deadline = None if timeout is None else loop.time() + timeout
        while not condition():
            if self._outcome.done() or (deadline is not None and loop.time() >= deadline):
                return False
            await asyncio.sleep(_POLL_INTERVAL_S)
        return True

    async def wait_for_result(self, future: Future[T], timeout: float | None = None) -> T | None:
        """Wait for a future of the graph, and return its result.

        The result is None if the command ends or `timeout` seconds pass before the future is done.
        """
        loop = asyncio.get_running_loop()
        done_event = asyncio.Event()
        future.add_waiter(lambda: loop.call_soon_threadsafe(done_event.set))
        wait_task = asyncio.ensure_future(done_event.wait())
        try:
            pending: tuple[asyncio.Future[Any], ...] = (wait_task, self._outcome)
            await asyncio.wait(pending, timeout=timeout, return_when=asyncio.FIRST_COMPLETED)
        finally:
            wait_task.cancel()
        return future.result() if future.done() else None


@asynccontextmanager
async def graph_session(
    *,
    node_name: str | None = None,
    spin_time: float | None = None,
    use_sim_time: bool = False,
    remappings: Sequence[tuple[str, str]] = (),
    read_only: bool = False,
) -> AsyncIterator[Session]:
    """Join the graph with a hidden node for the duration of the context.

    Args:
        node_name: the node's name; None for a name that is unique to the process.
        spin_time: the time to wait for discovery, in seconds; None to wait until the other participants are discovered.
        use_sim_time: whether the node uses ``/clock``.
        remappings: rules ``(from, to)`` for the names that the node uses.
        read_only: whether the command only reads the graph, in which case its node is invisible to other nodes.

    Raises:
        LinkwrightError: see `join_others`.
    """
    graph = open_graph()
    try:
        node = graph.create_node(
            node_name or f"{_NODE_NAME_PREFIX}_{os.getpid()}",
            parameters={"use_sim_time": True} if use_sim_time else None,
            remappings=remappings,
            start_parameter_services=False,
        )
        await join_others(graph, spin_time, read_only=read_only)
        yield Session(graph, node)
    finally:
        await graph.close()


def run_in_graph(
    arguments: argparse.Namespace,
    job: Callable[[Session], Awaitable[int]],
    *,
    node_name: str | None = None,
    remappings: Sequence[tuple[str, str]] = (),
    read_only: bool = False,
    signals: SignalWatch | None = None,
) -> int:
    """Run a command's coroutine in the graph, and return its result as the exit status.

    Args:
        arguments: the parsed arguments; the options of `add_session_arguments` may be missing.
        job: the coroutine function of the command.
        node_name: see `graph_session`.
        remappings: see `graph_session`.
        read_only: see `graph_session`.
        signals: the signal handler, which finishes the session on the first signal; None to interrupt the command
            instead.
    """

    async def main() -> int:
        async with graph_session(
            node_name=node_name,
            spin_time=getattr(arguments, "spin_time", None),
            use_sim_time=getattr(arguments, "use_sim_time", False),
            remappings=remappings,
            read_only=read_only,
        ) as session:
            if signals is not None:
                signals.session = session
            return await job(session)

    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(line_buffering=True)
    if signals is not None:
        with signals:
            return signals.run(main)
    with ExitOnSigterm():
        return run_coroutine(main, raise_interrupts)


def open_graph() -> Graph:
    """Open a graph that runs on the current event loop."""
    from linkwright.graph import Graph

    return Graph()


async def join_others(graph: Graph, spin_time: float | None, *, read_only: bool = False) -> None:
    """Join the graph with other processes, and wait until their participants are discovered.

    Raises:
        LinkwrightError: CLI401, neither DDS nor Zenoh is available; DDS101, ROS_DOMAIN_ID is not a domain; DDS111, a
            setting of Zenoh is malformed; DDS121, security is enforced; DDS102, DDS112, the domain cannot be joined.
    """
    from linkwright.wire.joining import check_settings, is_available, join, unavailable_reason

    if is_available():
        check_settings()  # report malformed settings as errors; joining would only log them
    transport = join(graph, discovers_only=read_only, must_join=True) if is_available() else None
    if transport is None:
        raise LinkwrightError(
            Diagnostic(
                "CLI401",
                phrase("the nodes of other processes cannot be reached without DDS or Zenoh"),
                notes=(Note(unavailable_reason()),),
                hint=phrase("unset LINKWRIGHT_DDS") if os.environ.get("LINKWRIGHT_DDS") else None,
            )
        )
    while not await asyncio.to_thread(transport.wait_until_ready, _JOIN_TIMEOUT_S) and transport.waits_for_others:
        pass  # the transport logs what it is waiting for
    if transport.problem is not None:
        raise transport.problem
    if spin_time is not None:
        await asyncio.sleep(spin_time)
    else:
        await asyncio.to_thread(transport.wait_for_discovery, _DISCOVERY_TIMEOUT_S)


class ExitOnSigterm:
    """A context in which SIGTERM ends the process as Ctrl-C does, so that it leaves the graph."""

    def __enter__(self) -> None:
        self._previous_handler: Any = None
        if threading.current_thread() is threading.main_thread():
            self._previous_handler = signal.signal(signal.SIGTERM, self._exit_process)

    def __exit__(self, *_: object) -> None:
        if self._previous_handler is not None:
            signal.signal(signal.SIGTERM, self._previous_handler)

    @staticmethod
    def _exit_process(signal_number: int, _frame: FrameType | None) -> None:
        raise SystemExit(128 + signal_number)
