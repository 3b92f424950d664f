"""Publishers and subscriptions over Zenoh."""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable, Collection
from threading import Lock
from typing import TYPE_CHECKING, Any

import zenoh
from zenoh import ext
from zenoh.handlers import Callback

from linkwright.graph.endpoints.base import MessageInfo
from linkwright.graph.qos.profile import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from linkwright.messages import serialize
from linkwright.wire.zenoh import attachment
from linkwright.wire.zenoh.tokens import Token

if TYPE_CHECKING:
    from linkwright.graph.endpoints.publisher import Publisher
    from linkwright.graph.endpoints.subscription import Subscription

_HEARTBEAT_S = 0.5
"""The interval, in seconds, at which a reliable publisher that stores messages announces its last number."""

_MAX_HISTORY = 1_000_000
"""The maximum number of messages that a publisher with KEEP_ALL stores for late joiners."""


class OutgoingTopic:
    """The connection of a publisher to the subscriptions of other processes.

    Args:
        publisher: the publisher.
        token: the publisher's token.
        session: the session.
        on_change: called, from any thread, when the publisher gains its first subscription or loses its last one.
    """

    def __init__(
        self, publisher: Publisher[Any], token: Token, session: zenoh.Session, on_change: Callable[[], None]
    ) -> None:
        self._publisher = publisher
        self.token = token
        profile = publisher.qos_profile
        self._is_transient_local = profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._listener: Any = None
        publisher.gid = token.gid
        is_reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
        keeps_all = is_reliable and profile.history is HistoryPolicy.KEEP_ALL
        options: dict[str, Any] = {
            "congestion_control": zenoh.CongestionControl.BLOCK if keeps_all else zenoh.CongestionControl.DROP,
            "reliability": zenoh.Reliability.RELIABLE if is_reliable else zenoh.Reliability.BEST_EFFORT,
            "allowed_destination": zenoh.Locality.REMOTE,
        }
        if self._is_transient_local:
            miss_detection = (
                ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=_HEARTBEAT_S) if is_reliable else None
            )
            self._zenoh: Any = ext.declare_advanced_publisher(
                session,
                token.data_key,
                cache=ext.CacheConfig(_get_depth(profile)),
                sample_miss_detection=miss_detection,
                publisher_detection=True,
                **options,
            )
        else:
            self._zenoh = session.declare_publisher(token.data_key, **options)
            # A thread of Zenoh calls this directly. With Zenoh's own handlers, each listener would have a Python
            # thread.
            self._listener = self._zenoh.declare_matching_listener(Callback(lambda _: on_change(), indirect=False))
        self._send: Callable[[Any], None] | None = self._make_sender()

    def update_match_count(self, count: int) -> None:
        """Enable or disable sending, and update the number of remote subscriptions.

        Sending is enabled while there is a subscription, or while late joiners must be served.

        Args:
            count: the number of known remote subscriptions.
        """
        is_needed = self._is_transient_local or self._zenoh.matching_status.matching
        self._publisher.set_remote_sender(self._send if is_needed else None, _is_acknowledged)
        self._publisher.set_remote_count(count if is_needed else 0)

    def close(self) -> None:
        """Withdraw the publisher.

        A publisher that stores messages for late joiners is not undeclared. Dropping the last reference withdraws it,
        too, whereas `undeclare` would hold the GIL for up to 10 s while waiting for a thread of Zenoh that may itself
        be waiting for the GIL in a callback.
        """
        self.abandon()
        if self._listener is not None:
            self._listener.undeclare()
            self._zenoh.undeclare()
        self._send, self._zenoh = None, None

    def abandon(self) -> None:
        """Stop sending, without calling Zenoh."""
        self._publisher.send_remote = None

    def _make_sender(self) -> Callable[[Any], None]:
        put_sample, gid, now, write = self._zenoh.put, self.token.gid, time.time_ns, attachment.write
        numbers, lock = itertools.count(1), Lock()

        def send(message: Any) -> None:
            data = message if type(message) is bytes else _to_bytes(message)
            with lock:  # Messages must be sent in the order of their numbers, because a gap counts as a loss.
                put_sample(data, attachment=write(next(numbers), now(), gid))

        return send


class IncomingTopic:
    """The connection of a subscription to the publishers of other processes.

    Args:
        subscription: the subscription.
        token: the subscription's token.
        session: the session.
        key: the key to subscribe to: the token's data key, or an expression that includes it.
        own_gids: the gids of this session's publishers, which deliver to the subscription inside the process.
    """

    def __init__(
        self,
        subscription: Subscription[Any],
        token: Token,
        session: zenoh.Session,
        key: str,
        own_gids: Collection[bytes],
    ) -> None:
        self._subscription = subscription
        self.token = token
        self._own_gids = own_gids
        self._last_numbers: dict[bytes, int] = {}
        self._has_warned = False
        subscription.gid = token.gid
        profile = subscription.qos_profile
        handler: Any = Callback(self._receive, indirect=False)
        if profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            is_reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
            self._zenoh: Any = ext.declare_advanced_subscriber(
                session,
                key,
                handler,
                allowed_origin=zenoh.Locality.REMOTE,
                history=ext.HistoryConfig(detect_late_publishers=True, max_samples=_get_depth(profile)),
                recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True) if is_reliable else None,
                subscriber_detection=True,
            )
        else:
            self._zenoh = session.declare_subscriber(key, handler, allowed_origin=zenoh.Locality.REMOTE)

    def update_match_count(self, count: int) -> None:
        """Update the number of known remote publishers."""
        self._subscription.set_remote_count(count)
        self._subscription.set_remote_liveliness(count, 0)  # Zenoh reports only live publishers

    def close(self) -> None:
        """Withdraw the subscription."""
        self._zenoh.undeclare()

    def _receive(self, sample: zenoh.Sample) -> None:
        """Pass a sample to the subscription.

        Zenoh calls this method in one of its threads.
        """
        encoded = sample.attachment
        metadata = attachment.read(None if encoded is None else encoded.to_bytes())
        if metadata is None:
            self._count_malformed()
            return
        number, sent_ns, gid = metadata
        if gid in self._own_gids:
            return
        last_number = self._last_numbers.get(gid)
        self._last_numbers[gid] = number
        if last_number is not None and number > last_number + 1:
            self._subscription.count_lost_remote(number - last_number - 1)
        info = MessageInfo(sent_ns, time.time_ns(), gid, True, number)
        try:
            self._subscription.receive(sample.payload.to_bytes(), info)
        except Exception as error:  # noqa: BLE001 - Zenoh's thread would print the error without logging it
            self._subscription.report(error)

    def _count_malformed(self) -> None:
        if not self._has_warned:
            self._has_warned = True
            self._subscription.node.logger.warning(
                f"Dropped a message of topic '{self._subscription.name}': it lacks the sender and the time that "
                "ROS 2 sends with each message over Zenoh"
            )


def _is_acknowledged(_seconds: float | None) -> bool:
    """Return True, because a message counts as sent when it was passed to Zenoh.

    Zenoh has reliable connections and no acknowledgments.
    """
    return True


def _get_depth(profile: QoSProfile) -> int:
    return _MAX_HISTORY if profile.queue_length is None else profile.queue_length


def _to_bytes(message: Any) -> bytes:
    return bytes(message) if isinstance(message, bytearray) else serialize(message)
