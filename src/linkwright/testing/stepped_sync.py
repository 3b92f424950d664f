"""A graph whose time advances only in steps, for tests that are plain functions."""

from __future__ import annotations

import asyncio
from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.graph import DEFAULT_QOS, Graph, JumpClock, LogRecord, Node, QoSProfile
from linkwright.testing.recording import Recording
from linkwright.testing.stepped import AsyncSteppedGraph

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.standins.rclpy_api.context import Context
    from linkwright.testing.programs.program import Main, Program


class SteppedGraph:
    """`AsyncSteppedGraph` for tests that are not coroutines.

    The event loop runs in the test's thread.

    >>> from linkwright.messages import String
    >>> with SteppedGraph() as test:
    ...     chatter = test.record("/chatter")
    ...     node = test.create_node("talker")
    ...     publisher = node.create_publisher(String, "chatter", 10)
    ...     timer = node.create_timer(0.5, lambda: publisher.publish(String(data=f"Hello: {len(chatter)}")))
    ...     test.advance(3600.0)
    ...     len(chatter), chatter.last.data
    (7200, 'Hello: 7199')

    A node that is written for rclpy is tested in the same way. After `init_rclpy`, nodes of rclpy are created in the
    test's graph, and the steps of the graph run their callbacks without spinning::

        with SteppedGraph() as test:
            test.init_rclpy()
            chatter = test.record("/chatter")
            MinimalPublisher()  # an rclpy.node.Node
            test.advance(10.0)
            assert len(chatter) == 20

    Args:
        start: the time of day at the start, in seconds since the epoch.
        strict: whether the step in which a callback fails raises the callback's error; otherwise errors are only
            logged.
        steps: the asynchronous graph to wrap, for which `start` and `strict` are ignored; None to create one.
    """

    def __init__(
        self, *, start: float = 1_700_000_000.0, strict: bool = True, steps: AsyncSteppedGraph | None = None
    ) -> None:
        self._steps = steps or AsyncSteppedGraph(start=start, strict=strict)
        self._loop: asyncio.AbstractEventLoop | None = None
        self._context: Context | None = None

    def __enter__(self) -> Self:
        self._loop = asyncio.new_event_loop()
        self._run(self._steps.__aenter__())
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._loop is not None, "it was entered"
        try:
            self._run(self._steps.end_programs(error))
            if self._context is not None:
                from linkwright.standins.rclpy_api.session import try_shutdown

                try_shutdown()
            self._run(self._steps.__aexit__(kind, error, trace))
        finally:
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.run_until_complete(self._loop.shutdown_default_executor())
            self._loop.close()
            self._loop = None

    @property
    def graph(self) -> Graph:
        """The graph of the test."""
        return self._steps.graph

    @property
    def clock(self) -> JumpClock:
        """The clock. ``clock.jump(seconds)`` changes only the time of day."""
        return self._steps.clock

    @property
    def node(self) -> Node:
        """The node of the test, ``/test``."""
        return self._steps.node

    @property
    def log(self) -> list[LogRecord]:
        """The log messages of all nodes."""
        return self._steps.log

    @property
    def errors(self) -> list[BaseException]:
        """The errors of callbacks, if the graph is not strict."""
        return self._steps.errors

    @property
    def now(self) -> float:
        """The time since the start of the test, in seconds."""
        return self._steps.now

    def init_rclpy(self, args: list[str] | None = None) -> Context:
        """Initialize rclpy with the test's graph until the end of the test.

        Args:
            args: the command line, with ROS arguments; None for an empty command line.

        Returns:
            The default context of rclpy, in which nodes are created.
        """
        from linkwright.standins.rclpy_api.defaults import use_graph

        self._context = use_graph(self.graph, args or [])
        return self._context

    def start_program(self, main: Main, args: Sequence[str] = (), *, budget: float = 30.0, seed: int = 0) -> Program:
        """Start a program, and return it.

        A program is, for example, a file that calls ``rclpy.init()`` and ``rclpy.spin(node)``. The program runs in
        separate threads, but only in the steps of the graph, until all its threads wait. Executors, ``time.sleep``,
        rates, locks, events, queues, futures and asyncio return control to the graph. The modules ``time`` and
        ``rclpy`` use the time of the graph, so the program's results are bit-identical in each run. Several programs
        may run in a graph. Each has its own default context of rclpy and its own ``sys.argv``.

        If an exception ends a program, the step in which it happens raises it. At the end of the test, programs
        receive Ctrl-C, and have 5 s of simulated time to end.

        Args:
            main: the path of a file, which runs as with ``python FILE``; the name of a module whose ``main`` is called;
                or a function.
            args: the command line without the name of the program, with ROS arguments such as
                ``["--ros-args", "-p", "use_sim_time:=true"]``.
            budget: the longest time for which the program may compute without waiting, in seconds, not counting the
                time in which it waits for a processor. If it is exceeded, the step raises a `BudgetExceededError` with
                file and line.
            seed: the seed of the modules ``random`` and ``numpy.random`` at the start.

        Raises:
            OSError: the file cannot be read.
        """
        return self._steps.start_program(main, args, budget=budget, seed=seed)

    @property
    def program_nodes(self) -> list[tuple[str, str]]:
        """The name and the namespace of each current node of the programs."""
        return self._steps.program_nodes

    def create_node(self, name: str, **options: Any) -> Node:
        """Create a node in the graph.

        The options are the arguments of ``Graph.create_node``.
        """
        return self._steps.create_node(name, **options)

    def record(self, topic: str, msg_type: Any = None) -> Recording:
        """Record the messages that are published on a topic from now on.

        See `AsyncSteppedGraph.record`.
        """
        return self._steps.record(topic, msg_type)

    def publish(self, topic: str, message: Any, qos_profile: QoSProfile | int = DEFAULT_QOS) -> None:
        """Publish a message.

        Subscribers receive it in the next step.
        """
        self._steps.publish(topic, message, qos_profile)

    def settle(self) -> None:
        """Run all ready callbacks, and the callbacks that these cause, without advancing time.

        Raises:
            Exception: the error of a callback.
        """
        self._run(self._steps.settle())

    spin = settle

    def advance(self, seconds: float) -> None:
        """Advance the time of the graph. See `AsyncSteppedGraph.advance`.

        Raises:
            Exception: the error of a callback; time has advanced even then.
        """
        self._run(self._steps.advance(seconds))

    def call(self, service: str, request: Any, *, timeout: float = 0.0) -> Any:
        """Call a service of the graph. See `AsyncSteppedGraph.call`.

        Raises:
            LookupError: there is no service with this name.
            TimeoutError: the response did not arrive in time.
        """
        return self._run(self._steps.call(service, request, timeout=timeout))

    def run(self, coroutine: Any) -> Any:
        """Run a coroutine on the graph's event loop without advancing time, and return its result."""
        return self._run(coroutine)

    def _run(self, coroutine: Any) -> Any:
        if self._loop is None:
            coroutine.close()
            raise RuntimeError("the test has not started: use the graph as a context manager")
        return self._loop.run_until_complete(coroutine)
