"""One direction of a bridge: mirrors the endpoints of the source network in the target network."""

from __future__ import annotations

import time
from collections import deque
from typing import NamedTuple

from linkwright.bridge.filters import NameFilter
from linkwright.bridge.mirrors import MATCHED_WITHIN, MirroredPublisher, MirroredService, Tap
from linkwright.bridge.side import Side, provision_of
from linkwright.bridge.streams import Stream, awaited_streams, can_receive, hash_of, stream_of
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo, Presence
from linkwright.graph.log.logger import Logger
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity

_KNOWN_WITHIN = 2.0
"""Seconds for which a message waits until its publisher is known."""

_MOST_EARLY = 1000

_SHOWN_WITHIN = 1.0
"""Seconds within which a subscription is shown that hears no publisher there is."""

_QUIET = 25
"""How many checks in a row must find no message of publishers that have left before their mirrors leave.

A check comes every 20 ms: on a busy machine the thread that takes messages from DDS may pause for a tenth of a second.
"""


class Early(NamedTuple):
    """A message whose publisher has not been discovered yet.

    Attributes:
        until: the time on the monotonic clock at which the message is dropped, seconds.
        tap: the tap that received the message.
        gid: the GID of the message's publisher.
        data: the message as CDR.
    """

    until: float
    tap: Tap
    gid: bytes
    data: bytes


