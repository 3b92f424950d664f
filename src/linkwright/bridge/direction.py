"""One way of a bridge: what there is in the network at its source is had in the one at its target."""

from __future__ import annotations

import time
from collections import deque
from typing import NamedTuple

from linkwright.bridge.filters import NameFilter
from linkwright.bridge.mirrors import MirroredPublisher, MirroredService, Stream, Tap
from linkwright.bridge.side import Side, provision_of
from linkwright.graph.endpoints.info import EndpointInfo, EndpointKind, MessageInfo
from linkwright.graph.log.logger import Logger
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.identity import NodeIdentity
from linkwright.messages import InterfaceNotFoundError, get_interface

_KNOWN_WITHIN = 2.0
"""Seconds for which a message waits until its publisher is known."""

_MOST_EARLY = 1000

_QUIET = 3
"""How many times in a row nothing waits of what publishers said that have left, before their mirrors leave."""


class Early(NamedTuple):
    """A message whose publisher is not known yet.

    Attributes:
        until: how long it is kept, by the steady clock.
        tap: where it came from.
        gid: its publisher's.
        data: the message.
    """

    until: float
    tap: Tap
    gid: bytes
    data: bytes


class Direction:
    """Carries from a source to a target.

    A node at the source has one of its name at the target, with the publishers and the services that it has at home.
    The bridge's own node listens at the source, to a topic that somebody at the target hears, and asks its services.

    Args:
        source: where what is carried is at home.
        target: where it is carried to.
        names: which topics and services are.
        logger: for what the user is told, once for each thing.
    """

    def __init__(self, source: Side, target: Side, names: NameFilter, logger: Logger) -> None:
        self._source = source
        self._target = target
        self._names = names
        self._logger = logger
        self._nodes: dict[str, NodeHandle] = {}
        self._publishers: dict[bytes, MirroredPublisher] = {}
        self._services: dict[tuple[str, str, str], MirroredService] = {}
        self._taps: dict[Stream, Tap] = {}
        self._early: deque[Early] = deque(maxlen=_MOST_EARLY)
        self._aliases: dict[bytes, bytes] = {}
        self._leaving: dict[bytes, int] = {}
        """Publishers that have left, and how many times nothing of theirs waited since."""
        self._wanted_nodes: dict[str, NodeIdentity] = {}
        self._wanted_publishers: dict[bytes, EndpointInfo] = {}
        self._wanted_services: dict[tuple[str, str, str], EndpointInfo] = {}
        self._told: set[str] = set()

    # --- after changes -----------------------------------------------------------------------------------------------

    def withdraw(self) -> None:
        """Take away what has left, having found out what there is to be carried now."""
        self._decide()
        self._leaving = {
            gid: self._leaving.get(gid, 0) for gid in self._publishers.keys() - self._wanted_publishers.keys()
        }
        for key in self._services.keys() - self._wanted_services.keys():
            self._services.pop(key).close()
        self._let_go()

    def add(self) -> None:
        """Have at the target what is new."""
        for name, node in self._wanted_nodes.items():
            if name not in self._nodes:
                self._nodes[name] = self._target.open_node(node)
        for gid, info in self._wanted_publishers.items():
            if gid not in self._publishers:
                self._publishers[gid] = MirroredPublisher(self._node_of(info), info)
        for key, info in self._wanted_services.items():
            if key not in self._services:
                self._services[key] = MirroredService(self._node_of(info), self._source.own, info)

    def settle(self) -> bool:
        """Do what had to wait; whether nothing waits any more."""
        is_settled = not self._leaving
        self._say_early()
        self._let_go()
        for publisher in self._publishers.values():
            is_settled = publisher.settle() and is_settled
        for service in self._services.values():
            is_settled = service.settle() and is_settled
        self._tap()
        return is_settled and not self._early

    # --- inside ------------------------------------------------------------------------------------------------------

    def _let_go(self) -> None:
        """Take away publishers that have left, once what they said last was carried, and nodes that have."""
        for gid, quiet in tuple(self._leaving.items()):
            tap = self._taps.get(self._publishers[gid].stream)
            self._leaving[gid] = 0 if tap is not None and tap.has_more() else quiet + 1
            if tap is None or self._leaving[gid] >= _QUIET:
                del self._leaving[gid]
                self._publishers.pop(gid).close()
                self._aliases = {alias: meant for alias, meant in self._aliases.items() if meant != gid}
        kept = {self._publishers[gid].info.node for gid in self._leaving}
        names = self._wanted_nodes.keys() | {node.full_name for node in kept if node is not None}
        for name in self._nodes.keys() - names:
            self._nodes.pop(name).destroy()

    def _node_of(self, info: EndpointInfo) -> NodeHandle:
        assert info.node is not None
        return self._nodes[info.node.full_name]

    def _decide(self) -> None:
        """What of the source is to be had at the target."""
        seen, there = self._source.seen, self._target.seen
        self._wanted_publishers, self._wanted_services, self._wanted_nodes = {}, {}, {}
        hidden = {node.full_name for node in seen.nodes}
        for info in seen.endpoints:
            if info.node is None or not self._names.passes(info.name):
                continue
            hidden.discard(info.node.full_name)
            if provision_of(info) in there.carried:
                continue
            if info.kind is EndpointKind.PUBLISHER and self._can_publish(info):
                self._wanted_publishers[info.gid] = info
            elif info.kind is EndpointKind.SERVICE and info.name not in there.served and self._can_serve(info):
                self._wanted_services[info.node.full_name, info.name, info.type_name] = info
            else:
                continue
            self._wanted_nodes[info.node.full_name] = info.node
        for node in seen.nodes:
            if node.full_name not in hidden and node.full_name not in there.carried_nodes:
                self._wanted_nodes[node.full_name] = node

    def _can_publish(self, info: EndpointInfo) -> bool:
        if not self._target.needs_hashes or info.type_hash or _is_known(info.type_name):
            return True
        self._tell_unknown(info, f"and its publisher at {self._source.label} does not tell the hash of it")
        return False

    def _can_serve(self, info: EndpointInfo) -> bool:
        if _is_known(info.type_name):
            return True
        self._tell_unknown(info, "and requests and responses have to be read")
        return False

    def _tell_unknown(self, info: EndpointInfo, why: str) -> None:
        if info.name not in self._told:
            self._told.add(info.name)
            self._logger.warning(
                f"'{info.name}' is not carried from {self._source.label} to {self._target.label}: no package here has "
                f"its type {info.type_name}, {why}. Run the bridge where the package is found"
            )

    def _tap(self) -> None:
        """Listen to what somebody at the target hears.

        What lasts is listened to until its publishers are gone: heard once more, late joiners would get it twice.
        """
        demanded = self._target.seen.demanded
        wanted = {
            publisher.stream
            for publisher in self._publishers.values()
            if (publisher.stream in self._taps and publisher.stream.lasts)
            or (publisher.info.name in demanded and publisher.listeners())
        }
        for stream in self._taps.keys() - wanted:
            self._taps.pop(stream).close()
        for stream in wanted - self._taps.keys():
            self._taps[stream] = Tap(self._source.own, stream, self._take)

    def _take(self, tap: Tap, data: bytes, info: MessageInfo) -> None:
        """Carry a message. What bridges have said is none."""
        if not info.from_outside:
            return
        publisher = self._publisher(info.publisher_gid)
        if publisher is not None:
            if publisher.stream == tap.stream:
                self._say_early()
                publisher.say(data)
        elif info.publisher_gid not in self._source.seen.by_bridges:
            self._early.append(Early(time.monotonic() + _KNOWN_WITHIN, tap, info.publisher_gid, data))

    def _say_early(self) -> None:
        """Carry what came before its publisher was known."""
        now = time.monotonic()
        for _ in range(len(self._early)):
            early = self._early.popleft()
            publisher = self._publisher(early.gid)
            if publisher is None and now < early.until:
                self._early.append(early)
                continue
            publisher = publisher or self._any_of(early)
            if publisher is not None and publisher.stream == early.tap.stream:
                publisher.say(early.data)

    def _publisher(self, gid: bytes) -> MirroredPublisher | None:
        return self._publishers.get(self._aliases.get(gid, gid))

    def _any_of(self, early: Early) -> MirroredPublisher | None:
        """Who speaks for a publisher whose messages have another gid than is told of it, as some have over Zenoh."""
        for gid, publisher in self._publishers.items():
            if publisher.stream == early.tap.stream:
                self._aliases[early.gid] = gid
                return publisher
        return None


def _is_known(type_name: str) -> bool:
    try:
        get_interface(type_name)
    except InterfaceNotFoundError:
        return False
    return True
