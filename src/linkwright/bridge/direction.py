"""One direction of a bridge: mirrors the source network's endpoints in the target network."""

from __future__ import annotations

import time
from collections import deque
from typing import NamedTuple

from linkwright.bridge.bridged_network import BridgedNetwork, make_endpoint_key
from linkwright.bridge.filters import NameFilter
from linkwright.bridge.mirrors import MATCH_TIMEOUT_S, MirroredPublisher, MirroredService, Tap
from linkwright.bridge.streams import Stream, can_receive, find_awaited_streams, find_type_hash, get_stream
from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind, MessageInfo, Presence
from linkwright.graph.log.logger import Logger
from linkwright.graph.loop.node_handle import NodeHandle
from linkwright.graph.names.rules import NodeIdentity

_DISCOVERY_TIMEOUT_S = 2.0
"""Seconds for which a message waits until its publisher is discovered."""

_MAX_EARLY = 1000

_ANNOUNCEMENT_DELAY_S = 1.0
"""Seconds after which a subscription without a known publisher is announced."""

_QUIET = 25
"""The number of consecutive checks without a message before a departed publisher's mirror is removed.

Checks run every 20 ms. On a busy machine, the thread that takes messages from DDS may pause for a tenth of a second.
"""


class EarlyMessage(NamedTuple):
    """A message whose publisher has not been discovered yet.

    Attributes:
        expires_at: the time on the monotonic clock at which the message is dropped, in seconds.
        tap: the tap that received the message.
        gid: the GID of the message's publisher.
        data: the message as CDR.
    """

    expires_at: float
    tap: Tap
    gid: bytes
    data: bytes


