"""A graph for the commands about running nodes, on the command's event loop."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from linkwright.cli import session
from linkwright.graph import Graph


@pytest.fixture
def add_to_graph(monkeypatch: pytest.MonkeyPatch) -> Callable[[Callable[[Graph], object]], None]:
    """Return a function that adds nodes to the graphs of later commands.

    It registers a callback. The graphs stay local.
    """

    def add_to_later_commands(add_nodes: Callable[[Graph], object]) -> None:
        async def join(graph: Graph, _spin_time: float | None, *, read_only: bool = False) -> None:
            add_nodes(graph)

        monkeypatch.setattr(session, "join_others", join)

    return add_to_later_commands
