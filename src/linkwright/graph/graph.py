"""The computation graph of this process: its nodes, the bus between them, and what they share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from linkwright.graph.bus import Bus
from linkwright.graph.clock import Clock, SystemClock
from linkwright.graph.executor import Executor
from linkwright.graph.log import Logger, LogSink, print_to_console
from linkwright.graph.names import Remappings, absolute_namespace, check_node_name, join
from linkwright.graph.node import Node


class Graph:
    """A ROS-like computation graph on the running event loop. Like asyncio, it belongs to one thread.

    Args:
        clock: what stamps messages and wakes timers; the system's when left out.
        on_log: what takes log records; standard error in ROS 2's console format when left out.
    """

    def __init__(self, *, clock: Clock | None = None, on_log: LogSink | None = None) -> None:
        self._clock = clock or SystemClock()
        self._sink = on_log or print_to_console
        self._executor = Executor()
        self._clock.attach(self._executor)
        self._bus = Bus()
        self._nodes: list[Node] = []

    @property
    def clock(self) -> Clock:
        """The clock that all nodes go by."""
        return self._clock

    def create_node(
        self,
        name: str,
        *,
        namespace: str = "/",
        parameters: Mapping[str, Any] | None = None,
        remappings: Sequence[tuple[str, str]] = (),
    ) -> Node:
        """Make a node.

        Args:
            name: the name its code gives it.
            namespace: where it lives; a missing leading slash is added.
            parameters: values that take the place of declared defaults; nested mappings stand for dotted names.
            remappings: rules ``(from, to)`` for topics, ``__node`` and ``__ns``.

        Raises:
            InvalidNameError: the name or the namespace is not valid.
        """
        rules = Remappings(remappings)
        name = rules.node_name(name)
        check_node_name(name)
        namespace = absolute_namespace(rules.namespace(namespace))
        logger = self.get_logger(join(namespace, name)[1:].replace("/", "."))
        if join(namespace, name) in self.node_names():
            logger.warning(
                f"There are nodes in the graph that share the exact name '{join(namespace, name)}': "
                "this can have unintended side effects"
            )
        node = Node(
            name,
            namespace,
            bus=self._bus,
            executor=self._executor,
            clock=self._clock,
            logger=logger,
            parameters=parameters or {},
            remappings=rules,
            forget=self._forget,
        )
        self._nodes.append(node)
        return node

    def get_logger(self, name: str) -> Logger:
        """A new logger of any name, for what speaks outside of a node."""
        return Logger(name, self._sink, self._clock.now_ns)

    def node_names(self) -> list[str]:
        """Full names of the nodes, sorted."""
        return sorted(node.get_fully_qualified_name() for node in self._nodes)

    def topics(self) -> dict[str, list[str]]:
        """Topic names, sorted, each with the names of the message types in use on it."""
        return self._bus.topics()

    def count_publishers(self, topic: str) -> int:
        """How many publishers a topic has; absolute name."""
        return self._bus.count_publishers(topic)

    def count_subscribers(self, topic: str) -> int:
        """How many subscriptions a topic has; absolute name."""
        return self._bus.count_subscribers(topic)

    def unique_node_name(self, name: str, namespace: str = "/") -> str:
        """A node name that is free in a namespace: the one given, or it with a number behind."""
        taken = self.node_names()
        namespace = absolute_namespace(namespace)
        candidate, number = name, 1
        while join(namespace, candidate) in taken:
            number += 1
            candidate = f"{name}_{number}"
        return candidate

    async def settle(self) -> None:
        """Wait until every message published so far is delivered, and those that callbacks published, and so on."""
        await self._executor.settle()

    async def close(self) -> None:
        """Destroy every node and forget what was not delivered yet. Nothing of the graph runs after this."""
        for node in tuple(self._nodes):
            node.destroy_node()
        self._executor.close()

    def _forget(self, node: Node) -> None:
        if node in self._nodes:
            self._nodes.remove(node)
