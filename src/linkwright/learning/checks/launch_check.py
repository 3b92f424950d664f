"""Checks of a launch file of the learner's package, and of the graph that it starts."""

from __future__ import annotations

import asyncio
import io
import math
import re
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import wait
from contextlib import suppress
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from linkwright.diagnostics import Diagnostic, LinkwrightError, Phrase, nearest, phrase, quoted_names
from linkwright.graph.faults import InvalidHandleError
from linkwright.learning.checks.findings import describe_finding
from linkwright.learning.checks.not_yet import NotYet
from linkwright.learning.checks.rviz_arguments import require_rviz_configuration
from linkwright.learning.local_text import LocalText
from linkwright.process.patience import PatientClock

if TYPE_CHECKING:
    from typing_extensions import Self

    from linkwright.graph import Node, QoSProfile
    from linkwright.graph.transforms.waiting import Buffer
    from linkwright.launch.engine.session import LaunchSession
    from linkwright.packages import PackageFinder

T = TypeVar("T")

_WAIT_S = 15.0
"""The seconds that a condition may take. Processes start slowly on a loaded machine."""

_QUIET_S = 1.2
"""The seconds without a new node or topic after which nothing more is expected of the nodes of this process."""

_QUIET_WITH_PROCESSES_S = 6.0
"""The same, if the launch has started the learner's programs, each in a process of its own."""

_POLL_PERIOD_S = 0.02
_GRAPH_PERIOD_S = 0.1
"""The time between two looks at all nodes and topics, which take longer than most conditions."""

_NODE_NAME = "lesson_check"
_PROCESS_LINE = re.compile(r"^\[([^\]\s]+-\d+)\] (.*)$")
_DEATH_LINE = re.compile(r"^\[ERROR\] \[([^\]\s]+)-\d+\]: process has died")
_LOG_PREFIX = re.compile(r"^\[[^\]]+\] \[\w+\] \[[\d.]+\] \[([^\]]+)\]: ")


