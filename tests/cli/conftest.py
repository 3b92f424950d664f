"""A graph for the commands about running nodes, on the event loop of the command."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from linkwright.cli import session
from linkwright.graph import Graph


@pytest.fixture
def in_graph(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Graph], object]], None]:
    """Accept a function that adds nodes to the graph of the next commands, which joins no other network."""

    def use(make: Callable[[Graph], object]) -> None:
        async def join(graph: Graph, _spin_time: float | None, *, read_only: bool = False) -> None:
            make(graph)

        monkeypatch.setattr(session, "join_others", join)

    return use
