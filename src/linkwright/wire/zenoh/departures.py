"""Distinguish lost publishers (killed, crashed, unreachable) from orderly departures.

A token disappears when its owner withdraws it, and when its session ends for any reason. Linkwright's sessions have an
additional token, and announce their departure before that token disappears. Without this announcement, their endpoints
are lost. Other sessions withdraw the endpoints of a node before the node itself. When a session is killed, all its
tokens disappear together, in no particular order. So an endpoint of another session is lost if its node disappears
before the endpoint.

A client of a router requests a session's other tokens once it knows of a publisher of the session (`Interests.follow`).
The router answers within milliseconds. If the session ends before, its end cannot be classified, and it does not count
as lost.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from collections.abc import Set as AbstractSet
from dataclasses import dataclass
from typing import TYPE_CHECKING

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.wire.zenoh.tokens import Token

if TYPE_CHECKING:
    from linkwright.wire.zenoh.remote import RemoteGraph

GRACE_S = 0.4
"""Seconds after a publisher disappears within which changes to its session's other tokens arrive."""


@dataclass(slots=True)
class _MissingPublisher:
    """A publisher whose token has disappeared.

    Attributes:
        key: the key expression of the token.
        token: the token.
        deadline: when to decide whether the publisher is lost, in seconds of the steady clock.
    """

    key: str
    token: Token
    deadline: float


class ZenohDepartureMonitor:
    """Decides whether publishers that disappeared were lost.

    Only the discovery thread may call the methods, except `watch`.

    Args:
        remote: the remote graph.
        now: the steady clock, in seconds.
    """

    def __init__(self, remote: RemoteGraph, now: Callable[[], float] = time.monotonic) -> None:
        self._remote = remote
        self._now = now
        self._watchers: list[Callable[[EndpointInfo], None]] = []
        self._missing_publishers: list[_MissingPublisher] = []
        self._live_sessions: set[str] = set()
        self._departed_sessions: set[str] = set()
        self._ended_at: dict[str, float] = {}
        self._unordered_nodes: set[tuple[str, str]] = set()
        self._nodes_removed_at: dict[tuple[str, str], float] = {}

    def watch(self, callback: Callable[[EndpointInfo], None]) -> None:
        """Register a callback for lost publishers.

        The callback runs in the discovery thread.
        """
        self._watchers.append(callback)

    @property
    def is_watched(self) -> bool:
        """Whether a callback is registered for lost publishers."""
        return bool(self._watchers)

    @property
    def live_sessions(self) -> AbstractSet[str]:
        """The ids of Linkwright's live sessions.

        These sessions announce their departure.
        """
        return self._live_sessions

    def on_session_started(self, session: str) -> None:
        """Record that a Linkwright session has started."""
        self._live_sessions.add(session)

    def on_session_leaving(self, session: str) -> None:
        """Record that a Linkwright session is about to end."""
        self._departed_sessions.add(session)

    def on_session_ended(self, session: str) -> None:
        """Record that a Linkwright session has ended."""
        self._live_sessions.discard(session)
        self._ended_at[session] = self._now()

    def on_token_removed(self, key: str, token: Token) -> None:
        """Record that a token has disappeared."""
        if token.kind is None:
            self._nodes_removed_at[token.node_key] = self._now()
            return
        if token.node_key in self._nodes_removed_at:
            self._unordered_nodes.add(token.node_key)
        if self._watchers and token.kind is EndpointKind.PUBLISHER:
            self._missing_publishers.append(_MissingPublisher(key, token, self._now() + GRACE_S))

    def report_lost_publishers(self) -> float | None:
        """Report the publishers that have become lost since the last call.

        Returns:
            The seconds until the next call, or None if no call is needed.
        """
        now = self._now()
        expired = [missing for missing in self._missing_publishers if missing.deadline <= now]
        self._missing_publishers = [publisher for publisher in self._missing_publishers if publisher.deadline > now]
        for publisher in expired:
            info = publisher.token.endpoint_info() if self._is_lost(publisher) else None
            if info is not None:
                for callback in self._watchers:
                    callback(info)
        if not self._missing_publishers:
            self._remove_expired_records(now)
        return max(self._missing_publishers[0].deadline - now, 0.0) if self._missing_publishers else None

    def _is_lost(self, missing: _MissingPublisher) -> bool:
        token = missing.token
        if self._remote.has_token(missing.key):
            return False
        if token.session in self._live_sessions or token.session in self._ended_at:
            return token.session in self._ended_at and token.session not in self._departed_sessions
        if token.node_key not in self._nodes_removed_at:
            return False
        return token.node_key in self._unordered_nodes or self._remote.has_endpoints(token.node_key)

    def _remove_expired_records(self, now: float) -> None:
        """Remove the records of nodes and sessions that disappeared long enough ago."""
        for node_key, since in tuple(self._nodes_removed_at.items()):
            if now - since > GRACE_S:
                del self._nodes_removed_at[node_key]
                self._unordered_nodes.discard(node_key)
        for session, since in tuple(self._ended_at.items()):
            if now - since > GRACE_S:
                del self._ended_at[session]
                self._departed_sessions.discard(session)
