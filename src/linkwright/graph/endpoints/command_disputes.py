"""Detect and log several publishers that command one robot at the same time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable
from typing import Any, Protocol

from linkwright.diagnostics import phrase, quoted_names
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.rules import NodeIdentity
from linkwright.graph.time.clock import Clock
from linkwright.process.nanoseconds import NANOSECONDS_PER_SECOND

_DISPUTE_END_S = 2.5
"""The seconds without a takeover after which a dispute ends.

If two publishers each send once a second, each of them takes over twice in this time.
"""
_REPORT_AGAIN_S = 10.0
"""The seconds without a takeover after which a dispute of the same parties is reported again."""


class DisputeDetector:
    """Detects publishers whose commands repeatedly replace each other.

    A publisher takes over when its command differs from the previous command, which another publisher sent. In a
    dispute, several publishers take over repeatedly for a while. A handover is not a dispute. Neither is a final stop
    command from another publisher, nor the second for which nav2's velocity smoother continues to publish after another
    server has begun to drive.

    Args:
        min_duration_s: how long the parties must contradict each other, in seconds.
        min_takeovers: how often each party must take over. The party that commands at the start has one already.

    Attributes:
        parties: the parties of the current or last dispute.
    """

    def __init__(self, min_duration_s: float = 3.0, min_takeovers: int = 3) -> None:
        self._min_duration_s = min_duration_s
        self._min_takeovers = min_takeovers
        self._last_command: tuple[Hashable, object, float] | None = None
        self._dispute_start_s = self._last_takeover_s = float("-inf")
        self._takeovers: Counter[Hashable] = Counter()
        self.parties: frozenset[Hashable] = frozenset()

    def record_command(self, publisher: Hashable, command: object, now_s: float) -> bool:
        """Record a command, and return whether a dispute begins.

        Args:
            publisher: the publisher of the command.
            command: the content of the command; commands with the same effect must compare equal.
            now_s: when the command arrived, in seconds.

        Returns:
            Whether a dispute begins, or gains a new party.
        """
        previous, self._last_command = self._last_command, (publisher, command, now_s)
        if previous is None or previous[0] == publisher or previous[1] == command:
            return False
        gap_s = now_s - self._last_takeover_s
        if not 0.0 <= gap_s <= _DISPUTE_END_S:
            self._dispute_start_s = previous[2] if 0.0 <= now_s - previous[2] <= _DISPUTE_END_S else now_s
            self._takeovers = Counter([previous[0]])
            if not 0.0 <= gap_s <= _REPORT_AGAIN_S:
                self.parties = frozenset()
        self._last_takeover_s = now_s
        self._takeovers[publisher] += 1
        if now_s - self._dispute_start_s < self._min_duration_s:
            return False
        parties = frozenset(party for party, count in self._takeovers.items() if count >= self._min_takeovers)
        if len(parties) < 2 or parties <= self.parties:
            return False
        self.parties = parties
        return True


class KnownEndpoints(Protocol):
    """The graph queries that `DisputeMonitor` needs."""

    def endpoints(self) -> Collection[EndpointInfo]:
        """Return all known endpoints."""

    def identities(self) -> Collection[NodeIdentity]:
        """Return all known nodes.

        If several nodes have the same name, each is included.
        """


class CommandedNode(Protocol):
    """The part of a node that `DisputeMonitor` needs."""

    @property
    def graph(self) -> KnownEndpoints:
        """The graph that the node belongs to."""

    def get_logger(self) -> Logger:
        """Return the node's logger."""

    def get_clock(self) -> Clock:
        """Return the node's clock."""


class DisputeMonitor:
    """A monitor that warns when several nodes command the same robot at the same time.

    It logs one warning, with the names of the nodes, whenever the set of these nodes changes. As in ROS and Gazebo,
    each message takes effect when it arrives. A dispute is reported, not prevented.

    Args:
        logger: logs the warnings.
        graph: finds the node that a publisher belongs to.
        now_ns: returns the current time of the clock that times commands, in nanoseconds.
    """

    def __init__(self, logger: Logger, graph: KnownEndpoints, now_ns: Callable[[], int]) -> None:
        self._logger = logger
        self._graph = graph
        self._now_ns = now_ns
        self._dispute = DisputeDetector()

    @classmethod
    def of(cls, node: CommandedNode) -> DisputeMonitor:
        """Create a monitor that uses the clock, the logger and the graph of a node."""
        return cls(node.get_logger(), node.graph, node.get_clock().now_ns)

    def record_command(self, message: Any, info: MessageInfo) -> None:
        """Record a command message.

        Of a stamped message only the twist is compared.
        """
        command = getattr(message, "twist", message)
        if self._dispute.record_command(info.publisher_gid, command, self._now_ns() / NANOSECONDS_PER_SECOND):
            self._warn()

    def _warn(self) -> None:
        """Warn of the dispute, provided that the nodes of at least two parties are known."""
        publishers = find_publishers(self._graph, self._dispute.parties)
        node_names = find_node_names(self._graph, publishers)
        if len(node_names) > 1:
            topics = sorted({publisher.name for publisher in publishers})
            warning = phrase(
                "several nodes drive the robot: {drivers} send commands on {topics}, and the robot jerks "
                "because it follows each message in turn. Stop all but one of them, remap their topics (-r "
                "{topic}:=...), or let twist_mux choose by priority",
                drivers=quoted_names(node_names),
                topics=quoted_names(topics),
                topic=topics[0],
            )
            self._logger.warning(warning)


def find_publishers(graph: KnownEndpoints, gids: Collection[Hashable]) -> list[EndpointInfo]:
    """Return the publishers with the given GIDs."""
    return [
        endpoint for endpoint in graph.endpoints() if endpoint.kind is EndpointKind.PUBLISHER and endpoint.gid in gids
    ]


def find_node_names(graph: KnownEndpoints, publishers: Iterable[EndpointInfo]) -> list[str]:
    """Return the sorted full names of the nodes that own the publishers.

    A name that two nodes share occurs twice. Publishers whose node has not been discovered are left out.
    """
    publisher_counts = Counter(publisher.node.full_name for publisher in publishers if publisher.node is not None)
    node_counts = Counter(identity.full_name for identity in graph.identities())
    return sorted((publisher_counts & (node_counts | Counter(set(publisher_counts)))).elements())