class LaunchCheck:
    """A launch of the learner's package that runs inside a ``with`` block.

    Linkwright's own nodes run in this process, the learner's programs in processes of their own.

    Args:
        package: the name of the package.
        file: the name of the launch file.
        arguments: the launch arguments.
        finder: the finder of the workspace's packages.
    """

    def __init__(self, package: str, file: str, arguments: Mapping[str, str], finder: PackageFinder) -> None:
        self._package = package
        self._file = file
        self._arguments = arguments
        self._finder = finder
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._output = io.StringIO()
        self._findings: list[Diagnostic] = []
        self._session: LaunchSession | None = None
        self._run: Any = None
        self._node: Node | None = None
        self._buffer: Buffer | None = None

    def __enter__(self) -> Self:
        from linkwright import standins

        standins.activate()
        self._thread.start()
        try:
            self._run = asyncio.run_coroutine_threadsafe(self._launch(), self._loop)
            self._wait_until(
                lambda: self._node is not None, phrase("the launch file '{file}' did not start", file=self._file)
            )
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    async def _launch(self) -> bool:
        from linkwright.hosting.signals import own_environment
        from linkwright.hosting.xacro_calls import Descriptions, use_descriptions
        from linkwright.launch.engine.session import LaunchSession
        from linkwright.launch.engine.supervisor import SessionOptions
        from linkwright.launch.frontend.launch_file import load_launch_file
        from linkwright.launch.model.context import LaunchContext
        from linkwright.launch.target import LaunchTarget
        from linkwright.learning.checks.launch_findings import CheckedLog

        path = LaunchTarget(self._file, self._package).resolve(self._finder)
        with own_environment(self._finder), use_descriptions(Descriptions(self._finder)):
            description = load_launch_file(path)
            argv = [f"{name}:={value}" for name, value in self._arguments.items()]
            context = LaunchContext(argv=argv, noninteractive=True)
            context.launch_configurations.update(self._arguments)
            options = SessionOptions("127.0.0.1", None, False, self._file, history=0)
            self._session = LaunchSession(self._finder, options, CheckedLog(self._output, self._findings), context)
            self._node = self._session.host.graph.create_node(_NODE_NAME)
            self._session.host.join_network_soon()
            launch_locals = {"current_launch_file_path": str(path), "current_launch_file_directory": str(path.parent)}
            return await self._session.run(description, launch_locals)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        from linkwright.launch.model import events

        session = self._session
        if session is not None and not self._run.done():
            self._loop.call_soon_threadsafe(session.context.emit_event_sync, events.Shutdown(reason="the check ended"))
            with suppress(Exception):
                self._run.result(_WAIT_S)
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(_WAIT_S)
        if not self._thread.is_alive():
            self._loop.close()

    def expect_rviz(self, path: Path) -> None:
        """Require the launch to open RViz with a configuration.

        Args:
            path: the file of the configuration.

        Raises:
            NotYet: RViz did not start in time, or opens another configuration.
        """
        self.expect_node("/rviz2")
        self._wait_until(
            lambda: bool(self._list_viewer_arguments()),
            phrase("the node '/rviz2' is another program than RViz; start 'rviz2' of the package 'rviz2'"),
        )
        require_rviz_configuration(self._list_viewer_arguments()[0], path)

    def _list_viewer_arguments(self) -> list[list[str]]:
        return [] if self._session is None else self._session.host.viewer_arguments

    def expect_distinct_nodes(self) -> None:
        """Require the nodes that run now to have different names.

        Raises:
            NotYet: two nodes have the same name.
        """
        names = self.nodes()
        if repeated := sorted(name for name in set(names) if names.count(name) > 1):
            raise NotYet(phrase("two nodes have the name '{name}'; each node needs its own name", name=repeated[0]))

    def expect_node(self, name: str) -> None:
        """Require a node to run.

        Args:
            name: the full name, such as ``/robot_state_publisher``.

        Raises:
            NotYet: the node did not start in time.
        """
        self._wait_until(lambda: name in self.nodes(), lambda: self._explain_missing_node(name))

    def nodes(self) -> list[str]:
        """Return the full names of the running nodes."""
        return self._call(self._list_nodes)

    def _list_nodes(self) -> list[str]:
        return [
            f"{namespace.rstrip('/')}/{name}"
            for name, namespace in self._checking_node.get_node_names_and_namespaces()
            if name != _NODE_NAME
        ]

    def subscribers(self, topic: str) -> list[str]:
        """Return the full names of the nodes that currently subscribe to a topic."""
        infos = self._call(lambda: self._checking_node.get_subscriptions_info_by_topic(topic))
        nodes = {(info.node_namespace.rstrip("/"), info.node_name) for info in infos}
        return sorted(f"{namespace}/{name}" for namespace, name in nodes if name != _NODE_NAME)

    def wait_for_parameter(self, node: str, name: str) -> Any:
        """Return the value of a node's parameter as soon as the node runs and has declared it.

        Args:
            node: the full name of the node.
            name: the name of the parameter.

        Raises:
            NotYet: the node did not start in time, or has no such parameter.
        """
        from linkwright.graph.parameters.client import AsyncParameterClient
        from linkwright.graph.parameters.parameter import parameter_value_to_python

        self.expect_node(node)
        client = self._call(lambda: AsyncParameterClient(self._checking_node, node))
        pending: list[Any] = []
        messages: list[Any] = []

        def has_value() -> bool:
            """Ask again after each response, because a node starts before it declares its parameters."""
            if pending and pending[0].ended():
                messages[:] = [value for value in pending.pop().result().values if value.type]
            if not pending and not messages and self._call(client.services_are_ready):
                pending.append(self._call(lambda: client.get_parameters([name])))
            return bool(messages)

        try:
            self._wait_until(has_value, phrase("the node '{node}' has no parameter '{name}'", node=node, name=name))
        finally:
            self._call(client.destroy)
        return parameter_value_to_python(messages[0])

    def wait_for_message(self, topic: str, accept: Callable[[Any], bool] | None = None) -> Any:
        """Return the next message of a topic.

        Args:
            topic: the full name of the topic.
            accept: returns whether the wait ends with a message; None to end it with any message.

        Raises:
            NotYet: no node publishes the topic, or no such message came in time.
        """
        from linkwright.messages import get_message

        node = self._checking_node
        self._wait_until(lambda: node.count_publishers(topic) > 0, lambda: self._explain_missing_topic(topic))
        received: list[Any] = []

        def subscribe() -> None:
            types = dict(node.get_topic_names_and_types())[topic]
            node.create_subscription(get_message(types[0]), topic, received.append, _choose_profile(node, topic))

        self._call(subscribe)
        matching: list[Any] = []

        def has_match() -> bool:
            matching.extend(message for message in received if accept is None or accept(message))
            received.clear()
            return bool(matching)

        self._wait_until(has_match, phrase("no message with the expected values arrived on '{topic}'", topic=topic))
        return matching[0]

    def expect_transform(
        self, frame: str, child: str, position: Sequence[float] | None = None, *, tolerance: float = 0.005
    ) -> None:
        """Require a transform between two frames.

        Args:
            frame: the frame in which the position is given.
            child: the frame whose position is expected.
            position: x, y and z in m; None for any.
            tolerance: the greatest accepted distance, in m.

        Raises:
            NotYet: the transform does not become available in time, or the position differs.
        """
        found: list[Sequence[float]] = []

        def has_transform() -> bool:
            found[:] = self._call(lambda: self._find_translations(frame, child))
            return bool(found) and (position is None or math.dist(found[0], position) <= tolerance)

        def problem() -> Phrase:
            if not found or position is None:
                return phrase("there is no transform from '{frame}' to '{child}'", frame=frame, child=child)
            return phrase(
                "'{child}' is at {actual} in '{frame}', but should be at {expected}",
                child=child,
                frame=frame,
                actual=" ".join(f"{value:g}" for value in np.round(found[0], 4)),
                expected=" ".join(f"{value:g}" for value in position),
            )

        self._wait_until(has_transform, problem)

    @property
    def _checking_node(self) -> Node:
        assert self._node is not None, "the launch has started"
        return self._node

    def _find_translations(self, frame: str, child: str) -> list[Sequence[float]]:
        from linkwright.graph import Time
        from linkwright.graph.transforms.errors import TransformException
        from linkwright.graph.transforms.listener import TransformListener
        from linkwright.graph.transforms.waiting import Buffer

        if self._buffer is None:
            self._buffer = Buffer()
            TransformListener(self._buffer, self._checking_node)
        try:
            translation = self._buffer.lookup_transform(frame, child, Time()).transform.translation
        except TransformException:
            return []
        return [(translation.x, translation.y, translation.z)]

    def _list_topics(self) -> list[str]:
        return [name for name, _ in self._checking_node.get_topic_names_and_types()]

    def _call(self, function: Callable[[], T]) -> T:
        """Call a function on the event loop of the launch.

        Raises:
            TimeoutError: the loop did not call it in time; the load of the machine does not count.
        """

        async def call() -> T:
            return function()

        future = asyncio.run_coroutine_threadsafe(call(), self._loop)
        if not wait([future], _POLL_PERIOD_S).done:
            clock = PatientClock()
            while not wait([future], _POLL_PERIOD_S).done:
                if clock.read() > _WAIT_S:
                    raise TimeoutError
        return future.result()

    def _wait_until(self, condition: Callable[[], bool], problem: Phrase | Callable[[], Phrase]) -> None:
        """Wait for a condition.

        Raises:
            NotYet: the launch failed, or the condition did not become true in time.
        """
        clock = PatientClock()
        next_look, last_change, last_graph = 0.0, 0.0, self._list_nodes_and_topics()
        while not self._is_true(condition):
            time_s = clock.read()
            if time_s >= next_look:
                next_look = time_s + _GRAPH_PERIOD_S
                graph = self._list_nodes_and_topics()
                if graph != last_graph:
                    last_change, last_graph = time_s, graph
                if time_s > min(_WAIT_S, last_change + self._get_quiet_seconds(graph[0])):
                    raise NotYet(problem() if callable(problem) else problem)
            time.sleep(_POLL_PERIOD_S)

    def _is_true(self, condition: Callable[[], bool]) -> bool:
        """Return whether a condition of the graph is true.

        Raises:
            NotYet: the launch has ended, and its nodes with it.
        """
        try:
            is_true = condition()
        except InvalidHandleError:
            is_true = False
        if not is_true and self._run.done():
            raise NotYet(self._explain_end())
        return is_true

    def _list_nodes_and_topics(self) -> tuple[Sequence[str], Sequence[str]]:
        """Return the nodes and topics of the graph; both are empty before the launch starts."""
        if self._node is None or self._run.done():
            return [], []
        return self._call(lambda: (self._list_nodes(), self._list_topics()))

    def _get_quiet_seconds(self, nodes: Sequence[str]) -> float:
        """Return the seconds without a change after which nothing more is expected while some nodes run."""
        if self._session is None or not nodes:
            return _WAIT_S
        return _QUIET_WITH_PROCESSES_S if self._session.processes.names else _QUIET_S

    def _explain_end(self) -> Phrase:
        """Return the reason why the launch ended before the check."""
        try:
            self._run.result()
        except LinkwrightError as error:
            return self._describe_located(error.diagnostics[0])
        if problem := self._find_first_problem():
            return problem
        return phrase(
            "the launch of '{file}' ended by itself: it starts no node that keeps running; are the nodes in the list "
            "of LaunchDescription([...])?",
            file=self._file,
        )

    def _describe_located(self, finding: Diagnostic) -> Phrase:
        """Return a finding with the name of the launch file, unless it names another file."""
        described = describe_finding(finding)
        return described if finding.span else phrase("{file}: {message}", file=self._file, message=described)

    def problems(self) -> list[LocalText]:
        """Return the problems of the launch: its findings, then the errors of its nodes."""
        return [LocalText.from_phrase(problem) for problem in self._list_problems()]

    def _list_problems(self) -> list[Phrase]:
        errors = [phrase("{file}: {message}", file=self._file, message=error) for error in self._list_error_lines()]
        return [*map(self._describe_located, self._findings), *errors]

    def _find_first_problem(self) -> Phrase | None:
        """Return the first problem that the launch has reported, or None."""
        return next(iter(self._list_problems()), None)

    def _explain_missing_topic(self, topic: str) -> Phrase:
        """Return the message for a topic without publishers, with the first error of the launch."""
        topics = self._call(self._list_topics)
        if problem := self._find_first_problem():
            return phrase("no node publishes '{topic}'; the launch says: {message}", topic=topic, message=problem)
        published = [name for name in topics if self._call(partial(self._checking_node.count_publishers, name))]
        name = topic.rpartition("/")[2]
        similar = [other for other in published if other.rpartition("/")[2] == name]
        if not similar and topic not in topics:
            similar = list(nearest(topic, topics, 1))
        if similar:
            return phrase("there is no topic '{name}'; there is '{similar}'", name=topic, similar=similar[0])
        return phrase(
            "no node publishes '{topic}'; the running nodes are {nodes}",
            topic=topic,
            nodes=quoted_names(sorted(self.nodes())) or "-",
        )

    def _explain_missing_node(self, name: str) -> Phrase:
        """Return the message for a missing node.

        It names a similar node, the launch's problem, or the running nodes.
        """
        nodes = self.nodes()
        if similar := nearest(name, nodes, 1):
            return phrase("there is no node '{name}'; there is '{similar}'", name=name, similar=similar[0])
        if problem := self._find_first_problem():
            return phrase("there is no node '{name}'; the launch says: {message}", name=name, message=problem)
        other_nodes = quoted_names(sorted(nodes)) or "-"
        return phrase("there is no node '{name}'; the running nodes are {nodes}", name=name, nodes=other_nodes)

    def _list_error_lines(self) -> list[str]:
        """Return the lines of the launch's output that report errors.

        Of the traceback of a process that has died, only the last line is returned.
        """
        errors: list[str] = []
        last_lines: dict[str, str] = {}
        for line in self._output.getvalue().splitlines():
            if match := _PROCESS_LINE.match(line):
                if not match[2].strip() or match[2].startswith(" "):
                    continue
                last_lines[match[1].rpartition("-")[0]] = match[2]
            death = _DEATH_LINE.match(line)
            if death and death[1] in last_lines:
                errors.append(f"{death[1]}: {last_lines[death[1]]}")
            elif any(name in line.casefold() for name in ("error", "fatal")):
                errors.append(_LOG_PREFIX.sub(r"\1: ", line))
        return errors


def _choose_profile(node: Node, topic: str) -> QoSProfile:
    """Return a profile with which a subscription receives a topic's latched messages, too."""
    from linkwright.graph import DurabilityPolicy, QoSProfile, ReliabilityPolicy

    offered = [info.qos_profile for info in node.get_publishers_info_by_topic(topic)]
    profile = QoSProfile(depth=10)
    if any(offered_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL for offered_profile in offered):
        profile.durability = DurabilityPolicy.TRANSIENT_LOCAL
    if any(offered_profile.reliability == ReliabilityPolicy.BEST_EFFORT for offered_profile in offered):
        profile.reliability = ReliabilityPolicy.BEST_EFFORT
    return profile
