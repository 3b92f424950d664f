"""A graph for the verbs that look at running nodes: made by the test, inside the command's own event loop."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from linkwright.cli import session
from linkwright.graph import Graph


@pytest.fixture
def in_graph(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Graph], object]], None]:
    """Takes a function that puts nodes into the graph that the next commands look at; nothing outside is joined."""

    def use(make: Callable[[Graph], object]) -> None:
        async def join(graph: Graph, _spin_time: float | None, *, read_only: bool = False) -> None:
            make(graph)

        monkeypatch.setattr(session, "join_others", join)

    return use