class Direction:
    """The part of a bridge that carries traffic from a source network to a target network.

    Each node in the source has a node with the same name in the target, with the same publishers and services. The
    subscriptions and clients of the source are only announced in the target, see `Presence`. The bridge's own node
    subscribes in the source to topics that have subscriptions in the target, and calls the services of the source.

    Args:
        source: the network that the traffic comes from.
        target: the network that the traffic is carried to.
        names: selects the topics and services to carry.
        logger: logs a warning, once for each topic or service that cannot be carried.
    """

    def __init__(self, source: BridgedNetwork, target: BridgedNetwork, names: NameFilter, logger: Logger) -> None:
        self._source = source
        self._target = target
        self._names = names
        self._logger = logger
        self._nodes: dict[str, NodeHandle] = {}
        self._publishers: dict[bytes, MirroredPublisher] = {}
        self._services: dict[tuple[str, str, str], MirroredService] = {}
        self._presences: dict[bytes, Presence] = {}
        self._taps: dict[Stream, Tap] = {}
        self._awaited_streams: set[Stream] = set()
        """The streams that subscriptions in the target would receive if publishers appeared in the source."""
        self._early_messages: deque[EarlyMessage] = deque(maxlen=_MAX_EARLY)
        self._aliases: dict[bytes, bytes] = {}
        self._departed_publishers: dict[bytes, int] = {}
        """The GIDs of departed publishers, each with the number of checks in a row that found no message from it."""
        self._selected_nodes: dict[str, NodeIdentity] = {}
        self._selected_publishers: dict[bytes, EndpointInfo] = {}
        self._selected_services: dict[tuple[str, str, str], EndpointInfo] = {}
        self._selected_presences: dict[bytes, EndpointInfo] = {}
        self._announcement_deadlines: dict[bytes, float] = {}
        """The steady time, in seconds, at which each new presence is announced at the latest."""
        self._warned_names: set[str] = set()

    # --- change handlers ---------------------------------------------------------------------------------------------

    def remove_mirrors(self) -> None:
        """Decide which endpoints to mirror now, and remove the mirrors of endpoints that have left."""
        self._select_endpoints()
        self._departed_publishers = {
            gid: self._departed_publishers.get(gid, 0)
            for gid in self._publishers.keys() - self._selected_publishers.keys()
        }
        for key in self._services.keys() - self._selected_services.keys():
            self._services.pop(key).close()
        for gid in self._presences.keys() - self._selected_presences.keys():
            self._presences.pop(gid).destroy()
        self._remove_departed()

    def add_mirrors(self) -> None:
        """Mirror new nodes, publishers and services in the target."""
        for name, node in self._selected_nodes.items():
            if name not in self._nodes:
                self._nodes[name] = self._target.open_node(node)
        for gid, info in self._selected_publishers.items():
            if gid not in self._publishers:
                stream = get_stream(info, is_keyed=self._source.needs_hashes)
                self._publishers[gid] = MirroredPublisher(self._mirror_node(info), info, stream)
            if self._publishers[gid].has_queued_messages:
                self._publishers[gid].expects_listeners = self._is_expected(info)
        for key, info in self._selected_services.items():
            if key not in self._services:
                self._services[key] = MirroredService(self._mirror_node(info), self._source.bridge_node, info)

    def announce(self, opposite: Direction) -> bool:
        """Announce the source's subscriptions and clients in the target.

        Return whether all of them are announced.

        Publishers in the target may send a message as soon as they discover a subscription. The bridge must therefore
        have subscribed there by then.

        Args:
            opposite: the opposite direction, which subscribes in the target.
        """
        now = time.monotonic()
        for gid in self._announcement_deadlines.keys() - self._selected_presences.keys():
            del self._announcement_deadlines[gid]
        for gid in self._selected_presences.keys() - self._presences.keys():
            info = self._selected_presences[gid]
            deadline = self._announcement_deadlines.setdefault(
                gid, now + (MATCH_TIMEOUT_S if opposite.has_match(info) else _ANNOUNCEMENT_DELAY_S)
            )
            if info.kind is EndpointKind.CLIENT or now >= deadline or opposite.is_subscribed(info.name):
                node = self._mirror_node(info)
                self._presences[gid] = node.add(Presence(node, info))
                del self._announcement_deadlines[gid]
        return not self._announcement_deadlines

    def is_subscribed(self, name: str) -> bool:
        """Return whether the bridge subscribes to a topic in the source."""
        return any(stream.name == name for stream in self._taps)

    def has_match(self, subscription: EndpointInfo) -> bool:
        """Return whether a mirrored publisher matches a subscription in the target."""
        return any(
            publisher.info.name == subscription.name
            and can_receive(subscription, publisher.info, is_keyed=self._target.needs_hashes)
            for publisher in self._publishers.values()
        )

    def process_pending(self) -> bool:
        """Continue pending work (messages, removals, matching), and return whether all is done."""
        is_settled = not self._departed_publishers
        self._publish_early()
        self._remove_departed()
        for publisher in self._publishers.values():
            is_settled = publisher.process_pending() and is_settled
        for service in self._services.values():
            is_settled = service.process_pending() and is_settled
        self._update_taps()
        return is_settled and not self._early_messages

    def close(self) -> None:
        """Close the mirrored publishers."""
        for publisher in self._publishers.values():
            publisher.close()

    # --- internals ---------------------------------------------------------------------------------------------------

    def _remove_departed(self) -> None:
        """Remove the mirrors of publishers that have left, and nodes without mirrors.

        A mirror is removed only when the last messages of its publisher have been carried.
        """
        for gid, quiet in tuple(self._departed_publishers.items()):
            publisher = self._publishers[gid]
            tap = self._taps.get(publisher.stream)
            has_pending = publisher.has_more() or (tap is not None and tap.has_more())
            self._departed_publishers[gid] = 0 if has_pending else quiet + 1
            if (tap is None and not has_pending) or self._departed_publishers[gid] >= _QUIET:
                del self._departed_publishers[gid]
                self._publishers.pop(gid).close()
                self._aliases = {
                    alias: publisher_gid for alias, publisher_gid in self._aliases.items() if publisher_gid != gid
                }
        departed_nodes = {self._publishers[gid].info.node for gid in self._departed_publishers}
        names = self._selected_nodes.keys() | {node.full_name for node in departed_nodes if node is not None}
        for name in self._nodes.keys() - names:
            self._nodes.pop(name).destroy()

    def _mirror_node(self, info: EndpointInfo) -> NodeHandle:
        assert info.node is not None
        return self._nodes[info.node.full_name]

    def _select_endpoints(self) -> None:
        """Decide which endpoints and nodes of the source to mirror, and which streams to await."""
        source_snapshot, target_snapshot = self._source.snapshot, self._target.snapshot
        self._selected_publishers, self._selected_services, self._selected_nodes = {}, {}, {}
        self._selected_presences = {}
        hidden = {node.full_name for node in source_snapshot.nodes}
        for info in source_snapshot.endpoints:
            if info.node is None or not self._names.passes(info.name):
                continue
            hidden.discard(info.node.full_name)
            if make_endpoint_key(info) in target_snapshot.mirrored_endpoints:
                continue
            if info.kind is EndpointKind.PUBLISHER and self._can_carry(info):
                self._selected_publishers[info.gid] = info
            elif (
                info.kind is EndpointKind.SERVICE
                and info.name not in target_snapshot.services_with_server
                and self._can_carry(info)
            ):
                self._selected_services[info.node.full_name, info.name, info.type_name] = info
            elif info.kind in (EndpointKind.SUBSCRIPTION, EndpointKind.CLIENT):
                self._selected_presences[info.gid] = info
            else:
                continue
            self._selected_nodes[info.node.full_name] = info.node
        for node in source_snapshot.nodes:
            if node.full_name not in hidden and node.full_name not in target_snapshot.mirrored_nodes:
                self._selected_nodes[node.full_name] = node
        self._awaited_streams = {
            stream
            for info in target_snapshot.endpoints
            if info.kind is EndpointKind.SUBSCRIPTION
            and self._names.passes(info.name)
            and make_endpoint_key(info) not in source_snapshot.mirrored_endpoints
            for stream in find_awaited_streams(info, is_keyed=self._source.needs_hashes)
        }

    def _is_expected(self, publisher: EndpointInfo) -> bool:
        """Return whether a subscription in the target can receive from the mirror of a publisher."""
        subscriptions = self._target.snapshot.subscriptions.get(publisher.name, ())
        return any(can_receive(endpoint, publisher, is_keyed=self._target.needs_hashes) for endpoint in subscriptions)

    def _can_carry(self, info: EndpointInfo) -> bool:
        """Return whether a topic or service with this type can be created in the target.

        If it cannot, warn once.
        """
        if not self._target.needs_hashes or find_type_hash(info):
            return True
        if info.name not in self._warned_names:
            self._warned_names.add(info.name)
            owner = "publisher" if info.kind is EndpointKind.PUBLISHER else "server"
            self._logger.warning(
                f"'{info.name}' is not carried from {self._source.label} to {self._target.label}: no package here has "
                f"its type {info.type_name}, and its {owner} at {self._source.label} does not announce its hash. Run "
                "the bridge where the package is found"
            )
        return False

    def _update_taps(self) -> None:
        """Subscribe to the streams that have subscriptions in the target.

        Unsubscribe from others. The subscription to a stream with history ends only when the publishers have left. If
        the bridge subscribed again, late joiners would receive the history twice. While a topic has no publisher, and
        while its first publisher is being matched, every possible stream is subscribed to.
        """
        subscriptions = self._target.snapshot.subscriptions
        streams = {
            publisher.stream
            for publisher in self._publishers.values()
            if (publisher.stream in self._taps and publisher.stream.has_history)
            or (publisher.info.name in subscriptions and publisher.listeners())
        }
        matched_names = {
            publisher.info.name for publisher in self._publishers.values() if not publisher.has_queued_messages
        }
        streams |= {stream for stream in self._awaited_streams if stream.name not in matched_names}
        for stream in self._taps.keys() - streams:
            self._taps.pop(stream).close()
        # A publisher may send as soon as it discovers one of several subscriptions, so the subscription that matches
        # most publishers is created first.
        for stream in sorted(streams - self._taps.keys(), key=lambda stream: (stream.history, stream.reliability)):
            self._taps[stream] = Tap(self._source.bridge_node, stream, self._carry)

    def _carry(self, tap: Tap, data: bytes, info: MessageInfo) -> None:
        """Publish a message in the target, unless a bridge has published it in the source.

        A message whose publisher has not been discovered yet is queued.
        """
        if not info.is_remote:
            return
        publisher = self._find_publisher(info.publisher_gid)
        if publisher is not None:
            if publisher.stream == tap.stream:
                self._publish_early()
                publisher.put(data)
                if publisher.info.gid in self._departed_publishers:
                    self._departed_publishers[publisher.info.gid] = 0
        elif info.publisher_gid not in self._source.snapshot.bridge_gids:
            self._early_messages.append(
                EarlyMessage(time.monotonic() + _DISCOVERY_TIMEOUT_S, tap, info.publisher_gid, data)
            )

    def _publish_early(self) -> None:
        """Publish the queued messages whose publisher has been discovered in the meantime."""
        now = time.monotonic()
        for _ in range(len(self._early_messages)):
            message = self._early_messages.popleft()
            if message.tap is not self._taps.get(message.tap.stream):
                continue  # another bridge now carries the stream
            publisher = self._find_publisher(message.gid)
            if publisher is None and now < message.expires_at:
                self._early_messages.append(message)
                continue
            publisher = publisher or self._assign_publisher(message)
            if publisher is not None and publisher.stream == message.tap.stream:
                publisher.put(message.data)

    def _find_publisher(self, gid: bytes) -> MirroredPublisher | None:
        return self._publishers.get(self._aliases.get(gid, gid))

    def _assign_publisher(self, message: EarlyMessage) -> MirroredPublisher | None:
        """Return any mirror of the message's stream, and assign the message's GID to it.

        Return None if the stream has no mirror.

        Over Zenoh, the messages of some programs have a GID that no publisher has announced.
        """
        for gid, publisher in self._publishers.items():
            if publisher.stream == message.tap.stream:
                self._aliases[message.gid] = gid
                return publisher
        return None
