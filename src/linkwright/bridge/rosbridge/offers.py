"""The services and actions that clients of rosbridge offer to the graph, by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from linkwright.bridge.rosbridge.requests import RequestError

_MAX_OFFERS = 1000


class Offered(Protocol):
    """A service or action that a client offers."""

    def close(self) -> None:
        """End the service or action."""


T = TypeVar("T", bound=Offered)


class Offers(Generic[T]):
    """The services, or the actions, that clients offer.

    Args:
        kind: what they are, for errors.
    """

    def __init__(self, kind: str) -> None:
        self._kind = kind
        self._offers: dict[str, tuple[object, T]] = {}

    def add(self, owner: object, name: str, create: Callable[[], T]) -> None:
        """Create what a client offers. It replaces what any client offers by the same name.

        Raises:
            RequestError: there are too many.
        """
        if len(self._offers) >= _MAX_OFFERS:
            raise RequestError(f"clients may offer at most {_MAX_OFFERS} of this kind: {self._kind}")
        if name in self._offers:
            self._offers.pop(name)[1].close()
        self._offers[name] = (owner, create())

    def find(self, owner: object, name: str) -> T:
        """Return what a client offers.

        Raises:
            RequestError: the client offers nothing by this name.
        """
        found_owner, offered = self._offers.get(name, (None, None))
        if offered is None or found_owner is not owner:
            raise RequestError(f"{self._kind} {name[:200]} has not been advertised via rosbridge.")
        return offered

    def withdraw(self, owner: object, name: str) -> None:
        """End what a client offers.

        Raises:
            RequestError: the client offers nothing by this name.
        """
        offered = self.find(owner, name)
        del self._offers[name]
        offered.close()

    def withdraw_all(self, owner: object) -> None:
        """End all that a client offers."""
        for name, (found_owner, _) in list(self._offers.items()):
            if found_owner is owner:
                self.withdraw(owner, name)