class Direction:
    """Carries messages, requests and responses from a source network to a target network.

    Each node in the source has a node with the same name in the target, with the same publishers and services. The
    subscriptions and clients of the source are only announced in the target, see `Presence`. The bridge's own node
    subscribes in the source to topics that have subscriptions in the target, and calls the services of the source.

    Args:
        source: the network that the traffic comes from.
        target: the network that the traffic is carried to.
        names: selects the topics and services to carry.
        logger: logs a warning, once for each topic or service that cannot be carried.
    """

    def __init__(self, source: Side, target: Side, names: NameFilter, logger: Logger) -> None:
        self._source = source
        self._target = target
        self._names = names
        self._logger = logger
        self._nodes: dict[str, NodeHandle] = {}
        self._publishers: dict[bytes, MirroredPublisher] = {}
        self._services: dict[tuple[str, str, str], MirroredService] = {}
        self._presences: dict[bytes, Presence] = {}
        self._taps: dict[Stream, Tap] = {}
        self._awaited: set[Stream] = set()
        """The streams of publishers that may appear and that a subscription at the target hears."""
        self._early: deque[Early] = deque(maxlen=_MOST_EARLY)
        self._aliases: dict[bytes, bytes] = {}
        self._leaving: dict[bytes, int] = {}
        """Publishers that have left, and how many times in a row no message of theirs arrived or waited."""
        self._wanted_nodes: dict[str, NodeIdentity] = {}
        self._wanted_publishers: dict[bytes, EndpointInfo] = {}
        self._wanted_services: dict[tuple[str, str, str], EndpointInfo] = {}
        self._wanted_presences: dict[bytes, EndpointInfo] = {}
        self._unseen: dict[bytes, float] = {}
        """When presences that are not shown yet are, by the steady clock."""
        self._warned: set[str] = set()

    # --- after changes -----------------------------------------------------------------------------------------------

    def withdraw(self) -> None:
        """Decide which endpoints to mirror now, and remove the mirrors of endpoints that have left."""
        self._select_endpoints()
        self._leaving = {
            gid: self._leaving.get(gid, 0) for gid in self._publishers.keys() - self._wanted_publishers.keys()
        }
        for key in self._services.keys() - self._wanted_services.keys():
            self._services.pop(key).close()
        for gid in self._presences.keys() - self._wanted_presences.keys():
            self._presences.pop(gid).destroy()
        self._remove_departed()

    def add(self) -> None:
        """Mirror new nodes, publishers and services in the target."""
        for name, node in self._wanted_nodes.items():
            if name not in self._nodes:
                self._nodes[name] = self._target.open_node(node)
        for gid, info in self._wanted_publishers.items():
            if gid not in self._publishers:
                stream = stream_of(info, keyed=self._source.needs_hashes)
                self._publishers[gid] = MirroredPublisher(self._node_of(info), info, stream)
            if self._publishers[gid].waits:
                self._publishers[gid].expects_listeners = self._is_expected(info)
        for key, info in self._wanted_services.items():
            if key not in self._services:
                self._services[key] = MirroredService(self._node_of(info), self._source.own, info)

    def show(self, back: Direction) -> bool:
        """Announce the source's subscriptions and clients in the target; return whether all are announced.

        Publishers in the target may send a message as soon as they discover a subscription. The bridge must therefore
        have subscribed there by then.

        Args:
            back: the opposite direction, which subscribes in the target.
        """
        now = time.monotonic()
        for gid in self._unseen.keys() - self._wanted_presences.keys():
            del self._unseen[gid]
        for gid in self._wanted_presences.keys() - self._presences.keys():
            info = self._wanted_presences[gid]
            until = self._unseen.setdefault(gid, now + (MATCHED_WITHIN if back.reaches(info) else _SHOWN_WITHIN))
            if info.kind is EndpointKind.CLIENT or now >= until or back.hears(info.name):
                node = self._node_of(info)
                self._presences[gid] = node.add(Presence(node, info))
                del self._unseen[gid]
        return not self._unseen

    def hears(self, name: str) -> bool:
        """Return whether the bridge subscribes to a topic in the source."""
        return any(stream.name == name for stream in self._taps)

    def reaches(self, subscription: EndpointInfo) -> bool:
        """Return whether a mirrored publisher matches a subscription in the target."""
        return any(
            publisher.info.name == subscription.name
            and can_receive(subscription, publisher.info, keyed=self._target.needs_hashes)
            for publisher in self._publishers.values()
        )

    def settle(self) -> bool:
        """Continue pending work (messages, removals, matching), and return whether none is left."""
        is_settled = not self._leaving
        self._publish_early()
        self._remove_departed()
        for publisher in self._publishers.values():
            is_settled = publisher.settle() and is_settled
        for service in self._services.values():
            is_settled = service.settle() and is_settled
        self._tap()
        return is_settled and not self._early

    def close(self) -> None:
        """Close the mirrored publishers."""
        for publisher in self._publishers.values():
            publisher.close()

    # --- internals ---------------------------------------------------------------------------------------------------

    def _remove_departed(self) -> None:
        """Remove the mirrors of publishers that have left, and nodes without mirrors.

        A mirror is removed only when the last messages of its publisher have been carried.
        """
        for gid, quiet in tuple(self._leaving.items()):
            publisher = self._publishers[gid]
            tap = self._taps.get(publisher.stream)
            waits = publisher.has_more() or (tap is not None and tap.has_more())
            self._leaving[gid] = 0 if waits else quiet + 1
            if (tap is None and not waits) or self._leaving[gid] >= _QUIET:
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

    def _select_endpoints(self) -> None:
        """Decide which endpoints and nodes of the source are mirrored, and which streams are awaited."""
        seen, there = self._source.seen, self._target.seen
        self._wanted_publishers, self._wanted_services, self._wanted_nodes = {}, {}, {}
        self._wanted_presences = {}
        hidden = {node.full_name for node in seen.nodes}
        for info in seen.endpoints:
            if info.node is None or not self._names.passes(info.name):
                continue
            hidden.discard(info.node.full_name)
            if provision_of(info) in there.carried:
                continue
            if info.kind is EndpointKind.PUBLISHER and self._can_carry(info):
                self._wanted_publishers[info.gid] = info
            elif info.kind is EndpointKind.SERVICE and info.name not in there.served and self._can_carry(info):
                self._wanted_services[info.node.full_name, info.name, info.type_name] = info
            elif info.kind in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT):
                self._wanted_presences[info.gid] = info
            else:
                continue
            self._wanted_nodes[info.node.full_name] = info.node
        for node in seen.nodes:
            if node.full_name not in hidden and node.full_name not in there.carried_nodes:
                self._wanted_nodes[node.full_name] = node
        self._awaited = {
            stream
            for info in there.endpoints
            if info.kind is EndpointKind.SUBSCRIPTION
            and self._names.passes(info.name)
            and provision_of(info) not in seen.carried
            for stream in awaited_streams(info, keyed=self._source.needs_hashes)
        }

    def _is_expected(self, publisher: EndpointInfo) -> bool:
        """Return whether a subscription in the target can receive from the mirror of a publisher."""
        demanding = self._target.seen.demanded.get(publisher.name, ())
        return any(can_receive(endpoint, publisher, keyed=self._target.needs_hashes) for endpoint in demanding)

    def _can_carry(self, info: EndpointInfo) -> bool:
        """Return whether a topic or service with this type can be created in the target; if not, warn once."""
        if not self._target.needs_hashes or hash_of(info):
            return True
        if info.name not in self._warned:
            self._warned.add(info.name)
            whose = "publisher" if info.kind is EndpointKind.PUBLISHER else "server"
            self._logger.warning(
                f"'{info.name}' is not carried from {self._source.label} to {self._target.label}: no package here has "
                f"its type {info.type_name}, and its {whose} at {self._source.label} does not announce its hash. Run "
                "the bridge where the package is found"
            )
        return False

    def _tap(self) -> None:
        """Subscribe to the streams that have subscriptions in the target, and unsubscribe from others.

        A stream with history is subscribed to until its publishers have left: if the bridge subscribed again, late
        joiners would receive the history twice. While a topic has no publisher, and while its first publisher
        is being matched, every possible stream is subscribed to.
        """
        demanded = self._target.seen.demanded
        wanted = {
            publisher.stream
            for publisher in self._publishers.values()
            if (publisher.stream in self._taps and publisher.stream.lasts)
            or (publisher.info.name in demanded and publisher.listeners())
        }
        met = {publisher.info.name for publisher in self._publishers.values() if not publisher.waits}
        wanted |= {stream for stream in self._awaited if stream.name not in met}
        for stream in self._taps.keys() - wanted:
            self._taps.pop(stream).close()
        # A publisher may send as soon as it discovers one of several subscriptions, so the subscription that matches
        # most
        # publishers is created first.
        for stream in sorted(wanted - self._taps.keys(), key=lambda stream: (stream.history, stream.reliability)):
            self._taps[stream] = Tap(self._source.own, stream, self._carry)

    def _carry(self, tap: Tap, data: bytes, info: MessageInfo) -> None:
        """Publish a message in the target, unless a bridge has published it in the source."""
        if not info.from_outside:
            return
        publisher = self._publisher(info.publisher_gid)
        if publisher is not None:
            if publisher.stream == tap.stream:
                self._publish_early()
                publisher.put(data)
                if publisher.info.gid in self._leaving:
                    self._leaving[publisher.info.gid] = 0
        elif info.publisher_gid not in self._source.seen.by_bridges:
            self._early.append(Early(time.monotonic() + _KNOWN_WITHIN, tap, info.publisher_gid, data))

    def _publish_early(self) -> None:
        """Publish the queued messages whose publisher has been discovered in the meantime."""
        now = time.monotonic()
        for _ in range(len(self._early)):
            early = self._early.popleft()
            if early.tap is not self._taps.get(early.tap.stream):
                continue  # another bridge now carries the stream
            publisher = self._publisher(early.gid)
            if publisher is None and now < early.until:
                self._early.append(early)
                continue
            publisher = publisher or self._any_of(early)
            if publisher is not None and publisher.stream == early.tap.stream:
                publisher.put(early.data)

    def _publisher(self, gid: bytes) -> MirroredPublisher | None:
        return self._publishers.get(self._aliases.get(gid, gid))

    def _any_of(self, early: Early) -> MirroredPublisher | None:
        """Return any mirror of the message's stream, or None.

        Over Zenoh, the messages of some programs have a GID that no publisher has announced.
        """
        for gid, publisher in self._publishers.items():
            if publisher.stream == early.tap.stream:
                self._aliases[early.gid] = gid
                return publisher
        return None
