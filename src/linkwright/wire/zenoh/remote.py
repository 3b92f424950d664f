"""The nodes and endpoints of other sessions, from their liveliness tokens."""

from __future__ import annotations

import time
from collections import Counter
from itertools import islice
from threading import Lock

from linkwright.graph.endpoints.base import EndpointInfo, EndpointKind
from linkwright.graph.names.rules import NodeIdentity
from linkwright.wire.remote_entities import RemoteEntities
from linkwright.wire.zenoh.tokens import Token

_READD_DELAY_S = 0.5
"""Seconds for which a removed token is not added again. Zenoh retries broken links only after one second."""


class RemoteGraph(RemoteEntities):
    """The nodes and endpoints of other sessions.

    `RemoteEntities` describes the thread safety.
    """

    def __init__(self) -> None:
        super().__init__()
        self._lock = Lock()
        self._tokens: dict[str, Token] = {}
        self._counts: Counter[tuple[EndpointKind, str]] = Counter()
        self._removal_times: dict[str, float] = {}

    # --- called by discovery -----------------------------------------------------------------------------------------

    def add(self, key: str, token: Token) -> bool:
        """Record a token under its key expression, and return whether it is new.

        The key expression may have additional chunks, from newer distributions.
        """
        with self._lock:
            if key in self._tokens:
                return False
            self._tokens[key] = token
            if token.kind is not None:
                self._counts[token.kind, token.data_key] += 1
        return True

    def was_just_removed(self, key: str) -> bool:
        """Return whether a token disappeared a moment ago.

        A report that such a token is alive is outdated.

        If a session requests tokens that it already knows, Zenoh answers in a separate task, and the report of a
        token's end may overtake the answer. A token that reappears after a broken connection takes longer.
        """
        return key in self._removal_times and time.monotonic() - self._removal_times[key] < _READD_DELAY_S

    def remove(self, key: str) -> Token | None:
        """Remove a token and return it, or None if the token was not known."""
        now = time.monotonic()
        for expired_key in [
            removed_key
            for removed_key in islice(self._removal_times, 2)
            if now - self._removal_times[removed_key] > _READD_DELAY_S
        ]:
            del self._removal_times[expired_key]  # removing two per call keeps the table small
        self._removal_times.pop(key, None)
        self._removal_times[key] = now
        with self._lock:
            token = self._tokens.pop(key, None)
            if token is not None and token.kind is not None:
                count_key = (token.kind, token.data_key)
                self._counts[count_key] -= 1
                if not self._counts[count_key]:
                    del self._counts[count_key]
        return token

    def remove_endpoints(self, kind: EndpointKind, data_key: str) -> None:
        """Remove the endpoints of a kind at a key.

        The session no longer subscribes to their tokens.
        """
        with self._lock:
            removed_keys = [
                key for key, token in self._tokens.items() if (token.kind, token.data_key) == (kind, data_key)
            ]
            for key in removed_keys:
                del self._tokens[key]
            self._counts.pop((kind, data_key), None)

    def remove_nodes(self, full_name: str) -> None:
        """Remove all nodes with a full name.

        The session no longer subscribes to their tokens.
        """
        with self._lock:
            for key in [key for key, token in self._tokens.items() if token.kind is None]:
                if self._tokens[key].node.full_name == full_name:
                    del self._tokens[key]

    # --- queries of the transport ------------------------------------------------------------------------------------

    def count(self, kind: EndpointKind, data_key: str) -> int:
        """Return the number of known endpoints of a kind at a key."""
        return self._counts[kind, data_key]

    def has_endpoints(self, node_key: tuple[str, str]) -> bool:
        """Return whether a node, given by its `Token.node_key`, has endpoints."""
        with self._lock:
            return any(token.kind is not None and token.node_key == node_key for token in self._tokens.values())

    def has_token(self, key: str) -> bool:
        """Return whether a token with this key expression is known."""
        return key in self._tokens

    def find_sessions(self, kind: EndpointKind | None = None) -> set[str]:
        """Return the ids of the known sessions.

        If a kind is given, only sessions that have endpoints of this kind are included.
        """
        with self._lock:
            return {token.session for token in self._tokens.values() if kind is None or token.kind is kind}

    def nodes(self) -> list[NodeIdentity]:
        """Return the nodes of other sessions."""
        with self._lock:
            return [token.node for token in self._tokens.values() if token.kind is None]

    def endpoints(self) -> list[EndpointInfo]:
        """Return the endpoints of other sessions."""
        with self._lock:
            tokens = list(self._tokens.values())
        return [info for token in tokens if (info := token.endpoint_info()) is not None]
