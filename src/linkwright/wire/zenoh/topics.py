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

_HEARTBEAT = 0.5
"""Seconds after which a reliable publisher that keeps messages announces the number of its last one."""

_MOST_KEPT = 1_000_000
"""The history for late joiners of a publisher that is to keep everything."""


class OutgoingTopic:
    """A publisher of this process, as subscriptions of other processes receive it.

    Args:
        publisher: the publisher.
        token: the publisher's token.
        session: the session.
        changed: called, from any thread, when the publisher gains its first subscription or loses its last one.
    """

    def __init__(
        self, publisher: Publisher[Any], token: Token, session: zenoh.Session, changed: Callable[[], None]
    ) -> None:
        self._publisher = publisher
        self.token = token
        profile = publisher.qos_profile
        self._keeps = profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
        self._listener: Any = None
        publisher.gid = token.gid
        reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
        keeps_all = reliable and profile.history is HistoryPolicy.KEEP_ALL
        options: dict[str, Any] = {
            "congestion_control": zenoh.CongestionControl.BLOCK if keeps_all else zenoh.CongestionControl.DROP,
            "reliability": zenoh.Reliability.RELIABLE if reliable else zenoh.Reliability.BEST_EFFORT,
            "allowed_destination": zenoh.Locality.REMOTE,
        }
        if self._keeps:
            misses = ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=_HEARTBEAT) if reliable else None
            self._zenoh: Any = ext.declare_advanced_publisher(
                session,
                token.data_key,
                cache=ext.CacheConfig(_depth(profile)),
                sample_miss_detection=misses,
                publisher_detection=True,
                **options,
            )
        else:
            self._zenoh = session.declare_publisher(token.data_key, **options)
            # A thread of Zenoh calls this directly. With Zenoh's own handlers, each listener would have a Python
            # thread.
            self._listener = self._zenoh.declare_matching_listener(Callback(lambda _: changed(), indirect=False))
        self._send: Callable[[Any], None] | None = self._sender()

    def review(self, count: int) -> None:
        """Enable sending while there is a subscription, or while late joiners must be served.

        Args:
            count: the number of known remote subscriptions.
        """
        listened_to = self._keeps or self._zenoh.matching_status.matching
        self._publisher.set_outside(self._send if listened_to else None, _sent)
        self._publisher.set_outside_count(count if listened_to else 0)

    def close(self) -> None:
        """Withdraw the publisher.

        A publisher that stores messages for late joiners is dropped without `undeclare`, which withdraws it as well.
        Its `undeclare` would hold the GIL for up to 10 s while waiting for a thread of Zenoh that may itself be
        waiting for the GIL in a callback.
        """
        self.abandon()
        if self._listener is not None:
            self._listener.undeclare()
            self._zenoh.undeclare()
        self._send, self._zenoh = None, None

    def abandon(self) -> None:
        """Stop sending, without calling Zenoh."""
        self._publisher.outside = None

    def _sender(self) -> Callable[[Any], None]:
        put, gid, now, write = self._zenoh.put, self.token.gid, time.time_ns, attachment.write
        numbers, lock = itertools.count(1), Lock()

        def send(message: Any) -> None:
            data = message if type(message) is bytes else _bytes_of(message)
            with lock:  # Messages must be sent in the order of their numbers, because a gap counts as a loss.
                put(data, attachment=write(next(numbers), now(), gid))

        return send


class IncomingTopic:
    """A subscription of this process, as publishers of other processes reach it.

    Args:
        subscription: the subscription.
        token: the subscription's token.
        session: the session.
        key: the key to subscribe to: the token's data key, or an expression that includes it.
        own: the gids of this session's publishers, which deliver to the subscription inside the process.
    """

    def __init__(
        self, subscription: Subscription[Any], token: Token, session: zenoh.Session, key: str, own: Collection[bytes]
    ) -> None:
        self._subscription = subscription
        self.token = token
        self._own = own
        self._last: dict[bytes, int] = {}
        self._warned = False
        subscription.gid = token.gid
        profile = subscription.qos_profile
        handler: Any = Callback(self._receive, indirect=False)
        if profile.durability is DurabilityPolicy.TRANSIENT_LOCAL:
            reliable = profile.reliability is not ReliabilityPolicy.BEST_EFFORT
            self._zenoh: Any = ext.declare_advanced_subscriber(
                session,
                key,
                handler,
                allowed_origin=zenoh.Locality.REMOTE,
                history=ext.HistoryConfig(detect_late_publishers=True, max_samples=_depth(profile)),
                recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True) if reliable else None,
                subscriber_detection=True,
            )
        else:
            self._zenoh = session.declare_subscriber(key, handler, allowed_origin=zenoh.Locality.REMOTE)

    def review(self, count: int) -> None:
        """Update the number of known remote publishers."""
        self._subscription.set_outside_count(count)
        self._subscription.set_outside_liveliness(count, 0)  # Zenoh reports only live publishers

    def close(self) -> None:
        """Withdraw the subscription."""
        self._zenoh.undeclare()

    def _receive(self, sample: zenoh.Sample) -> None:
        """Pass a sample to the subscription. Called in a thread of Zenoh."""
        enclosed = sample.attachment
        about = attachment.read(None if enclosed is None else enclosed.to_bytes())
        if about is None:
            self._refuse()
            return
        number, sent_ns, gid = about
        if gid in self._own:
            return
        last = self._last.get(gid)
        self._last[gid] = number
        if last is not None and number > last + 1:
            self._subscription.count_lost_outside(number - last - 1)
        info = MessageInfo(sent_ns, time.time_ns(), gid, True, number)
        try:
            self._subscription.receive(sample.payload.to_bytes(), info)
        except Exception as error:  # noqa: BLE001 - the thread is Zenoh's, which would print it and not log it
            self._subscription.report(error)

    def _refuse(self) -> None:
        if not self._warned:
            self._warned = True
            self._subscription.node.logger.warning(
                f"Dropped a message of topic '{self._subscription.name}': it does not name its sender and time, as "
                "those of ROS 2 do over Zenoh"
            )


def _sent(_seconds: float | None) -> bool:
    """Return True, because a message that was passed to Zenoh counts as sent.

    Zenoh has reliable connections and no acknowledgements.
    """
    return True


def _depth(profile: QoSProfile) -> int:
    return _MOST_KEPT if profile.queue_length is None else profile.queue_length


def _bytes_of(message: Any) -> bytes:
    return bytes(message) if isinstance(message, bytearray) else serialize(message)
