"""The liveliness tokens to which a session subscribes.

The router sends every token to each session that subscribes to all tokens. For a hall full of robots, this traffic
grows with the square of their number. Therefore a client of a router, as robots are, subscribes only to the tokens that
its own nodes and endpoints need, until the graph is queried (`docs/decisions/0076-tokens-on-demand.md`).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from collections.abc import Set as AbstractSet
from typing import Any

import zenoh
from zenoh.handlers import Callback

from linkwright.wire.zenoh import tokens

OURS = "@linkwright"
"""Sessions of Linkwright's have a token ``@linkwright/<domain>/<session>/here``, and ``left`` before they leave."""


class Interests:
    """The tokens to which a session subscribes. After `__init__`, only one thread may use this.

    Args:
        session: the session.
        domain_id: the ROS domain.
        hear: called, from threads of Zenoh, with each token that appears or disappears.
    """

    def __init__(self, session: zenoh.Session, domain_id: int, hear: Callable[[zenoh.Sample], None]) -> None:
        self._liveliness = session.liveliness()
        self._hear = hear
        self._all = f"{tokens.ROOT}/{domain_id}/**"
        self._sessions = f"{OURS}/{domain_id}"
        self._counts: Counter[str] = Counter()
        self._declared: dict[str, Any] = {}
        self._followed: AbstractSet[str] = frozenset()
        self.in_all = False
        """Whether all tokens of the domain are heard of."""

    def add(self, key: str) -> None:
        """Subscribe to the tokens that match a key expression.

        Repeated subscriptions to the same expression are counted.
        """
        self._counts[key] += 1
        if not self.in_all and self._counts[key] == 1:
            self._declare(key)

    def remove(self, key: str) -> bool:
        """Undo one `add`; return whether the session no longer subscribes to these tokens."""
        self._counts[key] -= 1
        if self._counts[key]:
            return False
        del self._counts[key]
        declared = self._declared.pop(key, None)
        if declared is not None:
            declared.undeclare()
        return not self.in_all

    def follow(self, publishing: AbstractSet[str], there: AbstractSet[str]) -> None:
        """Subscribe to all tokens of other sessions, from which it follows how the sessions leave.

        The subscription to a session ends when none of its tokens is left.

        Args:
            publishing: the ids of the sessions whose publishers are known.
            there: the ids of the live sessions, known by their own token or any other.
        """
        for session in self._followed - there:
            for key in self._keys_of(session):
                self._declared.pop(key).undeclare()
        for session in publishing - self._followed:
            for key in self._keys_of(session):
                self._declare(key)
        self._followed = self._followed & there | publishing

    def _keys_of(self, session: str) -> tuple[str, str]:
        return f"{self._sessions}/{session}/*", self._all.replace("**", f"{session}/**")

    def add_all(self) -> None:
        """Subscribe to all tokens of the domain."""
        if self.in_all:
            return
        self.in_all = True
        before, self._declared = self._declared, {}
        self._declare(f"{self._sessions}/**")
        self._declare(self._all)
        for declared in before.values():
            declared.undeclare()

    def request_all(self, seconds: float, answered: Callable[[], None]) -> None:
        """Request the live tokens of the domain.

        This must be called before `add_all`, after which Zenoh answers from its own memory.

        Args:
            seconds: the longest wait.
            answered: called from a thread of Zenoh when all have answered, or the time is over.
        """

        def receive(reply: zenoh.Reply) -> None:
            if reply.ok is not None:
                self._hear(reply.ok)

        handler: Any = Callback(receive, answered, indirect=False)
        self._liveliness.get(self._all, handler, timeout=seconds)

    def close(self) -> None:
        """End all subscriptions."""
        for declared in self._declared.values():
            declared.undeclare()
        self._declared.clear()

    def _declare(self, key: str) -> None:
        handler: Any = Callback(self._hear, indirect=False)
        self._declared[key] = self._liveliness.declare_subscriber(key, handler, history=True)
