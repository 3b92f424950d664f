"""Detects several publishers that command one thing at the same time, and warns of them in the log."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable
from typing import Any, Protocol

from linkwright.diagnostics import phrase, quoted_names
from linkwright.graph.endpoints.info import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.log.logger import Logger
from linkwright.graph.names.identity import NodeIdentity
from linkwright.graph.time.clock import Clock

_GAP_S = 2.5
"""A dispute is over when nobody has taken over for so long: of two that send once a second each does twice in that."""
_QUIET_S = 10.0
"""Who disputed is told again after so long without."""
_NANOSECONDS = 1e9


class Dispute:
    """Detects publishers whose commands replace each other again and again.

    A command takes over when it differs from the one before, which somebody else sent. It is a dispute when several
    have taken over again and again for a while. So a handover is none, nor is a stop that somebody sends at the end,
    nor the second for which nav2's velocity smoother goes on when another server begins to drive.

    Args:
        lasting_s: for how long they must have contradicted each other, in seconds.
        times: how often each must have taken over; who began counts once for that.

    Attributes:
        parties: who disputes, or did last.
    """

    def __init__(self, lasting_s: float = 3.0, times: int = 3) -> None:
        self._lasting_s = lasting_s
        self._times = times
        self._last: tuple[Hashable, object, float] | None = None
        self._since = self._taken_over = float("-inf")
        self._took: Counter[Hashable] = Counter()
        self.parties: frozenset[Hashable] = frozenset()

    def hear(self, who: Hashable, command: object, now_s: float) -> bool:
        """Note a command.

        Args:
            who: who sent it.
            command: what it says; equal where two say the same.
            now_s: when it came, in seconds.

        Returns:
            Whether there is a dispute that was not there before, or has a new party.
        """
        before, self._last = self._last, (who, command, now_s)
        if before is None or before[0] == who or before[1] == command:
            return False
        gap = now_s - self._taken_over
        if not 0.0 <= gap <= _GAP_S:
            self._since = before[2] if 0.0 <= now_s - before[2] <= _GAP_S else now_s
            self._took = Counter([before[0]])
            if not 0.0 <= gap <= _QUIET_S:
                self.parties = frozenset()
        self._taken_over = now_s
        self._took[who] += 1
        if now_s - self._since < self._lasting_s:
            return False
        parties = frozenset(each for each, times in self._took.items() if times >= self._times)
        if len(parties) < 2 or parties <= self.parties:
            return False
        self.parties = parties
        return True


class KnownEndpoints(Protocol):
    """The part of the graph that `DriverWatch` asks."""

    def endpoints(self) -> Collection[EndpointInfo]:
        """All endpoints that are known."""

    def identities(self) -> Collection[NodeIdentity]:
        """All nodes that are known, each as often as there are nodes of its name."""


class CommandedNode(Protocol):
    """The part of a node that `DriverWatch` needs."""

    @property
    def graph(self) -> KnownEndpoints:
        """The graph that it is in."""

    def get_logger(self) -> Logger:
        """Its logger."""

    def get_clock(self) -> Clock:
        """Its clock."""


class DriverWatch:
    """Warns, once for each change, where several nodes command one thing at the same time, and names them.

    Each of their messages is obeyed as it comes, as ROS and Gazebo do: it is told of and not prevented.

    Args:
        logger: which warns.
        graph: tells whose publishers are.
        now_ns: the time that the commands go by, in nanoseconds.
    """

    def __init__(self, logger: Logger, graph: KnownEndpoints, now_ns: Callable[[], int]) -> None:
        self._logger = logger
        self._graph = graph
        self._now_ns = now_ns
        self._dispute = Dispute()

    @classmethod
    def of(cls, node: CommandedNode) -> DriverWatch:
        """A watch that uses the clock of a node and warns in its log."""
        return cls(node.get_logger(), node.graph, node.get_clock().now_ns)

    def hear(self, message: Any, info: MessageInfo) -> None:
        """Note a message; of one with a header what counts is its twist."""
        command = getattr(message, "twist", message)
        if self._dispute.hear(info.publisher_gid, command, self._now_ns() / _NANOSECONDS):
            self._tell()

    def _tell(self) -> None:
        """Warn, unless it is not known of two of them who they are."""
        publishers = publishers_of(self._graph, self._dispute.parties)
        drivers = drivers_of(self._graph, publishers)
        if len(drivers) > 1:
            topics = sorted({publisher.name for publisher in publishers})
            told = phrase(
                "two drivers at once: {drivers} command by {topics}, and each message is obeyed in turn: what moves "
                "jerks between them. End one of them, remap its topic (-r {topic}:=...), or let twist_mux choose by "
                "priority",
                drivers=quoted_names(drivers),
                topics=quoted_names(topics),
                topic=topics[0],
            )
            self._logger.warning(told)


def publishers_of(graph: KnownEndpoints, gids: Collection[Hashable]) -> list[EndpointInfo]:
    """The publishers with these identifiers."""
    return [
        endpoint for endpoint in graph.endpoints() if endpoint.kind is EndpointKind.PUBLISHER and endpoint.gid in gids
    ]


def drivers_of(graph: KnownEndpoints, publishers: Iterable[EndpointInfo]) -> list[str]:
    """Full names of the nodes that publishers belong to, sorted; one twice where two nodes have it.

    Publishers of no node, and those whose node is not known yet, are left out.
    """
    publishing = Counter(publisher.node.full_name for publisher in publishers if publisher.node is not None)
    present = Counter(identity.full_name for identity in graph.identities())
    return sorted((publishing & (present | Counter(set(publishing)))).elements())
