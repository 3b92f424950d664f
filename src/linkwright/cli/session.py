"""The graph of a verb that looks at or acts on running nodes: joined over DDS, with a hidden node of its own.

A verb gives `run_in_graph` a coroutine. Interrupted with Ctrl-C it is cancelled, the graph is left properly, and the
command ends with status 130; one whose reader went away ends quietly.
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
from linkwright.event_loop import run_coroutine
from linkwright.interruption import raise_interrupts

if TYPE_CHECKING:
    from types import FrameType

    from linkwright.graph import Graph, Node
    from linkwright.graph.loop.future import Future
    from linkwright.hosting.signals import SignalWatch

T = TypeVar("T")

_HIDDEN = "_ros2cli"
_LONGEST_JOINING = 10.0
_LONGEST_DISCOVERY = 3.0
_POLL = 0.01


def add_session_arguments(parser: argparse.ArgumentParser) -> None:
    """The options that ros2 gives every verb that looks at the graph."""
    parser.add_argument(
        "--spin-time",
        metavar="SECONDS",
        type=float,
        help="how long to wait for other nodes to be discovered, instead of until they have been",
    )
    parser.add_argument("-s", "--use-sim-time", action="store_true", help="go by the time that /clock tells")
    parser.add_argument("--no-daemon", action="store_true", help="accepted for ros2's sake; there is no daemon")


class Session:
    """The graph and the node of a running verb.

    A `SignalWatch` can end it: the verb is done then.

    Attributes:
        graph: joined with what runs outside.
        node: the verb's own hidden node.
        loop: the loop it runs on.
        visiting: whether a signal has to break something off; never.
    """

    visiting = False

    def __init__(self, graph: Graph, node: Node) -> None:
        self.graph = graph
        self.node = node
        self.loop = asyncio.get_running_loop()
        self._outcome: asyncio.Future[int] = self.loop.create_future()

    def finish(self, status: int = 0) -> None:
        """Let `finished` return a status."""
        if not self._outcome.done():
            self._outcome.set_result(status)

    def interrupt(self, _reason: str) -> None:
        """Let `finished` return 0, as the user said so."""
        self.finish()

    def seconds_to_end(self) -> float:
        """No time: there are no processes."""
        return 0.0

    def kill_all(self) -> None:
        """There are no processes to be ended."""

    def guarded(self, callback: Callable[..., object]) -> Callable[..., None]:
        """A callback for the graph whose errors end the verb, where the graph itself would log them and go on."""

        def call(*arguments: Any) -> None:
            if self._outcome.done():
                return
            try:
                callback(*arguments)
            except (Exception, KeyboardInterrupt) as error:  # noqa: BLE001 - handed on to the verb
                if not self._outcome.done():
                    self._outcome.set_exception(error)

        return call

    def receiver(self, callback: Callable[..., object]) -> Callable[..., None]:
        """A guarded callback for a subscription, of as many arguments as the one given.

        The graph tells by the number whether the callback takes the message alone, or also what is known of it beside.
        """
        guarded = self.guarded(callback)

        def take(message: Any) -> None:
            guarded(message)

        def take_both(message: Any, info: Any) -> None:
            guarded(message, info)

        return take if len(signature(callback).parameters) == 1 else take_both

    def every(self, period: float, callback: Callable[[], object]) -> None:
        """Call a function periodically until the verb is done."""
        loop = asyncio.get_running_loop()
        guarded = self.guarded(callback)
        due = loop.time()

        def call() -> None:
            nonlocal due
            guarded()
            due += period
            if not self._outcome.done():
                loop.call_at(due, call)

        due += period
        loop.call_at(due, call)

    async def finished(self, timeout: float | None = None) -> int | None:
        """Wait until the verb is done, and return its status; None when `timeout` seconds have passed first."""
        done, _ = await asyncio.wait([self._outcome], timeout=timeout)
        return self._outcome.result() if done else None

    async def until(self, condition: Callable[[], bool], timeout: float | None = None) -> bool:
        """Wait until something holds, looking again and again; False when `timeout` seconds have passed first."""
        loop = asyncio.get_running_loop()
        end = None if timeout is None else loop.time() + timeout
        while not condition():
            if self._outcome.done() or (end is not None and loop.time() >= end):
                return False
            await asyncio.sleep(_POLL)
        return True

    async def answer(self, future: Future[T], timeout: float | None = None) -> T | None:
        """The result of a future of the graph; None when `timeout` seconds have passed first."""
        loop = asyncio.get_running_loop()
        ended = asyncio.Event()
        future.add_waiter(lambda: loop.call_soon_threadsafe(ended.set))
        waiting = asyncio.ensure_future(ended.wait())
        try:
            pending: tuple[asyncio.Future[Any], ...] = (waiting, self._outcome)
            await asyncio.wait(pending, timeout=timeout, return_when=asyncio.FIRST_COMPLETED)
        finally:
            waiting.cancel()
        return future.result() if future.done() else None


@asynccontextmanager
async def graph_session(
    *,
    node_name: str | None = None,
    spin_time: float | None = None,
    use_sim_time: bool = False,
    remappings: Sequence[tuple[str, str]] = (),
    only_looks: bool = False,
) -> AsyncIterator[Session]:
    """Join the graph, with a hidden node, until the block ends.

    Args:
        node_name: the node's name; one of its own for each process when left out.
        spin_time: seconds to wait for discovery; when left out, until others have told what they have.
        use_sim_time: whether the node goes by ``/clock``.
        remappings: rules ``(from, to)`` for the names that the node uses.
        only_looks: whether the verb asks what there is and speaks to nobody; its node is not seen outside then.

    Raises:
        LinkwrightError: see `join_others`.
    """
    graph = open_graph()
    try:
        node = graph.create_node(
            node_name or f"{_HIDDEN}_{os.getpid()}",
            parameters={"use_sim_time": True} if use_sim_time else None,
            remappings=remappings,
            start_parameter_services=False,
        )
        await join_others(graph, spin_time, only_looks=only_looks)
        yield Session(graph, node)
    finally:
        await graph.close()


def run_in_graph(
    arguments: argparse.Namespace,
    job: Callable[[Session], Awaitable[int]],
    *,
    node_name: str | None = None,
    remappings: Sequence[tuple[str, str]] = (),
    only_looks: bool = False,
    signals: SignalWatch | None = None,
) -> int:
    """Run a verb's coroutine in the graph; its result is the exit status.

    Args:
        arguments: with those of `add_session_arguments`, each of which may be missing.
        job: what the verb does.
        node_name: see `graph_session`.
        remappings: see `graph_session`.
        only_looks: see `graph_session`.
        signals: handles signals, the first of which finishes the session; when left out, they break the verb off.
    """

    async def main() -> int:
        async with graph_session(
            node_name=node_name,
            spin_time=getattr(arguments, "spin_time", None),
            use_sim_time=getattr(arguments, "use_sim_time", False),
            remappings=remappings,
            only_looks=only_looks,
        ) as session:
            if signals is not None:
                signals.session = session
            return await job(session)

    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(line_buffering=True)
    if signals is not None:
        with signals:
            return signals.run(main)
    with TerminationEnds():
        return run_coroutine(main, raise_interrupts)


def open_graph() -> Graph:
    """A graph on the running event loop."""
    from linkwright.graph import Graph

    return Graph()


async def join_others(graph: Graph, spin_time: float | None, *, only_looks: bool = False) -> None:
    """Connect the graph with what runs in other processes and wait until that is discovered.

    Raises:
        LinkwrightError: CLI401, there is neither DDS nor Zenoh; DDS101, ROS_DOMAIN_ID is no domain; DDS111, a
            setting of Zenoh is not well formed; DDS121, security is enforced; DDS102, DDS112, the domain cannot be
            joined.
    """
    from linkwright.wire.joining import available, check_settings, join, why_not

    if available():
        check_settings()  # raises what joining would only log
    transport = join(graph, only_looks=only_looks, must_join=True) if available() else None
    if transport is None:
        raise LinkwrightError(
            Diagnostic(
                "CLI401",
                phrase("the nodes of other processes cannot be reached without DDS or Zenoh"),
                notes=(Note(why_not()),),
                hint=phrase("unset LINKWRIGHT_DDS") if os.environ.get("LINKWRIGHT_DDS") else None,
            )
        )
    while not await asyncio.to_thread(transport.wait_until_ready, _LONGEST_JOINING) and transport.waits:
        pass  # it says what it waits for
    if transport.problem is not None:
        raise transport.problem
    if spin_time is not None:
        await asyncio.sleep(spin_time)
    else:
        await asyncio.to_thread(transport.wait_for_discovery, _LONGEST_DISCOVERY)


class TerminationEnds:
    """While this is entered, SIGTERM ends the process as Ctrl-C does, so that the graph is left properly."""

    def __enter__(self) -> None:
        self._before: Any = None
        if threading.current_thread() is threading.main_thread():
            self._before = signal.signal(signal.SIGTERM, self._end)

    def __exit__(self, *_: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGTERM, self._before)

    @staticmethod
    def _end(number: int, _frame: FrameType | None) -> None:
        raise SystemExit(128 + number)
