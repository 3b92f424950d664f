"""The liveliness tokens that a session subscribes to.

The router sends every token to each session that subscribes to all tokens. This traffic grows with the square of the
number of robots. Therefore, a client of a router, such as a robot, subscribes only to the tokens that its own nodes and
endpoints need, until the graph is queried (`docs/decisions/0076-tokens-on-demand.md`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from collections.abc import Set as AbstractSet
from typing import Any

import zenoh
from zenoh.handlers import Callback

from linkwright.wire.zenoh import tokens

KEY_PREFIX = "@linkwright"
"""Linkwright's sessions have a token ``@linkwright/<domain>/<session>/here``, and add ``left`` before they end."""


class Interests:
    """The tokens that a session subscribes to.

    After `__init__`, only one thread may use this.

    Args:
        session: the session.
        domain_id: the ROS domain.
        on_token: called, from threads of Zenoh, with each token that appears or disappears.
    """

    def __init__(self, session: zenoh.Session, domain_id: int, on_token: Callable[[zenoh.Sample], None]) -> None:
        self._liveliness = session.liveliness()
        self._on_token = on_token
        self._token_pattern = f"{tokens.ROOT}/{domain_id}/**"
        self._sessions = f"{KEY_PREFIX}/{domain_id}"
        self._counts: Counter[str] = Counter()
        self._declared: dict[str, Any] = {}
        self._followed_sessions: AbstractSet[str] = frozenset()
        self.subscribes_to_all = False
        """Whether the session subscribes to all tokens of the domain."""

    def add(self, key: str) -> None:
        """Subscribe to the tokens that match a key expression.

        Repeated subscriptions to the same expression are counted.
        """
        self._counts[key] += 1
        if not self.subscribes_to_all and self._counts[key] == 1:
            self._declare(key)

    def remove(self, key: str) -> bool:
        """Undo one `add`, and return whether the session no longer subscribes to these tokens."""
        self._counts[key] -= 1
        if self._counts[key]:
            return False
        del self._counts[key]
        subscriber = self._declared.pop(key, None)
        if subscriber is not None:
            subscriber.undeclare()
        return not self.subscribes_to_all

    def follow(self, publishing_sessions: AbstractSet[str], live_sessions: AbstractSet[str]) -> None:
        """Subscribe to all tokens of other sessions, whose changes show how these sessions end.

        The subscription to a session ends when none of its tokens is left.

        Args:
            publishing_sessions: the ids of the sessions whose publishers are known.
            live_sessions: the ids of the live sessions, known by their own token or any other.
        """
        for session in self._followed_sessions - live_sessions:
            for key in self._session_keys(session):
                self._declared.pop(key).undeclare()
        for session in publishing_sessions - self._followed_sessions:
            for key in self._session_keys(session):
                self._declare(key)
        self._followed_sessions = self._followed_sessions & live_sessions | publishing_sessions

    def _session_keys(self, session: str) -> tuple[str, str]:
        return f"{self._sessions}/{session}/*", self._token_pattern.replace("**", f"{session}/**")

    def add_all(self) -> None:
        """Subscribe to all tokens of the domain."""
        if self.subscribes_to_all:
            return
        self.subscribes_to_all = True
        previous, self._declared = self._declared, {}
        self._declare(f"{self._sessions}/**")
        self._declare(self._token_pattern)
        for subscriber in previous.values():
            subscriber.undeclare()

    def request_all(self, seconds: float, on_answered: Callable[[], None]) -> None:
        """Request the live tokens of the domain.

        This must be called before `add_all`, after which Zenoh answers from its own memory.

        Args:
            seconds: the longest wait.
            on_answered: called from a thread of Zenoh when all have answered, or the time is over.
        """

        def receive(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                self._on_token(reply.ok)

        handler: Any = Callback(receive, on_answered, indirect=False)
        self._liveliness.get(self._token_pattern, handler, timeout=seconds)

    def close(self) -> None:
        """End all subscriptions."""
        for subscriber in self._declared.values():
            subscriber.undeclare()
        self._declared.clear()

    def _declare(self, key: str) -> None:
        handler: Any = Callback(self._on_token, indirect=False)
        self._declared[key] = self._liveliness.declare_subscriber(key, handler, history=True)
