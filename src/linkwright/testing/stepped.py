"""A graph whose time advances only in steps, for tests that are coroutines."""

from __future__ import annotations

from collections.abc import Sequence
from types import TracebackType
from typing import TYPE_CHECKING, Any

from linkwright.graph import (
    DEFAULT_QOS,
    Client,
    Entity,
    Graph,
    JumpClock,
    LogRecord,
    Node,
    Publisher,
    QoSProfile,
)
from linkwright.testing.recording import Recording

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.testing.programs.program import Main, Program
    from linkwright.testing.programs.programs import Programs

_NODE_NAME = "test"


class AsyncSteppedGraph:
    """A graph whose time advances only in `advance`.

    An hour of timers, rates and throttles takes milliseconds.

    All callbacks run in one thread, in a reproducible order. If a callback fails, the step in which it runs raises the
    error. For tests that are not coroutines, use `SteppedGraph`.

    Example::

        async def test_the_talker_counts():
            async with AsyncSteppedGraph() as test:
                chatter = test.record("/chatter")
                node = test.create_node("talker")
                publisher = node.create_publisher(String, "chatter", 10)
                node.create_timer(0.5, lambda: publisher.publish(String(data=f"Hello: {len(chatter)}")))
                await test.advance(3600.0)
            assert len(chatter) == 7200
            assert chatter.last.data == "Hello: 7199"

    Args:
        start: the time of day at the start, in seconds since the epoch.
        strict: whether the step in which a callback fails raises the callback's error; otherwise errors are only
            logged.

    Attributes:
        clock: the clock; ``clock.jump(seconds)`` changes only the time of day, as when a system clock is corrected.
        graph: the graph of the test.
        node: the node of the test, ``/test``, for creating clients and other endpoints.
        log: the log messages of nodes.
        errors: the errors of callbacks, if `strict` is not set.
    """

    def __init__(self, *, start: float = 1_700_000_000.0, strict: bool = True) -> None:
        self.clock = JumpClock(round(start * 1e9), is_lockstep=True)
        self.log: list[LogRecord] = []
        self.errors: list[BaseException] = []
        self._strict = strict
        self._graph: Graph | None = None
        self._node: Node | None = None
        self._publishers: dict[str, Publisher[Any]] = {}
        self._clients: dict[str, Client[Any, Any]] = {}
        self._programs: Programs | None = None

    async def __aenter__(self) -> Self:
        self._graph = Graph(clock=self.clock, on_log=self.log.append)
        assert self._graph.dispatcher is not None, "a coroutine runs on a loop"
        self._graph.dispatcher.on_error = self._record_error
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        try:
            await self.end_programs(error)
        finally:
            await self.graph.close()

    @property
    def graph(self) -> Graph:
        """The graph of the test.

        Raises:
            RuntimeError: the test has not started.
        """
        if self._graph is None:
            raise RuntimeError("the test has not started: use the graph as a context manager")
        return self._graph

    @property
    def node(self) -> Node:
        """The node of the test, ``/test``."""
        if self._node is None:
            self._node = self.graph.create_node(_NODE_NAME)
        return self._node

    @property
    def now(self) -> float:
        """The time since the start of the test, in seconds."""
        return self.clock.steady_ns() / 1e9

    @property
    def program_nodes(self) -> list[tuple[str, str]]:
        """The name and the namespace of each current node of the programs."""
        return [] if self._programs is None else self._programs.node_names

    def create_node(self, name: str, **options: Any) -> Node:
        """Create a node in the graph.

        The options are the arguments of ``Graph.create_node``.
        """
        return self.graph.create_node(name, **options)

    def start_program(self, main: Main, args: Sequence[str] = (), *, budget: float = 30.0, seed: int = 0) -> Program:
        """Start a program in the graph. See `SteppedGraph.start_program`."""
        if self._programs is None:
            from linkwright.testing.programs.programs import Programs

            self._programs = Programs(self.graph, self.clock, self.errors.append)
        return self._programs.start(main, args, budget, seed)

    async def end_programs(self, error: BaseException | None = None) -> None:
        """Interrupt the running programs, and let them end. See `SteppedGraph.start_program`.

        Args:
            error: the error that ends the test, which takes precedence over errors of programs.

        Raises:
            Exception: the error of a program that failed while it ended.
        """
        if self._programs is not None:
            count = len(self.errors)
            await self._programs.end(self._advance)
            if self._strict and error is None and len(self.errors) > count:
                raise self.errors.pop(count)

    def record(self, topic: str, msg_type: Any = None) -> Recording:
        """Record the messages that are published on a topic from now on.

        Args:
            topic: the name of the topic.
            msg_type: the message class; None for the class of the first publisher or subscriber.
        """
        return Recording(self.graph, self.node, topic, msg_type)

    def publish(self, topic: str, message: Any, qos_profile: QoSProfile | int = DEFAULT_QOS) -> None:
        """Publish a message.

        Subscribers receive it in the next step. The publisher is created on the first call and used for later messages.
        """
        publisher = self._publishers.get(topic)
        if publisher is None:
            publisher = self.node.create_publisher(type(message), topic, qos_profile)
            self._publishers[topic] = publisher
        publisher.publish(message)

    async def settle(self) -> None:
        """Run all ready callbacks, and the callbacks that these cause, without advancing time.

        Raises:
            Exception: the error of a callback.
        """
        await self._settle_graph()
        self._raise_callback_error()

    spin = settle

    async def advance(self, seconds: float) -> None:
        """Advance the time of the graph.

        Timers are called in the order of their times. The callbacks that a timer causes run before the next timer.

        Raises:
            Exception: the error of a callback; time has advanced even then.
        """
        await self._advance(seconds)
        self._raise_callback_error()

    async def call(self, service: str, request: Any, *, timeout: float = 0.0) -> Any:
        """Call a service of the graph.

        Args:
            service: the name of the service.
            request: the request message.
            timeout: the time to advance if the response does not arrive immediately, in seconds.

        Returns:
            The response.

        Raises:
            LookupError: there is no service with this name.
            TimeoutError: the response did not arrive in time.
        """
        client = self._create_service_client(service)
        future = client.call_async(request)
        await self.settle()
        if not future.ended() and timeout > 0:
            await self.advance(timeout)
        if not future.ended():
            client.remove_pending_request(future)
            raise TimeoutError(f"service '{client.srv_name}' has not responded within {timeout:g} s")
        return future.result()

    async def _advance(self, seconds: float) -> None:
        await self.clock.advance(seconds)

    async def _settle_graph(self) -> None:
        await self.graph.settle()
        if self._programs is not None:
            await self._programs.settle()

    def _create_service_client(self, service: str) -> Client[Any, Any]:
        name = self.node.resolve_service_name(service)
        client = self._clients.get(name)
        if client is None:
            types = dict(self.graph.get_service_names_and_types())
            if name not in types:
                raise LookupError(f"there is no service '{name}' in the graph")
            client = self._clients[name] = self.node.create_client(types[name][0], name)
        return client

    def _record_error(self, entity: Entity, error: BaseException) -> None:
        entity.report(error)
        self.errors.append(error)

    def _raise_callback_error(self) -> None:
        if self._strict and self.errors:
            raise self.errors.pop(0)
